//! Which cases of a study share an attractor, how attractors go on along an axis, and where they change.

use std::collections::BTreeMap;
use std::marker::PhantomData;

use rayon::prelude::*;

use crate::branch::SpecialKind;
use crate::model::{Capsule, Locomotion, PrintedCapsule, Switching};
use crate::orbit::{Orbit, Section};

use super::cell::Cell;
use super::family::{Links, Neighbours};
use super::run::{RunError, pool};
use super::{Coordinate, Machine, Record, Study};
use crate::branch::natural::Along;

/// A change of an attractor along the axis, or its beginning or end.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractorEvent {
    /// What happens.
    pub kind: SpecialKind,
    /// The attractor, by its number on its line.
    pub attractor: usize,
    /// A case of the attractor beside the event, which tells the values of the other axes.
    pub case: usize,
    /// The value of the parameter of the axis.
    pub value: f64,
    /// How far the true value may be, as bisection has it.
    pub uncertainty: f64,
    /// Period of the orbit that changes [cycles].
    pub period: u64,
    /// Its section point there.
    pub section: Section,
}

/// The attractors of a study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attractors {
    /// The axis along which they are linked, by its place in the study; none where there is no single one.
    pub axis: Option<usize>,
    /// The attractor of each case, by its number; none where the case has none.
    ///
    /// They are numbered along each line of the axis anew, in the order in which they appear.
    pub of_case: Vec<Option<usize>>,
    /// The events, line by line in the order of the axis.
    pub events: Vec<AttractorEvent>,
}

/// Whether there are attractors to be told apart or followed: an axis is followed, or the only parameter that
/// varies, or cases differ in their start.
pub fn has_attractors(study: &Study) -> bool {
    linked_axis(study).is_some() || study.axes.iter().any(|axis| is_start(axis.coordinate))
}

/// Finds the attractors of a study from the `records` of its cases.
///
/// A periodic attractor is known by its certified orbit, see `Cell::sort` and `Neighbours::link`. Every
/// cell and every two neighbours are a task of their own, so that the threads do not matter.
pub fn attractors(
    study: &Study,
    records: &[Record],
    machine: Machine,
) -> Result<Attractors, RunError> {
    if !has_attractors(study) {
        return Ok(Attractors { of_case: vec![None; study.cases()], ..Attractors::default() });
    }
    let mut orbits = vec![None; study.cases()];
    for record in records {
        orbits[record.index] = Some(&record.orbit);
    }
    Ok(pool(machine.threads)?.install(|| match study.base.switching {
        Switching::Filippov => find::<Capsule<f64>>(study, &orbits),
        Switching::AsPrinted => find::<PrintedCapsule<f64>>(study, &orbits),
    }))
}

fn is_start(coordinate: Coordinate) -> bool {
    matches!(coordinate, Coordinate::StartR | Coordinate::StartY1 | Coordinate::StartY2)
}

/// The axis that is followed, or else the only parameter that varies.
fn linked_axis(study: &Study) -> Option<usize> {
    if let Some(follow) = &study.follow {
        return Some(follow.axis);
    }
    let is_parameter = |axis: &usize| !is_start(study.axes[*axis].coordinate);
    let mut varies = (0..study.axes.len()).filter(is_parameter);
    let first = varies.next()?;
    let alone = varies.next().is_none();
    let parameter = matches!(study.axes[first].coordinate, Coordinate::Parameter(_));
    (alone && parameter).then_some(first)
}

/// The cases of each cell, line by line along the axis; without one each cell is a line.
fn lines(study: &Study, axis: Option<usize>) -> Vec<Vec<Vec<usize>>> {
    let length = axis.map_or(1, |axis| study.axes[axis].values.len());
    let mut lines: BTreeMap<Vec<usize>, Vec<Vec<usize>>> = BTreeMap::new();
    for case in 0..study.cases() {
        let position = study.position(case);
        let others = study.axes.iter().enumerate().zip(&position);
        let key = others.filter(|((i, it), _)| Some(*i) != axis && !is_start(it.coordinate));
        let key = key.map(|(_, place)| *place).collect();
        let line = lines.entry(key).or_insert_with(|| vec![Vec::new(); length]);
        line[axis.map_or(0, |axis| position[axis])].push(case);
    }
    lines.into_values().collect()
}

fn find<S: Locomotion>(study: &Study, orbits: &[Option<&Orbit>]) -> Attractors {
    let axis = linked_axis(study);
    let sort = |cases: &Vec<usize>| {
        let known = |&case: &usize| Some((case, study.case(case), orbits[case]?));
        Cell::sort::<S>(&cases.iter().filter_map(known).collect::<Vec<_>>(), &study.protocol)
    };
    let lines: Vec<Vec<Cell>> =
        lines(study, axis).par_iter().map(|line| line.par_iter().map(sort).collect()).collect();
    let links: Vec<Vec<Links>> = lines
        .par_iter()
        .map(|line| {
            line.par_windows(2)
                .enumerate()
                .map(|(at, cells)| link::<S>(study, axis, at, [&cells[0], &cells[1]]))
                .collect()
        })
        .collect();
    let mut attractors =
        Attractors { axis, of_case: vec![None; study.cases()], events: Vec::new() };
    for (line, links) in lines.iter().zip(&links) {
        attractors.add_line(line, links);
    }
    attractors
}

/// The links between the cells at a place of the axis and at the next.
fn link<S: Locomotion>(study: &Study, axis: Option<usize>, at: usize, cells: [&Cell; 2]) -> Links {
    let parameter = axis.and_then(|axis| match study.axes[axis].coordinate {
        Coordinate::Parameter(parameter) => Some((parameter, &study.axes[axis].values)),
        _ => None,
    });
    let (Some((parameter, values)), Some(first)) = (parameter, cells[0].cases.first()) else {
        return Links::default();
    };
    let directions: Vec<_> = cells[0].cases.iter().map(|&case| study.direction(case)).collect();
    let case = study.case(*first);
    let along = Along { case, parameter, protocol: &study.protocol, system: PhantomData::<S> };
    let values = [values[at], values[at + 1]];
    Neighbours { along, values, cells, directions: &directions }.link()
}

impl Attractors {
    /// Numbers the attractors of a line and notes their events.
    fn add_line(&mut self, cells: &[Cell], links: &[Links]) {
        let mut numbers: Vec<Vec<usize>> = Vec::new();
        let mut count = 0;
        for (at, cell) in cells.iter().enumerate() {
            let before = |place: usize| {
                let pairs = &links[at.checked_sub(1)?].pairs;
                let pair = pairs.iter().find(|pair| pair[1] == place)?;
                Some(numbers[at - 1][pair[0]])
            };
            let here: Vec<Option<usize>> = (0..cell.attractors.len()).map(before).collect();
            let number = |known: Option<usize>| {
                known.unwrap_or_else(|| {
                    count += 1;
                    count - 1
                })
            };
            numbers.push(here.into_iter().map(number).collect());
            for (&case, place) in cell.cases.iter().zip(&cell.of_case) {
                self.of_case[case] = place.map(|place| numbers[at][place]);
            }
        }
        for (at, links) in links.iter().enumerate() {
            self.add_events(&cells[at..at + 2], &numbers[at..at + 2], links);
        }
    }

    /// Notes the events between two neighbours, in the order of the parameter.
    fn add_events(&mut self, cells: &[Cell], numbers: &[Vec<usize>], links: &Links) {
        let mut events = Vec::new();
        for side in [0, 1] {
            for (place, change) in &links.changes[side] {
                events.push(AttractorEvent {
                    kind: change.kind,
                    attractor: numbers[side][*place],
                    case: cells[side].attractors[*place].case,
                    value: change.value,
                    uncertainty: change.uncertainty,
                    period: change.period as u64,
                    section: change.section,
                });
            }
        }
        events.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.attractor.cmp(&b.attractor)));
        self.events.extend(events);
    }
}
