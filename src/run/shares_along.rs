//! The shares of the starts that lead to each attractor, along a parameter.

use super::room::Room;
use super::shock::shocks;
use super::{Attractors, FinalMotion, FinalMotions, Machine};
use crate::attractor::{Attractor, Integrity, Label, Share, shares_of_grid};
use crate::description::Section;
use crate::model::Setting;
use crate::orbit::Outcome;
use crate::study::layout::Layout;
use crate::study::{CaseSet, Study};

/// The attractors at one value of the parameter, by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct SharesAt {
    /// The part of the starts that lead to each.
    pub shares: Vec<Share>,
    /// Outcome and period of each, as its first case has them; none where no start leads to it.
    pub motions: Vec<Option<(Outcome, u32)>>,
    /// The room of the basin of each, where the starts lie along coordinates of the section.
    pub integrity: Vec<Option<Integrity>>,
    /// The minimal critical shock of each there [m/s]; NaN where none is known.
    pub shock: Vec<f64>,
}

/// The shares along the axis of a study of one parameter and of starts, one element for each value; none of any other study.
///
/// Attractors keep their numbers along the axis, see [`Attractors`].
pub fn shares_along(
    study: &Study,
    attractors: &Attractors,
    final_motions: &FinalMotions,
    machine: Machine,
) -> Option<Vec<SharesAt>> {
    let CaseSet::Grid(_) = &study.case_set else { return None };
    let layout = Layout::of(study);
    let axis = layout.axis.filter(|_| study.inherit().is_none())?;
    if layout.lines() != 1 || study.axes().len() < 2 {
        return None;
    }
    let mut shape = study.shape();
    shape.remove(axis);
    let count = attractors.of_case.iter().flatten().max().map_or(0, |most| *most as usize + 1);
    let at_value = |at: usize| {
        let case = |place: usize| layout.case(0, at, place);
        let label = |place: usize| attractors.label(case(place), final_motions);
        let motion = |number: usize| {
            let own = Label::Attractor(number as u32);
            let first = (0..layout.cases()).find(|place| label(*place) == own)?;
            Some((case(first), final_motions.get(case(first))?))
        };
        let found: Vec<_> = (0..count).map(motion).collect();
        let room = Room::of(study, case(0));
        let integrity = |number: usize| {
            found[number]?;
            Some(room.as_ref()?.around(number as u32, label))
        };
        let orbit = |(number, found): (usize, &Option<(usize, FinalMotion)>)| {
            let (case, motion) = (*found)?;
            Some((number as u32, attractor_of(study, case, &motion)?))
        };
        let orbits: Vec<_> = found.iter().enumerate().filter_map(orbit).collect();
        let known: Vec<_> = orbits.iter().map(|(number, it)| (*number, it)).collect();
        let mut shock = vec![f64::NAN; count];
        if room.is_some() {
            let found = shocks(study, case(0), &known, machine);
            orbits.iter().zip(found).for_each(|((number, _), it)| shock[*number as usize] = it);
        }
        SharesAt {
            shares: shares_of_grid(&shape, label, count),
            motions: found.iter().map(|it| it.map(|(_, it)| (it.outcome, it.period))).collect(),
            integrity: (0..count).map(integrity).collect(),
            shock,
        }
    };
    Some((0..layout.cells()).map(at_value).collect())
}

/// The attractor that a case has settled to, followed once more.
fn attractor_of(study: &Study, case: usize, motion: &FinalMotion) -> Option<Attractor<Section>> {
    let setting = Setting::of(&study.case(case));
    study.model().attractor(&setting, case, motion, &study.protocol)
}
