//! Paths of the results as figures draw them: each called after one of the quantities that vary along it, where that can be.

use super::error::FigureError;
use super::shown::Shown;
use super::view::View;
use crate::store::catalogue::{ATTRACTOR_AXIS, DRAW, named};
use crate::store::dataset::{Dataset, Variable};
use crate::store::schema::INHERITED_ALONG;
use crate::store::{Path, paths};
use crate::study::axis::is_monotone;
use crate::study::{Coordinate, Drawing};

/// The attribute that keeps the own name of a path that is called after a quantity.
fn path_called(quantity: &str) -> String {
    format!("path called {quantity}")
}

/// Results with what a figure asks of them, their paths called after quantities.
#[derive(Debug, Clone)]
pub struct ByQuantities {
    dataset: Dataset,
    drawing: Drawing,
}

impl ByQuantities {
    /// Those of `shown` for a request; none of results without paths.
    ///
    /// Method: the dimension of a path is called after a quantity that the request draws or holds; where it holds the path by its
    /// places, not at all; else after the first quantity that rises or falls throughout. The places of the dimension then are the
    /// values of this quantity, and what is drawn over it is drawn over them. The other quantities stay variables along it.
    ///
    /// Fails where a quantity that is drawn has a value twice.
    pub fn of(shown: Shown<'_>, drawing: &Drawing) -> Result<Option<ByQuantities>, FigureError> {
        let all = paths(shown.dataset);
        if all.is_empty() {
            return Ok(None);
        }
        let mut own = ByQuantities { dataset: shown.dataset.clone(), drawing: drawing.clone() };
        for path in &all {
            if let Some(quantity) = own.quantity_of(path)? {
                own.call(path, &quantity);
            }
        }
        Ok(Some(own))
    }

    /// The results and the request, of which the rest is `shown`.
    pub fn shown<'a>(&'a self, shown: Shown<'a>) -> Shown<'a> {
        Shown { dataset: &self.dataset, ..shown }
    }

    /// What a figure asks of them.
    pub fn drawing(&self) -> &Drawing {
        &self.drawing
    }

    /// After what a path is called; none for its own name.
    fn quantity_of(&self, path: &Path) -> Result<Option<String>, FigureError> {
        let drawing = &self.drawing;
        let is_own = |name: &&String| path.quantities.contains(name);
        let drawn = drawing.x.iter().chain(&drawing.y).find(is_own);
        let panels = drawing.panels.iter().map(|(name, _)| name);
        let mut held = drawing.at.keys().chain(panels);
        if let Some(quantity) = drawn {
            let values = self.values(quantity);
            let is_twice = |at: usize| values[..at].contains(&values[at]);
            if (1..values.len()).any(is_twice) {
                let why = format!(
                    "`{quantity}` has a value twice along the path `{0}`; draw over `{0}`",
                    path.name
                );
                return Err(FigureError::Unfit { figure: drawing.name.clone(), why });
            }
            return Ok(Some(quantity.clone()));
        }
        if let Some(quantity) = held.clone().find(is_own) {
            return Ok(Some(quantity.clone()));
        }
        if held.any(|name| *name == path.name) {
            return Ok(None);
        }
        let fit = path.quantities.iter().find(|it| is_monotone(&self.values(it)));
        Ok(fit.cloned())
    }

    /// The values of a quantity along its path.
    fn values(&self, quantity: &str) -> Vec<f64> {
        let stored = self.dataset.variable(quantity);
        stored.map_or(Vec::new(), |it| it.values.to_real().into_iter().collect())
    }

    /// Calls a path after a quantity, wherever it is named.
    fn call(&mut self, path: &Path, quantity: &str) {
        let Some(values) = self.dataset.variables.remove(quantity) else { return };
        let axis = Variable { dimensions: vec![quantity.to_owned()], ..values };
        for place in &mut self.dataset.coordinates {
            if place.0 == path.name {
                *place = (quantity.to_owned(), axis.clone());
            }
        }
        self.dataset.attributes.insert(path_called(quantity), path.name.clone());
        let over = self.dataset.variables.values_mut().flat_map(|it| &mut it.dimensions);
        let of_sweep = [INHERITED_ALONG, ATTRACTOR_AXIS];
        let attributes = self.dataset.attributes.iter_mut();
        let named = attributes.filter(|(key, _)| of_sweep.contains(&key.as_str())).map(|it| it.1);
        let drawing = &mut self.drawing;
        let asked = [&mut drawing.x, &mut drawing.y, &mut drawing.colour_by].into_iter().flatten();
        for name in over.chain(named).chain(asked).filter(|name| **name == path.name) {
            quantity.clone_into(name);
        }
    }
}

impl<'a> View<'a> {
    /// What varies beside an axis along a path, as the names of variables; nothing of an axis that is no path.
    pub fn beside(&self, axis: &str) -> Vec<&'a str> {
        let (dataset, mut names) = (self.dataset, Vec::new());
        // What is drawn goes along no path.
        if axis == DRAW.name || dataset.coordinate(axis).is_none() {
            return names;
        }
        for name in Coordinate::all(self.model()).map(Coordinate::name) {
            let variable = dataset.variables.get_key_value(name);
            names.extend(variable.filter(|it| it.1.dimensions == [axis]).map(|it| it.0.as_str()));
        }
        names
    }

    /// What a request may call each axis: a path by its own name, too, and by each quantity along it.
    pub fn named_along(&self) -> Vec<String> {
        let names = self.axes().into_iter().map(|axis| {
            let beside = self.beside(axis);
            let Some(path) = self.path_of(axis).filter(|_| !beside.is_empty()) else {
                return axis.to_owned();
            };
            let own = (axis != path).then_some(axis);
            let along: Vec<&str> = own.into_iter().chain(beside).collect();
            format!("{path} (a path along which go {})", along.join(", "))
        });
        names.collect()
    }

    /// The path that an axis is, by its own name.
    fn path_of(&self, axis: &'a str) -> Option<&'a str> {
        let called = self.dataset.attributes.get(&path_called(axis));
        called.map(String::as_str).or_else(|| named(axis, self.model()).is_none().then_some(axis))
    }

    /// How what varies beside an axis goes along it, as its label says it.
    pub fn told_beside(&self, axis: &str) -> String {
        let values = self.coordinate_values(axis);
        // As the axis is drawn: its least value first.
        let falls = values.first() > values.last();
        let told = self.beside(axis).into_iter().filter_map(|name| {
            let mut values = self.values_beside(name);
            if falls {
                values.reverse();
            }
            self.quantity(name).course(&values)
        });
        told.collect::<Vec<_>>().join(", ")
    }

    /// Whether an axis is a path by its places, which no quantity stands for.
    pub fn is_by_places(&self, axis: &str) -> bool {
        named(axis, self.model()).is_none() && !self.beside(axis).is_empty()
    }

    /// The values of what varies beside an axis along a path.
    pub fn values_beside(&self, quantity: &str) -> Vec<f64> {
        let stored = self.dataset.variable(quantity);
        stored.map_or(Vec::new(), |it| it.values.to_real().into_iter().collect())
    }
}
