//! Cases that have no period, along the upper side of a panel of periods: a period of 0 would be a number among numbers.

use super::canvas::{Canvas, Stroke};
use super::category;
use super::error::FigureError;
use super::header::{Entry, Mark};
use super::outcome::Outcomes;
use super::panel::Panel;
use super::style::{CURVE_WIDTH, INK};
use super::text::Text;
use super::view::View;
use crate::store::catalogue::PERIOD;

/// Length of a mark, from the frame inward [pt].
const LENGTH: f64 = 6.0;
/// Outcomes without a period.
const KINDS: [&str; 3] = ["chaotic", "quasi-periodic", "undecided"];

/// The cases without a period: their abscissae, and the places of their outcomes among [`KINDS`].
#[derive(Default)]
pub struct WithoutPeriod {
    cases: Vec<(f64, usize)>,
}

impl WithoutPeriod {
    /// Those of a diagram of `outputs`, of cases over the axes `free` that each have an abscissa where they are seen; none where the
    /// period is not among the outputs.
    pub fn of(
        view: &View<'_>,
        free: &[&str],
        outputs: &[String],
        abscissae: impl Iterator<Item = Option<f64>>,
    ) -> Result<WithoutPeriod, FigureError> {
        let mut found = WithoutPeriod::default();
        if !outputs.iter().any(|output| output == PERIOD.name) {
            return Ok(found);
        }
        let outcomes = Outcomes::over(view, free)?;
        for (case, x) in abscissae.enumerate() {
            let kind = KINDS.iter().position(|name| outcomes.name(case) == Some(name));
            found.cases.extend(x.zip(kind));
        }
        Ok(found)
    }

    /// What the marks mean.
    pub fn legend(&self) -> impl Iterator<Item = Entry> {
        let present = |kind: usize| self.cases.iter().any(|it| it.1 == kind);
        let kinds = KINDS.into_iter().enumerate().filter(move |(kind, _)| present(*kind));
        kinds
            .map(|(_, name)| (Mark::Tick(stroke(name)), Text::plain(&format!("{name}: no period"))))
    }

    /// Draws the marks at the upper side of a panel of periods.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, output: &str) {
        if output != PERIOD.name {
            return;
        }
        for (number, name) in KINDS.into_iter().enumerate() {
            let of_kind = self.cases.iter().filter(|it| it.1 == number).map(|it| it.0);
            let top = panel.frame.top;
            let marks: Vec<_> = of_kind
                .clone()
                .map(|x| panel.place(x, panel.y.scale.low).0)
                .map(|x| ((x, top), (x, top + LENGTH)))
                .collect();
            canvas.segments(&marks, stroke(name));
            panel.record(canvas, &format!("{name}, no period"), of_kind.map(|x| (x, f64::NAN)));
        }
    }
}

/// The numbers of an output over the axes `free`, in the unit shown; a motion that does not repeat has no period, which files have as 0.
pub fn numbers(view: &View<'_>, output: &str, free: &[&str]) -> Result<Vec<f64>, FigureError> {
    let is_period = output == PERIOD.name;
    let numbers = view.shown(output, free)?.into_iter();
    Ok(numbers.map(|it| if is_period && it < 1.0 { f64::NAN } else { it }).collect())
}

/// The mark of an outcome, in the colour that maps give it.
fn stroke(outcome: &str) -> Stroke {
    Stroke::solid(category::colour_of_outcome(outcome).unwrap_or(INK), CURVE_WIDTH)
}
