//! A motion between the cases of a study: where it is, what it gives, and what keeps it from being better.

use crate::capsule::{Outputs, Parameter, Parameters, Section};
use crate::tradeoff::{Hold, Side};

/// A motion of the refined front.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedMotion {
    /// The case whose orbit was followed to it.
    pub from: usize,
    /// Its parameters.
    pub parameters: Parameters,
    /// Its section point (SI).
    pub section: Section,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
    /// Period [cycles].
    pub period: u64,
    /// The outputs of the motion that starts at the section point (SI).
    pub outputs: Outputs,
    /// How it changes with the parameters.
    pub slopes: Slopes,
}

/// How speed and price of a periodic motion change with the parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Slopes {
    /// Percent of speed and of price per percent of each parameter that is not zero.
    pub sensitivity: Vec<(Parameter, [f64; 2])>,
    /// The largest relative slope of speed left at this price, for the whole range of a parameter [-]; none where no parameter
    /// is free.
    pub stationarity: Option<f64>,
    /// What keeps it from being better, in words.
    pub held_by: Vec<String>,
}

/// What holds a motion, in words.
pub(super) fn words(holds: &[Hold], free: &[(Parameter, [f64; 2])]) -> Vec<String> {
    let in_words = |hold: &Hold| match hold {
        Hold::Interior => "interior".to_owned(),
        Hold::Bound(place, side) => {
            let side = if *side == Side::Lower { "lower" } else { "upper" };
            format!("{side} bound of {}", free[*place].0.symbol())
        }
        Hold::Fold => "fold".to_owned(),
        Hold::PeriodDoubling => "period doubling".to_owned(),
        Hold::NeimarkSacker => "Neimark-Sacker".to_owned(),
        Hold::Grazing => "grazing".to_owned(),
        Hold::EventSequence => "event sequence".to_owned(),
        Hold::Steps => "not converged".to_owned(),
    };
    holds.iter().map(in_words).collect()
}
