//! Recorded histories beside the motions that are fitted to them, of any model: their residuals with all slopes.

use super::free_parameter::Free;
use super::least_squares::{Bounds, Fit, Model, Residuals};
use super::misfit::SignalResiduals;
use super::recording::Sensed;
use crate::quantity::Dimension;

/// What a recorded signal is called, and what it measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel {
    /// Its name in the recording.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
}

/// The noise of a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// What its residuals are divided by.
    pub unit: f64,
    /// Its noise by its third differences.
    pub noise: f64,
    /// The least that is taken for noise.
    pub least: f64,
}

impl Scatter {
    /// Puts the residuals of its signal behind the others: what was `found` less what was recorded, and the slopes of what was
    /// found by time and unknown.
    pub(super) fn add_residuals(
        &self,
        all: &mut Residuals,
        recorded: &Sensed,
        found: &[f64],
        slopes: &[Vec<f64>],
    ) {
        let unit = 1.0 / self.unit;
        let of_rows = recorded.beside(found).zip(recorded.beside(slopes));
        for ((recorded, found), (_, slopes)) in of_rows {
            all.push((found - recorded) * unit, slopes.iter().map(|it| it * unit).collect());
        }
    }
}

/// A recorded history with what is unknown of the start of its motion.
pub trait History: Sync {
    /// The times of each signal since the first sample of the record [s].
    fn times(&self) -> Vec<Vec<f64>>;

    /// What was recorded.
    fn channels(&self) -> Vec<Channel>;

    /// The noise of each signal.
    fn scatters(&self) -> &[Scatter];

    /// The same, so that what residuals are divided by can be changed.
    fn scatters_mut(&mut self) -> &mut [Scatter];

    /// Where what is unknown of the start is looked for.
    fn bounds(&self) -> Vec<Bounds>;

    /// Whether the phase of the drive is among it, with a datum of its own behind those of the signals.
    fn fits_phase(&self) -> bool;

    /// The residuals signal by signal, then that of the phase, at these values of the parameters and of what is unknown of the start,
    /// with their slopes in the parameters and then in what is unknown; none where the motion cannot be followed.
    fn residuals(&self, free: &[Free], parameters: &[f64], start: &[f64]) -> Option<Residuals>;
}

/// Recordings with the parameters that are fitted to them, as a model of all unknowns: the parameters, then what is unknown of the
/// start of each.
#[derive(Debug)]
pub struct Recordings<'c, H> {
    /// The recordings.
    pub courses: &'c [H],
    /// The parameters.
    pub free: &'c [Free],
}

impl<H: History> Model for Recordings<'_, H> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Residuals> {
        residuals(self.courses, self.free, unknowns)
    }
}

/// All residuals at these unknowns, with their slopes.
pub(super) fn residuals<H: History>(
    courses: &[H],
    free: &[Free],
    unknowns: &[f64],
) -> Option<Residuals> {
    let mut all = Residuals { values: Vec::new(), slopes: Vec::new() };
    let (parameters, mut rest) = unknowns.split_at(free.len());
    let mut before = free.len();
    for course in courses {
        let (start, others) = rest.split_at(course.bounds().len());
        let own = course.residuals(free, parameters, start)?;
        for (value, slopes) in own.values.into_iter().zip(own.slopes) {
            let mut row = vec![0.0; unknowns.len()];
            for (j, slope) in slopes.into_iter().enumerate() {
                let place = if j < free.len() { j } else { before + j - free.len() };
                row[place] = slope;
            }
            all.push(value, row);
        }
        before += start.len();
        rest = others;
    }
    Some(all)
}

/// How many residuals in turn are those of one signal, or of the phase of a drive.
pub(super) fn groups<H: History>(courses: &[H]) -> Vec<usize> {
    let mut groups = Vec::new();
    for course in courses {
        groups.extend(course.times().iter().map(Vec::len));
        groups.extend(course.fits_phase().then_some(1));
    }
    groups
}

/// The residuals of each signal of each recording in its unit; empty where the motion cannot be followed.
pub(super) fn by_signal<H: History>(courses: &[H], free: &[Free], fit: &Fit) -> Vec<Vec<f64>> {
    let Some(found) = residuals(courses, free, &fit.parameters) else { return Vec::new() };
    let (mut all, mut rest) = (Vec::new(), found.values.as_slice());
    for course in courses {
        for times in course.times() {
            let (own, others) = rest.split_at(times.len());
            all.push(own.to_vec());
            rest = others;
        }
        rest = &rest[usize::from(course.fits_phase())..];
    }
    all
}

/// The residuals of all signals with the noise of their records.
pub(super) fn signals<H: History>(courses: &[H], free: &[Free], fit: &Fit) -> Vec<SignalResiduals> {
    let scatters = courses.iter().flat_map(|it| it.scatters());
    let signals = by_signal(courses, free, fit).into_iter().zip(scatters);
    let residuals = signals.map(|(own, scatter)| SignalResiduals {
        values: own.iter().map(|it| it * scatter.unit).collect(),
        record_noise: scatter.noise,
        least_noise: scatter.least,
    });
    residuals.collect()
}
