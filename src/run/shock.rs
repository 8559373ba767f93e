//! The minimal critical shocks of the attractors of a grid of starts.

use crate::attractor::Attractor;
use crate::description::Section;
use crate::model::Setting;
use crate::orbit::{Machine, Outcome};
use crate::study::Study;

/// Section points that are disturbed; of an orbit of a longer period no shock is told.
const MOST_POINTS: usize = 16;

/// The minimal critical shock of each of some attractors of the system of `case`, by their numbers [m/s]; NaN of a
/// period of more than 16 cycles, where only one attractor is known, and of all where one of them does not repeat.
///
/// A disturbance is one of omega r, y1 and y2 together at the section, where the motion may be disturbed at any of its section
/// points.
pub(super) fn shocks(
    study: &Study,
    case: usize,
    known: &[(u32, &Attractor<Section>)],
    machine: Machine,
) -> Vec<f64> {
    // What does not repeat is told apart less surely, and takes long to follow.
    if known.iter().any(|(_, it)| it.outcome != Outcome::Periodic) {
        return vec![f64::NAN; known.len()];
    }
    let setting = Setting::of(&study.case(case));
    let leads = study.model().leads(&setting, &study.protocol, machine, known);
    let shocks = known.iter().map(|(number, attractor)| {
        if !(1..=MOST_POINTS).contains(&attractor.points.len()) {
            return None;
        }
        // To a section point of any other attractor is a shock.
        let mut others = known.iter().filter(|(other, _)| other != number);
        let first = others.find_map(|(_, other)| other.points.first())?;
        leads.shock(*number, &attractor.points, first)
    });
    shocks.map(|shock| shock.unwrap_or(f64::NAN)).collect()
}
