//! Names in the source are words of the field, not words whose meaning a reader has to guess.

use super::{FOLDERS, Source, assert_clean, identifiers, sources};

/// Words that are no part of an identifier or a path, also in the plural.
const FORBIDDEN: [&str; 15] = [
    "way",
    "happening",
    "station",
    "stride",
    "piece",
    "night",
    "works",
    "made",
    "bystanders",
    "convoy",
    "seat",
    "relieve",
    "wandering",
    "ending",
    "seal",
];

/// The parts of an identifier in lower case: `LongRun` and `long_run` are "long" and "run".
fn parts(identifier: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut before_is_lower = false;
    for character in identifier.chars() {
        let begins = character == '_' || (character.is_uppercase() && before_is_lower);
        if begins {
            parts.push(String::new());
        }
        if character.is_alphabetic() {
            parts.last_mut().expect("a part").extend(character.to_lowercase());
        }
        before_is_lower = character.is_lowercase() || character.is_ascii_digit();
    }
    parts
}

/// The forbidden word that a part of an identifier is, if it is one.
fn forbidden(part: &str) -> Option<&'static str> {
    let is_part = |word: &&str| part == *word || part.strip_suffix('s') == Some(*word);
    FORBIDDEN.into_iter().find(is_part)
}

/// Every name in the code or path of a file that has a forbidden word in it.
fn name_faults(source: &Source) -> Vec<String> {
    let in_code = identifiers(&source.code).map(|(_, name, _)| name);
    let in_path = source.path.split(['/', '.']);
    let mut faults = Vec::new();
    for name in in_code.chain(in_path) {
        let refused = parts(name).into_iter().filter_map(|part| forbidden(&part));
        faults.extend(refused.map(|word| format!("{}: {word} in {name}", source.path)));
    }
    faults.sort();
    faults.dedup();
    faults
}

#[test]
fn names_are_words_of_the_field() {
    let all = sources(&FOLDERS);
    assert!(all.len() > 5, "the source was not found");
    assert_clean(all.iter().flat_map(name_faults).collect());
}

#[test]
fn a_forbidden_word_in_a_name_is_seen() {
    for code in [
        "let way = 1;",
        "fn both_ways() {}",
        "struct OrbitStation;",
        "const NIGHT: u8 = 0;",
        "let it = self.stride2;",
        "mod made;",
    ] {
        assert_eq!(name_faults(&Source::new("src/store/a.rs", code)).len(), 1, "{code}");
    }
    assert_eq!(name_faults(&Source::new("tests/it/night.rs", "")).len(), 1);
    for code in [
        "// Found on the way, in one piece.",
        "let text = \"a long night\";",
        "let always = homemade(pieced, stationary);",
        "let depending = sealing + seating;",
    ] {
        assert_clean(name_faults(&Source::new("src/store/a.rs", code)));
    }
}
