//! How long the search for the attractors of a study takes, measured on parts of it.

use std::ops::Range;
use std::time::{Duration, Instant};

use super::error::CampaignError;
use crate::run::{
    Estimate, FinalMotions, Machine, RunError, attractor_table, attractors, final_motions,
    has_attractors, links, run_sample,
};
use crate::study::layout::linked_axis;
use crate::study::{CaseSet, Study, spread};

/// Parts that are spread along an axis, and the values of each.
pub(super) const PARTS: usize = 8;
const VALUES: usize = 16;
/// Pairs of neighbouring cells of a part, which fill the lanes.
const PAIRS: usize = 256;
/// Starts of a cell of a part, at most.
const STARTS: usize = 576;
/// Starts, at most, by which it is measured what goes with their number.
const MANY_STARTS: usize = 1 << 18;

/// The time that the search for attractors of `study` takes [s], or none if it has none; no part is begun after `span`.
///
/// Method: parts that have neighbouring values of the axis along which attractors are linked, and fewer lines and starts; time
/// goes with the pairs of neighbouring cells. Where there is no such axis, fewer starts lead to the same attractors, and what
/// goes with the number of starts is measured with many that end as the nearest of the few.
pub(super) fn search_seconds(
    study: &Study,
    machine: Machine,
    span: Duration,
) -> Result<Option<Estimate>, CampaignError> {
    if !has_attractors(study) {
        return Ok(None);
    }
    let begun = Instant::now();
    let mut found = Vec::new();
    for number in spread(if links(study) > 0 { PARTS } else { 1 }) {
        if begun.elapsed() > span && !found.is_empty() {
            break;
        }
        let few = Measured::of(part(study, number, STARTS), machine)?;
        found.push(match links(study) {
            0 => few.seconds + few.growth(&part(study, number, MANY_STARTS), study, machine)?,
            links_of_all => few.seconds * links_of_all as f64 / links(&few.part).max(1) as f64,
        });
    }
    Ok(Some(mean(&found)))
}

/// How long the search takes for the attractors of cases that have settled to these motions [s].
fn seconds(study: &Study, motions: &FinalMotions, machine: Machine) -> Result<f64, RunError> {
    let begun = Instant::now();
    let attractors = attractors(study, motions, machine, || ())?;
    attractor_table(study, &attractors, motions, machine, |_| ())?;
    Ok(begun.elapsed().as_secs_f64())
}

/// A part of a study with the motions of its cases, and how long the search for their attractors takes.
struct Measured {
    part: Study,
    motions: FinalMotions,
    /// How long it takes [s].
    seconds: f64,
}

impl Measured {
    fn of(part: Study, machine: Machine) -> Result<Measured, RunError> {
        let chains: Vec<usize> = (0..part.chains()).collect();
        let motions = final_motions(&part, &run_sample(&part, machine, &chains, || ())?);
        let seconds = seconds(&part, &motions, machine)?;
        Ok(Measured { part, motions, seconds })
    }

    /// The time that all starts of a study take beyond that of this part [s], by a part that has many of them.
    fn growth(&self, many: &Study, all: &Study, machine: Machine) -> Result<f64, RunError> {
        let few = self.part.cases();
        if many.cases() <= few {
            return Ok(0.0);
        }
        let (large, small) = (many.shape(), self.part.shape());
        let as_nearest = (0..many.cases())
            .filter_map(|case| Some((case, self.motions.get(nearest(case, &large, &small))?)));
        let motions = FinalMotions::of(many, as_nearest);
        let more = (seconds(many, &motions, machine)? - self.seconds).max(0.0);
        Ok(more * (all.cases() - few) as f64 / (many.cases() - few) as f64)
    }
}

/// The case of a small grid that lies where `case` lies in a large one of as many axes.
fn nearest(case: usize, large: &[usize], small: &[usize]) -> usize {
    let (mut rest, mut found, mut spacing) = (case, 0, 1);
    for (&large, &small) in large.iter().zip(small).rev() {
        found += rest % large * small / large * spacing;
        spacing *= small;
        rest /= large;
    }
    found
}

/// A part of `study` by its number, with so many starts of a cell at most.
fn part(study: &Study, number: usize, most: usize) -> Study {
    let mut part = Study { refine: None, ..study.clone() };
    match &mut part.case_set {
        CaseSet::Draws(draws) => draws.truncate(most),
        CaseSet::Grid(grid) => {
            let linked = linked_axis(study);
            let starts = grid.axes.iter().filter(|axis| axis.is_of_starts()).count();
            let lines = grid.axes.len() - starts - usize::from(linked.is_some());
            for (place, axis) in grid.axes.iter_mut().enumerate() {
                let places = axis.places();
                let some = match () {
                    () if Some(place) == linked => neighbours(places, number).collect(),
                    () if axis.is_of_starts() => thinned(places, root(most, starts), 0.5),
                    () => {
                        let offset = (number as f64 + 0.5) / PARTS as f64;
                        thinned(places, root(PAIRS / VALUES, lines), offset)
                    }
                };
                axis.keep(&some);
            }
        }
    }
    part
}

/// The places of a part of an axis of so many by its number: neighbours, or all where there are few.
pub(super) fn neighbours(places: usize, number: usize) -> Range<usize> {
    let length = VALUES.min(places);
    let first = number * (places - length) / (PARTS - 1);
    first..first + length
}

/// The largest number whose power of so many is at most `most`.
fn root(most: usize, axes: usize) -> usize {
    (1..).take_while(|it: &usize| it.pow(axes.max(1) as u32) <= most).last().unwrap_or(1)
}

/// At most so many of some places, evenly spaced, from an offset in the first of the spaces on.
fn thinned(places: usize, most: usize, offset: f64) -> Vec<usize> {
    if places <= most {
        return (0..places).collect();
    }
    let space = places as f64 / most as f64;
    (0..most).map(|it| ((it as f64 + offset) * space) as usize).collect()
}

/// The mean, with its standard error where there are enough.
fn mean(numbers: &[f64]) -> Estimate {
    let count = numbers.len() as f64;
    let value = numbers.iter().sum::<f64>() / count;
    let squares: f64 = numbers.iter().map(|it| (it - value).powi(2)).sum();
    let error = if count > 2.0 { (squares / (count * (count - 1.0))).sqrt() } else { f64::NAN };
    Estimate { value, error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_neighbouring_values_and_few_lines_and_starts() {
        let axis = |name: &str, to: &str, points: usize| {
            format!(
                "[[axes]]\nname = \"{name}\"\nfrom = \"0.1 {to}\"\nto = \"9 {to}\"\npoints = {points}\n"
            )
        };
        let parsed = |axes: &[String]| {
            let text = "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n".to_owned();
            let text = text + &axes.concat();
            Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"))
        };
        let inherit = "[start]\ninherit = \"omega\"\n".to_owned();
        let map = parsed(&[axis("p_d", "N", 50), axis("omega", "rad/s", 300), inherit]);
        let starts = ["start_r", "start_y1"]
            .map(|name| axis(name, if name == "start_r" { "mm" } else { "m/s" }, 40));
        let force = "p_d = \"3 N\"\n".to_owned();
        let shares = parsed(&[&[force, axis("omega", "rad/s", 300)], &starts[..]].concat());
        for (study, linked, shape) in [(&map, 1, &[16, 16][..]), (&shares, 0, &[16, 24, 24])] {
            for number in 0..PARTS {
                let part = part(study, number, STARTS);
                assert_eq!(part.shape()[..shape.len()], *shape);
                let [few, all] = [&part, study].map(|it| &it.axes()[linked].varying[0].values);
                let first = all.iter().position(|it| it == &few[0]).expect("one of all");
                assert_eq!(few[..], all[first..first + VALUES]);
                assert_eq!(first == 284, number == PARTS - 1, "{first}");
            }
        }
        let places = [0, 2, 3, 4, 8].map(|case| nearest(case, &[3, 4], &[2, 2]));
        assert_eq!(places, [0, 1, 1, 0, 2]);
        assert_eq!([root(16, 1), root(16, 2), root(17, 3), root(1, 0)], [16, 4, 2, 1]);
        assert_eq!(thinned(4, 2, 0.5), [1, 3]);
    }
}
