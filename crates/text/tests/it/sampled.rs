//! States at given times, and their derivatives in parameters, starts and phases, against differences and against what models simulate.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use capsulemap_engine::flow::Reason;
use capsulemap_models::description::{Parameters, State};
use capsulemap_models::motion::{Case, SimulationSize};
use capsulemap_models::of::model_of;
use capsulemap_text::model::model;
use capsulemap_text::sampled::{Direction, Started, sampled};

const TOLERANCE: f64 = 1e-14;

/// A text of the repository.
fn characters(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../systems").join(name);
    fs::read_to_string(path).expect("a text")
}

/// Two masses, of which one meets a wall and the other slides: four coordinates on the section, which is more than the few of small
/// systems.
const TWO_MASSES: &str = r#"
[system]
name = "two masses"
states = { x = "1", v = "1", y = "1", u = "1" }
section = { every = "2*pi/w" }
[system.parameters]
w = 1.3
k = 0.7
r = 0.6
wall = 0.5
s = 0.1
[system.rates]
x = "v"
v = "cos(w*t) - x - 0.1*v - k*(x - y)"
y = "u"
u = "k*(x - y) - y - friction"
[[system.events]]
name = "impact"
while = "x < wall"
reset = { x = "wall", v = "-r*v" }
[system.friction.friction]
of = "u"
sliding = "s"
holds = "1.3*s"
"#;

/// A motion of a text of the repository, with some parameters, from a start.
fn started(name: &str, values: &[(&str, f64)], start: &[f64]) -> Started {
    started_of(&characters(name), values, start)
}

/// The same of any text.
fn started_of(text: &str, values: &[(&str, f64)], start: &[f64]) -> Started {
    let description = model(text).expect("a text without faults");
    let mut parameters = Parameters::of(description);
    for (symbol, value) in values {
        parameters[description.parameter(symbol).expect("a parameter")] = *value;
    }
    Started::new(parameters, State::new(description, start), 0.0)
}

/// How long a cycle of a driven motion lasts.
fn period(motion: &Started) -> f64 {
    motion.parameters.period_of_drive().expect("a drive")
}

/// Times that are even, the last of which is this.
fn even(count: u32, last: f64) -> Vec<f64> {
    (1..=count).map(|i| last * f64::from(i) / f64::from(count)).collect()
}

/// All states by their places.
fn columns(motion: &Started) -> Vec<usize> {
    (0..motion.start.values().len()).collect()
}

/// The states of a motion at these times.
fn values(motion: &Started, times: &[f64]) -> Vec<Vec<f64>> {
    sampled(motion, times, &columns(motion), &[], TOLERANCE).expect("followed").values
}

/// The largest difference of two sets of samples, relative to the largest sample of its column.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let of_column = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let size = a.iter().fold(1e-9, |most: f64, it| most.max(it.abs()));
        a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs() / size))
    };
    a.iter().zip(b).map(of_column).fold(0.0, f64::max)
}

/// The differences of all samples in a direction, extrapolated, and how far those of two lengths are apart.
fn differences(motion: &Started, times: &[f64], direction: Direction) -> (Vec<Vec<f64>>, f64) {
    let at = motion.value(direction);
    let slopes = |reach: f64| -> Vec<Vec<f64>> {
        let ends = [reach, -reach].map(|by| values(&motion.with(direction, at + by), times));
        let slope = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * reach)).collect()
        };
        ends[0].iter().zip(&ends[1]).map(slope).collect()
    };
    let reach = 1e-5 * at.abs().max(1e-2);
    let (wide, near) = (slopes(2.0 * reach), slopes(reach));
    let extrapolate = |(wide, near): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        wide.iter().zip(near).map(|(w, n)| (4.0 * n - w) / 3.0).collect()
    };
    let best: Vec<Vec<f64>> = wide.iter().zip(&near).map(extrapolate).collect();
    let doubt = apart(&best, &near);
    (best, doubt)
}

/// Checks the derivatives of a motion in all its parameters and starts, and in the phase of its drive; returns how many it compared.
///
/// Differences that disagree among themselves tell nothing: an event falls on a sample within their reach.
fn check_derivatives(motion: &Started, times: &[f64]) -> usize {
    let model = motion.parameters.model();
    let mut directions: Vec<Direction> = model.parameters().map(Direction::Parameter).collect();
    directions.extend(columns(motion).into_iter().map(Direction::Start));
    directions.extend(model.roles.drive.map(|_| Direction::Phase));
    let found = sampled(motion, times, &columns(motion), &directions, TOLERANCE);
    let found = found.expect("followed");
    assert!(apart(&found.values, &values(motion, times)) < 1e-11);
    let mut compared = 0;
    for (place, direction) in directions.iter().enumerate() {
        let of = |column: &Vec<Vec<f64>>| column.iter().map(|it| it[place]).collect();
        let exact: Vec<Vec<f64>> = found.slopes.iter().map(of).collect();
        let (expected, doubt) = differences(motion, times, *direction);
        if doubt < 1e-7 {
            let error = apart(&expected, &exact);
            assert!(error < 1e-6, "{direction:?} of {}: {error:e}, doubt {doubt:e}", model.name);
            compared += 1;
        }
    }
    compared
}

#[test]
fn derivatives_pass_through_impacts() {
    let mut motion = started("impact.toml", &[("w", 1.3)], &[0.4, 0.3]);
    motion.phase = 0.8;
    // Seven parameters and starts, and the phase.
    assert!(check_derivatives(&motion, &even(40, 3.07 * period(&motion))) >= 7);
    // Where the start is later, the phase at it depends on the frequency.
    motion.time = 17.3;
    assert!(check_derivatives(&motion, &even(40, 3.07 * period(&motion))) >= 7);
}

#[test]
fn derivatives_pass_through_stick_and_slip() {
    let values = [("w", 0.5), ("d", 0.05), ("s", 0.35)];
    let mut motion = started("friction.toml", &values, &[0.2, 0.9]);
    motion.phase = 2.1;
    assert!(check_derivatives(&motion, &even(40, 2.03 * period(&motion))) >= 5);
    let mut capsule = started("capsule.toml", &[("mu_s", 0.8)], &[1e-3, 0.0, 0.1, 0.02]);
    capsule.phase = 1.0;
    assert!(check_derivatives(&capsule, &even(40, 3.02 * period(&capsule))) >= 14);
}

#[test]
fn derivatives_pass_through_edges_and_contacts_that_last() {
    let mut pulse = started("pulse.toml", &[], &[1e-3, 0.0, 0.05, 0.01]);
    pulse.phase = 3.0;
    assert!(check_derivatives(&pulse, &even(40, 2.04 * period(&pulse))) >= 11);
    let ball = started("ball.toml", &[("r", 0.5)], &[2e-3, 0.0]);
    assert!(check_derivatives(&ball, &even(40, 2.04 * period(&ball))) >= 3);
}

#[test]
fn derivatives_are_those_of_systems_of_many_states() {
    let mut motion = started_of(TWO_MASSES, &[], &[0.1, 0.2, -0.3, 0.4]);
    motion.phase = 0.5;
    assert!(check_derivatives(&motion, &even(40, 2.03 * period(&motion))) >= 9);
    let text = TWO_MASSES.replace("cos(w*t)", "0.5*sin(w)");
    let text = text.replace("{ every = \"2*pi/w\" }", "{ when = \"v falls\", within = 50.0 }");
    let mut free =
        started_of(&text.replace("\"two masses\"", "\"free masses\""), &[], &[0.1, 0.9, -0.3, 0.4]);
    free.phase = 0.5;
    assert!(check_derivatives(&free, &even(40, 11.3)) >= 8);
}

#[test]
fn derivatives_pass_the_section_of_an_autonomous_system() {
    let belt = started("belt.toml", &[], &[0.5, 0.6]);
    assert!(check_derivatives(&belt, &even(60, 25.3)) >= 5);
}

#[test]
fn samples_are_what_the_model_simulates() {
    for (name, start) in [
        ("impact.toml", &[0.4, 0.3][..]),
        ("friction.toml", &[0.2, 0.9]),
        ("capsule.toml", &[1e-3, 2e-3, 0.1, 0.02]),
        ("pulse.toml", &[1e-3, 0.0, 0.05, 0.01]),
        ("ball.toml", &[2e-3, 0.0]),
        ("belt.toml", &[0.5, 0.6]),
    ] {
        let motion = started(name, &[], start);
        let phases = if name == "belt.toml" { [0.0; 2] } else { [1.0, 0.4] };
        let case = Case {
            parameters: motion.parameters.clone(),
            start: motion.start.clone(),
            start_phase: phases[0],
            section_phase: phases[1],
        };
        let most = SimulationSize { cycles: 6, events: 1000 };
        let simulated = model_of(&motion.parameters).simulate(&case, most, TOLERANCE);
        assert!(simulated.failure.is_none(), "{name}: {:?}", simulated.failure);
        let times: Vec<f64> = simulated.section.iter().map(|it| it.time).collect();
        let motion = Started { phase: phases[0], ..motion };
        let by_time =
            |column: usize| simulated.section.iter().map(move |it| it.state.values()[column]);
        let expected: Vec<Vec<f64>> =
            columns(&motion).into_iter().map(|it| by_time(it).collect()).collect();
        let error = apart(&expected, &values(&motion, &times));
        assert!(times.len() == 7 && error < 1e-8, "{name}: {error:e}");
    }
}

#[test]
fn a_motion_goes_on_from_any_of_its_samples() {
    let motion = Started { phase: 0.9, ..started("pulse.toml", &[], &[1e-3, 0.0, 0.05, 0.01]) };
    let times = even(50, 3.0 * period(&motion));
    let all = values(&motion, &times);
    for from in [7, 23, 41] {
        let state: Vec<f64> = all.iter().map(|it| it[from]).collect();
        let start = State::new(motion.start.model(), &state);
        let later = Started { start, time: times[from], ..motion.clone() };
        let since: Vec<f64> = times[from..].iter().map(|it| it - times[from]).collect();
        let rest: Vec<Vec<f64>> = all.iter().map(|it| it[from..].to_vec()).collect();
        assert!(apart(&rest, &values(&later, &since)) < 1e-9, "{from}");
    }
    // The phase is one of a turn.
    let turned = Started { phase: motion.phase - 3.0 * TAU, ..motion.clone() };
    assert!(apart(&all, &values(&turned, &times)) < 1e-9);
}

#[test]
fn a_motion_need_not_come_back_to_its_section() {
    // With much damping it comes to rest where the spring holds the friction; the section is waited for 100 long.
    let motion = started("belt.toml", &[("c", 3.0)], &[0.5, 0.6]);
    let found = values(&motion, &[0.0, 350.0, 400.0]);
    let rests = 0.5 * (1.0 + (-1.5_f64 / 0.5).exp());
    assert_eq!([found[0][0], found[1][0]], [0.5, 0.6]);
    for place in [1, 2] {
        let error = (found[0][place] - rests).abs().max(found[1][place].abs());
        assert!(error < 1e-9, "{error:e}");
    }
}

#[test]
fn a_start_behind_a_bound_is_refused() {
    let motion = started("impact.toml", &[], &[1.5, 0.0]);
    let refused = sampled(&motion, &[0.0, 1.0], &[0], &[], TOLERANCE);
    assert_eq!(refused.map(|it| it.values), Err(Reason::NotFinite));
}
