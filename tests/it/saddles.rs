//! The saddles between basins: unstable orbits on the boundary, as starts beside them show, and those that continuation finds.

use capsulemap::capsule::branch::{self, Point, Request};
use capsulemap::capsule::{CapsuleSystem, Case, Filippov, Output, Parameter, State, settle_case};
use capsulemap::flow::System;
use capsulemap::model::Setting;
use capsulemap::orbit::matrix::{Matrix, solve};
use capsulemap::orbit::passage::{OneByOne, image};
use capsulemap::orbit::return_map::Cycles;
use capsulemap::orbit::{Machine, Outcome};
use capsulemap::run::{self, Attractors, Edge};
use capsulemap::study::Study;

use super::program::TWO_MOTIONS;
use capsulemap::attractor::Attractor;
use capsulemap::description::Section;

type Capsule = CapsuleSystem<Filippov>;

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

/// The attractors to which a small push along the unstable direction of a saddle leads, either way, whichever its size.
fn pushed(study: &Study, found: &Attractors, edge: &Edge) -> [u32; 2] {
    let saddle = &edge.saddle;
    let Setting { parameters, phase } = Setting::of(&study.case(0));
    let system = Capsule::new(parameters, phase);
    let count = saddle.points.len() as u64;
    let cycles = Cycles { count, tolerance: study.protocol.tolerance };
    let image = image(&OneByOne, &system, &saddle.points[0].array(), &cycles).expect("it goes on");
    let unstable = eigenvector(&image.jacobian, saddle.multipliers[0].re);
    let metric = system.metric();
    let of_engine = |it: &Attractor<Section>| it.clone().map(|point| point.array());
    let leads = |push: f64| {
        let point: [f64; 3] = std::array::from_fn(|i| saddle.points[0][i] + push * unstable[i]);
        let [r, y1, y2] = point;
        let case = Case { start: State::of([r, y1, 0.0, y2]).into(), ..study.case(0) };
        let motion = run::final_motion(&settle_case(&case, &study.protocol));
        let met = study.model().attractor(&Setting::of(&case), 0, &motion, &study.protocol);
        let here = met.expect("an attractor");
        assert_eq!(here.outcome, Outcome::Periodic);
        let place = found
            .of_starts
            .iter()
            .position(|known| of_engine(known).is(&of_engine(&here), &metric));
        place.expect("a known one") as u32
    };
    let of_size = [1e-3, 1e-5, 1e-7].map(|size| {
        let mut both = [leads(size), leads(-size)];
        both.sort_unstable();
        both
    });
    assert!(of_size.iter().all(|it| *it == of_size[0]), "{of_size:?}");
    of_size[0]
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
    assert_eq!(pushed(&study, &found, &edges[0]), [0, 1]);
}

/// The speed of what a section point leads to [m/s].
fn speed(study: &Study, [r, y1, y2]: [f64; 3]) -> f64 {
    let case = Case { start: State::of([r, y1, 0.0, y2]).into(), ..study.case(0) };
    let orbit = settle_case(&case, &study.protocol);
    assert_eq!(orbit.outcome, Outcome::Periodic);
    orbit.outputs[Output::ProgressionSpeed]
}

#[test]
fn a_saddle_names_the_attractors_of_its_own_boundary_among_three() {
    // Some neighbours of this grid have the third basin between them, as a strip thinner than the grid.
    let text = std::fs::read_to_string("studies/three-ways.toml").expect("the study");
    let text = text.replace("points = 1000", "points = 100").replace("refine = true", "");
    let study = Study::parse("three-ways.toml", &text).unwrap_or_else(|faults| panic!("{faults}"));
    let (found, edges) = edges(&study);
    assert_eq!((found.of_starts.len(), study.cases()), (3, 10_000));
    // A push of the mass alone, which is no eigenvector, crosses the boundary, too; the orbit that follows tells the side by its
    // speed, without sections and metrics.
    let speeds: Vec<f64> =
        found.of_starts.iter().map(|it| speed(&study, it.points[0].array())).collect();
    for edge in &edges {
        let [r, y1, y2] = edge.saddle.points[0].array();
        let sides = [1e-5, -1e-5].map(|push| {
            let here = speed(&study, [r, y1 + push, y2]);
            let place = speeds.iter().position(|it| (it - here).abs() < 1e-9);
            place.expect("a known attractor") as u32
        });
        let sides = [sides[0].min(sides[1]), sides[0].max(sides[1])];
        assert_eq!(sides, edge.between, "{edge:?}");
        assert_eq!(pushed(&study, &found, edge), edge.between, "{edge:?}");
    }
    let pairs: Vec<[u32; 2]> = edges.iter().map(|edge| edge.between).collect();
    assert_eq!(pairs, [[0, 2], [1, 2]]);
    // No saddle stands for two boundaries.
    let firsts: Vec<[f64; 3]> = edges.iter().map(|edge| edge.saddle.points[0].array()).collect();
    for (i, a) in firsts.iter().enumerate() {
        let is_same = |b: &[f64; 3]| (0..3).all(|at| (a[at] - b[at]).abs() < 1e-9);
        assert!(!firsts[..i].iter().any(is_same), "{edges:?}");
    }
}

/// Between the two folds the branch of moving on comes back with orbits that repel: another method finds the same orbit.
#[test]
fn the_saddle_is_the_unstable_orbit_that_continuation_finds() {
    let study = study(8);
    let (found, edges) = edges(&study);
    let (case, moving) = (study.case(0), &found.of_starts[1]);
    let request = Request {
        setting: Setting::of(&case),
        section: moving.points[0],
        period: 1,
        along: Parameter::Omega.into(),
        range: [150.0, 170.0],
        doublings: 0,
        second: None,
        curve_range: None,
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
