//! Numbers of attractors along an axis: one branch, one number, whatever the points of the axis.

use std::collections::BTreeSet;
use std::env;
use std::sync::Mutex;

use capsulemap::attractor::Attractor;
use capsulemap::branch::SpecialKind;
use capsulemap::capsule::{CapsuleParameters as _, Orbit, Parameter, Parameters, Resistance};
use capsulemap::model::Setting;
use capsulemap::orbit::Outcome;
use capsulemap::run::{self, Attractors, FinalMotions, Machine, Record};
use capsulemap::study::{Axis, CaseSet, Coordinate, Direction, Grid, Inherit, Study};

use super::draws::{self, ALONG, Random};
use capsulemap::description::Section;

/// The capsule of the issue at 40 rad/s.
const CAPSULE_P: &str = "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\n\
     p_d = \"3.4 N\"\ndelta = \"2.45 mm\"\nomega = \"40 rad/s\"\n";
/// Where its orbits of period 2 appear and where those of period 1 end [N/m]: folds, as branches of
/// `crates/engine/tests/it/whole_branches.rs` have them, by continuation with small steps.
const FOLDS: [f64; 2] = [15100.3915, 17368.3133];
/// Where period 2 doubles [N/m].
const DOUBLES: f64 = 43742.26;
/// Axes that are drawn, and how many points they have.
const AXES: usize = 4;
const POINTS: usize = 25;
/// The axis that tells more has so many times as many intervals.
const FINER: usize = 4;

struct Swept {
    study: Study,
    records: Vec<Record>,
    final_motions: FinalMotions,
    attractors: Attractors,
}

impl Swept {
    fn of(text: &str) -> Self {
        Swept::all(Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}")))
    }

    fn all(study: Study) -> Self {
        let records = Mutex::new(Vec::new());
        run::run(&study, Machine::default(), |it| records.lock().expect("a lock").push(it))
            .expect("the study runs");
        let mut records = records.into_inner().expect("a lock");
        records.sort_by_key(|record| record.index);
        let final_motions = run::final_motions(&study, &records);
        let attractors = run::attractors(&study, &final_motions, Machine::default(), || ())
            .expect("the threads start");
        Swept { study, records, final_motions, attractors }
    }

    /// The value of the axis that varies first, the period and the number of each periodic case.
    fn periodic(&self) -> impl Iterator<Item = (f64, u64, u32)> + '_ {
        let each = self.records.len() / self.study.axes()[0].varying[0].values.len();
        self.records.iter().enumerate().filter_map(move |(case, record)| {
            let number = self.attractors.of_case[case]?;
            let value = self.study.axes()[0].varying[0].values[case / each];
            let Orbit { outcome, period, .. } = record.orbit;
            (outcome == Outcome::Periodic).then_some((value, period, number))
        })
    }
}

#[test]
fn a_smooth_curve_keeps_its_number_and_a_jump_changes_it() {
    let line = Swept::of(&format!(
        "{CAPSULE_P}[[axes]]\nname = \"k2\"\nfrom = \"1 kN/m\"\nto = \"100 kN/m\"\npoints = 601\n\
         spacing = \"logarithmic\"\n[start]\ninherit = \"k2\"\ndirections = [\"upward\", \"downward\"]\n"
    ));
    for (k2, period, number) in line.periodic().filter(|(k2, ..)| *k2 < DOUBLES) {
        assert_eq!(u64::from(number), period - 1, "{k2}");
        assert!(if period == 1 { k2 < FOLDS[1] } else { k2 > FOLDS[0] }, "{k2} {period}");
    }
    let folds = line.attractors.events.iter().filter(|it| it.kind == SpecialKind::Fold);
    for (fold, right) in folds.zip(FOLDS) {
        assert!((fold.value / right - 1.0).abs() < 1e-8, "{fold:?}");
    }
}

#[test]
fn chaos_beside_a_periodic_orbit_keeps_its_number() {
    // Upward cases stay on an orbit of one cycle; downward ones come on chaos, where nothing inherits its start upward.
    let line = Swept::of(&format!(
        "{}[[axes]]\nname = \"omega\"\nfrom = \"37.6 rad/s\"\nto = \"38.5 rad/s\"\npoints = 10\n\
         [start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]\n",
        CAPSULE_P.replace("omega = \"40 rad/s\"", "k2 = \"86.8 kN/m\"")
    ));
    let numbers = |direction: usize, wanted: Outcome| -> Vec<u32> {
        let cases = (direction..line.records.len()).step_by(2);
        let cases = cases.filter(|case| line.records[*case].orbit.outcome == wanted);
        cases.map(|case| line.attractors.of_case[case].expect("a number")).collect()
    };
    let (periodic, chaotic) = (numbers(0, Outcome::Periodic), numbers(1, Outcome::Chaotic));
    assert_eq!((periodic, chaotic), (vec![0; 8], vec![1; 8]));
    let unresolved = line.attractors.events.iter().filter(|it| it.kind == SpecialKind::Unresolved);
    assert_eq!(unresolved.count(), 0);
}

#[test]
fn a_basin_that_has_vanished_does_not_revive() {
    let starts = "[[axes]]\nname = \"start_r\"\nfrom = \"-8 mm\"\nto = \"4 mm\"\npoints = 10\n\
                  [[axes]]\nname = \"start_y1\"\nfrom = \"-0.8 m/s\"\nto = \"0.8 m/s\"\npoints = 10\n";
    let shares = Swept::of(&format!(
        "{CAPSULE_P}[[axes]]\nname = \"k2\"\nfrom = \"14 kN/m\"\nto = \"19 kN/m\"\npoints = 26\n{starts}"
    ));
    let numbers = |among: &dyn Fn(f64, u64) -> bool| -> BTreeSet<u32> {
        let all = shares.periodic();
        all.filter(|(k2, period, _)| among(*k2, *period)).map(|(_, _, number)| number).collect()
    };
    let of_one = numbers(&|_, period| period == 1);
    let of_two = numbers(&|k2, period| period == 2 && k2 < 17200.0);
    assert_eq!((of_one.len(), of_two.len()), (1, 1), "{of_one:?} {of_two:?}");
    assert!(of_one.is_disjoint(&of_two));
    assert_eq!(numbers(&|k2, _| k2 > FOLDS[1]), of_two);
}

impl Swept {
    /// The orbits on which the cases of a cell of a line in both directions end, with their numbers.
    fn orbits(&self, at: usize) -> Vec<(Attractor<Section>, u32)> {
        let (model, setting) = (self.study.model(), Setting::of(&self.study.case(2 * at)));
        let orbit = |case: usize| {
            let motion = self.final_motions.get(case)?;
            let found = model.attractor(&setting, case, &motion, &self.study.protocol)?;
            let number = self.attractors.of_case[case]?;
            (found.outcome == Outcome::Periodic).then_some((found, number))
        };
        (2 * at..2 * at + 2).filter_map(orbit).collect()
    }

    /// Whether it is listed as unresolved how one of these attractors goes on between two values.
    fn is_unresolved(&self, numbers: [u32; 2], [low, high]: [f64; 2]) -> bool {
        self.attractors.events.iter().any(|it| {
            it.kind == SpecialKind::Unresolved
                && numbers.contains(&it.attractor)
                && (low..=high).contains(&it.value)
        })
    }
}

/// A line of cases of a capsule in both directions.
fn line(base: &Parameters, parameter: Parameter, values: Vec<f64>) -> Study {
    let axis = Axis::of(Coordinate::Parameter(parameter.into()), values);
    let directions = vec![Direction::Upward, Direction::Downward];
    let grid = Grid { axes: vec![axis], inherit: Some(Inherit { axis: 0, directions }) };
    Study { base: base.clone(), case_set: CaseSet::Grid(grid), ..Study::default() }
}

/// The numbers that a finer axis gives to the orbits of a cell, by the numbers of this one.
fn renumbered(coarse: &Swept, fine: &Swept, at: usize) -> Vec<[u32; 2]> {
    let metric = coarse.study.case(2 * at).parameters.metric();
    let finer = fine.orbits(FINER * at);
    let of_engine = |it: &Attractor<Section>| it.clone().map(|point| point.array());
    let same = |(orbit, number): &(Attractor<Section>, u32)| {
        let found = finer.iter().find(|(it, _)| of_engine(it).is(&of_engine(orbit), &metric));
        found.map(|(_, finer)| [*number, *finer])
    };
    coarse.orbits(at).iter().filter_map(same).collect()
}

#[test]
fn no_number_passes_from_one_orbit_to_another_that_a_finer_axis_tells_apart() {
    let axes = env::var("AXES").map_or(AXES, |it| it.parse().expect("a number of axes"));
    let mut random = Random::new(360);
    let (mut pairs, mut broken, mut unresolved, mut changes) = (0, 0, 0, 0);
    let mut wrong = Vec::new();
    for number in 0..axes {
        let seed = 3600 + number as u64;
        let case = if number % 2 == 0 {
            draws::cases(1, seed).remove(0)
        } else {
            draws::wide(1, seed, Resistance::NAMES[number / 2 % 3].1).remove(0)
        };
        let (base, parameter) = (case.parameters, ALONG[number % ALONG.len()]);
        let low = base[parameter].max(1e-4);
        let high = low * random.uniform(1.1, 2.5);
        let values = |points: usize| -> Vec<f64> {
            (0..points).map(|i| low + (high - low) * i as f64 / (points - 1) as f64).collect()
        };
        let coarse = Swept::all(line(&base, parameter, values(POINTS)));
        let fine = Swept::all(line(&base, parameter, values(FINER * (POINTS - 1) + 1)));
        let cells: Vec<Vec<[u32; 2]>> =
            (0..POINTS).map(|at| renumbered(&coarse, &fine, at)).collect();
        let events = coarse.attractors.events.iter();
        unresolved += events.filter(|it| it.kind == SpecialKind::Unresolved).count();
        for (at, pair) in cells.windows(2).enumerate() {
            let between = [at, at + 1].map(|it| coarse.study.axes()[0].varying[0].values[it]);
            for [here, finer_here] in &pair[0] {
                for [next, finer_next] in &pair[1] {
                    let one = [here == next, finer_here == finer_next];
                    pairs += usize::from(one[0]);
                    changes += usize::from(!one[0] && !one[1]);
                    broken += usize::from(!one[0] && one[1]);
                    if one[0] && !one[1] && !fine.is_unresolved([*finer_here, *finer_next], between)
                    {
                        wrong.push(format!("axis {number} {parameter:?} {between:?} {base:?}"));
                    }
                }
            }
        }
    }
    println!(
        "{pairs} pairs keep a number, {changes} change it on both axes, {broken} on the coarse one alone"
    );
    println!("{unresolved} are listed as unresolved");
    assert!(wrong.is_empty(), "{} of {pairs}: {}", wrong.len(), wrong.join("\n"));
    assert!(pairs > 20 * axes, "{pairs}");
}
