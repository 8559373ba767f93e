//! What lies on a branch does not depend on where its range ends, on its steps, on the phase of the section, or on the point
//! of the orbit that it begins from.

use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::branch::{Request, follow};
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Parameter, Parameters, Resistance, State,
    settle, settle_case,
};
use rayon::prelude::*;

use super::draws::{self, Random};
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

/// Capsules of the wide box that are drawn.
const CAPSULES: usize = 12;
/// Two special points are one if their values are so near, relative to the range.
const SAME: f64 = 1e-7;

/// The special points of the branch through an orbit, each with its kind, period and value, and the intervals of the parameter
/// in which something is unresolved; none where no branch is found or one has more points than are asked for.
struct Shown {
    special: Vec<(SpecialKind, f64)>,
    unresolved: Vec<[f64; 2]>,
    ends: [End; 2],
}

fn shown(request: &Request) -> Option<Shown> {
    let branch = follow(request).ok()?.branches.swap_remove(0);
    if branch.ends.contains(&End::MostPoints) {
        return None;
    }
    let (mut special, mut unresolved) = (Vec::new(), Vec::new());
    for it in &branch.special {
        if it.kind == SpecialKind::Unresolved {
            let ends = [it.after, (it.after + 1).min(branch.points.len() - 1)];
            let [a, b] = ends.map(|at| branch.points[at].parameter);
            unresolved.push([a.min(b), a.max(b)]);
        } else {
            special.push((it.kind, it.point.parameter));
        }
    }
    Some(Shown { special, unresolved, ends: branch.ends })
}

impl Shown {
    /// Those that another one does not have, where nothing is unresolved in either.
    fn missing_in(&self, other: &Shown, width: f64) -> Vec<(SpecialKind, f64)> {
        let near = SAME * width;
        let mut left = other.special.clone();
        let is_known = |value: f64| {
            let mut all = self.unresolved.iter().chain(&other.unresolved);
            all.all(|[low, high]| !(low - near..=high + near).contains(&value))
        };
        let mut missing = self.special.clone();
        missing.retain(|(kind, value)| {
            let found = left.iter().position(|it| it.0 == *kind && (it.1 - value).abs() <= near);
            found.map(|at| left.swap_remove(at)).is_none() && is_known(*value)
        });
        missing
    }
}

/// A capsule of the wide box by its number, the parameter that its branch goes along, and how far, as a share.
fn numbered(number: usize) -> (Parameters, Parameter, f64) {
    let along = [Parameter::Omega, Parameter::Pd, Parameter::K2, Parameter::Delta, Parameter::C];
    let seed = 7000 + number as u64;
    let case = match number % 2 {
        0 => draws::cases(1, seed).remove(0),
        _ => draws::wide(1, seed, Resistance::NAMES[number / 2 % 3].1).remove(0),
    };
    (case.parameters, along[number % along.len()], Random::new(seed).uniform(0.05, 0.5))
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

#[test]
fn random_branches_are_the_same_by_any_settings() {
    let capsules = std::env::var("CAPSULES").map_or(CAPSULES, |it| it.parse().expect("a number"));
    let drawn = (0..).map(|number: usize| (number, numbered(number)));
    let periodic = drawn.filter_map(|(number, (parameters, along, share))| {
        let orbit = settle(&parameters, 0.0, State::default(), &Protocol::default());
        let is_short = orbit.outcome == Outcome::Periodic && orbit.period <= 4;
        (is_short && parameters[along] > 0.0).then_some((number, parameters, along, share, orbit))
    });
    let chosen: Vec<_> = periodic.take(capsules).collect();
    let compared = chosen.into_par_iter().map(|(number, parameters, along, share, settled)| {
        let (low, high) = (parameters[along] * (1.0 - share), parameters[along] * (1.0 + share));
        let request = |phase: f64, point: usize| {
            // The same orbit, of which other starts may not lead to.
            let start = State { x2: 0.0, ..settled.end.capsule() };
            let case = Case {
                start: start.into(),
                section_phase: phase,
                ..Case::at_section(parameters.clone(), start, 0.0)
            };
            let orbit = settle_case(&case, &Protocol::default());
            Request {
                setting: Setting { parameters: parameters.clone(), phase },
                section: orbit.section[point % orbit.section.len()],
                period: orbit.period,
                along: along.into(),
                range: [low, high],
                doublings: 0,
                second: None,
                longest_step: 0.02,
                most_points: 2000,
                tolerance: 1e-12,
            }
        };
        let usual = request(0.0, 0);
        let mut others: Vec<(String, Request)> = Vec::new();
        for longest_step in [0.005, 0.05, 0.1, 0.2] {
            others
                .push((format!("step {longest_step}"), Request { longest_step, ..usual.clone() }));
        }
        for phase in [1.0, 2.0, 3.0, 4.0, 5.0] {
            others.push((format!("phase {phase}"), request(phase, 0)));
        }
        for point in 1..usual.period as usize {
            others.push((format!("point {point}"), request(0.0, point)));
        }
        let first = shown(&usual)?;
        let width = high - low;
        let mut told = Vec::new();
        let (mut pairs, mut unresolved) = (0, first.unresolved.len());
        for (name, other) in &others {
            let Some(other) = shown(other) else { continue };
            pairs += 1;
            unresolved += other.unresolved.len();
            let (more, less) = (other.missing_in(&first, width), first.missing_in(&other, width));
            if !more.is_empty() || !less.is_empty() {
                told.push(format!(
                    "{name}: more {more:?} less {less:?} ends {:?} {:?}",
                    first.ends, other.ends
                ));
            }
        }
        // A wider range may have more, as the branch comes back into the narrower one.
        for factor in [1.1, 1.3, 1.5, 2.0] {
            let wide = Request { range: [low, low + factor * width], ..usual.clone() };
            let Some(other) = shown(&wide) else { continue };
            pairs += 1;
            unresolved += other.unresolved.len();
            let less = first.missing_in(&other, width);
            if !less.is_empty() {
                told.push(format!(
                    "end {factor}: less {less:?} ends {:?} {:?}",
                    first.ends, other.ends
                ));
            }
        }
        let about =
            format!("capsule {number} along {along:?} in {:?}, {parameters:?}", usual.range);
        Some((first.special.len(), pairs, unresolved, about, told))
    });
    let compared: Vec<_> = compared.collect();
    let known: Vec<_> = compared.iter().flatten().collect();
    let special: usize = known.iter().map(|it| it.0).sum();
    let pairs: usize = known.iter().map(|it| it.1).sum();
    let unresolved: usize = known.iter().map(|it| it.2).sum();
    println!(
        "{} branches with {special} special points, {pairs} comparisons, {unresolved} unresolved",
        known.len()
    );
    let wrong: Vec<_> = known.iter().filter(|it| !it.4.is_empty()).collect();
    for it in &wrong {
        println!("{}", it.3);
        it.4.iter().for_each(|told| println!("    {told}"));
    }
    // Long branches of hardly damped capsules may stop at another orbit that is too steep to be followed.
    assert!(wrong.len() * 40 <= known.len(), "{} of {} branches", wrong.len(), known.len());
    assert!(known.len() >= capsules / 2 && pairs > 5 * known.len(), "{pairs}");
}
