//! The cases that have a panel each: the values of an axis, or those at which `at` holds axes.

use super::error::FigureError;
use super::outcome::Outcomes;
use super::text::Text;
use super::view::View;
use crate::store::catalogue::{ATTRACTOR, HISTORY_TIME, PERIOD};

/// Cases that one page has room for.
const MOST_CASES: usize = 12;

/// A case with a panel of its own.
pub struct CasePanel<'a> {
    /// The results with its axes held, but for the one over which it stands.
    pub view: View<'a>,
    /// That axis, if there is one.
    pub free: Vec<&'a str>,
    /// Its place along that axis.
    pub case: usize,
}

impl<'a> CasePanel<'a> {
    /// The period of its orbit in cycles, where the results tell one.
    pub fn period(&self) -> Result<Option<usize>, FigureError> {
        if self.view.dataset.variable(PERIOD.name).is_none() {
            return Ok(None);
        }
        let is_periodic = Outcomes::over(&self.view, &self.free)?.periodic(self.case);
        let period = self.view.take(PERIOD.name, &self.free)?.iter().nth(self.case).copied();
        Ok(period.filter(|it| is_periodic && *it >= 1.0).map(|it| it as usize))
    }

    /// The number of its attractor in the file; none where the results do not tell it.
    pub fn attractor(&self) -> Result<Option<usize>, FigureError> {
        if self.view.dataset.variable(ATTRACTOR.name).is_none() {
            return Ok(None);
        }
        let number = self.view.take(ATTRACTOR.name, &self.free)?.iter().nth(self.case).copied();
        Ok(number.filter(|it| *it >= 0.0).map(|it| it as usize))
    }

    /// Which case it is, for the heading of its panel.
    pub fn note(&self) -> Option<Text> {
        let own = self.free.first().map(|name| self.view.value_note(name, self.case));
        let held = self.view.held_note(&self.free).filter(|note| !note.is_empty());
        let both = own.into_iter().chain(held);
        both.reduce(|note, next| note.then(Text::plain(", ")).then(next))
    }
}

/// The cases that a figure of histories shows: all that `at` leaves, at each of the values that it names.
///
/// Fails where there are no histories and where one page has no room for all.
pub fn case_panels<'a>(view: &View<'a>) -> Result<Vec<CasePanel<'a>>, FigureError> {
    if view.dataset.coordinate(HISTORY_TIME.name).is_none() {
        return Err(view.without_histories());
    }
    let mut panels = Vec::new();
    for view in view.panels().into_iter().flatten() {
        let axis = case_axis(&view);
        let count = axis.map_or(1, |name| view.coordinate_values(name).len());
        if panels.len() + count > MOST_CASES {
            let name = axis.unwrap_or("at");
            return Err(view.unfit(format!(
                "axis `{name}` has more values than the {MOST_CASES} panels that there is room for: hold it \
                 at one or several of them with `at`"
            )));
        }
        for case in 0..count {
            let free = axis.into_iter().collect();
            panels.push(CasePanel { view: view.clone(), free, case });
        }
    }
    Ok(panels)
}

/// The axis whose every value gets a panel.
fn case_axis<'a>(view: &View<'a>) -> Option<&'a str> {
    let free = view.free_axes();
    match view.drawing.x.as_deref() {
        Some(name) => free.into_iter().find(|axis| *axis == name),
        None => free.into_iter().find(|name| view.coordinate_values(name).len() > 1),
    }
}
