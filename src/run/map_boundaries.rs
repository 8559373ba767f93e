//! The boundaries between the regions of a map of two parameters, located between neighbouring cases and followed as curves.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::boundary_try::{Located, MotionKind, Tried, Try};
use super::cases::{RunError, pool};
use super::map_plane::{MapPlane, Neighbours, Place, passes};
use crate::branch::{Curve, SpecialKind};
use crate::description::Section;
use crate::motion::branch::Found;
use crate::study::{Boundaries, CaseSet, Continuation, Study};

/// Pairs that are tried side by side, whatever the number of threads: what one finds spares others.
const AT_A_TIME: usize = 16;

/// What is known of the pairs of neighbours of two kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairState {
    /// A boundary that is followed passes between them.
    OnCurve = 0,
    /// The motion of one goes on to the other, beside its own: both parameters have several motions there.
    SeveralMotions,
    /// No special point that could be followed was found on the orbit of either side.
    NotLocated,
    /// Not tried, as so many pairs were tried as the study allows.
    NotTried,
}

impl PairState {
    /// Each by its name in files, in the order of declaration.
    pub const NAMES: [(&str, PairState); 4] = [
        ("on-a-curve", PairState::OnCurve),
        ("several-motions", PairState::SeveralMotions),
        ("not-located", PairState::NotLocated),
        ("not-tried", PairState::NotTried),
    ];
}

/// The boundaries of a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapBoundaries {
    /// What was followed, each from a pair of neighbours: the short branch between them, and the curves through its special points.
    pub followed: Vec<(Continuation, Found)>,
    /// Pairs of neighbours of two kinds, one of which at least repeats, by their states.
    pub pairs: [usize; PairState::NAMES.len()],
    /// Those of them that were tried.
    pub tries: [usize; PairState::NAMES.len()],
}

impl MapBoundaries {
    /// Curves that are followed.
    pub fn curves(&self) -> usize {
        self.followed.iter().map(|(_, found)| found.curves.len()).sum()
    }
}

/// The cases of a map.
pub struct MapCases<'a> {
    /// The kind of motion of each; none of a case that has none, or has not been computed.
    pub kinds: &'a [Option<MotionKind>],
    /// A section point of a case that repeats.
    pub section: &'a dyn Fn(usize) -> Option<Section>,
}

/// Follows the boundaries of the map of a study, which asks for it, on so many threads, all cores for none; calls `done` after each try and ends with the tries that
/// are under way once it breaks.
///
/// Method: where two neighbours differ, the orbit of each that repeats is continued to the other, and a curve is followed through
/// each special point at which its stability or its impacts change. All pairs that a curve passes between are settled by it, if
/// its orbits have the period of one side; others are tried, evenly spread, until none is left or so many as the study allows
/// have been. Of two curves of one kind and period through one point the first is kept.
///
/// Guarantees: the result does not depend on the threads.
pub fn map_boundaries(
    study: &Study,
    asked: &Boundaries,
    cases: &MapCases<'_>,
    threads: Option<usize>,
    done: impl Fn() -> ControlFlow<()> + Sync,
) -> Result<MapBoundaries, RunError> {
    // Draws are no map, and no study that can be read asks for its boundaries.
    let CaseSet::Grid(grid) = &study.case_set else { return Ok(MapBoundaries::default()) };
    let mut search = Search::new(MapPlane::of(grid), cases.kinds);
    let pool = pool(threads)?;
    let mut tried = 0;
    let is_stopped = AtomicBool::new(false);
    while tried < asked.most_tries && !is_stopped.load(Ordering::Relaxed) {
        let chosen = search.some_open(AT_A_TIME.min(asked.most_tries - tried));
        if chosen.is_empty() {
            break;
        }
        tried += chosen.len();
        let tries = chosen.iter().map(|pair| Try {
            study,
            asked,
            pair: *pair,
            kinds: pair.cases.map(|case| cases.kinds[case].as_ref()),
            sections: pair.cases.map(|case| (cases.section)(case)),
        });
        let tries: Vec<Try<'_>> = tries.collect();
        let results: Vec<Tried> = pool.install(|| {
            let each = tries.par_iter().with_max_len(1).map(|it| {
                let result = it.result();
                is_stopped.fetch_or(done().is_break(), Ordering::Relaxed);
                result
            });
            each.collect()
        });
        for (pair, result) in chosen.into_iter().zip(results) {
            search.take(pair, result, cases.kinds);
        }
    }
    Ok(search.end())
}

/// A search for boundaries.
struct Search {
    plane: MapPlane,
    /// What is known of each pair of neighbours of two kinds; none of those that are open.
    pairs: BTreeMap<Neighbours, Option<PairState>>,
    /// Those that were tried.
    tried: Vec<Neighbours>,
    followed: Vec<(Continuation, Found)>,
    /// The curves that are kept, as lines through the plane.
    lines: Vec<Line>,
}

/// A curve as a line through the plane of the map.
struct Line {
    kind: SpecialKind,
    period: u64,
    places: Vec<Place>,
}

impl Search {
    fn new(plane: MapPlane, kinds: &[Option<MotionKind>]) -> Search {
        let differ = |pair: &Neighbours| match pair.cases.map(|case| kinds[case].as_ref()) {
            [Some(one), Some(other)] => one != other,
            _ => false,
        };
        let pairs = plane.neighbours().filter(differ).map(|pair| (pair, None)).collect();
        Search { plane, pairs, tried: Vec::new(), followed: Vec::new(), lines: Vec::new() }
    }

    /// So many of the pairs that are open, evenly spread among them, or all.
    fn some_open(&self, count: usize) -> Vec<Neighbours> {
        let open = self.pairs.iter().filter(|(_, state)| state.is_none());
        let open: Vec<Neighbours> = open.map(|(pair, _)| *pair).collect();
        let count = count.min(open.len());
        (0..count).map(|at| open[(2 * at + 1) * open.len() / (2 * count)]).collect()
    }

    /// Takes note of the result of a try.
    fn take(&mut self, pair: Neighbours, result: Tried, kinds: &[Option<MotionKind>]) {
        let (located, otherwise) = match result {
            Tried::Located(located) => (located, PairState::OnCurve),
            Tried::GoesOn => (Vec::new(), PairState::SeveralMotions),
            Tried::NotLocated => (Vec::new(), PairState::NotLocated),
        };
        for it in located {
            self.keep(pair, it, kinds);
        }
        self.tried.push(pair);
        // What others of its round have found may settle it, too.
        let state = self.pairs.entry(pair).or_default();
        state.get_or_insert(otherwise);
    }

    /// Keeps the curves of a located boundary that are not known, and settles the pairs that they pass between.
    fn keep(&mut self, pair: Neighbours, located: Located, kinds: &[Option<MotionKind>]) {
        let Located { continuation, mut found, curves } = located;
        let mut kept = Vec::new();
        for number in curves {
            let (branch, special) = found.curves[number].through;
            let through = &found.branches[branch].special[special].point;
            let other =
                continuation.second.map_or(0.0, |(second, _)| continuation.parameters[second]);
            let at = self.plane.place(in_order(pair.axis, [through.parameter, other]));
            let Curve { kind, period, points, .. } = &found.curves[number];
            let known = self
                .lines
                .iter()
                .any(|it| (it.kind, it.period) == (*kind, *period) && passes(&it.places, at));
            if known {
                continue;
            }
            let places = points.iter().map(|it| self.plane.place(in_order(pair.axis, *it)));
            let line = Line { kind: *kind, period: *period, places: places.collect() };
            self.settle(&line, kinds);
            self.lines.push(line);
            kept.push(number);
        }
        if !kept.is_empty() {
            retain_curves(&mut found, &kept);
            let name = format!("boundary {}", self.followed.len() + 1);
            self.followed.push((Continuation { name, ..continuation }, found));
        }
    }

    /// Settles the open pairs of which one side has orbits as those of a line that passes between them.
    fn settle(&mut self, line: &Line, kinds: &[Option<MotionKind>]) {
        for crossed in self.plane.crossed(&line.places) {
            let mut sides = crossed.cases.iter().filter_map(|case| kinds[*case].as_ref());
            if !sides.any(|it| it.period == line.period) {
                continue;
            }
            if let Some(state) = self.pairs.get_mut(&crossed) {
                *state = Some(PairState::OnCurve);
            }
        }
    }

    fn end(self) -> MapBoundaries {
        let [mut pairs, mut tries] = [[0; PairState::NAMES.len()]; 2];
        for state in self.pairs.values() {
            pairs[state.unwrap_or(PairState::NotTried) as usize] += 1;
        }
        for state in self.tried.iter().filter_map(|pair| self.pairs[pair]) {
            tries[state as usize] += 1;
        }
        MapBoundaries { followed: self.followed, pairs, tries }
    }
}

/// The values of the parameter along an axis and of the other, in the order of the axes.
fn in_order(axis: usize, [along, other]: [f64; 2]) -> [f64; 2] {
    if axis == 0 { [along, other] } else { [other, along] }
}

/// Leaves out the curves that are not kept.
fn retain_curves(found: &mut Found, kept: &[usize]) {
    for special in found.branches.iter_mut().flat_map(|branch| &mut branch.special) {
        special.curve = special.curve.and_then(|it| kept.iter().position(|number| *number == it));
    }
    let curves = std::mem::take(&mut found.curves).into_iter().enumerate();
    let curves = curves.filter(|(number, _)| kept.contains(number));
    found.curves = curves.map(|(_, curve)| curve).collect();
}
