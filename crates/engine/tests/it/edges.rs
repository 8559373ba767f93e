//! Starts on a guard, tangencies, simultaneous events and degenerate parameters.

use capsulemap_engine::flow::Switched;

use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters as _, CapsuleState as _, Contact, Event, EventKind, Locomotion,
    Output, Parameter, Parameters, State, StickSlip,
};

use super::forms::{settle, simulate};

fn kinds(p: &Parameters, start: State<f64>, cycles: u64) -> Vec<EventKind> {
    let simulation = simulate(p, 0.0, start, cycles, 1e-12);
    assert!(simulation.failure.is_none(), "{:?}", simulation.failure);
    simulation.events.iter().map(|event| event.kind).collect()
}

/// The mode a motion starts in, guards that are due at once obeyed.
fn modes(p: &Parameters, start: State<f64>) -> (Contact, StickSlip) {
    let system = Capsule::single(p, 0.0);
    let motion = capsulemap_engine::flow::Motion::new(&system, 0.0, start);
    (system.contact(&motion.mode, 0), system.stick_slip(&motion.mode, 0))
}

#[test]
fn a_start_on_the_stop_goes_where_it_is_heading() {
    let p = Parameters::with(&[(Parameter::Delta, 1e-3)]);
    let at_stop = |y1: f64| State { r: 1e-3, y1, ..State::default() };
    assert_eq!(modes(&p, at_stop(0.1)).0, Contact::Closed);
    assert_eq!(modes(&p, at_stop(-0.1)).0, Contact::Open);
    // At rest on the stop the force decides: the drive outweighs the spring, or it does not.
    assert_eq!(modes(&p, at_stop(0.0)).0, Contact::Closed);
    let weak = Parameters::with(&[(Parameter::Delta, 1e-3), (Parameter::Pd, 1.0)]);
    assert_eq!(modes(&weak, at_stop(0.0)).0, Contact::Open);
    // The mode at the start is no event: of the one that leads away from the stop, none is reported at t = 0.
    for y1 in [-0.1, 0.0, 0.1] {
        let simulation = simulate(&p, 0.0, at_stop(y1), 2, 1e-12);
        assert!(simulation.events.iter().all(|event| event.t > 1e-6), "{y1}");
    }
}

#[test]
fn a_start_at_the_break_away_force_slips_or_stays() {
    let p = Parameters::default();
    let break_away = p[Parameter::MuS] * p.normal_load();
    // The spring alone holds the capsule at the limit; velocity of the mass raises or lowers F from there.
    let at_limit = |y1: f64| State {
        r: (break_away - p[Parameter::C] * y1) / p[Parameter::K1],
        y1,
        ..State::default()
    };
    let system = Capsule::single(&p, 0.0);
    for (y1, slides) in [(0.2, true), (-0.2, false)] {
        let start = at_limit(y1);
        let simulation = simulate(&p, 0.0, start, 1, 1e-12);
        let soon = simulation.events.iter().any(|event| event.t < 1e-9);
        let mode = system.stick_slip(&system.start(0.0, &mut start.clone()), 0);
        assert_eq!(modes(&p, start).1 != StickSlip::Stick || soon, slides, "{y1} {mode:?}");
    }
}

#[test]
fn a_start_at_speed_zero_beyond_the_limit_slides_at_once() {
    let p = Parameters::with(&[(Parameter::K2, 0.0)]);
    let stretched = |r: f64| State { r, ..State::default() };
    assert_eq!(modes(&p, stretched(4e-3)).1, StickSlip::Forward);
    assert_eq!(modes(&p, stretched(-4e-3)).1, StickSlip::Backward);
    assert_eq!(modes(&p, stretched(2e-3)).1, StickSlip::Stick);
}

#[test]
fn a_tangency_is_no_contact() {
    // Nothing but the drive acts on a mass of 1 kg: y1 = 1 - 2 sin t, r = t - 2 (1 - cos t), which is highest
    // where sin t = 1/2, at pi/6, for the first time.
    let contacts = |delta: f64| {
        let p = Parameters::with(&[
            (Parameter::K1, 0.0),
            (Parameter::C, 0.0),
            (Parameter::M1, 1.0),
            (Parameter::Pd, 2.0),
            (Parameter::Omega, 1.0),
            (Parameter::Delta, delta),
        ]);
        let start = State { y1: 1.0, ..State::default() };
        let simulation = simulate(&p, std::f64::consts::PI, start, 1, 1e-12);
        let closed = |event: &&Event| event.kind == EventKind::ContactClosed && event.t < 1.0;
        simulation.events.iter().filter(closed).count()
    };
    let highest = std::f64::consts::FRAC_PI_6 - 2.0 + 3.0_f64.sqrt();
    assert_eq!(contacts(highest + 1e-12), 0);
    assert_eq!(contacts(highest + 1e-15), 0);
    assert!(contacts(highest) <= 1, "to rounding it may be either");
    assert_eq!(contacts(highest - 1e-12), 1);
}

#[test]
fn simultaneous_events_are_both_obeyed() {
    // The capsule glides to rest while a weightless stop is met: y2 and the gap reach zero together.
    // Mass and capsule coast apart from each other: r = (v_r) t, y2 = v0 - a t.
    let (mu_d, v0) = (0.3, 0.5);
    let base = [
        (Parameter::K1, 0.0),
        (Parameter::C, 0.0),
        (Parameter::K2, 1e3),
        (Parameter::Pd, 0.0),
        (Parameter::Omega, 1.0),
        (Parameter::MuS, mu_d),
        (Parameter::MuD, mu_d),
    ];
    let mut p = Parameters::with(&base);
    p.resist_by(capsulemap_models::capsule::Resistance::Coulomb);
    let deceleration = mu_d * p.normal_load() / p[Parameter::M2];
    let stop = v0 / deceleration;
    // The mass keeps its speed v; r = v t - (v0 t - a t^2/2) is v stop - v0 stop / 2 at the stop.
    let v = 0.4;
    p[Parameter::Delta] = v * stop - v0 * stop / 2.0;
    let start = State { y1: v, y2: v0, ..State::default() };
    let simulation = simulate(&p, 0.0, start, 1, 1e-12);
    let first: Vec<_> = simulation.events.iter().take(2).collect();
    assert!(first.iter().all(|event| (event.t - stop).abs() < 1e-12), "{first:?}");
    let mut kinds: Vec<EventKind> = first.iter().map(|event| event.kind).collect();
    kinds.sort();
    assert_eq!(kinds, [EventKind::ContactClosed, EventKind::Stick]);
}

#[test]
fn without_a_gap_contact_starts_and_ends_at_zero() {
    let p = Parameters::with(&[(Parameter::Delta, 0.0)]);
    assert_eq!(modes(&p, State::default()).0, Contact::Closed, "the drive pushes forward");
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic);
    assert!(orbit.outputs[Output::ImpactsPerCycle] >= 1.0);
    // Contact at the start is no impact: closing and opening alternate, opening first.
    let kinds = kinds(&p, State::default(), 5);
    let contact: Vec<_> = kinds
        .into_iter()
        .filter(|k| matches!(k, EventKind::ContactClosed | EventKind::ContactOpened))
        .collect();
    assert_eq!(contact[0], EventKind::ContactOpened);
    assert!(contact.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn a_stop_without_stiffness_is_as_none() {
    let hollow = Parameters::with(&[(Parameter::K2, 0.0), (Parameter::Pd, 6.0)]);
    let absent = Parameters::with(&[(Parameter::Delta, 10.0), (Parameter::Pd, 6.0)]);
    let [hollow, absent] =
        [hollow, absent].map(|p| settle(&p, 0.0, State::default(), &Protocol::default()));
    assert!(hollow.outputs[Output::ImpactsPerCycle] > 0.0, "it passes the plate all the same");
    assert_eq!(hollow.outputs[Output::PeakContactForce], 0.0);
    let speed = hollow.outputs[Output::ProgressionSpeed];
    assert!(speed.abs() < 1e-12, "a stop without force moves nothing: {speed:e}");
    let work = |orbit: &capsulemap_models::capsule::Orbit| orbit.outputs[Output::WorkNet];
    assert!((work(&hollow) / work(&absent) - 1.0).abs() < 1e-9);
}

#[test]
fn without_a_drive_everything_comes_to_rest() {
    let p = Parameters::with(&[(Parameter::Pd, 0.0)]);
    let still = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!((still.outcome, still.period), (Outcome::Periodic, 1));
    for output in [Output::ProgressionSpeed, Output::WorkNet, Output::EnergyResidual] {
        assert_eq!(still.outputs[output], 0.0, "{}", output.name());
    }
    assert!(kinds(&p, State::default(), 20).is_empty());
    let start = State::of([3e-3, -0.2, 0.0, 0.1]);
    let rung = settle(&p, 0.0, start, &Protocol::default());
    assert_eq!((rung.outcome, rung.period), (Outcome::Periodic, 1));
    assert_eq!(rung.end.capsule().y2, 0.0);
    assert!(
        rung.end.capsule().r.abs() < 1e-9 && rung.end.capsule().y1.abs() < 1e-7,
        "{:?}",
        rung.end
    );
}

#[test]
fn everything_at_zero_on_the_stop_stays_there() {
    let p = Parameters::with(&[(Parameter::Pd, 0.0), (Parameter::Delta, 0.0)]);
    assert!(kinds(&p, State::default(), 20).is_empty());
}

#[test]
fn a_start_in_contact_is_pushed_apart() {
    let p =
        Parameters::with(&[(Parameter::Delta, -1e-3), (Parameter::Pd, 0.0), (Parameter::MuS, 5.0)]);
    assert_eq!(modes(&p, State::default()).0, Contact::Closed);
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic);
    // The springs balance: k1 r + k2 (r - delta) = 0.
    let (k1, k2) = (p[Parameter::K1], p[Parameter::K2]);
    assert!((orbit.end.capsule().r - k2 * -1e-3 / (k1 + k2)).abs() < 1e-12);
}

#[test]
fn a_capsule_that_never_moves_is_periodic_at_speed_zero() {
    let p = Parameters::with(&[(Parameter::Pd, 0.5)]);
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert_eq!(orbit.outputs[Output::ProgressionPerCycle], 0.0);
    assert_eq!(orbit.outputs[Output::StickShare], 1.0);
    assert_eq!(orbit.end.capsule().x2, 0.0);
}
