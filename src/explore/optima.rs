//! The optima of a report: a table, sensitivities, commands that compute them again, and their motions.

use super::html::Page;
use super::numbers::{number, percent, unit};
use super::optimum::{Drawings, Undrawn, drawings};
use super::request::Request;
use crate::campaign::{
    Answer, Between, CampaignError, KeptFront, Margins, Named, Refined, Row, TradeOff, silent,
};
use crate::description::{Description, Parameter};
use crate::study::Study;
use crate::tradeoff::{Direction, GainAndCost, unit_behind};

/// Writes the optima in a direction, of the cases and of what was found between them, if anything was sought: those that keep its
/// conditions.
pub fn write_optima(
    page: &mut Page,
    request: &Request<'_>,
    study: &Study,
    front: Option<&KeptFront>,
    direction: Direction,
) -> Result<(), CampaignError> {
    let Request { archive, file, of } = *request;
    let condition = front.map(KeptFront::condition).filter(|it| !it.is_empty());
    let under = condition.as_ref().map_or(String::new(), |it| format!(", where {it}"));
    let moving = match of.has_own_gain() {
        true => format!("Moving {}", direction.name()),
        false => format!("{}, {}", of.gain.name(), direction.name()),
    };
    page.heading(&format!("{moving}{under}"));
    let trade_off = TradeOff {
        archive,
        file,
        of,
        direction,
        conditions: condition.as_deref(),
        at_rest: None,
        budget: None,
        least_gain: None,
        top: 0,
        slopes: false,
        between: front.map_or(Between::Nothing, Between::Known),
        under: None,
        margins: true,
        threads: None,
    };
    match trade_off.answer(&silent) {
        Err(CampaignError::TradeOff { faults, .. }) => {
            page.text(&format!("No optima: {}.", faults.join("; ")));
            Ok(())
        }
        Err(error) => Err(error),
        Ok(answer) if answer.front.is_empty() => {
            page.text("No motion.");
            Ok(())
        }
        Ok(answer) => write_answer(page, study, &answer, &format!("{}{under}", direction.name())),
    }
}

/// Writes the optima that were found; `moving` tells their direction and condition.
fn write_answer(
    page: &mut Page,
    study: &Study,
    answer: &Answer,
    moving: &str,
) -> Result<(), CampaignError> {
    page.text(&front_in_words(answer));
    let rows = answer
        .named
        .iter()
        .filter_map(|Named { name, row }| Some((name.replace('_', " "), row.clone()?)));
    let named: Vec<(String, Row)> = rows.collect();
    write_table(page, &named, answer.of);
    write_sensitivities(page, &named, answer.of);
    write_margins(page, &named, study.base.model());
    let replays: Vec<&str> = named.iter().map(|(_, row)| row.replay.as_str()).collect();
    page.text("To compute them again:");
    page.verbatim(&replays.join("\n"));
    write_motions(page, &named, study, moving)
}

/// Draws the motions of the optima; without a drive there are no cycles to draw.
fn write_motions(
    page: &mut Page,
    named: &[(String, Row)],
    study: &Study,
    moving: &str,
) -> Result<(), CampaignError> {
    if !study.base.model().keeps_histories() {
        page.note("Motions without a drive are not drawn.");
        return Ok(());
    }
    for (name, row) in named {
        match drawings(row, study) {
            Ok(Some(Drawings { pictures, cycles })) => {
                let caption = format!("{name}, {moving}: {cycles} cycles of the drive");
                page.pictures(&pictures, &caption);
            }
            Ok(None) => page.note(&format!("{name}: does not repeat, and is not drawn.")),
            Err(Undrawn::Figure(error)) => page.note(&format!("{name}: not drawn: {error}")),
            Err(Undrawn::Run(error)) => return Err(error.into()),
        }
    }
    Ok(())
}

/// The front, what takes part in it and what does not.
fn front_in_words(answer: &Answer) -> String {
    let between = answer.front.iter().filter(|row| row.case.is_none()).count();
    let left_out: Vec<String> =
        answer.left_out.iter().map(|(why, count)| format!("{count} {why}")).collect();
    let left_out = if left_out.is_empty() {
        String::new()
    } else {
        format!(" Cases left out: {}.", left_out.join(", "))
    };
    let condition = match answer.conditions.is_empty() {
        true => String::new(),
        false => format!(" where {}", answer.conditions.join(" and ")),
    };
    let searched = match &answer.refined {
        Some(Refined { searched, found, .. }) => format!(
            " Between the cases {} led to {found} motions under these conditions; each search is local, and a better motion may lie \
             elsewhere.",
            searched.in_words()
        ),
        None => " No motion was sought between the cases.".to_owned(),
    };
    let (of, at_rest) = (answer.of, answer.at_rest.0);
    let (gain, without) = match of.has_own_gain() {
        true => (
            "progression speed",
            format!("Motions of no more than {at_rest:.1e} m/s count as at rest."),
        ),
        false => (
            of.gain.name(),
            format!("A gain of no more than {at_rest:.1e}{} counts as none.", unit_behind(of.gain)),
        ),
    };
    format!(
        "The Pareto front of {gain} ({}) and {}{condition} has {} motions, {between} of them between the cases.{searched}{left_out} \
         {without}",
        answer.direction.name(),
        of.cost.name(),
        answer.front.len()
    )
}

/// The optima side by side: what they give, what holds them, and where they are.
fn write_table(page: &mut Page, named: &[(String, Row)], of: GainAndCost) {
    let Some((_, first)) = named.first() else { return };
    let (gain, per_gain) = match of.has_own_gain() {
        true => ("progression speed [m/s]".to_owned(), "energy per metre [J/m]"),
        false => (format!("{} [{}]", of.gain.name(), of.gain.unit()), "cost per gain"),
    };
    let mut rows = vec![
        line(&gain, named, |row| {
            let error = row.errors.map(|it| format!(" \u{b1} {}", number(it.gain)));
            number(row.gain) + &error.unwrap_or_default()
        }),
        line(&format!("{} [{}]", of.cost.name(), of.cost.unit()), named, |row| number(row.price)),
    ];
    if of.told_per_gain() != Some(of.cost) {
        rows.push(line(per_gain, named, |row| number(row.per_gain)));
    }
    rows.push(line("motion", named, |row| match row.period {
        Some(period) => format!("period {period}"),
        None => format!("{}, by its mean", row.outcome),
    }));
    for (place, (coordinate, _, varies)) in first.coordinates.iter().enumerate() {
        let label = format!("{} [{}]", coordinate.name(), unit(*coordinate));
        if *varies {
            rows.push(line(&label, named, |row| {
                row.coordinates.get(place).map_or(String::new(), |it| number(it.1))
            }));
        }
    }
    rows.push(line("case", named, |row| {
        row.case.map_or("between cases".to_owned(), |it| it.to_string())
    }));
    rows.push(line("active constraint", named, |row| row.slopes.held_by.join(", ")));
    rows.push(line("relative gradient left", named, |row| {
        row.slopes.stationarity.map_or(String::new(), |it| format!("{it:.1e}"))
    }));
    let names = named.iter().map(|(name, _)| name.clone());
    let headings: Vec<String> = [String::new()].into_iter().chain(names).collect();
    page.table(&headings, &rows);
}

/// By how many percent gain and price of the motions between the cases change per percent of each parameter.
fn write_sensitivities(page: &mut Page, named: &[(String, Row)], of: GainAndCost) {
    let known: Vec<&(String, Row)> =
        named.iter().filter(|(_, row)| !row.slopes.sensitivity.is_empty()).collect();
    let Some((_, first)) = known.first() else { return };
    let gain = if of.has_own_gain() { "speed" } else { of.gain.name() };
    let outputs = [gain, of.cost.name()];
    let columns = known.iter().flat_map(|(name, _)| outputs.map(|it| format!("{it}, {name}")));
    let rows = first.slopes.sensitivity.iter().map(|(parameter, _)| {
        let cells = known.iter().flat_map(|(_, row)| sensitivity(row, *parameter).map(percent));
        [parameter.symbol().to_owned()].into_iter().chain(cells).collect()
    });
    let rows: Vec<Vec<String>> = rows.collect();
    page.text(
        "Change in percent per percent of each parameter. At a kink the change is another on its other side; that told is of the \
         sequence of events of the motion:",
    );
    let headings: Vec<String> = [String::new()].into_iter().chain(columns).collect();
    page.table(&headings, &rows);
}

/// By how many percent gain and price of a motion change per percent of a parameter; NaN where that is not known.
fn sensitivity(row: &Row, parameter: Parameter) -> [f64; 2] {
    let known = row.slopes.sensitivity.iter().find(|(other, _)| *other == parameter);
    known.map_or([f64::NAN; 2], |(_, both)| *both)
}

/// How far the parameters of the optima may change before these end.
fn write_margins(page: &mut Page, named: &[(String, Row)], model: &'static Description) {
    let known: Vec<&(String, Row)> =
        named.iter().filter(|(_, row)| !row.margins.is_empty()).collect();
    if known.is_empty() {
        return;
    }
    let rows: Vec<Vec<String>> =
        model.parameters().filter_map(|parameter| margin_line(&known, parameter)).collect();
    let columns =
        known.iter().flat_map(|(name, _)| ["falling", "rising"].map(|it| format!("{name}, {it}")));
    let headings: Vec<String> = [String::new()].into_iter().chain(columns).collect();
    page.text(
        "Where each motion ends or loses its stability as one parameter falls or rises, by a half at most; `tradeoff --margins` \
         tells the changes of events on the way, too:",
    );
    page.table(&headings, &rows);
}

/// The line of a parameter: where each motion ends along it; none where that is known of no motion.
fn margin_line(motions: &[&(String, Row)], parameter: Parameter) -> Option<Vec<String>> {
    let margins =
        motions.iter().map(|(_, row)| row.margins.iter().find(|it| it.parameter == parameter));
    let ends: Vec<Option<[String; 2]>> = margins.map(|it| it.map(Margins::ends)).collect();
    let is_known = ends.iter().any(Option::is_some);
    let cells = ends.into_iter().flat_map(Option::unwrap_or_default);
    is_known.then(|| [parameter.symbol().to_owned()].into_iter().chain(cells).collect())
}

/// A line of a table: its name, and a cell for each optimum.
fn line(name: &str, named: &[(String, Row)], cell: impl Fn(&Row) -> String) -> Vec<String> {
    let cells = named.iter().map(|(_, row)| cell(row));
    [name.to_owned()].into_iter().chain(cells).collect()
}
