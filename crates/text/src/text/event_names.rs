//! What the events of a text are called.

use crate::text::content::Text;
use crate::text::mode::{EventKind, TextEvent};

/// What an event is called; "none" where the text has no such event.
pub fn event_name(text: &Text, event: TextEvent) -> String {
    let place = event.place();
    let of_switch = |verb: &str| text.switches.get(place).map(|it| format!("{} {verb}", it.name));
    let of_friction = |what: &str| {
        text.frictions.get(place).map(|it| match text.frictions.len() {
            1 => what.to_owned(),
            _ => format!("{what} of {}", it.name),
        })
    };
    let name = match event.kind() {
        EventKind::Impact | EventKind::Event => text.events.get(place).map(|it| it.name.clone()),
        EventKind::EntersContact | EventKind::Enters => {
            let enters = text.switches.get(place).and_then(|it| it.enters.clone());
            enters.or_else(|| of_switch("begins"))
        }
        EventKind::Leaves => of_switch("ends"),
        EventKind::SlipForward => of_friction("slip forward"),
        EventKind::SlipBackward => of_friction("slip backward"),
        EventKind::Stick => of_friction("stick"),
        EventKind::Reversal => of_friction("reversal"),
        EventKind::Opens => {
            let lasting = text.events.get(place).filter(|it| it.lasting.is_some());
            lasting.map(|it| format!("{} ends", it.name))
        }
        EventKind::Edge => (!text.pulses.is_empty() && place == 0).then(|| "edge".into()),
    };
    name.unwrap_or_else(|| "none".into())
}

/// The same as a name that expressions and results may have.
pub fn event_symbol(text: &Text, event: TextEvent) -> String {
    let name = event_name(text, event);
    let letters = name.chars().map(|it| if it.is_ascii_alphanumeric() { it } else { '_' });
    letters.flat_map(char::to_lowercase).collect()
}

/// All names of events that a text has, as expressions have them.
pub fn event_symbols(text: &Text) -> Vec<String> {
    let all = TextEvent::all().filter(|it| event_name(text, *it) != "none");
    let mut symbols: Vec<String> = all.map(|it| event_symbol(text, it)).collect();
    symbols.sort();
    symbols.dedup();
    symbols
}
