//! Identified constants in lines and as JSON.

use serde_json::json;

use crate::experiment::estimate::{decimals, significant};
use crate::experiment::identification::{Other, remarks};
use crate::experiment::{Estimate, Identified, Verdict};
use crate::quantity::Dimension;

/// A value with the decimals that show two significant digits of its standard error; without one, with three significant digits.
pub fn shown(value: f64, error: f64) -> String {
    match decimals(error) {
        Some(decimals) => format!("{value:.decimals$}"),
        None => significant(value, 3),
    }
}

/// An estimate in words: value, standard error and interval; where the data do not determine it, what they say of it.
fn told(estimate: &Estimate, verdict: Verdict, unit: &str) -> String {
    let Estimate { value, standard_error: error, interval } = estimate;
    let is_told = verdict == Verdict::Determined && error.is_finite();
    let [least, greatest] = interval.map(|end| match is_told {
        true => shown(end, *error),
        false => significant(end, 3),
    });
    match verdict {
        _ if is_told && *error <= 1e-12 * value.abs() => {
            format!(
                "{}{unit}, no standard error, as the tests do not scatter",
                significant(*value, 6)
            )
        }
        _ if is_told => format!(
            "{}{unit}, standard error {}, 95 %: {least} to {greatest}",
            shown(*value, *error),
            shown(*error, *error)
        ),
        Verdict::LimitedAbove => format!("below {greatest}{unit}, no standard error"),
        Verdict::LimitedBelow => format!("above {least}{unit}, no standard error"),
        _ => format!("between {least} and {greatest}{unit}, no standard error"),
    }
}

/// What a second method gives, and how far it differs.
fn told_of_other(other: &Other, unit: &str) -> String {
    let Other { method, estimate, disagreement, bias } = other;
    let verdict = match estimate.standard_error.is_finite() {
        true => Verdict::Determined,
        false => Verdict::NotDetermined,
    };
    let text = format!("{}, by {method}", told(estimate, verdict, unit));
    let apart = disagreement
        .map(|it| format!("; the methods differ by {:.1} standard errors", it.abs()))
        .unwrap_or_default();
    let bias = bias.map(|it| format!(": {it}")).unwrap_or_default();
    text + &apart + &bias
}

/// The unit as it stands behind a number; nothing for a plain number.
pub fn unit(dimension: Dimension) -> String {
    match dimension {
        Dimension::Number => String::new(),
        dimension => format!(" {}", dimension.unit()),
    }
}

/// The constants, one per line, with notes below.
pub fn table(all: &[Identified]) -> String {
    let mut text = String::new();
    for it in all {
        let unit = unit(it.constant.dimension());
        let found = told(&it.estimate, it.verdict, &unit);
        text += &format!("{:<15}{found}\n", it.constant.symbol());
        text += &format!("{:<15}{}, {}\n", "", it.method, it.source);
        if let Some(other) = &it.other {
            text += &format!("{:<15}{}\n", "", told_of_other(other, &unit));
        }
        if it.verdict != Verdict::Determined {
            text += &format!("{:<15}{}\n", "", it.verdict);
        }
        for note in &it.notes {
            let having: Vec<&Identified> = all
                .iter()
                .filter(|other| other.source == it.source && other.notes.contains(note))
                .collect();
            // A note of several constants is told once, with the first of them.
            if having.first().is_none_or(|first| first.constant != it.constant) {
                continue;
            }
            let names: Vec<&str> = having.iter().map(|it| it.constant.symbol()).collect();
            let of =
                if names.len() > 1 { format!(" of {}", names.join(", ")) } else { String::new() };
            text += &format!("{:<15}warning{of}: {note}\n", "");
        }
    }
    text
}

/// The constants as JSON.
pub fn as_json(all: &[Identified]) -> serde_json::Value {
    let identified = all.iter().map(|it| {
        let other = it.other.map(|it| {
            json!({
                "method": it.method,
                "value": it.estimate.value,
                "standard_error": it.estimate.standard_error,
                "disagreement_in_standard_errors": it.disagreement,
                "bias": it.bias,
            })
        });
        json!({
            "name": it.constant.symbol(),
            "unit": it.constant.dimension().unit(),
            "value": it.estimate.value,
            "standard_error": it.estimate.standard_error,
            "interval_95": it.estimate.interval,
            "verdict": it.verdict.to_string(),
            "method": it.method,
            "recording": it.source,
            "other": other,
            "notes": it.notes,
        })
    });
    json!({ "identified": identified.collect::<Vec<_>>(), "notes": remarks(all) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capsule::Parameter;
    use crate::experiment::Constant;

    #[test]
    fn a_warning_of_several_constants_is_told_once() {
        let of = |parameter: Parameter, notes: &[&str]| Identified {
            constant: Constant::Parameter(parameter.into()),
            estimate: Estimate { value: 1.0, standard_error: 0.1, interval: [0.8, 1.2] },
            verdict: Verdict::Determined,
            method: "a method",
            source: "decay.csv".to_owned(),
            other: None,
            notes: notes.iter().map(|it| (*it).to_owned()).collect(),
        };
        let text = table(&[of(Parameter::K1, &["both"]), of(Parameter::C, &["both", "own"])]);
        let warnings: Vec<&str> =
            text.lines().filter_map(|it| it.split_once("warning")).map(|it| it.1).collect();
        assert_eq!(warnings, [" of k1, c: both", ": own"]);
    }

    #[test]
    fn estimates_have_two_digits_of_their_errors_and_none_where_they_have_none() {
        let told = |value, standard_error, interval, verdict| {
            told(&Estimate { value, standard_error, interval }, verdict, " N/m")
        };
        assert_eq!(
            told(2418.96, 1.499, [2415.72, 2422.2], Verdict::Determined),
            "2419.0 N/m, standard error 1.5, 95 %: 2415.7 to 2422.2"
        );
        let open = f64::INFINITY;
        for (interval, verdict, text) in [
            ([1e-4, 0.00751], Verdict::LimitedAbove, "below 0.00751 N/m, no standard error"),
            ([0.5, 100.0], Verdict::LimitedBelow, "above 0.500 N/m, no standard error"),
            ([0.31, 0.65], Verdict::Several, "between 0.310 and 0.650 N/m, no standard error"),
            (
                [0.31, 0.65],
                Verdict::NotDetermined,
                "between 0.310 and 0.650 N/m, no standard error",
            ),
        ] {
            assert_eq!(told(0.4, open, interval, verdict), text);
            assert_eq!(
                told(0.4, 8.2e32, interval, verdict).split(',').next_back(),
                Some(" no standard error")
            );
        }
        let exact = told(0.65625, 0.0, [0.65625; 2], Verdict::Determined);
        assert_eq!(exact, "0.656250 N/m, no standard error, as the tests do not scatter");
    }
}
