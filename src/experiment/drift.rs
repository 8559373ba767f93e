//! Whether a recorded signal drifts against the fitted motion, as one of a sensor does whose zero moves.

use super::covariance::{Covariance, Data};
use super::effort::{Effort, search};
use super::free_parameter::Free;
use super::history::{Channel, History, groups, residuals};
use super::least_squares::{Fit, Residuals};

/// A drift of so many standard errors is no chance: of 15 000 signals one is so far off.
const CLEAR: f64 = 4.0;

/// The drift of a signal of a recording against the fitted motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// Which of the recordings.
    pub recording: usize,
    /// Which signal.
    pub signal: Channel,
    /// What it rises by, recorded less fitted [SI, per second].
    pub rate: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Drift {
    /// Whether it is more than chance makes it.
    pub fn is_clear(&self) -> bool {
        self.rate.abs() > CLEAR * self.standard_error
    }
}

/// The drifts of all signals of which the data tell one.
///
/// # Method
///
/// One step of Gauss and Newton from the fit, with a drift of each signal as a further unknown beside those that were fitted: so
/// what the parameters took of a drift is counted, as a line through the residuals alone would not.
///
/// # Source
///
/// The score test of Rao, Proceedings of the Cambridge Philosophical Society 44 (1948).
///
/// # Assumes
///
/// A fit near enough to the truth for the motion to be linear in the unknowns.
///
/// # Breaks
///
/// Where the model does not describe the records a signal may have a trend without a drift of its sensor.
pub(super) fn drifts<H: History>(
    courses: &[H],
    free: &[Free],
    effort: &Effort,
    fit: &Fit,
) -> Vec<Drift> {
    let Some(mut found) = residuals(courses, free, &fit.parameters) else { return Vec::new() };
    let fitted = fit.parameters.len();
    let mut drifts = with_drifts(&mut found, courses, fitted);
    let bounds = search(courses, free, effort).bounds;
    let on_bound = fit.parameters.iter().zip(bounds).map(|(value, bounds)| bounds.holds(*value));
    let left_out: Vec<bool> = on_bound.chain(vec![false; drifts.len()]).collect();
    let groups = groups(courses);
    let data = Data { values: &found.values, slopes: &found.slopes, groups: &groups };
    let covariance = Covariance::new(data, effort.loss, &left_out);
    let scores = (0..left_out.len()).map(|column| {
        let pairs = found.values.iter().zip(&found.slopes);
        pairs.map(|(value, row)| effort.loss.influence(*value) * row[column]).sum::<f64>()
    });
    let scores: Vec<f64> = scores.collect();
    let kept: Vec<usize> =
        (0..left_out.len()).filter(|&i| covariance.covariance[(i, i)].is_finite()).collect();
    for (i, drift) in drifts.iter_mut().enumerate() {
        let own = fitted + i;
        let curvature = &covariance.inverse_curvature;
        // The step is that of a drift added to the motion, which takes the residuals, fitted less recorded, to their least.
        drift.rate = -kept.iter().map(|&j| curvature[(own, j)] * scores[j]).sum::<f64>();
        drift.standard_error = covariance.covariance[(own, own)].sqrt();
    }
    drifts.retain(|it| it.standard_error.is_finite());
    drifts
}

/// Adds the slopes of residuals in a drift of each signal behind those in what is `fitted`; returns the drifts, none of which is
/// known yet.
fn with_drifts<H: History>(found: &mut Residuals, courses: &[H], fitted: usize) -> Vec<Drift> {
    let signals: usize = courses.iter().map(|it| it.scatters().len()).sum();
    found.slopes.iter_mut().for_each(|row| row.resize(fitted + signals, 0.0));
    let (mut row, mut column) = (0, fitted);
    let mut drifts = Vec::new();
    for (recording, course) in courses.iter().enumerate() {
        let signals = course.channels().into_iter().zip(course.scatters());
        for ((signal, scatter), times) in signals.zip(course.times()) {
            for time in times {
                found.slopes[row][column] = time / scatter.unit;
                row += 1;
            }
            drifts.push(Drift { recording, signal, rate: 0.0, standard_error: 0.0 });
            column += 1;
        }
        row += usize::from(course.fits_phase());
    }
    drifts
}
