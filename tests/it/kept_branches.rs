//! The branches of the studies that are kept: the points they are known for, and the motion beside these.

use std::fs;

use capsulemap::branch::{End, SpecialKind};
use capsulemap::capsule::{Parameter, State, settle};
use capsulemap::orbit::{Outcome, Protocol};
use capsulemap::store::{self, Dataset};
use capsulemap::study::Study;

use super::program::WorkDir;

/// A study that is kept, the file of its branches, and what the program prints of them.
struct Kept {
    study: Study,
    dataset: Dataset,
    ran: String,
}

/// A special point: the frequency, and the first section point of the orbit.
struct Point {
    omega: f64,
    section: [f64; 3],
}

impl Kept {
    fn continued(name: &str) -> Kept {
        let dir = WorkDir::new();
        let text = fs::read_to_string(format!("studies/{name}.toml")).expect("the study");
        dir.put("s.toml", &text);
        let ran = dir.run(&["continue", "s.toml", "--no-figures"]).done().out;
        let dataset = store::read(&dir.path("results/s/s.h5")).expect("a result");
        Kept { study: Study::parse("s.toml", &text).expect("a study"), dataset, ran }
    }

    /// A variable over the special points; of a section point, that of the first cycle.
    fn specials(&self, name: &str) -> Vec<f64> {
        let values =
            self.dataset.variable(&format!("special_{name}")).expect(name).values.to_real();
        values.outer_iter().filter_map(|row| row.first().copied()).collect()
    }

    /// The special points of a kind on the branch of this number.
    fn points(&self, branch: usize, kind: SpecialKind) -> Vec<Point> {
        let [branches, kinds] = ["branch", "kind"].map(|name| self.specials(name));
        let columns = ["omega", "section_r", "section_y1", "section_y2"];
        let [omega, r, y1, y2] = columns.map(|name| self.specials(name));
        (0..omega.len())
            .filter(|&i| branches[i] == branch as f64 && kinds[i] == f64::from(kind as u8))
            .map(|i| Point { omega: omega[i], section: [r[i], y1[i], y2[i]] })
            .collect()
    }

    /// The period of what the motion settles to at `omega` from a section point; 0 if it does not repeat.
    fn period(&self, omega: f64, [r, y1, y2]: [f64; 3]) -> u64 {
        let mut parameters = self.study.branches[0].parameters.clone();
        parameters[Parameter::Omega] = omega;
        let protocol = Protocol { max_cycles: 20_000, ..Protocol::default() };
        let orbit = settle(&parameters, 0.0, State::of([r, y1, 0.0, y2]), &protocol);
        if orbit.outcome == Outcome::Periodic { orbit.period } else { 0 }
    }
}

#[test]
fn the_cascade_doubles_where_the_motion_does() {
    let kept = Kept::continued("cascade");
    let doublings: Vec<Point> =
        (0..5).map(|n| kept.points(n, SpecialKind::PeriodDoubling).remove(0)).collect();
    let omegas: Vec<f64> = doublings.iter().map(|it| it.omega).collect();
    let document = fs::read_to_string("docs/branches.md").expect("the document");
    let digits = [39.798_118_915, 40.208_396_664, 40.310_005_693, 40.332_241_821, 40.337_127_912];
    for (omega, digits) in omegas.iter().zip(digits) {
        assert!((omega - digits).abs() < 2e-9, "{omega}");
        let shown = format!("{omega:.8}");
        assert!(kept.ran.contains(&shown) && document.contains(&shown), "{omega}\n{}", kept.ran);
    }
    // Beside each of the first three the motion from its section point repeats after k cycles, and 2 k.
    for (n, pair) in omegas.windows(2).take(3).enumerate() {
        let (aside, section) = (0.1 * (pair[1] - pair[0]), doublings[n].section);
        let k = 1 << n;
        assert_eq!(kept.period(pair[0] - 0.2 * aside, section), k);
        assert_eq!(kept.period(pair[0] + aside, section), 2 * k);
    }
    // The ratio of successive intervals tends to Feigenbaum's constant.
    let widths: Vec<f64> = omegas.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let ratios: Vec<f64> = widths.windows(2).map(|pair| pair[0] / pair[1]).collect();
    let expected = [4.038, 4.570, 4.551];
    for (ratio, expected) in ratios.iter().zip(expected) {
        assert!((ratio - expected).abs() < 1e-3, "{ratios:?}");
    }
    assert!((ratios[2] - 4.669_201_609).abs() < 0.15);
    // Beside it lies a branch of period 3 that closes upon itself between two folds.
    let folds: Vec<f64> = kept.points(5, SpecialKind::Fold).iter().map(|it| it.omega).collect();
    assert!(folds.len() == 2 && kept.ran.contains(", closed"), "{}", kept.ran);
    let ends = kept.dataset.variable("index_end_last").expect("ends").values.to_real();
    assert_eq!(ends[[5]], f64::from(End::Closed as u8));
    assert!((folds[0].min(folds[1]) - 39.276_239_7).abs() < 1e-7, "{folds:?}");
    assert!((folds[0].max(folds[1]) - 40.299_701_2).abs() < 1e-7, "{folds:?}");
}

#[test]
fn the_hysteresis_has_an_unstable_branch_between_its_folds() {
    let kept = Kept::continued("hysteresis");
    let folds = kept.points(0, SpecialKind::Fold);
    let [upper, lower] = &folds[..] else { panic!("two folds\n{}", kept.ran) };
    assert!(
        (upper.omega - 164.155_503_150).abs() < 2e-9
            && (lower.omega - 151.018_049_610).abs() < 2e-9
    );
    let column = |name: &str| -> Vec<f64> {
        kept.dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let (omega, stable, speed) =
        (column("branch_omega"), column("branch_stable"), column("branch_progression_speed"));
    let between: Vec<usize> =
        (0..omega.len()).filter(|&i| stable[i] == 0.0 && omega[i] > 140.0).collect();
    assert!(between.len() > 10);
    assert!(between.iter().all(|&i| omega[i] > lower.omega && omega[i] < upper.omega));
    // Halfway, it parts the starts that move on from those that shake in place.
    let middle = |i: &&usize| omega[**i] > 155.0 && omega[**i] < 161.0;
    let places: Vec<usize> = between.iter().filter(middle).copied().collect();
    assert!(!places.is_empty() && places.iter().all(|&i| speed[i] > 0.003 && speed[i] < 0.06));
    for i in places {
        let section = ["r", "y1", "y2"].map(|name| {
            let values = kept.dataset.variable(&format!("branch_section_{name}")).expect(name);
            values.values.to_real()[[i, 0]]
        });
        let reached = [-1e-3, 1e-3].map(|push| {
            let mut parameters = kept.study.branches[0].parameters.clone();
            parameters[Parameter::Omega] = omega[i];
            let [r, y1, y2] = section;
            let start = State::of([r, y1 + push, 0.0, y2]);
            let orbit = settle(&parameters, 0.0, start, &Protocol::default());
            orbit.outputs[capsulemap::capsule::Output::ProgressionSpeed].abs() > 0.05
        });
        assert_ne!(reached[0], reached[1], "{}", omega[i]);
    }
}
