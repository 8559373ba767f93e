//! The manifolds of the saddles between the basins of a grid of starts over two coordinates of the section.

use super::Attractors;
use super::edge::{Edge, has_edges};
use crate::attractor::{Manifolds, Plane, Saddle};
use crate::description::Section;
use crate::model::Setting;
use crate::orbit::{Machine, Outcome};
use crate::study::{Coordinate, Study};

/// The curves on which the basins of a study meet, and the unstable manifolds of their saddles, which are those among `edges`; those that
/// are met beside are added to them. None where the study does not ask for them, or an attractor does not repeat.
///
/// Method: see [`ManifoldSearch`](crate::attractor::ManifoldSearch). Inferred starts count as those that are computed. `begins` is
/// called before the search, with the number of saddles, as it is long and tells nothing until it is done.
pub fn manifolds(
    study: &Study,
    attractors: &Attractors,
    edges: &mut Vec<Edge>,
    machine: Machine,
    begins: impl FnOnce(usize),
) -> Option<Manifolds<Section>> {
    let all_repeat = attractors.of_starts.iter().all(|it| it.outcome == Outcome::Periodic);
    if !study.manifolds || !has_edges(study) || !all_repeat {
        return None;
    }
    let setting = Setting::of(&study.case(0));
    let known: Vec<_> = (0..).zip(&attractors.of_starts).collect();
    let leads = study.model().leads(&setting, &study.protocol, machine, &known);
    let saddles: Vec<Saddle<Section>> = edges.iter().map(|it| it.saddle.clone()).collect();
    begins(saddles.len());
    let mut found = leads.manifolds(&plane(study)?, &attractors.of_case, &saddles);
    let mut places = Vec::new();
    for met in &found.saddles {
        let known = edges.iter().position(|it| it.saddle.points == met.saddle.points);
        places.push(known.unwrap_or_else(|| {
            let mut between = met.sides;
            between.sort_unstable();
            edges.push(Edge { between, saddle: met.saddle.clone() });
            edges.len() - 1
        }));
    }
    for curve in &mut found.stable {
        curve.saddle = curve.saddle.map(|place| places[place]);
    }
    for branch in &mut found.unstable {
        branch.saddle = places[branch.saddle];
    }
    Some(found)
}

/// The plane of the starts of a grid of two axes.
fn plane(study: &Study) -> Option<Plane<Section>> {
    let [first, second] = study.axes() else { return None };
    let (first, second) = (first.single()?, second.single()?);
    let all = Coordinate::of_section(study.base.model());
    let places = [first, second].map(|axis| all.clone().position(|it| it == axis.coordinate));
    Some(Plane {
        origin: study.case(0).start.section(),
        places: [places[0]?, places[1]?],
        values: [first.values.clone(), second.values.clone()],
    })
}
