//! What was computed, in a report: which cases, what varies and what is held, from which start, by which protocol.

use super::escaped::symbol;
use super::html::{Page, Prose};
use super::numbers::{called, measured, number, unit};
use super::table::{Cell, Column, Table};
use crate::campaign::count::{count, counted};
use crate::description::State;
use crate::orbit::{Exponents, Protocol};
use crate::study::draws::Range;
use crate::study::{Axis, CaseSet, Coordinate, Draws, Study};

/// Writes it; with the number of cases of the file, where it has any.
pub fn write_computation(page: &mut Page, study: &Study, cases: Option<usize>) {
    page.section("What was computed");
    if let Some(cases) = cases {
        page.sum_up(format!("{}.", cases_in_words(&study.case_set, cases)));
        let text =
            Prose::from(format!("{}; what varies is in ", cases_in_words(&study.case_set, cases)));
        page.text(text.see(page.next_table()).and(&format!(".{}", start_in_words(study))));
        write_varied(page, study);
    }
    write_held(page, study);
    write_protocol(page, study);
}

/// How many cases there are, and of what.
fn cases_in_words(case_set: &CaseSet, cases: usize) -> String {
    let number = counted(cases, "case");
    match case_set {
        CaseSet::Draws(Draws { ranges, kind, .. }) => {
            let of: Vec<&str> = ranges.iter().map(|it| it.coordinate.name()).collect();
            format!("The file has {number}, drawn ({}) from ranges of {}", kind.name(), listed(&of))
        }
        CaseSet::Grid(grid) if grid.axes.is_empty() => format!("The file has {number}"),
        CaseSet::Grid(grid) => {
            let axes: Vec<String> = grid.axes.iter().map(axis_in_words).collect();
            let each = if axes.len() > 1 { "each combination of " } else { "" };
            let directions = grid.direction_axis().map(|all| {
                let names: Vec<&str> = all.iter().map(|it| it.name()).collect();
                format!(", in the directions {}", listed(&names))
            });
            let directions = directions.unwrap_or_default();
            format!("The file has {number}: {each}{}{directions}", listed(&axes))
        }
    }
}

/// The values of an axis.
fn axis_in_words(axis: &Axis) -> String {
    let places = count(axis.places());
    match (&axis.path, axis.single()) {
        (None, Some(varying)) => {
            let coordinate = varying.coordinate;
            let ends = varying.values.iter().copied();
            let low = ends.clone().fold(f64::INFINITY, f64::min);
            let high = ends.fold(f64::NEG_INFINITY, f64::max);
            let unit = coordinate.dimension().unit();
            format!(
                "{places} values of {} from {} to {} ({})",
                coordinate.name(),
                number(low),
                measured(high, unit),
                phrase(coordinate)
            )
        }
        _ => {
            let along: Vec<&str> = axis.coordinates().map(Coordinate::name).collect();
            format!(
                "{places} places along the path {}, on which {} vary together",
                axis.name(),
                listed(&along)
            )
        }
    }
}

/// What a coordinate is, in a phrase; where its model has no words for it, its name.
fn phrase(coordinate: Coordinate) -> String {
    match coordinate.meaning() {
        "" => called(coordinate.quantity()),
        meaning => meaning.to_owned(),
    }
}

/// From where the cases start, if they do not all start as the study says.
fn start_in_words(study: &Study) -> String {
    let Some(inherit) = study.inherit() else { return String::new() };
    let Some(axis) = study.axes().get(inherit.axis) else { return String::new() };
    let directions: Vec<&str> = inherit.directions.iter().map(|it| it.name()).collect();
    format!(
        " Along {} a case starts where its neighbour has settled ({}).",
        axis.name(),
        directions.join(", ")
    )
}

/// Words with commas, and with "and" before the last.
pub fn listed<T: AsRef<str>>(words: &[T]) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match &words[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => words.concat(),
    }
}

/// The first cells of a row about a coordinate: its name, its symbol and what it is.
fn about(coordinate: Coordinate) -> [Cell; 3] {
    let shown = coordinate.quantity().shown;
    let symbol = Cell::html(shown.map_or(String::new(), |it| symbol(it.symbol)));
    [Cell::text(coordinate.name()), symbol, Cell::text(coordinate.meaning())]
}

fn columns_about() -> [Column; 3] {
    [Column::text("name"), Column::text("symbol"), Column::long("meaning")]
}

fn write_varied(page: &mut Page, study: &Study) {
    let varied = study.case_set.varied();
    let rows = varied.iter().map(|coordinate| {
        let [low, high] = match study.case_set.ends(*coordinate) {
            Some(ends) => ends.map(|it| Cell::text(number(it))),
            None => [Cell::default(), Cell::default()],
        };
        let how = Cell::text(spread(study, *coordinate));
        let more = [low, high, Cell::text(unit(*coordinate)), how];
        about(*coordinate).into_iter().chain(more).collect()
    });
    let more = [
        Column::number("from"),
        Column::number("to"),
        Column::text("unit"),
        Column::text("values"),
    ];
    let rows: Vec<_> = rows.collect();
    let caption = match rows.is_empty() {
        true => "What varies among the cases: nothing.",
        false => "What varies among the cases.",
    };
    let columns = columns_about().into_iter().chain(more).collect();
    let table = Table { caption: caption.to_owned(), columns, rows };
    page.table(&table.without_empty_columns());
}

/// How the values of a coordinate lie.
fn spread(study: &Study, coordinate: Coordinate) -> String {
    match &study.case_set {
        CaseSet::Grid(grid) => {
            let axis = grid.axes.iter().find(|it| it.values_of(coordinate).is_some());
            axis.map_or(String::new(), |axis| match &axis.path {
                Some(path) => format!("{} along {path}", count(axis.places())),
                None => count(axis.places()),
            })
        }
        CaseSet::Draws(draws) => {
            let range = draws.ranges.iter().find(|it| it.coordinate == coordinate);
            range.map_or(String::new(), |range| distribution(range, draws))
        }
    }
}

fn distribution(range: &Range, draws: &Draws) -> String {
    let of = match range.normal {
        Some(normal) => {
            format!("normal, mean {}, deviation {}", number(normal.mean), number(normal.deviation))
        }
        None => format!("{} spacing", range.spacing.name()),
    };
    format!("{} drawn, {of}", count(draws.count))
}

/// The parameters and starts that do not vary.
fn write_held(page: &mut Page, study: &Study) {
    let varied = study.case_set.varied();
    let base = &study.base;
    let model = base.model();
    let parameters = base.stated().map(|(it, value)| (Coordinate::Parameter(it), value));
    let held = parameters.chain(starts(study)).filter(|(it, _)| !varied.contains(it));
    let rows = held.map(|(it, value)| {
        let more = [Cell::text(number(value)), Cell::text(unit(it))];
        about(it).into_iter().chain(more).collect()
    });
    let columns =
        columns_about().into_iter().chain([Column::number("value"), Column::text("unit")]);
    let table = Table {
        caption: "What is held.".to_owned(),
        columns: columns.collect(),
        rows: rows.collect(),
    };
    page.subsection("What is held");
    let choices = base.choices().map(|(name, chosen)| {
        let title = model.choices.iter().find(|it| it.name == name).map_or(name, |it| it.title);
        format!(" {title}: {chosen}.")
    });
    let choices: String = choices.collect();
    let of = format!(
        "The model is {}. Its parameters and the start of its cases, as far as they do not vary, are in ",
        model.name
    );
    page.text(Prose::from(of).see(page.next_table()).and(&format!(".{choices}")));
    page.table(&table.without_empty_columns());
}

/// The start of the cases as the study says it.
fn starts(study: &Study) -> impl Iterator<Item = (Coordinate, f64)> {
    let model = study.base.model();
    let start: &State = &study.start;
    let of_state = model.start_coordinates().map(move |it| (Coordinate::Start(it), start[it]));
    let of_phases = Coordinate::phases(model).map(|it| match it {
        Coordinate::StartPhase => (it, study.start_phase),
        _ => (it, study.section_phase),
    });
    of_state.chain(of_phases)
}

/// How the cases are followed and judged.
fn write_protocol(page: &mut Page, study: &Study) {
    let Protocol {
        tolerance,
        recurrence,
        max_cycles,
        max_period,
        measured_cycles,
        exponent_cycles,
        ..
    } = study.protocol;
    let mut settings = vec![
        ("relative local error of a step", format!("{tolerance:e}")),
        ("how closely the section must repeat, relative to its size", format!("{recurrence:e}")),
        (
            "after how long a case that has not settled is undecided [cycles]",
            count(max_cycles as usize),
        ),
        ("longest period looked for while a motion settles [cycles]", count(max_period)),
        (
            "over how long a motion that does not repeat is measured [cycles]",
            count(measured_cycles as usize),
        ),
        ("over how long an exponent is computed at most [cycles]", count(exponent_cycles as usize)),
    ];
    if study.protocol.exponents != Exponents::Largest {
        settings.push(("exponents that are computed", study.protocol.exponents.name().to_owned()));
    }
    if let Some(error) = study.protocol.mean_error {
        settings.push(("relative standard error wanted of a mean", format!("{error:e}")));
    }
    let rows = settings.into_iter().map(|(what, value)| vec![Cell::text(what), Cell::text(value)]);
    let table = Table {
        caption: "The protocol of the cases.".to_owned(),
        columns: vec![Column::long("setting"), Column::number("value")],
        rows: rows.collect(),
    };
    page.subsection("Protocol");
    page.text(
        Prose::from("How a case is followed and judged is in ").see(page.next_table()).and("."),
    );
    page.table(&table);
}
