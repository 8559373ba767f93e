//! What a figure says of the part of the results that it shows: where axes are held, what is taken for something else.

use super::text::Text;
use super::view::View;
use crate::store::catalogue::DIRECTION;
use crate::store::schema::INHERITED_ALONG;
use crate::study::Sweep;

/// Values that differ by no more than this, relative to them, are one.
const ROUNDING: f64 = 1e-9;

impl View<'_> {
    /// What is set and has no effect, or leaves values out.
    pub fn notes_of_settings(&self) -> Vec<String> {
        self.chosen.iter().flat_map(|(name, chosen)| chosen.notes(name)).collect()
    }

    /// What `at` asks for and the axes do not have, with the value that was taken, for each.
    pub fn taken_for_another(&self) -> Vec<String> {
        let held = self.held.places.iter();
        let one = held.filter_map(|(name, at)| Some((name, *at, *self.drawing.at.get(name)?)));
        let several = self.drawing.panels.iter().zip(&self.held.panelled).flat_map(
            |((name, wanted), (_, taken))| {
                wanted.iter().zip(taken).map(move |it| (name, *it.1, *it.0))
            },
        );
        let notes = one.chain(several).map(|(name, at, wanted)| self.taken(name, at, wanted));
        notes.flatten().collect()
    }

    /// That the value of an axis at a place is taken for the one that is wanted, where they differ.
    fn taken(&self, name: &str, place: usize, wanted: f64) -> Option<String> {
        let (taken, unit) = (*self.coordinate_values(name).get(place)?, self.unit(name));
        let differs = (taken - wanted).abs() > ROUNDING * taken.abs().max(wanted.abs());
        differs.then(|| format!("{name} = {taken}{unit} is taken for {wanted}{unit}, the nearest"))
    }

    /// What a figure shows, in a sentence kept inside its files.
    pub fn about(&self, outputs: &[String], free: &[&str]) -> String {
        let over =
            if free.is_empty() { String::new() } else { format!(" over {}", free.join(", ")) };
        let held = self.held_record(free);
        let at = if held.is_empty() { String::new() } else { format!(" at {held}") };
        format!("{}{over}{at}", outputs.join(", "))
    }

    /// Where the axes other than `free` are held, as "name = value unit" in the units of the figure.
    pub fn held_record(&self, free: &[&str]) -> String {
        let ours = self.axes().into_iter().filter(|name| !free.contains(name));
        let mut notes = Vec::new();
        for axis in ours {
            notes.push(self.held_values(axis, axis));
            notes.extend(self.beside(axis).into_iter().map(|name| self.held_values(axis, name)));
        }
        notes.join(", ")
    }

    /// Where an axis is held, as "name = value unit" of it or of what varies beside it, with several values where panels differ in it.
    fn held_values(&self, axis: &str, name: &str) -> String {
        let values = match name == axis {
            true => self.coordinate_values(axis),
            false => self.values_beside(name),
        };
        let quantity = self.quantity(name);
        let several = self.held.panelled.iter().find(|it| it.0 == axis).map(|it| it.1.clone());
        let held = several.unwrap_or_else(|| vec![self.held.place(axis)]);
        let flags = self.dataset.coordinate(name).map_or(&[][..], |it| &it.flags);
        let held = held.into_iter().map(|index| {
            let value = values.get(index).copied().unwrap_or(f64::NAN);
            let named = flags.iter().find(|(code, _)| *code as f64 == value);
            named.map_or_else(|| significant(value * quantity.factor), |it| it.1.clone())
        });
        let held: Vec<String> = held.collect();
        let unit = quantity.unit().content();
        let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
        format!("{name} = {}{unit}", held.join(" and "))
    }

    /// The part of the study that a figure shows, for those of its axes that have several values
    /// and are not among `free`.
    pub fn held_note(&self, free: &[&str]) -> Option<Text> {
        let others = self.axes().into_iter().filter(|name| !free.contains(name));
        let varying = others.filter(|name| self.coordinate_values(name).len() > 1);
        // What is told of the difference of two sweeps holds for both.
        let is_of_both = self.drawing.sweep == Some(Sweep::Difference);
        let ours = varying.filter(|name| !(is_of_both && *name == DIRECTION.name));
        ours.map(|name| self.value_note(name, self.held.place(name)))
            .reduce(|note, next| note.then(Text::plain(", ")).then(next))
    }

    /// The note on where the axes are held, and on what is left out.
    pub fn note(&self, free: &[&str], left_out: &Option<String>) -> Option<Text> {
        let left_out = left_out.as_deref().map(Text::plain);
        let parts = self.held_note(free).into_iter().chain(left_out);
        parts.reduce(|note, next| note.then(Text::plain("; ")).then(next))
    }

    /// The name of a direction in which starts were inherited, with the symbol of the axis that it goes along.
    fn direction_text(&self, name: &str) -> Text {
        match self.dataset.attributes.get(INHERITED_ALONG) {
            Some(path) if self.is_by_places(path) => Text::plain(&format!("{name} in\u{a0}{path}")),
            Some(axis) => {
                Text::plain(&format!("{name} in\u{a0}")).then(self.quantity(axis).short_name())
            }
            None => Text::plain(name),
        }
    }

    /// The name of a direction in which starts were inherited, with the axis that it goes along unless that is `x`.
    pub fn direction_name(&self, name: &str, x: &str) -> String {
        match self.dataset.attributes.get(INHERITED_ALONG) {
            Some(axis) if x != axis.as_str() => format!("{name} in {axis}"),
            _ => name.to_owned(),
        }
    }

    /// A value of an axis, as "symbol = value unit" or by its name where values have names.
    pub fn value_note(&self, axis: &str, index: usize) -> Text {
        let value = self.coordinate_values(axis).get(index).copied().unwrap_or(f64::NAN);
        let flags = self.dataset.coordinate(axis).map_or(&[][..], |it| &it.flags);
        match flags.iter().find(|(code, _)| *code as f64 == value) {
            Some((_, name)) if axis == DIRECTION.name => self.direction_text(name),
            Some((_, name)) => Text::plain(name),
            None => self.notes_along(axis, index, value),
        }
    }

    /// The values of an axis and of what varies beside it along a path, each as "symbol = value unit".
    fn notes_along(&self, axis: &str, index: usize, value: f64) -> Text {
        let own = (!self.is_by_places(axis)).then(|| self.quantity(axis).note(value));
        let beside = self.beside(axis).into_iter().map(|name| {
            let value = self.values_beside(name).get(index).copied().unwrap_or(f64::NAN);
            self.quantity(name).note(value)
        });
        let all = own.into_iter().chain(beside);
        all.reduce(|note, next| note.then(Text::plain(", ")).then(next)).unwrap_or_default()
    }
}

/// A number in the unit of a figure, without the last digits, which converting it leaves.
fn significant(number: f64) -> String {
    let digits = format!("{number:.13e}").parse::<f64>().unwrap_or(number);
    digits.to_string()
}
