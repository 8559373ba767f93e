//! Quantities as people write them.

use capsulemap_models::quantity::{Dimension, parse_quantity};

#[test]
fn reads_what_people_write() {
    for (text, dimension, value) in [
        ("18.96 kN/m", Dimension::Stiffness, 18_960.0),
        ("1.5mm", Dimension::Length, 0.0015),
        ("77.91 rad/s", Dimension::AngularFrequency, 77.91),
        ("-2e-3 m", Dimension::Length, -0.002),
        ("4 N", Dimension::Force, 4.0),
        ("9.81 m/s²", Dimension::Acceleration, 9.81),
        ("3.89 N·s/m", Dimension::Damping, 3.89),
        ("3.89 Ns/m", Dimension::Damping, 3.89),
        ("12 µm", Dimension::Length, 12e-6),
        ("0.66", Dimension::Number, 0.66),
    ] {
        let found = parse_quantity(text, dimension).expect(text);
        assert!((found - value).abs() <= 1e-15 * value.abs(), "{text}: {found}");
    }
    let hertz = parse_quantity("12.4 Hz", Dimension::AngularFrequency).expect("hertz");
    assert!((hertz - 77.91149780902687).abs() < 1e-12);
}

#[test]
fn says_what_is_wrong() {
    let error = |text, dimension| parse_quantity(text, dimension).expect_err(text);
    assert!(error("4 N", Dimension::Length).contains("is a force; expected a length in m, mm"));
    assert!(error("4", Dimension::Force).contains("has no unit"));
    assert!(error("4 furlongs", Dimension::Length).contains("unknown unit \"furlongs\""));
    assert!(error("fast", Dimension::Velocity).contains("does not begin with a number"));
}
