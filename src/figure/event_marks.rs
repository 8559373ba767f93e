//! The events of attractors as symbols on the panels of a diagram.

use super::attractors::Attractors;
use super::error::FigureError;
use super::kind::Names;
use super::symbol::{SYMBOLS, Symbol};
use super::text::Text;
use super::thinned::{Placed, Special};
use super::view::View;
use crate::description::{Description, Section};
use crate::store::catalogue::{
    EVENT_ATTRACTOR, EVENT_KIND, EVENT_PERIOD, EVENT_PLACE, Place, section,
};

/// What is read of the events.
pub fn reads(model: &'static Description) -> Names {
    let sections = section(model).into_iter().map(|entry| Place::Event.of(entry));
    Names::of([EVENT_KIND, EVENT_ATTRACTOR, EVENT_PERIOD, EVENT_PLACE])
        .and(sections)
        .and(Place::Event.parameters(model))
}

/// One event.
struct Event {
    symbol: Symbol,
    /// The attractor that it is of.
    attractor: i64,
    period: i64,
    /// Value of the axis [SI].
    at: f64,
    /// Its section point [SI].
    section: Section,
}

/// The events to be marked.
pub struct EventMarks {
    events: Vec<Event>,
    /// Value shown per value of the axis stored.
    factor: f64,
    /// How many events of attractors without a colour of their own lie within the limits and are not marked.
    left_out: usize,
}

impl EventMarks {
    /// None at all.
    pub fn none() -> EventMarks {
        EventMarks { events: Vec::new(), factor: 1.0, left_out: 0 }
    }

    /// Which events are not marked, if any.
    pub fn left_out(&self) -> Option<String> {
        (self.left_out > 0)
            .then(|| format!("special points of further attractors, not marked: {}", self.left_out))
    }

    /// The events along the axis `x` of attractors with colours of their own, where the other axes are held.
    pub fn of(
        view: &View<'_>,
        x: &str,
        attractors: &Attractors<'_>,
    ) -> Result<EventMarks, FigureError> {
        let quantity = view.quantity(x);
        let factor = quantity.factor;
        let mut events = events(view, x)?;
        events.retain(|event| quantity.is_within(event.at * factor));
        let all = events.len();
        events.retain(|event| attractors.has_colour(event.attractor));
        let left_out = all - events.len();
        // Where symbols of one kind overlap, that of the shortest orbit stays.
        events.sort_by_key(|event| event.period);
        Ok(EventMarks { events, factor, left_out })
    }

    /// The symbols that occur, with their names.
    pub fn legend(&self) -> impl Iterator<Item = (Symbol, Text)> {
        let occurring = SYMBOLS
            .into_iter()
            .rev()
            .filter(|symbol| self.events.iter().any(|event| event.symbol == *symbol));
        occurring.map(|symbol| (symbol, Text::plain(symbol.words)))
    }

    /// The symbols on the panel of a section coordinate, with their places in its units: each at the section point
    /// of its own orbit. No other output of that orbit is known, and on other panels there are none; nor is there a place for
    /// what happens to a motion that does not repeat.
    pub fn on(&self, view: &View<'_>, output: &str) -> Vec<Placed> {
        let Some(i) = section(view.model()).iter().position(|entry| entry.name == output) else {
            return Vec::new();
        };
        let factor = view.quantity(output).factor;
        let with_place = self.events.iter().filter(|event| event.section[i].is_finite());
        with_place
            .map(|event| {
                let at = (event.at * self.factor, event.section[i] * factor);
                (Special::One(event.symbol), at)
            })
            .collect()
    }
}

/// The events of kinds with symbols, where the figure holds the axes other than `x`; none where the results hold no events.
fn events(view: &View<'_>, x: &str) -> Result<Vec<Event>, FigureError> {
    if view.dataset.variable(EVENT_KIND.name).is_none() {
        return Ok(Vec::new());
    }
    let (kinds, attractors) = (column(view, EVENT_KIND.name)?, column(view, EVENT_ATTRACTOR.name)?);
    let (places, periods) = (column(view, &place_name(view, x))?, column(view, EVENT_PERIOD.name)?);
    let coordinates = section(view.model()).into_iter();
    let coordinates: Vec<Vec<f64>> = coordinates
        .map(|entry| column(view, &Place::Event.name(entry.name)))
        .collect::<Result<_, _>>()?;
    let on_line = on_line(view, x, kinds.len())?;
    let flags = view.flags(EVENT_KIND.name);
    let events = (0..kinds.len()).filter(|i| on_line[*i]).filter_map(|i| {
        let (_, name) = flags.iter().find(|(code, _)| *code as f64 == kinds[i])?;
        Some(Event {
            symbol: Symbol::named(name)?,
            attractor: attractors[i] as i64,
            period: periods[i] as i64,
            at: places[i],
            section: coordinates.iter().map(|column| column[i]).collect(),
        })
    });
    Ok(events.collect())
}

/// The variable of where the events are along an axis.
fn place_name(view: &View<'_>, x: &str) -> String {
    match view.is_by_places(x) {
        true => EVENT_PLACE.name.to_owned(),
        false => Place::Event.name(x),
    }
}

/// A variable of the events, in SI.
fn column(view: &View<'_>, name: &str) -> Result<Vec<f64>, FigureError> {
    Ok(view.take(name, &[])?.into_iter().collect())
}

/// Whether each event lies where the figure holds the axes other than `x`.
fn on_line(view: &View<'_>, x: &str, count: usize) -> Result<Vec<bool>, FigureError> {
    let mut on_line = vec![true; count];
    let others = view.axes().into_iter().filter(|name| *name != x);
    for name in others.flat_map(|name| std::iter::once(name).chain(view.beside(name))) {
        let column = Place::Event.name(name);
        if view.dataset.variable(&column).is_none() {
            continue;
        }
        let held = view.parameter(name, &[])?.into_iter().next();
        for (kept, value) in on_line.iter_mut().zip(view.take(&column, &[])?) {
            *kept &= Some(value) == held;
        }
    }
    Ok(on_line)
}
