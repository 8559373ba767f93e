//! Finds where a step ends: the first guard to fall.

use crate::lane::{Lane, Mask, Part, Series, series};

use super::guard::{divide_by_time, first_fall, stays_positive};
use super::step::Step;
use super::step_end::StepEnd;
use super::switched::{MAX_GUARDS, Switched, Zeros};

/// A section's function this far beyond zero, relative to its change in a step, is not there by rounding.
const ACROSS: f64 = 1e-9;

/// Finds the first guard to fall within a step whose series are known.
///
/// Most guards cannot fall and are told at once; the others are decided in turn, each lane its own,
/// so that lanes whose events differ share the search for a root.
pub(super) struct Locate<'a, L: Lane, S: Switched<L>> {
    pub system: &'a S,
    pub mode: &'a S::Mode,
    pub zeros: &'a Zeros<L>,
    /// The sign of the section's function of an autonomous system; zero until it is known.
    pub side: &'a mut L,
    /// Duration of the step where no guard falls [s].
    pub length: L::Plain,
    pub step: &'a mut Step<L, S>,
}

impl<L: Lane, S: Switched<L>> Part for Locate<'_, L, S> {
    type Output = StepEnd<L>;

    #[inline(always)]
    fn run(mut self) -> StepEnd<L> {
        let length = self.length;
        let none = L::Plain::splat(-1.0);
        let unknown = L::Mask::splat(false);
        let mut end = StepEnd { length, guard: none, root: L::from_plain(length), unknown };
        let mut open = self.open_guards();
        loop {
            let mut chosen = none;
            for which in (0..Step::<L, S>::GUARDS).rev() {
                let this = L::Plain::splat(which as f64);
                chosen = L::Plain::select(open[which], this, chosen);
            }
            let takes_part = none.lt(chosen);
            if !takes_part.any() {
                break;
            }
            let step = &mut *self.step;
            step.choose(chosen);
            end.unknown = end.unknown | (takes_part & !series::is_finite(&step.chosen));
            let fall = first_fall(&mut step.chosen, end.length, takes_part);
            let sooner = fall.length.lt(end.length);
            end.guard = L::Plain::select(sooner, none, end.guard);
            end.guard = L::Plain::select(fall.falls, chosen, end.guard);
            end.length = fall.length;
            for (which, open) in open.iter_mut().enumerate() {
                *open = *open & chosen.lt(L::Plain::splat(which as f64));
            }
        }
        end.root = L::from_plain(end.length);
        if const { L::PARTS > 1 } {
            for which in 0..Step::<L, S>::GUARDS {
                let due = end.is_due(which);
                if due.any() {
                    self.write_guard(which);
                    let root = L::root(end.length, &self.step.guards[0]);
                    end.root = L::select(due, root, end.root);
                }
            }
        }
        end
    }
}

impl<L: Lane, S: Switched<L>> Locate<'_, L, S> {
    /// Writes a guard with its derivatives, its known zeros divided out, to the first place.
    #[inline(always)]
    fn write_guard(&mut self, which: usize) {
        let Locate { system, mode, zeros, side, step, .. } = self;
        let Step { jet, guards: [guard, ..], .. } = &mut **step;
        if S::AUTONOMOUS && which == S::GUARDS {
            system.section(jet, guard);
            guard.iter_mut().for_each(|term| *term = **side * *term);
        } else {
            system.guard(which, mode, jet, guard);
        }
        divide_by_zeros::<L, L, S>(zeros, which, guard);
    }

    /// Writes the guards without their derivatives, with their known zeros divided out; where each of them might fall within
    /// `length`.
    #[inline(always)]
    fn open_guards(&mut self) -> [L::Mask; MAX_GUARDS] {
        let Locate { system, mode, zeros, length, .. } = *self;
        let (side, step) = (&mut *self.side, &mut *self.step);
        let mut open = [L::Mask::splat(false); MAX_GUARDS];
        for (which, open) in open.iter_mut().enumerate().take(Step::<L, S>::GUARDS) {
            let is_section = S::AUTONOMOUS && which == S::GUARDS;
            let mut watched = match is_section {
                true => L::Mask::splat(true),
                false => system.watched(which, mode),
            };
            if !watched.any() {
                continue;
            }
            let Step { jet, guards, plain_guards, .. } = step;
            // Of numbers with derivatives the guards without them are kept, and one room serves all: caches are small.
            let place = if const { L::PARTS > 1 } { 0 } else { which };
            let (guard, plain) = (&mut guards[place], &mut plain_guards[which]);
            let guard = if is_section {
                system.section(jet, guard);
                watched = turn_to_section(side, guard, length);
                guard.iter_mut().for_each(|term| *term = *side * *term);
                L::plain_series(guard, plain)
            } else if const { L::PARTS > 1 } {
                system.plain_guard(which, mode, jet, guard, plain);
                plain
            } else {
                system.guard(which, mode, jet, guard);
                L::plain_series(guard, plain)
            };
            divide_by_zeros::<L, L::Plain, S>(zeros, which, guard);
            *open = watched & !stays_positive(guard, length);
        }
        open
    }
}

/// Divides the known zeros out of a guard.
#[inline(always)]
fn divide_by_zeros<L: Lane, P: Lane<Mask = L::Mask>, S: Switched<L>>(
    zeros: &Zeros<L>,
    which: usize,
    guard: &mut Series<P>,
) {
    for vanished in 0..S::MOST_ZEROS {
        let drop = L::splat(vanished as f64 + 0.5).lt(zeros[which]);
        if drop.any() {
            divide_by_time(guard, drop);
        }
    }
}

/// Notes the sign by which the function of the section falls through zero next, and says whether it may.
///
/// An event that moves the state may take it across the section, which is no return to it: a value that is below
/// zero by more than rounding, of the size of what the function changes by in a step, tells so. While a motion rests on the
/// section the function is zero throughout: it does not fall then, and its sign is that by which the motion leaves.
#[inline(always)]
fn turn_to_section<L: Lane>(side: &mut L, section: &Series<L>, length: L::Plain) -> L::Mask {
    let zero = L::splat(0.0);
    let next = series::sign_after_start(section, zero);
    *side = L::select(zero.lt(*side * *side), *side, next);
    let [value, slope, bend] = [0, 1, 2].map(|k| (*side * section[k]).plain());
    let change = (slope * length).abs().max((bend * length * length).abs());
    let is_across = value.lt(-(change * L::Plain::splat(ACROSS)));
    let mut size = zero;
    for term in section {
        size = size + term.abs();
    }
    let rests = size.le(zero);
    *side = L::select(is_across, -*side, L::select(rests, zero, *side));
    !rests
}
