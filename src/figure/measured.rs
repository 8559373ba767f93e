//! Points of an experiment over a diagram of the same quantities.

use super::canvas::Canvas;
use super::cloud::Dot;
use super::error::FigureError;
use super::header::Mark;
use super::page::PanelRequest;
use super::panel::Panel;
use super::symbol::MEASURED;
use super::text::Text;
use super::view::View;

/// The measured points on the panels of a diagram, in the units of their axes.
pub struct MeasuredPoints {
    panels: Vec<Vec<(f64, f64)>>,
}

impl MeasuredPoints {
    /// The points of each of the `outputs` over the axis `x`; none where nothing was measured.
    ///
    /// Fails where the axis was not measured, or none of the outputs.
    pub fn over(
        view: &View<'_>,
        x: &str,
        outputs: &[String],
    ) -> Result<MeasuredPoints, FigureError> {
        let Some(measured) = view.measured else {
            return Ok(MeasuredPoints { panels: outputs.iter().map(|_| Vec::new()).collect() });
        };
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
        let of = |output: &String| {
            let factor = view.quantity(output).factor;
            let values = measured.column(output).unwrap_or(&[]);
            abscissae.iter().zip(values).map(|(x, y)| (x * x_factor, y * factor)).collect()
        };
        Ok(MeasuredPoints { panels: outputs.iter().map(of).collect() })
    }

    /// The abscissae of all points.
    pub fn abscissae(&self) -> impl Iterator<Item = f64> {
        self.panels.iter().flatten().map(|at| at.0)
    }

    /// The ordinates of the points on a panel.
    pub fn ordinates(&self, panel: usize) -> impl Iterator<Item = f64> {
        self.panels.get(panel).into_iter().flatten().map(|at| at.1)
    }

    /// The rows with what the points are in the legend of the first; `dots` are those of the simulation.
    pub fn with_legend(
        &self,
        mut rows: Vec<Vec<PanelRequest>>,
        dots: &[Vec<Vec<Dot>>],
    ) -> Vec<Vec<PanelRequest>> {
        let first = rows.first_mut().and_then(|row| row.first_mut());
        if let (Some(first), true) = (first, self.abscissae().next().is_some()) {
            let legend = &mut first.header.legend;
            let dot = dots.iter().flatten().flatten().next();
            if let (true, Some(dot)) = (legend.is_empty(), dot) {
                legend.push((Mark::Disc(dot.colour, 1.3), Text::plain("simulated")));
            }
            legend.push((Mark::Symbol(MEASURED), Text::plain(MEASURED.words)));
        }
        rows
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
        let all = self.panels.iter().zip(panels.iter().flatten());
        let outside = |(points, panel): (&Vec<(f64, f64)>, &Panel)| {
            points.iter().filter(|(x, y)| !panel.holds(*x, *y)).count()
        };
        match all.map(outside).sum() {
            0 => None,
            1 => Some("1 measured point lies outside the limits".to_owned()),
            count => Some(format!("{count} measured points lie outside the limits")),
        }
    }
}
