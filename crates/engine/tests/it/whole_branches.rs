//! What lies on a branch does not depend on where its range ends, on its steps, on the phase of the section, or on the point
//! of the orbit that it begins from.

use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::orbit::Protocol;
use capsulemap_models::capsule::branch::{Request, follow};
use capsulemap_models::capsule::{CapsuleParameters as _, Parameter, Parameters, State, settle};

use super::random_branches::numbered;
use super::rigid_branches::impact_oscillator::Impactor;
use capsulemap_models::motion::Setting;

/// A capsule with many special points, small and large branches of twice and four times the period, and period doublings
/// next to grazings and folds.
fn capsule() -> Parameters {
    Parameters::with(&[
        (Parameter::C, 0.44),
        (Parameter::MuS, 0.437),
        (Parameter::MuD, 0.2185),
        (Parameter::Pd, 3.4),
        (Parameter::K2, 86.8e3),
        (Parameter::Delta, 2.45e-3),
        (Parameter::Omega, 39.2),
    ])
}

/// How a branch is asked for.
#[derive(Debug, Clone, Copy)]
struct Asked {
    along: Parameter,
    range: [f64; 2],
    longest_step: f64,
    phase: f64,
    doublings: u32,
}

/// The special points below a value, of all branches: their kind, period and value, in order of the value.
fn special(parameters: &Parameters, asked: Asked, below: f64) -> Vec<(SpecialKind, u64, f64)> {
    let Asked { along, range, longest_step, phase, doublings } = asked;
    let orbit = settle(parameters, phase, State::default(), &Protocol::default());
    let found = follow(&Request {
        setting: Setting { parameters: parameters.clone(), phase },
        section: orbit.section[0],
        period: orbit.period,
        along: along.into(),
        range,
        doublings,
        second: None,
        curve_range: None,
        longest_step,
        most_points: 4000,
        tolerance: 1e-12,
    });
    let found = found.expect("a branch");
    let mut all = Vec::new();
    for branch in &found.branches {
        assert!(!branch.ends.contains(&End::MostPoints), "{asked:?}");
        let of_branch =
            branch.special.iter().map(|it| (it.kind, branch.period, it.point.parameter));
        all.extend(of_branch.filter(|it| it.2 < below));
    }
    all.sort_by(|a, b| a.2.total_cmp(&b.2));
    all
}

/// Whether two lists of special points are one: the kinds in their order, and the values.
fn assert_same(a: &[(SpecialKind, u64, f64)], b: &[(SpecialKind, u64, f64)], asked: Asked) {
    let kinds = |all: &[(SpecialKind, u64, f64)]| -> Vec<(SpecialKind, u64)> {
        all.iter().map(|it| (it.0, it.1)).collect()
    };
    assert_eq!(kinds(a), kinds(b), "{asked:?}");
    for (a, b) in a.iter().zip(b) {
        assert!((a.2 - b.2).abs() < 1e-8 * a.2, "{asked:?}: {a:?} {b:?}");
    }
}

#[test]
fn special_points_depend_on_neither_range_nor_step_nor_section() {
    let parameters = capsule();
    let usual = Asked {
        along: Parameter::Omega,
        range: [36.0, 60.0],
        longest_step: 0.02,
        phase: 0.0,
        doublings: 2,
    };
    let all = special(&parameters, usual, 46.5);
    assert_eq!(all.len(), 29);
    // Those that steps of other lengths have passed over.
    for (kind, value) in [
        (SpecialKind::Fold, 45.395_600_82),
        (SpecialKind::PeriodDoubling, 45.370_244_27),
        (SpecialKind::Grazing, 38.796_642_72),
    ] {
        let is = |it: &&(SpecialKind, u64, f64)| it.0 == kind && (it.2 - value).abs() < 1e-7;
        assert_eq!(all.iter().filter(is).count(), 1, "{kind:?} {value}");
    }
    let ends = [62.0, 64.0, 70.0, 80.0, 90.0];
    let others = ends.map(|end| Asked { range: [36.0, end], ..usual });
    let steps = [0.005, 0.05, 0.08, 0.1, 0.2].map(|longest_step| Asked { longest_step, ..usual });
    let phases = [1.0, 2.0, 3.0, 4.0, 5.0].map(|phase| Asked { phase, ..usual });
    let narrow =
        [0.08, 0.1].map(|longest_step| Asked { range: [36.0, 46.5], longest_step, ..usual });
    for asked in others.into_iter().chain(steps).chain(phases).chain(narrow) {
        assert_same(&special(&parameters, asked, 46.5), &all, asked);
    }
}

#[test]
fn a_doubled_branch_begins_next_to_its_parent() {
    let mut parameters = capsule();
    (parameters[Parameter::Omega], parameters[Parameter::K2]) = (40.0, 10e3);
    let usual = Asked {
        along: Parameter::K2,
        range: [1e3, 100e3],
        longest_step: 0.02,
        phase: 0.0,
        doublings: 1,
    };
    let all = special(&parameters, usual, f64::INFINITY);
    // A first orbit farther off would lie beyond both.
    for (kind, value) in [(SpecialKind::Grazing, 17_279.34), (SpecialKind::Fold, 17_368.313)] {
        assert!(all.iter().any(|it| it.0 == kind && (it.2 - value).abs() < 0.01), "{all:?}");
    }
    for longest_step in [0.005, 0.1, 0.2] {
        let asked = Asked { longest_step, ..usual };
        assert_same(&special(&parameters, asked, f64::INFINITY), &all, asked);
    }
}

/// The branch of the rigid impact oscillator along the amplitude of its force.
fn rigid(f: f64, section: [f64; 2], longest_step: f64) -> branch::BranchOf<Impactor<f64>, 2> {
    let system = Impactor { c: 0.04, f, w: 0.81, r: 0.9, wall: 1.0, phase: 0.0 };
    let found = branch::follow(&branch::Request {
        system,
        section,
        period: 2,
        along: "f",
        range: [0.34, 0.4],
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step,
        most_points: 4000,
        tolerance: 1e-12,
    });
    found.expect("a branch").branches.swap_remove(0)
}

/// The doubling is that of the published curve, .347533397412283355; beyond it the orbit becomes one of half its period as it
/// touches the wall, and is traced no second time.
#[test]
fn a_rigid_branch_is_one_from_each_point_of_its_orbit() {
    let first = rigid(0.38, [0.65174, 0.08155], 0.02);
    let nearest = first
        .points
        .iter()
        .min_by(|a, b| (a.parameter - 0.38).abs().total_cmp(&(b.parameter - 0.38).abs()));
    let nearest = nearest.expect("orbits");
    for (number, section) in nearest.section.iter().enumerate() {
        for longest_step in [0.005, 0.02, 0.1] {
            let branch = rigid(nearest.parameter, *section, longest_step);
            assert_eq!(branch.ends, [End::Merged, End::Bound], "{number} {longest_step}");
            let kinds: Vec<SpecialKind> = branch.special.iter().map(|it| it.kind).collect();
            assert_eq!(kinds, [SpecialKind::Grazing, SpecialKind::PeriodDoubling]);
            let doubling = branch.special[1].point.parameter;
            assert!((doubling - 0.347_533_397_412_283_36).abs() < 1e-13, "{doubling}");
        }
    }
}

/// Between two gaps one contact begins and another ceases, so that a step over both has the same events at its ends. The
/// values are those at which the distances of the two extrema, printed along the branch at a step of .0005, pass zero.
#[test]
fn two_grazings_are_seen_that_undo_each_other_in_the_events() {
    let (parameters, along, share) = numbered(213);
    let range = [1.0 - share, 1.0 + share].map(|it| it * parameters[along]);
    for longest_step in [0.005, 0.02, 0.1] {
        let asked = Asked { along, range, longest_step, phase: 0.0, doublings: 0 };
        let all = special(&parameters, asked, f64::INFINITY);
        for value in [3.295_168e-3, 3.297_865e-3] {
            let is = |it: &&(SpecialKind, u64, f64)| {
                it.0 == SpecialKind::Grazing && (it.2 - value).abs() < 1e-9
            };
            assert_eq!(all.iter().filter(is).count(), 1, "{longest_step} {value}: {all:?}");
        }
    }
}
