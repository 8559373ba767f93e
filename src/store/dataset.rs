//! A labelled set of arrays, the form in which results are kept, read back and drawn.

use std::collections::BTreeMap;

use ndarray::ArrayD;

/// The numbers of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Measured quantities; a missing value is NaN.
    Real(ArrayD<f64>),
    /// Counts and categories.
    Integer(ArrayD<i64>),
}

impl Values {
    /// Length along each dimension, slowest first.
    pub fn shape(&self) -> &[usize] {
        match self {
            Values::Real(array) => array.shape(),
            Values::Integer(array) => array.shape(),
        }
    }

    /// The least and the greatest of integers; none for reals and where there are none.
    pub fn range(&self) -> Option<[i64; 2]> {
        let Values::Integer(all) = self else { return None };
        let wider = |[low, high]: [i64; 2], it: &i64| [low.min(*it), high.max(*it)];
        all.first().map(|&first| all.iter().fold([first, first], wider))
    }

    /// The same numbers as reals.
    pub fn to_real(&self) -> ArrayD<f64> {
        match self {
            Values::Real(array) => array.clone(),
            Values::Integer(array) => array.mapv(|value| value as f64),
        }
    }
}

/// One array with its meaning.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name of each dimension, slowest first; every one is a coordinate of the set.
    pub dimensions: Vec<String>,
    /// Unit as written in a table ("m/s", "J"); "1" where there is none.
    pub unit: String,
    /// What the numbers are, in a phrase.
    pub long_name: String,
    /// The numbers.
    pub values: Values,
    /// For categories: each integer with its meaning; empty otherwise.
    pub flags: Vec<(i64, String)>,
}

/// Coordinates, variables and what made them: what xarray calls a dataset.
///
/// Invariant: each dimension of every variable is the name of a coordinate, and the lengths agree.
/// A coordinate is a variable of one dimension, its own name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dataset {
    /// One entry per dimension, in the order of the study's axes, then section points and the like.
    pub coordinates: Vec<(String, Variable)>,
    /// The outputs, by name.
    pub variables: BTreeMap<String, Variable>,
    /// Provenance and settings, by name (title, version, commit, time, host, ...).
    pub attributes: BTreeMap<String, String>,
    /// Long texts kept beside the numbers, by name (the study as it was written).
    pub texts: BTreeMap<String, String>,
}

impl Dataset {
    /// The coordinate called `name`.
    pub fn coordinate(&self, name: &str) -> Option<&Variable> {
        self.coordinates.iter().find(|(key, _)| key == name).map(|(_, variable)| variable)
    }

    /// The variable called `name`.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.get(name)
    }
}
