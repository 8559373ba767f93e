//! What is said below a figure of a report: its kind, what is seen in it, and what it leaves out.

use super::numbers::{called, lower};
use crate::description::Description;
use crate::figure::Picture;
use crate::store::catalogue::named;
use crate::study::{Coordinate, Drawing, DrawingKind};

/// The caption of a figure of a study, and its notes, a sentence each.
pub fn caption(drawing: &Drawing, picture: &Picture, model: &'static Description) -> String {
    let kind = kind(drawing.kind);
    let title = match &drawing.title {
        Some(title) => format!("{title} ({})", lower(&kind)),
        None if drawing.name == drawing.kind.name() => kind,
        None => format!("{kind} \u{201c}{}\u{201d}", drawing.name),
    };
    let notes: String = picture.notes.iter().map(|it| sentence(it)).collect();
    format!("{title}: {}.{notes}", seen(&picture.about, model))
}

/// What a kind of figure is called.
pub fn kind(kind: DrawingKind) -> String {
    let words = kind.name().replace('-', " ");
    let words = match kind {
        DrawingKind::Bifurcation => format!("{words} diagram"),
        DrawingKind::Basin => format!("{words}s of attraction"),
        _ => words,
    };
    let mut letters = words.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}

/// A note as a sentence after others.
fn sentence(note: &str) -> String {
    let mut letters = note.trim_end_matches('.').chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!(" {first}{}.", letters.as_str())
}

/// What a figure shows, with quantities called as figures call them; what stands behind a semicolon stays as it is.
fn seen(about: &str, model: &'static Description) -> String {
    let (shown, more) = match about.split_once("; ") {
        Some((shown, more)) => (shown, format!("; {more}")),
        None => (about, String::new()),
    };
    let (shown, at) = match shown.split_once(" at ") {
        Some((shown, at)) => (shown, format!(" at {at}")),
        None => (shown, String::new()),
    };
    let parts = shown.split(" over ").map(|part| {
        let names = part.split(", ").map(|name| in_words(name, model));
        names.collect::<Vec<_>>().join(", ")
    });
    format!("{}{at}{more}", parts.collect::<Vec<_>>().join(" over "))
}

/// A variable called in words; what is none stays as it is.
fn in_words(name: &str, model: &'static Description) -> String {
    if let Some(coordinate) = Coordinate::all(model).find(|it| it.name() == name) {
        return match coordinate.meaning() {
            "" => name.to_owned(),
            meaning => format!("{meaning} ({name})"),
        };
    }
    if let Some(output) = model.outputs().find(|it| it.name() == name) {
        return called(output.quantity());
    }
    match named(name, model).map(|entry| entry.meaning) {
        Some("") | None => name.to_owned(),
        Some(meaning) => meaning.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::of::default_model;

    #[test]
    fn quantities_are_called_in_words() {
        let model = default_model();
        let about = "section_r, progression_speed over omega at p_d = 3.4 N; 3 cases";
        let words = "relative displacement x1 - x2 at the stroboscopic section, progression speed over \
             frequency of the drive (omega) at p_d = 3.4 N; 3 cases";
        assert_eq!(seen(about, model), words);
        assert_eq!(kind(DrawingKind::PhasePortrait), "Phase portrait");
        assert_eq!(
            sentence("special points that are not marked: 3."),
            " Special points that are not marked: 3."
        );
    }
}
