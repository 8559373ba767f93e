//! Random branches, of the paper's capsule and of members of the family, are the same by any settings.

use capsulemap_engine::branch::{End, SpecialKind};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::branch::{Request, follow};
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, DriveKind, Orbit, Parameter, Parameters,
    Resistance, State, settle, settle_case,
};
use capsulemap_models::motion::Setting;
use rayon::prelude::*;

use super::draws::{self, Random};

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
pub fn numbered(number: usize) -> (Parameters, Parameter, f64) {
    let along = [Parameter::Omega, Parameter::Pd, Parameter::K2, Parameter::Delta, Parameter::C];
    let seed = 7000 + number as u64;
    let case = match number % 2 {
        0 => draws::cases(1, seed).remove(0),
        _ => draws::wide(1, seed, Resistance::NAMES[number / 2 % 3].1).remove(0),
    };
    (case.parameters, along[number % along.len()], Random::new(seed).uniform(0.05, 0.5))
}

/// How many capsules are drawn; the long form takes 300 (CAPSULES=300).
fn capsules() -> usize {
    std::env::var("CAPSULES").map_or(CAPSULES, |it| it.parse().expect("a number"))
}

/// A branch that is asked for in several ways.
struct Drawn {
    number: usize,
    parameters: Parameters,
    along: Parameter,
    range: [f64; 2],
    /// What the capsule settles to.
    settled: Orbit,
}

/// The branches of so many drawn capsules that settle to a short period.
fn periodic(
    drawn: impl Iterator<Item = (usize, Parameters, Parameter, [f64; 2])>,
    count: usize,
) -> Vec<Drawn> {
    let settled = drawn.filter_map(|(number, parameters, along, range)| {
        let settled = settle(&parameters, 0.0, State::default(), &Protocol::default());
        let is_short = settled.outcome == Outcome::Periodic && settled.period <= 4;
        (is_short && range[0] < range[1]).then_some(Drawn {
            number,
            parameters,
            along,
            range,
            settled,
        })
    });
    settled.take(count).collect()
}

#[test]
fn random_branches_are_the_same_by_any_settings() {
    let drawn = (0..).map(|number: usize| {
        let (parameters, along, share) = numbered(number);
        let range = [1.0 - share, 1.0 + share].map(|it| it * parameters[along]);
        (number, parameters, along, range)
    });
    // Long branches of hardly damped capsules may stop at another orbit that is too steep to be followed.
    assert_independent(periodic(drawn, capsules()), 1.0 / 40.0);
}

/// A member of the family by its number, the parameter of the family that its branch goes along, and the range.
fn numbered_member(number: usize) -> (usize, Parameters, Parameter, [f64; 2]) {
    let all = [
        Parameter::Duty,
        Parameter::PreloadGap,
        Parameter::Incline,
        Parameter::Load,
        Parameter::K3,
    ];
    let (along, seed) = (all[number % all.len()], 9000 + number as u64);
    let mut parameters = draws::rich_members(1, seed).remove(0).parameters;
    let mut random = Random::new(seed);
    if along == Parameter::Duty {
        parameters.drive_by(DriveKind::Square);
    }
    let (middle, width) = match along {
        Parameter::Duty => (random.uniform(0.2, 0.8), 0.15),
        Parameter::PreloadGap => (random.uniform(-1e-3, 1e-3), 5e-4),
        Parameter::Incline => (random.uniform(-0.2, 0.2), 0.1),
        Parameter::Load => (random.uniform(-0.2, 0.2), 0.3),
        _ => (random.logarithmic(1e3, 1e5), 5e2),
    };
    parameters[along] = middle;
    (number, parameters, along, [middle - width, middle + width])
}

/// Branches of members in duty, preload, incline, load and stiffness of the rear stop, through edges of the drive that pass impacts,
/// slips and the section. How many impacts on a rigid stop accumulate before the mass stays there follows from a limit, and so do
/// the places where their number changes: such members have no part in it.
///
/// Some branches differ, for these reasons: where static friction is above kinetic a slip may appear with a length of its own, and a
/// branch whose section lies in it ends there; a kink is not passed with every step; of several extrema near a stop another one is taken
/// for the one that touches.
#[test]
fn random_branches_of_members_are_the_same_by_any_settings() {
    let drawn = (0..).map(numbered_member).filter(|(_, it, ..)| !it.shape().is_rigid());
    assert_independent(periodic(drawn, 2 * capsules()), 1.0 / 20.0);
}

/// Members whose capsule rests at the section, or whose slips begin and end there: where rounding moves the section point off the rest,
/// as by a velocity of 1e-20, there is no special point.
#[test]
fn branches_of_members_at_rest_at_the_section_have_no_more_special_points() {
    let numbers = [138, 142, 280, 345];
    assert_independent(periodic(numbers.into_iter().map(numbered_member), numbers.len()), 0.0);
}

/// What is on each branch is the same by other steps, phases of the section, points of the orbit and ends of the range,
/// but on a share of the branches of at most this.
fn assert_independent(chosen: Vec<Drawn>, share: f64) {
    let count = chosen.len();
    let compared = chosen.into_par_iter().map(|drawn| {
        let Drawn { number, parameters, along, range: [low, high], settled } = drawn;
        let request = |phase: f64, point: usize| {
            // The same orbit, of which other starts may not lead to.
            let start = State { x2: 0.0, ..settled.end.capsule() };
            let case = Case {
                start: start.into(),
                section_phase: phase,
                ..Case::at_section(parameters.clone(), start, 0.0)
            };
            let orbit = settle_case(&case, &Protocol::default());
            (orbit.outcome == Outcome::Periodic).then(|| Request {
                setting: Setting { parameters: parameters.clone(), phase },
                section: orbit.section[point % orbit.section.len()],
                period: orbit.period,
                along: along.into(),
                range: [low, high],
                doublings: 0,
                second: None,
                curve_range: None,
                longest_step: 0.02,
                most_points: 2000,
                tolerance: 1e-12,
            })
        };
        let usual = request(0.0, 0)?;
        let mut others: Vec<(String, Request)> = Vec::new();
        for longest_step in [0.005, 0.05, 0.1, 0.2] {
            others
                .push((format!("step {longest_step}"), Request { longest_step, ..usual.clone() }));
        }
        for phase in [1.0, 2.0, 3.0, 4.0, 5.0] {
            others.extend(request(phase, 0).map(|it| (format!("phase {phase}"), it)));
        }
        for point in 1..usual.period as usize {
            others.extend(request(0.0, point).map(|it| (format!("point {point}"), it)));
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
    let most = share * known.len() as f64;
    assert!(wrong.len() as f64 <= most, "{} of {} branches", wrong.len(), known.len());
    assert!(known.len() >= count / 2 && pairs > 5 * known.len(), "{pairs}");
}
