//! What happens where a mode ends, and in which mode a motion starts.

use capsulemap_engine::flow::Event as _;
use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::{Lane, Mask};

use crate::text::due::Due;
use crate::text::instructions::Guard;
use crate::text::interpreter::{at, slides};
use crate::text::mode::{EventKind, TextEvent, TextMode};
use crate::text::oscillator::{Oscillator, Values};
use crate::text::program::touches;

/// Two sizes of a friction that are no farther apart, relative to them, are one: then sliding begins without a jump of the force.
const SAME: f64 = 1e-9;

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Oscillator<L, D, N, AUTONOMOUS>
    {
        /// Obeys a guard; returns the event there.
        ///
        /// Method: what needs no values first, then what needs the values before the event, then what needs those after it. The values
        /// are computed at one place, as that is long.
        pub(crate) fn obey(&self, mut due: Due<'_, L, N>) -> L {
            let guard = self.program.guards[due.which];
            let mut code = self.begin_event(guard, &mut due);
            let has_frictions = !self.program.frictions.is_empty();
            let needs_before = match guard {
                Guard::Event(_) => true,
                // What leaves rest stays where it is.
                Guard::Forward(it) | Guard::Backward(it) => (due.here & slides(due.mode, it)).any(),
                Guard::Switch(_) | Guard::Edge => false,
            };
            let may_last = self.program.lasting.iter().any(Option::is_some);
            let moves_sides = matches!(
                guard,
                Guard::Event(event) if self.program.crosses[event] || self.program.lasting[event].is_some()
            );
            let passes = [needs_before, moves_sides, has_frictions, may_last];
            let mut values = self.room.replace(Values::room());
            for (pass, is_needed) in passes.into_iter().enumerate() {
                if !is_needed {
                    continue;
                }
                self.compute(&mut values, due.mode, due.time, due.state);
                if pass == 3 {
                    self.note_loose(due.here, &values, due.mode);
                    continue;
                }
                match guard {
                    Guard::Event(event) if pass == 0 => self.reset(event, &values, &mut due),
                    Guard::Forward(friction) | Guard::Backward(friction) if pass == 0 => {
                        self.put_to_rest(friction, &values, &mut due);
                    }
                    Guard::Forward(friction) => code = self.obey_friction((friction, true), &values, &mut due),
                    Guard::Backward(friction) => code = self.obey_friction((friction, false), &values, &mut due),
                    Guard::Event(event) if pass == 1 => {
                        self.note_crossed(event, &values, &mut due);
                        self.note_lasting(event, &values, &mut due);
                    }
                    Guard::Event(event) => {
                        self.note_moved(event, &values, &mut due);
                        self.note_jumps(due.here, &values, due.mode);
                    }
                    _ => self.note_jumps(due.here, &values, due.mode),
                }
            }
            self.room.replace(values);
            code
        }

        /// What of an event needs no values; returns its code.
        fn begin_event(&self, guard: Guard, due: &mut Due<'_, L, N>) -> L {
            let (here, one) = (due.here, L::splat(1.0));
            let code = |kind, place| L::select(here, TextEvent::of(kind, place).code::<L>(), L::splat(0.0));
            match guard {
                Guard::Event(event) => {
                    let bound = self.program.bounds.events[event];
                    self.put_on(bound, here, due.state);
                    let opens = self.open(event, due);
                    for zero in due.zeros.iter_mut() {
                        // The state moves: what another guard has left it may meet again at once.
                        *zero = L::select(here, L::splat(0.0), *zero);
                    }
                    if self.program.text.events[event].stays_on_surface {
                        due.zeros[due.which] = L::select(here, one, due.zeros[due.which]);
                    }
                    due.zeros[due.which] = L::select(due.opens, opens, due.zeros[due.which]);
                    let kind = if self.touches(bound) { EventKind::Impact } else { EventKind::Event };
                    L::select(due.opens, code(EventKind::Opens, event), code(kind, event))
                }
                Guard::Switch(switch) => {
                    let on = L::Plain::splat(0.5).lt(due.mode.switches[switch]);
                    let turned = L::Plain::select(on, L::Plain::splat(0.0), L::Plain::splat(1.0));
                    let own = &mut due.mode.switches[switch];
                    *own = L::Plain::select(here, turned, *own);
                    let bound = self.program.bounds.switches[switch];
                    self.put_on(bound, here, due.state);
                    due.zeros[due.which] = L::select(here, one, due.zeros[due.which]);
                    let touches = self.touches(bound);
                    let enters = if touches { EventKind::EntersContact } else { EventKind::Enters };
                    L::select(on, code(EventKind::Leaves, switch), code(enters, switch))
                }
                Guard::Forward(_) | Guard::Backward(_) => L::splat(0.0),
                Guard::Edge => {
                    let next = self.next_of_all(due.mode);
                    for pulse in 0..self.pulses.len() {
                        let passes = here & self.next_edge(due.mode, pulse).le(next);
                        let own = &mut due.mode.passed[pulse];
                        let later = *own + L::Plain::splat(1.0);
                        *own = L::Plain::select(passes, later, *own);
                    }
                    code(EventKind::Edge, 0)
                }
            }
        }

        /// Puts a state on a surface, where `here`.
        fn put_on(&self, bound: Option<(usize, usize)>, here: L::Mask, state: &mut [L; N]) {
            if let Some((place, value)) = bound {
                let own = &mut state[self.program.layout[place]];
                *own = L::select(here, self.numbers[value], *own);
            }
        }

        /// Whether a surface is one that may be touched.
        fn touches(&self, bound: Option<(usize, usize)>) -> bool {
            touches(self.program.touching, bound)
        }

        /// Moves the state as the event at a place does.
        fn reset(&self, event: usize, values: &Values<L>, due: &mut Due<'_, L, N>) {
            for (place, value) in &self.program.resets[event] {
                let own = &mut due.state[self.program.layout[*place]];
                *own = L::select(due.here & !due.opens, at(*value, &values.numbers, &values.registers), *own);
            }
        }

        /// Notes on which side switches are that an event has taken the state across, and where it has taken it behind an event, which is
        /// no number.
        fn note_crossed(&self, event: usize, values: &Values<L>, due: &mut Due<'_, L, N>) {
            let (zero, one) = (L::splat(0.0), L::splat(1.0));
            let of = |place| at(place, &values.numbers, &values.registers);
            let moved = &self.program.text.events[event].moved;
            for (place, side) in self.program.sides.iter().enumerate() {
                let value = of(*side);
                let known = L::from_plain(due.mode.switches[place]);
                let side = L::select(zero.lt(value), one, L::select(value.lt(zero), zero, known));
                if moved.switches[place] {
                    let own = &mut due.mode.switches[place];
                    *own = L::Plain::select(due.here, side.plain(), *own);
                }
            }
            for (place, lasts) in self.program.lasts.iter().enumerate() {
                if moved.events[place] {
                    let is_behind = due.here & of(*lasts).lt(zero);
                    due.state[0] = L::select(is_behind, L::splat(f64::NAN), due.state[0]);
                }
            }
        }

        /// Notes what frictions do where an event has moved what they are of.
        fn note_moved(&self, event: usize, values: &Values<L>, due: &mut Due<'_, L, N>) {
            for (friction, moves) in self.program.text.events[event].moved.frictions.iter().enumerate() {
                if *moves {
                    self.note_sign(friction, due.here, values, due.mode);
                }
            }
        }

        /// Notes in which direction the friction at a place slides, by what it is of.
        fn note_sign(
            &self,
            friction: usize,
            here: L::Mask,
            values: &Values<L>,
            mode: &mut TextMode<L>,
        ) {
            let of = at(self.program.frictions[friction].of, &values.numbers, &values.registers);
            let sign = beyond(of, L::splat(0.0));
            let own = &mut mode.signs[friction];
            *own = L::Plain::select(here, sign, *own);
            let thrown = &mut mode.thrown[friction];
            *thrown = L::Plain::select(here, L::Plain::splat(0.0), *thrown);
        }

        /// Notes where the force on a friction at rest has jumped beyond what it holds.
        fn note_jumps(&self, here: L::Mask, values: &Values<L>, mode: &mut TextMode<L>) {
            for (place, it) in self.program.frictions.iter().enumerate() {
                let of = |place| at(place, &values.numbers, &values.registers);
                let thrown = beyond(of(it.at_rest), of(it.holds));
                let rests = here & !slides(mode, place);
                mode.thrown[place] = L::Plain::select(rests, thrown, mode.thrown[place]);
            }
        }

        /// Makes what a friction is of vanish where it slides, by the state that leads there.
        fn put_to_rest(&self, friction: usize, values: &Values<L>, due: &mut Due<'_, L, N>) {
            let stops = due.here & slides(due.mode, friction);
            self.rest(friction, stops, values, due.state);
        }

        /// Makes what a friction is of vanish, where `here`.
        fn rest(&self, friction: usize, here: L::Mask, values: &Values<L>, state: &mut [L; N]) {
            let it = &self.program.frictions[friction];
            let of = at(it.of, &values.numbers, &values.registers);
            let own = &mut state[self.program.layout[it.leading.0]];
            *own = L::select(here, *own - of / self.numbers[it.leading.1], *own);
        }

        /// Ends a rest, or the sliding in one direction; returns the event by its code.
        fn obey_friction(
            &self,
            (friction, is_forward): (usize, bool),
            values: &Values<L>,
            due: &mut Due<'_, L, N>,
        ) -> L {
            let it = &self.program.frictions[friction];
            let Due { which, here, mode, zeros, .. } = due;
            let (zero, one) = (L::Plain::splat(0.0), L::Plain::splat(1.0));
            let side = if is_forward { one } else { -one };
            let forward = if is_forward { *which } else { *which - 1 };
            let sliding = slides(mode, friction);
            let (leaves, stops) = (*here & !sliding, *here & sliding);
            let came = mode.signs[friction];
            // What is needed at rest does not depend on whether it is at rest.
            let of = |place| at(place, &values.numbers, &values.registers);
            let (needed, holds, sizes) = (of(it.at_rest), of(it.holds), of(it.sliding));
            // Friction cannot push on in the direction that it was brought to rest from.
            let against = -(needed.plain() * came);
            let reverses = stops & holds.plain().lt(against);
            let sticks = stops & !reverses;
            let is_thrown = leaves & L::Plain::splat(0.5).lt(mode.thrown[friction] * side);
            let jumps = (holds - sizes).abs().plain();
            let is_smooth = jumps.le(L::Plain::splat(SAME) * holds.abs().plain());
            let sign = L::Plain::select(leaves, side, came);
            let sign = L::Plain::select(reverses, -came, sign);
            mode.signs[friction] = L::Plain::select(sticks, zero, sign);
            mode.thrown[friction] = L::Plain::select(leaves, zero, mode.thrown[friction]);
            let smooth = L::select(is_smooth, L::splat(2.0), L::splat(1.0));
            let of_leaving = L::select(is_thrown, L::splat(1.0), smooth);
            let of_stopping = L::select(reverses, L::splat(1.0), L::splat(0.0));
            zeros[forward] = L::select(leaves, of_leaving, zeros[forward]);
            zeros[forward] = L::select(stops, of_stopping, zeros[forward]);
            let slip = if is_forward { EventKind::SlipForward } else { EventKind::SlipBackward };
            let code = |kind| TextEvent::of(kind, friction).code::<L>();
            let code_of_sliding = L::select(reverses, code(EventKind::Reversal), L::splat(0.0));
            let ended = L::select(sticks, code(EventKind::Stick), code_of_sliding);
            L::select(leaves, code(slip), ended)
        }
    }
}

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Oscillator<L, D, N, AUTONOMOUS>
    {
        /// Where each switch is at the start, and each friction; what the text does not allow is no number.
        pub(crate) fn mode_at(&self, time: L, state: &mut [L; N]) -> TextMode<L> {
            let everywhere = L::Mask::splat(true);
            let (zero, one) = (L::splat(0.0), L::splat(1.0));
            let mut mode = TextMode::<L>::default();
            for (place, [first, second, _]) in self.pulses.iter().enumerate() {
                let passed =
                    L::select(first.lt(time), one, zero) + L::select(second.lt(time), one, zero);
                mode.passed[place] = passed.plain();
                // A duty that makes no pulse has no edges: no motion starts.
                state[0] = L::select(first.le(*second), state[0], L::splat(f64::NAN));
            }
            // The forces on what rests are known once the switches are.
            let mut values = Values::room();
            for pass in 0..2 {
                self.compute(&mut values, &mode, time, state);
                if pass == 0 {
                    self.note_sides(&values, &mut mode, state);
                    for friction in 0..self.program.frictions.len() {
                        self.note_sign(friction, everywhere, &values, &mut mode);
                    }
                    continue;
                }
                self.note_jumps(everywhere, &values, &mut mode);
                self.note_contacts(&values, &mut mode, state);
                for friction in 0..self.program.frictions.len() {
                    let rests = !slides(&mode, friction);
                    // It rests whatever it was given, derivatives included.
                    self.rest(friction, rests, &values, state);
                    let thrown = mode.thrown[friction];
                    mode.signs[friction] = L::Plain::select(rests, thrown, mode.signs[friction]);
                    mode.thrown[friction] = L::Plain::splat(0.0);
                }
            }
            mode
        }

        /// Notes on which side each switch is; a start behind the bound of an event is no number.
        fn note_sides(&self, values: &Values<L>, mode: &mut TextMode<L>, state: &mut [L; N]) {
            let (zero, one) = (L::splat(0.0), L::splat(1.0));
            let of = |place| at(place, &values.numbers, &values.registers);
            for (place, side) in self.program.sides.iter().enumerate() {
                let is_on = zero.lt(of(*side));
                mode.switches[place] = L::select(is_on, one, zero).plain();
            }
            for (lasts, bound) in self.program.lasts.iter().zip(&self.program.bounds.events) {
                let place = bound.map_or(0, |it| it.0);
                let own = &mut state[self.program.layout[place]];
                *own = L::select(of(*lasts).lt(zero), L::splat(f64::NAN), *own);
            }
        }
    }

    /// The direction in which a force at rest exceeds what is held; 0 where it does not.
    fn beyond<L: Lane>(needed: L, holds: L) -> L::Plain {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let backward = L::select(needed.lt(-holds), -one, zero);
        L::select(holds.lt(needed), one, backward).plain()
    }
}
