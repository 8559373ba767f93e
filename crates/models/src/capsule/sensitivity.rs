//! How the section point and the outputs of a periodic orbit change with a parameter, exactly.

use crate::capsule::{Account, CapsuleSystem, Parameter, Reading, per_cycle};
use crate::motion::Sensitivity;
use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Dual;
use capsulemap_engine::orbit::matrix::{less_identity, solve};
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, observed, seeded};

/// Directions of the derivatives: the coordinates of the section, then the parameter.
const DIRECTIONS: usize = 4;
/// The place of the parameter among them.
const FREE: usize = 3;

/// The derivatives of the periodic orbit through `section`, of this `period` [cycles], in a parameter; none where the motion
/// cannot be followed, or where a multiplier is one, so that no orbit goes on there.
///
/// # Method
///
/// The motion is followed for a period in numbers with derivatives in the section point s and in the parameter p, events
/// included, and the sums of the outputs with it. The implicit function theorem on F(s, p) = s gives
/// ds/dp = (I - dF/ds)^-1 dF/dp, and each output Q(s, p) has dQ/dp + dQ/ds ds/dp.
///
/// # Assumes
///
/// The orbit is closed to rounding.
///
/// # Breaks
///
/// Where an event falls on another or a surface is only touched, outputs have a corner, and the slopes are those of the
/// side that the orbit takes.
pub fn sensitivity<R: Reading>(
    system: &CapsuleSystem<R>,
    (section, period): (&[f64; 3], u64),
    tolerance: f64,
    parameter: Parameter,
) -> Option<Sensitivity> {
    let of = |it: Parameter| -> Dual<f64, DIRECTIONS> {
        let value = system.value(it);
        if it == parameter { Dual::variable(value, FREE) } else { Dual::constant(value) }
    };
    let mut account = Account::new(of, 0);
    let cycles = Cycles { count: period, tolerance };
    let image = observed(&system.system(of), seeded(section), &cycles, &mut account).ok()?;
    let in_parameter = image.map(|it| -it.gradient[FREE]);
    let section_slope = solve(less_identity(&jacobian(&image)), in_parameter)?;
    let outputs = per_cycle(&account, of, period as f64);
    let total = |it: Dual<f64, DIRECTIONS>| {
        let by_section = section_slope.iter().zip(it.gradient).map(|(slope, by)| slope * by);
        it.gradient[FREE] + by_section.sum::<f64>()
    };
    Some(Sensitivity {
        outputs: outputs.map(|it| it.value).into(),
        section_slope: section_slope.into(),
        slopes: outputs.map(total).into(),
    })
}
