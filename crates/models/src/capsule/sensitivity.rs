//! How the section point and the outputs of a periodic orbit change with a parameter, exactly.

use crate::capsule::{
    Account, CapsuleParameters as _, CapsuleSystem, Parameter, Reading, per_cycle,
};
use crate::motion::Sensitivity;
use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Dual;
use capsulemap_engine::orbit::matrix::{less_identity, solve};
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, observed, seeded};

/// Directions of the derivatives: the coordinates of the section, then the parameter.
const DIRECTIONS: usize = 5;
/// The place of the parameter among them, behind that of every section.
const FREE: usize = 4;

/// The derivatives of the periodic orbit through `section`, whose period is `cycles`, in a parameter; none where the motion
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
pub fn sensitivity<R: Reading<D>, const D: usize>(
    system: &CapsuleSystem<R>,
    section: &[f64; D],
    cycles: Cycles,
    parameter: Parameter,
) -> Option<Sensitivity> {
    let of = Seeded { system, free: parameter };
    let shape = system.parameters.shape();
    let mut account = Account::new(|it| of.value(it), shape, 0);
    let lane = system.system(|it| of.value(it));
    let image = observed(&lane, seeded(section), &cycles, &mut account).ok()?;
    let in_parameter = image.map(|it| -it.gradient[FREE]);
    let section_slope = solve(less_identity(&jacobian(&image)), in_parameter)?;
    let outputs = per_cycle(&account, |it| of.value(it), shape, cycles.count as f64);
    let slopes = outputs.map(|it| {
        let by_section = section_slope.iter().zip(it.gradient).map(|(slope, by)| slope * by);
        it.gradient[FREE] + by_section.sum::<f64>()
    });
    Some(Sensitivity {
        outputs: R::told(&outputs.map(|it| it.value)),
        section_slope: section_slope.into(),
        slopes: R::told(&slopes),
    })
}

/// The parameters of a capsule, of which the derivatives in one are followed.
struct Seeded<'s, R, const D: usize> {
    system: &'s CapsuleSystem<R>,
    free: Parameter,
}

impl<R: Reading<D>, const D: usize> Seeded<'_, R, D> {
    fn value(&self, parameter: Parameter) -> Dual<f64, DIRECTIONS> {
        let value = self.system.value(parameter);
        if parameter == self.free { Dual::variable(value, FREE) } else { Dual::constant(value) }
    }
}
