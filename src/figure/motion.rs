//! The stored motion of a case over time, and what follows from it.

use super::error::FigureError;
use super::view::View;
use crate::capsule::{Forces, Parameter, Parameters, Resistance, State, Switching};
use crate::store::catalogue::{
    Entry, HISTORY_CONTACT, HISTORY_FRICTION, HISTORY_R, HISTORY_TIME, HISTORY_X1, HISTORY_X2,
    HISTORY_Y1, HISTORY_Y2, RELATIVE_VELOCITY,
};
use crate::store::schema::{RESISTANCE, SWITCHING};

/// What the quantity called `name` is found from.
pub fn sources(name: &str) -> Vec<Entry> {
    match name {
        _ if name == HISTORY_X1.name => vec![HISTORY_X2, HISTORY_R],
        _ if name == RELATIVE_VELOCITY.name => vec![HISTORY_Y1, HISTORY_Y2],
        _ if name == HISTORY_CONTACT.name || name == HISTORY_FRICTION.name => {
            let parameters = Parameter::ALL.iter().map(|it| Entry::of_parameter(*it));
            parameters.chain([HISTORY_R, HISTORY_Y1, HISTORY_Y2]).collect()
        }
        _ => Vec::new(),
    }
}

/// A case of a figure, by its place among those over the axes `free`.
pub struct Motion<'v, 'a> {
    view: &'v View<'a>,
    free: &'v [&'v str],
    case: usize,
}

impl<'v, 'a> Motion<'v, 'a> {
    /// The motion of a case.
    pub fn new(view: &'v View<'a>, free: &'v [&'v str], case: usize) -> Motion<'v, 'a> {
        Motion { view, free, case }
    }

    /// The cycles of its samples, counted from its start.
    pub fn cycles(&self) -> Result<Vec<f64>, FigureError> {
        let cycles = self.view.coordinate_values(HISTORY_TIME.name);
        if cycles.is_empty() { Err(self.view.without_histories()) } else { Ok(cycles) }
    }

    /// Its samples of the quantity called `name`, in the unit of the figure.
    pub fn shown(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let factor = self.view.quantity(name).factor;
        Ok(self.samples(name)?.into_iter().map(|value| value * factor).collect())
    }

    /// The same in SI.
    fn samples(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let both = |a: Entry, b: Entry, of: fn(f64, f64) -> f64| {
            let (a, b) = (self.stored(a.name)?, self.stored(b.name)?);
            Ok(a.into_iter().zip(b).map(|(a, b)| of(a, b)).collect())
        };
        match name {
            _ if name == HISTORY_X1.name => both(HISTORY_X2, HISTORY_R, |x2, r| x2 + r),
            _ if name == RELATIVE_VELOCITY.name => both(HISTORY_Y1, HISTORY_Y2, |y1, y2| y1 - y2),
            _ if name == HISTORY_CONTACT.name => self.forces(|forces| forces.contact),
            _ if name == HISTORY_FRICTION.name => {
                let reading = self.view.dataset.attributes.get(SWITCHING).map(String::as_str);
                if reading == Some(Switching::AsPrinted.name()) {
                    let why = "the friction at rest is not that of the equation as printed";
                    return Err(self.view.unfit(why));
                }
                self.forces(|forces| forces.friction)
            }
            _ => self.stored(name),
        }
    }

    /// The samples of a variable.
    fn stored(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let count = self.cycles()?.len();
        let all = self.view.take(name, self.free)?;
        Ok(all.iter().skip(self.case * count).take(count).copied().collect())
    }

    /// A force at each sample.
    fn forces(&self, of: impl Fn(Forces) -> f64) -> Result<Vec<f64>, FigureError> {
        let mut parameters = Parameters::default();
        for &parameter in Parameter::ALL {
            let values = self.view.parameter(parameter.symbol(), self.free)?;
            parameters[parameter] = values.iter().nth(self.case).copied().unwrap_or(f64::NAN);
        }
        let law = self.view.dataset.attributes.get(RESISTANCE);
        let law = Resistance::NAMES.iter().find(|it| Some(it.0) == law.map(String::as_str));
        let Some(&(_, law)) = law else {
            return Err(self.view.unfit("the results do not name their law of resistance"));
        };
        parameters.resistance = law;
        let [r, y1, y2] = [HISTORY_R, HISTORY_Y1, HISTORY_Y2].map(|it| self.stored(it.name));
        let states = r?.into_iter().zip(y1?).zip(y2?);
        let state = |((r, y1), y2): ((f64, f64), f64)| State { r, y1, x2: 0.0, y2 };
        Ok(states.map(|it| of(parameters.forces(&state(it)))).collect())
    }
}
