//! The models of texts: their descriptions, and the outputs of motions against closed forms.

use std::f64::consts::PI;

use capsulemap_engine::orbit::{Outcome, Proof, Protocol};
use capsulemap_models::description::{Description, Parameters, Section, State};
use capsulemap_models::motion::{Case, Orbit};
use capsulemap_models::of::{model_of, settle_case};
use capsulemap_text::model::model;

use super::six::characters;

/// The model of a text of the repository.
fn described(name: &str) -> &'static Description {
    model(&characters(name)).expect("a text without faults")
}

/// What a case of a model settles to, with some values of its parameters, from some states.
fn settled(
    model: &'static Description,
    values: &[(&str, f64)],
    start: &[(&str, f64)],
) -> (Orbit, Parameters) {
    let mut parameters = Parameters::of(model);
    for (name, value) in values {
        parameters[model.parameter(name).expect("a parameter")] = *value;
    }
    let mut state = State::origin(model);
    for (name, value) in start {
        let coordinate = model.coordinates().find(|it| it.name() == *name).expect("a state");
        state[coordinate] = *value;
    }
    let case = Case::at_section(parameters.clone(), state, 0.0);
    (settle_case(&case, &Protocol::default()), parameters)
}

/// An output of an orbit by its name.
fn output(orbit: &Orbit, name: &str) -> f64 {
    orbit.outputs[orbit.outputs.model().output(name).expect("an output")]
}

#[test]
fn a_text_is_one_model_however_it_is_laid_out() {
    let text = characters("duffing.toml");
    let one = model(&text).expect("a model");
    let other = model(&format!("# A remark.\ntitle = \"a study\"\n\n{text}")).expect("a model");
    assert!(std::ptr::eq(one, other));
    let changed = model(&text.replace("x^3", "x^5")).expect("a model");
    assert!(!std::ptr::eq(one, changed));
    let tables = one.equations.expect("it is a text").tables;
    assert!(std::ptr::eq(one, model(tables).expect("the tables say the same")));
}

#[test]
fn every_text_of_the_repository_is_a_model_without_faults() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../systems");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("the folder of texts") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|it| it == "toml") {
            let text = std::fs::read_to_string(&path).expect("a text");
            let described =
                model(&text).unwrap_or_else(|faults| panic!("{}: {faults:?}", path.display()));
            assert_eq!(model_of(&Parameters::of(described)).faults(), Vec::<String>::new());
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
}

#[test]
fn a_model_has_no_coordinates_beside_those_of_its_text() {
    let belt = described("belt.toml");
    let (orbit, _) = settled(belt, &[], &[("x", 2.0)]);
    assert_eq!(orbit.outcome, Outcome::Periodic);
    assert_eq!((orbit.section[0].len(), orbit.certificate.multipliers.len()), (1, 1));
    assert!(!belt.has_drive() && belt.drive_frequency().is_none());
    let capsule = described("capsule.toml");
    let (orbit, parameters) = settled(capsule, &[], &[]);
    assert_eq!((orbit.section[0].len(), orbit.certificate.multipliers.len()), (3, 3));
    let omega = capsule.drive_frequency().expect("its drive");
    assert_eq!(omega.symbol(), "omega");
    assert_eq!(parameters.period_of_drive(), Some(2.0 * PI / 77.91));
    assert_eq!(capsule.impact_surface().map(|it| it.symbol()), Some("delta"));
    // The speed that docs/model.md has, and what the events of the orbit tell.
    assert!((1e3 * output(&orbit, "speed_of_x2") - 10.298_005).abs() < 1e-6);
    assert_eq!(output(&orbit, "impact_per_cycle"), 1.0);
    let rest = output(&orbit, "rest_share_of_f");
    assert!(rest > 0.0 && rest < 1.0, "{rest}");
}

/// The amplitude of Den Hartog's oscillator that never stops, of a force of size one.
fn den_hartog(w: f64, f: f64) -> f64 {
    let gain = 1.0 / (1.0 - w * w);
    let turned = PI / w;
    let loss = turned.sin() / (w * (1.0 + turned.cos()));
    (gain * gain - (f * loss).powi(2)).sqrt()
}

#[test]
fn the_largest_value_is_that_of_den_hartog() {
    let friction = described("friction.toml");
    for (w, f) in [(1.5, 0.2), (0.7, 0.25), (1.2, 0.4)] {
        let (orbit, _) = settled(friction, &[("w", w), ("f", f), ("s", f)], &[("x", 0.3)]);
        let apart = output(&orbit, "amplitude") - den_hartog(w, f);
        assert!(apart.abs() < 1e-11, "w {w}, f {f}: {apart:e}");
        assert_eq!(output(&orbit, "reversal_per_cycle"), 2.0);
        assert_eq!(output(&orbit, "rest_share_of_friction"), 0.0);
    }
}

#[test]
fn work_and_loss_balance_and_a_linear_oscillator_has_its_closed_form() {
    let text = characters("duffing.toml");
    let duffing = model(&text).expect("a model");
    for start in [[0.0, 0.0], [-1.0, 0.5], [0.7, 0.9]] {
        let (orbit, _) = settled(duffing, &[], &[("x", start[0]), ("v", start[1])]);
        assert_eq!(orbit.certificate.proof, Proof::Newton);
        let [work, loss] = ["work", "loss"].map(|it| output(&orbit, it));
        assert!((work - loss).abs() < 1e-11 * work, "{work} {loss}");
    }
    let more = "least = \"min(v)\"\nsquares = \"mean(x^2)\"\nrest = \"peak - sqrt(2*squares)\"\n";
    let linear = text.replace("- x^3", "- x") + more;
    let linear = model(&linear).expect("a model");
    let (w, c, p): (f64, f64, f64) = (1.7, 0.08, 0.2);
    let (orbit, _) = settled(linear, &[("w", w)], &[]);
    let amplitude = p / ((1.0 - w * w).powi(2) + (c * w).powi(2)).sqrt();
    let peak = output(&orbit, "peak");
    assert!((peak - amplitude).abs() < 1e-11 * amplitude, "{peak} {amplitude}");
    assert!((output(&orbit, "least") + w * amplitude).abs() < 1e-11);
    let loss = output(&orbit, "loss");
    assert!((loss - PI * c * w * amplitude * amplitude).abs() < 1e-11 * loss);
    assert!(output(&orbit, "rest").abs() < 1e-11);
}

#[test]
fn a_ball_bounces_once_a_period_as_its_closed_form_has_it() {
    let ball = described("ball.toml");
    let (a, omega, r, g) = (1.0e-3, 88.0, 0.8, 9.81);
    let period = 2.0 * PI / omega;
    // It leaves the table with half of what gravity takes in a period, at a phase at which impacts restore that.
    let leaves = 0.5 * g * period;
    let table = leaves * (1.0 - r) / (1.0 + r);
    let phases = [PI + (table / (a * omega)).asin(), 2.0 * PI - (table / (a * omega)).asin()];
    let sections = phases.map(|phase| {
        let flown = period - phase / omega;
        let height = a * phase.cos() + leaves * flown - 0.5 * g * flown * flown - a;
        [height, leaves - g * flown]
    });
    let mut met = 0;
    for [h, v] in sections {
        let (orbit, _) = settled(ball, &[("omega", omega)], &[("h", h + 1e-5), ("v", v)]);
        if orbit.outcome == Outcome::Periodic && orbit.period == 1 {
            let found = sections.iter().find(|it| near(&orbit.section[0], it));
            assert!(found.is_some(), "{:?} {sections:?}", orbit.section[0]);
            assert_eq!(output(&orbit, "bounce_per_cycle"), 1.0);
            met += 1;
        }
    }
    assert!(met > 0);
}

fn near(section: &Section, closed_form: &[f64; 2]) -> bool {
    (section[0] - closed_form[0]).abs() < 1e-12 && (section[1] - closed_form[1]).abs() < 1e-10
}

#[test]
fn faults_of_outputs_are_told_in_their_place() {
    let text = characters("duffing.toml");
    let at = text.lines().count() + 1;
    for (line, message) in [
        ("wrong = \"x\"", "wrong changes along the motion"),
        ("wrong = \"integral(max(x))\"", "max takes 2 arguments, not 1"),
        ("wrong = \"later + 1\"\nlater = 2", "later is an output"),
        ("wrong = \"count(bounce)\"", "no event is called"),
        ("wrong = \"integrate(x)\"", "there is no function \"integrate\""),
        ("wrong = { unit = \"J\" }", "wrong needs `value`"),
    ] {
        let faults = model(&format!("{text}{line}\n")).expect_err(line);
        assert!(faults[0].message.contains(message), "{line}: {faults:?}");
        assert_eq!(faults[0].line, at, "{line}: {faults:?}");
    }
    let faults = model(&text.replace("c*v - x^3", "c*v - x^3 + peak")).expect_err("an output");
    assert!(faults[0].message.contains("peak is an output"), "{faults:?}");
}

/// Two masses in a row between springs, each with a little damping, the first driven.
const ROW: &str = r#"
[system]
name = "two masses in a row"
states = { x1 = "1", v1 = "1", x2 = "1", v2 = "1" }
section = { every = "2*pi/w" }
[system.parameters]
w = 1.3
c = 0.1
wall = 5.0
[system.rates]
x1 = "v1"
v1 = "cos(w*t) - 2*x1 + x2 - c*v1"
x2 = "v2"
v2 = "x1 - 2*x2 - c*v2"
[[system.events]]
name = "impact"
while = "x2 < wall"
reset = { x2 = "wall", v2 = "-0.8*v2" }
[system.outputs]
together = "max(x1 + x2)"
apart = "max(x1 - x2)"
"#;

#[test]
fn a_section_of_four_coordinates_has_the_closed_form_of_its_modes() {
    let row = model(ROW).expect("a model");
    let (orbit, _) = settled(row, &[], &[("x1", 0.1)]);
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert_eq!((orbit.section[0].len(), orbit.certificate.multipliers.len()), (4, 4));
    // The sum and the difference of the displacements are oscillators of the stiffness 1 and 3.
    for (name, stiffness) in [("together", 1.0), ("apart", 3.0)] {
        let (w, c): (f64, f64) = (1.3, 0.1);
        let amplitude = 1.0 / (stiffness - w * w).hypot(c * w);
        assert!((output(&orbit, name) - amplitude).abs() < 1e-10, "{name} {amplitude}");
    }
    let decay = (-0.05 * 2.0 * PI / 1.3_f64).exp();
    assert!(orbit.certificate.multipliers.iter().all(|it| (it.abs() - decay).abs() < 1e-10));
    let (orbit, _) = settled(row, &[("wall", 0.5)], &[("x1", 0.1)]);
    assert!(output(&orbit, "impact_per_cycle") > 0.0);
}

/// Masses in a row between springs of stiffness 1, the ends held, each with a little damping, the first driven.
fn row_of(masses: usize) -> String {
    let all: Vec<usize> = (1..=masses).collect();
    let joined = |of: &dyn Fn(usize) -> String, between: &str| {
        all.iter().map(|it| of(*it)).collect::<Vec<_>>().join(between)
    };
    let states = joined(&|i| format!("x{i} = \"1\", v{i} = \"1\""), ", ");
    let beside = |i: usize| match i {
        i if (1..=masses).contains(&i) => format!(" + x{i}"),
        _ => String::new(),
    };
    let rates = joined(
        &|i| {
            let drive = if i == 1 { "cos(w*t)" } else { "0" };
            let neighbours = [beside(i - 1), beside(i + 1)].concat();
            format!("x{i} = \"v{i}\"\nv{i} = \"{drive} - 2*x{i} - c*v{i}{neighbours}\"")
        },
        "\n",
    );
    let mode = |j: usize| {
        let share = |i: usize| (PI * (i * j) as f64 / (masses + 1) as f64).sin();
        let sum = joined(&|i| format!("({:e})*x{i}", share(i)), " + ");
        format!("mode_{j} = \"max({sum})\"")
    };
    let outputs = joined(&mode, "\n");
    format!(
        "[system]\nname = \"masses in a row\"\nstates = {{ {states} }}\nsection = {{ every = \"2*pi/w\" }}\n\
         [system.parameters]\nw = 1.3\nc = 0.1\n[system.rates]\n{rates}\n[system.outputs]\n{outputs}\n"
    )
}

#[test]
fn a_section_of_eight_coordinates_has_the_closed_form_of_its_modes() {
    let (w, c): (f64, f64) = (1.3, 0.1);
    for masses in [3, 4] {
        let row = model(&row_of(masses)).expect("a model");
        let (orbit, _) = settled(row, &[], &[("x1", 0.1)]);
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        let multipliers = &orbit.certificate.multipliers;
        assert_eq!((orbit.section[0].len(), multipliers.len()), (2 * masses, 2 * masses));
        for j in 1..=masses {
            let angle = PI * j as f64 / (masses + 1) as f64;
            let stiffness = 2.0 - 2.0 * angle.cos();
            let amplitude = angle.sin() / (stiffness - w * w).hypot(c * w);
            let told = output(&orbit, &format!("mode_{j}"));
            assert!((told - amplitude).abs() < 1e-9 * amplitude, "{told} {amplitude}");
        }
        let decay = (-c * PI / w).exp();
        assert!(multipliers.iter().all(|it| (it.abs() - decay).abs() < 1e-10), "{multipliers:?}");
    }
    let faults = model(&row_of(5)).expect_err("ten states");
    assert!(faults.iter().any(|it| it.message.contains("more than 8 states")), "{faults:?}");
}

/// What is measured does not touch the motion: the same bits with outputs and without.
#[test]
fn outputs_do_not_change_the_motion() {
    let text = characters("duffing.toml");
    let without = text.split("[system.outputs]").next().expect("what stands before them");
    let [with, without] = [text.as_str(), without].map(|it| model(it).expect("a model"));
    let [(with, _), (without, _)] =
        [with, without].map(|it| settled(it, &[("p", 0.23)], &[("x", 0.4)]));
    assert_eq!(with.section, without.section);
    assert_eq!(with.certificate.multipliers, without.certificate.multipliers);
}
