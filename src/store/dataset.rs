//! A labelled set of arrays, the form in which results are kept, read back and drawn.

use std::collections::BTreeMap;

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{Entry, Flags, OWN_TEXT, SYSTEM_TEXT};
use super::names::MODEL;
use crate::description::Description;
use crate::of::{default_model, model_called};
use crate::study::{named_system, own_outputs};

/// The numbers of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Measured quantities; a missing value is NaN.
    Real(ArrayD<f64>),
    /// Counts and categories.
    Integer(ArrayD<i64>),
}

impl Values {
    /// A real without dimensions.
    pub fn real(value: f64) -> Values {
        Values::Real(ArrayD::from_elem(IxDyn(&[]), value))
    }

    /// An integer without dimensions.
    pub fn integer(value: i64) -> Values {
        Values::Integer(ArrayD::from_elem(IxDyn(&[]), value))
    }

    /// Reals along one dimension.
    pub fn reals(values: Vec<f64>) -> Values {
        Values::Real(line(values))
    }

    /// Integers along one dimension.
    pub fn integers(values: Vec<i64>) -> Values {
        Values::Integer(line(values))
    }

    /// The numbers from zero along one dimension.
    pub fn count(length: usize) -> Values {
        Values::integers((0..length as i64).collect())
    }

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
        all.iter().min().zip(all.iter().max()).map(|(&low, &high)| [low, high])
    }

    /// The number at a place of a line, as a line.
    pub fn at(&self, place: usize) -> Values {
        match self {
            Values::Real(line) => Values::reals(vec![line[[place]]]),
            Values::Integer(line) => Values::integers(vec![line[[place]]]),
        }
    }

    /// The same numbers as reals.
    pub fn to_real(&self) -> ArrayD<f64> {
        match self {
            Values::Real(array) => array.clone(),
            Values::Integer(array) => array.mapv(|value| value as f64),
        }
    }
}

fn line<T>(values: Vec<T>) -> ArrayD<T> {
    ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).expect("a line has the length it has")
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
    pub flags: Flags,
}

impl Variable {
    /// The variable of the catalogue over these dimensions, slowest first.
    pub fn of(entry: Entry, dimensions: Vec<String>, values: Values) -> Variable {
        let labels = [entry.unit, entry.meaning].map(str::to_owned);
        Variable::labelled(dimensions, labels, values).with_flags(entry.flags())
    }

    /// A variable with its unit and its long name as a file has them.
    pub fn labelled(
        dimensions: Vec<String>,
        [unit, long_name]: [String; 2],
        values: Values,
    ) -> Variable {
        Variable { dimensions, unit, long_name, values, flags: Flags::new() }
    }

    /// The name of each value of a category along one dimension; none of a value without one.
    pub fn names(&self) -> Vec<Option<&str>> {
        let named = |code: f64| {
            let flag = self.flags.iter().find(|(value, _)| *value as f64 == code);
            flag.map(|(_, word)| word.as_str())
        };
        self.values.to_real().into_iter().map(named).collect()
    }

    /// The variable in another unit.
    pub fn with_unit(self, unit: &str) -> Variable {
        Variable { unit: unit.to_owned(), ..self }
    }

    /// The variable with other flags.
    pub fn with_flags(self, flags: Flags) -> Variable {
        Variable { flags, ..self }
    }
}

/// Coordinates, variables and their provenance: a dataset in the sense of xarray.
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
    /// The model whose results they are.
    pub fn model(&self) -> &'static Description {
        let as_text = self.texts.get(SYSTEM_TEXT).and_then(|tables| named_system::known(tables));
        let named = || self.attributes.get(MODEL).and_then(|name| model_called(name));
        let model = as_text.or_else(named).unwrap_or_else(default_model);
        self.texts.get(OWN_TEXT).map_or(model, |table| own_outputs::known(model, table))
    }

    /// The coordinate called `name`.
    pub fn coordinate(&self, name: &str) -> Option<&Variable> {
        self.coordinates.iter().find(|(key, _)| key == name).map(|(_, variable)| variable)
    }

    /// The variable called `name`.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.get(name)
    }

    /// Puts a variable of the catalogue into the set, over these dimensions.
    pub fn put(&mut self, entry: Entry, dimensions: &[&str], values: Values) -> &mut Variable {
        let dimensions = dimensions.iter().map(|name| name.to_string()).collect();
        let variable = Variable::of(entry, dimensions, values);
        self.variables.entry(entry.name.to_owned()).insert_entry(variable).into_mut()
    }

    /// Puts a column of a table of the catalogue into the set, over its own dimensions.
    pub fn put_column(&mut self, entry: Entry, values: Values) -> &mut Variable {
        self.put(entry, &entry.dimensions(), values)
    }

    /// Puts a coordinate of the catalogue behind the others.
    pub fn put_coordinate(&mut self, entry: Entry, values: Values) {
        let variable = Variable::of(entry, vec![entry.name.to_owned()], values);
        self.coordinates.push((entry.name.to_owned(), variable));
    }
}
