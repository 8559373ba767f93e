//! Which cases of a study share an attractor, how attractors go on along an axis, and where they change.

use std::cmp::Reverse;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::cases::{Rayon, RunError, pool};
use super::infer::infer;
use super::{FinalMotions, Machine};
use crate::attractor::{Attractor, Bridge, Label, Links, Table};
use crate::branch::{ONE_VALUE, SpecialKind, SpecialValue};
use crate::description::Section;
use crate::lane::Instructions;
use crate::model::{Along, Cell, LinearOrbits, Motions, Neighbours, Setting, Unlinked};
use crate::study::layout::{Layout, linked_axis};
use crate::study::{CaseSet, Coordinate, Direction, Study};

/// Lines are searched together that have so many cells: links that take long fill the lanes.
const LINKS: usize = 32768;
/// A thread more is worth so many computations, as fewer leave its lanes empty.
const LEAST: usize = 64;

/// A change of an attractor along the axis, or its beginning or end.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractorEvent {
    /// What happens.
    pub kind: SpecialKind,
    /// The attractor, by its number on its line.
    pub attractor: u32,
    /// A case of the attractor beside the event, which tells the values of the other axes.
    pub case: usize,
    /// The value of the parameter of the axis.
    pub value: f64,
    /// How far the true value may be.
    pub uncertainty: f64,
    /// Period of the orbit that changes [cycles].
    pub period: u64,
    /// Its section point there.
    pub section: Section,
}

impl AttractorEvent {
    /// Whether another event, as it was located, can be this one.
    fn is(&self, other: &AttractorEvent) -> bool {
        let apart = (self.value - other.value).abs();
        (self.kind, self.attractor, self.period) == (other.kind, other.attractor, other.period)
            && apart <= self.uncertainty + other.uncertainty + ONE_VALUE * self.value.abs()
    }
}

/// The attractors of a study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attractors {
    /// The axis along which they are linked, by its place in the study; none where there is no single one.
    pub axis: Option<usize>,
    /// The attractor of each case, by its number; none where the case has none. Of a refined study, that of a case that has not
    /// been computed is inferred.
    ///
    /// They are numbered along each line of the axis anew, in the order in which they appear; those that appear
    /// together in the order of [`Table::order`].
    pub of_case: Vec<Option<u32>>,
    /// The events, line by line in the order of the parameter.
    pub events: Vec<AttractorEvent>,
    /// The attractors by their numbers, where all cases have the same parameters.
    pub of_starts: Vec<Attractor<Section>>,
}

impl Attractors {
    /// What a case leads to, by the final motions of all cases.
    pub fn label(&self, case: usize, final_motions: &FinalMotions) -> Label {
        match self.of_case[case] {
            Some(number) => Label::Attractor(number),
            None if final_motions.get(case).is_some() => Label::Undecided,
            None => Label::Missing,
        }
    }
}

/// Whether there are attractors to be told apart or followed: an axis is followed, or the only parameter that
/// varies, or cases differ in their start; of draws, in their start alone.
pub fn has_attractors(study: &Study) -> bool {
    let varied = study.case_set.varied();
    match study.case_set {
        CaseSet::Grid(_) => {
            linked_axis(study).is_some() || varied.iter().any(|coordinate| coordinate.is_start())
        }
        CaseSet::Draws(_) => varied.iter().all(|coordinate| coordinate.is_start()),
    }
}

/// Pairs of neighbouring cells between which attractors are linked.
pub fn links(study: &Study) -> usize {
    let layout = Layout::of(study);
    layout.lines() * layout.cells().saturating_sub(1)
}

/// Finds the attractors of a study from the `final_motions` of its cases; calls `linked` after each link.
///
/// A periodic attractor is known by its certified orbit, see [`Table::sort`] and `Neighbours::link`. Every line
/// is a task of its own, of which only numbers and events are kept; so are its cells and every two
/// neighbours, as there may be a single line. The threads do not matter.
pub fn attractors(
    study: &Study,
    final_motions: &FinalMotions,
    machine: Machine,
    linked: impl Fn() + Sync,
) -> Result<Attractors, RunError> {
    if !has_attractors(study) {
        return Ok(Attractors { of_case: vec![None; study.cases()], ..Attractors::default() });
    }
    let instructions = machine.instructions_for(links(study));
    let mut found =
        pool(machine.threads)?.install(|| find(study, final_motions, instructions, &linked));
    infer(study, final_motions, &mut found.of_case);
    Ok(found)
}

fn find(
    study: &Study,
    final_motions: &FinalMotions,
    instructions: Instructions,
    linked: impl Fn() + Sync,
) -> Attractors {
    let layout = Layout::of(study);
    let of_case = vec![None; study.cases()];
    let mut found = Attractors { axis: layout.axis, of_case, ..Attractors::default() };
    let some = LINKS.div_ceil(layout.cells());
    for first in (0..layout.lines()).step_by(some) {
        let numbers = first..layout.lines().min(first + some);
        let line = |number| Line::sorted(study, &layout, number, final_motions);
        let lines: Vec<Line> = numbers.map(line).collect();
        let links = links_of_lines(&lines, instructions, &linked);
        lines.iter().zip(&links).for_each(|(line, links)| line.add_to(&mut found, links));
    }
    found
}

/// How the attractors of each cell of some lines go on in the next.
fn links_of_lines(
    lines: &[Line<'_>],
    instructions: Instructions,
    linked: impl Fn() + Sync,
) -> Vec<Vec<Links<Section>>> {
    let last = lines[0].cells.len().saturating_sub(1);
    // Of one cell there are no links, and along another axis than a parameter none leads on.
    if last == 0 || lines[0].along(0).is_none() {
        (0..lines.len() * last).for_each(|_| linked());
        return vec![vec![Links::default(); last]; lines.len()];
    }
    // The derivatives of an orbit serve its links on both sides.
    let linear = linear_orbits(lines, instructions);
    let mut order: Vec<usize> = (0..lines.len() * last).collect();
    // Those begun last end last: let them be short ones, so that no thread goes on alone.
    order.sort_by_cached_key(|place| {
        let (cells, at) = (&lines[place / last].cells, place % last);
        Reverse(cells[at].cycles() + cells[at + 1].cycles())
    });
    let model = lines[0].study.model();
    let links = together(order, &|next| {
        let unlinked = |place: usize| {
            let (line, at) = (place / last, place % last);
            let neighbours = lines[line].neighbours(at)?;
            let linear = [at, at + 1].map(|at| linear[line * (last + 1) + at].clone());
            Some((place, Unlinked { neighbours, linear }))
        };
        model.links(instructions, &mut || unlinked(next()?), &mut || linked())
    });
    let mut links = links.into_iter();
    lines.iter().map(|_| links.by_ref().take(last).collect()).collect()
}

/// The attractors of all cells of some lines along a parameter, line by line, with their derivatives.
fn linear_orbits(lines: &[Line<'_>], instructions: Instructions) -> Vec<LinearOrbits> {
    let (model, length) = (lines[0].study.model(), lines[0].cells.len());
    together((0..lines.len() * length).collect(), &|next| {
        let cell = |place: usize| Some((place, lines[place / length].cell(place % length)?));
        model.linear_orbits(instructions, &mut || cell(next()?))
    })
}

/// A line of a study, by its number.
struct Line<'a> {
    study: &'a Study,
    layout: &'a Layout,
    number: usize,
    /// The cells, their cases sorted by attractor.
    cells: Vec<Arc<Table<Section>>>,
}

impl<'a> Line<'a> {
    /// The line, its cases sorted by attractor.
    fn sorted(
        study: &'a Study,
        layout: &'a Layout,
        number: usize,
        final_motions: &FinalMotions,
    ) -> Self {
        let sort = |at: usize| {
            let final_motion = |place: usize| {
                let case = layout.case(number, at, place);
                (case, final_motions.get(case))
            };
            let motions = Motions { count: layout.cases(), at: &final_motion };
            let setting = Setting::of(&study.case(layout.case(number, at, 0)));
            Arc::new(study.model().table(&setting, motions, &study.protocol, &Rayon))
        };
        let cells = (0..layout.cells()).into_par_iter().map(sort).collect();
        Line { study, layout, number, cells }
    }

    /// What is held at a place of the axis, and the value there; none where the axis is no parameter.
    fn along(&self, at: usize) -> Option<(Along, f64)> {
        let Line { study, layout, number, .. } = *self;
        let axis = &study.axes()[layout.axis?];
        let Coordinate::Parameter(parameter) = axis.coordinate else { return None };
        let setting = Setting::of(&study.case(layout.case(number, at, 0)));
        let tolerance = study.protocol.tolerance;
        Some((Along { setting, parameter, tolerance }, axis.values[at]))
    }

    /// The cell at a place of the axis; none where the axis is no parameter.
    fn cell(&self, at: usize) -> Option<Cell> {
        let (along, value) = self.along(at)?;
        Some(Cell { along, value, table: self.cells[at].clone() })
    }

    /// The cells at a place of the axis and at the next; none where the axis is no parameter.
    fn neighbours(&self, at: usize) -> Option<Neighbours> {
        let Line { study, layout, .. } = *self;
        let (along, value) = self.along(at)?;
        let values = [value, study.axes()[layout.axis?].values[at + 1]];
        let cells = [at, at + 1].map(|cell| self.cells[cell].clone());
        let directions = study.inherit().map_or(&[][..], |inherit| &inherit.directions);
        let inherited = [Direction::Upward, Direction::Downward].map(|direction| {
            directions.contains(&direction).then(|| leads(&cells, directions, direction))
        });
        Some(Neighbours { along, protocol: study.protocol, values, cells, inherited })
    }

    /// Adds its attractors, which go on so from cell to cell, to those of a study.
    fn add_to(&self, found: &mut Attractors, links: &[Links<Section>]) {
        let Line { study, layout, cells, .. } = self;
        let between = |at: usize| self.neighbours(at);
        let bridges = study.model().bridges(cells, links, &between, &Rayon);
        let numbers = numbers(cells, links, &bridges);
        found.events.extend(events(cells, links, &bridges, &numbers));
        self.note(&numbers, &mut found.of_case);
        if let ([cell], 1) = (&cells[..], layout.lines()) {
            let numbered = cell.order.iter().map(|&place| cell.attractors[place].clone());
            found.of_starts = numbered.collect();
        }
    }

    /// Notes the number of each case's attractor.
    fn note(&self, numbers: &[Vec<u32>], of_case: &mut [Option<u32>]) {
        for (at, (cell, numbers)) in self.cells.iter().zip(numbers).enumerate() {
            for (place, attractor) in cell.of_case.iter().enumerate() {
                let case = self.layout.case(self.number, at, place);
                of_case[case] = attractor.map(|attractor| numbers[attractor as usize]);
            }
        }
    }
}

/// What a thread computes of the places that it is given one after another, each with its place.
type OfThread<'a, T> = dyn Fn(&mut dyn FnMut() -> Option<usize>) -> Vec<(usize, T)> + Sync + 'a;

/// Computations on all threads, begun in the order of these places, each by the thread that has room for it. Their results by
/// rising places.
fn together<T: Send>(places: Vec<usize>, of_thread: &OfThread<'_, T>) -> Vec<T> {
    let taken = AtomicUsize::new(0);
    let compute = |_| of_thread(&mut || places.get(taken.fetch_add(1, Ordering::Relaxed)).copied());
    let threads = rayon::current_num_threads().min(places.len().div_ceil(LEAST));
    let mut results: Vec<(usize, T)> =
        (0..threads).into_par_iter().flat_map_iter(compute).collect();
    results.sort_by_key(|(place, _)| *place);
    results.into_iter().map(|(_, result)| result).collect()
}

/// The attractors of two cells between which the cases lead that have this one of the `directions` of a cell in
/// turn, each pair once.
fn leads(
    cells: &[Arc<Table<Section>>; 2],
    directions: &[Direction],
    direction: Direction,
) -> Vec<[usize; 2]> {
    let [low, high] = cells.each_ref().map(|cell| &cell.of_case);
    let both = low.iter().zip(high).zip(directions.iter().cycle());
    let mut pairs = Vec::new();
    for ((a, b), _) in both.filter(|(_, it)| **it == direction) {
        if let (Some(a), Some(b)) = (a, b)
            && !pairs.contains(&[*a as usize, *b as usize])
        {
            pairs.push([*a as usize, *b as usize]);
        }
    }
    pairs
}

/// The numbers of the attractors of a line, cell by cell.
fn numbers(
    cells: &[Arc<Table<Section>>],
    links: &[Links<Section>],
    bridges: &[Bridge<Section>],
) -> Vec<Vec<u32>> {
    let mut numbers: Vec<Vec<u32>> = Vec::with_capacity(cells.len());
    let mut count = 0;
    for (at, cell) in cells.iter().enumerate() {
        let before = |place: usize| {
            let pairs = &links[at.checked_sub(1)?].pairs;
            let pair = pairs.iter().find(|pair| pair[1] == place);
            let bridge = || bridges.iter().find(|bridge| bridge.to == [at, place]);
            let from = pair.map(|pair| [at - 1, pair[0]]).or_else(|| Some(bridge()?.from));
            from.map(|[at, place]| numbers[at][place])
        };
        let mut here = vec![0; cell.attractors.len()];
        for &place in &cell.order {
            here[place] = before(place).unwrap_or_else(|| {
                count += 1;
                count - 1
            });
        }
        numbers.push(here);
    }
    numbers
}

/// The events of a line, in the order of the parameter.
fn events(
    cells: &[Arc<Table<Section>>],
    links: &[Links<Section>],
    bridges: &[Bridge<Section>],
    numbers: &[Vec<u32>],
) -> Vec<AttractorEvent> {
    let mut events = Vec::new();
    let mut add = |[at, place]: [usize; 2], special: &SpecialValue<Section>| {
        events.push(AttractorEvent {
            kind: special.kind,
            attractor: numbers[at][place],
            case: cells[at].attractors[place].case,
            value: special.value,
            uncertainty: special.uncertainty,
            period: special.period,
            section: special.section,
        });
    };
    for (at, links) in links.iter().enumerate() {
        for side in [0, 1] {
            links.special[side].iter().for_each(|(place, it)| add([at + side, *place], it));
        }
    }
    for bridge in bridges {
        bridge.special.iter().for_each(|special| add(bridge.from, special));
    }
    events.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.attractor.cmp(&b.attractor)));
    // What two cells know of the same special point counts once.
    events.dedup_by(|b, a| a.is(b));
    events
}
