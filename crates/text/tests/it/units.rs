//! Units of texts that fit each other, and what is told where they do not.

use std::fs;
use std::path::Path;

use capsulemap_text::read;
use capsulemap_text::unit::Unit;

/// What does not fit in a text, as it is shown.
fn misfits(text: &str) -> Vec<String> {
    let text = read(text).unwrap_or_else(|faults| panic!("{faults:?}"));
    text.misfits.iter().map(ToString::to_string).collect()
}

#[test]
fn units_are_products_of_powers_of_others() {
    let same = [
        ("N s/m", "kg/s"),
        ("J", "N m"),
        ("W", "J/s"),
        ("m/s^2", "m s-2"),
        ("m/s²", "m/s2"),
        ("N/(m s)", "N m-1 s-1"),
        ("N/m/s", "N/(m s)"),
        ("kN/mm", "MN/m"),
        ("mN s/mm", "N s/m"),
        ("µm", "um"),
        ("rad/s", "1/s"),
        ("1", ""),
        ("V A", "W"),
        ("pixel/pixel", "1"),
    ];
    for (a, b) in same {
        assert!(Unit::of(a).fits(&Unit::of(b)), "{a} {b}");
    }
    let other = [
        ("N", "kg"),
        ("mm", "m"),
        ("Hz", "rad/s"),
        ("N/m s", "N/(m s)"),
        ("deg", "rad"),
        ("pixel", "m"),
        ("pixel", "1"),
        ("g", "kg"),
    ];
    for (a, b) in other {
        assert!(!Unit::of(a).fits(&Unit::of(b)), "{a} {b}");
    }
    let written = [
        ("N/m", "kg/s2"),
        ("mm", "mm"),
        ("km^2/s", "km2/s"),
        ("1/ms", "1/ms"),
        ("g", "0.001 kg"),
        ("W/m", "kg m/s3"),
        ("1/(m s)", "1/(m s)"),
    ];
    for (unit, is) in written {
        assert_eq!(Unit::of(unit).written(), is);
    }
}

#[test]
fn the_units_of_the_texts_of_the_repository_fit() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../systems");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|it| it == "toml") {
            let text = fs::read_to_string(&path).expect("a text");
            assert_eq!(misfits(&text), [""; 0], "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 13, "{seen}");
}

/// A mass at a spring with a stop, friction and a drive, whose units fit.
const FITS: &str = r#"[system]
name = "a mass"
states = { x = "mm", v = "m/s" }
section = { every = "2*pi/w" }

[system.parameters]
m = { default = 2.0, unit = "kg" }
k = { default = 5.0, unit = "N/m" }
w = { default = 1.0, unit = "rad/s" }
gap = { default = 2.0, unit = "mm" }
mu = { default = 0.1, unit = "1" }
g = { default = 9.81, unit = "m/s2" }
a = 3.0

[system.definitions]
stretch = "0.001*x"
energy = "m*v^2/2 + k*stretch^2/2"
scale = "sqrt(k/m)/w"

[system.rates]
x = "1000*v"
v = "(a*sin(w*t) - k*stretch - f)/m"

[system.friction.f]
of = "v"
sliding = "mu*m*g"

[[system.events]]
name = "impact"
while = "x < gap"
reset = { x = "gap", v = "-0.8*v" }

[system.outputs]
most = { value = "max(energy)", unit = "J" }
work = { value = "integral(a*sin(w*t)*v)", unit = "J" }
share = { value = "most/(k*1e-6*gap^2)", unit = "1" }
"#;

#[test]
fn what_does_not_fit_is_told_with_its_place_and_not_refused() {
    assert_eq!(misfits(FITS), [""; 0]);
    let wrong = [
        ("x = \"1000*v\"", "x = \"v\"", "line 21, column 6: the rate of x is in m/s, not in mm/s"),
        (
            "- k*stretch - f)/m",
            "- k*stretch - f)",
            "line 22, column 6: the rate of v is in kg m/s2, not in m/s2",
        ),
        ("- k*stretch", "- k*stretch^2", "line 22, column 34: kg m2/s2 and kg m/s2 are added"),
        (
            "sin(w*t) - k",
            "sin(w) - k",
            "line 22, column 13: sin is of a number or an angle, not of 1/s",
        ),
        ("m*v^2/2 +", "m*v/2 +", "line 17, column 19: kg m/s and kg m2/s2 are added"),
        ("x < gap", "v < gap", "line 30, column 10: mm and m/s are compared"),
        (
            "x = \"gap\", v",
            "x = \"0.5*w\", v",
            "line 31, column 16: what becomes of x is in 1/s, not in mm",
        ),
        ("\"rad/s\"", "\"rad\"", "line 4, column 22: `every` of the section is in 1, not in s"),
        (
            "\"max(energy)\"",
            "\"max(v)\"",
            "line 34, column 19: the output most is in m/s, not in kg m2/s2",
        ),
        ("*v)\", unit = \"J\"", ")\", unit = \"J\"", ""),
        ("most/(k", "most*(k", "line 36, column 20: the output share is in kg2 m4/s4, not in 1"),
        (
            "\"mu*m*g\"",
            "\"mu*m*g\"\nholds = \"mu*v\"",
            "line 27, column 10: `holds` of f is in m/s, not in kg m/s2",
        ),
    ];
    for (right, other, told) in wrong {
        let text = FITS.replace(right, other);
        assert_ne!(text, FITS, "{right}");
        let misfits = misfits(&text);
        let found = misfits.iter().any(|it| it.starts_with(told));
        assert!(if told.is_empty() { misfits.is_empty() } else { found }, "{other}: {misfits:?}");
    }
    let told = "nothing is known of \"smoot\", which counts as a unit of its own";
    let unknown = misfits(&FITS.replace("unit = \"J\"", "unit = \"smoot J\""));
    assert!(unknown.iter().any(|it| it.contains(told)), "{unknown:?}");
}
