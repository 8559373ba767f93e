//! What came of the cases, in a report: outcomes, periods, the attractors of starts and the special points of branches.

use std::collections::BTreeMap;

use super::computation::listed;
use super::html::{Page, Prose};
use super::numbers::{called, digits, percent, with_unit};
use super::table::{Cell, Column, Table};
use crate::campaign::CampaignError;
use crate::campaign::count::{count, counted};
use crate::description::Parameter;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR, BRANCH,
    BRANCH_POINT, INDEX, INDEX_REQUEST, OUTCOME, PERIOD, Place, SPECIAL_BRANCH, SPECIAL_KIND,
    SPECIAL_PERIOD,
};
use crate::store::{Archive, CaseTable, Column as Numbers, Variable};
use crate::study::Study;

/// So many periods have a row of their own: those of the most cases.
const PERIODS: usize = 12;
/// So many special points are shown.
const SPECIAL_POINTS: usize = 60;

/// Writes what came of the cases and of the branches.
pub fn write_outcomes(
    page: &mut Page,
    archive: &Archive,
    study: &Study,
) -> Result<(), CampaignError> {
    page.section("Outcomes");
    let table = CaseTable::of(archive)?;
    match &table {
        Some(table) => write_cases(page, table)?,
        None => {
            let none = "The file holds no cases of a sweep.";
            page.text(none);
            page.sum_up(none);
        }
    }
    write_attractors(page, archive)?;
    write_branches(page, archive, study)
}

fn write_cases(page: &mut Page, table: &CaseTable<'_>) -> Result<(), CampaignError> {
    let Some(outcomes) = table.column(OUTCOME.name)? else { return Ok(()) };
    let found = by_outcome(&outcomes);
    let all = table.cases();
    page.sum_up(in_words(&found, all));
    let rows = found.iter().map(|(name, number)| {
        let share = 100.0 * *number as f64 / all as f64;
        vec![Cell::text(name), Cell::text(count(*number)), Cell::text(percent(share))]
    });
    let own = Table {
        caption: "What the cases turned out to be.".to_owned(),
        columns: vec![
            Column::text(OUTCOME.name),
            Column::number("cases"),
            Column::number("share [%]"),
        ],
        rows: rows.collect(),
    };
    page.text(Prose::from("The outcomes of the cases are in ").see(page.next_table()).and("."));
    page.table(&own);
    if let Some(periods) = table.column(PERIOD.name)? {
        write_periods(page, &periods);
    }
    Ok(())
}

/// The outcomes in a sentence.
fn in_words(counted: &[(String, usize)], all: usize) -> String {
    match counted {
        [] => String::new(),
        [(name, _)] if all == 1 => format!("It is {name}."),
        [(name, _)] => format!("All of them are {name}."),
        [(name, number), others @ ..] => {
            let verb = if *number == 1 { "is" } else { "are" };
            let first = format!("{} {verb} {name}", count(*number));
            let others = others.iter().map(|(name, number)| format!("{} {name}", count(*number)));
            let told: Vec<String> = [first].into_iter().chain(others).collect();
            format!("Of them {}.", listed(&told))
        }
    }
}

/// How many cases have each outcome that there is.
fn by_outcome(outcomes: &Numbers) -> Vec<(String, usize)> {
    let counts = outcomes.flags.iter().map(|(code, name)| {
        (name.clone(), outcomes.values.iter().filter(|it| **it == *code as f64).count())
    });
    counts.filter(|(_, number)| *number > 0).collect()
}

/// How many cases have each period, where there are several.
fn write_periods(page: &mut Page, periods: &Numbers) {
    let mut counts = BTreeMap::<u64, usize>::new();
    for period in periods.values.iter().filter(|it| **it >= 1.0) {
        *counts.entry(*period as u64).or_default() += 1;
    }
    if counts.len() < 2 {
        return;
    }
    let longest = counts.keys().next_back().copied().unwrap_or(0);
    let mut most: Vec<(u64, usize)> = counts.iter().map(|(it, number)| (*it, *number)).collect();
    most.sort_by_key(|(_, number)| std::cmp::Reverse(*number));
    most.truncate(PERIODS);
    most.sort_unstable();
    let left: usize = counts.values().sum::<usize>() - most.iter().map(|it| it.1).sum::<usize>();
    let others = match counts.len() - most.len() {
        0 => String::new(),
        kinds => format!(
            " The {PERIODS} periods of the most cases are shown; {kinds} others, up to {longest} cycles, have {}.",
            counted(left, "case")
        ),
    };
    let rows = most
        .iter()
        .map(|(period, number)| vec![Cell::text(period.to_string()), Cell::text(count(*number))]);
    page.table(&Table {
        caption: format!("Periods of the cases that repeat.{others}"),
        columns: vec![Column::number("period [cycles]"), Column::number("cases")],
        rows: rows.collect(),
    });
}

/// The numbers of a variable; empty where the file does not have it.
fn numbers(archive: &Archive, name: &str) -> Result<Vec<f64>, CampaignError> {
    let variable = archive.variable(name)?;
    Ok(variable.map_or(Vec::new(), |it| it.values.to_real().into_iter().collect()))
}

/// The names that the numbers of a category stand for.
fn names(variable: &Variable) -> Vec<String> {
    variable.names().into_iter().map(|it| it.unwrap_or_default().to_owned()).collect()
}

/// The attractors of starts, where the file has one table of them.
fn write_attractors(page: &mut Page, archive: &Archive) -> Result<(), CampaignError> {
    let kinds = archive.variable(ATTRACTOR_KIND.name)?;
    let Some(kinds) = kinds.filter(|it| it.values.shape().len() == 1) else { return Ok(()) };
    let kinds = names(&kinds);
    let [periods, shares, errors] = [ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR]
        .map(|entry| numbers(archive, entry.name));
    let (periods, shares, errors) = (periods?, shares?, errors?);
    let outputs = archive.frame().model().gain_and_work();
    let mut values = Vec::new();
    for output in &outputs {
        values.push(numbers(archive, &Place::Attractor.name(output.name()))?);
    }
    let rows = kinds.iter().enumerate().map(|(number, kind)| {
        let of = |all: &[f64]| all.get(number).copied().filter(|it| it.is_finite());
        let shown = |value: Option<f64>| Cell::text(value.map_or(String::new(), digits));
        let period =
            of(&periods).filter(|it| *it >= 1.0).map_or(String::new(), |it| it.to_string());
        let first = [Cell::text(number.to_string()), Cell::text(kind), Cell::text(period)];
        let percent_of =
            |all: &[f64]| Cell::text(of(all).map_or(String::new(), |it| percent(100.0 * it)));
        let last = [percent_of(&shares), percent_of(&errors)];
        let measured = values.iter().map(|all| shown(of(all)));
        first.into_iter().chain(measured).chain(last).collect()
    });
    let first =
        [Column::number(ATTRACTOR.name), Column::text("motion"), Column::number("period [cycles]")];
    let measured =
        outputs.iter().map(|it| Column::number(&with_unit(&called(it.quantity()), it.unit())));
    let last = [Column::number("share of the starts [%]"), Column::number("standard error [%]")];
    let table = Table {
        caption: "Attractors of the starts, by their numbers in the file, and the shares of the starts that lead to them.".to_owned(),
        columns: first.into_iter().chain(measured).chain(last).collect(),
        rows: rows.collect(),
    };
    let shares: Vec<String> =
        shares.iter().map(|it| format!("{}\u{a0}%", percent(100.0 * it))).collect();
    let sentence = format!("The starts lead to {}", counted(kinds.len(), ATTRACTOR.name));
    page.sum_up(match shares.len() {
        2.. => format!("{sentence}, with shares of {} of the starts.", listed(&shares)),
        _ => format!("{sentence}."),
    });
    page.text(Prose::from(format!("{sentence} (")).see(page.next_table()).and(")."));
    page.table(&table.without_empty_columns());
    Ok(())
}

/// How many orbits were continued, and the points where they change.
fn write_branches(page: &mut Page, archive: &Archive, study: &Study) -> Result<(), CampaignError> {
    let length = |name: &str| archive.frame().coordinate(name).map_or(0, |it| it.values.shape()[0]);
    let (branches, points) = (length(INDEX.name), length(BRANCH_POINT.name));
    if branches == 0 {
        return Ok(());
    }
    let kinds = archive.variable(SPECIAL_KIND.name)?.map_or(Vec::new(), |it| names(&it));
    let plural = if branches == 1 { BRANCH.name } else { "branches" };
    let sentence = format!(
        "{} periodic orbits on {} {plural} were found by continuation, with {} special points",
        count(points),
        count(branches),
        count(kinds.len())
    );
    page.sum_up(format!("{sentence}."));
    if kinds.is_empty() {
        page.text(format!("{sentence}."));
        return Ok(());
    }
    page.text(Prose::from(format!("{sentence} (")).see(page.next_table()).and(")."));
    page.table(&special_points(archive, study, &kinds)?.without_empty_columns());
    Ok(())
}

/// Where the orbits of branches change.
fn special_points(
    archive: &Archive,
    study: &Study,
    kinds: &[String],
) -> Result<Table, CampaignError> {
    let of_branch = numbers(archive, SPECIAL_BRANCH.name)?;
    let requests = numbers(archive, INDEX_REQUEST.name)?;
    let periods = numbers(archive, SPECIAL_PERIOD.name)?;
    let mut along: Vec<Parameter> = Vec::new();
    for branch in &study.branches {
        if !along.contains(&branch.along) {
            along.push(branch.along);
        }
    }
    let mut places = Vec::new();
    for parameter in &along {
        places.push(numbers(archive, &Place::Special.name(parameter.symbol()))?);
    }
    let rows = kinds.iter().take(SPECIAL_POINTS).enumerate().map(|(number, kind)| {
        let branch = of_branch.get(number).map(|it| *it as usize);
        let request = branch.and_then(|it| requests.get(it)).map(|it| *it as usize);
        let name = request.and_then(|it| study.branches.get(it)).map_or("", |it| it.name.as_str());
        let name = branch.map_or(String::new(), |it| match name {
            "" => (it + 1).to_string(),
            name => format!("{} ({name})", it + 1),
        });
        let values = places.iter().map(|all| {
            let value = all.get(number).filter(|it| it.is_finite());
            Cell::text(value.map_or(String::new(), |it| digits(*it)))
        });
        let period = periods.get(number).map_or(String::new(), |it| it.to_string());
        let first = [Cell::text(name), Cell::text(kind)];
        let last = [Cell::text(period)];
        first.into_iter().chain(values).chain(last).collect()
    });
    let left_out = match kinds.len().saturating_sub(SPECIAL_POINTS) {
        0 => String::new(),
        more => format!(" The first {SPECIAL_POINTS}; {} more are in the file.", count(more)),
    };
    let first = [Column::text(BRANCH.name), Column::text("special point")];
    let measured =
        along.iter().map(|it| Column::number(&with_unit(it.symbol(), it.dimension().unit())));
    let last = [Column::number("period [cycles]")];
    Ok(Table {
        caption: format!("Special points of the branches, in the order of the file.{left_out}"),
        columns: first.into_iter().chain(measured).chain(last).collect(),
        rows: rows.collect(),
    })
}
