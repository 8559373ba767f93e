//! What is said below a figure of a report: its kind, what is seen in it, and what it leaves out.

use super::computation::listed;
use super::numbers::{called, lower};
use crate::description::Description;
use crate::figure::Picture;
use crate::store::catalogue::{DIRECTION, named};
use crate::study::{Coordinate, Drawing, DrawingKind};

/// What a figure is called in a sentence.
pub fn mention(drawing: &Drawing) -> String {
    let kind = lower(&kind(drawing.kind));
    match drawing.name == drawing.kind.name() {
        true => kind,
        false => format!("{kind} \u{201c}{}\u{201d}", drawing.name),
    }
}

/// The caption of a figure of a study, and its notes, a sentence each.
pub fn caption(drawing: &Drawing, picture: &Picture, model: &'static Description) -> String {
    let kind = kind(drawing.kind);
    let title = match &drawing.title {
        Some(title) => format!("{title} ({})", lower(&kind)),
        None if drawing.name == drawing.kind.name() => kind,
        None => format!("{kind} \u{201c}{}\u{201d}", drawing.name),
    };
    let notes: String = picture.notes.iter().map(|it| sentence(it)).collect();
    // Diagrams have a panel for each output, one below the other.
    let is_lettered = drawing.kind == DrawingKind::Bifurcation && drawing.panels.is_empty();
    format!("{title}: {}.{notes}", seen(&picture.about, is_lettered, model))
}

/// What a kind of figure is called.
pub fn kind(kind: DrawingKind) -> String {
    let words = match kind {
        DrawingKind::Bifurcation => format!("{} diagram", kind.name()),
        DrawingKind::Basin => format!("{}s of attraction", kind.name()),
        // The word of the field has its hyphen.
        DrawingKind::TradeOff => kind.name().to_owned(),
        DrawingKind::TradeOffMaps => format!("maps of the {}", DrawingKind::TradeOff.name()),
        _ => kind.name().replace('-', " "),
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

/// What a figure shows, with quantities called as figures call them; what stands behind a colon or a semicolon stays as it is.
fn seen(about: &str, is_lettered: bool, model: &'static Description) -> String {
    let end = [": ", "; "].into_iter().filter_map(|it| about.find(it)).min().unwrap_or(about.len());
    let (shown, more) = about.split_at(end);
    let (shown, at) = match shown.split_once(" at ") {
        Some((shown, at)) => (shown, format!(" at {at}")),
        None => (shown, String::new()),
    };
    let (outputs, over) = match shown.split_once(" over ") {
        Some((outputs, over)) => (outputs, format!(" over {}", in_words(over, false, model))),
        None => (shown, String::new()),
    };
    format!("{}{over}{at}{more}", in_words(outputs, is_lettered, model))
}

/// Variables called in words, with the letters of panels, if each has one.
fn in_words(names: &str, is_lettered: bool, model: &'static Description) -> String {
    let words: Vec<String> = names.split(", ").map(|name| word(name, model)).collect();
    if !is_lettered || words.len() < 2 {
        return listed(&words);
    }
    let lettered = ('a'..='z').zip(&words).map(|(letter, word)| format!("({letter}) {word}"));
    listed(&lettered.collect::<Vec<_>>())
}

/// A variable called in words; what is none stays as it is.
fn word(name: &str, model: &'static Description) -> String {
    if name == DIRECTION.name {
        return "direction of the sweep".to_owned();
    }
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
        // What is said of its numbers is not what it is.
        Some(meaning) => {
            let meaning = meaning.split(", ").next().unwrap_or(meaning);
            meaning.replace(" - ", " \u{2212} ")
        }
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
        let words = "(a) relative displacement x1 \u{2212} x2 at the stroboscopic section and (b) progression speed over \
             frequency of the drive (omega) at p_d = 3.4 N; 3 cases";
        assert_eq!(seen(about, true, model), words);
        let words = "attractor that the case ends on over relative displacement at the start (start_r): 2 at 3 %; more";
        assert_eq!(seen("attractor over start_r: 2 at 3 %; more", false, model), words);
        let kinds =
            [DrawingKind::PhasePortrait, DrawingKind::TradeOff, DrawingKind::Basin].map(kind);
        assert_eq!(kinds, ["Phase portrait", "Trade-off", "Basins of attraction"]);
        assert_eq!(
            sentence("special points that are not marked: 3."),
            " Special points that are not marked: 3."
        );
    }
}
