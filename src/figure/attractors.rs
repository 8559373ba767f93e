//! The attractors of a diagram: which case shows which, in what colour, and where several coexist.

use std::collections::{BTreeMap, BTreeSet};

use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::error::FigureError;
use super::outcome::Outcomes;
use super::style::{OTHER_ATTRACTOR, UNDECIDED_DOT};
use super::view::View;
use crate::store::catalogue::{ATTRACTOR, ATTRACTOR_AXIS, DIRECTION, Entry, starts};

/// What is read of each case.
pub const READS: [Entry; 1] = [ATTRACTOR];

/// What a case shows, from what is drawn first to what is drawn last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Look {
    /// No attractor is known.
    Undecided,
    /// An attractor with a colour that it shares with others.
    Other,
    /// An attractor with a colour of its own, by its number.
    Own(usize),
}

impl Look {
    /// Its name in the data behind a figure.
    pub fn name(self) -> String {
        match self {
            Look::Undecided => "undecided".to_owned(),
            Look::Other => "further attractors".to_owned(),
            Look::Own(number) => format!("attractor {number}"),
        }
    }
}

/// The attractors along one axis.
pub struct Attractors<'a> {
    /// The axes over which the cases are spread, that of the diagram first.
    pub free: Vec<&'a str>,
    /// Cases at each value of the axis.
    pub per_value: usize,
    /// Values of the axis.
    pub values: usize,
    /// The number of each case's attractor, in the order of the axes; negative for none.
    numbers: Vec<i64>,
    failed: Vec<bool>,
    /// The colours of the attractors.
    colours: Colours,
}

impl<'a> Attractors<'a> {
    /// The attractors over the axis `x`; none where the results do not link any along it.
    pub fn along(view: &View<'a>, x: &'a str) -> Result<Option<Attractors<'a>>, FigureError> {
        let numbered = view.dataset.attributes.get(ATTRACTOR_AXIS).is_some_and(|axis| axis == x);
        if !numbered || view.dataset.variable(ATTRACTOR.name).is_none() {
            return Ok(None);
        }
        let starts: Vec<&str> = starts(view.model()).into_iter().map(|entry| entry.name).collect();
        let mut free = view.free_axes();
        free.retain(|name| starts.contains(name) || *name == DIRECTION.name);
        free.insert(0, x);
        let numbers: Vec<i64> =
            view.take(ATTRACTOR.name, &free)?.iter().map(|it| *it as i64).collect();
        let outcomes = Outcomes::over(view, &free)?;
        let failed = (0..numbers.len()).map(|case| outcomes.failed(case)).collect();
        let values = view.coordinate_values(x).len();
        let colours = Colours::of(view)?;
        let per_value = numbers.len().checked_div(values).unwrap_or(0);
        Ok(Some(Attractors { free, per_value, values, numbers, failed, colours }))
    }

    /// How a case looks; none where it failed, or where an earlier case at its value shows the same
    /// attractor.
    pub fn look(&self, case: usize) -> Option<Look> {
        let number = self.numbers[case];
        if self.failed[case] {
            return None;
        }
        if number < 0 {
            return Some(Look::Undecided);
        }
        let first = case / self.per_value * self.per_value;
        let shown = self.numbers[first..case].contains(&number);
        let is_own = self.colours.has(number as usize);
        (!shown).then_some(if is_own { Look::Own(number as usize) } else { Look::Other })
    }

    /// Whether an attractor has a colour of its own.
    pub fn has_colour(&self, number: i64) -> bool {
        usize::try_from(number).is_ok_and(|number| self.colours.has(number))
    }

    /// The colour of the points of a look.
    pub fn colour(&self, look: Look) -> RGBColor {
        match look {
            Look::Undecided => UNDECIDED_DOT,
            Look::Other => OTHER_ATTRACTOR,
            Look::Own(number) => self.colours.colour(number),
        }
    }

    /// All looks of cases, in the order in which they are drawn.
    pub fn looks(&self) -> Vec<Look> {
        let all: BTreeSet<Look> = (0..self.numbers.len()).filter_map(|it| self.look(it)).collect();
        all.into_iter().collect()
    }

    /// Whether several attractors exist at each value.
    ///
    /// An attractor exists from the first to the last value where a case shows it: between them it keeps
    /// its number only if it has been linked.
    pub fn coexist(&self) -> Vec<bool> {
        let mut extents: BTreeMap<i64, [usize; 2]> = BTreeMap::new();
        for (case, number) in self.numbers.iter().enumerate().filter(|(_, number)| **number >= 0) {
            let at = case / self.per_value;
            extents.entry(*number).or_insert([at, at])[1] = at;
        }
        let mut coexist = vec![false; self.values];
        for (at, coexist) in coexist.iter_mut().enumerate() {
            let here = extents.values().filter(|[first, last]| (*first..=*last).contains(&at));
            *coexist = here.count() > 1;
        }
        coexist
    }

    /// The looks of the cases that are seen.
    pub fn seen(&self, is_seen: impl Fn(usize) -> bool) -> BTreeSet<Look> {
        (0..self.numbers.len())
            .filter(|case| is_seen(*case))
            .filter_map(|case| self.look(case))
            .collect()
    }
}
