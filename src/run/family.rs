//! Which attractors of two neighbouring cells are one, and their changes in between.

use crate::branch::SpecialKind;
use crate::capsule::Reading;
use crate::flow::Metric;
use crate::orbit::Outcome;

use super::change::{Change, branch_end, changes, straddles};
use super::natural::{Along, End, Solution};
use crate::attractor::{Attractor, Table, coincide};
use crate::study::Direction;

/// How the attractors of a cell go on in the next.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Links {
    /// Pairs of places, in this cell and in the next, that are one attractor.
    pub pairs: Vec<[usize; 2]>,
    /// Changes of attractors of this cell, by place, and of the next.
    pub changes: [Vec<(usize, Change)>; 2],
    /// Orbits of this cell, by place, that go on at the next one, where no case shows them.
    pub unseen: Vec<(usize, Unseen)>,
}

/// The attractors of the two cells, by place, whose orbits are known not to be one in the other cell.
#[derive(Default)]
struct Apart {
    /// The orbit ends in between.
    ended: [Vec<usize>; 2],
    /// The orbit attracts at the other value, where no case shows it.
    unseen: [Vec<usize>; 2],
}

/// An orbit at a value of the parameter where no case shows the attractor that it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The orbit.
    pub orbit: Solution,
    /// Whether it has lost its stability by a period doubling, so that the attractor is of twice the period.
    pub doubled: bool,
}

/// Two neighbouring cells along a parameter.
pub struct Neighbours<'a, R> {
    /// What is held, and the parameter.
    pub along: Along<'a, R>,
    /// Its two values.
    pub values: [f64; 2],
    /// The cells.
    pub cells: [&'a Table<3>; 2],
    /// The directions that the cases of a cell have in turn; none where the axis is not followed.
    pub directions: &'a [Direction],
}

impl<R: Reading> Neighbours<'_, R> {
    /// Links the attractors of the two cells.
    ///
    /// Periodic orbits by continuation, the shortest first, to the other cell; where an orbit has lost
    /// its stability at a period doubling in between, it goes on in the orbit of twice the period that lies
    /// on both sides of it. What is left by what the followed cases say, see [`Neighbours::led`].
    pub fn link(&self) -> Links {
        let mut links = Links::default();
        let mut apart = Apart::default();
        for (side, place) in self.periodic() {
            if !links.has(side, place) {
                self.follow(side, place, &mut links, &mut apart);
            }
        }
        self.led(&mut links, &apart);
        links.pairs.sort_unstable();
        links
    }

    /// Continues an orbit to the other cell and notes its changes.
    fn follow(&self, side: usize, place: usize, links: &mut Links, apart: &mut Apart) {
        let attractor = &self.cells[side].attractors[place];
        let Some(start) = self.solution(side, attractor) else { return };
        let to = self.values[1 - side];
        let (path, end) = self.along.follow(&start, to);
        let mut found = changes(&self.along, &path);
        let last = path.last().unwrap_or(&start);
        match end {
            End::Reached => {
                let here = Unseen { orbit: last.clone(), doubled: doubles(&found) };
                let other = self.successor(side, links, &here);
                if other.is_none() {
                    apart.unseen[side].extend(here.orbit.attracts().then_some(place));
                    if side == 0 && here.is_followed() {
                        links.unseen.push((place, here));
                    }
                }
                links.pairs.extend(other.map(|other| match side {
                    0 => [place, other],
                    _ => [other, place],
                }));
            }
            End::Stopped(step) => {
                apart.ended[side].push(place);
                found.extend(branch_end(&self.along, &path, (to, step)));
            }
            End::Lost => {}
        }
        links.changes[side].extend(found.into_iter().map(|change| (place, change)));
    }

    /// The periodic attractors by side and place, the shortest periods first: beside a period doubling it
    /// is the shorter orbit that goes on, while the longer one ends.
    fn periodic(&self) -> Vec<(usize, usize)> {
        let mut all: Vec<(usize, usize, usize)> = Vec::new();
        for (side, cell) in self.cells.iter().enumerate() {
            let attractors = cell.attractors.iter().enumerate();
            let periodic = attractors.filter(|(_, it)| it.outcome == Outcome::Periodic);
            all.extend(periodic.map(|(place, it)| (it.points.len(), side, place)));
        }
        all.sort_unstable();
        all.into_iter().map(|(_, side, place)| (side, place)).collect()
    }

    /// The orbit of an attractor at its value of the parameter.
    fn solution(&self, side: usize, attractor: &Attractor<3>) -> Option<Solution> {
        let Attractor { points, bound, size, .. } = attractor;
        self.along.known(self.values[side], points, bound / size)
    }

    /// The attractor of the other cell that belongs to an orbit that was followed there.
    fn successor(&self, side: usize, links: &Links, here: &Unseen) -> Option<usize> {
        let metric = self.along.metric(here.orbit.value);
        let is_next = |(place, other): &(usize, &Attractor<3>)| {
            !links.has(1 - side, *place) && here.belongs_to(other, &metric)
        };
        let mut others = self.cells[1 - side].attractors.iter().enumerate();
        others.find(is_next).map(|(place, _)| place)
    }

    /// Links what continuation has left, by what the followed cases say.
    ///
    /// Two attractors are one if the upward cases lead from the first to the second and the downward ones
    /// back; where the axis is followed in one direction only, if they lead so and neither orbit ends on
    /// the way; where it is not followed, if both are the only ones left that do not repeat. An orbit that
    /// is known to attract at the other value is no other attractor there. It breaks where a followed case
    /// falls from one such attractor to another beside it in both directions.
    fn led(&self, links: &mut Links, apart: &Apart) {
        let upward = self.leads(Direction::Upward);
        let downward = self.leads(Direction::Downward);
        let follows = |direction| self.directions.contains(&direction);
        let among = |places: &[Vec<usize>; 2], [a, b]: &[usize; 2]| {
            places[0].contains(a) || places[1].contains(b)
        };
        let mut pairs = match (follows(Direction::Upward), follows(Direction::Downward)) {
            (true, true) => upward.into_iter().filter(|pair| downward.contains(pair)).collect(),
            (false, false) => self.only_ones(links),
            _ => {
                let mut pairs = [upward, downward].concat();
                pairs.retain(|pair| !among(&apart.ended, pair));
                pairs
            }
        };
        pairs.retain(|pair| !among(&apart.unseen, pair));
        for [a, b] in pairs {
            if !links.has(0, a) && !links.has(1, b) {
                links.pairs.push([a, b]);
            }
        }
    }

    /// The attractors of the two cells between which the cases followed in a direction lead, each pair once.
    fn leads(&self, direction: Direction) -> Vec<[usize; 2]> {
        let [low, high] = self.cells.map(|cell| &cell.of_case);
        let both = low.iter().zip(high).zip(self.directions.iter().cycle());
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

    /// The attractors that do not repeat, where each cell has just one that is not linked.
    fn only_ones(&self, links: &Links) -> Vec<[usize; 2]> {
        let left = |side: usize| {
            let attractors = self.cells[side].attractors.iter().enumerate();
            let mut left = attractors
                .filter(|(place, it)| it.outcome != Outcome::Periodic && !links.has(side, *place));
            let first = left.next().map(|(place, it)| (place, it.outcome));
            first.filter(|_| left.next().is_none())
        };
        match (left(0), left(1)) {
            (Some((a, first)), Some((b, second))) if first == second => vec![[a, b]],
            _ => Vec::new(),
        }
    }
}

/// Whether a period doubling is among the changes of an orbit.
pub fn doubles(changes: &[Change]) -> bool {
    changes.iter().any(|change| change.kind == SpecialKind::PeriodDoubling)
}

impl Unseen {
    /// Whether it is worth following on.
    pub fn is_followed(&self) -> bool {
        self.doubled || self.orbit.attracts()
    }

    /// Whether the attractor at the same parameters is its own.
    pub fn belongs_to(&self, attractor: &Attractor<3>, metric: &Metric<3>) -> bool {
        let Attractor { outcome, points, bound, size, .. } = attractor;
        let Unseen { orbit, doubled } = self;
        let bound = bound + orbit.size * orbit.error.max(bound / size);
        *outcome == Outcome::Periodic
            && (coincide(&orbit.points, points, bound, metric)
                || (*doubled && straddles(points, &orbit.points, metric)))
    }
}

impl Links {
    fn has(&self, side: usize, place: usize) -> bool {
        self.pairs.iter().any(|pair| pair[side] == place)
    }
}
