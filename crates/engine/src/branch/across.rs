//! Where an event passes the instant of the section: the section point jumps there, and the orbit goes on.

use crate::flow::{Stroboscopic, Switched, System};
use crate::lane::{Lane, Mask};
use crate::orbit::Varied;
use crate::orbit::return_map::{Cycles, returned};

use super::arclength::{CurvePoint, Equations, dot, norm, unit};
use super::family::Family;
use super::scales::seeded;
use super::step_control::{Advance, StepControl};

/// An event this close to the instant of the section may pass it in the next step, as a share of a cycle.
const NEAR: f64 = 1e-5;
/// The section point jumps if it moves by more than this, relative to the motion: by its restitution, an impact.
const JUMPS: f64 = 1e-3;
/// How far beyond the instant of the section the first orbit may lie, relative to the longest step.
const BEYOND: [f64; 6] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];

/// A section point on the other side of the event that lies next to the instant of the section.
#[derive(Debug, Clone, Copy)]
struct Across<L, const D: usize> {
    /// The point: the field before the event continued beyond it, or the field after it continued back.
    point: [L; D],
    /// The time of the event after the section; negative before it [s].
    time: L,
}

impl<L: Lane, const D: usize> Across<L, D> {
    /// How far the event is from the instant of the section [s].
    fn away(&self) -> f64 {
        self.time.lane(0).abs()
    }

    fn keep_if_nearer(self, nearest: &mut Option<Self>) {
        if nearest.as_ref().is_none_or(|known| self.away() < known.away()) {
            *nearest = Some(self);
        }
    }
}

impl<M: System<D>, const D: usize> Family<M, D> {
    /// The other side of the event that lies nearest to the instant of the section, if one is near.
    fn across<L: Lane>(&self, point: [L; D], free: &[(M::Parameter, L)]) -> Option<Across<L, D>> {
        if M::In::<L>::AUTONOMOUS {
            return None;
        }
        let system = self.with_free(free);
        let period = system.period();
        let near = NEAR * period.lane(0);
        let mut nearest: Option<Across<L, D>> = None;
        let (mut cycle, mut begun_with) = (1, None);
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let end = returned(&system, point, &cycles, |step| {
            if let Some(time) = begun_with.take() {
                let point = M::In::<L>::point(&system.at(&step.jet, -step.start));
                Across { point, time }.keep_if_nearer(&mut nearest);
            }
            let at_end = step.start + step.length;
            let left = period - at_end;
            if step.event.lane(0) > 0.0 && cycle == 1 && at_end.lane(0) < near {
                begun_with = Some(at_end);
            }
            if step.event.lane(0) > 0.0 && cycle == self.period && left.lane(0) < near {
                let point = M::In::<L>::point(&system.at(&step.jet, step.length + left));
                Across { point, time: -left }.keep_if_nearer(&mut nearest);
            }
            cycle += u64::from(step.arrives.lane(0));
        });
        end.ok().and(nearest)
    }
}

/// Solutions whose first unknowns are a section point and whose last ones are parameters.
#[derive(Debug, Clone, Copy)]
pub struct Unknowns<'a, M: System<D>, const D: usize, const U: usize> {
    /// The motions.
    pub family: &'a Family<M, D>,
    /// Units of the unknowns.
    pub units: &'a [f64; U],
    /// What the parameters among them vary, in turn.
    pub free: &'a [Varied<M::Parameter>],
}

/// The first solution beyond the instant of the section, where the curve reaches it with an event that moves the
/// section point.
///
/// Method: the orbit from the section point on the other side of the event is the same orbit; the direction of the
/// curve there is that of its derivatives along the curve.
pub fn across_section<M: System<D>, E: Equations<U>, const D: usize, const U: usize>(
    equations: &E,
    unknowns: &Unknowns<'_, M, D, U>,
    control: &StepControl<U>,
    last: &CurvePoint<U, E::Seen>,
) -> Option<Advance<CurvePoint<U, E::Seen>>> {
    let Unknowns { family, units, free } = unknowns;
    let seeded = seeded(&last.at, units);
    let point = std::array::from_fn(|i| seeded[i]);
    let free = free.iter().enumerate().flat_map(|(i, it)| it.at(seeded[D + i]));
    let free: Vec<_> = free.collect();
    let Across { point, time } = family.across(point, &free)?;
    let (mut at, mut ahead) = (last.at, last.tangent);
    let mut jump: f64 = 0.0;
    for i in 0..D {
        at[i] = point[i].value / units[i];
        ahead[i] = dot(&point[i].gradient, &last.tangent) / units[i];
        jump = jump.max((at[i] - last.at[i]).abs());
    }
    // The event comes to the instant of the section after this length along the curve.
    let away = -time.value / dot(&time.gradient, &last.tangent);
    if jump < JUMPS || away.is_nan() || away < -BEYOND[0] * control.longest {
        return None;
    }
    let away = away.max(0.0) * norm(&ahead);
    let start = CurvePoint { at, tangent: unit(&ahead), ..last.clone() };
    BEYOND.into_iter().find_map(|beyond| {
        let length = away + beyond * control.longest;
        control.attempt(equations, &start, length).map(|(advance, _)| advance)
    })
}
