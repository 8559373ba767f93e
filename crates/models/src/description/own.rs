//! Outputs that a study defines over those of a model, which the description of a model of its own has behind them.

use std::fmt::{self, Debug, Formatter};

use super::{Description, Output, Outputs, Parameter, Parameters};

/// What own outputs are, by the values of parameters and of the outputs of the model (SI, in its order).
pub trait Definitions: Send + Sync {
    /// The own outputs, in their order.
    fn values(&self, parameters: &[f64], outputs: &[f64]) -> Vec<f64>;

    /// Their derivatives, by those of the parameters and of the outputs.
    fn slopes(&self, parameters: [&[f64]; 2], outputs: [&[f64]; 2]) -> Vec<f64>;

    /// The parameters that they use, by their places, each with the name of an own output that does.
    fn parameters(&self) -> &[(usize, String)];
}

/// Outputs that are defined over those of the model that a description extends.
#[derive(Clone, Copy)]
pub struct OwnOutputs {
    /// What they are.
    pub definitions: &'static dyn Definitions,
    /// The table of a study that says them, which differs where they do.
    pub table: &'static str,
}

impl Debug for OwnOutputs {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("OwnOutputs").field(&self.table).finish()
    }
}

impl Description {
    /// The model without the outputs that a study defines.
    pub fn without_own(&'static self) -> &'static Description {
        match (self.own, self.extends) {
            (Some(_), Some(model)) => model,
            _ => self,
        }
    }

    /// The outputs that a study defines.
    pub fn own_outputs(&'static self) -> impl Iterator<Item = Output> {
        self.outputs().skip(self.without_own().outputs.len())
    }

    /// The parameters that these use, each with the name of one that does.
    pub fn used_by_own(&'static self) -> impl Iterator<Item = (Parameter, &'static str)> {
        let used = self.own.map_or(&[][..], |it| it.definitions.parameters());
        used.iter().map(move |(place, name)| (Parameter::of(self, *place), name.as_str()))
    }
}

impl Parameters {
    /// The same of the model without the outputs that a study defines.
    pub fn without_own(&self) -> Parameters {
        let mut parameters = self.clone();
        parameters.model = self.model.without_own();
        parameters
    }
}

impl Outputs {
    /// The same with those that a study defines, by the values of the parameters; nothing is known of these where nothing is
    /// known of the others.
    ///
    /// # Panics
    /// Where these are no outputs of the model without them.
    pub fn with_own(&self, parameters: &Parameters) -> Outputs {
        self.extended(parameters.model, |own| own.values(&parameters.values, &self.values))
    }

    /// Derivatives in a parameter of `values`, with those of the outputs that a study defines.
    ///
    /// Method: the chain rule.
    ///
    /// # Panics
    /// As [`Outputs::with_own`].
    pub fn slopes_with_own(
        &self,
        parameters: &Parameters,
        values: &Outputs,
        parameter: Parameter,
    ) -> Outputs {
        let mut direction = vec![0.0; parameters.values.len()];
        direction[parameter.index()] = 1.0;
        self.extended(parameters.model, |own| {
            own.slopes([&parameters.values, &direction], [&values.values, &self.values])
        })
    }

    fn extended(
        &self,
        model: &'static Description,
        own: impl Fn(&dyn Definitions) -> Vec<f64>,
    ) -> Outputs {
        let is_known = self.values.iter().any(|it| !it.is_nan());
        let Some(OwnOutputs { definitions, .. }) = model.own.filter(|_| is_known) else {
            return Outputs::unknown(model);
        };
        Outputs::new(model, &[&self.values[..], &own(definitions)].concat())
    }
}
