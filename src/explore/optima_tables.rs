//! The tables of the optima of a report: what they are, what changes them, what ends them, and the front on which they lie.

use super::numbers::{called, digits, number, percent, with_unit};
use super::table::{Cell, Column, Table};
use crate::campaign::count::count;
use crate::campaign::{Answer, Margin, MarginEnd, Margins, Row};
use crate::description::{Description, Output, Parameter};
use crate::tradeoff::GainAndCost;

/// So many motions of a front are shown.
const FRONT: usize = 25;

/// The columns of what motions gain and cost.
fn gains_and_costs(of: GainAndCost) -> Vec<Column> {
    let heading = |output: Output| with_unit(&called(output.quantity()), output.unit());
    let [gain, cost] = of.both().map(|it| Column::number(&heading(it)));
    let per_gain = of.told_per_gain().map_or("cost per gain".to_owned(), heading);
    let own = (of.told_per_gain() != Some(of.cost)).then(|| Column::number(&per_gain));
    let error = format!("standard error of the {}", called(of.gain.quantity()));
    let error = Column::number(&with_unit(&error, of.gain.unit()));
    [gain, cost].into_iter().chain(own).chain([error]).collect()
}

/// The cells of these columns.
fn gain_and_cost(row: &Row, of: GainAndCost) -> Vec<Cell> {
    let per_gain = (of.told_per_gain() != Some(of.cost)).then(|| Cell::text(digits(row.per_gain)));
    let error = row.errors.as_ref().map_or(String::new(), |it| format!("{:.1e}", it.gain));
    let both = [row.gain, row.price].map(|it| Cell::text(digits(it)));
    both.into_iter().chain(per_gain).chain([Cell::text(error)]).collect()
}

/// The columns of what varies; none without motions.
fn varied(rows: &[&Row]) -> Vec<Column> {
    let coordinates = rows.first().map_or(&[][..], |row| &row.coordinates);
    let varied = coordinates.iter().filter(|(_, _, varies)| *varies);
    varied.map(|(it, ..)| Column::number(&with_unit(it.name(), it.dimension().unit()))).collect()
}

/// The values of what varies.
fn values(row: &Row) -> impl Iterator<Item = Cell> {
    let varied = row.coordinates.iter().filter(|(_, _, varies)| *varies);
    varied.map(|(_, value, _)| Cell::text(number(*value)))
}

/// How a motion repeats.
fn motion(row: &Row) -> String {
    match row.period {
        Some(period) => format!("period {period}"),
        None => format!("{}, by its mean", row.outcome),
    }
}

fn case(row: &Row) -> Cell {
    match row.case {
        Some(case) => Cell::text(case.to_string()),
        None => Cell::valued("between cases", f64::NAN),
    }
}

/// The optima: what they give, what holds them, and where they are.
pub fn optima(named: &[(String, Row)], of: GainAndCost, moving: &str) -> Table {
    let rows: Vec<&Row> = named.iter().map(|(_, row)| row).collect();
    let last = ["active constraint", "relative gradient left"];
    let columns = [Column::text("best in")]
        .into_iter()
        .chain(gains_and_costs(of))
        .chain(varied(&rows))
        .chain([Column::text("motion"), Column::number("case")])
        .chain([Column::text(last[0]), Column::number(last[1])]);
    let cells = named.iter().map(|(name, row)| {
        let gradient = row.slopes.stationarity.map_or(String::new(), |it| format!("{it:.1e}"));
        [Cell::text(name)]
            .into_iter()
            .chain(gain_and_cost(row, of))
            .chain(values(row))
            .chain([Cell::text(motion(row)), case(row)])
            .chain([Cell::text(row.slopes.held_by.join(", ")), Cell::text(gradient)])
            .collect()
    });
    let table = Table {
        caption: format!("The best motions, {moving}."),
        columns: columns.collect(),
        rows: cells.collect(),
    };
    table.without_empty_columns()
}

/// Motions of the front, by rising cost.
pub fn front(answer: &Answer, moving: &str) -> Table {
    let all: Vec<&Row> = answer.front.iter().collect();
    let shown: Vec<&Row> = match all.len() {
        ..=FRONT => all.clone(),
        many => (0..FRONT).map(|it| all[it * (many - 1) / (FRONT - 1)]).collect(),
    };
    let refine = if answer.refined.is_some() { " --refine" } else { "" };
    let how_many = match all.len() > FRONT {
        true => format!(
            " {FRONT} of its {} motions, the first and the last among them; `capsulemap tradeoff{refine} --csv` lists all.",
            count(all.len())
        ),
        false => String::new(),
    };
    let columns = gains_and_costs(answer.of)
        .into_iter()
        .chain(varied(&shown))
        .chain([Column::text("motion"), Column::number("case")]);
    let rows = shown.iter().map(|row| {
        let first = gain_and_cost(row, answer.of).into_iter().chain(values(row));
        first.chain([Cell::text(motion(row)), case(row)]).collect()
    });
    let table = Table {
        caption: format!("The Pareto front, {moving}, by rising cost.{how_many}"),
        columns: columns.collect(),
        rows: rows.collect(),
    };
    table.without_empty_columns()
}

/// By how many percent gain and price of the motions between the cases change per percent of each parameter.
pub fn sensitivities(named: &[(String, Row)], of: GainAndCost, moving: &str) -> Option<Table> {
    let known: Vec<&(String, Row)> =
        named.iter().filter(|(_, row)| !row.slopes.sensitivity.is_empty()).collect();
    let (_, first) = known.first()?;
    let outputs = of.both().map(|it| called(it.quantity()));
    let columns = known
        .iter()
        .flat_map(|(name, _)| outputs.clone().map(|it| Column::number(&format!("{it}, {name}"))));
    let rows = first.slopes.sensitivity.iter().map(|(parameter, _)| {
        let changes = known.iter().flat_map(|(_, row)| sensitivity(row, *parameter));
        let cells = changes.map(|it| match it.is_nan() {
            true => Cell::default(),
            false => Cell::text(percent(it)),
        });
        [Cell::text(parameter.symbol())].into_iter().chain(cells).collect()
    });
    Some(Table {
        caption: format!(
            "Change in percent per percent of each parameter, {moving}. At a kink the change is another on its other side; that told is of \
             the sequence of events of the motion."
        ),
        columns: [Column::text("parameter")].into_iter().chain(columns).collect(),
        rows: rows.collect(),
    })
}

/// By how many percent gain and price of a motion change per percent of a parameter; NaN where that is not known.
fn sensitivity(row: &Row, parameter: Parameter) -> [f64; 2] {
    let known = row.slopes.sensitivity.iter().find(|(other, _)| *other == parameter);
    known.map_or([f64::NAN; 2], |(_, both)| *both)
}

/// How far the parameters of the optima may change before these end.
pub fn margins(
    named: &[(String, Row)],
    model: &'static Description,
    moving: &str,
) -> Option<Table> {
    let known: Vec<&(String, Row)> =
        named.iter().filter(|(_, row)| !row.margins.is_empty()).collect();
    if known.is_empty() {
        return None;
    }
    let rows = model.parameters().filter_map(|parameter| margin_line(&known, parameter));
    let columns = known.iter().flat_map(|(name, _)| {
        ["falling", "rising"].map(|it| Column::number(&format!("{name}, {it} [%]")))
    });
    Some(Table {
        caption: format!(
            "What ends each motion, {moving}, or its stability, as one parameter falls or rises, and after which change in percent; none: it \
             stays stable up to a change by a half; unknown: it could not be followed further. `capsulemap tradeoff --margins` tells the \
             changes of events on the way, too."
        ),
        columns: [Column::text("parameter")].into_iter().chain(columns).collect(),
        rows: rows.collect(),
    })
}

/// The line of a parameter: where each motion ends along it; none where that is known of no motion.
fn margin_line(motions: &[&(String, Row)], parameter: Parameter) -> Option<Vec<Cell>> {
    let margins: Vec<Option<&Margins>> = motions
        .iter()
        .map(|(_, row)| row.margins.iter().find(|it| it.parameter == parameter))
        .collect();
    let is_known = margins.iter().any(Option::is_some);
    let cells = margins.into_iter().flat_map(|it| match it {
        Some(margins) => ends(margins),
        None => [Cell::default(), Cell::default()],
    });
    is_known.then(|| [Cell::text(parameter.symbol())].into_iter().chain(cells).collect())
}

/// What ends a motion, down and up, sorted by how far that is; what is not known stands last.
fn ends(margins: &Margins) -> [Cell; 2] {
    [&margins.down, &margins.up].map(|Margin { until, end, .. }| {
        let change = 100.0 * (until / margins.at - 1.0);
        match end {
            MarginEnd::Range => Cell::valued("none", change),
            MarginEnd::NotFollowed => {
                Cell::valued(&format!("unknown beyond {change:+.2}"), f64::NAN)
            }
            MarginEnd::Bifurcation(it) => {
                let name = it.name().replace('-', " ");
                Cell::valued(&format!("{name} {change:+.2}"), change)
            }
        }
    })
}
