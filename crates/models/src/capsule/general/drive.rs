//! The drives of the family: one or two harmonics, or pulses whose edges are known times of the cycle.

use std::f64::consts::PI;

use capsulemap_engine::lane::{Lane, Mask, Series, series, side_by_side};

use crate::capsule::drive::Drive;
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

/// The parts of a force that are straight lines in time, in the order of a cycle that begins at the section.
#[derive(Debug, Clone, Copy)]
struct Lines<L> {
    /// When each begins, since the start of the cycle [s].
    begins: [L; PARTS],
    /// The force there [N].
    from: [L; PARTS],
    /// Its rate [N/s].
    rate: [L; PARTS],
}

side_by_side!(Lines {} with { begins, from, rate });

/// A drive whose force is a sum of two harmonics, or made of lines between edges.
///
/// Assumes: no edge but the one at phase 0 is at the section; that one is due at the start of each cycle, so that no section depends
/// on it.
#[derive(Debug, Clone, Copy)]
pub struct PiecewiseDrive<L: Lane> {
    kind: DriveKind,
    /// Frequency [rad/s].
    pub omega: L,
    constant: L,
    first: Drive<L>,
    second: Drive<L>,
    lines: Lines<L>,
}

side_by_side!(PiecewiseDrive { omega, constant } with { first, second, lines } alike { kind });

impl<L: Lane> PiecewiseDrive<L> {
    /// The drive of these parameters, at `phase` at the section [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self {
        let (omega, zero) = (shape.frequency(&of), L::splat(0.0));
        let phase = reduced(phase);
        let has_second = shape.drive == DriveKind::TwoHarmonics;
        let second_phase = L::splat(2.0 * phase) + of(Parameter::Phase2);
        PiecewiseDrive {
            kind: shape.drive,
            omega,
            constant: if has_second { of(Parameter::P0) } else { zero },
            first: Drive::new(&of, shape, L::splat(phase)),
            second: Drive::harmonic(of(Parameter::P2), omega + omega, second_phase),
            lines: lines(of, shape.drive, omega, phase),
        }
    }

    /// The period, 2 pi / omega [s].
    #[inline(always)]
    pub fn period(&self) -> L {
        L::splat(2.0 * PI) / self.omega
    }

    /// Whether the force has edges.
    #[inline(always)]
    pub fn has_edges(&self) -> bool {
        self.kind.edges() > 0
    }

    /// How many edges have passed at a time within the cycle, one there included.
    pub fn passed_at(&self, time: L) -> L {
        let mut passed = L::splat(0.0);
        for begins in &self.lines.begins[1..=self.kind.edges()] {
            let is_over = begins.le(time);
            passed = passed + L::select(is_over, L::splat(1.0), L::splat(0.0));
        }
        passed
    }

    /// Where an edge is still to come in the cycle, when so many have passed.
    #[inline(always)]
    pub fn has_next(&self, passed: L) -> L::Mask {
        let edges = L::splat(self.kind.edges() as f64);
        match self.has_edges() {
            true => passed.lt(edges - L::splat(0.5)),
            false => L::Mask::splat(false),
        }
    }

    /// Of the part of the force after so many edges when it begins, the force there and its rate.
    #[inline(always)]
    fn line(&self, passed: L) -> [L; 3] {
        let Lines { begins, from, rate } = &self.lines;
        let mut line = [begins[0], from[0], rate[0]];
        for edge in 1..=self.kind.edges() {
            let is_past = L::splat(edge as f64 - 0.5).lt(passed);
            for (number, next) in line.iter_mut().zip([begins[edge], from[edge], rate[edge]]) {
                *number = L::select(is_past, next, *number);
            }
        }
        line
    }

    /// How long the next edge is away, when so many have passed; without meaning where none is to come [s].
    #[inline(always)]
    pub fn until_next(&self, passed: L, time: L) -> L {
        let begins = &self.lines.begins;
        let mut next = begins[1];
        for edge in 1..self.kind.edges() {
            let is_past = L::splat(edge as f64 - 0.5).lt(passed);
            next = L::select(is_past, begins[edge + 1], next);
        }
        next - time
    }

    /// Writes the series of the force from `time` since the section [s], when so many edges have passed.
    #[inline(always)]
    pub fn force(&self, passed: L, time: L, force: &mut Series<L>) {
        *force = series::zero();
        if self.has_edges() {
            let [begins, from, rate] = self.line(passed);
            (force[0], force[1]) = (from + rate * (time - begins), rate);
            return;
        }
        // As the paper's capsule has it, whose bits are so the same.
        self.first.cos(time, force);
        for term in force.iter_mut() {
            *term = self.first.amplitude * *term;
        }
        if self.kind == DriveKind::TwoHarmonics {
            let mut second = series::zero();
            self.second.any_cos(time, &mut second);
            force[0] = force[0] + self.constant;
            for (term, second) in force.iter_mut().zip(&second) {
                *term = *term + self.second.amplitude * *second;
            }
        }
    }

    /// The force at a time [N].
    #[inline(always)]
    pub fn force_at(&self, passed: L, time: L) -> L {
        let mut force = series::zero();
        self.force(passed, time, &mut force);
        force[0]
    }
}

impl PiecewiseDrive<f64> {
    /// The force at `time`, by a library's functions, when so many edges have passed [N].
    pub fn exact_force(&self, passed: f64, time: f64) -> f64 {
        if self.has_edges() {
            let [begins, from, rate] = self.line(passed);
            return from + rate * (time - begins);
        }
        let second = match self.kind {
            DriveKind::TwoHarmonics => self.second.force(time),
            _ => 0.0,
        };
        self.constant + self.first.force(time) + second
    }
}

/// The mean force of the drive over a cycle, and the largest magnitude that it may have [N].
pub fn mean_and_largest<L: Lane>(of: impl Fn(Parameter) -> L, kind: DriveKind) -> [L; 2] {
    let [p_d, p_0, p_low, duty, p_2] =
        [Parameter::Pd, Parameter::P0, Parameter::PLow, Parameter::Duty, Parameter::P2].map(of);
    match kind {
        DriveKind::Harmonic => [L::splat(0.0), p_d],
        DriveKind::TwoHarmonics => [p_0, p_0.abs() + p_d + p_2.abs()],
        // An edge that rises takes from the pulse what one that falls adds to it.
        DriveKind::Square | DriveKind::Trapezoid => {
            let [high, low] = [p_0 + p_d, p_0 + p_low];
            [duty * high + (L::splat(1.0) - duty) * low, high.abs().max(low.abs())]
        }
    }
}

/// An edge of the force within a turn that begins at phase 0.
#[derive(Clone, Copy)]
struct Edge<L> {
    /// Where it is [turns].
    at: L,
    /// The force after it [N].
    from: L,
    /// The rate of the force after it [N/turn].
    rate: L,
}

/// The edges of a kind of drive, from phase 0 on.
fn edges<L: Lane>(of: impl Fn(Parameter) -> L, kind: DriveKind) -> [Edge<L>; MOST_EDGES] {
    let zero = L::splat(0.0);
    let [duty, rise] = [Parameter::Duty, Parameter::Rise].map(&of);
    let high = of(Parameter::P0) + of(Parameter::Pd);
    let low = of(Parameter::P0) + of(Parameter::PLow);
    let edge = |at, from, rate| Edge { at, from, rate };
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

/// The edge of a drive that lies at a phase [rad], as a share of the period from phase 0 on; none where there is none, or the one at
/// phase 0, which no parameter moves.
pub fn edge_at(parameters: &Parameters, phase: f64) -> Option<f64> {
    let kind = Shape::of(parameters).drive;
    let edges = edges(|it| parameters[it], kind);
    let section = reduced(phase) / (2.0 * PI);
    let later = edges.iter().take(kind.edges()).skip(1);
    let near = |at: &f64| (at - section).abs() <= ON_EDGE;
    later.map(|edge| edge.at).find(near)
}

/// The parts of the force in the order of a cycle that begins at `phase`.
fn lines<L: Lane>(of: impl Fn(Parameter) -> L, kind: DriveKind, omega: L, phase: f64) -> Lines<L> {
    let zero = L::splat(0.0);
    let count = kind.edges();
    let mut lines = Lines { begins: [zero; PARTS], from: [zero; PARTS], rate: [zero; PARTS] };
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
            lines.from[place] = L::select(is_here, edge.from, lines.from[place]);
            lines.rate[place] = L::select(is_here, edge.rate / period, lines.rate[place]);
        }
    }
    // What is there at the section began with the last edge of the turn before.
    lines.begins[0] = lines.begins[count] - period;
    (lines.from[0], lines.rate[0]) = (lines.from[count], lines.rate[count]);
    lines
}
