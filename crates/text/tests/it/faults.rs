//! What is said of texts with faults: each with its line and column, whatever the characters.

use capsulemap_text::model::model;
use capsulemap_text::read;
use proptest::prelude::*;

use super::six::characters;

/// The faults of a text, as they are shown.
fn faults(text: &str) -> Vec<String> {
    match read(text) {
        Ok(_) => Vec::new(),
        Err(faults) => faults.iter().map(ToString::to_string).collect(),
    }
}

#[test]
fn every_fault_is_told_with_its_place_and_what_is_allowed() {
    let text = "[system]
name = \"two faults and more\"
states = { x = \"1\", v = \"1\" }
section = { every = \"2*pi/w\" }
drift = \"y\"

[system.parameters]
w = 1.0
t = 2.0
k = \"one\"

[system.rates]
x = \"v + u\"
v = \"-x ^ 0.5 - abs(x) + max(x, 1) + sine(x)\"
z = \"0\"

[system.friction.f]
of = \"v^2\"
sliding = \"1\"

[[system.events]]
name = \"impact\"
while = \"x - 1\"
rest = { v = \"-v\" }
";
    let told = faults(text);
    let expected = [
        "line 5, column 10: there is no state \"y\" (allowed: x, v)",
        "line 9, column 1: \"t\" has a meaning in every text already",
        "line 10, column 5: k must be a finite number",
        "line 13, column 10: nothing is called \"u\" (allowed: f, k, pi, t, v, w, x)",
        "line 14, column 11: a power must be a whole number from -64 to 64; others are exp(exponent*log(base)), roots are sqrt",
        "line 14, column 17: abs of what changes is allowed only of the `of` of a friction; elsewhere it is a switch: write \
         [system.switch.NAME] with `where`",
        "line 14, column 26: max of what changes is a switch: write [system.switch.NAME] with `where`",
        "line 14, column 38: there is no function \"sine\"; did you mean \"sin\"? (allowed: sqrt, exp, log, sin, cos, tanh, abs, max, min)",
        "line 15, column 1: there is no state \"z\" (allowed: x, v)",
        "line 23, column 15: expected < or > between two expressions",
        "line 24, column 1: [[system.events]] has no key \"rest\"; did you mean \"reset\"? (allowed: name, while, reset, lasting)",
    ];
    assert_eq!(told, expected, "{}", told.join("\n"));
}

#[test]
fn what_cannot_be_is_refused_with_the_reason() {
    let belt = characters("belt.toml");
    let of = |from: &str, to: &str| faults(&belt.replace(from, to)).join("; ");
    for (from, to, reason) in [
        (
            "of = \"v - belt\"\nsliding = \"a*(1 + exp(-abs(v - belt)/s))\"",
            "of = \"v*v\"\nsliding = \"a\"",
            "`of` must be a sum of states with constant factors",
        ),
        ("- f\"", "- f*f\"", "the rates must be linear in the friction"),
        ("- f\"", "\"", "the rates of what it is of must have the friction"),
        ("v falls", "v turns", "a section is where a state falls or rises through zero"),
        ("-x - c*v - f", "-x - c*v - f + cos(t)", "the equations depend on time"),
        ("sliding = \"a*(1", "sliding = \"f + a*(1", "may not be of a friction"),
        ("name = ", "drift = \"x\"\nname = ", "x cannot drift: the equations depend on it"),
        ("x = \"v\"\n", "", "the state x needs a rate"),
        ("c = 0.1", "c = d", "line"),
        ("within = 100.0", "within = 0.0", "must be positive"),
    ] {
        let told = of(from, to);
        assert!(told.contains(reason), "{from} to {to}: {told}");
    }
    let pulse = characters("pulse.toml");
    let of = |from: &str, to: &str| faults(&pulse.replace(from, to)).join("; ");
    for (from, to, reason) in [
        ("D = 0.35", "D = 1.0", "the duty of on must be above 0 and below 1"),
        ("period = \"T\"", "period = \"2*T\"", "must be that of the section"),
        ("p_d*on\"", "p_d*on*cos(t)\"", "does not repeat after `every`"),
        ("p_d*on\"", "p_d*on*cos((2*pi/T + w)*t)\"", "nothing is called"),
        ("p_d*on\"", "p_d*on*t\"", "t may stand in sin and cos alone"),
        (
            "[system.rates]",
            "[system.switch.s]\nwhere = \"r > 1e-3*on\"\n[system.rates]",
            "may not depend on switches, pulses and frictions",
        ),
        (
            "[system.friction.f]",
            "[[system.events]]\nname = \"e\"\nwhile = \"r < 1\"\nreset = { x2 = \"0\" }\n[system.friction.f]",
            "what drifts cannot be reset",
        ),
    ] {
        let told = of(from, to);
        assert!(told.contains(reason), "{from} to {to}: {told}");
    }
    let five: String =
        (0..5).map(|i| format!("[system.pulse.p{i}]\nperiod = \"T\"\nduty = 0.5\n")).collect();
    assert!(faults(&format!("{pulse}\n{five}")).join(" ").contains("more than 4 pulses"));
    let twice = "[system.definitions]\na1 = \"b1\"\nb1 = \"a1\"\n";
    assert!(
        faults(&format!("{belt}{twice}")).join(" ").contains("is defined by itself in the end")
    );
}

/// Texts that are too long are refused, and some that are just not are read.
/// Bounds of a parameter hold for its default and for what is given.
#[test]
fn parameters_keep_within_their_bounds() {
    let impact = characters("impact.toml");
    let with = |r: &str| impact.replace("r = 0.7", &format!("r = {{ default = 0.7, {r} }}"));
    let told = |r: &str| faults(&with(r)).join("; ");
    assert_eq!(told("least = 0.0, below = 1.0"), "");
    for (r, fault) in [
        (
            "above = 0.7",
            "line 10, column 1: the default of r, 0.7, must be a finite number above 0.7",
        ),
        ("least = 0.0, most = 0.5", "must be a finite number of at least 0 and of at most 0.5"),
        ("least = 0.0, above = 0.1", "r has `least` and `above`: leave one of them out"),
        ("most = 2.0, below = 1.0", "r has `most` and `below`: leave one of them out"),
        ("least = \"0\"", "least must be a finite number"),
        ("at_least = 0.0", "has no key \"at_least\"; did you mean \"least\"?"),
    ] {
        assert!(told(r).contains(fault), "{r}: {}", told(r));
    }
    let described = model(&with("least = 0.0, below = 1.0")).expect("a model");
    let allowed = described.parameter("r").expect("a parameter").allowed();
    for (value, is_allowed) in [(0.0, true), (0.99, true), (1.0, false), (-0.1, false)] {
        assert_eq!(allowed.admits(value), is_allowed, "{value}");
    }
    // A frequency is above zero whatever its bounds are.
    let frequency = impact.replace("w = 1.5", "w = { default = 1.5, most = 3.0 }");
    let described = model(&frequency).expect("a model");
    let allowed = described.parameter("w").expect("a parameter").allowed();
    assert!(allowed.admits(3.0) && !allowed.admits(0.0) && !allowed.admits(3.1));
    assert_eq!(allowed.to_string(), "a finite number above 0 and of at most 3");
}

#[test]
fn long_texts_are_refused_and_do_not_exhaust_the_stack() {
    let belt = characters("belt.toml");
    let with =
        |definitions: String| faults(&format!("{belt}\n[system.definitions]\n{definitions}"));
    let chain = |count: usize| -> String {
        (1..count).map(|i| format!("d{i} = \"sin(d{})\"\n", i - 1)).collect()
    };
    assert!(with(format!("d0 = \"x\"\n{}", chain(90))).is_empty());
    // In the order of the text each is known where the next asks for it; from its end none is.
    assert!(with(format!("d0 = \"x\"\n{}", chain(1500))).is_empty());
    let backward: String = chain(1500).lines().rev().map(|it| format!("{it}\n")).collect();
    let told = with(format!("{backward}d0 = \"x\"\n")).join(" ");
    assert!(told.contains("definitions use each other in a row"), "{told}");
    let told = with(format!("d0 = \"x\"\n{}", chain(3000))).join(" ");
    assert!(told.contains("more than 2000 values"), "{told}");
    let sum = vec!["x"; 600].join("+");
    assert!(with(format!("d0 = \"{sum}\"\n")).join(" ").contains("numbers, names and signs"));
    let brackets = format!("{}x{}", "(".repeat(300), ")".repeat(300));
    assert!(with(format!("d0 = \"{brackets}\"\n")).join(" ").contains("brackets and signs"));
}

/// What a mutant is made by: a place in the text, and what comes there in place of so many characters.
fn mutation() -> impl Strategy<Value = (usize, usize, String)> {
    let bits = [
        "", "(", ")", "\"", "=", "[", "]", "x", "v", "t", "-", "*", "/", "^", "1e999", ",", "\n",
        "#", "{", "}",
    ];
    let insert = proptest::sample::select(bits.to_vec()).prop_map(str::to_owned);
    (0..2000_usize, 0..4_usize, prop_oneof![insert, ".{0,3}"])
}

/// Mutants of the texts; the long form takes 3000 (PROPTEST_CASES=3000).
#[derive(Debug, Clone)]
struct Mutant(String);

fn mutants() -> impl Strategy<Value = Mutant> {
    let texts = ["belt", "capsule", "impact", "valve", "pulse", "two_stops"];
    let text = proptest::sample::select(texts.to_vec());
    (text, proptest::collection::vec(mutation(), 1..4)).prop_map(|(name, mutations)| {
        let mut text: Vec<char> = characters(&format!("{name}.toml")).chars().collect();
        for (at, count, new) in mutations {
            let at = at % text.len();
            let ends = (at + count).min(text.len());
            text.splice(at..ends, new.chars());
        }
        Mutant(text.into_iter().collect())
    })
}

proptest! {
    #[test]
    fn no_mutant_of_a_text_panics_and_each_message_has_its_line(Mutant(text) in mutants()) {
        let lines = text.matches('\n').count() + 1;
        if let Err(faults) = read(&text) {
            prop_assert!(!faults.is_empty());
            for fault in faults {
                prop_assert!((1..=lines).contains(&fault.line) && fault.column > 0, "{fault}");
            }
        }
    }
}
