//! The least squares of the identification on NIST's problems of nonlinear regression (StRD), whose parameters and standard
//! errors are certified to eleven digits: <https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml>.

use std::f64::consts::PI;

use capsulemap::experiment::least_squares::{Residuals, Search, fit};
use capsulemap::lane::{Dual, Lane};
use serde_json::Value;

/// A number with derivatives in up to nine parameters.
type Number = Dual<f64, 9>;

/// Digits that the values must agree with the certified ones to.
const DIGITS: f64 = 6.0;

struct Problem {
    name: String,
    starts: [Vec<f64>; 2],
    certified: Vec<f64>,
    errors: Vec<f64>,
    sum_of_squares: f64,
    /// The response, then the predictors.
    data: Vec<Vec<f64>>,
}

fn problems() -> Vec<Problem> {
    let all: Value = serde_json::from_str(include_str!("../data/nist_strd.json")).expect("JSON");
    let numbers = |it: &Value| -> Vec<f64> {
        it.as_array().expect("a list").iter().map(|it| it.as_f64().expect("a number")).collect()
    };
    let read = |it: &Value| Problem {
        name: it["name"].as_str().expect("a name").to_owned(),
        starts: [0, 1].map(|i| numbers(&it["starts"][i])),
        certified: numbers(&it["certified"]),
        errors: numbers(&it["errors"]),
        sum_of_squares: it["sum_of_squares"].as_f64().expect("a number"),
        data: it["data"].as_array().expect("a list").iter().map(numbers).collect(),
    };
    all.as_array().expect("a list").iter().map(read).collect()
}

fn number(value: f64) -> Number {
    Number::constant(value)
}

/// A function of a number by its value and slope.
fn chain(x: Number, value: f64, slope: f64) -> Number {
    let mut result = x;
    result.value = value;
    result.gradient.iter_mut().for_each(|it| *it *= slope);
    result
}

fn exp(x: Number) -> Number {
    chain(x, x.value.exp(), x.value.exp())
}

fn ln(x: Number) -> Number {
    chain(x, x.value.ln(), 1.0 / x.value)
}

fn power(base: Number, exponent: Number) -> Number {
    exp(exponent * ln(base))
}

fn cubic([a, b, c, d]: [Number; 4], x: Number) -> Number {
    a + x * (b + x * (c + x * d))
}

/// What the model of a problem gives for its predictors.
#[allow(clippy::too_many_lines)]
fn response(name: &str, b: &[Number], predictors: &[f64]) -> Number {
    let x = number(predictors[0]);
    let one = number(1.0);
    let gauss = |height: Number, centre: Number, width: Number| {
        let u = (x - centre) / width;
        height * exp(-(u * u))
    };
    let wave = |cos: Number, sin: Number, period: Number| {
        let angle = number(2.0 * PI) * x / period;
        cos * chain(angle, angle.value.cos(), -angle.value.sin())
            + sin * chain(angle, angle.value.sin(), angle.value.cos())
    };
    match name {
        "Bennett5" => b[0] * power(b[1] + x, -one / b[2]),
        "BoxBOD" | "Misra1a" => b[0] * (one - exp(-b[1] * x)),
        "Chwirut1" | "Chwirut2" => exp(-b[0] * x) / (b[1] + b[2] * x),
        "DanWood" => b[0] * power(x, b[1]),
        "ENSO" => {
            b[0] + wave(b[1], b[2], number(12.0)) + wave(b[4], b[5], b[3]) + wave(b[7], b[8], b[6])
        }
        "Eckerle4" => {
            let u = (x - b[2]) / b[1];
            b[0] / b[1] * exp(number(-0.5) * u * u)
        }
        "Gauss1" | "Gauss2" | "Gauss3" => {
            b[0] * exp(-b[1] * x) + gauss(b[2], b[3], b[4]) + gauss(b[5], b[6], b[7])
        }
        "Hahn1" | "Thurber" => {
            cubic([b[0], b[1], b[2], b[3]], x) / cubic([one, b[4], b[5], b[6]], x)
        }
        "Kirby2" => {
            let none = number(0.0);
            cubic([b[0], b[1], b[2], none], x) / cubic([one, b[3], b[4], none], x)
        }
        "Lanczos1" | "Lanczos2" | "Lanczos3" => {
            b[0] * exp(-b[1] * x) + b[2] * exp(-b[3] * x) + b[4] * exp(-b[5] * x)
        }
        "MGH09" => b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]),
        "MGH10" => b[0] * exp(b[1] / (x + b[2])),
        "MGH17" => b[0] + b[1] * exp(-x * b[3]) + b[2] * exp(-x * b[4]),
        "Misra1b" => {
            let root = one + b[1] * x * number(0.5);
            b[0] * (one - one / (root * root))
        }
        "Misra1c" => b[0] * (one - one / (one + number(2.0) * b[1] * x).sqrt()),
        "Misra1d" => b[0] * b[1] * x / (one + b[1] * x),
        "Nelson" => b[0] - b[1] * x * exp(-b[2] * number(predictors[1])),
        "Rat42" => b[0] / (one + exp(b[1] - b[2] * x)),
        "Rat43" => b[0] / power(one + exp(b[1] - b[2] * x), one / b[3]),
        "Roszman1" => {
            let u = b[2] / (x - b[3]);
            let angle = chain(u, u.value.atan(), 1.0 / (1.0 + u.value * u.value));
            b[0] - b[1] * x - angle / number(PI)
        }
        other => panic!("no model of {other}"),
    }
}

fn residuals(problem: &Problem, parameters: &[f64]) -> Option<Residuals> {
    let seeded: Vec<Number> =
        parameters.iter().enumerate().map(|(i, &it)| Number::variable(it, i)).collect();
    let mut all = Residuals { values: Vec::new(), slopes: Vec::new() };
    for row in &problem.data {
        let found = response(&problem.name, &seeded, &row[1..]);
        let given = if problem.name == "Nelson" { row[0].ln() } else { row[0] };
        all.values.push(found.value - given);
        all.slopes.push(found.gradient[..parameters.len()].to_vec());
    }
    let is_finite = all.slopes.iter().flatten().all(|it| it.is_finite());
    is_finite.then_some(all)
}

/// Digits in which two numbers agree, by their relative difference.
fn digits(found: f64, certified: f64) -> f64 {
    let apart = ((found - certified) / certified).abs();
    if apart == 0.0 { 15.0 } else { -apart.log10() }
}

#[test]
fn certified_values_are_found_from_both_starts() {
    let mut faults = Vec::new();
    let problems = problems();
    assert_eq!(problems.len(), 27);
    for problem in &problems {
        for (which, start) in problem.starts.iter().enumerate() {
            let name = format!("{}, start {}", problem.name, which + 1);
            let model = |parameters: &[f64]| residuals(problem, parameters);
            let found = fit(&model, start, &Search::free(start.len()));
            let Some(fit) = found else {
                faults.push(format!("{name}: no fit"));
                continue;
            };
            let least = |pairs: &mut dyn Iterator<Item = f64>| pairs.fold(15.0, f64::min);
            let values = fit.parameters.iter().zip(&problem.certified);
            let of_values = least(&mut values.map(|(a, b)| digits(*a, *b)));
            let errors = problem.errors.iter().enumerate();
            let of_errors = least(&mut errors.map(|(i, b)| digits(fit.standard_error(i), *b)));
            let of_sum = digits(fit.sum_of_squares, problem.sum_of_squares);
            println!("{name}: {of_values:.1} {of_errors:.1} {of_sum:.1} {:?}", fit.termination);
            // The data of Lanczos1 have no scatter but rounding: its residuals, and so its errors, have few digits.
            let wanted_of_errors = if problem.name == "Lanczos1" { 0.0 } else { DIGITS };
            if of_values < DIGITS || of_errors < wanted_of_errors {
                faults.push(format!("{name}: digits {of_values:.1} {of_errors:.1} {of_sum:.1}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
