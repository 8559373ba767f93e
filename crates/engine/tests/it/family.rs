//! The family of capsules: what is known of its members, and each against a second method.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::general::balance::Balance;
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Output, Parameter, Resistance, State, simulate,
};
use capsulemap_models::description;

use super::draws;
use super::second_method::follow;

/// Members that are followed beside the second method; the long form takes 200 (MEMBERS=200).
fn count() -> usize {
    std::env::var("MEMBERS").ok().and_then(|count| count.parse().ok()).unwrap_or(24)
}

/// The section points of a motion: omega r, y1, omega x2 and y2 [m/s].
fn sections(case: &Case, start: State<f64>, cycles: u64, tolerance: f64) -> Vec<[f64; 4]> {
    let omega = case.parameters.frequency();
    let run = simulate(&case.parameters, case.section_phase, told(case, start), cycles, tolerance);
    let points = run.section.iter().map(|it| [omega * it.r, it.y1, omega * it.x2, it.y2]);
    points.collect()
}

/// Where a case starts: a mass whose motion is prescribed is where that puts it.
fn begun(case: &Case) -> State<f64> {
    let start = case.start.capsule();
    if !case.parameters.shape().drive.is_prescribed() {
        return start;
    }
    let run = simulate(&case.parameters, case.section_phase, told(case, start), 0, 1e-14);
    State { r: run.section[0].r, y1: run.section[0].y1, ..start }
}

/// A state as the model of a case tells of it.
fn told(case: &Case, State { r, y1, x2, y2, place }: State<f64>) -> description::State {
    let model = case.parameters.model();
    description::State::new(model, &[r, y1, x2, y2, place][..model.coordinates.len()])
}

/// The largest difference of two section points, relative to a size.
fn apart(a: &[f64; 4], b: &[f64; 4], size: f64) -> f64 {
    (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / size
}

/// What the comparison of members with the second method has met.
#[derive(Debug, Default)]
struct Met {
    members: usize,
    sensitive: usize,
    /// Those that run away, and so stop early.
    stopped: usize,
    worst: f64,
}

impl Met {
    /// Follows a member beside the second method.
    fn follow(&mut self, case: &Case) {
        const CYCLES: u64 = 30;
        let (p, start) = (&case.parameters, case.start.capsule());
        // The second method takes hundreds of times as long: fast drives only.
        if p.frequency() < 10.0 || !p.form().is_of_family() {
            return;
        }
        let ours = sections(case, start, CYCLES, 1e-14);
        let size = ours.iter().flatten().map(|x| x.abs()).fold(1e-3, f64::max);
        // A motion that forgets its start so slowly, or not at all, that rounding shows, is no measure of a method.
        let push = 1e-11 * size / p.frequency();
        let near = State { r: start.r + push, ..start };
        // A motion that is prescribed takes no push of r; over folds the place takes one.
        let near = match p.shape().over_folds {
            true => State { place: start.place + push / p[Parameter::FoldSpacing], ..near },
            false => near,
        };
        let near = sections(case, near, CYCLES, 1e-14);
        let both = ours.iter().zip(&near);
        if both.map(|(a, b)| apart(a, b, size)).fold(0.0, f64::max) > 1e-10 {
            self.sensitive += 1;
            return;
        }
        self.stopped += usize::from(ours.len() as u64 != CYCLES + 1);
        let theirs = follow(p, case.section_phase, begun(case), ours.len() as u64 - 1);
        for (cycle, (a, b)) in ours.iter().zip(&theirs).enumerate() {
            let b = [p.frequency() * b[0], b[1], p.frequency() * b[2], b[3]];
            let gap = apart(a, &b, size);
            assert!(gap < 1e-9, "{gap:e} after {cycle} cycles: {case:?}");
            self.worst = self.worst.max(gap);
        }
        self.members += 1;
    }
}

#[test]
fn members_move_as_a_second_method_has_them_move() {
    let mut met = Met::default();
    for (_, law) in Resistance::NAMES {
        draws::members(count(), 91, law).iter().for_each(|case| met.follow(case));
    }
    println!("{met:?}");
    assert!(2 * met.members > count() && met.members > met.sensitive, "{met:?}");
}

#[test]
fn members_over_folds_move_as_a_second_method_has_them_move() {
    let mut met = Met::default();
    for (_, law) in Resistance::NAMES {
        let cases = draws::over_folds(draws::members(count(), 93, law), 93);
        cases.iter().for_each(|case| met.follow(case));
    }
    println!("{met:?}");
    assert!(2 * met.members > count() && met.members > met.sensitive, "{met:?}");
}

/// Momentum and energy of every orbit that is certified balance to rounding.
#[test]
fn certified_orbits_balance_their_forces_and_their_energies() {
    let cases = |law| draws::members(20 * count(), 92, law);
    let balanced = |law| balanced(&cases(law), &Protocol::default());
    let met: usize = Resistance::NAMES.iter().map(|(_, law)| balanced(*law)).sum();
    assert!(met > 5 * count(), "{met}");
}

/// The same over folds, where they pass a whole number of them in a period.
#[test]
fn certified_orbits_over_folds_balance_their_forces_and_their_energies() {
    let cases = |law| draws::over_folds(draws::members(20 * count(), 94, law), 94);
    // Most drift, which takes long to see.
    let protocol = Protocol { max_cycles: 200, exponent_cycles: 0, ..Protocol::default() };
    let balanced = |law| balanced(&cases(law), &protocol);
    let met: usize = Resistance::NAMES.iter().map(|(_, law)| balanced(*law)).sum();
    assert!(met > count(), "{met}");
}

/// How many orbits that the cases settle to are certified, and balance.
fn balanced(cases: &[Case], protocol: &Protocol) -> usize {
    let (mut met, mut worst) = (0, [0.0_f64; 2]);
    let orbits = draws::settled(cases, protocol, Instructions::widest());
    for (case, orbit) in cases.iter().zip(orbits) {
        // Without a drive there is nothing but losses to compare them with.
        let is_driven = Balance::of(&case.parameters).largest_drive > 0.0;
        if orbit.outcome != Outcome::Periodic || !is_driven {
            continue;
        }
        let residuals = [Output::EnergyResidual, Output::MomentumResidual];
        for (worst, residual) in worst.iter_mut().zip(residuals.map(|it| orbit.outputs[it].abs())) {
            assert!(residual < 1e-9, "{residual:e}: {case:?}");
            *worst = worst.max(residual);
        }
        if case.parameters.shape().over_folds {
            let advance = orbit.outputs[Output::ProgressionPerCycle] * orbit.period as f64;
            let folds = advance / case.parameters[Parameter::FoldSpacing];
            let whole = orbit.outputs[Output::FoldsPerPeriod];
            assert!((folds - whole).abs() < 1e-9, "{folds} folds: {case:?}");
        }
        met += 1;
    }
    println!("{met} orbits; energy balances to {:.1e}, momentum to {:.1e}", worst[0], worst[1]);
    met
}
