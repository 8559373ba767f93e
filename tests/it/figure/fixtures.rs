//! Synthetic results for the tests of figures.

use std::f64::consts::TAU;

use capsulemap::store::dataset::{Dataset, Values, Variable};
use ndarray::{ArrayD, IxDyn};

/// Names of the outcomes, by their number.
pub const OUTCOMES: [&str; 5] = ["periodic", "chaotic", "quasi-periodic", "undecided", "failed"];

fn variable(dimensions: &[&str], unit: &str, values: Values) -> Variable {
    Variable {
        dimensions: dimensions.iter().map(|name| name.to_string()).collect(),
        unit: unit.to_string(),
        long_name: String::new(),
        values,
        flags: Vec::new(),
    }
}

/// Synthetic results, built by adding one variable after the other.
#[derive(Clone, Default)]
pub struct Fixture(pub Dataset);

impl Fixture {
    pub fn coordinate(mut self, name: &str, unit: &str, values: Vec<f64>) -> Fixture {
        let values = ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).unwrap();
        let coordinate = variable(&[name], unit, Values::Real(values));
        self.0.coordinates.push((name.to_string(), coordinate));
        self
    }

    /// Both directions along an axis.
    pub fn directions(mut self) -> Fixture {
        let values = ArrayD::from_shape_vec(IxDyn(&[2]), vec![0, 1]).unwrap();
        let mut coordinate = variable(&["direction"], "1", Values::Integer(values));
        coordinate.flags = vec![(0, "upward".into()), (1, "downward".into())];
        self.0.coordinates.push(("direction".to_string(), coordinate));
        self
    }

    fn shape(&self, dimensions: &[&str]) -> Vec<usize> {
        let length = |name: &&str| self.0.coordinate(name).unwrap().values.shape()[0];
        dimensions.iter().map(length).collect()
    }

    /// A variable whose numbers `of` gives from the index along each dimension.
    pub fn real(
        mut self,
        name: &str,
        dimensions: &[&str],
        of: impl Fn(&[usize]) -> f64,
    ) -> Fixture {
        let shape = self.shape(dimensions);
        let array = ArrayD::from_shape_fn(IxDyn(&shape), |index| {
            of(&(0..shape.len()).map(|at| index[at]).collect::<Vec<_>>())
        });
        self.0.variables.insert(name.into(), variable(dimensions, "1", Values::Real(array)));
        self
    }

    pub fn integer(
        mut self,
        name: &str,
        dimensions: &[&str],
        flags: &[&str],
        of: impl Fn(&[usize]) -> i64,
    ) -> Fixture {
        let shape = self.shape(dimensions);
        let array = ArrayD::from_shape_fn(IxDyn(&shape), |index| {
            of(&(0..shape.len()).map(|at| index[at]).collect::<Vec<_>>())
        });
        let mut fixture = variable(dimensions, "1", Values::Integer(array));
        fixture.flags =
            flags.iter().enumerate().map(|(at, name)| (at as i64, name.to_string())).collect();
        self.0.variables.insert(name.into(), fixture);
        self
    }
}

pub fn steps(first: f64, last: f64, count: usize) -> Vec<f64> {
    let share = |at: usize| at as f64 / (count - 1).max(1) as f64;
    (0..count).map(|at| first + (last - first) * share(at)).collect()
}

/// A motion that looks like the capsule's: `omega` [rad/s] over `cycles`.
pub fn with_history(fixture: Fixture, axes: &[&str], cycles: f64, samples: usize) -> Fixture {
    let fixture = fixture.coordinate("history_time", "1", steps(0.0, cycles, samples));
    let times = steps(0.0, cycles, samples);
    let phase = move |index: &[usize]| TAU * times[index[index.len() - 1]];
    let case = |index: &[usize]| if index.len() > 1 { index[0] as f64 + 1.0 } else { 1.0 };
    let dimensions: Vec<&str> = axes.iter().copied().chain(["history_time"]).collect();
    let points: Vec<&str> = axes.iter().copied().chain(["point"]).collect();
    let impacts: Vec<&str> = axes.iter().copied().chain(["impact_point"]).collect();
    let p = phase.clone();
    let r = move |i: &[usize]| 1e-3 * (1.3 * p(i).cos() + 0.35 * (3.0 * p(i)).sin() + 0.15);
    let p = phase.clone();
    let y1 = move |i: &[usize]| -0.09 * p(i).sin() + 0.05 * (3.0 * p(i)).cos();
    let p = phase.clone();
    let y2 = move |i: &[usize]| case(i) * 0.02 * (p(i).sin() - 0.6).max(0.0);
    let p = phase;
    let x2 = move |i: &[usize]| {
        let cycle = p(i) / TAU;
        case(i) * 1e-4 * (cycle.floor() + (3.0 * cycle.fract()).min(1.0))
    };
    fixture
        .coordinate("point", "1", vec![0.0, 1.0])
        .coordinate("impact_point", "1", vec![0.0, 1.0, 2.0])
        .real("history_r", &dimensions, r)
        .real("history_y1", &dimensions, y1)
        .real("history_y2", &dimensions, y2)
        .real("history_x2", &dimensions, x2)
        .real("section_r", &points, |i| if i[i.len() - 1] == 0 { 1.45e-3 } else { f64::NAN })
        .real("section_y1", &points, |i| if i[i.len() - 1] == 0 { 0.05 } else { f64::NAN })
        .real("section_y2", &points, |_| 0.0)
        .real("impact_y1", &impacts, |i| [0.1, 0.04, f64::NAN][i[i.len() - 1]])
        .real("impact_y2", &impacts, |i| [0.0, 0.01, f64::NAN][i[i.len() - 1]])
        .real("delta", &[], |_| 1.5e-3)
}

/// A cascade of period doublings along the frequency, in both directions if asked for.
pub fn cascade(count: usize, points: usize, both_directions: bool) -> Dataset {
    let omega = steps(40.0, 70.0, count);
    let fixture = Fixture::default().coordinate("omega", "rad/s", omega.clone());
    let (fixture, axes) = match both_directions {
        true => (fixture.directions(), vec!["omega", "direction"]),
        false => (fixture, vec!["omega"]),
    };
    let with_points: Vec<&str> = axes.iter().copied().chain(["point"]).collect();
    let orbit = |index: &[usize]| {
        let shift = if both_directions && index[1] == 1 { 0.06 } else { 0.0 };
        let a = 2.8 + 1.2 * (index[0] as f64 / (count - 1).max(1) as f64) - shift;
        let mut x = 0.4;
        for _ in 0..300 + index[index.len() - 1] {
            x = a * x * (1.0 - x);
        }
        x
    };
    fixture
        .coordinate("point", "1", steps(0.0, points as f64 - 1.0, points))
        .real("section_r", &with_points, |i| 2e-3 * orbit(i) - 0.5e-3)
        .real("section_y1", &with_points, |i| 0.2 * orbit(i))
        .real("progression_speed", &axes, |i| {
            let x = i[0] as f64 / count as f64;
            let shift = if both_directions && i[1] == 1 { 0.8e-3 } else { 0.0 };
            let jump = if x > 0.55 - 150.0 * shift { 3e-3 } else { 0.0 };
            4e-3 * (x - 0.3) + jump + 0.4e-3 * (20.0 * x).sin() * x
        })
        .integer("outcome", &axes, &OUTCOMES, |i| if i[0] % 37 == 36 { 4 } else { 0 })
        .0
}

/// Smooth outputs over frequency and stiffness, with a region that failed and one that stands.
pub fn plane(columns: usize, rows: usize) -> Dataset {
    let omega = steps(20.0, 120.0, columns);
    let decades = steps(3.0, 5.0, rows);
    let k2 = decades.iter().map(|exponent| 10f64.powf(*exponent)).collect();
    let axes = ["omega", "k2"];
    let at = move |i: &[usize]| {
        (i[0] as f64 / (columns - 1).max(1) as f64, i[1] as f64 / (rows - 1).max(1) as f64)
    };
    let period = move |i: &[usize]| {
        let (x, y) = at(i);
        let value = (6.0 * x).sin() + (5.0 * y + 2.0 * x).cos();
        if x > 0.85 && y > 0.7 {
            return (0, 4);
        }
        match value {
            v if v > 1.5 => (0, 1),
            v if v > 1.3 => (12, 0),
            v if v > 1.1 => (8, 0),
            v if v > 0.8 => (4, 0),
            v if v > 0.4 => (2, 0),
            v if v < -1.3 => (3, 0),
            v if v < -1.1 => (0, 3),
            v if v < -1.0 => (0, 2),
            _ => (1, 0),
        }
    };
    Fixture::default()
        .coordinate("omega", "rad/s", omega)
        .coordinate("k2", "N/m", k2)
        .real("progression_speed", &axes, move |i| {
            let (x, y) = at(i);
            1e-3 * ((7.0 * x).sin() * 6.0 + 5.0 * (4.0 * y).cos() + 3.0 * x)
        })
        .real("work_positive", &axes, move |i| {
            let (x, y) = at(i);
            1e-3 * (2.0 + 8.0 * x * x + 3.0 * (1.0 - y) + 1.5 * (9.0 * x * y).sin())
        })
        .real("cost_of_transport", &axes, move |i| {
            let (x, y) = at(i);
            if x < 0.2 { f64::INFINITY } else { 0.5 + 200.0 * (x - 0.2).powi(4) / (0.05 + y) }
        })
        .integer("period", &axes, &[], move |i| period(i).0)
        .integer("outcome", &axes, &OUTCOMES, move |i| period(i).1)
        .0
}
