//! Above the models nothing is compiled against a system: models are asked through one door without type parameters.

use super::{Source, assert_clean, identifiers, sources};

/// Types and functions by which code is generic over the readings of the capsule, or tells them apart.
const BELOW: [&str; 6] =
    ["Filippov", "AsPrinted", "CapsuleSystem", "settle_as", "Batch", "Underway"];
/// The same as bounds and choices.
const CODE: [&str; 2] = ["R: Reading", "switching {"];

/// What a file names that only models may.
fn model_faults(source: &Source) -> Vec<String> {
    let named = identifiers(&source.code).map(|(_, word, _)| word);
    let named = named.filter(|word| BELOW.contains(word));
    let found = named.chain(CODE.into_iter().filter(|code| source.code.contains(code)));
    found.map(|what| format!("{}: {what}; ask the model", source.path)).collect()
}

#[test]
fn nothing_above_the_models_tells_them_apart() {
    let program = sources(&["src"]);
    assert!(program.len() > 200, "the source was not found");
    assert_clean(program.iter().flat_map(model_faults).collect());
}

#[test]
fn a_model_that_is_told_apart_is_seen() {
    for code in [
        "use crate::capsule::Filippov;",
        "fn run<R: Reading>() {}",
        "match study.base.switching {",
        "let case = case.read::<AsPrinted>();",
        "Batch::all(instructions, computations, done)",
    ] {
        assert_eq!(model_faults(&Source::new("src/run/a.rs", code)).len(), 1, "{code}");
    }
    for code in ["// Filippov", "let text = \"AsPrinted\";", "parameters.switching.name()"] {
        assert_clean(model_faults(&Source::new("src/run/a.rs", code)));
    }
}
