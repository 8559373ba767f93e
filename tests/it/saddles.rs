//! The saddles between basins: unstable orbits on the boundary, as starts beside them show, and those that continuation finds.

use capsulemap::attractor::{Attractor, FinalMotion};
use capsulemap::capsule::branch::{self, Point, Request};
use capsulemap::capsule::{CapsuleSystem, Filippov, Parameter};
use capsulemap::flow::{Stroboscopic, System};
use capsulemap::orbit::matrix::{Matrix, solve};
use capsulemap::orbit::passage::{OneByOne, image};
use capsulemap::orbit::return_map::Cycles;
use capsulemap::orbit::{self, Machine, Outcome};
use capsulemap::run::{self, Attractors, Edge};
use capsulemap::study::Study;

use super::program::TWO_MOTIONS;

type Capsule = CapsuleSystem<Filippov>;
type Single = <Capsule as System<3>>::Single;

fn study(points: usize) -> Study {
    let axis = |name: &str, most: &str| {
        format!(
            "[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = {points}\n"
        )
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}");
    Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn edges(study: &Study) -> (Attractors, Vec<Edge>) {
    let machine = Machine::default();
    let chains: Vec<usize> = (0..study.chains()).collect();
    let records = run::run_sample(study, machine, &chains, || ()).expect("the study runs");
    let motions = run::final_motions(study, &records);
    let found = run::attractors(study, &motions, machine, || ()).expect("the threads start");
    let edges = run::edges(study, &found, machine);
    (found, edges)
}

/// A vector that a matrix turns into nearly itself times a number: inverse iteration.
fn eigenvector(matrix: &Matrix<3>, value: f64) -> [f64; 3] {
    let mut shifted = *matrix;
    (0..3).for_each(|i| shifted[i][i] -= value * (1.0 + 1e-9));
    let mut vector = [1.0, 1.0, 1.0];
    for _ in 0..5 {
        let next = solve(shifted, vector).expect("it is not singular to rounding");
        let size = next.iter().map(|it| it * it).sum::<f64>().sqrt();
        vector = next.map(|it| it / size);
    }
    vector
}

#[test]
fn starts_on_the_two_sides_of_a_saddle_lead_to_the_two_attractors() {
    let study = study(12);
    let (found, edges) = edges(&study);
    assert_eq!((found.of_starts.len(), edges.len()), (2, 1));
    let Edge { between, saddle } = &edges[0];
    assert_eq!((*between, saddle.points.len()), ([0, 1], 1));
    assert!(saddle.residual < 1e-12, "{:e}", saddle.residual);
    assert!(saddle.multipliers[0].abs() > 1.0 && saddle.multipliers[1].abs() < 1.0);
    let system: Capsule = study.case(0).read::<Filippov>().system;
    let cycles = Cycles { count: 1, tolerance: study.protocol.tolerance };
    let image = image(&OneByOne, &system, &saddle.points[0], &cycles).expect("it goes on");
    let unstable = eigenvector(&image.jacobian, saddle.multipliers[0].re);
    // A small push along the unstable direction decides, whichever its size.
    let metric = system.metric();
    let leads = |push: f64| {
        let point = std::array::from_fn(|i| saddle.points[0][i] + push * unstable[i]);
        let case = orbit::Case::new(system.clone(), Single::state(point));
        let settled = orbit::settle(&case, &study.protocol);
        let motion = FinalMotion::of(&settled, Single::point(&settled.end));
        let here = Attractor::of(0, &system, &motion, &study.protocol).expect("an attractor");
        assert_eq!(here.outcome, Outcome::Periodic);
        found.of_starts.iter().position(|known| known.is(&here, &metric)).expect("a known one")
    };
    for size in [1e-3, 1e-5, 1e-7] {
        let mut both = [leads(size), leads(-size)];
        both.sort_unstable();
        assert_eq!(both, [0, 1], "{size:e}");
    }
}

/// Between the two folds the branch of moving on comes back with orbits that repel: another method finds the same orbit.
#[test]
fn the_saddle_is_the_unstable_orbit_that_continuation_finds() {
    let study = study(8);
    let (found, edges) = edges(&study);
    let (case, moving) = (study.case(0), &found.of_starts[1]);
    let request = Request {
        parameters: case.parameters.clone(),
        phase: case.section_phase,
        section: moving.points[0],
        period: 1,
        along: Parameter::Omega,
        range: [150.0, 170.0],
        doublings: 0,
        second: None,
        longest_step: 0.005,
        most_points: 5000,
        tolerance: study.protocol.tolerance,
    };
    let followed = branch::follow(&request).expect("the orbit is continued");
    let omega = case.parameters[Parameter::Omega];
    let saddle = &edges[0].saddle;
    let crosses = |pair: &&[Point]| {
        let repels = pair.iter().all(|it| it.multipliers[0].abs() > 1.0);
        (pair[0].parameter - omega) * (pair[1].parameter - omega) <= 0.0 && repels
    };
    let crossings = followed.branches[0].points.windows(2).filter(crosses);
    let is_saddle = |pair: &[Point]| {
        let share = (omega - pair[0].parameter) / (pair[1].parameter - pair[0].parameter);
        (0..3).all(|i| {
            let [a, b] = [pair[0].section[0][i], pair[1].section[0][i]];
            (a + share * (b - a) - saddle.points[0][i]).abs() < 0.1 * (b - a).abs() + 1e-9
        })
    };
    assert!(crossings.filter(|pair| is_saddle(pair)).count() == 1, "{saddle:?}");
}
