//! The family of capsules: what is known of its members, and each against a second method.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::general::balance::Balance;
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Form, Output, Resistance, State, simulate,
};

use super::draws;
use super::second_method::follow;

/// Members that are followed beside the second method; the long form takes 200 (MEMBERS=200).
fn count() -> usize {
    std::env::var("MEMBERS").ok().and_then(|count| count.parse().ok()).unwrap_or(24)
}

/// The section points of a motion: omega r, y1, omega x2 and y2 [m/s].
fn sections(case: &Case, start: State<f64>, cycles: u64, tolerance: f64) -> Vec<[f64; 4]> {
    let omega = case.parameters.frequency();
    let run = simulate(&case.parameters, case.section_phase, start, cycles, tolerance);
    let points = run.section.iter().map(|it| [omega * it.r, it.y1, omega * it.x2, it.y2]);
    points.collect()
}

/// Where a case starts: a mass whose motion is prescribed is where that puts it.
fn begun(case: &Case) -> State<f64> {
    let start = case.start.capsule();
    if !case.parameters.shape().drive.is_prescribed() {
        return start;
    }
    let run = simulate(&case.parameters, case.section_phase, start, 0, 1e-14);
    let State { x2, y2, .. } = start;
    State { r: run.section[0].r, y1: run.section[0].y1, x2, y2 }
}

/// The largest difference of two section points, relative to a size.
fn apart(a: &[f64; 4], b: &[f64; 4], size: f64) -> f64 {
    (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / size
}

#[test]
fn members_move_as_a_second_method_has_them_move() {
    const CYCLES: u64 = 30;
    let (mut met, mut sensitive, mut stopped, mut worst) = (0, 0, 0, 0.0_f64);
    for (_, law) in Resistance::NAMES {
        for case in draws::members(count(), 91, law) {
            let (p, start) = (&case.parameters, case.start.capsule());
            // The second method takes hundreds of times as long: fast drives only.
            if p.frequency() < 10.0 || p.form() != Form::General {
                continue;
            }
            let ours = sections(&case, start, CYCLES, 1e-14);
            let size = ours.iter().flatten().map(|x| x.abs()).fold(1e-3, f64::max);
            // A motion that forgets its start so slowly, or not at all, that rounding shows, is no measure of a method.
            let near = State { r: start.r + 1e-11 * size / p.frequency(), ..start };
            let near = sections(&case, near, CYCLES, 1e-14);
            let both = ours.iter().zip(&near);
            if both.map(|(a, b)| apart(a, b, size)).fold(0.0, f64::max) > 1e-10 {
                sensitive += 1;
                continue;
            }
            stopped += usize::from(ours.len() as u64 != CYCLES + 1);
            let theirs = follow(p, case.section_phase, begun(&case), ours.len() as u64 - 1);
            for (cycle, (a, b)) in ours.iter().zip(&theirs).enumerate() {
                let b = [p.frequency() * b[0], b[1], p.frequency() * b[2], b[3]];
                let gap = apart(a, &b, size);
                assert!(gap < 1e-9, "{gap:e} after {cycle} cycles: {case:?}");
                worst = worst.max(gap);
            }
            met += 1;
        }
    }
    println!("{met} members, {sensitive} sensitive, {stopped} run away; the worst {worst:.1e} off");
    assert!(2 * met > count() && met > sensitive, "{met} {sensitive}");
}

/// Momentum and energy of every orbit that is certified balance to rounding.
#[test]
fn certified_orbits_balance_their_forces_and_their_energies() {
    let (mut met, mut worst) = (0, [0.0_f64; 2]);
    for (_, law) in Resistance::NAMES {
        let cases = draws::members(20 * count(), 92, law);
        let orbits = draws::settled(&cases, &Protocol::default(), Instructions::widest());
        for (case, orbit) in cases.iter().zip(orbits) {
            // Without a drive there is nothing but losses to compare them with.
            let is_driven = Balance::of(&case.parameters).largest_drive > 0.0;
            if orbit.outcome != Outcome::Periodic || !is_driven {
                continue;
            }
            let residuals = [Output::EnergyResidual, Output::MomentumResidual];
            for (worst, residual) in
                worst.iter_mut().zip(residuals.map(|it| orbit.outputs[it].abs()))
            {
                assert!(residual < 1e-9, "{residual:e}: {case:?}");
                *worst = worst.max(residual);
            }
            met += 1;
        }
    }
    println!("{met} orbits; energy balances to {:.1e}, momentum to {:.1e}", worst[0], worst[1]);
    assert!(met > 5 * count(), "{met}");
}
