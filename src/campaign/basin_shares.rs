//! What a file of results says of basins beyond its tables: shares under a distribution of starts, and what has settled by when.

use crate::attractor::{Label, Share, weighted_shares_of_grid};
use crate::run::SettlingTimes;
use crate::store::catalogue::{ATTRACTOR, CYCLES, OUTCOME};
use crate::store::{Dataset, Values};
use crate::study::{Coordinate, Draws, Normal};

/// The shares of basins on a grid under a distribution of starts.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedShares {
    /// The share of each attractor, by its number.
    pub shares: Vec<Share>,
    /// The share of starts whose attractor is not known.
    pub unknown: f64,
    /// The probability of a start within the grid: the shares are those of the distribution cut at its ends.
    pub inside: f64,
    /// The axes whose cells are wider than the deviation: the grid does not resolve the distribution.
    pub coarse: Vec<&'static str>,
}

/// The basins of a file: the attractor of each start of a grid, or of each draw.
struct Basins<'a> {
    dimensions: &'a [String],
    shape: Vec<usize>,
    labels: Vec<Label>,
    /// What came of each start.
    outcomes: Vec<Option<&'a str>>,
}

impl<'a> Basins<'a> {
    /// Fails where the file has none whose starts alone vary.
    fn of(dataset: &'a Dataset) -> Result<Basins<'a>, String> {
        let none = || "the file has no basins: its cases tell no attractors".to_owned();
        let variable = dataset.variable(ATTRACTOR.name).ok_or_else(none)?;
        let Values::Integer(numbers) = &variable.values else { return Err(none()) };
        let outcomes = dataset.variable(OUTCOME.name).ok_or_else(none)?.names();
        let label = |(number, outcome): (&i64, &Option<&str>)| match u32::try_from(*number) {
            Ok(number) => Label::Attractor(number),
            Err(_) if *outcome == Some("missing") => Label::Missing,
            Err(_) => Label::Undecided,
        };
        let basins = Basins {
            dimensions: &variable.dimensions,
            shape: numbers.shape().to_vec(),
            labels: numbers.iter().zip(&outcomes).map(label).collect(),
            outcomes,
        };
        let model = dataset.model();
        let is_start = |name: &String| {
            let starts = Coordinate::all(model).filter(|it| it.is_start());
            name == Draws::DIMENSION || starts.map(Coordinate::name).any(|it| it == name)
        };
        match basins.dimensions.iter().find(|name| !is_start(name)) {
            Some(name) => Err(format!(
                "the basins vary along {name}; expected basins whose cases differ in their starts alone"
            )),
            None => Ok(basins),
        }
    }

    /// How many attractors there are.
    fn attractors(&self) -> usize {
        let numbers = self.labels.iter().map(|it| match it {
            Label::Attractor(number) => *number as usize + 1,
            _ => 0,
        });
        numbers.max().unwrap_or(0)
    }
}

/// The shares of the basins of a file where starts are drawn from normal distributions, each of a coordinate; along the other axes of the
/// grid starts are evenly distributed.
///
/// Method: each start of the grid counts with the probability of its cell, see [`weighted_shares_of_grid`].
///
/// Fails where the file has no grid of starts alone, or a coordinate is no axis of it; tells all faults.
pub fn weighted_shares(
    dataset: &Dataset,
    densities: &[(Coordinate, Normal)],
) -> Result<WeightedShares, Vec<String>> {
    let basins = Basins::of(dataset).map_err(|fault| vec![fault])?;
    if basins.dimensions.iter().any(|name| name == Draws::DIMENSION) {
        return Err(vec![
            "the starts of the file are drawn, and have the distribution of their study; expected a grid of starts".to_owned(),
        ]);
    }
    let mut faults = Vec::new();
    for (coordinate, _) in densities {
        let name = coordinate.name();
        if !basins.dimensions.iter().any(|it| it == name) {
            let axes = basins.dimensions.join(", ");
            faults.push(format!("{name} is no axis of the basins (allowed: {axes})"));
        } else if dataset.coordinate(name).is_some_and(|it| it.values.shape() == [1]) {
            faults.push(format!("{name} has one value; expected an axis of two or more"));
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let (mut weights, mut inside, mut coarse) = (Vec::new(), 1.0, Vec::new());
    for (name, length) in basins.dimensions.iter().zip(&basins.shape) {
        let density = densities.iter().find(|(coordinate, _)| coordinate.name() == name);
        let values = dataset.coordinate(name).map(|it| it.values.to_real());
        let (Some((coordinate, normal)), Some(values)) = (density, values) else {
            weights.push(vec![1.0 / *length as f64; *length]);
            continue;
        };
        let values: Vec<f64> = values.into_iter().collect();
        let (cells, all) = normal.cells(&values);
        inside *= all;
        weights.push(cells);
        if values.windows(2).any(|pair| (pair[1] - pair[0]).abs() > normal.deviation) {
            coarse.push(coordinate.name());
        }
    }
    if inside <= 0.0 {
        return Err(vec!["the grid holds nothing of this distribution".to_owned()]);
    }
    let label = |start: usize| basins.labels[start];
    let shares = weighted_shares_of_grid(&basins.shape, label, basins.attractors(), |start| {
        weight_of(start, &weights)
    });
    let known: f64 = shares.iter().map(|it| it.value).sum();
    let is_unknown = basins.labels.contains(&Label::Undecided);
    let unknown = if is_unknown { (1.0 - known).max(0.0) } else { 0.0 };
    Ok(WeightedShares { shares, unknown, inside, coarse })
}

/// The weight of a start of a grid by those of the cells along each axis, the last axis fastest.
fn weight_of(mut start: usize, weights: &[Vec<f64>]) -> f64 {
    weights.iter().rev().fold(1.0, |product, cells| {
        let at = start % cells.len();
        start /= cells.len();
        product * cells[at]
    })
}

/// After how many cycles the starts of the basins of a file have settled, and how many starts were inferred and not followed.
///
/// Fails where the file has no basins whose starts alone vary.
pub fn settling_times(dataset: &Dataset) -> Result<(SettlingTimes, usize), String> {
    let basins = Basins::of(dataset)?;
    let Some(Values::Integer(cycles)) = dataset.variable(CYCLES.name).map(|it| &it.values) else {
        return Err("the file does not tell for how many cycles its cases were followed".to_owned());
    };
    let attractor = |label: &Label| match label {
        Label::Attractor(number) => Some(*number),
        _ => None,
    };
    let starts = basins.labels.iter().zip(cycles).zip(&basins.outcomes);
    let followed = starts.filter(|(_, outcome)| !matches!(**outcome, Some("missing" | "inferred")));
    let followed = followed.map(|((label, cycles), _)| (attractor(label), (*cycles).max(0) as u64));
    let times = SettlingTimes::of(basins.attractors(), followed);
    let inferred = basins.outcomes.iter().filter(|it| **it == Some("inferred")).count();
    Ok((times, inferred))
}
