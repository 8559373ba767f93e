//! A value for every parameter of a model, and what is chosen beside them.

use std::f64::consts::PI;
use std::fmt::{self, Debug, Formatter};
use std::ops::{Index, IndexMut};

use super::{Choice, Description, Parameter, Presence};
use crate::quantity::Dimension;

/// A value for every parameter of a model (SI), and what is chosen beside them.
///
/// A parameter that the equations have only where it is given ([`Presence`]) is given once it has been written to, be it with its
/// default.
#[derive(Clone, PartialEq)]
pub struct Parameters {
    pub(super) model: &'static Description,
    pub(super) values: Vec<f64>,
    chosen: Vec<usize>,
    /// Those that the equations have only where they are given and that are, as bits by place.
    given: u64,
}

/// As fingerprints of studies have it: what is optional is in it only where it is given.
impl Debug for Parameters {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Parameters");
        let always = self.each().filter(|(it, _)| it.presence() != Presence::Optional);
        text.field("values", &always.map(|(_, value)| value).collect::<Vec<f64>>());
        let optional = self.stated().filter(|(it, _)| it.presence() == Presence::Optional);
        for (parameter, value) in optional {
            text.field(&format!("{parameter:?}"), &value);
        }
        for (choice, option) in self.stated_options() {
            text.field(choice.tag, &format_args!("{}", choice.option_tags[option]));
        }
        text.finish()
    }
}

/// A parameter whose value is not allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    /// Which parameter.
    pub parameter: Parameter,
    /// The value it was given.
    pub value: f64,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Fault { parameter, value } = self;
        let (symbol, meaning) = (parameter.symbol(), parameter.meaning());
        let unit = match parameter.dimension() {
            Dimension::Number => String::new(),
            dimension => format!(" {}", dimension.unit()),
        };
        write!(f, "{symbol} ({meaning}) = {value}{unit}: must be {}", parameter.allowed())
    }
}

impl Parameters {
    /// The defaults of a model.
    pub fn of(model: &'static Description) -> Parameters {
        let values = model.parameters.iter().map(|it| it.default).collect();
        Parameters { model, values, chosen: vec![0; model.choices.len()], given: 0 }
    }

    /// The same as those of a model that extends theirs, whose own are at their defaults.
    ///
    /// # Panics
    /// Where it extends another model.
    pub fn of_extension(&self, model: &'static Description) -> Parameters {
        let (own, of) = (self.model.name, model.name);
        assert!(model.extends == Some(self.model), "{of} does not extend {own}");
        let mut parameters = Parameters::of(model);
        parameters.values[..self.values.len()].copy_from_slice(&self.values);
        parameters.chosen.clone_from(&self.chosen);
        parameters.given = self.given;
        parameters
    }

    /// The model whose parameters they are.
    pub fn model(&self) -> &'static Description {
        self.model
    }

    /// Every parameter with its value (SI).
    pub fn each(&self) -> impl Iterator<Item = (Parameter, f64)> + '_ {
        self.model.parameters().zip(self.values.iter().copied())
    }

    /// Those that there is something to tell of: all but the optional ones that are not given.
    pub fn stated(&self) -> impl Iterator<Item = (Parameter, f64)> + '_ {
        self.each().filter(|(it, _)| self.states(*it))
    }

    /// Whether there is something to tell of a parameter: one that is optional has to be given, and none in the stead of another.
    pub fn states(&self, parameter: Parameter) -> bool {
        let is_there = parameter.presence() != Presence::Optional || self.is_given(parameter);
        is_there && !parameter.replaced_by().any(|it| self.is_given(it))
    }

    /// Whether a parameter that the equations have only where it is given has been given.
    pub fn is_given(&self, parameter: Parameter) -> bool {
        self.given >> place(self.model, parameter) & 1 != 0
    }

    /// The places of those that the equations have only where they are given and that are, as bits.
    pub fn given_places(&self) -> u64 {
        self.given
    }

    /// They where the equations have a parameter, as where it varies.
    pub fn with_part(mut self, parameter: Parameter) -> Parameters {
        // To be borrowed to be written to is to be given.
        let _ = &mut self[parameter];
        self
    }

    /// Takes the value of a parameter over from others, and whether it is given.
    pub fn take(&mut self, parameter: Parameter, other: &Parameters) {
        let place = place(self.model, parameter);
        self.values[place] = other[parameter];
        self.given = (self.given & !(1 << place)) | (other.given & (1 << place));
        if let Some(replaced) = parameter.replaces().filter(|_| other.is_given(parameter)) {
            self.values[replaced.index()] = other[replaced];
        }
    }

    /// What is chosen otherwise than usual, each by its name with the name of what is chosen.
    pub fn unusual_choices(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        let chosen = self.stated_options().filter(|(_, option)| *option > 0);
        chosen.map(|(choice, option)| (choice.name, choice.options[option]))
    }

    /// Whether the equations have anything that is optional.
    pub fn have_optional_parts(&self) -> bool {
        let is_chosen = |(choice, option): (&Choice, usize)| choice.is_optional && option > 0;
        let is_given = |it: Parameter| it.presence() == Presence::Optional && self.is_given(it);
        self.model.parameters().any(is_given) || self.stated_options().any(is_chosen)
    }

    /// The period of the drive [s]; none of a model without one.
    pub fn period_of_drive(&self) -> Option<f64> {
        if let Some(cycle) = self.model.roles.drive?.cycle {
            return Some(cycle(self));
        }
        let by_period = self.model.drive_period().filter(|it| self.is_given(*it));
        let by_frequency = || Some(2.0 * PI / self[self.model.drive_frequency()?]);
        by_period.map_or_else(by_frequency, |it| Some(self[it]))
    }

    /// Every value that is not allowed.
    pub fn faults(&self) -> Vec<Fault> {
        let faults = self.each().map(|(parameter, value)| Fault { parameter, value });
        faults.filter(|it| !it.parameter.allowed().admits(it.value)).collect()
    }

    /// What is chosen at a place among the choices of the model, as the place among its options.
    pub fn chosen(&self, choice: usize) -> usize {
        self.chosen[choice]
    }

    /// Chooses the option at a place for the choice at another.
    pub fn choose(&mut self, choice: usize, option: usize) {
        self.chosen[choice] = option;
    }

    /// Each choice that there is something to tell of by its name, with the name of what is chosen.
    pub fn choices(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        self.stated_options().map(|(choice, option)| (choice.name, choice.options[option]))
    }

    /// The choices that there is something to tell of, each with the place of what is chosen.
    fn stated_options(&self) -> impl Iterator<Item = (&'static Choice, usize)> + '_ {
        let both = self.model.choices.iter().zip(self.chosen.iter().copied());
        both.filter(|(choice, option)| !choice.is_optional || *option > 0)
    }
}

/// Of the model's own parameters.
///
/// # Panics
/// Where the parameter is that of another model.
impl<P: Into<Parameter>> Index<P> for Parameters {
    type Output = f64;
    fn index(&self, parameter: P) -> &f64 {
        &self.values[place(self.model, parameter.into())]
    }
}

impl<P: Into<Parameter>> IndexMut<P> for Parameters {
    fn index_mut(&mut self, parameter: P) -> &mut f64 {
        let place = place(self.model, parameter.into());
        let described = &self.model.parameters[place];
        if described.presence != Presence::Always {
            self.given |= 1 << place;
        }
        // What it stands in place of has no value of its own any more.
        if let Some(replaced) = described.replaces {
            self.values[replaced] = self.model.parameters[replaced].default;
        }
        &mut self.values[place]
    }
}

/// The place of a parameter of a model.
fn place(model: &'static Description, parameter: Parameter) -> usize {
    let is_its = parameter.model().shares_with(model) && parameter.index() < model.parameters.len();
    assert!(is_its, "{} is no parameter of {}", parameter.symbol(), model.name);
    parameter.index()
}
