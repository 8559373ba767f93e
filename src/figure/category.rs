//! Cases sorted into kinds, each with a name and a colour: outcomes and periods.

use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::canvas::{Anchor, Canvas};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Mark, draw_mark};
use super::inferred;
use super::outcome::{self, Outcomes, told_of_missing};
use super::raster::Fill;
use super::style::{
    CHAOTIC, INFERRED, LONG_PERIOD, NOT_YET, OTHER_ATTRACTOR, PAPER, PERIODS, QUASI_PERIODIC,
    SMALL_SIZE, UNDECIDED,
};
use super::text::Text;
use super::view::View;
use crate::description::{Description, Output};
use crate::store::catalogue::{ATTRACTOR, Entry, OUTCOME, PERIOD};

/// What is read of each case, beside that by which they are sorted.
pub fn reads(model: &'static Description) -> Vec<Entry> {
    [OUTCOME].into_iter().chain(model.rest_share().map(Entry::of_output)).collect()
}

/// Distance between a frame and the legend [pt].
const LEGEND_GAP: f64 = 7.0;
/// Distance between lines of the legend [pt].
const LINE: f64 = 11.5;
/// Width of a mark and the gap after it [pt].
const MARK: f64 = 16.0;

/// The place in the legend after those of all kinds with numbers.
const FURTHER: usize = usize::MAX - 2;

/// A kind of case.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    /// Its name in the legend.
    pub name: String,
    /// Its colour; none where the case has no result.
    pub colour: Option<RGBColor>,
}

impl Kind {
    fn coloured(name: &str, colour: RGBColor) -> Kind {
        Kind { name: name.to_owned(), colour: Some(colour) }
    }
}

/// The kind of every case, as places in a list of those that occur.
pub struct Kinds {
    /// The kinds that occur, in the order of the legend.
    pub kinds: Vec<Kind>,
    /// Heading of the legend.
    heading: Text,
    /// The kind of each case.
    of_case: Vec<u16>,
    /// Whether the legend lists each kind.
    listed: Vec<bool>,
}

impl Kinds {
    /// Sorts the cases of one panel after the other by the variable `name`, which holds periods or has named values.
    pub fn of(
        view: &View<'_>,
        panels: &[View<'_>],
        name: &str,
        free: &[&str],
    ) -> Result<Kinds, FigureError> {
        let mut sorted = Vec::new();
        for panel in panels {
            sorted.extend(kinds(panel, name, free)?);
        }
        Ok(Kinds::sorted(sorted, view.quantity(name).short_name()))
    }

    /// Whether the cases of two sweeps are of the same kind.
    pub fn of_difference(
        [first, second]: [&View<'_>; 2],
        name: &str,
        free: &[&str],
    ) -> Result<Kinds, FigureError> {
        let (of_first, of_second) = (kinds(first, name, free)?, kinds(second, name, free)?);
        let both = of_first.iter().zip(&of_second);
        let compared = both.map(|(first, second)| alike(first == second)).collect();
        Ok(Kinds::sorted(compared, first.quantity(name).short_name()))
    }

    /// The kinds of cases that occur in the order of their places in the legend.
    fn sorted(kinds: Vec<(usize, Kind)>, heading: Text) -> Kinds {
        let mut present: Vec<(usize, Kind)> = Vec::new();
        let mut of_case = Vec::new();
        for kind in kinds {
            let known = present.iter().position(|other| other.1 == kind.1);
            of_case.push(known.unwrap_or(present.len()) as u16);
            if known.is_none() {
                present.push(kind);
            }
        }
        let mut order: Vec<usize> = (0..present.len()).collect();
        order.sort_by(|&a, &b| {
            let (a, b) = (&present[a], &present[b]);
            a.0.cmp(&b.0).then_with(|| a.1.name.cmp(&b.1.name))
        });
        let mut places = vec![0; present.len()];
        for (place, &shown) in order.iter().enumerate() {
            places[shown] = place as u16;
        }
        of_case.iter_mut().for_each(|it| *it = places[usize::from(*it)]);
        let kinds: Vec<Kind> = order.iter().map(|&it| present[it].1.clone()).collect();
        let listed = vec![true; kinds.len()];
        Kinds { kinds, heading, of_case, listed }
    }

    /// Leaves kinds out of the legend of which no case is seen.
    pub fn list(&mut self, seen: impl Fn(usize) -> bool) {
        self.listed.fill(false);
        for (_, kind) in self.of_case.iter().enumerate().filter(|(case, _)| seen(*case)) {
            self.listed[usize::from(*kind)] = true;
        }
    }

    /// The kinds in the legend.
    fn in_legend(&self) -> impl Iterator<Item = &Kind> {
        self.kinds.iter().zip(&self.listed).filter(|(_, listed)| **listed).map(|(kind, _)| kind)
    }

    /// How many of the cases that are seen are not computed yet, in words.
    pub fn told_of_missing(&self, seen: impl Fn(usize) -> bool) -> Option<String> {
        let cases = (0..self.of_case.len()).filter(|case| seen(*case));
        let is_missing =
            |case: &usize| self.kinds[usize::from(self.of_case[*case])].name == outcome::NOT_YET;
        let missing = cases.clone().filter(is_missing).count();
        told_of_missing(missing, cases.count())
    }

    /// What the kinds are of.
    pub fn told(&self) -> String {
        self.heading.content()
    }

    /// The place of the kind of a case in the list.
    pub fn place(&self, case: usize) -> Option<u16> {
        self.of_case.get(case).copied()
    }

    /// The name of the kind of a case.
    pub fn name(&self, case: usize) -> Option<String> {
        self.of_case.get(case).map(|place| self.kinds[usize::from(*place)].name.clone())
    }

    /// The colour of a case.
    pub fn colour(&self, case: usize) -> Option<RGBColor> {
        self.of_case.get(case).and_then(|place| self.kinds[usize::from(*place)].colour)
    }

    /// Room that the legend takes beside a frame [pt].
    pub fn room(&self) -> f64 {
        let widths = self.in_legend().map(|kind| Text::plain(&kind.name).width(SMALL_SIZE) + MARK);
        LEGEND_GAP + widths.fold(self.heading.width(SMALL_SIZE), f64::max) + 2.0
    }

    /// Height of the legend [pt].
    pub fn height(&self) -> f64 {
        SMALL_SIZE + self.in_legend().count() as f64 * LINE
    }

    /// Draws the legend beside `frame`.
    pub fn draw_legend(&self, canvas: &mut Canvas, frame: Rect) {
        let left = frame.right + LEGEND_GAP;
        let mut baseline = frame.top + 0.7 * SMALL_SIZE;
        canvas.text(&self.heading, (left, baseline), SMALL_SIZE, Anchor::Start);
        for kind in self.in_legend() {
            baseline += LINE;
            let mark = kind.colour.map_or(Mark::Filled(Fill::NO_VALUE), Mark::Patch);
            draw_mark(canvas, mark, (left - 1.0, baseline - 0.3 * SMALL_SIZE));
            let at = (left - 1.0 + MARK, baseline);
            canvas.text(&Text::plain(&kind.name), at, SMALL_SIZE, Anchor::Start);
        }
    }
}

/// Whether the values of a variable or an axis are kinds, which have no order.
pub fn is_sorted(view: &View<'_>, name: &str) -> bool {
    name == PERIOD.name || name == ATTRACTOR.name || !view.flags(name).is_empty()
}

/// The kind of each case with its place in the legend.
fn kinds(view: &View<'_>, name: &str, free: &[&str]) -> Result<Vec<(usize, Kind)>, FigureError> {
    let codes = view.parameter(name, free)?;
    let (flags, outcomes) = (view.flags(name), Outcomes::over(view, free)?);
    let resting = resting(view, free, &outcomes)?;
    let colours = Colours::of(view)?;
    let mut kinds = Vec::new();
    for (case, code) in codes.iter().enumerate() {
        kinds.push(match name {
            _ if name == ATTRACTOR.name => by_attractor(*code, outcomes.missing(case), &colours),
            _ if name != PERIOD.name => by_flag(*code, flags),
            _ if resting.get(case) == Some(&true) => rest(),
            _ => by_period(*code, outcomes.name(case)),
        });
    }
    Ok(kinds)
}

/// The kind of a case that is of one kind in both sweeps, or of two.
fn alike(is_alike: bool) -> (usize, Kind) {
    match is_alike {
        true => (0, Kind::coloured("upward and downward alike", PAPER)),
        false => (1, Kind::coloured("different", PERIODS[4])),
    }
}

/// The kind of a case that leads to an attractor, by its number.
fn by_attractor(number: f64, is_missing: bool, colours: &Colours) -> (usize, Kind) {
    if is_missing {
        return (FURTHER + 1, Kind::coloured(outcome::NOT_YET, NOT_YET));
    }
    let number = match number {
        number if number >= 0.0 => number as usize,
        _ => return (FURTHER + 1, Kind::coloured("no attractor known", UNDECIDED)),
    };
    match colours.has(number) {
        true => (number, Kind::coloured(&format!("attractor {number}"), colours.colour(number))),
        false => (FURTHER, Kind::coloured("further attractors", OTHER_ATTRACTOR)),
    }
}

/// The colour of an outcome by its name; none of one that has none.
pub fn colour_of_outcome(name: &str) -> Option<RGBColor> {
    by_name(name)?.1.colour
}

/// The kind of a named outcome and its place in the legend, after those of the periods.
fn by_name(name: &str) -> Option<(usize, Kind)> {
    let (rank, colour) = match name {
        "periodic" => (0, Some(PERIODS[0])),
        "quasi-periodic" => (20, Some(QUASI_PERIODIC)),
        "chaotic" => (21, Some(CHAOTIC)),
        "undecided" => (22, Some(UNDECIDED)),
        "failed" => (23, None),
        "missing" => {
            let kind = Kind::coloured(outcome::NOT_YET, NOT_YET);
            return Some((24, kind));
        }
        "inferred" => (25, Some(INFERRED)),
        _ => return None,
    };
    Some((rank, Kind { name: name.to_string(), colour }))
}

/// Whether each periodic case is one in which the capsule never slides; empty where the results do not say.
fn resting(
    view: &View<'_>,
    free: &[&str],
    outcomes: &Outcomes<'_>,
) -> Result<Vec<bool>, FigureError> {
    let rest_share = view.model().rest_share().map(Output::name);
    let Some(rest_share) = rest_share.filter(|name| view.dataset.variable(name).is_some()) else {
        return Ok(Vec::new());
    };
    let shares = view.take(rest_share, free)?;
    let cases = shares.iter().enumerate();
    let resting = cases.map(|(case, share)| {
        let repeats = outcomes.periodic(case) || outcomes.name(case) == Some(inferred::NAME);
        *share >= 1.0 && repeats
    });
    Ok(resting.collect())
}

/// The mass moves and the capsule does not, whatever the period.
fn rest() -> (usize, Kind) {
    (0, Kind::coloured("capsule at rest", PAPER))
}

fn no_value() -> (usize, Kind) {
    (FURTHER + 2, Kind { name: "no value".to_string(), colour: None })
}

fn by_period(period: f64, outcome: Option<&str>) -> (usize, Kind) {
    // Only what repeats is inferred in a map, with its period.
    let repeats = outcome == Some("periodic") || (outcome == Some(inferred::NAME) && period >= 1.0);
    if let Some(found) = outcome.filter(|_| !repeats).and_then(by_name) {
        return found;
    }
    if period.is_nan() || period < 1.0 {
        return no_value();
    }
    let place = period as usize;
    match PERIODS.get(place - 1) {
        Some(colour) => (place, Kind::coloured(&place.to_string(), *colour)),
        None => (9, Kind::coloured(&format!("{} or more", PERIODS.len() + 1), LONG_PERIOD)),
    }
}

fn by_flag(code: f64, flags: &[(i64, String)]) -> (usize, Kind) {
    let Some(place) = flags.iter().position(|(value, _)| *value as f64 == code) else {
        return no_value();
    };
    let name = &flags[place].1;
    by_name(name).unwrap_or_else(|| (place, Kind::coloured(name, PERIODS[place % PERIODS.len()])))
}
