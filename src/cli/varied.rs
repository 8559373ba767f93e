//! Parameters with bounds, as options name them, and how values of them are printed.

use super::files;
use super::identify_report::{shown, unit};
use crate::description::{Description, Parameter};
use crate::experiment::least_squares::Bounds;
use crate::experiment::{Free, Side};
use crate::quantity::{Dimension, units};
use crate::study::document::unknown;

/// A parameter that is varied, in the unit of its first bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    /// Which, and from where to where (SI).
    pub free: Free,
    /// Its bounds as they were given.
    bounds: [String; 2],
    /// The unit that values are printed in, with a space before it, and its size in SI.
    unit: (String, f64),
}

impl Varied {
    /// A value in the unit of the bounds, with the digits that an error of this size leaves, both in SI.
    pub fn shown(&self, value: f64, error: f64) -> String {
        shown(value / self.unit.1, error / self.unit.1)
    }

    /// A limit of its interval: a bound as it was given, or a value with the digits that an error leaves.
    pub fn limit(&self, value: f64, error: f64) -> String {
        match Side::of(value, self.free.bounds) {
            Some(Side::Least) => self.bounds[0].clone(),
            Some(Side::Greatest) => self.bounds[1].clone(),
            None => format!("{}{}", self.shown(value, error), self.unit.0),
        }
    }

    /// The unit as it stands behind a number.
    pub fn unit(&self) -> &str {
        &self.unit.0
    }

    /// What is said of a best value on a bound.
    pub fn told_of_bound(&self, before: &str, bound: Option<Side>) -> String {
        let warning = self.bound_warning(bound);
        warning.map_or_else(String::new, |it| format!("{before}warning: {it}\n"))
    }

    /// That a best value lies on a bound, if it does.
    pub fn bound_warning(&self, bound: Option<Side>) -> Option<String> {
        let side = bound?;
        let (symbol, name) = (self.free.parameter.symbol(), side.name());
        let value = match side {
            Side::Least => &self.bounds[0],
            Side::Greatest => &self.bounds[1],
        };
        Some(format!(
            "{symbol} is best at the {name} value allowed, {value}: the true one may lie beyond; widen the bounds"
        ))
    }
}

/// Threads of this machine.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Parameters of a model with bounds, as "k2=1 kN/m..5 kN/m,mu_d=0.1..0.6".
pub fn varied(
    option: &str,
    text: &str,
    model: &'static Description,
    faults: &mut Vec<String>,
) -> Vec<Varied> {
    text.split(',').filter_map(|part| one(option, part, model, faults)).collect()
}

/// One of them.
fn one(
    option: &str,
    part: &str,
    model: &'static Description,
    faults: &mut Vec<String>,
) -> Option<Varied> {
    let Some((name, (from, to))) =
        part.split_once('=').and_then(|(name, range)| Some((name.trim(), range.split_once("..")?)))
    else {
        faults.push(format!("{option}: {part}: expected NAME=FROM..TO, as \"k2=1 kN/m..5 kN/m\""));
        return None;
    };
    let Some(parameter) = model.parameter(name) else {
        let symbols = model.parameters().map(|it| it.symbol());
        faults.push(format!("{option}: {}", unknown("parameter", name, symbols)));
        return None;
    };
    let [least, greatest] = [from, to].map(|text| {
        let value = allowed_quantity(&format!("{option} {name}"), text, parameter);
        value.map_err(|fault| faults.push(fault)).ok()
    });
    let (least, greatest) = (least?, greatest?);
    if least >= greatest {
        faults.push(format!("{option} {name}: {from} must be below {to}"));
        return None;
    }
    Some(Varied {
        free: Free { parameter, bounds: Bounds { least, greatest } },
        bounds: [from, to].map(|it| it.trim().to_owned()),
        unit: unit_of(from, parameter.dimension()),
    })
}

/// A value that a parameter may have.
fn allowed_quantity(option: &str, text: &str, parameter: Parameter) -> Result<f64, String> {
    let value = files::quantity(option, text, parameter.dimension())?;
    match parameter.allowed().admits(value) {
        true => Ok(value),
        false => Err(format!("{option}: {value} must be {}", parameter.allowed())),
    }
}

/// The unit that a quantity was given in, or that of SI where it has none.
fn unit_of(text: &str, dimension: Dimension) -> (String, f64) {
    let mut ends = text.char_indices().map(|it| it.0).rev();
    let end = ends.find(|end| text[..*end].trim().parse::<f64>().is_ok()).unwrap_or(text.len());
    match units::unit(&text[end..], dimension).filter(|it| !it.0.is_empty()) {
        Some((name, size)) => (format!(" {name}"), size),
        None => (unit(dimension), 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capsule::description::CAPSULE;

    fn varied(option: &str, text: &str, faults: &mut Vec<String>) -> Vec<Varied> {
        super::varied(option, text, &CAPSULE, faults)
    }

    #[test]
    fn values_are_printed_in_the_unit_of_the_bounds() {
        let mut faults = Vec::new();
        let all =
            varied("--vary", "delta=2 mm..5 mm,k2=1e3 N/m..5 kN/m,mu_d=0.1..0.6", &mut faults);
        assert!(faults.is_empty(), "{faults:?}");
        let [delta, k2, mu_d] = all.as_slice() else { panic!("{all:?}") };
        assert_eq!(delta.shown(3.49412e-3, 2.23e-6) + delta.unit(), "3.4941 mm");
        assert_eq!(delta.limit(2.000000001e-3, 1e-6), "2 mm");
        assert_eq!(k2.unit(), " N/m");
        assert_eq!([mu_d.limit(0.1, 0.05), mu_d.limit(0.6, 0.05)], ["0.1", "0.6"]);
        assert_eq!(mu_d.limit(0.23456, 0.011), "0.235");
        let told = k2.told_of_bound("", Some(Side::Greatest));
        assert!(told.contains("greatest value allowed, 5 kN/m:"), "{told}");
        varied("--vary", "v_s=0.05..1", &mut faults);
        assert_eq!(faults.len(), 2, "{faults:?}");
    }
}
