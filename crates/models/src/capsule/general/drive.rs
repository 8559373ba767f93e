//! The drives of the family: one or two harmonics, or lines between edges at known times of the cycle.

use std::f64::consts::PI;

use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, series, side_by_side};

use super::edges::{Edge, Lines, edges, lines};
use crate::capsule::drive::Drive;
use crate::capsule::parameter::Parameter;
use crate::capsule::shape::{DriveKind, Shape};
use crate::motion::reduced;

/// A prescribed motion of the mass relative to the capsule.
#[derive(Debug, Clone)]
pub struct Prescribed<L> {
    /// The displacement [m].
    pub place: Series<L>,
    /// The velocity [m/s].
    pub speed: Series<L>,
    /// The acceleration [m/s^2].
    pub acceleration: Series<L>,
}

impl<L: Lane> Prescribed<L> {
    /// No motion.
    #[inline(always)]
    fn at_rest() -> Self {
        let zero = series::zero();
        Prescribed { place: zero, speed: zero, acceleration: zero }
    }
}

/// A drive whose force, or prescribed motion, is a sum of two harmonics, or made of lines between edges.
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
        let mut first = Drive::new(&of, shape, L::splat(phase));
        let mut second = of(Parameter::P2);
        if shape.drive == DriveKind::Prescribed {
            (first.amplitude, second) = (of(Parameter::Xi1), of(Parameter::Xi2));
        }
        PiecewiseDrive {
            kind: shape.drive,
            omega,
            constant: if has_second { of(Parameter::P0) } else { zero },
            first,
            second: Drive::harmonic(second, omega + omega, second_phase),
            lines: lines(of, shape.drive, omega, phase),
        }
    }

    /// The period, 2 pi / omega [s].
    #[inline(always)]
    pub fn period(&self) -> L {
        L::splat(2.0 * PI) / self.omega
    }

    /// Whether it gives the motion of the mass relative to the capsule, not a force.
    #[inline(always)]
    pub fn is_prescribed(&self) -> bool {
        self.kind.is_prescribed()
    }

    /// Whether the velocity jumps at the edges.
    #[inline(always)]
    pub fn velocity_jumps(&self) -> bool {
        self.kind == DriveKind::TwoPhase
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

    /// Of the part of the force or of the prescribed velocity after so many edges when it begins, that and its rate there, and the
    /// displacement of a prescribed motion.
    #[inline(always)]
    fn line(&self, passed: L) -> [L; 4] {
        let Lines { begins, from, rate, place } = &self.lines;
        let mut line = [begins[0], from[0], rate[0], place[0]];
        for edge in 1..=self.kind.edges() {
            let is_past = L::splat(edge as f64 - 0.5).lt(passed);
            let next = [begins[edge], from[edge], rate[edge], place[edge]];
            for (number, next) in line.iter_mut().zip(next) {
                *number = L::select(is_past, next, *number);
            }
        }
        line
    }

    /// The prescribed velocity after so many edges when that part of it begins [m/s].
    #[inline(always)]
    pub fn speed_after(&self, passed: L) -> L {
        self.line(passed)[1]
    }

    /// The series of a prescribed motion from `time` since the section [s], when so many edges have passed.
    #[inline(always)]
    pub fn prescribed(&self, passed: L, time: L) -> Prescribed<L> {
        let mut motion = Prescribed::at_rest();
        match self.has_edges() {
            true => self.write_phase(passed, time, &mut motion),
            false => self.write_harmonics(time, &mut motion),
        }
        motion
    }

    /// The displacement, velocity and acceleration of a prescribed motion at a time [m, m/s, m/s^2].
    #[inline(always)]
    pub fn prescribed_at(&self, passed: L, time: L) -> [L; 3] {
        if self.has_edges() {
            let mut motion = Prescribed::at_rest();
            self.write_phase(passed, time, &mut motion);
            return [motion.place[0], motion.speed[0], motion.acceleration[0]];
        }
        let (first, second) = (self.first.turned(time), self.second.turned(time));
        let (slow, fast) = (self.omega, self.second.omega);
        [
            first[0] + second[0],
            slow * first[1] + fast * second[1],
            -(slow * slow * first[0] + fast * fast * second[0]),
        ]
    }

    /// Writes a motion in phases.
    #[inline(always)]
    fn write_phase(&self, passed: L, time: L, motion: &mut Prescribed<L>) {
        let [begins, from, rate, place] = self.line(passed);
        let since = time - begins;
        let half = L::splat(0.5) * rate;
        let speed = from + rate * since;
        motion.place[0] = place + since * (from + half * since);
        (motion.place[1], motion.place[2]) = (speed, half);
        (motion.speed[0], motion.speed[1]) = (speed, rate);
        motion.acceleration[0] = rate;
    }

    /// Writes a motion of two harmonics.
    #[inline(always)]
    fn write_harmonics(&self, time: L, motion: &mut Prescribed<L>) {
        let mut second = series::zero();
        self.first.cos(time, &mut motion.place);
        self.second.any_cos(time, &mut second);
        let [square, second_square] = [self.omega, self.second.omega].map(|omega| omega * omega);
        for (k, second) in second.iter().enumerate() {
            let first = self.first.amplitude * motion.place[k];
            let second = self.second.amplitude * *second;
            motion.place[k] = first + second;
            motion.acceleration[k] = -(square * first + second_square * second);
        }
        for k in 0..ORDER {
            motion.speed[k] = motion.place[k + 1].scaled(L::Plain::splat((k + 1) as f64));
        }
        let last = L::Plain::splat(series::INVERSE[ORDER]);
        motion.speed[ORDER] = motion.acceleration[ORDER - 1].scaled(last);
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
            let [begins, from, rate, _] = self.line(passed);
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
            let [begins, from, rate, _] = self.line(passed);
            return from + rate * (time - begins);
        }
        let second = match self.kind {
            DriveKind::TwoHarmonics => self.second.force(time),
            _ => 0.0,
        };
        self.constant + self.first.force(time) + second
    }

    /// The velocity and the acceleration of a prescribed motion at `time`, by a library's functions, when so many edges have passed
    /// [m/s, m/s^2].
    pub fn exact_motion(&self, passed: f64, time: f64) -> [f64; 2] {
        if self.has_edges() {
            let [begins, from, rate, _] = self.line(passed);
            return [from + rate * (time - begins), rate];
        }
        let mut sums = [0.0; 2];
        for harmonic in [&self.first, &self.second] {
            let (place, omega) = (harmonic.force(time), harmonic.omega);
            // A quarter of a turn later the cosine is minus the sine.
            sums[0] += omega * harmonic.force(time + 0.5 * PI / omega);
            sums[1] -= omega * omega * place;
        }
        sums
    }
}

/// The mean force of the drive over a cycle, and the largest magnitude that it may have [N]; of a prescribed motion what moves the mass
/// with it.
pub fn mean_and_largest<L: Lane>(of: impl Fn(Parameter) -> L, shape: Shape) -> [L; 2] {
    let zero = L::splat(0.0);
    let [p_d, p_0, p_low, duty, p_2] =
        [Parameter::Pd, Parameter::P0, Parameter::PLow, Parameter::Duty, Parameter::P2].map(&of);
    match shape.drive {
        DriveKind::Harmonic => [zero, p_d],
        DriveKind::TwoHarmonics => [p_0, p_0.abs() + p_d + p_2.abs()],
        // An edge that rises takes from the pulse what one that falls adds to it.
        DriveKind::Square | DriveKind::Trapezoid => {
            let [high, low] = [p_0 + p_d, p_0 + p_low];
            [duty * high + (L::splat(1.0) - duty) * low, high.abs().max(low.abs())]
        }
        DriveKind::Prescribed => {
            let sum = of(Parameter::Xi1).abs() + L::splat(4.0) * of(Parameter::Xi2).abs();
            let omega = shape.frequency(&of);
            [zero, of(Parameter::M1) * omega * omega * sum]
        }
        DriveKind::TwoPhase | DriveKind::ThreePhase => {
            let mut largest = zero;
            for Edge { from, rate, .. } in edges(&of, shape.drive) {
                largest = largest.max(from.abs()).max(rate.abs());
            }
            // A velocity that jumps has no largest acceleration: that of one velocity in a period stands for it.
            let turns = shape.frequency(&of) / L::splat(2.0 * PI);
            [zero, of(Parameter::M1) * largest * turns * turns]
        }
    }
}
