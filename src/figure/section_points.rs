//! Section points of attractors and of saddles, as they are seen in a plane of starts.

use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::canvas::{Canvas, Stroke};
use super::geometry::Point;
use super::header::rimmed_disc;
use super::kind::Names;
use super::panel::Panel;
use super::plane::Plane;
use super::style::{INK, PAPER, POINT_RADIUS, POINT_RIM};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{ATTRACTOR_INDEX, Entry, Place, edges, section};
use crate::study::Coordinate;

/// What is read of the attractors.
pub fn reads(model: &'static Description) -> Names {
    let phases = Coordinate::phases(model).map(Entry::of_coordinate);
    Names::of(of_attractors(model)).and(phases)
}

/// The coordinates of the section points of attractors.
pub fn of_attractors(model: &'static Description) -> Vec<Entry> {
    section(model).into_iter().map(|entry| Place::Attractor.of(entry)).collect()
}

/// A section point of an attractor, in the units of the figure.
pub struct SectionPoint {
    at: (f64, f64),
    /// The colour of the attractor.
    pub colour: RGBColor,
}

/// The section points of the periodic attractors, by attractor, where the section is at the phase of the starts.
pub fn section_points(view: &View<'_>, plane: &Plane<'_>, colours: &Colours) -> Vec<SectionPoint> {
    let places = in_plane(view, plane, &of_attractors(view.model()));
    let attractors = view.coordinate_values(ATTRACTOR_INDEX.name).len();
    let cycles = (places.len() / attractors.max(1)).max(1);
    let mut points = Vec::new();
    for (place, at) in places.into_iter().enumerate() {
        points.push(SectionPoint { at, colour: colours.colour(place / cycles) });
    }
    points.retain(|point| is_finite(point.at));
    points
}

/// The section points of the saddles between basins, in the units of the figure.
pub fn saddles(view: &View<'_>, plane: &Plane<'_>) -> Vec<(f64, f64)> {
    let places = in_plane(view, plane, &edges(view.model()));
    places.into_iter().filter(|at| is_finite(*at)).collect()
}

fn is_finite(at: (f64, f64)) -> bool {
    at.0.is_finite() && at.1.is_finite()
}

/// Section points with these coordinates in the plane of the starts, in the units of the figure; none where the section is at
/// another phase than the starts.
pub fn in_plane(view: &View<'_>, plane: &Plane<'_>, coordinates: &[Entry]) -> Vec<(f64, f64)> {
    if !is_at_starts(view) {
        return Vec::new();
    }
    let columns: Vec<Vec<f64>> = coordinates.iter().map(|entry| view.column(*entry)).collect();
    let [x, y] = plane.names().map(|axis| along(view, axis, &columns));
    x.into_iter().zip(y).collect()
}

/// Whether the section is at the phase of the starts.
pub fn is_at_starts(view: &View<'_>) -> bool {
    let phases: Vec<Option<f64>> = Coordinate::phases(view.model())
        .map(|it| view.parameter(it.name(), &[]).ok()?.first().copied())
        .collect();
    !phases.contains(&None) && phases.first() == phases.last()
}

/// Where section points are along an axis of starts, in the unit of the figure, of the columns of their coordinates.
fn along(view: &View<'_>, axis: &str, columns: &[Vec<f64>]) -> Vec<f64> {
    let place = Coordinate::of_section(view.model()).position(|it| it.name() == axis);
    let factor = view.quantity(axis).factor;
    // What is no coordinate of the section is zero there.
    let points = columns.first().map_or(0, Vec::len);
    let values = place.map_or(vec![0.0; points], |place| columns[place].clone());
    values.into_iter().map(|value| value * factor).collect()
}

/// How many section points of attractors and of saddles lie behind others: the middle of one that is drawn later is on them.
pub fn behind(panel: &Panel, points: &[SectionPoint], saddles: &[(f64, f64)]) -> usize {
    let points = points.iter().map(|it| it.at).chain(saddles.iter().copied());
    let places: Vec<Point> = panel.places(&points.collect::<Vec<_>>());
    let is_behind = |(place, at): &(usize, &Point)| {
        places[place + 1..].iter().any(|it| (it.0 - at.0).hypot(it.1 - at.1) < POINT_RADIUS)
    };
    places.iter().enumerate().filter(is_behind).count()
}

/// Draws section points, those of each attractor in its colour.
pub fn draw_section_points(canvas: &mut Canvas, panel: &Panel, points: &[SectionPoint]) {
    canvas.clipped(panel.frame, |canvas| {
        for point in points {
            let at = panel.place(point.at.0, point.at.1);
            rimmed_disc(canvas, at, point.colour);
        }
    });
    panel.record(canvas, "section points of the attractors", points.iter().map(|it| it.at));
}

/// Draws the section points of saddles: rings on paper, as they belong to no basin.
pub fn draw_saddles(canvas: &mut Canvas, panel: &Panel, saddles: &[(f64, f64)]) {
    canvas.clipped(panel.frame, |canvas| {
        for (x, y) in saddles {
            let at = panel.place(*x, *y);
            canvas.discs(&[(at, PAPER)], POINT_RADIUS + POINT_RIM);
            canvas.rings(&[at], POINT_RADIUS, Stroke::solid(INK, 2.0 * POINT_RIM));
        }
    });
}
