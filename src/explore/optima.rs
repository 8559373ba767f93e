//! The optima of a report: tables, commands that compute them again, and their motions.

use super::computation::listed;
use super::html::{Page, Prose};
use super::numbers::{called, measured};
use super::optima_tables::{front, margins, optima, sensitivities};
use super::optimum::{Drawings, Undrawn, drawings};
use super::request::Request;
use crate::campaign::count::counted;
use crate::campaign::{
    Answer, Between, CampaignError, KeptFront, Named, Refined, Row, TradeOff, silent,
};
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
    page.subsection(&format!("{moving}{under}"));
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
            page.text(format!("No optima: {}.", faults.join("; ")));
            Ok(())
        }
        Err(error) => Err(error),
        Ok(answer) if answer.front.is_empty() => {
            page.text("No motion.");
            Ok(())
        }
        Ok(answer) => {
            if condition.is_none() {
                page.sum_up(best_in_words(&answer, &moving));
            }
            write_answer(page, study, &answer, &format!("{}{under}", direction.name()))
        }
    }
}

/// Motions that are the best in something, each once.
fn each_once(answer: &Answer) -> Vec<(String, Row)> {
    let mut named: Vec<(String, Row)> = Vec::new();
    for Named { name, row } in &answer.named {
        let Some(row) = row else { continue };
        let name = name.replace('_', " ");
        match named.iter_mut().find(|(_, it)| it.replay == row.replay) {
            Some((others, _)) => *others += &format!("{AND}{name}"),
            None => named.push((name, row.clone())),
        }
    }
    named
}

/// Between the names of a motion that is the best in several things.
const AND: &str = " and ";

/// A motion in a sentence, by what it is the best in.
fn phrase(name: &str) -> String {
    let mut words = name.split(AND).map(|it| match it {
        "fastest" => "fastest".to_owned(),
        "knee" => "at the knee".to_owned(),
        other => format!("with the {other}"),
    });
    let first = words.next().unwrap_or_default();
    let others: Vec<String> = words.collect();
    let more =
        if others.is_empty() { String::new() } else { format!(" (also {})", listed(&others)) };
    match first.as_str() {
        "fastest" => format!("fastest motion{more}"),
        place => format!("motion {place}{more}"),
    }
}

/// Writes the optima that were found; `moving` tells their direction and condition.
fn write_answer(
    page: &mut Page,
    study: &Study,
    answer: &Answer,
    moving: &str,
) -> Result<(), CampaignError> {
    let named = each_once(answer);
    page.text(front_in_words(answer));
    let best = Prose::from("The best motions are in ").see(page.next_table());
    page.text(best.and("; each can be computed again by its command below."));
    page.table(&optima(&named, answer.of, moving));
    if let Some(table) = sensitivities(&named, answer.of, moving) {
        page.table(&table);
    }
    if let Some(table) = margins(&named, study.base.model(), moving) {
        page.table(&table);
    }
    if answer.front.len() > 1 {
        page.table(&front(answer, moving));
    }
    let replays: Vec<&str> = named.iter().map(|(_, row)| row.replay.as_str()).collect();
    page.text("To compute the best motions again:");
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
                let where_it_is = match row.case {
                    Some(case) => format!("case {case}"),
                    None => "between the cases".to_owned(),
                };
                let caption = format!(
                    "The {}, {moving} ({where_it_is}): displacements and velocities over {cycles} cycles of the drive, and \
                     the phase portrait of the relative motion.",
                    phrase(name)
                );
                page.pictures(&pictures, &caption);
            }
            Ok(None) => page.note(&format!("{name}: does not repeat, and is not drawn.")),
            Err(Undrawn::Figure(error)) => page.note(&format!("{name}: not drawn: {error}")),
            Err(Undrawn::Run(error)) => return Err(error.into()),
        }
    }
    Ok(())
}

/// The best motions in a sentence.
fn best_in_words(answer: &Answer, moving: &str) -> String {
    let of = answer.of;
    let told = each_once(answer).into_iter().map(|(name, row)| {
        let varied = row.coordinates.iter().filter(|(_, _, varies)| *varies);
        let at: Vec<String> = varied
            .map(|(it, value, _)| {
                format!("{} = {}", it.name(), measured(*value, it.dimension().unit()))
            })
            .collect();
        let at = if at.is_empty() { String::new() } else { format!(" at {}", listed(&at)) };
        let [gain, cost] = [(of.gain, row.gain), (of.cost, row.price)].map(|(output, value)| {
            format!("a {} of {}", called(output.quantity()), measured(value, output.unit()))
        });
        format!("the {} has {gain} and {cost}{at}", phrase(&name))
    });
    let told: Vec<String> = told.collect();
    let front = counted(answer.front.len(), "motion");
    format!("{moving}, the Pareto front has {front}: {}.", told.join("; "))
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
    let without = match of.has_own_gain() {
        true => format!("Motions of no more than {at_rest:.1e} m/s count as at rest."),
        false => {
            format!("A gain of no more than {at_rest:.1e}{} counts as none.", unit_behind(of.gain))
        }
    };
    format!(
        "The Pareto front of {} ({}) and {}{condition} has {}, {between} of them between the cases.{searched}{left_out} \
         {without}",
        gain_in_words(of),
        answer.direction.name(),
        called(of.cost.quantity()),
        counted(answer.front.len(), "motion")
    )
}

/// The gain, as a sentence calls it.
pub fn gain_in_words(of: GainAndCost) -> String {
    called(of.gain.quantity())
}
