//! What the table of attractors in a file of results tells of each of them.

use super::error::FigureError;
use super::ticks::significant;
use super::view::View;
use crate::store::catalogue::{
    ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR, Entry, Place,
};
use crate::tradeoff::NOISE;

/// What is read of each attractor, beside its speed.
pub const READS: [Entry; 4] =
    [ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR];

/// The columns of the table, each empty where the results do not have it.
pub struct KnownAttractors<'a> {
    /// The names of the kinds of motion.
    kinds: &'a [(i64, String)],
    /// The code of each attractor's kind.
    codes: Vec<f64>,
    periods: Vec<f64>,
    /// Speeds [m/s].
    speeds: Vec<f64>,
    /// Shares of the starts, and their standard errors.
    shares: Vec<f64>,
    errors: Vec<f64>,
}

impl<'a> KnownAttractors<'a> {
    /// The table of the results; of those that have a row for each value of an axis, that where the axis is held.
    ///
    /// Fails where a column does not fit its dimensions.
    pub fn held(view: &View<'a>) -> Result<KnownAttractors<'a>, FigureError> {
        KnownAttractors::read(view, |entry| match view.dataset.variable(entry.name) {
            Some(_) => Ok(view.take(entry.name, &[])?.into_iter().collect()),
            None => Ok(Vec::new()),
        })
    }

    /// The tables of all values of an axis, one after the other.
    pub fn along(view: &View<'a>) -> Result<KnownAttractors<'a>, FigureError> {
        KnownAttractors::read(view, |entry| Ok(view.column(entry)))
    }

    fn read(
        view: &View<'a>,
        column: impl Fn(Entry) -> Result<Vec<f64>, FigureError>,
    ) -> Result<KnownAttractors<'a>, FigureError> {
        let model = view.model();
        let speed = model.has_trade_off().then(|| Entry::of_output(model.speed()));
        let of_attractors = speed.map(|entry| column(Place::Attractor.of(entry)));
        Ok(KnownAttractors {
            kinds: view.flags(ATTRACTOR_KIND.name),
            codes: column(ATTRACTOR_KIND)?,
            periods: column(ATTRACTOR_PERIOD)?,
            speeds: of_attractors.transpose()?.unwrap_or_default(),
            shares: column(ATTRACTOR_SHARE)?,
            errors: column(ATTRACTOR_SHARE_ERROR)?,
        })
    }

    /// The share of the starts that lead to the attractor at a place of the table, and its standard error; NaN where it is not known.
    pub fn share(&self, place: usize) -> [f64; 2] {
        [&self.shares, &self.errors].map(|all| all.get(place).copied().unwrap_or(f64::NAN))
    }

    /// The name of the kind of motion at a place of the table.
    fn kind(&self, place: usize) -> Option<&'a str> {
        let code = self.codes.get(place)?;
        let kind = self.kinds.iter().find(|(value, _)| *value as f64 == *code);
        kind.map(|(_, name)| name.as_str())
    }

    /// Whether the motion at each place of the table is chaotic or quasi-periodic.
    pub fn irregular(&self) -> Vec<bool> {
        let kinds = (0..self.codes.len()).map(|place| self.kind(place));
        kinds.map(|kind| kind.is_some_and(|name| name != "periodic")).collect()
    }

    /// What the motion at a place of the table is: its period, or the name of its kind.
    pub fn motion(&self, place: usize) -> String {
        match (self.kind(place), self.periods.get(place)) {
            (Some("periodic"), Some(period)) => format!("period {period}"),
            (kind, _) => kind.unwrap_or("unknown").to_owned(),
        }
    }

    /// An attractor in a phrase: its number in the file, its kind or period, its speed, and its share with the error.
    pub fn told(&self, number: usize) -> String {
        if number >= self.codes.len() {
            return format!("attractor {number}");
        }
        let mut parts = vec![format!("attractor {number}: {}", self.motion(number))];
        parts.extend(self.speeds.get(number).map(|it| format!("{} mm/s", millimetres(*it))));
        if let (Some(share), Some(error)) = (self.shares.get(number), self.errors.get(number)) {
            parts.push(share_in_words(100.0 * share, 100.0 * error));
        }
        parts.join(", ")
    }
}

/// A share of the starts with its error, both in per cent.
fn share_in_words(share: f64, error: f64) -> String {
    if error.is_nan() {
        return format!("{share:.1} % of the starts computed, others are missing");
    }
    if error > 0.0 {
        // Two digits of the error say how many of the share are known.
        let decimals = (1.0 - error.log10().floor()).clamp(0.0, 4.0) as usize;
        return format!("{share:.decimals$} ± {error:.decimals$} % of the starts");
    }
    format!("{share:.1} % of the starts")
}

/// A speed [m/s] in mm/s, with three digits; what rounding leaves is zero.
pub fn millimetres(speed: f64) -> String {
    significant(if speed.abs() < NOISE { 0.0 } else { 1e3 * speed }, 3)
}
