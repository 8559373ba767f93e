//! Right values of the family of capsules: closed forms, symmetries, and the limits of its members.

use std::f64::consts::PI;

use capsulemap_engine::flow::Reason;
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, DriveKind, EventKind, Form, Orbit, Output, Parameter, Parameters,
    Reaction, Resistance, State, settle, simulate,
};

use super::draws::{self, Random};

/// What a capsule settles to from rest.
fn settled(p: &Parameters) -> Orbit {
    settle(p, 0.0, State::default(), &Protocol::default())
}

/// The speed of a capsule that settles to a periodic motion [m/s].
fn speed(p: &Parameters) -> f64 {
    let orbit = settled(p);
    assert_eq!(orbit.outcome, Outcome::Periodic, "{p:?}");
    orbit.outputs[Output::ProgressionSpeed]
}

/// The same with the section at this phase [rad].
fn speed_at(p: &Parameters, phase: f64) -> f64 {
    let orbit = settle(p, phase, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic, "{p:?}");
    orbit.outputs[Output::ProgressionSpeed]
}

/// A capsule of a gram or two under pulses, as a millimetre capsule is; without stops.
fn pulsed(duty: f64) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 1.8e-3),
        (Parameter::M2, 1.67e-3),
        (Parameter::K1, 62.0),
        (Parameter::C, 0.3),
        (Parameter::K2, 0.0),
        (Parameter::Delta, 1.0),
        (Parameter::Pd, 0.05),
        (Parameter::Omega, 2.0 * PI * 20.0),
        (Parameter::MuS, 0.2293),
        (Parameter::MuD, 0.2293),
        (Parameter::Duty, duty),
    ]);
    p.resist_by(Resistance::Coulomb);
    p.drive_by(DriveKind::Square);
    p
}

/// A keyless capsule and one with keys that change nothing move alike to the bit.
#[test]
fn parts_that_are_zero_leave_the_bits_of_the_papers_capsule() {
    let mut compared = 0;
    for (_, law) in Resistance::NAMES {
        for case in draws::wide(60, 31, law) {
            let mut with_parts = case.parameters.clone();
            for part in [
                Parameter::PreloadGap,
                Parameter::K3,
                Parameter::Incline,
                Parameter::Load,
                Parameter::K2Damping,
            ] {
                with_parts[part] = 0.0;
            }
            with_parts[Parameter::Delta3] = 1e-3;
            assert!(case.parameters.form() == Form::Filippov && with_parts.form() == Form::General);
            let start = State::from(&case.start);
            let runs = [&case.parameters, &with_parts]
                .map(|p| simulate(p, case.section_phase, start, 20, 1e-12).section);
            let states = runs.map(|run| {
                run.iter().map(|it| [it.r, it.y1, it.x2, it.y2].map(f64::to_bits)).collect()
            });
            let [plain, general]: [Vec<[u64; 4]>; 2] = states;
            assert_eq!(plain, general, "{case:?}");
            compared += 1;
        }
    }
    assert_eq!(compared, 180);
}

/// A mass on a capsule that friction holds, under pulses: a damped oscillator under two constant forces in turn.
#[test]
fn pulses_on_a_capsule_that_is_held_move_the_mass_as_in_closed_form() {
    for (rise, duty, [p_d, p_low, p_0]) in
        [(0.0, 0.3, [0.8, 0.0, 0.0]), (0.0, 0.72, [1.1, -1.1, 0.2]), (0.0, 0.5, [0.4, 0.1, -0.3])]
    {
        assert_eq!(rise, 0.0);
        let mut p = Parameters::with(&[
            (Parameter::K2, 0.0),
            (Parameter::Delta, 1.0),
            (Parameter::MuS, 50.0),
            (Parameter::MuD, 1.0),
            (Parameter::C, 1.3),
            (Parameter::Pd, p_d),
            (Parameter::PLow, p_low),
            (Parameter::P0, p_0),
            (Parameter::Duty, duty),
            (Parameter::Period, 0.11),
        ]);
        p.drive_by(DriveKind::Square);
        let [m1, k1, c] = [Parameter::M1, Parameter::K1, Parameter::C].map(|it| p[it]);
        let (decay, turns) = (0.5 * c / m1, (k1 / m1 - (0.5 * c / m1).powi(2)).sqrt());
        // The motion about the rest of a constant force, by the matrix exponential.
        let after = |[r, v]: [f64; 2], force: f64, t: f64| {
            let (x, e) = (r - force / k1, (-decay * t).exp());
            let (sin, cos) = (turns * t).sin_cos();
            let x_t = e * (x * cos + (v + decay * x) / turns * sin);
            let v_t = e * (v * cos - (decay * v + (k1 / m1) * x) / turns * sin);
            [x_t + force / k1, v_t]
        };
        let run = simulate(&p, 0.0, State { r: 1e-3, ..State::default() }, 12, 1e-13);
        let mut exact = [1e-3, 0.0];
        let period = 0.11;
        for sample in &run.section {
            assert!((sample.r - exact[0]).abs() < 1e-12 * 1e-1, "{:e}", sample.r - exact[0]);
            assert!((sample.y1 - exact[1]).abs() < 1e-12, "{:e}", sample.y1 - exact[1]);
            exact = after(exact, p_0 + p_d, duty * period);
            exact = after(exact, p_0 + p_low, (1.0 - duty) * period);
        }
        let edges: Vec<f64> =
            run.events.iter().filter(|it| it.kind == EventKind::DriveEdge).map(|it| it.t).collect();
        assert_eq!(edges.len(), 23, "the edge at the start belongs to no motion");
        for (number, t) in edges.iter().enumerate() {
            let cycle = number.div_ceil(2) as f64;
            let within = if number % 2 == 0 { duty } else { 0.0 };
            assert!((t - (cycle + within) * period).abs() < 1e-13, "{number} {t}");
        }
    }
}

/// With an actuator between mass and capsule, isotropic friction and no stop, a pulse of duty 1 - D is one of duty D turned round.
#[test]
fn an_actuator_without_a_stop_turns_round_with_the_duty() {
    for (duty, is_moving) in [(0.2, true), (0.35, true), (0.5, false)] {
        let speeds = [duty, 1.0 - duty].map(|duty| {
            let mut p = pulsed(duty);
            p.react_on(Reaction::Capsule);
            speed(&p)
        });
        assert!((speeds[0] + speeds[1]).abs() < 1e-12, "{speeds:?}");
        assert_eq!(speeds[0].abs() > 1e-3, is_moving, "{speeds:?}");
    }
}

/// Pulses of both signs and equal size: turned round and half a period later they are themselves, so nothing progresses at duty 1/2.
#[test]
fn a_symmetric_drive_on_symmetric_ground_leads_nowhere() {
    for reaction in [Reaction::None, Reaction::Capsule] {
        let mut p = pulsed(0.5);
        p[Parameter::PLow] = -p[Parameter::Pd];
        p.react_on(reaction);
        assert!(speed(&p).abs() < 1e-13, "{}", speed(&p));
    }
}

/// Two harmonics: half a turn of the second one's phase turns the progression round.
#[test]
fn half_a_turn_of_the_second_harmonic_turns_the_motion_round() {
    for phase in [0.0, 0.9, 2.0] {
        let speeds = [phase, phase + PI].map(|phase| {
            let mut p = pulsed(0.5);
            p.drive_by(DriveKind::TwoHarmonics);
            p[Parameter::P2] = 0.03;
            p[Parameter::Phase2] = phase;
            speed(&p)
        });
        assert!((speeds[0] + speeds[1]).abs() < 1e-12, "{speeds:?}");
        assert!(speeds[0].abs() > 1e-4, "{speeds:?}");
    }
}

/// A member and its mirror image: stops, directions of the ground and signs of all forces exchanged.
#[test]
fn the_mirror_image_moves_to_the_other_side_to_the_bit() {
    let mut random = Random::new(77);
    let mut compared = 0;
    while compared < 40 {
        let mut p = pulsed(random.uniform(0.1, 0.9));
        if random.uniform(0.0, 1.0) < 0.5 {
            p.react_on(Reaction::Capsule);
        }
        let [gap, rear] = [(); 2].map(|()| random.uniform(0.0, 1e-3));
        let [stiff, rear_stiff] = [(); 2].map(|()| random.logarithmic(1e2, 5e4));
        let [damped, rear_damped] = [(); 2].map(|()| random.logarithmic(1e-3, 0.1));
        let [low, constant, preload, load] =
            [0.05, 0.01, 3e-4, 2e-3].map(|size| random.uniform(-size, size));
        let [incline, forward, backward] =
            [random.uniform(-0.2, 0.2), random.uniform(0.1, 0.4), random.uniform(0.1, 0.4)];
        let [drag, rear_drag] = [(); 2].map(|()| random.uniform(0.0, 0.05));
        // The force of a pulse as the constant part, so that its sign can be turned.
        let image = |side: f64| {
            let mut p = p.clone();
            let (front, back) = if side > 0.0 { (0, 1) } else { (1, 0) };
            let stops = [[gap, stiff, damped], [rear, rear_stiff, rear_damped]];
            let ground = [[forward, drag], [backward, rear_drag]];
            for (parameter, value) in [
                (Parameter::Delta, stops[front][0]),
                (Parameter::K2, stops[front][1]),
                (Parameter::K2Damping, stops[front][2]),
                (Parameter::Delta3, stops[back][0]),
                (Parameter::K3, stops[back][1]),
                (Parameter::K3Damping, stops[back][2]),
                (Parameter::MuDForward, ground[front][0]),
                (Parameter::MuSForward, ground[front][0]),
                (Parameter::C1Forward, ground[front][1]),
                (Parameter::MuDBackward, ground[back][0]),
                (Parameter::MuSBackward, ground[back][0]),
                (Parameter::C1Backward, ground[back][1]),
                (Parameter::Pd, 0.0),
                (Parameter::P0, side * (0.05 + constant)),
                (Parameter::PLow, side * (low - 0.05)),
                (Parameter::PreloadGap, side * preload),
                (Parameter::Incline, side * incline),
                (Parameter::Load, side * load),
            ] {
                p[parameter] = value;
            }
            p
        };
        let runs = [1.0, -1.0].map(|side| {
            let start = State::of([side * 1e-5, side * 0.01, 0.0, 0.0]);
            simulate(&image(side), 0.3, start, 60, 1e-12).section
        });
        for (a, b) in runs[0].iter().zip(&runs[1]) {
            let states = [[a.r, a.y1, a.x2, a.y2], [-b.r, -b.y1, -b.x2, -b.y2]];
            // Zeros have a sign of their own.
            assert_eq!(states[0].map(|x| x + 0.0), states[1].map(|x| x + 0.0), "{:?}", image(1.0));
        }
        assert_eq!(runs[0].len(), 61);
        p = image(1.0);
        compared += usize::from(p.form() == Form::General);
    }
}

/// A preloaded mass that lies on its rear stop leaves it when a slow drive reaches the force of the preload.
#[test]
fn a_preloaded_mass_leaves_its_stop_at_the_force_of_the_preload() {
    let mut p = Parameters::with(&[
        (Parameter::Omega, 0.05),
        (Parameter::Pd, 3.0),
        (Parameter::MuS, 20.0),
        (Parameter::PreloadGap, 1.2e-3),
        (Parameter::K3, 5e4),
        (Parameter::Delta3, 0.0),
    ]);
    p.drive_by(DriveKind::Harmonic);
    // From the rest of the preload on, where the drive is zero and rises.
    let pressed = -p[Parameter::K1] * 1.2e-3 / (p[Parameter::K1] + 5e4);
    let start = State { r: pressed, ..State::default() };
    let run = simulate(&p, 1.5 * PI, start, 1, 1e-12);
    let left =
        run.events.iter().find(|it| it.kind == EventKind::RearContactOpened).expect("it leaves");
    let force = 3.0 * (0.05 * left.t + 1.5 * PI).cos();
    let preload = p[Parameter::K1] * 1.2e-3;
    assert!((force / preload - 1.0).abs() < 1e-4, "{force} {preload}");
}

/// In a viscous medium alone the mean speed is that of the mean force, whatever the motion is.
#[test]
fn in_viscous_drag_the_mean_speed_is_the_mean_force_over_the_drag() {
    for (reaction, incline, load) in [
        (Reaction::None, 0.0, 0.0),
        (Reaction::Capsule, 0.0, 0.0),
        (Reaction::None, 0.3, 0.5),
        (Reaction::Capsule, -0.2, 0.1),
    ] {
        for (_, kind) in DriveKind::NAMES {
            let mut p = Parameters::with(&[
                (Parameter::C1, 2.5),
                (Parameter::Duty, 0.3),
                (Parameter::Rise, 0.12),
                (Parameter::PLow, -0.5),
                (Parameter::P2, 1.0),
                (Parameter::Phase2, 0.7),
                (Parameter::Incline, incline),
                (Parameter::Load, load),
            ]);
            p.resist_by(Resistance::Medium);
            p.drive_by(kind);
            p.react_on(reaction);
            let mean = match kind {
                DriveKind::Square | DriveKind::Trapezoid => 0.3 * 4.0 - 0.7 * 0.5,
                _ => 0.0,
            };
            let weight = (p[Parameter::M1] + p[Parameter::M2]) * p[Parameter::G];
            let external = if p.shape().reacts() { 0.0 } else { mean };
            let exact = (external - weight * incline.sin() + load) / 2.5;
            // The velocities of two phases jump at phase 0.
            let found = speed_at(&p, 0.4);
            assert!((found - exact).abs() < 1e-11, "{kind:?} {reaction:?}: {found} {exact}");
        }
    }
}

/// On a slope under a load a capsule rests as long as friction holds both, and slides where it does not.
#[test]
fn rest_holds_while_friction_holds_slope_and_load() {
    let own = |incline: f64, load: f64| {
        let mut p = Parameters::with(&[
            (Parameter::Pd, 0.0),
            (Parameter::MuS, 0.5),
            (Parameter::MuD, 0.25),
            (Parameter::Incline, incline),
            (Parameter::Load, load),
        ]);
        p.drive_by(DriveKind::Harmonic);
        let weight = (p[Parameter::M1] + p[Parameter::M2]) * p[Parameter::G];
        (p, weight)
    };
    for incline in [-0.4, 0.2, 0.45] {
        let (_, weight) = own(incline, 0.0);
        let (slope, limit) = (weight * f64::sin(incline), 0.5 * weight * f64::cos(incline));
        for side in [-1.0, 1.0] {
            for (share, rests) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
                let (p, _) = own(incline, slope + side * share * limit);
                // The mass where its spring holds it on the slope.
                let r = -p[Parameter::M1] * p[Parameter::G] * incline.sin() / p[Parameter::K1];
                let run = simulate(&p, 0.0, State { r, ..State::default() }, 1, 1e-12);
                let moves = run.section.last().expect("a section").x2;
                assert_eq!(moves == 0.0, rests, "{incline} {side} {share}: {moves:e}");
                assert!(rests || moves * side > 0.0, "{moves:e}");
            }
        }
    }
}

/// A mean force that friction does not hold accelerates the capsule for ever: the case fails and says so.
#[test]
fn a_capsule_that_nothing_holds_runs_away() {
    let mut p = pulsed(0.8);
    p[Parameter::Pd] = 0.12;
    let orbit = settled(&p);
    let failure = orbit.failure.as_ref().expect("it runs away");
    assert_eq!((orbit.outcome, failure.reason), (Outcome::Failed, Reason::Runaway));
    // Less than the friction of 7.8 mN in the mean is held.
    let mut p = pulsed(0.08);
    p[Parameter::Pd] = 0.09;
    assert_eq!(settled(&p).outcome, Outcome::Periodic);
    // An actuator has no mean force outside.
    let mut p = pulsed(0.8);
    p[Parameter::Pd] = 0.12;
    p.react_on(Reaction::Capsule);
    assert_eq!(settled(&p).outcome, Outcome::Periodic);
}
