//! Which attractors of two neighbouring cells are one, and their special points in between.

use std::sync::Arc;

use super::identity::{Attractor, coincide, relative_bound};
use super::table::Table;
use crate::branch::{
    Along, Linearised, PeriodicOrbit, SegmentEnd, SpecialKind, SpecialValue, leads_to, linearised,
    succession,
};
use crate::flow::{Metric, System};
use crate::orbit::matrix::least_from_one;
use crate::orbit::passage::Integrator;
use crate::orbit::{Outcome, Protocol};

/// How the attractors of a cell continue in the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Links<P> {
    /// Pairs of places, in this cell and in the next, that are one attractor.
    pub pairs: Vec<[usize; 2]>,
    /// Special points of attractors of this cell, by place, and of the next.
    pub special: [Vec<(usize, SpecialValue<P>)>; 2],
    /// Orbits at the next cell, stable there, in which attractors of this one go on, by place, but that no case shows.
    pub unseen: Vec<(usize, PeriodicOrbit<P>)>,
}

impl<P> Default for Links<P> {
    fn default() -> Self {
        Links { pairs: Vec::new(), special: [Vec::new(), Vec::new()], unseen: Vec::new() }
    }
}

impl<P> Links<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q + Copy) -> Links<Q> {
        let Links { pairs, special, unseen } = self;
        let special =
            special.map(|side| side.into_iter().map(|(place, it)| (place, it.map(held))).collect());
        let unseen = unseen.into_iter().map(|(place, it)| (place, it.map(held))).collect();
        Links { pairs, special, unseen }
    }

    /// Whether an attractor of a side is linked.
    fn has(&self, side: usize, place: usize) -> bool {
        self.pairs.iter().any(|pair| pair[side] == place)
    }
}

/// Whether an orbit that was continued to the parameters of an attractor is that attractor.
pub(super) fn is_reached<const D: usize>(
    orbit: &PeriodicOrbit<[f64; D]>,
    attractor: &Attractor<[f64; D]>,
    metric: &Metric<D>,
    protocol: &Protocol,
) -> bool {
    let Attractor { outcome, points, bound, size, .. } = attractor;
    let from_one = least_from_one(&orbit.multipliers);
    let own = relative_bound(orbit.residual, from_one, protocol).max(bound / size);
    let own_size = metric.largest(&orbit.points);
    *outcome == Outcome::Periodic && coincide(&orbit.points, points, bound + own * own_size, metric)
}

/// The attractors of the two cells, by place, whose orbits are known not to be one in the other cell.
#[derive(Default)]
struct Apart {
    /// The orbit ends in between.
    ended: [Vec<usize>; 2],
    /// The orbit is stable at the other value, where no case shows it.
    unseen: [Vec<usize>; 2],
}

impl Apart {
    /// Whether one of the two attractors is among these.
    fn among(places: &[Vec<usize>; 2], [a, b]: &[usize; 2]) -> bool {
        places[0].contains(a) || places[1].contains(b)
    }
}

/// Two neighbouring cells along a parameter.
pub struct Neighbours<M: System<D>, const D: usize> {
    /// What is held, and the parameter.
    pub along: Along<M, D>,
    /// How closely orbits are computed.
    pub protocol: Protocol,
    /// The two values of the parameter.
    pub values: [f64; 2],
    /// The cells.
    pub cells: [Arc<Table<[f64; D]>>; 2],
    /// Pairs of places, in the first cell and in the second, between which cases lead that inherit their start from
    /// the first cell, and from the second; none where no case does.
    pub inherited: [Option<Vec<[usize; 2]>>; 2],
}

impl<M: System<D>, const D: usize> Neighbours<M, D> {
    /// Links the attractors of the two cells.
    ///
    /// Periodic ones by continuation to the other cell, see [`succession`]. Those that do not repeat by the cases that
    /// inherit their start, see `Neighbours::inherit`. An attractor that is linked by neither is listed as unresolved, unless
    /// continuation has shown how it goes on.
    ///
    /// `linear` are the attractors of both cells by place, as [`linear_orbits`] has them.
    pub fn link(
        &self,
        integrator: &dyn Integrator<M, D>,
        linear: [&LinearOrbits<M, D>; 2],
    ) -> Links<[f64; D]> {
        let (mut links, mut apart) = (Links::default(), Apart::default());
        let [periodic, mut lost] = self.by_outcome();
        for &(side, place) in &periodic {
            if !links.has(side, place)
                && let Some(other) = self.direct(side, place, &links, linear)
            {
                links.pairs.push(pair(side, place, other));
            }
        }
        for (side, place) in periodic {
            if !links.has(side, place)
                && !self.continued(integrator, side, place, &mut links, &mut apart)
            {
                lost.push((side, place));
            }
        }
        self.inherit(&mut links, &apart);
        for (side, place) in lost {
            if !links.has(side, place) {
                let unresolved = self.unresolved(&links.special[side], side, place);
                links.special[side].push((place, unresolved));
            }
        }
        links.pairs.sort_unstable();
        links
    }

    /// The attractor of the other cell to which the branch of an orbit leads in a single step, if it does.
    fn direct(
        &self,
        side: usize,
        place: usize,
        links: &Links<[f64; D]>,
        linear: [&LinearOrbits<M, D>; 2],
    ) -> Option<usize> {
        let from = linear[side].get(place)?.as_ref()?;
        let others = linear[1 - side].iter().enumerate();
        let mut unlinked = others.filter(|(place, _)| !links.has(1 - side, *place));
        let next = unlinked
            .find(|(_, other)| other.as_ref().is_some_and(|to| leads_to(&self.along, from, to)));
        next.map(|(place, _)| place)
    }

    /// Continues a periodic attractor to the other cell and notes its special points; whether it is known how it goes on.
    fn continued(
        &self,
        integrator: &dyn Integrator<M, D>,
        side: usize,
        place: usize,
        links: &mut Links<[f64; D]>,
        apart: &mut Apart,
    ) -> bool {
        let points = &self.cells[side].attractors[place].points;
        let [from, to] = [self.values[side], self.values[1 - side]];
        let Some(found) = succession(integrator, &self.along, (from, points), to) else {
            return false;
        };
        links.special[side].extend(found.special.into_iter().map(|it| (place, it)));
        match found.end {
            SegmentEnd::Reached(orbit) => {
                match self.successor(side, links, &orbit) {
                    Some(other) => links.pairs.push(pair(side, place, other)),
                    None if orbit.is_stable() => {
                        apart.unseen[side].push(place);
                        links.unseen.extend((side == 0).then_some((place, orbit)));
                    }
                    None => {}
                }
                true
            }
            SegmentEnd::Ended => {
                apart.ended[side].push(place);
                true
            }
            SegmentEnd::Merged | SegmentEnd::Lost => false,
        }
    }

    /// Note that it is not known how an attractor goes on from the last of its `special` points, or from its own cell, to the
    /// other cell. One that does not repeat has no period, and no section point of its own.
    fn unresolved(
        &self,
        special: &[(usize, SpecialValue<[f64; D]>)],
        side: usize,
        place: usize,
    ) -> SpecialValue<[f64; D]> {
        let [cell, to] = [self.values[side], self.values[1 - side]];
        let Attractor { outcome, points, .. } = &self.cells[side].attractors[place];
        let orbit = points.first().filter(|_| *outcome == Outcome::Periodic);
        let own = orbit.map_or((0, [f64::NAN; D]), |point| (points.len() as u64, *point));
        let last = special.iter().rev().find(|(of, _)| *of == place).map(|(_, last)| last);
        let (period, section) = last.map_or(own, |last| (last.period, last.section));
        let from = last.map_or(cell, |last| last.value);
        SpecialValue {
            kind: SpecialKind::Unresolved,
            value: 0.5 * (from + to),
            uncertainty: 0.5 * (to - from).abs(),
            period,
            section,
            is_stable_beyond: false,
        }
    }

    /// The attractors by side and place: the periodic ones, the shortest periods first, which take least to continue, and those
    /// that do not repeat.
    fn by_outcome(&self) -> [Vec<(usize, usize)>; 2] {
        let sides = self.cells.iter().enumerate();
        let all = sides
            .flat_map(|(side, cell)| (0..cell.attractors.len()).map(move |place| (side, place)));
        let (mut periodic, others): (Vec<_>, Vec<_>) =
            all.partition(|&(side, place)| self.repeats(side, place));
        periodic.sort_by_key(|&(side, place)| self.cells[side].attractors[place].points.len());
        [periodic, others]
    }

    /// Whether an attractor is periodic.
    fn repeats(&self, side: usize, place: usize) -> bool {
        self.cells[side].attractors[place].outcome == Outcome::Periodic
    }

    /// The attractor of the other cell that is the orbit that was continued to it.
    fn successor(
        &self,
        side: usize,
        links: &Links<[f64; D]>,
        orbit: &PeriodicOrbit<[f64; D]>,
    ) -> Option<usize> {
        let metric = self.along.metric(orbit.value);
        let mut others = self.cells[1 - side].attractors.iter().enumerate();
        let next = others.find(|(place, other)| {
            !links.has(1 - side, *place) && is_reached(orbit, other, &metric, &self.protocol)
        });
        next.map(|(place, _)| place)
    }

    /// Links what continuation has left, by the cases that inherit their start.
    ///
    /// Two attractors are one if cases lead from one to the other, see `Neighbours::led`, or, where no start is inherited, if
    /// both are the only ones left that do not repeat. An orbit that is known to be stable at the other value is no other
    /// attractor there, two that repeat are never linked so, and neither is one to which several lead.
    fn inherit(&self, links: &mut Links<[f64; D]>, apart: &Apart) {
        let mut pairs = match &self.inherited {
            [None, None] => self.only_ones(links),
            [upward, downward] => {
                let [upward, downward] = [upward, downward].map(|it| it.as_deref().unwrap_or(&[]));
                Self::led(upward, downward, apart)
            }
        };
        pairs.retain(|[a, b]| !links.has(0, *a) && !links.has(1, *b));
        pairs.retain(|pair| !Apart::among(&apart.unseen, pair));
        pairs.retain(|[a, b]| !(self.repeats(0, *a) && self.repeats(1, *b)));
        // Each shares a place with itself.
        links.pairs.extend(
            pairs
                .iter()
                .filter(|[a, b]| pairs.iter().filter(|[c, d]| a == c || b == d).count() == 1),
        );
    }

    /// The pairs of which cases say that they are one: upward ones lead from the first to the second, and downward ones back.
    ///
    /// Where no case of the other direction begins at the attractor that is reached, one direction is enough, unless either
    /// orbit is known to end between the two values. Breaks: where a case falls from one attractor to another beside it, and one
    /// of the other direction falls back, or none begins there.
    fn led(upward: &[[usize; 2]], downward: &[[usize; 2]], apart: &Apart) -> Vec<[usize; 2]> {
        let both = upward.iter().filter(|pair| downward.contains(pair));
        let mut pairs: Vec<[usize; 2]> = both.copied().collect();
        for (there, back, reached) in [(upward, downward, 1), (downward, upward, 0)] {
            pairs.extend(there.iter().filter(|pair| {
                back.iter().all(|other| other[reached] != pair[reached])
                    && !Apart::among(&apart.ended, pair)
            }));
        }
        pairs
    }

    /// The attractors that do not repeat, where each cell has just one that is not linked.
    fn only_ones(&self, links: &Links<[f64; D]>) -> Vec<[usize; 2]> {
        match (self.only_one(0, links), self.only_one(1, links)) {
            (Some((a, first)), Some((b, second))) if first == second => vec![[a, b]],
            _ => Vec::new(),
        }
    }

    /// The one attractor of a cell that does not repeat and is not linked; none where there are several.
    fn only_one(&self, side: usize, links: &Links<[f64; D]>) -> Option<(usize, Outcome)> {
        let attractors = self.cells[side].attractors.iter().enumerate();
        let mut left = attractors
            .filter(|(place, it)| it.outcome != Outcome::Periodic && !links.has(side, *place));
        let first = left.next().map(|(place, it)| (place, it.outcome));
        first.filter(|_| left.next().is_none())
    }
}

/// The pair of an attractor of one side and one of the other.
fn pair(side: usize, place: usize, other: usize) -> [usize; 2] {
    if side == 0 { [place, other] } else { [other, place] }
}

/// The attractors of a cell by place with their derivatives; none where they do not repeat.
pub type LinearOrbits<M, const D: usize> = [Option<Linearised<<M as System<D>>::Event, D>>];

/// The attractors of a cell at a value of a parameter, with their derivatives.
pub fn linear_orbits<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    value: f64,
    cell: &Table<[f64; D]>,
) -> Vec<Option<Linearised<M::Event, D>>> {
    let orbits = cell.attractors.iter().map(|it| match it.outcome {
        Outcome::Periodic => linearised(integrator, along, value, &it.points),
        _ => None,
    });
    orbits.collect()
}
