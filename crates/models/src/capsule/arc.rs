//! A short part of a motion, computed from where it begins.

use capsulemap_engine::flow::{Event as _, Stroboscopic};
use capsulemap_engine::lane::series;

use super::failure::Failure;
use super::filippov::Capsule;
use super::locomotion::Locomotion;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::printed::PrintedCapsule;
use super::resistance::Switching;
use super::simulate::trajectory;
use super::state::{EventKind, State};
use crate::description::Parameters;
use crate::motion::Case;

/// A point of an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcPoint {
    /// Time since the arc began [s].
    pub time: f64,
    /// Positions and velocities [m, m/s].
    pub state: State<f64>,
    /// Force of the drive [N].
    pub drive: f64,
}

/// The motion from `start`, while the phase of the drive goes from the first of `phases` to the second [rad], by less than
/// a cycle: at `count` even times, the last of which is its end, and at every event between, in the order of time.
pub fn arc(
    parameters: &Parameters,
    start: State<f64>,
    phases: [f64; 2],
    count: u32,
    tolerance: f64,
) -> Result<Vec<ArcPoint>, Failure> {
    let [start_phase, section_phase] = phases;
    let start = start.into();
    let case = Case { parameters: parameters.clone(), start, start_phase, section_phase };
    match parameters.switching() {
        Switching::Filippov => {
            arc_on(&Capsule::single(parameters, section_phase), &case, count, tolerance)
        }
        Switching::AsPrinted => {
            arc_on(&PrintedCapsule::single(parameters, section_phase), &case, count, tolerance)
        }
    }
}

fn arc_on<S: Locomotion<f64> + Stroboscopic<f64, 3>>(
    system: &S,
    case: &Case,
    count: u32,
    tolerance: f64,
) -> Result<Vec<ArcPoint>, Failure> {
    let begins = case.start_time();
    let between = (case.parameters.drive_period() - begins) / f64::from(count);
    let p_d = case.parameters[Parameter::Pd];
    let mut points = Vec::new();
    let mut next = 1;
    let mut trajectory = trajectory(case, system, tolerance);
    trajectory.cycle(|step| {
        let jet = system.jet(&step.jet);
        let mut put = |h: f64| {
            let time = step.start + h - begins;
            let drive = p_d * series::value(&jet.cos, h);
            points.push(ArcPoint { time, state: jet.state(h), drive });
        };
        // The last of the even times is the end, whatever rounding makes of it.
        while next < count && begins + f64::from(next) * between <= step.start + step.length {
            put((begins + f64::from(next) * between - step.start).max(0.0));
            next += 1;
        }
        let Some(event) = EventKind::from_code(step.event) else { return };
        put(step.length);
        // The series ends within rounding of zero, on either side: just before it rests or turns round, the capsule
        // still slides, and friction is that of sliding.
        if matches!(event, EventKind::Stick | EventKind::Reversal) {
            let at_end = points.len() - 1;
            points[at_end].state.y2 = system.direction(&step.mode) * f64::MIN_POSITIVE;
            if event == EventKind::Stick {
                let state = State { y2: 0.0, ..points[at_end].state };
                points.push(ArcPoint { state, ..points[at_end] });
            }
        }
    })?;
    let phase = case.section_phase;
    let end = ArcPoint {
        time: case.parameters.drive_period() - begins,
        state: trajectory.state(),
        drive: p_d * phase.cos(),
    };
    points.push(end);
    Ok(points)
}
