//! A fit to motion in words and as JSON.

use serde_json::json;

use super::identify_report::shown;
use super::varied::Varied;
use crate::capsule::{self, CapsuleParameters as _};
use crate::description::Parameter;
use crate::experiment::{Drift, Fitted, MotionFit, Verdict};
use crate::quantity::Dimension;

/// A misfit above this is told.
const LARGE: f64 = 1.5;

/// The fit in lines.
pub fn table(fit: &MotionFit, varied: &[Varied], names: &[String], is_robust: bool) -> String {
    let pairs = fit.fitted.iter().zip(varied);
    let mut text: String = pairs.map(|(it, varied)| told_of(it, varied)).collect();
    if let Some((a, b, value)) = strongest(fit) {
        text +=
            &format!("strongest correlation {value:+.2}, of {} and {}\n", a.symbol(), b.symbol());
    }
    text += &told_of_misfit(fit, is_robust);
    text.extend(notes(fit, names).iter().map(|it| format!("note: {it}\n")));
    text
}

/// What is to be known of a fit, beside its warnings.
fn notes(fit: &MotionFit, names: &[String]) -> Vec<String> {
    let mut notes = Vec::new();
    if !fit.combined.is_empty() {
        let names: Vec<&str> = fit.combined.iter().map(|it| it.symbol()).collect();
        notes.push(format!(
            "of {} only combinations are determined: changed together they leave the motion as it is; hold one of them",
            names.join(", ")
        ));
    }
    if fit.fitted.iter().any(|it| it.parameter == capsule::Parameter::MuS) {
        let mut idle: Vec<String> =
            fit.parameters.iter().filter_map(|it| it.idle_static_friction()).collect();
        idle.dedup();
        notes.extend(idle);
    }
    let resting = names.iter().zip(&fit.rests).filter(|it| *it.1);
    notes.extend(resting.map(|(name, _)| {
        format!("{name}: the capsule is taken to rest at the first sample, which describes the record as well as any speed")
    }));
    notes
}

/// What makes a fit doubtful.
pub fn warnings(
    fit: &MotionFit,
    varied: &[Varied],
    names: &[String],
    is_robust: bool,
) -> Vec<String> {
    let on_bound = fit
        .fitted
        .iter()
        .zip(varied)
        .filter(|(it, _)| it.verdict != Verdict::NotDetermined)
        .filter_map(|(it, varied)| varied.bound_warning(it.bound));
    let mut warnings: Vec<String> = on_bound.collect();
    let clear = fit.drifts.iter().filter(|it| it.is_clear());
    warnings.extend(clear.map(|it| told_of_drift(it, &names[it.recording])));
    let misfit = &fit.misfit;
    let told = if is_robust { misfit.robust } else { misfit.value };
    if misfit.is_coarse {
        warnings.push(
            "the records change too much from sample to sample for their noise to be told from the motion; errors rest on the \
             residuals alone"
                .to_owned(),
        );
    }
    if !is_robust && misfit.value > LARGE && 2 * misfit.lone >= misfit.outliers.max(1) {
        warnings.push(
            "few samples have most of the misfit; --robust lets outliers count little".to_owned(),
        );
    } else if told > LARGE {
        warnings.push(
            "the model does not describe the records to their noise; errors are those of the best fit, not of the truth"
                .to_owned(),
        );
    }
    warnings
}

/// A drift in a sentence.
fn told_of_drift(it: &Drift, name: &str) -> String {
    let (scale, unit) = match it.signal.dimension {
        Dimension::Length => (1e3, "mm/s".to_owned()),
        Dimension::Number => (1.0, "per unit of time".to_owned()),
        other => (1.0, format!("{}/s", other.unit())),
    };
    let (rate, error) = (scale * it.rate, scale * it.standard_error);
    format!(
        "{name}: {} drifts against the fitted motion by {} {unit} (standard error {}), which moves the parameters and is not in \
         their errors; where its sensor drifts take that out of the record",
        it.signal.name,
        shown(rate, error),
        shown(error, error)
    )
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

/// The misfit, and how many samples are outliers.
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
    text
}

/// The two parameters that are correlated most.
fn strongest(fit: &MotionFit) -> Option<(Parameter, Parameter, f64)> {
    let count = fit.fitted.len();
    let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
    let correlations = pairs
        .map(|(i, j)| (fit.fitted[j].parameter, fit.fitted[i].parameter, fit.correlations[i][j]));
    correlations.filter(|it| it.2.is_finite()).max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))
}

/// The fit as JSON.
pub fn as_json(fit: &MotionFit, names: &[String], warnings: &[String]) -> serde_json::Value {
    let fitted = fit.fitted.iter().zip(&fit.profiles).map(|(it, profile)| {
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
    });
    let drifts = fit.drifts.iter().map(|it| {
        json!({
            "recording": names[it.recording],
            "signal": it.signal.name,
            "unit": format!("{}/s", it.signal.dimension.unit()),
            "rate": it.rate,
            "standard_error": it.standard_error,
        })
    });
    let combined = fit.combined.iter().map(|it| it.symbol());
    json!({
        "fitted": fitted.collect::<Vec<_>>(),
        "combined": combined.collect::<Vec<_>>(),
        "correlations": fit.correlations,
        "covariance": fit.covariance,
        "misfit": fit.misfit.value,
        "misfit_robust": fit.misfit.robust,
        "outliers": fit.misfit.outliers,
        "samples": fit.samples,
        "starts_here": fit.starts[0],
        "starts": fit.starts[1],
        "rests_at_first_sample": fit.rests,
        "drifts": drifts.collect::<Vec<_>>(),
        "notes": notes(fit, names),
        "warnings": warnings,
    })
}
