//! What is said of a name that is not known: those that are allowed, and the nearest of them.

use strsim::damerau_levenshtein;

use crate::description::Description;
use crate::of::all_models;

/// A message about a name that is not known, with the nearest of those that are.
pub fn unknown<'n>(what: &str, name: &str, known: impl Iterator<Item = &'n str>) -> String {
    let known: Vec<&str> = known.collect();
    if known.is_empty() {
        return format!("unknown {what} \"{name}\" (there is none)");
    }
    let nearest = nearest(name, known.iter().copied());
    let hint = match nearest {
        Some(candidate) => format!("; did you mean \"{candidate}\"?"),
        None => String::new(),
    };
    format!("unknown {what} \"{name}\"{hint} (allowed: {})", listed(name, known))
}

/// The same about a key of a model, with the model that has it on other ground, if there is one.
pub fn unknown_of<'n>(
    model: &'static Description,
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
) -> String {
    let others = all_models().into_iter().filter(|it| it.extends == Some(model));
    let having = others.into_iter().find(|it| has(it, name) && !has(model, name));
    match having {
        Some(other) => {
            format!(
                "unknown {what} \"{name}\" of the model {}: it is one of the model {}",
                model.name, other.name
            )
        }
        None => unknown(what, name, known),
    }
}

/// Whether a model has a quantity that studies name so.
fn has(model: &'static Description, name: &str) -> bool {
    let starts = model.coordinates.iter().map(|it| it.start.name);
    model.parameter(name).is_some()
        || model.output(name).is_some()
        || model.signal(name).is_some()
        || model.points().map(|it| it.name).chain(starts).any(|it| it == name)
}

/// Names in a list; of many, those that are nearest to `name`, and how many others there are.
fn listed(name: &str, mut known: Vec<&str>) -> String {
    if known.len() <= MOST_LISTED {
        return known.join(", ");
    }
    let others = known.len() - NEAREST_LISTED;
    known
        .sort_by_key(|candidate| (!candidate.contains(name), damerau_levenshtein(name, candidate)));
    let nearest = known[..NEAREST_LISTED].join(", ");
    format!(
        "{nearest} and {others} others, which capsulemap help study parameters and capsulemap help output list"
    )
}

/// Names that a message lists at most, and how many of a longer list.
const MOST_LISTED: usize = 40;
const NEAREST_LISTED: usize = 10;

/// The name among `known` that was probably meant: one that begins with it or has it among its words, else one that differs in few
/// letters.
pub fn nearest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    known
        .map(|candidate| (rank(name, candidate), damerau_levenshtein(name, candidate), candidate))
        .filter(|&(rank, distance, _)| rank < 2 || distance <= 1 + name.chars().count() / 3)
        .min_by_key(|&(rank, distance, _)| (rank, distance))
        .map(|(_, _, candidate)| candidate)
}

/// How a name matches another: 0 where that begins with it, 1 where that has it among its words, 2 otherwise.
fn rank(name: &str, candidate: &str) -> u8 {
    match candidate {
        _ if candidate.starts_with(name) && !name.is_empty() => 0,
        _ if candidate.split(['_', '-']).any(|word| word == name) => 1,
        _ => 2,
    }
}
