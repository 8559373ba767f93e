//! What the mode of a motion is, and what ends it.

use capsulemap_engine::flow::{Event, MAX_GUARDS};
use capsulemap_engine::lane::{Lane, SideBySide};

use crate::text::content::MOST_PULSES;

/// The most frictions, each of which has two guards, and the most pulses.
pub const FEW: usize = {
    assert!(MOST_PULSES <= MAX_GUARDS / 2, "pulses have no more places than frictions");
    MAX_GUARDS / 2
};

/// Which equations act in each lane.
#[derive(Debug, Clone, Copy)]
pub struct TextMode<L: Lane> {
    /// Of each switch 1 on its side, else 0.
    pub switches: [L::Plain; MAX_GUARDS],
    /// Of each friction the sign of its sliding; 0 at rest.
    pub signs: [L::Plain; FEW],
    /// Of each friction at rest the direction in which a force that has jumped ends the rest at once; else 0.
    pub thrown: [L::Plain; FEW],
    /// Of each pulse how many edges have passed in the cycle.
    pub passed: [L::Plain; FEW],
    /// Of each event 1 where its contact lasts, else 0.
    pub contacts: [L::Plain; MAX_GUARDS],
    /// Of each contact that lasts 1 where what presses on it has jumped below zero, so that it opens at once.
    pub loose: [L::Plain; MAX_GUARDS],
}

impl<L: Lane> Default for TextMode<L> {
    fn default() -> Self {
        let (many, few) = ([L::Plain::ZERO; MAX_GUARDS], [L::Plain::ZERO; FEW]);
        TextMode {
            switches: many,
            signs: few,
            thrown: few,
            passed: few,
            contacts: many,
            loose: many,
        }
    }
}

impl<L: Lane> SideBySide for TextMode<L> {
    type One = TextMode<f64>;

    #[inline(always)]
    fn splat(one: &TextMode<f64>) -> Self {
        TextMode {
            switches: SideBySide::splat(&one.switches),
            signs: SideBySide::splat(&one.signs),
            thrown: SideBySide::splat(&one.thrown),
            passed: SideBySide::splat(&one.passed),
            contacts: SideBySide::splat(&one.contacts),
            loose: SideBySide::splat(&one.loose),
        }
    }
    #[inline(always)]
    fn lane(&self, index: usize) -> TextMode<f64> {
        TextMode {
            switches: self.switches.lane(index),
            signs: self.signs.lane(index),
            thrown: self.thrown.lane(index),
            passed: self.passed.lane(index),
            contacts: self.contacts.lane(index),
            loose: self.loose.lane(index),
        }
    }
    #[inline(always)]
    fn put(&mut self, index: usize, one: &TextMode<f64>) {
        self.switches.put(index, &one.switches);
        self.signs.put(index, &one.signs);
        self.thrown.put(index, &one.thrown);
        self.passed.put(index, &one.passed);
        self.contacts.put(index, &one.contacts);
        self.loose.put(index, &one.loose);
    }
    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        self.switches.take_lane(index, &other.switches);
        self.signs.take_lane(index, &other.signs);
        self.thrown.take_lane(index, &other.thrown);
        self.passed.take_lane(index, &other.passed);
        self.contacts.take_lane(index, &other.contacts);
        self.loose.take_lane(index, &other.loose);
    }
}

/// Where a part of a mode is 1.
#[inline(always)]
pub fn is_on<P: Lane>(part: P) -> P::Mask {
    P::splat(0.5).lt(part)
}

/// What happens where a mode ends, with the place of what it happens to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextEvent(u8);

/// The kinds of events of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum EventKind {
    /// An event of the text on the surface that may be touched.
    Impact = 0,
    /// Another event of the text.
    Event,
    /// A switch becomes 1 on the surface that may be touched.
    EntersContact,
    /// Another switch becomes 1.
    Enters,
    /// A switch becomes 0.
    Leaves,
    /// Rest ends, forward.
    SlipForward,
    /// Rest ends, backward.
    SlipBackward,
    /// Rest begins.
    Stick,
    /// What a friction is of changes its sign.
    Reversal,
    /// An edge of a pulse.
    Edge,
    /// A contact that has lasted ends.
    Opens,
}

impl EventKind {
    const ALL: [EventKind; 11] = [
        EventKind::Impact,
        EventKind::Event,
        EventKind::EntersContact,
        EventKind::Enters,
        EventKind::Leaves,
        EventKind::SlipForward,
        EventKind::SlipBackward,
        EventKind::Stick,
        EventKind::Reversal,
        EventKind::Edge,
        EventKind::Opens,
    ];
}

impl TextEvent {
    /// An event of a kind, to what has a place.
    pub const fn of(kind: EventKind, place: usize) -> Self {
        TextEvent(kind as u8 * MAX_GUARDS as u8 + place as u8)
    }

    /// All that a text can have, in the order of their numbers.
    pub fn all() -> impl Iterator<Item = TextEvent> {
        EVENTS.into_iter()
    }

    /// Its kind.
    pub fn kind(self) -> EventKind {
        EventKind::ALL[usize::from(self.0) / MAX_GUARDS]
    }

    /// The place of what it happens to among those of its kind.
    pub fn place(self) -> usize {
        usize::from(self.0) % MAX_GUARDS
    }
}

/// All events that a text can have.
const EVENTS: [TextEvent; EventKind::ALL.len() * MAX_GUARDS] = {
    let mut events = [TextEvent(0); EventKind::ALL.len() * MAX_GUARDS];
    let mut number = 0;
    while number < events.len() {
        events[number] = TextEvent(number as u8);
        number += 1;
    }
    events
};

impl Event for TextEvent {
    const ALL: &'static [TextEvent] = &EVENTS;

    fn number(self) -> u8 {
        self.0 + 1
    }

    fn from_code(code: f64) -> Option<Self> {
        (code > 0.5).then_some(TextEvent((code - 0.5) as u8))
    }

    fn is_impact(self) -> bool {
        matches!(self.kind(), EventKind::Impact | EventKind::EntersContact)
    }

    fn is_timed(self) -> bool {
        self.kind() == EventKind::Edge
    }
}
