//! The results as one figure sees them: their numbers where it holds the axes, and its names for them.

use std::collections::BTreeMap;
use std::rc::Rc;

use ndarray::ArrayD;

use super::axis_numbers::Numbers;
use super::chosen::Chosen;
use super::error::FigureError;
use super::held::Held;
use super::quantity::Quantity;
use super::shown::Measured;
use crate::campaign::KeptFront;
use crate::description::{Description, Output};
use crate::store::catalogue::{self, DIRECTION, DRAW, Entry, HISTORY_TIME};
use crate::store::dataset::{Dataset, Variable};
use crate::study::Drawing;

/// The results as one figure sees them.
#[derive(Clone)]
pub struct View<'a> {
    /// The results.
    pub dataset: &'a Dataset,
    /// What was found between their cases, apart by the conditions that were kept.
    pub refined: &'a [KeptFront],
    /// Points that were measured.
    pub measured: Option<&'a Measured>,
    /// The request.
    pub drawing: &'a Drawing,
    /// Where axes are held.
    pub held: Held,
    /// What is set of quantities, by their names.
    pub chosen: Rc<BTreeMap<String, Rc<Chosen>>>,
}

impl<'a> View<'a> {
    /// The model of the results.
    pub fn model(&self) -> &'static Description {
        self.dataset.model()
    }

    /// The unit of an axis after a space; nothing where it has none.
    pub fn unit(&self, name: &str) -> String {
        let unit = self.dataset.coordinate(name).map_or("1", |it| it.unit.as_str());
        if unit == "1" { String::new() } else { format!(" {unit}") }
    }

    /// The fault that the request does not fit.
    pub fn unfit(&self, why: impl Into<String>) -> FigureError {
        FigureError::Unfit { figure: self.drawing.name.clone(), why: why.into() }
    }

    /// The fault that there is no history to draw.
    pub fn without_histories(&self) -> FigureError {
        let name = HISTORY_TIME.name;
        self.unfit(format!("the results hold no time histories (no `{name}`)"))
    }

    /// Names of the study's axes, in its order.
    pub fn axes(&self) -> Vec<&'a str> {
        let names = self.dataset.coordinates.iter().map(|(name, _)| name.as_str());
        names.filter(|name| !catalogue::is_dimension(name)).collect()
    }

    /// Names of the axes that `at` does not hold.
    pub fn free_axes(&self) -> Vec<&'a str> {
        self.axes().into_iter().filter(|name| !self.held.has(name)).collect()
    }

    /// The axes a diagram runs along by default: those that are free and not the direction of a sweep.
    pub fn drawable_axes(&self) -> Vec<&'a str> {
        self.free_axes()
            .into_iter()
            .filter(|name| ![DIRECTION.name, DRAW.name].contains(name))
            .collect()
    }

    /// Checks that the study has the axis called `name`.
    pub fn check_axis(&self, name: &str) -> Result<(), FigureError> {
        let axes = self.axes();
        if axes.contains(&name) {
            return Ok(());
        }
        if self.dataset.variable(name).is_some() {
            let known = match axes.is_empty() {
                true => "none".to_owned(),
                false => self.named_along().join(", "),
            };
            let why = format!("`{name}` is not an axis of this study (its axes: {known})");
            return Err(self.unfit(why));
        }
        Err(self.missing("axis", name, self.named_along()))
    }

    /// Checks that each of these names is of a signal, or of a variable that the results have over time.
    pub fn check_signals<'n>(
        &self,
        mut names: impl Iterator<Item = &'n str>,
    ) -> Result<(), FigureError> {
        // Where there are none at all, that is what is to be told.
        if self.coordinate_values(HISTORY_TIME.name).is_empty() {
            return Ok(());
        }
        let (kind, model) = (self.drawing.kind, self.model());
        let is_over_time = |name: &str| {
            let dimensions = self.dataset.variable(name).map(|it| &it.dimensions);
            dimensions.is_some_and(|all| all.iter().any(|it| it == HISTORY_TIME.name))
        };
        match names.find(|name| model.signal(name).is_none() && !is_over_time(name)) {
            None => Ok(()),
            Some(name) => {
                let known = kind.can_show(model, &[]).join(", ");
                let kind = kind.name();
                Err(self.unfit(format!("a {kind} cannot show `{name}`; it can show {known}")))
            }
        }
    }

    fn missing(&self, what: &'static str, name: &str, present: Vec<String>) -> FigureError {
        let (figure, name) = (self.drawing.name.clone(), name.to_string());
        FigureError::Missing { figure, what, name, present }
    }

    /// The values of a study's axis, in SI.
    pub fn axis_values(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        self.check_axis(name)?;
        Ok(self.coordinate_values(name))
    }

    /// The numbers of a variable as they are stored; none where there is none.
    pub fn column(&self, entry: Entry) -> Vec<f64> {
        let stored = self.dataset.variable(entry.name);
        stored.map_or(Vec::new(), |variable| variable.values.to_real().into_iter().collect())
    }

    /// The values of any coordinate; none if there is no such coordinate.
    pub fn coordinate_values(&self, name: &str) -> Vec<f64> {
        let stored = self.dataset.coordinate(name);
        stored.map_or(Vec::new(), |variable| variable.values.to_real().into_iter().collect())
    }

    /// The variable called `name`.
    pub fn variable(&self, name: &str) -> Result<&'a Variable, FigureError> {
        self.dataset.variable(name).ok_or_else(|| {
            let (kind, variables) = (self.drawing.kind, &self.dataset.variables);
            let outputs: Vec<Output> = self.model().outputs().collect();
            let drawable = kind.can_show(self.model(), &outputs).into_iter().map(str::to_owned);
            let present: Vec<String> = drawable.filter(|it| variables.contains_key(it)).collect();
            let present = match present.is_empty() {
                true => variables.keys().cloned().collect(),
                false => present,
            };
            self.missing("variable", name, present)
        })
    }

    /// The numbers of a variable over the axes `free`, in that order, then over its inner
    /// dimensions; every other axis is where `at` holds it, or at its first value.
    pub fn take(&self, name: &str, free: &[&str]) -> Result<ArrayD<f64>, FigureError> {
        let variable = self.variable(name)?;
        let Some(mut numbers) = Numbers::of(variable) else {
            return Err(self.unfit(format!("variable `{name}` does not have its dimensions")));
        };
        for dimension in variable.dimensions.iter().map(String::as_str) {
            if free.contains(&dimension) || catalogue::is_dimension(dimension) {
                continue;
            }
            let Some(held) = numbers.held(dimension, self.held.place(dimension)) else {
                return Err(self.unfit(format!("variable `{name}` is empty along `{dimension}`")));
            };
            numbers = held;
        }
        self.over(name, numbers, free)
    }

    /// The numbers of what is called `name` over the axes `free`, then over those that they have beside.
    fn over<'n>(
        &self,
        name: &str,
        numbers: Numbers<'n>,
        free: &[&'n str],
    ) -> Result<ArrayD<f64>, FigureError> {
        let lengths: Vec<usize> =
            free.iter().map(|axis| self.coordinate_values(axis).len()).collect();
        let fitting = numbers.over(free, &lengths);
        fitting.ok_or_else(|| self.unfit(format!("variable `{name}` does not fit its coordinates")))
    }

    /// The numbers of a variable in the units of the figure.
    pub fn shown(&self, name: &str, free: &[&str]) -> Result<ArrayD<f64>, FigureError> {
        let factor = self.quantity(name).factor;
        Ok(self.take(name, free)?.mapv_into(|value| value * factor))
    }

    /// How figures show the quantity called `name`.
    pub fn quantity(&self, name: &str) -> Quantity {
        let quantity = Quantity::named(name, self.dataset);
        let quantity = match self.chosen.get(name) {
            Some(chosen) => quantity.with(chosen.clone()),
            None => quantity,
        };
        quantity.going_with(self.told_beside(name))
    }

    /// Whether a mark is shown.
    pub fn shows(&self, mark: &str) -> bool {
        !self.drawing.hide.iter().any(|hidden| hidden == mark)
    }

    /// A parameter over the axis `free`, in SI: the axis of that name, or the variable.
    pub fn parameter(&self, name: &str, free: &[&str]) -> Result<ArrayD<f64>, FigureError> {
        if !self.axes().contains(&name) {
            return self.take(name, free);
        }
        let numbers = match free.contains(&name) {
            true => Numbers::along(name, self.coordinate_values(name)),
            false => Numbers::constant(self.held_value(name).unwrap_or(f64::NAN)),
        };
        self.over(name, numbers, free)
    }

    /// The value at which an axis that is not drawn is held, in SI.
    pub fn held_value(&self, name: &str) -> Option<f64> {
        self.coordinate_values(name).get(self.held.place(name)).copied()
    }

    /// The index along `axis` of each case by its number over the axes `free`.
    pub fn places_along(&self, axis: &str, free: &[&str]) -> impl Fn(usize) -> usize + use<> {
        let later = free.iter().skip_while(|name| **name != axis).skip(1);
        let spacing: usize = later.map(|name| self.coordinate_values(name).len()).product();
        let length = self.coordinate_values(axis).len();
        move |case| (case / spacing.max(1)) % length.max(1)
    }

    /// The name and meaning of each category of an integer variable.
    pub fn flags(&self, name: &str) -> &'a [(i64, String)] {
        let stored = self.dataset.variable(name).or_else(|| self.dataset.coordinate(name));
        stored.map_or(&[], |variable| &variable.flags)
    }
}
