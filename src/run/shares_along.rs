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
    let values = 0..layout.cells();
    let starts =
        values.map(|at| StartsAt { study, layout: &layout, at, attractors, final_motions });
    Some(starts.map(|it| it.shares(&shape, count, machine)).collect())
}

/// The starts at one value of the parameter, by its place along the axis.
struct StartsAt<'a> {
    study: &'a Study,
    layout: &'a Layout,
    at: usize,
    attractors: &'a Attractors,
    final_motions: &'a FinalMotions,
}

impl StartsAt<'_> {
    /// The case of a start.
    fn case(&self, start: usize) -> usize {
        self.layout.case(0, self.at, start)
    }

    /// What a start leads to.
    fn label(&self, start: usize) -> Label {
        self.attractors.label(self.case(start), self.final_motions)
    }

    /// The first case that leads to an attractor, and what it has settled to.
    fn first_motion(&self, attractor: u32) -> Option<(usize, FinalMotion)> {
        let own = Label::Attractor(attractor);
        let first = self.case((0..self.layout.cases()).find(|start| self.label(*start) == own)?);
        Some((first, self.final_motions.get(first)?))
    }

    /// The shares of so many attractors among the starts, which lie on a grid of this shape.
    fn shares(&self, shape: &[usize], count: usize, machine: Machine) -> SharesAt {
        let found: Vec<_> = (0..count).map(|number| self.first_motion(number as u32)).collect();
        let room = Room::of(self.study, self.case(0));
        let integrity = found.iter().enumerate().map(|(number, found)| {
            found.as_ref()?;
            Some(room.as_ref()?.around(number as u32, |start| self.label(start)))
        });
        SharesAt {
            shares: shares_of_grid(shape, |start| self.label(start), count),
            motions: found.iter().map(|it| it.map(|(_, it)| (it.outcome, it.period))).collect(),
            integrity: integrity.collect(),
            shock: match room {
                Some(_) => self.shocks(&found, machine),
                None => vec![f64::NAN; count],
            },
        }
    }

    /// The minimal critical shock of each attractor that is `found`, by its first case; NaN where none is known.
    fn shocks(&self, found: &[Option<(usize, FinalMotion)>], machine: Machine) -> Vec<f64> {
        let orbits = (0..).zip(found).filter_map(|(number, found)| {
            let (case, motion) = (*found)?;
            Some((number, attractor_of(self.study, case, &motion)?))
        });
        let orbits: Vec<(u32, Attractor<Section>)> = orbits.collect();
        let known: Vec<_> = orbits.iter().map(|(number, it)| (*number, it)).collect();
        let mut all = vec![f64::NAN; found.len()];
        for ((number, _), shock) in
            known.iter().zip(shocks(self.study, self.case(0), &known, machine))
        {
            all[*number as usize] = shock;
        }
        all
    }
}

/// The attractor that a case has settled to, followed once more.
fn attractor_of(study: &Study, case: usize, motion: &FinalMotion) -> Option<Attractor<Section>> {
    let setting = Setting::of(&study.case(case));
    study.model().attractor(&setting, case, motion, &study.protocol)
}
