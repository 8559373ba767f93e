//! What a request asks of the results: the axes that it draws, where it holds the others, and what it sets of quantities.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::chosen::Chosen;
use super::error::FigureError;
use super::held::Held;
use super::shown::Shown;
use super::unit::ShownUnit;
use super::varied::varied;
use super::view::View;
use crate::description::Parameter;
use crate::store::catalogue::DIRECTION;
use crate::study::axis::{is_within, range};
use crate::study::{Direction, Drawing};

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
                .map(|unit| ShownUnit::of(name, self.model(), unit, || self.natural_frequency()));
            let unit = unit.transpose().map_err(|why| self.unfit(why))?;
            chosen.insert(name.clone(), Rc::new(Chosen::new(set.clone(), unit)));
        }
        Ok(chosen)
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
}
