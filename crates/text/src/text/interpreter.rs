//! The instructions of a text carried out over lanes: numbers of a case and of a mode, terms of series, values at a point.

use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::series::{self, SquareRoot};
use capsulemap_engine::lane::{Lane, Series};

use crate::text::function::{Function, elementary_of};
use crate::text::instructions::{Instruction, Place, ScalarStep, SeriesStep, Sum};
use crate::text::mode::TextMode;
use crate::text::program::Program;

/// The numbers of a case, with zeros for those that change with the mode.
///
/// Once a case, so that it need not be compiled with the instructions of the lanes.
#[inline(never)]
pub fn constants<L: Lane>(program: &Program, parameters: &[L]) -> Vec<L> {
    let mut numbers = vec![L::splat(0.0); program.scalars.len()];
    for place in 0..program.scalars.len() {
        numbers[place] = match program.scalars[place] {
            ScalarStep::Parameter(parameter) => parameters[parameter],
            step => number(step, &numbers),
        };
    }
    numbers
}

/// A function of a number that changes with the mode, which is rare.
#[inline(never)]
fn rarely<L: Lane>(function: Function, x: L) -> L {
    elementary_of(function, x)[0]
}

in_lanes! {
    /// Completes the numbers of a case by those of a mode; `pulses` are the values of the pulses.
    pub fn complete<L: Lane>(
        program: &Program,
        mode: &TextMode<L>,
        pulses: &[L::Plain],
        numbers: &mut [L],
    ) {
        for &place in &program.of_mode {
            numbers[place] = match program.scalars[place] {
                ScalarStep::Switch(it) => L::from_plain(mode.switches[it]),
                ScalarStep::Pulse(it) => L::from_plain(pulses[it]),
                ScalarStep::Sign(it) => L::from_plain(mode.signs[it]),
                step => number(step, numbers),
            };
        }
    }

    /// A number from others.
    fn number<L: Lane>(step: ScalarStep, of: &[L]) -> L {
        match step {
            ScalarStep::Number(value) => L::splat(value),
            ScalarStep::Add(a, b) => of[a] + of[b],
            ScalarStep::Sub(a, b) => of[a] - of[b],
            ScalarStep::Mul(a, b) => of[a] * of[b],
            ScalarStep::Div(a, b) => of[a] / of[b],
            ScalarStep::Neg(a) => -of[a],
            ScalarStep::Of(function, a) => rarely(function, of[a]),
            ScalarStep::Max(a, b) => of[a].max(of[b]),
            ScalarStep::Min(a, b) => of[a].min(of[b]),
            ScalarStep::Parameter(_)
            | ScalarStep::Switch(_)
            | ScalarStep::Pulse(_)
            | ScalarStep::Sign(_) => L::splat(0.0),
        }
    }

    /// Where a friction slides.
    pub fn slides<L: Lane>(mode: &TextMode<L>, friction: usize) -> L::Mask {
        let sign = mode.signs[friction];
        L::Plain::splat(0.5).lt(sign * sign)
    }

    /// Carries out an instruction on the terms of order `k` of all registers, of which those before it are there; `of` has the
    /// earlier terms of registers that are kept, and of the others the terms of order `k - 1` are in `row`.
    pub fn carry_out<L: Lane>(
        it: &Instruction,
        numbers: &[L],
        (mode, time): (&TextMode<L>, L),
        (row, of): (&mut [L], &mut [Series<L>]),
        k: usize,
    ) {
        let register = it.register;
        if k > 0 && it.folds {
            let [own, next] = later_term(register, it.step, of, k);
            (row[register], of[register][k]) = (own, own);
            if it.is_pair {
                (row[register + 1], of[register + 1][k]) = (next, next);
            }
            return;
        }
        // Of these functions, which are long, each stands once.
        let mut argument = None;
        row[register] = match it.step {
            SeriesStep::Add(a, b) => row[a] + row[b],
            SeriesStep::Sub(a, b) => row[a] - row[b],
            SeriesStep::Neg(a) => -row[a],
            SeriesStep::Scale(s, a) => numbers[s] * row[a],
            SeriesStep::AddScaled(a, s, b) => row[a] + numbers[s] * row[b],
            SeriesStep::TwoScaled(s, a, r, b) => numbers[s] * row[a] + numbers[r] * row[b],
            SeriesStep::Sum(sum) => of_terms(&sum, numbers, row, k),
            SeriesStep::AddConstant(a, s) => if k == 0 { row[a] + numbers[s] } else { row[a] },
            SeriesStep::FromConstant(s, a) => if k == 0 { numbers[s] - row[a] } else { -row[a] },
            SeriesStep::Constant(s) => if k == 0 { numbers[s] } else { L::splat(0.0) },
            SeriesStep::Time => match k {
                0 => time,
                1 => L::splat(1.0),
                _ => L::splat(0.0),
            },
            SeriesStep::Friction(friction, sliding, at_rest) => {
                let sign = mode.signs[friction];
                L::select(slides(mode, friction), row[sliding].scaled(sign), row[at_rest])
            }
            SeriesStep::Rotation(_, r) if k > 0 => {
                let rate = numbers[r].scaled(L::Plain::splat(series::INVERSE[k]));
                let (sine, cosine) = (row[register], row[register + 1]);
                row[register + 1] = -(rate * sine);
                rate * cosine
            }
            // From here on the first terms alone.
            SeriesStep::Mul(a, b) => row[a] * row[b],
            SeriesStep::Square(a) => row[a] * row[a],
            SeriesStep::Div(a, b) => row[a] / row[b],
            SeriesStep::Rotation(s, r) => {
                argument = Some((Function::Sin, numbers[s] + numbers[r] * time));
                time
            }
            SeriesStep::Sqrt(a) => of_function(&mut argument, Function::Sqrt, row[a]),
            SeriesStep::Exp(a) => of_function(&mut argument, Function::Exp, row[a]),
            SeriesStep::Log(a) => of_function(&mut argument, Function::Log, row[a]),
            SeriesStep::SinCos(a) => of_function(&mut argument, Function::Sin, row[a]),
            SeriesStep::Tanh(a) => of_function(&mut argument, Function::Tanh, row[a]),
        };
        if let Some((function, x)) = argument {
            let [own, next] = elementary_of(function, x);
            row[register] = own;
            if it.is_pair {
                row[register + 1] = next;
            }
        }
        if it.is_kept {
            of[register][k] = row[register];
            if it.is_pair {
                of[register + 1][k] = row[register + 1];
            }
        }
    }

    /// Term `k` of a sum of scaled terms.
    fn of_terms<L: Lane>(sum: &Sum, numbers: &[L], row: &[L], k: usize) -> L {
        let mut total = L::splat(0.0);
        for (place, (number, register)) in sum.terms().iter().enumerate() {
            let term = numbers[usize::from(*number)] * row[usize::from(*register)];
            total = if place == 0 { term } else { total + term };
        }
        match sum.constant {
            Some(constant) if k == 0 => total + numbers[usize::from(constant)],
            _ => total,
        }
    }

    /// Notes of what a function is to be computed; until then it is its argument.
    fn of_function<L: Lane>(argument: &mut Option<(Function, L)>, function: Function, x: L) -> L {
        *argument = Some((function, x));
        x
    }

    /// Term `k > 0` of what is folded from earlier ones, and that of the next register.
    fn later_term<L: Lane>(
        register: usize,
        step: SeriesStep,
        of: &mut [Series<L>],
        k: usize,
    ) -> [L; 2] {
        let zero = L::splat(0.0);
        let own = match step {
            SeriesStep::Mul(a, b) => series::product_term(&of[a], &of[b], k),
            SeriesStep::Square(a) => series::square_term(&of[a], k),
            SeriesStep::Div(a, b) => series::quotient_term(&of[a], &of[b], &of[register], k),
            SeriesStep::Sqrt(a) => SquareRoot::of(of[a][0]).term(&of[a], &of[register], k),
            SeriesStep::Exp(a) => series::slope_product_term(&of[a], &of[register], k),
            SeriesStep::Log(a) => series::log_term(&of[a], &of[register], k),
            SeriesStep::SinCos(a) => {
                let next = -series::slope_product_term(&of[a], &of[register], k);
                return [series::slope_product_term(&of[a], &of[register + 1], k), next];
            }
            SeriesStep::Tanh(a) => {
                let own = series::slope_product_term(&of[a], &of[register + 1], k);
                of[register][k] = own;
                return [own, -series::square_term(&of[register], k)];
            }
            _ => zero,
        };
        [own, zero]
    }

    /// A value at a point.
    pub fn at<L: Lane>(place: Place, numbers: &[L], values: &[L]) -> L {
        match place {
            Place::Scalar(it) => numbers[it],
            Place::Series(it) => values[it],
        }
    }

    /// The series of a value; that of a number is written to `room`.
    pub fn series_of<'a, L: Lane>(
        place: Place,
        numbers: &[L],
        registers: &'a [Series<L>],
        room: &'a mut Series<L>,
    ) -> &'a Series<L> {
        match place {
            Place::Series(it) => &registers[it],
            Place::Scalar(it) => {
                *room = series::zero();
                room[0] = numbers[it];
                room
            }
        }
    }
}
