//! The colours of attractors and of their basins: by the number in the file of results, the same in every figure of it.

use std::collections::BTreeMap;

use plotters::style::RGBColor;

use super::error::FigureError;
use super::style::{ATTRACTORS, OTHER_ATTRACTOR, PAPER};
use super::view::View;
use crate::store::catalogue::{ATTRACTOR, ATTRACTOR_AXIS, DIRECTION, Entry, starts};
use crate::study::{AttractorColours, Colour, Coordinate};

/// How much paper the colour of a basin has, so that the points of its attractor stand out.
const TINT: f64 = 0.45;
/// The same of the colours that figures choose: two of them differ by 19 or more in CIELAB, also to eyes without green cones, and the first
/// three can be told apart in grey.
const TINTS: [f64; ATTRACTORS.len()] = [0.30, 0.60, 0.80, 0.20, 0.10, 0.35, 0.20];

/// The colours of the attractors along the line of the results that a figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Colours {
    /// Those that have one of their own, by number.
    own: BTreeMap<usize, RGBColor>,
    /// Those that the request sets of attractors that are not there.
    absent: Vec<usize>,
}

impl Colours {
    /// Those of the attractors of a view; none where the results number none.
    ///
    /// Each attractor has the colour of its number. Of more than there are colours those have one of their own to which most cases
    /// along that line lead, in the order of their numbers. What the request sets goes before.
    pub fn of(view: &View<'_>) -> Result<Colours, FigureError> {
        let cases = cases_of_each(view)?;
        let set = &view.drawing.colours;
        let mut own = usual(&cases);
        let numbers = set.keys().map(|number| *number as usize);
        let absent = numbers.filter(|number| !cases.contains_key(number)).collect();
        own.extend(set.iter().map(|(number, colour)| (*number as usize, shown(*colour))));
        Ok(Colours { own, absent })
    }

    /// Whether an attractor has a colour of its own.
    pub fn has(&self, number: usize) -> bool {
        self.own.contains_key(&number)
    }

    /// The colour of an attractor, by its number.
    pub fn colour(&self, number: usize) -> RGBColor {
        self.own.get(&number).copied().unwrap_or(OTHER_ATTRACTOR)
    }

    /// The colour of an area that belongs to an attractor.
    pub fn band(&self, number: usize) -> RGBColor {
        tinted(self.colour(number))
    }

    /// What of the colours that the request sets has no effect, or makes two attractors alike.
    pub fn notes(&self, set: &AttractorColours) -> Vec<String> {
        let absent = self.absent.iter();
        let absent = absent.map(|number| format!("`colours`: there is no attractor {number} here"));
        let mut notes: Vec<String> = absent.collect();
        for (number, colour) in set {
            let number = *number as usize;
            let is_alike = |it: &(&usize, &RGBColor)| *it.0 != number && *it.1 == shown(*colour);
            let others = self.own.iter().filter(is_alike).map(|it| *it.0);
            let told =
                others.filter(|it| !self.absent.contains(it) && !self.absent.contains(&number));
            // Of two that are set alike it is said once.
            let told = told.filter(|it| *it > number || !set.contains_key(&(*it as u32)));
            notes.extend(told.map(|it| {
                format!(
                    "`colours`: attractors {number} and {it} have the same colour, {}",
                    colour.text()
                )
            }));
        }
        notes
    }
}

/// The colours that a figure chooses for attractors to which so many cases lead.
fn usual(cases: &BTreeMap<usize, usize>) -> BTreeMap<usize, RGBColor> {
    let is_few = cases.keys().all(|number| *number < ATTRACTORS.len());
    if is_few {
        return cases.keys().map(|number| (*number, ATTRACTORS[*number])).collect();
    }
    let mut most: Vec<(usize, usize)> =
        cases.iter().map(|(number, count)| (*number, *count)).collect();
    most.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut numbers: Vec<usize> = most.into_iter().take(ATTRACTORS.len()).map(|it| it.0).collect();
    numbers.sort_unstable();
    numbers.into_iter().zip(ATTRACTORS).collect()
}

/// How many cases lead to each attractor on the line of the results along which they are numbered, where the figure holds the other
/// axes.
fn cases_of_each(view: &View<'_>) -> Result<BTreeMap<usize, usize>, FigureError> {
    let mut cases = BTreeMap::new();
    if view.dataset.variable(ATTRACTOR.name).is_none() {
        return Ok(cases);
    }
    let along = view.dataset.attributes.get(ATTRACTOR_AXIS);
    let mut of_line: Vec<&str> = starts(view.model()).into_iter().map(|it| it.name).collect();
    of_line.extend([DIRECTION.name, Entry::of_coordinate(Coordinate::StartPhase).name]);
    of_line.extend(along.map(String::as_str));
    let axes = view.axes().into_iter();
    let line: Vec<&str> = axes.filter(|name| of_line.contains(name)).collect();
    for number in view.take(ATTRACTOR.name, &line)?.iter().filter(|number| **number >= 0.0) {
        *cases.entry(*number as usize).or_default() += 1;
    }
    Ok(cases)
}

/// The colour of an attractor, by its number, where nothing is known of others.
pub fn colour_of(number: usize) -> RGBColor {
    ATTRACTORS.get(number).copied().unwrap_or(OTHER_ATTRACTOR)
}

fn shown(Colour([red, green, blue]): Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

/// A colour with paper in it.
pub fn tinted(colour: RGBColor) -> RGBColor {
    let place = ATTRACTORS.iter().position(|it| *it == colour);
    let tint = place.map_or(TINT, |place| TINTS[place]);
    let RGBColor(red, green, blue) = colour;
    let [red, green, blue] = [red, green, blue].map(|channel| with_paper(channel, tint));
    RGBColor(red, green, blue)
}

fn with_paper(channel: u8, tint: f64) -> u8 {
    let RGBColor(white, ..) = PAPER;
    (f64::from(channel) * (1.0 - tint) + f64::from(white) * tint).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_names_are_the_colours_that_figures_choose() {
        for (colour, (name, named)) in ATTRACTORS.into_iter().zip(Colour::NAMES) {
            assert_eq!(colour, shown(named), "{name}");
        }
    }

    #[test]
    fn the_basins_of_three_attractors_differ_in_grey() {
        let grey = |RGBColor(red, green, blue): RGBColor| {
            0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
        };
        let of_three = [0, 1, 2].map(|number| grey(tinted(ATTRACTORS[number])));
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            assert!((of_three[a] - of_three[b]).abs() > 25.0, "{of_three:?}");
        }
    }

    /// A colour in linear red, green and blue.
    fn linear(RGBColor(red, green, blue): RGBColor) -> [f64; 3] {
        [red, green, blue].map(|channel| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// The product of a matrix and a colour.
    fn times(matrix: [[f64; 3]; 3], colour: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(colour).map(|(a, b)| a * b).sum())
    }

    /// What eyes without green cones see, by the matrix of Machado, Oliveira and Fernandes (2009).
    fn without_green_cones(colour: [f64; 3]) -> [f64; 3] {
        let seen = [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ];
        times(seen, colour).map(|it| it.clamp(0.0, 1.0))
    }

    /// A colour in CIELAB under the daylight D65.
    fn lab(colour: [f64; 3]) -> [f64; 3] {
        let to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        let [x, y, z] = times(to_xyz, colour);
        let [x, y, z] = [x / 0.9505, y, z / 1.089].map(|share| {
            if share > 0.008856 { share.cbrt() } else { 7.787 * share + 16.0 / 116.0 }
        });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn basins_are_told_apart_without_green_cones_as_well() {
        for seen in [|colour| colour, without_green_cones as fn([f64; 3]) -> [f64; 3]] {
            let all = ATTRACTORS.map(|colour| lab(seen(linear(tinted(colour)))));
            for (place, a) in all.iter().enumerate() {
                for b in &all[..place] {
                    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
                    let apart = squares.sum::<f64>().sqrt();
                    assert!(apart > 19.0, "{place}: {apart}");
                }
            }
        }
    }

    #[test]
    fn of_many_attractors_the_widest_have_colours_of_their_own() {
        let few = BTreeMap::from([(0, 5), (6, 1)]);
        assert_eq!(usual(&few), BTreeMap::from([(0, ATTRACTORS[0]), (6, ATTRACTORS[6])]));
        let many: BTreeMap<usize, usize> = (0..20).map(|number| (number, number)).collect();
        let found = usual(&many);
        assert_eq!(found.keys().copied().collect::<Vec<_>>(), (13..20).collect::<Vec<_>>());
        assert_eq!(found[&13], ATTRACTORS[0]);
    }
}
