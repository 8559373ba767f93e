//! Contacts that last: a ball that comes to rest on a table, and leaves it where the table falls away.

use std::f64::consts::PI;

use capsulemap_engine::flow::Reason;
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Case, Machine, Outcome, Proof, Protocol, settle, settle_all};
use capsulemap_models::description::{Parameters, State};
use capsulemap_models::motion::{self, SimulationSize};
use capsulemap_models::of::model_of;
use capsulemap_text::model::model;

use super::six::{D3, characters, program};

const G: f64 = 9.81;

/// The ball with an amplitude [m] and a frequency [rad/s] of its table and a restitution.
fn ball(a: f64, omega: f64, r: f64) -> D3 {
    let system = D3::new(program(&characters("ball.toml")));
    system.with_named("a", a).with_named("omega", omega).with_named("r", r)
}

/// A case of the ball from a height [m], at rest.
fn from_height(system: &D3, h: f64) -> Case<D3, 3> {
    Case::new(system.clone(), [h, 0.0, 0.0, 0.0, 0.0])
}

#[test]
fn bounces_on_a_still_table_are_over_when_their_sum_says() {
    let ball = model(&characters("ball.toml")).expect("a text without faults");
    let mut parameters = Parameters::of(ball);
    let mut set = |name: &str, value: f64| {
        parameters[ball.parameter(name).expect("a parameter")] = value;
    };
    let (omega, r, height) = (20.0, 0.6, 0.5);
    set("a", 0.0);
    set("omega", omega);
    set("r", r);
    let mut start = State::origin(ball);
    start[ball.coordinates().next().expect("the height")] = height;
    let case = motion::Case::at_section(parameters.clone(), start, 0.0);
    let most = SimulationSize { cycles: 60, events: 1000 };
    let told = model_of(&parameters).simulate(&case, most, 1e-13);
    assert!(told.failure.is_none(), "{:?}", told.failure);
    let last = told.events.last().expect("impacts").time;
    let exact = (2.0 * height / G).sqrt() * (1.0 + r) / (1.0 - r);
    assert!((last - exact).abs() < 2e-9 * 2.0 * PI / omega, "{last} {exact}");
    assert!(told.events.len() > 30, "{}", told.events.len());
    let end = told.section.last().expect("a section");
    assert_eq!(end.state.values(), [0.0, 0.0]);
}

/// The phase between two at which a function changes its sign.
fn root(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let sign = of(low) > 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (of(middle) > 0.0) == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn a_ball_that_does_not_bounce_leaves_and_lands_where_its_closed_form_has_it() {
    let (a, gamma) = (2e-3, 2.0);
    let omega = (gamma * G / a).sqrt();
    // It leaves where the table falls with the acceleration of gravity, and flies freely.
    let leaves = 2.0 * PI - (1.0 / gamma).acos();
    let speed =
        |phase: f64| a * omega * (phase.sin() - leaves.sin()) - G * (phase - leaves) / omega;
    let height = |phase: f64| {
        let flown = phase - leaves;
        a * (leaves.cos() - phase.cos())
            - a * leaves.sin() * flown
            - 0.5 * G * (flown / omega).powi(2)
    };
    let turns = root(leaves + 0.5, leaves + 4.0, speed);
    let lands = root(turns, leaves + 2.0 * PI, height);
    assert!(lands < leaves + 2.0 * PI && (lands - 2.0 * PI).cos() < 1.0 / gamma);
    let at_section = [height(2.0 * PI), speed(2.0 * PI)];
    let described = model(&characters("ball.toml")).expect("a text");
    for start in [0.0, 1e-3, 5e-3] {
        let mut parameters = Parameters::of(described);
        for (name, value) in [("a", a), ("omega", omega), ("r", 0.0)] {
            parameters[described.parameter(name).expect("a parameter")] = value;
        }
        let mut state = State::origin(described);
        state[described.coordinates().next().expect("the height")] = start;
        let case = motion::Case::at_section(parameters.clone(), state, 0.0);
        let orbit = model_of(&parameters).settle(&case, &Protocol::default(), None);
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        let output = |name: &str| orbit.outputs[described.output(name).expect("an output")];
        assert!((output("height") - height(turns)).abs() < 1e-13, "{}", output("height"));
        assert_eq!((output("bounce_per_cycle"), output("bounce_ends_per_cycle")), (1.0, 1.0));
        let [h, v] = [orbit.section[0][0], orbit.section[0][1]];
        assert!((h - at_section[0]).abs() < 1e-14 && (v - at_section[1]).abs() < 1e-12);
        // What rests forgets all: the multipliers vanish.
        assert_eq!(orbit.certificate.proof, Proof::Newton);
        assert!(orbit.certificate.multipliers.iter().all(|it| it.abs() == 0.0));
    }
}

#[test]
fn a_ball_rests_on_a_table_that_never_falls_as_fast_as_it() {
    // Nor so fast that bounces could be kept up, a omega^2/g < pi (1 - r)/(1 + r).
    let a = 1e-3;
    for (r, omega) in [(0.0, 90.0), (0.3, 90.0), (0.8, 55.0)] {
        let gamma = a * omega * omega / G;
        assert!(gamma < 1.0 && gamma < PI * (1.0 - r) / (1.0 + r));
        let orbit = settle(&from_height(&ball(a, omega, r), 0.01), &Protocol::default());
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1), "{r}");
        assert_eq!(orbit.section[0], [0.0; 3]);
    }
}

/// Where no contact lasts, bounces that accumulate are the end of what can be computed, alone and in lanes.
#[test]
fn bounces_that_accumulate_without_a_contact_that_lasts_are_chatter() {
    let text = characters("ball.toml").replace("lasting = true", "lasting = false");
    let system = D3::new(program(&text)).with_named("a", 0.0).with_named("r", 0.6);
    let cases: Vec<_> = (1..=24).map(|it| from_height(&system, 0.01 * f64::from(it))).collect();
    let (alone, together) = (
        cases.iter().map(|it| settle(it, &Protocol::default())).collect::<Vec<_>>(),
        settle_all(&cases, &Protocol::default(), Machine::default()),
    );
    for orbit in alone.iter().chain(&together) {
        assert_eq!(orbit.outcome, Outcome::Failed);
        let why = orbit.failure.as_ref().map(|it| it.reason);
        assert_eq!(why, Some(Reason::Chatter));
    }
}

#[test]
fn contacts_that_last_have_the_same_bits_in_all_lanes() {
    let cases: Vec<_> = (0..40)
        .map(|it| {
            let share = f64::from(it) / 40.0;
            from_height(&ball(1e-3, 80.0 + 90.0 * share, 0.1 + 0.5 * share), 2e-3 * share)
        })
        .collect();
    let protocol = Protocol { exponent_cycles: 0, max_cycles: 200, ..Protocol::default() };
    let sections = |instructions: Instructions| {
        let machine = Machine { instructions: Some(instructions), ..Machine::default() };
        let orbits = settle_all(&cases, &protocol, machine);
        orbits.into_iter().map(|it| (it.outcome, it.section, it.end)).collect::<Vec<_>>()
    };
    let scalar = sections(Instructions::Scalar);
    assert!(scalar.iter().all(|it| it.0 != Outcome::Failed));
    for instructions in Instructions::available() {
        assert_eq!(sections(instructions), scalar, "{}", instructions.name());
    }
}

#[test]
fn what_cannot_last_is_told() {
    let ball = characters("ball.toml");
    for (from, to, message) in [
        ("while = \"h > 0\"", "while = \"h + v > 0\"", "must be of one state"),
        ("h = \"v\"", "h = \"2*v\"", "the rate of the state in its condition must be a state"),
        ("v = \"-r*v\" }", "h = \"0\" }", "its reset must say"),
        ("lasting = true", "lasting = 1", "lasting must be true or false"),
    ] {
        let changed = ball.replacen(from, to, 1).replace("h = \"0\", h = \"0\"", "h = \"0\"");
        let faults = model(&changed).expect_err(message);
        assert!(faults.iter().any(|it| it.message.contains(message)), "{message}: {faults:?}");
    }
}
