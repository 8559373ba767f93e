//! Coulomb's law with one coefficient of friction: the other is the same, which the study says.

use capsulemap::capsule::{Output, Parameter, settle_case, simulate_case};
use capsulemap::store;
use capsulemap::study::Study;

/// A study of one case, from the lines of its `[parameters]` and what follows them.
fn study(parameters: &str, rest: &str) -> Study {
    let text = format!("[parameters]\nresistance = \"coulomb\"\n{parameters}\n{rest}");
    Study::parse("one.toml", &text).expect("a study")
}

#[test]
fn a_capsule_coasts_as_far_as_the_one_coefficient_says() {
    // Closed form: from the speed v it slides v^2/(2 mu g) and stops after v/(mu g), as nothing else acts on it.
    let (v, mu, g) = (1.3, 0.437, 9.81);
    let sliding = "omega = \"1 rad/s\"\np_d = \"0 N\"\nk1 = \"0 N/m\"\nc = \"0 N s/m\"\nk2 = \"0 N/m\"\n\
                   delta = \"1 m\"\nm1 = \"1e-15 kg\"\nmu_s = 0.437";
    let study = study(sliding, "[start]\ny1 = \"1.3 m/s\"\ny2 = \"1.3 m/s\"");
    let simulation = simulate_case(&study.case(0), 1, 1e-12);
    let end = simulation.section.last().expect("a section");
    assert_eq!(end.y2, 0.0);
    let distance = v * v / (2.0 * mu * g);
    assert!((end.x2 / distance - 1.0).abs() < 1e-9, "{} {distance}", end.x2);
    let stop = simulation.events.iter().find(|it| it.t > 0.0).expect("a stop");
    assert!((stop.t * mu * g / v - 1.0).abs() < 1e-9, "{stop:?}");

    // The file says what was taken.
    let expected = "mu_d is not given: Coulomb's law knows one coefficient, so mu_d = mu_s = 0.437";
    assert_eq!(study.remarks, [expected]);
    assert_eq!(store::frame(&study).attributes["study_remarks"], expected);
    assert_eq!(study.case(0).parameters[Parameter::MuD], mu);
}

#[test]
fn rest_ends_at_the_force_that_the_one_coefficient_says() {
    // Closed form: at rest and out of contact the mass is a linear oscillator, and the force on the capsule has the amplitude
    // p_d sqrt(k1^2 + c^2 w^2)/Z with Z = sqrt((k1 - m1 w^2)^2 + c^2 w^2); it slips from mu_d (m1 + m2) g on.
    let (m1, m2, k1, c, omega, mu, g) = (0.11, 0.53, 1420.0, 3.89, 20.0, 0.2, 9.81);
    let z = f64::hypot(k1 - m1 * omega * omega, c * omega);
    let onset = mu * (m1 + m2) * g * z / f64::hypot(k1, c * omega);
    let share = |p_d: f64| {
        let given = format!(
            "omega = \"20 rad/s\"\np_d = \"{p_d} N\"\nk2 = \"1 kN/m\"\ndelta = \"1 m\"\nmu_d = {mu}"
        );
        let study = study(&given, "");
        assert_eq!(study.base[Parameter::MuS], mu);
        // From the linear motion itself, so that no transient slips.
        let phase = (c * omega).atan2(k1 - m1 * omega * omega);
        let start = format!(
            "[start]\nr = \"{} m\"\ny1 = \"{} m/s\"",
            p_d / z * phase.cos(),
            omega * p_d / z * phase.sin()
        );
        let study = self::study(&given, &start);
        settle_case(&study.case(0), &study.protocol).outputs[Output::StickShare]
    };
    assert_eq!(share(0.9999 * onset), 1.0);
    assert!(share(1.01 * onset) < 1.0);
}

#[test]
fn what_is_given_is_left_as_it_is_and_an_axis_is_not_followed() {
    let open = "omega = \"40 rad/s\"\np_d = \"3 N\"\nk2 = \"2 kN/m\"\ndelta = \"1 mm\"";
    let both = |study: &Study| [Parameter::MuS, Parameter::MuD].map(|it| study.base[it]);
    let given = study(&format!("{open}\nmu_s = 0.5\nmu_d = 0.4"), "");
    assert_eq!((both(&given), given.remarks.len()), ([0.5, 0.4], 0));
    let neither = study(open, "");
    assert_eq!((both(&neither), neither.remarks.len()), ([0.66, 0.33], 0));
    let stribeck = format!("[parameters]\n{open}\nmu_s = 0.9");
    let stribeck = Study::parse("one.toml", &stribeck).expect("a study");
    assert_eq!((both(&stribeck), stribeck.remarks.len()), ([0.9, 0.33], 0));
    // It is written with both, and read back as it is.
    let one = study(&format!("{open}\nmu_s = 0.5"), "");
    let again = Study::parse("again.toml", &one.to_toml()).expect("a study");
    assert_eq!((both(&one), &one.base), ([0.5, 0.5], &again.base));

    for (axis, missing) in [("mu_s", "mu_d"), ("mu_d", "mu_s")] {
        let axis = format!("[[axes]]\nname = \"{axis}\"\nvalues = [0.2, 0.3]");
        let text = format!("[parameters]\nresistance = \"coulomb\"\n{open}\n{axis}");
        let faults = Study::parse("one.toml", &text).expect_err("one is missing").to_string();
        assert!(faults.contains(&format!("parameters.{missing}: missing; expected")), "{faults}");
        let text =
            format!("[parameters]\nresistance = \"coulomb\"\n{open}\n{missing} = 0.1\n{axis}");
        assert!(Study::parse("one.toml", &text).is_ok());
    }
}

#[test]
fn notes_name_the_force_of_the_law() {
    let idle = |law: &str, switching: &str| {
        let text = format!(
            "[parameters]\nomega = \"40 rad/s\"\np_d = \"3 N\"\nk2 = \"2 kN/m\"\ndelta = \"1 mm\"\nmu_s = 0.1\nmu_d = 0.2\n\
             resistance = \"{law}\"\nfriction_switching = \"{switching}\""
        );
        Study::parse("one.toml", &text).expect("a study").remarks_on_values().pop()
    };
    // mu N with N = 0.64 kg times 9.81 m/s^2: 1.25568 N, and twice that.
    let coulomb = idle("coulomb", "filippov").expect("a note");
    assert!(coulomb.contains("below mu_d has") && coulomb.contains("at mu_d (m1 + m2) g = 1.255"));
    let stribeck = idle("coulomb-stribeck", "filippov").expect("a note");
    assert!(stribeck.contains("below 2 mu_d has") && stribeck.contains("g = 2.511"), "{stribeck}");
    assert_eq!(idle("medium", "filippov"), None);
    assert_eq!(idle("coulomb", "as-printed"), None);
}
