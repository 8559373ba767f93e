//! Contacts that last: where impacts accumulate, and until the forces let go.

use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::Lane;

use crate::text::due::Due;
use crate::text::interpreter::at;
use crate::text::mode::{TextMode, is_on};
use crate::text::oscillator::{Oscillator, Values};

/// Flights that are all over within this share of the period are left out.
const OVER: f64 = 1e-9;
/// A state that starts this close to a bound, relative to both, starts on it.
const AT_BOUND: f64 = 1e-10;

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Oscillator<L, D, N, AUTONOMOUS>
    {
        /// Opens the contact of an event where it lasts; returns how many coefficients of its guard vanish then: what is let go by a force
        /// that falls to zero leaves with its third derivative, by one that jumps with its second.
        pub(crate) fn open(&self, event: usize, due: &mut Due<'_, L, N>) -> L {
            let Some(it) = self.program.lasting[event] else { return L::splat(0.0) };
            due.came = due.state[self.program.layout[it.velocity]];
            due.opens = due.here & is_on(due.mode.contacts[event]);
            let opening = L::select(is_on(due.mode.loose[event]), L::splat(2.0), L::splat(3.0));
            for own in [&mut due.mode.contacts[event], &mut due.mode.loose[event]] {
                *own = L::Plain::select(due.here, L::Plain::splat(0.0), *own);
            }
            opening
        }

        /// Notes where the flights after an impact are all over so soon that they are left out: the contact lasts at once.
        ///
        /// Method: pressed on with an acceleration a, what leaves the bound with a velocity v flies 2 v/a, and after the next impacts e, e^2, ...
        /// times as long, where e is what the first impact has left of the velocity. What this changes is of the second order in that time.
        pub(crate) fn note_lasting(&self, event: usize, values: &Values<L>, due: &mut Due<'_, L, N>) {
            let Some(it) = self.program.lasting[event] else { return };
            let (zero, one) = (L::splat(0.0), L::splat(1.0));
            let acceleration = at(it.acceleration, &values.numbers, &values.registers);
            let pressing = acceleration.scaled(L::Plain::splat(it.towards));
            let own = &mut due.state[self.program.layout[it.velocity]];
            let (back, came) = (own.abs(), due.came.abs());
            let kept = L::select(zero.lt(came), back / came, zero);
            let over = L::splat(OVER) * self.numbers[self.program.period];
            let are_over = (back + back).le(pressing * (one - kept) * over);
            let lasts = due.here & !due.opens & zero.lt(pressing) & are_over;
            *own = L::select(lasts, zero, *own);
            let contact = &mut due.mode.contacts[event];
            *contact = L::Plain::select(lasts, L::Plain::splat(1.0), *contact);
            due.zeros[due.which] = L::select(lasts, zero, due.zeros[due.which]);
        }

        /// Notes where what presses on a contact that lasts has jumped below zero.
        pub(crate) fn note_loose(&self, here: L::Mask, values: &Values<L>, mode: &mut TextMode<L>) {
            for (place, it) in self.program.lasting.iter().enumerate() {
                let Some(it) = it else { continue };
                let acceleration = at(it.acceleration, &values.numbers, &values.registers);
                let pressing = acceleration.scaled(L::Plain::splat(it.towards));
                let pulls = here & is_on(mode.contacts[place]) & pressing.lt(L::splat(0.0));
                mode.loose[place] =
                    L::Plain::select(pulls, L::Plain::splat(1.0), mode.loose[place]);
            }
        }

        /// Notes which contacts last from the start on: where the state is on the bound of an event, up to rounding, and stays there.
        pub(crate) fn note_contacts(&self, values: &Values<L>, mode: &mut TextMode<L>, state: &mut [L; N]) {
            let zero = L::splat(0.0);
            for (place, it) in self.program.lasting.iter().enumerate() {
                let (Some(it), Some((_, bound))) = (it, self.program.bounds.events[place]) else {
                    continue;
                };
                let (at_bound, layout) = (self.numbers[bound], &self.program.layout);
                let (own, velocity) = (state[layout[it.state]], state[layout[it.velocity]]);
                let far = L::splat(AT_BOUND) * (own.abs() + at_bound.abs());
                let acceleration = at(it.acceleration, &values.numbers, &values.registers);
                let presses = zero.lt(acceleration.scaled(L::Plain::splat(it.towards)));
                let rests = velocity.abs().le(zero) & presses;
                let holds = rests & (own - at_bound).abs().le(far);
                state[layout[it.state]] = L::select(holds, at_bound, own);
                state[layout[it.velocity]] = L::select(holds, zero, velocity);
                mode.contacts[place] =
                    L::Plain::select(holds, L::Plain::splat(1.0), L::Plain::splat(0.0));
            }
        }
    }
}
