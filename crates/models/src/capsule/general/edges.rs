//! The edges of a drive: at which phases they are, and the straight lines between them.

use std::f64::consts::PI;

use capsulemap_engine::lane::{Lane, side_by_side};

use crate::capsule::parameter::Parameter;
use crate::capsule::shape::{DriveKind, Shape};
use crate::description::Parameters;
use crate::motion::reduced;

/// The most edges in a cycle.
const MOST_EDGES: usize = 4;
/// A section this close to an edge lies on it [turns].
const ON_EDGE: f64 = 1e-12;
/// The force between two edges: the part before the first edge of a cycle, and that after each.
const PARTS: usize = MOST_EDGES + 1;

/// The parts of a force, or of a prescribed velocity, that are straight lines in time, in the order of a cycle that begins at the section.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lines<L> {
    /// When each begins, since the start of the cycle [s].
    pub(super) begins: [L; PARTS],
    /// The force or the velocity there [N, m/s].
    pub(super) from: [L; PARTS],
    /// Its rate [N/s, m/s^2].
    pub(super) rate: [L; PARTS],
    /// The displacement there, of a prescribed velocity [m].
    pub(super) place: [L; PARTS],
}

side_by_side!(Lines {} with { begins, from, rate, place });

/// An edge within a turn that begins at phase 0.
#[derive(Clone, Copy)]
pub(super) struct Edge<L> {
    /// Where it is [turns].
    at: L,
    /// The force or the velocity after it [N, m/turn].
    pub(super) from: L,
    /// The rate of that after it [N/turn, m/turn^2].
    pub(super) rate: L,
    /// The displacement there, of a prescribed velocity [m].
    place: L,
}

/// The edges of a kind of drive, from phase 0 on.
pub(super) fn edges<L: Lane>(
    of: impl Fn(Parameter) -> L,
    kind: DriveKind,
) -> [Edge<L>; MOST_EDGES] {
    let zero = L::splat(0.0);
    let [duty, rise] = [Parameter::Duty, Parameter::Rise].map(&of);
    let high = of(Parameter::P0) + of(Parameter::Pd);
    let low = of(Parameter::P0) + of(Parameter::PLow);
    let edge = |at, from, rate| Edge { at, from, rate, place: zero };
    if kind.is_prescribed() {
        return phases(of, kind);
    }
    if kind == DriveKind::Trapezoid {
        // Edges that do not fit into the period make no drive: the case fails.
        let fits = rise.le(duty) & (duty + rise).le(L::splat(1.0));
        let low = L::select(fits, low, L::splat(f64::NAN));
        let rate = (high - low) / rise;
        return [
            edge(zero, low, rate),
            edge(rise, high, zero),
            edge(duty, high, -rate),
            edge(duty + rise, low, zero),
        ];
    }
    [edge(zero, high, zero), edge(duty, low, zero), edge(zero, low, zero), edge(zero, low, zero)]
}

/// The edges of a prescribed motion in phases, from phase 0 on.
fn phases<L: Lane>(of: impl Fn(Parameter) -> L, kind: DriveKind) -> [Edge<L>; MOST_EDGES] {
    let (zero, one, half) = (L::splat(0.0), L::splat(1.0), L::splat(0.5));
    let [stroke, duty, first, second] =
        [Parameter::Stroke, Parameter::Duty, Parameter::Share1, Parameter::Share2].map(of);
    let end = half * stroke;
    let nothing = Edge { at: zero, from: zero, rate: zero, place: -end };
    if kind == DriveKind::TwoPhase {
        let out = Edge { from: stroke / duty, ..nothing };
        let back = Edge { at: duty, from: -(stroke / (one - duty)), place: end, ..nothing };
        return [out, back, nothing, nothing];
    }
    // The velocities at the two inner edges, up and down, from what both ends and the whole turn have in common: no velocity and no
    // displacement. Phases that fill the turn leave none for the third: the case fails.
    let third = one - first - second;
    let third = L::select(zero.lt(third), third, L::splat(f64::NAN));
    let share = (second + third) / (first + second + second + third);
    let up = (stroke + stroke) / (first + second * share);
    let down = up * (first + second) / (second + third);
    [
        Edge { rate: up / first, ..nothing },
        Edge { at: first, from: up, rate: -((up + down) / second), place: half * up * first - end },
        Edge {
            at: first + second,
            from: -down,
            rate: down / third,
            place: half * down * third - end,
        },
        nothing,
    ]
}

/// The edge of a drive that lies at a phase [rad], as a share of the period from phase 0 on; none where there is none, or the one at
/// phase 0, which no parameter moves, unless the velocity jumps there.
pub fn edge_at(parameters: &Parameters, phase: f64) -> Option<f64> {
    let kind = Shape::of(parameters).drive;
    let edges = edges(|it| parameters[it], kind);
    let section = reduced(phase) / (2.0 * PI);
    let passed_over = if kind == DriveKind::TwoPhase { 0 } else { 1 };
    let later = edges.iter().take(kind.edges()).skip(passed_over);
    let near = |at: &f64| (at - section).abs() <= ON_EDGE;
    later.map(|edge| edge.at).find(near)
}

/// The parts of the force in the order of a cycle that begins at `phase`.
pub(super) fn lines<L: Lane>(
    of: impl Fn(Parameter) -> L,
    kind: DriveKind,
    omega: L,
    phase: f64,
) -> Lines<L> {
    let zero = L::splat(0.0);
    let count = kind.edges();
    let none = [zero; PARTS];
    let mut lines = Lines { begins: none, from: none, rate: none, place: none };
    if count == 0 {
        return lines;
    }
    let edges = edges(of, kind);
    let (section, period) = (L::splat(phase / (2.0 * PI)), L::splat(2.0 * PI) / omega);
    // How many edges of the turn lie before the section.
    let mut before = zero;
    for edge in &edges[..count] {
        before = before + L::select(edge.at.lt(section), L::splat(1.0), zero);
    }
    for place in 1..=count {
        for first in 0..=count {
            let which = first + place - 1;
            let (edge, turns) = (edges[which % count], L::splat((which / count) as f64));
            let is_here = (before - L::splat(first as f64)).abs().lt(L::splat(0.5));
            let begins = (edge.at - section + turns) * period;
            lines.begins[place] = L::select(is_here, begins, lines.begins[place]);
            let (mut from, mut rate) = (edge.from, edge.rate / period);
            if kind.is_prescribed() {
                (from, rate) = (from / period, rate / period);
            }
            lines.from[place] = L::select(is_here, from, lines.from[place]);
            lines.rate[place] = L::select(is_here, rate, lines.rate[place]);
            lines.place[place] = L::select(is_here, edge.place, lines.place[place]);
        }
    }
    // What is there at the section began with the last edge of the turn before.
    lines.begins[0] = lines.begins[count] - period;
    (lines.from[0], lines.rate[0]) = (lines.from[count], lines.rate[count]);
    lines.place[0] = lines.place[count];
    lines
}
