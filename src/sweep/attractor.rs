//! Which cases of a study share an attractor, how attractors go on along an axis, and where they change.

use std::collections::BTreeMap;
use std::marker::PhantomData;

use rayon::prelude::*;

use crate::branch::SpecialKind;
use crate::model::{Capsule, Locomotion, PrintedCapsule, Switching};
use crate::orbit::{Orbit, Section};

use super::bridge::{Bridge, bridges};
use super::cell::Cell;
use super::change::Change;
use super::family::{Links, Neighbours};
use super::run::{RunError, pool};
use super::{Coordinate, Machine, Record, Study};
use crate::branch::natural::{Along, ROUNDING};

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

impl AttractorEvent {
    /// Whether another event, as it was located, can be this one.
    fn is(&self, other: &AttractorEvent) -> bool {
        let apart = (self.value - other.value).abs();
        (self.kind, self.attractor, self.period) == (other.kind, other.attractor, other.period)
            && apart <= self.uncertainty + other.uncertainty + ROUNDING * self.value.abs()
    }
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
    /// The events, line by line in the order of the parameter.
    pub events: Vec<AttractorEvent>,
}

/// Whether there are attractors to be told apart or followed: an axis is followed, or the only parameter that
/// varies, or cases differ in their start.
pub fn has_attractors(study: &Study) -> bool {
    linked_axis(study).is_some() || study.axes.iter().any(|axis| is_start(axis.coordinate))
}

/// Pairs of neighbouring cells between which attractors are linked.
pub fn links(study: &Study) -> usize {
    let pairs = |axis: usize| {
        let others = study.axes.iter().enumerate().filter(|(at, _)| *at != axis);
        let lines =
            others.filter(|(_, it)| !is_start(it.coordinate)).map(|(_, it)| it.values.len());
        lines.product::<usize>() * study.axes[axis].values.len().saturating_sub(1)
    };
    linked_axis(study).map_or(0, pairs)
}

/// Finds the attractors of a study from the `records` of its cases; calls `linked` after each link.
///
/// A periodic attractor is known by its certified orbit, see `Cell::sort` and `Neighbours::link`. Every
/// cell and every two neighbours are a task of their own, so that the threads do not matter.
pub fn attractors(
    study: &Study,
    records: &[Record],
    machine: Machine,
    linked: impl Fn() + Sync,
) -> Result<Attractors, RunError> {
    if !has_attractors(study) {
        return Ok(Attractors { of_case: vec![None; study.cases()], ..Attractors::default() });
    }
    let mut orbits = vec![None; study.cases()];
    for record in records {
        orbits[record.index] = Some(&record.orbit);
    }
    Ok(pool(machine.threads)?.install(|| match study.base.switching {
        Switching::Filippov => find::<Capsule<f64>>(study, &orbits, &linked),
        Switching::AsPrinted => find::<PrintedCapsule<f64>>(study, &orbits, &linked),
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

fn find<S: Locomotion>(
    study: &Study,
    orbits: &[Option<&Orbit>],
    linked: impl Fn() + Sync,
) -> Attractors {
    let axis = linked_axis(study);
    let sort = |cases: &Vec<usize>| {
        let known = |&case: &usize| Some((case, study.case(case), orbits[case]?));
        Cell::sort::<S>(&cases.iter().filter_map(known).collect::<Vec<_>>(), &study.protocol)
    };
    let lines: Vec<Vec<Cell>> =
        lines(study, axis).par_iter().map(|line| line.par_iter().map(sort).collect()).collect();
    let mut attractors =
        Attractors { axis, of_case: vec![None; study.cases()], events: Vec::new() };
    let found: Vec<(Vec<Links>, Vec<Bridge>)> = lines
        .par_iter()
        .map(|line| {
            let between = |at: usize| neighbours::<S>(study, axis, at, line);
            let link = |at: usize| {
                let links = between(at).map_or_else(Links::default, |it| it.link());
                linked();
                links
            };
            let last = line.len().saturating_sub(1);
            let links: Vec<Links> = (0..last).into_par_iter().map(link).collect();
            let bridges = bridges(line, &links, between);
            (links, bridges)
        })
        .collect();
    for (line, (links, bridges)) in lines.iter().zip(&found) {
        attractors.add_line(line, links, bridges);
    }
    attractors
}

/// The cells of a line at a place of the axis and at the next; none where the axis is no parameter.
fn neighbours<'a, S: Locomotion>(
    study: &'a Study,
    axis: Option<usize>,
    at: usize,
    line: &'a [Cell],
) -> Option<Neighbours<'a, S>> {
    let axis = &study.axes[axis?];
    let Coordinate::Parameter(parameter) = axis.coordinate else { return None };
    let case = study.case(*line[at].cases.first()?);
    let along = Along { case, parameter, protocol: &study.protocol, system: PhantomData::<S> };
    let values = [axis.values[at], axis.values[at + 1]];
    let directions = line[at].cases.iter().map(|&case| study.direction(case)).collect();
    Some(Neighbours { along, values, cells: [&line[at], &line[at + 1]], directions })
}

impl Attractors {
    /// Numbers the attractors of a line and notes their events, in the order of the parameter.
    fn add_line(&mut self, cells: &[Cell], links: &[Links], bridges: &[Bridge]) {
        let mut numbers: Vec<Vec<usize>> = Vec::new();
        let mut count = 0;
        for (at, cell) in cells.iter().enumerate() {
            let before = |place: usize| {
                let pairs = &links[at.checked_sub(1)?].pairs;
                let pair = pairs.iter().find(|pair| pair[1] == place);
                let bridge = || bridges.iter().find(|bridge| bridge.to == [at, place]);
                let from = pair.map(|pair| [at - 1, pair[0]]).or_else(|| Some(bridge()?.from));
                from.map(|[at, place]| numbers[at][place])
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
        let mut events = Vec::new();
        let mut add = |[at, place]: [usize; 2], change: &Change| {
            events.push(AttractorEvent {
                kind: change.kind,
                attractor: numbers[at][place],
                case: cells[at].attractors[place].case,
                value: change.value,
                uncertainty: change.uncertainty,
                period: change.period as u64,
                section: change.section,
            });
        };
        for (at, links) in links.iter().enumerate() {
            for side in [0, 1] {
                links.changes[side].iter().for_each(|(place, it)| add([at + side, *place], it));
            }
        }
        for bridge in bridges {
            bridge.changes.iter().for_each(|change| add(bridge.from, change));
        }
        events.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.attractor.cmp(&b.attractor)));
        // What two cells know of the same change counts once.
        events.dedup_by(|b, a| a.is(b));
        self.events.extend(events);
    }
}
