//! The saddles between the basins of a grid of starts.

use std::collections::BTreeMap;

use super::Attractors;
use crate::attractor::{Met, Saddle};
use crate::description::Section;
use crate::model::Setting;
use crate::orbit::{Machine, Outcome};
use crate::study::{CaseSet, Coordinate, Study};

/// So many pairs of basins are looked at.
const PAIRS: usize = 64;
/// So many pairs of neighbouring starts are tried for each, spread along their boundary on the grid, as long as a third basin
/// lies between the two.
const TRIES: usize = 8;

/// A saddle on the boundary of two basins.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// The two attractors to which the motions on the two sides of the boundary beside it lead, by their numbers, the lower first.
    pub between: [u32; 2],
    /// The orbit.
    pub saddle: Saddle<Section>,
}

/// Whether saddles between basins are looked for: on a grid of starts that lie at the phase of the section; without a drive they need
/// not lie on the section.
pub fn has_edges(study: &Study) -> bool {
    let is_grid = matches!(study.case_set, CaseSet::Grid(_));
    let in_section = study.case_set.varied().iter().all(|it| matches!(it, Coordinate::Start(_)));
    let at_section = study.base.model().has_drive() && study.start_phase == study.section_phase;
    is_grid && in_section && at_section
}

/// The saddles between the basins of a study, one at most for each two; none is looked for where an attractor does not repeat.
///
/// Method: between two neighbouring starts that lead to different attractors, see [`EdgeSearch::saddle`](crate::attractor::EdgeSearch::saddle). Two neighbouring starts
/// may have a third basin between them, thinner than the grid: what is met then is between one of the two and the third, and
/// counts as that, and other neighbours are tried for the two. Breaks: where a third basin lies between all that are tried.
pub fn edges(study: &Study, attractors: &Attractors, machine: Machine) -> Vec<Edge> {
    // What does not repeat is told apart less surely, and takes long to follow.
    let all_repeat = attractors.of_starts.iter().all(|it| it.outcome == Outcome::Periodic);
    if !has_edges(study) || attractors.of_starts.len() < 2 || !all_repeat {
        return Vec::new();
    }
    let setting = Setting::of(&study.case(0));
    let known: Vec<_> = (0..).zip(&attractors.of_starts).collect();
    let leads = study.model().leads(&setting, &study.protocol, machine, &known);
    let mut found = BTreeMap::new();
    let mut between_others = Vec::new();
    for (between, all) in neighbours(study, attractors).into_iter().take(PAIRS) {
        for cases in spread_out(&all) {
            let points = cases.map(|case| study.case(case).start.section());
            let Some(Met { mut sides, saddle }) = leads.saddle(points) else { break };
            sides.sort_unstable();
            if sides == between {
                found.insert(between, saddle);
                break;
            }
            between_others.push((sides, saddle));
        }
    }
    for (sides, saddle) in between_others {
        found.entry(sides).or_insert(saddle);
    }
    found.into_iter().map(|(between, saddle)| Edge { between, saddle }).collect()
}

/// Some of all, the first among them, spread evenly.
fn spread_out(all: &[[usize; 2]]) -> impl Iterator<Item = [usize; 2]> {
    let count = all.len().min(TRIES);
    (0..count).map(move |at| all[at * all.len() / count])
}

/// The neighbouring starts that lead to each two attractors, the start of the lower number first.
fn neighbours(study: &Study, attractors: &Attractors) -> BTreeMap<[u32; 2], Vec<[usize; 2]>> {
    let (shape, labels) = (study.shape(), &attractors.of_case);
    let mut found: BTreeMap<[u32; 2], Vec<[usize; 2]>> = BTreeMap::new();
    for start in 0..labels.len() {
        let mut spacing = labels.len();
        for &length in &shape {
            spacing /= length;
            let Some(&other) =
                labels.get(start + spacing).filter(|_| start / spacing % length + 1 < length)
            else {
                continue;
            };
            match (labels[start], other) {
                (Some(a), Some(b)) if a < b => {
                    found.entry([a, b]).or_default().push([start, start + spacing]);
                }
                (Some(a), Some(b)) if b < a => {
                    found.entry([b, a]).or_default().push([start + spacing, start]);
                }
                _ => {}
            }
        }
    }
    found
}
