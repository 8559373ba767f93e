//! Which cases of a study share an attractor, how attractors go on along an axis, and where they change.

use std::cmp::Reverse;
use std::sync::Arc;

use rayon::prelude::*;

use super::cases::{Rayon, RunError, pool};
use super::infer::infer;
use super::inherited_pairs::leads;
use super::together::together;
use super::{FinalMotions, Machine};
use crate::attractor::{Attractor, Bridge, Label, Links, Table};
use crate::branch::{ONE_VALUE, SpecialKind, SpecialValue};
use crate::description::{Parameter, Section};
use crate::lane::Instructions;
use crate::model::{Along, Cell, LinearOrbits, Motions, Neighbours, Setting, Unlinked};
use crate::orbit::Varied;
use crate::study::layout::{Layout, linked_axis};
use crate::study::{Axis, CaseSet, Coordinate, Direction, Study, Varying};

/// Lines are searched together that have so many cells: links that take long fill the lanes.
const LINKS: usize = 32768;

/// A change of an attractor along the axis, or its beginning or end.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractorEvent {
    /// What happens.
    pub kind: SpecialKind,
    /// The attractor, by its number on its line.
    pub attractor: u32,
    /// A case of the attractor beside the event, which tells the values of the other axes.
    pub case: usize,
    /// The value of the parameter of the axis; along a path of several the place, which is whole at its places.
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
    match study.case_set {
        CaseSet::Grid(_) => {
            linked_axis(study).is_some() || study.axes().iter().any(Axis::is_of_starts)
        }
        CaseSet::Draws(_) => study.case_set.varied().iter().all(|it| it.is_start()),
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
        let lines: Vec<Line> =
            numbers.map(|number| Line::sorted(study, &layout, number, final_motions)).collect();
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
    if last == 0 || lines[0].varied(0).is_none() {
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
        model.links(
            instructions,
            &mut || next().and_then(|place| Some((place, unlinked(lines, &linear, place)?))),
            &mut || linked(),
        )
    });
    let mut links = links.into_iter();
    lines.iter().map(|_| links.by_ref().take(last).collect()).collect()
}

/// The cells of a link, by its place among those of some lines, with the derivatives of their orbits.
fn unlinked(lines: &[Line<'_>], linear: &[LinearOrbits], link: usize) -> Option<Unlinked> {
    let last = lines[0].cells.len() - 1;
    let (line, at) = (link / last, link % last);
    let neighbours = lines[line].neighbours(at)?;
    let both = match lines[line].has_one_direction() {
        true => [at, at + 1].map(|at| line * (last + 1) + at),
        false => [0, 1].map(|side| 2 * link + side),
    };
    Some(Unlinked { neighbours, linear: both.map(|place| linear[place].clone()) })
}

/// The attractors of all cells of some lines along a parameter, line by line, with their derivatives; along a path of several
/// parameters, which may have another direction before a cell than behind it, those of the two cells of each link.
fn linear_orbits(lines: &[Line<'_>], instructions: Instructions) -> Vec<LinearOrbits> {
    let (model, cells) = (lines[0].study.model(), lines[0].cells.len());
    let is_one = lines[0].has_one_direction();
    let length = if is_one { cells } else { 2 * (cells - 1) };
    together((0..lines.len() * length).collect(), &|next| {
        model.linear_orbits(instructions, &mut || {
            let place = next()?;
            let (line, at) = (&lines[place / length], place % length);
            let cell = match is_one {
                true => line.cell(at, at.min(cells - 2)),
                false => line.cell(at / 2 + at % 2, at / 2),
            };
            Some((place, cell?))
        })
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
        let line = Line { study, layout, number, cells: Vec::new() };
        let cells = (0..layout.cells()).into_par_iter();
        let cells = cells.map(|at| Arc::new(line.sorted_cell(at, final_motions))).collect();
        Line { cells, ..line }
    }

    /// The cases of the cell at a place of the axis, sorted by attractor.
    fn sorted_cell(&self, at: usize, final_motions: &FinalMotions) -> Table<Section> {
        let Line { study, layout, number, .. } = *self;
        let setting = Setting::of(&study.case(layout.case(number, at, 0)));
        let motions = Motions {
            count: layout.cases(),
            at: &|place| {
                let case = layout.case(number, at, place);
                (case, final_motions.get(case))
            },
        };
        study.model().table(&setting, motions, &study.protocol, &Rayon)
    }

    /// Whether one thing alone varies along the axis, so that orbits move in one direction there.
    fn has_one_direction(&self) -> bool {
        self.layout.axis.is_some_and(|axis| self.study.axes()[axis].single().is_some())
    }

    /// What varies from a place of the axis to the next, with its numbers at both; none where the axis is not of parameters.
    ///
    /// The number of a parameter is its value. Several along a path change in step, by the place between the two.
    fn varied(&self, at: usize) -> Option<(Varied<Parameter>, [f64; 2])> {
        let axis = &self.study.axes()[self.layout.axis?];
        let mut parameters = Vec::with_capacity(axis.varying.len());
        for Varying { coordinate, values } in &axis.varying {
            let Coordinate::Parameter(parameter) = *coordinate else { return None };
            parameters.push((parameter, [values[at], values[at + 1]]));
        }
        if let [(parameter, values)] = parameters[..] {
            return Some((Varied::One(parameter), values));
        }
        let places = [at as f64, (at + 1) as f64];
        Some((Varied::in_step(places, parameters.into_iter()), places))
    }

    /// What is held at a place of the axis where something varies.
    fn along(&self, at: usize, varied: Varied<Parameter>) -> Along {
        let Line { study, layout, number, .. } = *self;
        let setting = Setting::of(&study.case(layout.case(number, at, 0)));
        Along { setting, varied, tolerance: study.protocol.tolerance }
    }

    /// The cell at a place of the axis, which is one of the two of a link; none where the axis is not of parameters.
    fn cell(&self, at: usize, link: usize) -> Option<Cell> {
        let (varied, numbers) = self.varied(link)?;
        let (along, value) = (self.along(at, varied), numbers[at - link]);
        Some(Cell { along, value, table: self.cells[at].clone() })
    }

    /// The cells at a place of the axis and at the next; none where the axis is not of parameters.
    fn neighbours(&self, at: usize) -> Option<Neighbours> {
        let study = self.study;
        let (varied, values) = self.varied(at)?;
        let along = self.along(at, varied);
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
        let bridges = study.model().bridges(cells, links, &|at| self.neighbours(at), &Rayon);
        let linked = LinkedCells { cells, links, bridges: &bridges };
        let numbers = linked.numbers();
        found.events.extend(linked.events(&numbers));
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

/// The cells of a line, with how their attractors go on from one to another.
struct LinkedCells<'a> {
    cells: &'a [Arc<Table<Section>>],
    /// How the attractors of each cell go on in the next.
    links: &'a [Links<Section>],
    /// The attractors that no case of the cells between shows.
    bridges: &'a [Bridge<Section>],
}

impl LinkedCells<'_> {
    /// The numbers of the attractors, cell by cell.
    fn numbers(&self) -> Vec<Vec<u32>> {
        let mut numbers: Vec<Vec<u32>> = Vec::with_capacity(self.cells.len());
        let mut count = 0;
        for (at, cell) in self.cells.iter().enumerate() {
            let mut here = vec![0; cell.attractors.len()];
            for &place in &cell.order {
                let before = self.before(at, place).map(|[at, place]| numbers[at][place]);
                here[place] = before.unwrap_or_else(|| {
                    count += 1;
                    count - 1
                });
            }
            numbers.push(here);
        }
        numbers
    }

    /// The cell and the place of the attractor that goes on at this place of a cell; none where it begins there.
    fn before(&self, at: usize, place: usize) -> Option<[usize; 2]> {
        let last = at.checked_sub(1)?;
        match self.links[last].pairs.iter().find(|pair| pair[1] == place) {
            Some(pair) => Some([last, pair[0]]),
            None => Some(self.bridges.iter().find(|bridge| bridge.to == [at, place])?.from),
        }
    }

    /// The events, in the order of the parameter; `numbers` are those of the attractors.
    fn events(&self, numbers: &[Vec<u32>]) -> Vec<AttractorEvent> {
        let mut events = Vec::new();
        for (at, links) in self.links.iter().enumerate() {
            for side in [0, 1] {
                for (place, special) in &links.special[side] {
                    events.push(self.event(numbers, [at + side, *place], special));
                }
            }
        }
        for bridge in self.bridges {
            for special in &bridge.special {
                events.push(self.event(numbers, bridge.from, special));
            }
        }
        events.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.attractor.cmp(&b.attractor)));
        // What two cells know of the same special point counts once.
        events.dedup_by(|b, a| a.is(b));
        events
    }

    /// A special point of the attractor at a place of a cell.
    fn event(
        &self,
        numbers: &[Vec<u32>],
        [at, place]: [usize; 2],
        special: &SpecialValue<Section>,
    ) -> AttractorEvent {
        AttractorEvent {
            kind: special.kind,
            attractor: numbers[at][place],
            case: self.cells[at].attractors[place].case,
            value: special.value,
            uncertainty: special.uncertainty,
            period: special.period,
            section: special.section,
        }
    }
}
