//! The linearised flow, jumps included, against differences of the flow itself and against laws.

use capsulemap::lane::Dual;
use capsulemap::model::{Capsule, Parameter, Parameters, State};
use capsulemap::orbit::matrix::Matrix;
use capsulemap::orbit::return_map::{Cycles, jacobian, returned, seeded};
use capsulemap::orbit::{Case, Outcome, Protocol, Section, Trajectory, settle};

use super::draws;

/// Tight enough that differences of the map see its slope rather than its rounding.
const TOLERANCE: f64 = 1e-15;

/// The section point after `k` cycles, without derivatives.
fn image(case: &Case, point: Section, k: u64) -> Section {
    let system = Capsule::single(&case.parameters, case.phase);
    let [r, y1, y2] = point;
    let period = case.parameters.drive_period();
    let mut trajectory =
        Trajectory::new(&system, State { r, y1, x2: 0.0, y2 }, period, TOLERANCE);
    for _ in 0..k {
        trajectory.cycle(|_| ()).expect("it goes on");
    }
    trajectory.section()
}

/// The Jacobian of the k-cycle map by the linearised flow.
fn linearised(case: &Case, point: &Section, k: u64) -> Matrix<3> {
    let p = &case.parameters;
    let system = Capsule::<Dual<f64, 3>>::new(|q| Dual::constant(p[q]), p.resistance, case.phase);
    let cycles = Cycles {
        drive_period: Dual::constant(p.drive_period()),
        count: k,
        tolerance: TOLERANCE,
    };
    jacobian(&returned(&system, seeded(point), &cycles, |_| ()).expect("it goes on"))
}

/// The derivative along coordinate `j` by central differences at two widths, extrapolated.
fn difference(case: &Case, point: &Section, k: u64, j: usize, width: f64) -> Section {
    let at = |h: f64| {
        let mut moved = *point;
        moved[j] += h;
        image(case, moved, k)
    };
    let central = |h: f64| -> Section {
        let (ahead, behind) = (at(h), at(-h));
        std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * h))
    };
    let (wide, narrow) = (central(width), central(0.5 * width));
    std::array::from_fn(|i| (4.0 * narrow[i] - wide[i]) / 3.0)
}

#[test]
fn dbg_jacobians() {
    let mut done = 0;
    for case in draws::cases(200, 9) {
        let orbit = settle(&case.parameters, case.phase, case.start, &Protocol::default());
        if orbit.outcome != Outcome::Periodic { continue; }
        let State { r, y1, y2, .. } = orbit.end;
        let point = [r, y1, y2];
        let k = orbit.period;
        let omega = case.parameters[Parameter::Omega];
        let exact = linearised(&case, &point, k);
        let scale = (omega * r).abs().max(y1.abs()).max(y2.abs());
        let weights = [omega, 1.0, 1.0];
        for j in 0..3 {
            if j == 2 && y2 == 0.0 { continue; }
            let mut best = f64::INFINITY;
            for e in [1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7,1e-8] {
            let fd = difference(&case, &point, k, j, e * scale / weights[j]);
            let norm = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| (exact[i][j] * weights[i] / weights[j]).abs()).fold(0.0, f64::max);
            let err = (0..3).map(|i| ((fd[i] - exact[i][j]) * weights[i] / weights[j]).abs()).fold(0.0, f64::max);
            if [39,70,88,80].contains(&done) {println!("{done} {e:e} {:e} margin {:e} stick {}", err/norm, orbit.outputs[capsulemap::orbit::Output::GrazingMargin], orbit.outputs[capsulemap::orbit::Output::StickShare]);} best=best.min(err/norm);
            }
            if best > 1e-2 {println!("case {done} k {k} j {j} err {best:e} {exact:?}");}
        }
        done += 1;
    }
    let _ = Parameters::default();
}
