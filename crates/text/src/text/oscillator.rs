//! The oscillator of a text in numbers of any kind: its numbers, its pulses, and its values at a point.

use std::cell::RefCell;

use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::{Lane, SideBySide};

use crate::text::instructions::Instruction;
use crate::text::interpreter::{carry_out, complete, constants};
use crate::text::mode::{FEW, TextMode};
use crate::text::program::Program;

/// The oscillator of a text with one set of parameters per lane.
///
/// A point of its section has room for `D` coordinates, a state for the `N = D + 2`: these, the state that is zero on the section, and
/// the one that drifts. What a text does not have is zero.
#[derive(Debug, Clone)]
pub struct Oscillator<L, const D: usize, const N: usize, const AUTONOMOUS: bool> {
    pub(crate) program: &'static Program,
    /// The values of the parameters.
    pub(crate) parameters: Vec<L>,
    /// The numbers of the case.
    pub(crate) numbers: Vec<L>,
    /// How long after the start of a period its section is.
    pub(crate) later: L,
    /// Of each pulse the times of its two edges in a cycle, the earlier first, and its value before.
    pub(crate) pulses: Vec<[L; 3]>,
    /// Room for the values of an event, which are computed often.
    pub(crate) room: RefCell<Values<L>>,
}

/// The values of a text at a point.
#[derive(Debug, Clone)]
pub(crate) struct Values<L> {
    /// The numbers of the case and of the mode.
    pub(crate) numbers: Vec<L>,
    /// The registers.
    pub(crate) registers: Vec<L>,
}

impl<L> Values<L> {
    /// Room for them, before they are computed.
    #[inline(always)]
    pub(crate) fn room() -> Self {
        Values { numbers: Vec::new(), registers: Vec::new() }
    }
}

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool> SideBySide
        for Oscillator<L, D, N, AUTONOMOUS>
    {
        type One = Oscillator<f64, D, N, AUTONOMOUS>;

        fn splat(one: &Self::One) -> Self {
            Oscillator {
                program: one.program,
                parameters: one.parameters.iter().map(|it| L::splat(*it)).collect(),
                numbers: one.numbers.iter().map(|it| L::splat(*it)).collect(),
                later: L::splat(one.later),
                pulses: one.pulses.iter().map(SideBySide::splat).collect(),
                room: RefCell::new(Values::room()),
            }
        }
        fn lane(&self, index: usize) -> Self::One {
            Oscillator {
                program: self.program,
                parameters: self.parameters.iter().map(|it| it.lane(index)).collect(),
                numbers: self.numbers.iter().map(|it| it.lane(index)).collect(),
                later: self.later.lane(index),
                pulses: self.pulses.iter().map(|it| it.lane(index)).collect(),
                room: RefCell::new(Values::room()),
            }
        }
        fn put(&mut self, index: usize, one: &Self::One) {
            for (own, one) in self.parameters.iter_mut().zip(&one.parameters) {
                *own = own.with_lane(index, *one);
            }
            for (own, one) in self.numbers.iter_mut().zip(&one.numbers) {
                *own = own.with_lane(index, *one);
            }
            self.later = self.later.with_lane(index, one.later);
            for (own, one) in self.pulses.iter_mut().zip(&one.pulses) {
                own.put(index, one);
            }
        }
        fn take_lane(&mut self, index: usize, other: &Self) {
            for (own, other) in self.parameters.iter_mut().zip(&other.parameters) {
                *own = own.with_lane_of(index, *other);
            }
            for (own, other) in self.numbers.iter_mut().zip(&other.numbers) {
                *own = own.with_lane_of(index, *other);
            }
            self.later = self.later.with_lane_of(index, other.later);
            for (own, other) in self.pulses.iter_mut().zip(&other.pulses) {
                own.take_lane(index, other);
            }
        }
    }
}

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Oscillator<L, D, N, AUTONOMOUS>
    {
        /// The oscillator of a program with these parameters, whose section is so many turns after the start of a period.
        pub fn new(program: &'static Program, parameters: &[L], turns: f64) -> Self {
            let numbers = constants(program, parameters);
            let period = numbers[program.period];
            let mut pulses = Vec::with_capacity(program.duties.len());
            for duty in &program.duties {
                pulses.push(edges(numbers[*duty], period, turns));
            }
            let later = period * L::splat(turns);
            let room = RefCell::new(Values::room());
            Oscillator { program, parameters: parameters.to_vec(), numbers, later, pulses, room }
        }

        /// The values of the pulses.
        pub(crate) fn pulses(&self, mode: &TextMode<L>) -> [L::Plain; FEW] {
            let one = L::Plain::splat(1.0);
            let mut values = [L::Plain::ZERO; FEW];
            for (place, [_, _, before]) in self.pulses.iter().enumerate() {
                let before = before.plain();
                let passed = mode.passed[place];
                let turned = (passed - one).abs().lt(L::Plain::splat(0.5));
                values[place] = L::Plain::select(turned, one - before, before);
            }
            values
        }

        /// When the next edge of a pulse is, since the start of the cycle; never after both.
        pub(crate) fn next_edge(&self, mode: &TextMode<L>, pulse: usize) -> L {
            let [first, second, _] = self.pulses[pulse];
            let passed = mode.passed[pulse];
            let half = L::Plain::splat(0.5);
            let later = L::select((passed - L::Plain::splat(1.0)).abs().lt(half), second, L::splat(f64::INFINITY));
            L::select(passed.lt(half), first, later)
        }

        /// When the next edge of any pulse is.
        pub(crate) fn next_of_all(&self, mode: &TextMode<L>) -> L {
            let mut next = L::splat(f64::INFINITY);
            for pulse in 0..self.pulses.len() {
                next = next.min(self.next_edge(mode, pulse));
            }
            next
        }

        /// Computes the numbers of the case and of a mode, and the values of the registers in a state.
        pub(crate) fn compute(
            &self,
            values: &mut Values<L>,
            mode: &TextMode<L>,
            time: L,
            state: &[L; N],
        ) {
            let program = self.program;
            let Values { numbers, registers } = values;
            numbers.clear();
            numbers.extend_from_slice(&self.numbers);
            complete(program, mode, &self.pulses(mode), numbers);
            if registers.is_empty() {
                registers.resize(program.registers, L::splat(0.0));
            }
            for (place, at) in program.layout.iter().enumerate() {
                registers[place] = state[*at];
            }
            for step in &program.series {
                let step = Instruction { is_kept: false, ..*step };
                carry_out(&step, numbers, (mode, time + self.later), (registers, &mut []), 0);
            }
        }
    }

    /// The edges of a pulse in a cycle that begins so many turns after its period: the times of both, and its value before.
    fn edges<L: Lane>(duty: L, period: L, turns: f64) -> [L; 3] {
        let (zero, one, start) = (L::splat(0.0), L::splat(1.0), L::splat(turns));
        let rises = if turns > 0.0 { one - start } else { zero };
        let falls = duty - start;
        let has_fallen = falls.lt(zero);
        let falls = L::select(has_fallen, falls + one, falls);
        // Before the section it is on where it has not fallen since it rose.
        let before = L::select(has_fallen, zero, if turns > 0.0 { one } else { zero });
        let is_pulse = zero.lt(duty) & duty.lt(one);
        let period = L::select(is_pulse, period, L::splat(f64::NAN));
        let rises_first = rises.lt(falls);
        let first = L::select(rises_first, rises, falls);
        let second = L::select(rises_first, falls, rises);
        [first * period, second * period, before]
    }
}
