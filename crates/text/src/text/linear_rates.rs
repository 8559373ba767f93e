//! Rates that are linear in the states, by which the record of a state tells of others that were not recorded.

use capsulemap_models::description::Description;

use crate::text::described::program_of;
use crate::text::linear::linear;

/// A rate as a sum: factors times states, and a constant.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearRate {
    /// The states by their places, each with its factor; none twice.
    pub factors: Vec<(usize, f64)>,
    /// What is left.
    pub constant: f64,
}

/// The rate of each state of the model of a text; none where it is not linear in the states, with numbers for factors, whatever the
/// parameters are.
///
/// # Panics
/// Where it is not the model of a text.
pub fn linear_rates(model: &'static Description) -> Vec<Option<LinearRate>> {
    let text = &program_of(model).text;
    // Sums add values to it.
    let mut graph = text.graph.clone();
    let mut rates = Vec::with_capacity(text.rates.len());
    for rate in &text.rates {
        let found = linear(&mut graph, *rate);
        let numbers = found.and_then(|it| {
            let factor = |(state, id): &(usize, _)| Some((*state, graph.number_of(*id)?));
            let factors = it.factors.iter().map(factor).collect::<Option<_>>()?;
            Some(LinearRate { factors, constant: graph.number_of(it.constant)? })
        });
        rates.push(numbers);
    }
    rates
}
