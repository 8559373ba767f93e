//! Points of an experiment over a diagram of the same quantities.

use super::canvas::Canvas;
use super::error::FigureError;
use super::header::{Entry, Mark};
use super::panel::Panel;
use super::symbol::MEASURED;
use super::text::Text;
use super::view::View;

/// The measured points on the panels of a diagram, in the units of their axes.
pub struct MeasuredPoints {
    panels: Vec<Vec<(f64, f64)>>,
}

impl MeasuredPoints {
    /// No points of any of the `outputs`.
    pub fn none(outputs: &[String]) -> MeasuredPoints {
        MeasuredPoints { panels: vec![Vec::new(); outputs.len()] }
    }

    /// Whether there are no points at all.
    pub fn is_empty(&self) -> bool {
        self.panels.iter().all(Vec::is_empty)
    }

    /// The points of each of the `outputs` over the axis `x`; none where nothing was measured.
    ///
    /// Fails where the axis was not measured, or none of the outputs.
    pub fn over(
        view: &View<'_>,
        x: &str,
        outputs: &[String],
    ) -> Result<MeasuredPoints, FigureError> {
        let Some(measured) = view.measured else { return Ok(MeasuredPoints::none(outputs)) };
        let names: Vec<&str> = measured.columns.iter().map(|it| it.0.as_str()).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        let Some(abscissae) = measured.column(x) else {
            let why = format!("the measured points have no column {x} (their columns: {names})");
            return Err(view.unfit(why));
        };
        if !outputs.iter().any(|output| measured.column(output).is_some()) {
            let outputs = outputs.join(", ");
            let why = format!(
                "the measured points have a column of none of {outputs} (their columns: {names})"
            );
            return Err(view.unfit(why));
        }
        let x_factor = view.quantity(x).factor;
        let mut panels = Vec::new();
        for output in outputs {
            let factor = view.quantity(output).factor;
            let both = abscissae.iter().zip(measured.column(output).unwrap_or(&[]));
            panels.push(both.map(|(x, y)| (x * x_factor, y * factor)).collect());
        }
        Ok(MeasuredPoints { panels })
    }

    /// The abscissae of all points.
    pub fn abscissae(&self) -> impl Iterator<Item = f64> {
        self.panels.iter().flatten().map(|at| at.0)
    }

    /// The ordinates of the points on a panel.
    pub fn ordinates(&self, panel: usize) -> impl Iterator<Item = f64> {
        self.panels.get(panel).into_iter().flatten().map(|at| at.1)
    }

    /// What the points are.
    pub fn legend() -> Entry {
        (Mark::Symbol(MEASURED), Text::plain(MEASURED.words))
    }

    /// Draws the points of a panel.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, index: usize) {
        let Some(points) = self.panels.get(index).filter(|it| !it.is_empty()) else { return };
        for place in panel.places(points) {
            MEASURED.draw(canvas, place);
        }
        let inside = points.iter().copied().filter(|(x, y)| panel.holds(*x, *y));
        panel.record(canvas, MEASURED.words, inside);
    }

    /// How many points lie outside the limits of their panels, in words.
    pub fn left_out(&self, panels: &[Vec<Panel>]) -> Option<String> {
        let mut outside = 0;
        for (points, panel) in self.panels.iter().zip(panels.iter().flatten()) {
            outside += points.iter().filter(|(x, y)| !panel.holds(*x, *y)).count();
        }
        match outside {
            0 => None,
            1 => Some("1 measured point lies outside the limits".to_owned()),
            count => Some(format!("{count} measured points lie outside the limits")),
        }
    }
}
