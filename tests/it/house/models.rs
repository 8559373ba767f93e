//! Above the models nothing is compiled against a system: models are asked through one door without type parameters.

use super::{Source, assert_clean, identifiers, sources};

/// Types and functions by which code is generic over the readings of the capsule, or tells them apart.
const BELOW: [&str; 6] =
    ["Filippov", "AsPrinted", "CapsuleSystem", "settle_as", "Batch", "Underway"];
/// The same as bounds and choices.
const CODE: [&str; 2] = ["R: Reading", "switching() {"];

/// The capsule's own parameters and outputs, each behind this.
const OWN: [&str; 2] = ["Parameter::", "Output::"];
/// Files that know the rig of the capsule, or have options that are called after its parameters.
const OF_THE_RIG: [&str; 9] = [
    "src/experiment/",
    "src/cli/asked_case.rs",
    "src/cli/compare_report.rs",
    "src/cli/experiment_figures.rs",
    "src/cli/fit.rs",
    "src/cli/fit_report.rs",
    "src/cli/identify.rs",
    "src/cli/simulate.rs",
    "src/cli/synthesize.rs",
];

/// Files beside these that take something of the capsule's floor, and what.
const OF_THE_FLOOR: [(&str, &str); 2] = [
    ("src/campaign/mean_errors.rs", "the standard error of a mean"),
    ("src/tradeoff/mod.rs", "what the library has under this path"),
];

/// Whether a file takes anything of the capsule outside its tests, where it may not.
fn takes_of_the_capsule(source: &Source) -> bool {
    let mut may = OF_THE_RIG.into_iter().chain(OF_THE_FLOOR.map(|(path, _)| path));
    let code = source.code.split("#[cfg(test)]").next().unwrap_or_default();
    code.contains("crate::capsule") && !may.any(|path| source.path.starts_with(path))
}

/// What a file names that only models may.
fn model_faults(source: &Source) -> Vec<String> {
    let named = identifiers(&source.code).map(|(_, word, _)| word);
    let named = named.filter(|word| BELOW.contains(word));
    let found = named.chain(CODE.into_iter().filter(|code| source.code.contains(code)));
    let taken = takes_of_the_capsule(source).then(|| "crate::capsule".to_owned());
    let found = found.map(str::to_owned).chain(own_quantities(source)).chain(taken);
    found.map(|what| format!("{}: {what}; ask the model", source.path)).collect()
}

/// The capsule's own parameters and outputs that a file names outside its tests, where it may not.
fn own_quantities(source: &Source) -> Vec<String> {
    let knows_the_rig = OF_THE_RIG.iter().any(|path| source.path.starts_with(path));
    let code = source.code.split("#[cfg(test)]").next().unwrap_or_default();
    let is_own = |at: usize, of: &str| {
        let is_variant = code[at + of.len()..].starts_with(|c: char| c.is_ascii_uppercase());
        let is_part = code[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        is_variant && !is_part
    };
    let places = OWN.iter().flat_map(|of| code.match_indices(of));
    let places = places.filter(|(at, of)| !knows_the_rig && is_own(*at, of));
    let word = |at: usize, of: &str| -> String {
        let rest = code[at + of.len()..].chars().take_while(|c| c.is_ascii_alphanumeric());
        of.chars().chain(rest).collect()
    };
    places.map(|(at, of)| word(at, of)).collect()
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
        "use super::Filippov;",
        "use crate::capsule::State;",
        "fn run<R: Reading>() {}",
        "match study.base.switching() {",
        "let case = case.read::<AsPrinted>();",
        "Batch::all(instructions, computations, done)",
        "let k2 = base[Parameter::K2];",
        "outputs[capsule::Output::Power]",
        "for parameter in Parameter::ALL {",
    ] {
        assert_eq!(model_faults(&Source::new("src/run/a.rs", code)).len(), 1, "{code}");
    }
    for code in [
        "// Filippov",
        "let text = \"AsPrinted\";",
        "parameters.switching().name()",
        "Coordinate::Parameter(parameter)",
        "Parameter::of(model, 0)",
        "f(); #[cfg(test)] mod tests { use Parameter::K2; }",
    ] {
        assert_clean(model_faults(&Source::new("src/run/a.rs", code)));
    }
}
