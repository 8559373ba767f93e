//! The part of the results that one figure shows: which axes are free and where the others are held.

use ndarray::{ArrayD, Axis, IxDyn};

use std::collections::BTreeMap;
use std::rc::Rc;

use super::chosen::Chosen;
use super::cloud;
use super::error::FigureError;
use super::quantity::Quantity;
use super::shown::{Measured, Shown};
use super::style::POINTS_PER_MM;
use super::unit::ShownUnit;
use super::varied::varied;
use crate::campaign::KeptFront;
use crate::description::{Description, Output, Parameter};
use crate::store::catalogue::{self, DIRECTION, DRAW, Entry, HISTORY_TIME};
use crate::store::dataset::{Dataset, Variable};
use crate::study::axis::{is_within, range};
use crate::study::{Direction, Drawing};

/// Whether a dimension lies within a case or beside the cases, and is no axis of the study.
fn is_inner(dimension: &str) -> bool {
    catalogue::is_dimension(dimension)
}

/// Panels along one axis that stand side by side at most.
const COLUMNS: usize = 4;

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
    /// Index at which each axis named by `at` is held.
    pub held: Vec<(String, usize)>,
    /// Indices of the panels along each axis that is held at several values.
    pub panelled: Vec<(String, Vec<usize>)>,
    /// What is set of quantities, by their names.
    pub chosen: Rc<BTreeMap<String, Rc<Chosen>>>,
}

impl<'a> View<'a> {
    /// Checks the axes that `drawing` names against the results in `shown`.
    pub fn new(shown: Shown<'a>, drawing: &'a Drawing) -> Result<View<'a>, FigureError> {
        let Shown { dataset, refined, measured } = shown;
        let (held, panelled, chosen) = (Vec::new(), Vec::new(), Rc::default());
        let mut view = View { dataset, refined, measured, drawing, held, panelled, chosen };
        for name in drawing.x.iter().chain(&drawing.y) {
            if !varied(dataset).contains(&name.as_str()) {
                view.check_axis(name)?;
            }
            if drawing.at.contains_key(name) || drawing.panels.iter().any(|it| it.0 == *name) {
                return Err(view.unfit(format!("the axis `{name}` is both drawn and held by `at`")));
            }
        }
        for (name, wanted) in &drawing.at {
            let index = view.nearest(name, *wanted)?;
            view.held.push((name.clone(), index));
        }
        for (name, wanted) in &drawing.panels {
            let indices = wanted.iter().map(|it| view.nearest(name, *it));
            let indices = indices.collect::<Result<Vec<usize>, FigureError>>()?;
            view.held.extend(indices.first().map(|first| (name.clone(), *first)));
            view.panelled.push((name.clone(), indices));
        }
        if let Some(sweep) = drawing.sweep {
            let [first, _] = sweep.directions();
            let index = view.direction(first)?;
            view.held.push((DIRECTION.name.to_owned(), index));
        }
        let mut chosen = BTreeMap::new();
        for (name, set) in &drawing.settings {
            let unit =
                |unit| ShownUnit::of((name, view.model()), unit, || view.natural_frequency());
            let unit = set.unit.map(unit).transpose().map_err(|why| view.unfit(why))?;
            chosen.insert(name.clone(), Rc::new(Chosen::new(set.clone(), unit)));
        }
        view.chosen = Rc::new(chosen);
        Ok(view)
    }

    /// The model of the results.
    pub fn model(&self) -> &'static Description {
        self.dataset.model()
    }

    /// The natural frequency of the mass on its spring alone [rad/s], where it is the same for all cases.
    fn natural_frequency(&self) -> Option<f64> {
        let one = |parameter: Parameter| {
            let values = self.parameter(parameter.symbol(), &[]).ok()?;
            let varies = self.coordinate_values(parameter.symbol()).len() > 1;
            values.first().copied().filter(|_| !varies)
        };
        let [stiffness, mass] = self.model().natural()?;
        Some((one(stiffness)? / one(mass)?).sqrt())
    }

    /// The first fault of what is set.
    pub fn fault_of_settings(&self) -> Option<FigureError> {
        let fault = |(name, chosen): (&String, &Rc<Chosen>)| {
            chosen.fault().map(|fault| self.unfit(format!("`scale` of {name}: {fault}")))
        };
        self.chosen.iter().find_map(fault)
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
        let index = self.direction(direction)?;
        let others = self.held.iter().filter(|(name, _)| name != DIRECTION.name).cloned();
        let held = others.chain([(DIRECTION.name.to_owned(), index)]).collect();
        let View { dataset, refined, measured, drawing, .. } = *self;
        Ok(View {
            dataset,
            refined,
            measured,
            drawing,
            held,
            panelled: Vec::new(),
            chosen: self.chosen.clone(),
        })
    }

    /// What each panel shows, row by row: those of the first axis that is held at several values, those of the second side by side.
    pub fn panels(&self) -> Vec<Vec<View<'a>>> {
        let [rows, columns] = [0, 1].map(|axis| {
            let one = || vec![None];
            let each = |(name, indices): &(String, Vec<usize>)| {
                indices.iter().map(|index| Some((name.clone(), *index))).collect()
            };
            self.panelled.get(axis).map_or_else(one, each)
        });
        let at = |row: &Option<(String, usize)>, column: &Option<(String, usize)>| {
            let is_moved = |name: &String| self.panelled.iter().any(|it| it.0 == *name);
            let held = self.held.iter().filter(|(name, _)| !is_moved(name)).cloned();
            let View { dataset, refined, measured, drawing, .. } = *self;
            let held = held.chain(row.clone()).chain(column.clone()).collect();
            View {
                dataset,
                refined,
                measured,
                drawing,
                held,
                panelled: Vec::new(),
                chosen: self.chosen.clone(),
            }
        };
        let row = |row: &Option<(String, usize)>| columns.iter().map(|it| at(row, it)).collect();
        let all: Vec<Vec<View<'a>>> = rows.iter().map(row).collect();
        if self.panelled.len() != 1 {
            return all;
        }
        // The panels along one axis are read like lines of text.
        let mut all = all.into_iter().flatten().peekable();
        let mut wrapped = Vec::new();
        while all.peek().is_some() {
            wrapped.push(all.by_ref().take(COLUMNS).collect());
        }
        wrapped
    }

    /// The index of the value of an axis that is nearest to one within its range.
    fn nearest(&self, name: &str, wanted: f64) -> Result<usize, FigureError> {
        let values = self.axis_values(name)?;
        let away = |index: &usize| (values[*index] - wanted).abs();
        let nearest = (0..values.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
        let index = nearest.ok_or_else(|| self.unfit(format!("axis `{name}` is empty")))?;
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
        names.filter(|name| !is_inner(name)).collect()
    }

    /// Names of the axes that `at` does not hold.
    pub fn free_axes(&self) -> Vec<&'a str> {
        let is_held = |name: &str| self.held.iter().any(|(other, _)| other == name);
        self.axes().into_iter().filter(|name| !is_held(name)).collect()
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
            let all = || variables.keys().cloned().collect();
            self.missing("variable", name, if present.is_empty() { all() } else { present })
        })
    }

    /// The numbers of a variable over the axes `free`, in that order, then over its inner
    /// dimensions; every other axis is where `at` holds it, or at its first value.
    pub fn take<'n>(&'n self, name: &str, free: &[&'n str]) -> Result<ArrayD<f64>, FigureError> {
        let variable = self.variable(name)?;
        let mut array = variable.values.to_real();
        let mut left: Vec<&str> = variable.dimensions.iter().map(String::as_str).collect();
        if array.ndim() != left.len() {
            return Err(self.unfit(format!("variable `{name}` does not have its dimensions")));
        }
        for dimension in &variable.dimensions {
            if free.contains(&dimension.as_str()) || is_inner(dimension) {
                continue;
            }
            let index = self.held_index(dimension);
            let at = left.iter().position(|axis| axis == dimension).unwrap_or(0);
            if index >= array.shape()[at] {
                return Err(self.unfit(format!("variable `{name}` is empty along `{dimension}`")));
            }
            array = array.index_axis_move(Axis(at), index);
            left.remove(at);
        }
        self.arrange(name, array, left, free)
    }

    /// Puts the axes `free` first, repeating the numbers along those the variable does not have.
    fn arrange<'n>(
        &self,
        name: &str,
        mut array: ArrayD<f64>,
        mut left: Vec<&'n str>,
        free: &[&'n str],
    ) -> Result<ArrayD<f64>, FigureError> {
        for axis in free.iter().rev().filter(|axis| !left.contains(axis)).collect::<Vec<_>>() {
            left.insert(0, axis);
            array = array.insert_axis(Axis(0));
        }
        let mut order: Vec<usize> =
            free.iter().filter_map(|axis| left.iter().position(|it| it == axis)).collect();
        order.extend((0..left.len()).filter(|at| !free.contains(&left[*at])));
        let array = array.permuted_axes(IxDyn(&order));
        let mut shape: Vec<usize> = array.shape().to_vec();
        for (at, axis) in free.iter().enumerate() {
            shape[at] = self.coordinate_values(axis).len();
        }
        let whole = array.broadcast(IxDyn(&shape)).map(|view| view.to_owned());
        whole.ok_or_else(|| self.unfit(format!("variable `{name}` does not fit its coordinates")))
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

    /// The radius of `count` points of cases [pt].
    pub fn radius(&self, count: usize) -> f64 {
        let set = self.drawing.marker_mm.map(|diameter| diameter / 2.0 * POINTS_PER_MM);
        set.unwrap_or_else(|| cloud::radius(count))
    }

    /// A parameter over the axis `free`, in SI: the axis of that name, or the variable.
    pub fn parameter<'n>(
        &self,
        name: &'n str,
        free: &[&'n str],
    ) -> Result<ArrayD<f64>, FigureError> {
        let axes = self.axes();
        if !axes.contains(&name) {
            return self.take(name, free);
        }
        let values = self.coordinate_values(name);
        if free.contains(&name) {
            let array = ArrayD::from_shape_vec(IxDyn(&[values.len()]), values)
                .map_err(|error| self.unfit(error.to_string()))?;
            return self.arrange(name, array, vec![name], free);
        }
        let value = values.get(self.held_index(name)).copied().unwrap_or(f64::NAN);
        self.arrange(name, ArrayD::from_elem(IxDyn(&[]), value), Vec::new(), free)
    }

    /// The value at which an axis that is not drawn is held, in SI.
    pub fn held_value(&self, name: &str) -> Option<f64> {
        self.coordinate_values(name).get(self.held_index(name)).copied()
    }

    /// Index at which an axis that is not drawn is held.
    pub fn held_index(&self, name: &str) -> usize {
        self.held.iter().find(|(axis, _)| axis == name).map_or(0, |(_, index)| *index)
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
