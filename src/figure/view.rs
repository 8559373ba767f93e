//! The part of the results that one figure shows: which axes are free and where the others are held.

use std::collections::BTreeMap;
use std::rc::Rc;

use ndarray::ArrayD;

use super::chosen::Chosen;
use super::error::FigureError;
use super::held::Held;
use super::numbers::Numbers;
use super::quantity::Quantity;
use super::shown::{Measured, Shown};
use super::unit::ShownUnit;
use super::varied::varied;
use crate::campaign::KeptFront;
use crate::description::{Description, Output, Parameter};
use crate::store::catalogue::{self, DIRECTION, DRAW, Entry, HISTORY_TIME};
use crate::store::dataset::{Dataset, Variable};
use crate::study::axis::{is_within, range};
use crate::study::{Direction, Drawing};

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
    /// Checks the axes that `drawing` names against the results in `shown`.
    pub fn new(shown: Shown<'a>, drawing: &'a Drawing) -> Result<View<'a>, FigureError> {
        let Shown { dataset, refined, measured } = shown;
        let (held, chosen) = (Held::default(), Rc::default());
        let mut view = View { dataset, refined, measured, drawing, held, chosen };
        view.check_drawn_axes()?;
        view.held = view.asked_places()?;
        view.chosen = Rc::new(view.asked_settings()?);
        Ok(view)
    }

    /// Checks that the axes that the request draws are there and not held.
    fn check_drawn_axes(&self) -> Result<(), FigureError> {
        let drawing = self.drawing;
        for name in drawing.x.iter().chain(&drawing.y) {
            if !varied(self.dataset).contains(&name.as_str()) {
                self.check_axis(name)?;
            }
            if drawing.at.contains_key(name) || drawing.panels.iter().any(|it| it.0 == *name) {
                return Err(self.unfit(format!("the axis `{name}` is both drawn and held by `at`")));
            }
        }
        Ok(())
    }

    /// Where the request holds axes.
    fn asked_places(&self) -> Result<Held, FigureError> {
        let mut held = Held::default();
        for (name, wanted) in &self.drawing.at {
            held.hold(name, self.nearest(name, *wanted)?);
        }
        for (name, wanted) in &self.drawing.panels {
            let places = wanted.iter().map(|it| self.nearest(name, *it));
            held.hold_at_each(name, places.collect::<Result<Vec<usize>, FigureError>>()?);
        }
        if let Some(sweep) = self.drawing.sweep {
            let [first, _] = sweep.directions();
            held.hold(DIRECTION.name, self.direction(first)?);
        }
        Ok(held)
    }

    /// What the request sets of quantities, with the units that it names.
    fn asked_settings(&self) -> Result<BTreeMap<String, Rc<Chosen>>, FigureError> {
        let mut chosen = BTreeMap::new();
        for (name, set) in &self.drawing.settings {
            let unit = set
                .unit
                .map(|unit| ShownUnit::of((name, self.model()), unit, || self.natural_frequency()));
            let unit = unit.transpose().map_err(|why| self.unfit(why))?;
            chosen.insert(name.clone(), Rc::new(Chosen::new(set.clone(), unit)));
        }
        Ok(chosen)
    }

    /// The model of the results.
    pub fn model(&self) -> &'static Description {
        self.dataset.model()
    }

    /// The natural frequency of the mass on its spring alone [rad/s], where it is the same for all cases.
    fn natural_frequency(&self) -> Option<f64> {
        let [stiffness, mass] = self.model().natural()?;
        Some((self.common_value(stiffness)? / self.common_value(mass)?).sqrt())
    }

    /// The value of a parameter [SI], where it is the same for all cases.
    fn common_value(&self, parameter: Parameter) -> Option<f64> {
        let values = self.parameter(parameter.symbol(), &[]).ok()?;
        let varies = self.coordinate_values(parameter.symbol()).len() > 1;
        values.first().copied().filter(|_| !varies)
    }

    /// The first fault of what is set.
    pub fn fault_of_settings(&self) -> Option<FigureError> {
        self.chosen.iter().find_map(|(name, chosen)| {
            let fault = chosen.fault()?;
            Some(self.unfit(format!("`scale` of {name}: {fault}")))
        })
    }

    /// The index of a direction in which starts were inherited.
    fn direction(&self, direction: Direction) -> Result<usize, FigureError> {
        let flags = self.flags(DIRECTION.name);
        let code = flags.iter().find(|(_, name)| name == direction.name()).map(|it| it.0 as f64);
        let index = self.coordinate_values(DIRECTION.name).iter().position(|it| Some(*it) == code);
        index.ok_or_else(|| {
            let wanted = direction.name();
            self.unfit(format!("`sweep`: these results have no sweep {wanted}"))
        })
    }

    /// The same for the cases whose starts were inherited in another direction.
    pub fn swept(&self, direction: Direction) -> Result<View<'a>, FigureError> {
        let place = self.direction(direction)?;
        Ok(View { held: self.held.moved(DIRECTION.name, place), ..self.clone() })
    }

    /// What each panel shows, row by row.
    pub fn panels(&self) -> Vec<Vec<View<'a>>> {
        let mut panels = Vec::new();
        for row in self.held.panels() {
            panels.push(row.into_iter().map(|held| View { held, ..self.clone() }).collect());
        }
        panels
    }

    /// The index of the value of an axis that is nearest to one within its range.
    fn nearest(&self, name: &str, wanted: f64) -> Result<usize, FigureError> {
        let values = self.axis_values(name)?;
        let away = values.iter().map(|value| (value - wanted).abs()).enumerate();
        let nearest = away.min_by(|a, b| a.1.total_cmp(&b.1));
        let (index, _) = nearest.ok_or_else(|| self.unfit(format!("axis `{name}` is empty")))?;
        if is_within(wanted, &values) {
            return Ok(index);
        }
        let [low, high] = range(&values);
        let unit = self.unit(name);
        let why = format!(
            "`at` holds {name} at {wanted}{unit}, and its axis goes from {low}{unit} to {high}{unit}"
        );
        Err(self.unfit(why))
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

    fn check_axis(&self, name: &str) -> Result<(), FigureError> {
        let axes = self.axes();
        if axes.contains(&name) {
            return Ok(());
        }
        if self.dataset.variable(name).is_some() {
            let known = if axes.is_empty() { "none".to_string() } else { axes.join(", ") };
            let why = format!("`{name}` is not an axis of this study (its axes: {known})");
            return Err(self.unfit(why));
        }
        let present = axes.iter().map(|axis| axis.to_string()).collect();
        Err(self.missing("axis", name, present))
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
        match self.chosen.get(name) {
            Some(chosen) => quantity.with(chosen.clone()),
            None => quantity,
        }
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
