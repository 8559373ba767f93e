//! What the table of a trade-off says before its rows: starts of searches, tolerances, and limits that choose motions.

use std::fmt::Write;

use super::readable::{count, counted};
use crate::campaign::{Answer, Robustness, Row, Searched, Tolerances};
use crate::tradeoff::unit_behind;

/// How many points were drawn as starts, and what was found and does not count.
pub fn write_starts(text: &mut String, searched: &Searched, drawn: Option<[usize; 2]>) {
    if let Some([points, begun]) = drawn {
        let points = counted(points, "drawn point");
        let _ = writeln!(
            text,
            "{points} over the ranges, settled from rest: {} of them gave starts, the other starts are cases",
            count(begun)
        );
    }
    if searched.unsettled > 0 {
        let found = counted(searched.unsettled, "orbit");
        let _ = writeln!(
            text,
            "{found} found do not count: plain integration does not lead to them, or they do not keep the conditions"
        );
    }
}

/// What tolerances are, and what of the conditions cannot be judged under them.
pub fn write_tolerances(text: &mut String, answer: &Answer) {
    let Some(Tolerances { each, draws, seed }) = &answer.tolerances else { return };
    let half_widths: Vec<String> = each
        .iter()
        .map(|(it, most)| format!("{} \u{b1} {} %", it.symbol(), percent(*most)))
        .collect();
    let _ = writeln!(
        text,
        "tolerances: {}, half widths of even distributions (standard deviations are these over \u{221a}3), independent; {draws} draws, \
         seed {seed}",
        half_widths.join(", ")
    );
    if !answer.not_judged.is_empty() {
        let conditions = answer.not_judged.join(" and ");
        let _ = writeln!(text, "not judged of the draws, which have no such number: {conditions}");
    }
}

/// How many draws keep the conditions and the budget.
pub fn counts_of_draws(robustness: &Robustness) -> String {
    let Robustness { draws, meet_conditions, within_budget, meet_both, .. } = robustness;
    let counts = [
        (meet_conditions, "keep the conditions"),
        (within_budget, "keep to the budget"),
        (meet_both, "do both"),
    ];
    let told = counts.map(|(count, does)| {
        count.map_or(String::new(), |count| format!(", {count} of {draws} draws {does}"))
    });
    told.concat()
}

/// What may be spent and what gain is wanted, which choose motions of the front.
pub fn write_limits(text: &mut String, answer: &Answer) {
    let of = answer.of;
    let [budget, least_gain] = answer.limits;
    if let Some(most) = budget {
        let unit = match of.has_own_gain() {
            true => format!(" {}", of.cost.unit()),
            false => unit_behind(of.cost),
        };
        let kept = of_the_front(answer, |row| row.price <= most);
        let _ = writeln!(text, "budget: {} of {most:e}{unit} at most, {kept}", of.cost.name());
    }
    if let Some(least) = least_gain {
        let kept = of_the_front(answer, |row| answer.direction.of(row.gain) >= least);
        let wanted = match of.has_own_gain() {
            true => format!("speed wanted: {} mm/s", 1e3 * least),
            false => {
                format!("gain wanted: {} of {least:e}{}", of.gain.name(), unit_behind(of.gain))
            }
        };
        let _ = writeln!(text, "{wanted} at least, {kept}");
    }
}

/// How many motions of the front keep a limit, which chooses among them and leaves none out of it.
fn of_the_front(answer: &Answer, keeps: impl Fn(&Row) -> bool) -> String {
    let kept = answer.front.iter().filter(|row| keeps(row)).count();
    let all = counted(answer.front.len(), "motion");
    format!("which {} of the front's {all} keep; the front lists the others, too", count(kept))
}

/// A share in percent, without what rounding adds.
fn percent(share: f64) -> String {
    let text = format!("{:.9}", 100.0 * share);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
