//! The manifolds of the saddles between basins, as they are seen in the plane of the starts.

use super::canvas::{Canvas, Dash, Stroke};
use super::header::{self, Mark};
use super::kind::Names;
use super::panel::Panel;
use super::plane::Plane;
use super::style::{INK, REFERENCE_WIDTH};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    BOUNDARY_CROSSINGS, BOUNDARY_UNCOVERED, Entry, Place, STABLE_POINT_CURVE,
    UNSTABLE_POINT_BRANCH, section,
};
use crate::study::Coordinate;

/// The line on which two basins meet.
const STABLE: Stroke = Stroke { colour: INK, width: 0.8, dash: Dash::None };
/// The line of an unstable manifold.
const UNSTABLE: Stroke = Stroke { colour: INK, width: REFERENCE_WIDTH, dash: Dash::Mixed };

/// What is read of the manifolds.
pub fn reads(model: &'static Description) -> Names {
    let stable = Coordinate::of_section(model).map(|it| Place::Stable.of(Entry::of_coordinate(it)));
    let unstable = section(model).into_iter().map(|entry| Place::Unstable.of(entry));
    let fixed = [STABLE_POINT_CURVE, UNSTABLE_POINT_BRANCH, BOUNDARY_CROSSINGS, BOUNDARY_UNCOVERED];
    Names::of(fixed).and(stable).and(unstable)
}

/// The curves in the units of the figure, those of each manifold apart by a point that is no number.
pub struct Curves {
    /// The boundary.
    pub stable: Vec<(f64, f64)>,
    /// The unstable manifolds.
    pub unstable: Vec<(f64, f64)>,
    /// Pairs of neighbouring starts that lead to two attractors, and those that have no curve beside them.
    crossings: [usize; 2],
    /// Whether the unstable manifolds lie in more dimensions than the plane has.
    is_projected: bool,
}

impl Curves {
    /// None.
    pub fn none() -> Curves {
        Curves { stable: Vec::new(), unstable: Vec::new(), crossings: [0, 0], is_projected: false }
    }

    /// Those of the results.
    pub fn of(view: &View<'_>, plane: &Plane<'_>) -> Curves {
        let model = view.model();
        let coordinates: Vec<Coordinate> = Coordinate::of_section(model).collect();
        let places = plane.names().map(|name| coordinates.iter().position(|it| it.name() == name));
        let [Some(x), Some(y)] = places else { return Curves::none() };
        let of_starts = [x, y].map(|it| Place::Stable.of(Entry::of_coordinate(coordinates[it])));
        let sections = section(model);
        let of_section = [x, y].map(|it| Place::Unstable.of(sections[it]));
        let factors = plane.names().map(|name| view.quantity(name).factor);
        let count = |entry: Entry| view.column(entry).first().map_or(0, |it| *it as usize);
        Curves {
            stable: apart(
                &view.column(STABLE_POINT_CURVE),
                of_starts.map(|it| view.column(it)),
                factors,
            ),
            unstable: apart(
                &view.column(UNSTABLE_POINT_BRANCH),
                of_section.map(|it| view.column(it)),
                factors,
            ),
            crossings: [BOUNDARY_CROSSINGS, BOUNDARY_UNCOVERED].map(count),
            is_projected: coordinates.len() > 2,
        }
    }

    /// What the lines mean, and which part of the boundary is none.
    pub fn legend(&self) -> Vec<header::Entry> {
        let mut legend = Vec::new();
        if !self.stable.is_empty() {
            legend.push((Mark::Line(STABLE), Text::plain("boundary as a curve")));
        }
        if !self.unstable.is_empty() {
            let more = if self.is_projected { ", projected onto the plane" } else { "" };
            let words = format!("unstable manifolds of the saddles{more}");
            legend.push((Mark::Line(UNSTABLE), Text::plain(&words)));
        }
        legend.extend(self.shortfall().map(|it| (Mark::Nothing, Text::plain(&it))));
        legend
    }

    /// Which part of the boundary has no curve beside it, if there is such a part.
    pub fn shortfall(&self) -> Option<String> {
        let [all, uncovered] = self.crossings;
        let told = || {
            format!(
                "boundary not resolved as curves: {uncovered} of {all} pairs of neighbouring starts"
            )
        };
        (uncovered > 0).then(told)
    }

    /// What the curves are, in words; none where there are none.
    pub fn about(&self) -> Vec<String> {
        let curves = (!self.stable.is_empty()).then(|| "the boundary as curves".to_owned());
        curves.into_iter().chain(self.shortfall()).collect()
    }

    /// Draws them.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        panel.curve(canvas, &self.unstable, UNSTABLE);
        panel.curve(canvas, &self.stable, STABLE);
        panel.record(canvas, "boundary as a curve", self.stable.iter().copied());
        panel.record(canvas, "unstable manifolds of the saddles", self.unstable.iter().copied());
    }
}

/// Points in the units of the figure, with one that is no number where the next belongs to another curve.
fn apart(curves: &[f64], columns: [Vec<f64>; 2], factors: [f64; 2]) -> Vec<(f64, f64)> {
    let [x, y] = columns;
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(curves.len());
    for (place, (x, y)) in x.iter().zip(&y).enumerate() {
        if place > 0 && curves[place] != curves[place - 1] {
            points.push((f64::NAN, f64::NAN));
        }
        points.push((x * factors[0], y * factors[1]));
    }
    points
}
