//! The shares of the starts that lead to each attractor, along a parameter.

use crate::attractor::{Label, Share, shares_of_grid};
use crate::orbit::Outcome;
use crate::study::layout::Layout;
use crate::study::{CaseSet, Study};

use super::{Attractors, FinalMotions};

/// The attractors at one value of the parameter, by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct SharesAt {
    /// The part of the starts that lead to each.
    pub shares: Vec<Share>,
    /// Outcome and period of each, as its first case has them; none where no start leads to it.
    pub motions: Vec<Option<(Outcome, u32)>>,
}

/// The shares along the axis of a study of one parameter and of starts, one element for each value; none of any other study.
///
/// Attractors keep their numbers along the axis, see [`Attractors`].
pub fn shares_along(
    study: &Study,
    attractors: &Attractors,
    final_motions: &FinalMotions,
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
            final_motions.get(case(first)).map(|it| (it.outcome, it.period))
        };
        let motions = (0..count).map(motion).collect();
        SharesAt { shares: shares_of_grid(&shape, label, count), motions }
    };
    Some((0..layout.cells()).map(at_value).collect())
}
