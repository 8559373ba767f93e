//! A fit to motion in words and as JSON.

use serde_json::json;

use super::varied::Varied;
use crate::capsule::Parameter;
use crate::experiment::{Fitted, MotionFit, Verdict};

/// A misfit above this is told.
const LARGE: f64 = 1.5;

/// The fit in lines.
pub fn table(fit: &MotionFit, varied: &[Varied], is_robust: bool) -> String {
    let mut text = String::new();
    for (it, varied) in fit.fitted.iter().zip(varied) {
        text += &told_of(it, varied);
    }
    for (it, varied) in fit.fitted.iter().zip(varied) {
        if it.verdict != Verdict::NotDetermined {
            text += &varied.told_of_bound("", it.bound);
        }
    }
    if !fit.combined.is_empty() {
        let names: Vec<&str> = fit.combined.iter().map(|it| it.symbol()).collect();
        text += &format!(
            "note: of {} only combinations are determined: changed together they leave the motion as it is; hold one of them\n",
            names.join(", ")
        );
    }
    if let Some((a, b, value)) = strongest(fit) {
        text +=
            &format!("strongest correlation {value:+.2}, of {} and {}\n", a.symbol(), b.symbol());
    }
    text += &told_of_misfit(fit, is_robust);
    if fit.fitted.iter().any(|it| it.parameter == Parameter::MuS) {
        let mut idle: Vec<String> =
            fit.motions.iter().filter_map(|it| it.parameters.idle_static_friction()).collect();
        idle.dedup();
        idle.iter().for_each(|why| text += &format!("note: {why}\n"));
    }
    text
}

/// A parameter in a line.
fn told_of(it: &Fitted, varied: &Varied) -> String {
    let (symbol, error) = (it.parameter.symbol(), it.estimate.standard_error);
    if it.verdict != Verdict::Determined {
        let [from, to] = it.estimate.interval;
        let [least, greatest] =
            [from, to].map(|end| varied.limit(end, error.min(0.1 * (to - from))));
        return format!("{symbol:<6}{}: {least} to {greatest} within its bounds\n", it.verdict);
    }
    let [value, error, least, greatest] =
        [it.estimate.value, error, it.estimate.interval[0], it.estimate.interval[1]]
            .map(|it| varied.shown(it, error));
    let unit = varied.unit();
    format!("{symbol:<6}{value}{unit}, standard error {error}, 95 %: {least} to {greatest}\n")
}

/// The misfit, with what it says of model and records.
fn told_of_misfit(fit: &MotionFit, is_robust: bool) -> String {
    let [same, starts] = fit.starts;
    let misfit = &fit.misfit;
    let told = if is_robust { misfit.robust } else { misfit.value };
    let by = if is_robust { " by the median" } else { "" };
    let mut text = format!(
        "misfit {told:.2} in units of the noise{by} (1 where the model describes the records), {} samples; {same} of {starts} starts led \
         here\n",
        fit.samples
    );
    let outliers = misfit.outliers;
    if outliers > 0 {
        let (samples, are) = if outliers == 1 { ("sample", "is") } else { ("samples", "are") };
        text +=
            &format!("{outliers} {samples} {are} more than five times the noise from the fit\n");
    }
    if misfit.is_coarse {
        text += "warning: the records change too much from sample to sample for their noise to be told from the motion; errors rest \
                 on the residuals alone\n";
    }
    if !is_robust && misfit.value > LARGE && 2 * misfit.lone >= misfit.outliers.max(1) {
        text +=
            "warning: few samples have most of the misfit; --robust lets outliers count little\n";
    } else if told > LARGE {
        text += "warning: the model does not describe the records to their noise; errors are those of the best fit, not of the truth\n";
    }
    text
}

/// The two parameters that are correlated most.
fn strongest(fit: &MotionFit) -> Option<(Parameter, Parameter, f64)> {
    let count = fit.fitted.len();
    let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
    let of = |(i, j): (usize, usize)| {
        (fit.fitted[j].parameter, fit.fitted[i].parameter, fit.correlations[i][j])
    };
    pairs.map(of).filter(|it| it.2.is_finite()).max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))
}

/// The fit as JSON.
pub fn as_json(fit: &MotionFit, warnings: &[String]) -> serde_json::Value {
    let one = |(it, profile): (&Fitted, &Vec<[f64; 2]>)| {
        json!({
            "name": it.parameter.symbol(),
            "unit": it.parameter.dimension().unit(),
            "value": it.estimate.value,
            "standard_error": it.estimate.standard_error,
            "interval_95": it.estimate.interval,
            "verdict": it.verdict.to_string(),
            "on_bound": it.bound.map(|it| it.name()),
            "profile": profile,
        })
    };
    let combined = fit.combined.iter().map(|it| it.symbol());
    json!({
        "fitted": fit.fitted.iter().zip(&fit.profiles).map(one).collect::<Vec<_>>(),
        "combined": combined.collect::<Vec<_>>(),
        "correlations": fit.correlations,
        "covariance": fit.covariance,
        "misfit": fit.misfit.value,
        "misfit_robust": fit.misfit.robust,
        "outliers": fit.misfit.outliers,
        "samples": fit.samples,
        "starts_here": fit.starts[0],
        "starts": fit.starts[1],
        "warnings": warnings,
    })
}
