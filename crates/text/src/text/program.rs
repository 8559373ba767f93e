//! The instructions by which the values of a text are computed: constants once a case, others once a mode, series term by term.

use std::f64::consts::PI;
use std::sync::OnceLock;

use capsulemap_models::description::Description;

use crate::text::content::{Event, Section, Text};
use crate::text::instructions::{
    Bounds, FrictionPlaces, Guard, Instruction, LastingPlaces, Place, Register, Scalar, ScalarStep,
    SeriesStep, Unseen,
};
use crate::text::lowering::Making;
use crate::text::mode::{EventKind, TextEvent};

/// A state with the surfaces that its local extrema may touch.
pub type Touching = (usize, [Scalar; 2]);

/// Whether a bound is such a surface.
pub fn touches(touching: Option<Touching>, bound: Option<(usize, Scalar)>) -> bool {
    let both = touching.zip(bound);
    both.is_some_and(|((state, surfaces), (of, value))| state == of && surfaces.contains(&value))
}

/// What of a text the motion needs, with instructions for all of it.
#[derive(Debug, Clone)]
pub struct Program {
    /// The text.
    pub text: Text,
    /// What computes the numbers, each from earlier ones.
    pub scalars: Vec<ScalarStep>,
    /// Which of them change with the mode; the others are constant in a case.
    pub of_mode: Vec<Scalar>,
    /// The first registers are the states; what computes the others, each from earlier ones.
    pub series: Vec<Instruction>,
    /// How many registers there are.
    pub registers: usize,
    /// The rate of each state.
    pub rates: Vec<Place>,
    /// Of each switch what is positive on its side.
    pub sides: Vec<Place>,
    /// Of each event what is positive until it happens.
    pub lasts: Vec<Place>,
    /// Of each event what it makes of states.
    pub resets: Vec<Vec<(usize, Place)>>,
    /// Of each friction what it is of, its size, what it holds, and what it is at rest.
    pub frictions: Vec<FrictionPlaces>,
    /// Of each pulse its duty.
    pub duties: Vec<Scalar>,
    /// The period of the section, or the longest time that is waited for it.
    pub period: Scalar,
    /// Of each event whether it ends in a contact that lasts, and what is held then.
    pub lasting: Vec<Option<LastingPlaces>>,
    /// Of each switch and of each event where the motion is put.
    pub bounds: Bounds,
    /// The guards in their order.
    pub guards: Vec<Guard>,
    /// The series whose decay sets the length of a step: the states, and what may grow within a step from below the rounding of others.
    pub paced: Vec<Register>,
    /// The arguments of exponentials and of hyperbolic tangents, with where these are too small to be seen.
    pub arguments: Vec<(Register, Unseen)>,
    /// For how many coordinates a point of the section has room.
    pub room: usize,
    /// Where each state is in the array of a motion: first those on the section, which have room for `D`, then the state that is zero on
    /// it, then the one that drifts.
    pub layout: Vec<usize>,
    /// Of each event whether it may take the state across the surface of a switch, or of another event.
    pub crosses: Vec<bool>,
    /// The state whose local extrema may touch surfaces, with these: at first one, or two.
    pub touching: Option<Touching>,
    /// The description of its model, once it is one.
    pub description: OnceLock<&'static Description>,
    /// The events that may happen, in the order of their numbers.
    pub events: Vec<TextEvent>,
    /// Of all that is measured of values, these.
    pub observed: Vec<Option<Place>>,
    /// What computes those of them that the motion does not need, from what it does.
    pub of_observed: Vec<Instruction>,
    /// The registers of the motion that these are of.
    pub observed_from: Vec<Register>,
}

impl Program {
    /// The instructions of a text.
    ///
    /// A point of its section has room for `room` coordinates.
    ///
    /// # Panics
    /// Where it needs more.
    pub fn new(text: Text, room: usize) -> Self {
        let mut making = Making::new(&text);
        let rates: Vec<Place> = text.rates.iter().map(|it| making.place(*it)).collect();
        let sides: Vec<Place> = text.switches.iter().map(|it| making.place(it.side)).collect();
        let lasts: Vec<Place> = text.events.iter().map(|it| making.place(it.lasts)).collect();
        let resets = text
            .events
            .iter()
            .map(|event| event.reset.iter().map(|it| (it.0, making.place(it.1))).collect())
            .collect();
        let frictions: Vec<FrictionPlaces> =
            (0..text.frictions.len()).map(|it| making.friction(&text, it)).collect();
        let duties = text.pulses.iter().map(|it| making.scalar(it.duty)).collect();
        let period = match text.section {
            Section::Every(period) => making.scalar(period),
            Section::When { within, .. } => making.scalar(within),
        };
        let bounds = Bounds {
            switches: text.switches.iter().map(|it| making.bound(it.bound)).collect(),
            events: text.events.iter().map(|it| making.bound(it.bound)).collect(),
        };
        let lasting: Vec<_> = text.events.iter().map(|it| lasting(it, &rates)).collect();
        let guards = guards(&text);
        let touching = touching(&text, &bounds);
        let layout = layout(&text, room);
        let events = events(&text, &bounds, touching);
        let crosses = text.events.iter().map(|it| {
            let moved = it.moved.switches.iter().chain(&it.moved.events);
            moved.copied().any(|it| it)
        });
        let crosses = crosses.collect();
        let (of_motion, growing) = (making.series.len(), making.growing.clone());
        let observed: Vec<Option<Place>> = {
            let all = text.measured.iter();
            all.map(|it| it.of().map(|id| making.place(id))).collect()
        };
        let Making { scalars, of_mode, mut series, registers, .. } = making;
        let of_observed = series.split_off(of_motion);
        let observed_from = operands(&of_observed, &observed);
        let argument = |it: &Instruction| match it.step {
            SeriesStep::Exp(of) => Some((of, Unseen::Below)),
            SeriesStep::Tanh(of) => Some((of, Unseen::Beyond)),
            _ => None,
        };
        let arguments = series.iter().filter_map(argument).collect();
        let asked_for = sides.iter().chain(&lasts).copied();
        let of_guards: Vec<Place> = asked_for.chain(of_frictions(&frictions)).collect();
        let asked_for = observed_from.iter().map(|it| Place::Series(*it));
        let pressing = lasting.iter().flatten().map(|it| it.acceleration);
        let asked_for: Vec<Place> =
            of_guards.into_iter().chain(asked_for).chain(pressing).collect();
        let series = kept(series, &asked_for);
        let paced = (0..text.states.len()).chain(growing).collect();
        Program {
            text,
            scalars,
            of_mode,
            series,
            registers,
            rates,
            sides,
            lasts,
            resets,
            frictions,
            duties,
            period,
            lasting,
            bounds,
            guards,
            paced,
            arguments,
            room,
            layout,
            crosses,
            touching,
            description: OnceLock::new(),
            events,
            observed,
            of_observed,
            observed_from,
        }
    }
}

/// What the contact of an event that lasts holds.
fn lasting(event: &Event, rates: &[Place]) -> Option<LastingPlaces> {
    let (lasting, bound) = (event.lasting?, event.bound?);
    Some(LastingPlaces {
        state: bound.state,
        velocity: lasting.velocity,
        acceleration: rates[lasting.velocity],
        towards: if lasting.is_above { -1.0 } else { 1.0 },
    })
}

/// The registers of the motion that what is observed is of, or is.
fn operands(of_observed: &[Instruction], observed: &[Option<Place>]) -> Vec<Register> {
    let own = |register: &Register| {
        of_observed
            .iter()
            .any(|it| (it.register..it.register + it.step.registers()).contains(register))
    };
    let taken = of_observed.iter().flat_map(|it| it.step.operands());
    let are = observed.iter().filter_map(|it| match it {
        Some(Place::Series(register)) => Some(*register),
        _ => None,
    });
    let mut from: Vec<Register> = taken.chain(are).filter(|it| !own(it)).collect();
    from.sort_unstable();
    from.dedup();
    from
}

/// The events that may happen, in the order of their numbers.
fn events(text: &Text, bounds: &Bounds, touching: Option<Touching>) -> Vec<TextEvent> {
    let of_bound = |bound: &Option<(usize, Scalar)>, kinds: [EventKind; 2]| {
        if touches(touching, *bound) { kinds[0] } else { kinds[1] }
    };
    let mut events = Vec::new();
    for (place, bound) in bounds.events.iter().enumerate() {
        events.push(TextEvent::of(of_bound(bound, [EventKind::Impact, EventKind::Event]), place));
        let lasts = text.events[place].lasting.is_some();
        events.extend(lasts.then_some(TextEvent::of(EventKind::Opens, place)));
    }
    for (place, bound) in bounds.switches.iter().enumerate() {
        let enters = of_bound(bound, [EventKind::EntersContact, EventKind::Enters]);
        events.extend([enters, EventKind::Leaves].map(|it| TextEvent::of(it, place)));
    }
    let of_frictions =
        [EventKind::SlipForward, EventKind::SlipBackward, EventKind::Stick, EventKind::Reversal];
    for place in 0..text.frictions.len() {
        events.extend(of_frictions.map(|it| TextEvent::of(it, place)));
    }
    events.extend((!text.pulses.is_empty()).then_some(TextEvent::of(EventKind::Edge, 0)));
    events.sort();
    events
}

/// What guards ask of frictions.
fn of_frictions(frictions: &[FrictionPlaces]) -> impl Iterator<Item = Place> + '_ {
    frictions.iter().flat_map(|it| [it.of, it.holds, it.at_rest])
}

/// Instructions that know which of their registers are asked for as series.
fn kept(series: Vec<Instruction>, of_guards: &[Place]) -> Vec<Instruction> {
    let folded = series.iter().filter(|it| it.step.folds());
    let folded: Vec<Register> = folded.flat_map(|it| it.step.operands()).collect();
    let is_kept = |it: &Instruction| {
        let own = it.register..it.register + it.step.registers();
        let is_asked_for = |place: &Place| match place {
            Place::Series(register) => own.contains(register),
            Place::Scalar(_) => false,
        };
        it.step.folds()
            || folded.iter().any(|it| own.contains(it))
            || of_guards.iter().any(is_asked_for)
    };
    series.iter().map(|it| Instruction { is_kept: is_kept(it), ..*it }).collect()
}

impl Program {
    /// What the places of the array of a motion are multiplied by to be compared, with the period of the section.
    ///
    /// A state of a driven oscillator whose unit is that of another one times seconds counts as a velocity, by the angular
    /// frequency; others count as they are.
    pub fn scales<const N: usize>(&self, period: f64) -> [f64; N] {
        let mut scales = [1.0; N];
        for (state, at) in self.layout.iter().enumerate() {
            if self.counts_as_velocity(state) {
                scales[*at] = 2.0 * PI / period;
            }
        }
        scales
    }

    /// The values of the outputs of the text, by the values of parameters and what was measured.
    pub fn outputs(&self, parameters: &[f64], measured: &[f64]) -> Vec<f64> {
        let values = self.text.graph.constants(&|place| parameters[place], measured);
        self.text.outputs.iter().map(|it| values[it.value.index()]).collect()
    }

    /// Whether a state is compared with others by the angular frequency.
    pub fn counts_as_velocity(&self, state: usize) -> bool {
        let states = &self.text.states;
        let rate = format!("{}/s", states[state].unit);
        let has_rate = states.iter().any(|it| it.unit == rate);
        has_rate && matches!(self.text.section, Section::Every(_))
    }
}

/// Where each state of a text is in the array of a motion.
fn layout(text: &Text, room: usize) -> Vec<usize> {
    let on_section: Vec<usize> = text.on_section().collect();
    assert!(on_section.len() <= room, "the section has more coordinates than room");
    let place = |state: usize| match on_section.iter().position(|it| *it == state) {
        Some(place) => place,
        None if text.drift == Some(state) => room + 1,
        None => room,
    };
    (0..text.states.len()).map(place).collect()
}

/// The guards of a text in their order.
fn guards(text: &Text) -> Vec<Guard> {
    let events = (0..text.events.len()).map(Guard::Event);
    let switches = (0..text.switches.len()).map(Guard::Switch);
    let frictions =
        (0..text.frictions.len()).flat_map(|it| [Guard::Forward(it), Guard::Backward(it)]);
    let edges = (!text.pulses.is_empty()).then_some(Guard::Edge);
    events.chain(switches).chain(frictions).chain(edges).collect()
}

/// The state that may touch surfaces: that which the first event is at, or else the first switch.
fn touching(text: &Text, bounds: &Bounds) -> Option<Touching> {
    let mut all = bounds.events.iter().flatten();
    let mut switches = bounds.switches.iter().flatten();
    let (state, first) = *all.next().or_else(|| switches.next())?;
    let second = all.chain(switches).find(|it| it.0 == state).map_or(first, |it| it.1);
    debug_assert!(state < text.states.len());
    Some((state, [first, second]))
}
