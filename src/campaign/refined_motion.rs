//! A motion between the cases of a study: where it is, what it gives, and what keeps it from being better.

use serde::{Deserialize, Serialize};

use crate::description::{Description, Output, Outputs, Parameter, Parameters, Section, State};
use crate::study::Coordinate;
use crate::tradeoff::{Candidate, Family, GainAndCost, Hold, Side};

/// Said of a motion whose search has not converged.
const NOT_CONVERGED: &str = "not converged";

/// What a search begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Start {
    /// The motion of a case of the file.
    Case(usize),
    /// The motion that a point of the ranges settles to from rest.
    Drawn {
        /// The number by which points are drawn.
        seed: u64,
        /// Its number among them.
        drawn: usize,
    },
}

/// A periodic motion that a drawn point settles to.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnMotion {
    /// The number of the point.
    pub number: usize,
    /// Its parameters.
    pub parameters: Parameters,
    /// A section point of its orbit (SI).
    pub section: Section,
    /// Its period [cycles].
    pub period: u64,
    /// Its outputs (SI).
    pub outputs: Outputs,
}

/// A motion of the refined front.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedMotion {
    /// The motion that was followed to it.
    pub from: Start,
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

impl RefinedMotion {
    /// The motion as one that takes part in a trade-off, under this number and with this gain and this cost.
    pub fn candidate(&self, case: usize, of: GainAndCost) -> Candidate {
        Candidate {
            case,
            gain: self.outputs[of.gain],
            price: self.outputs[of.cost],
            per_gain: of.per_gain(&self.outputs),
        }
    }

    /// Whether the search has not converged, so that a better motion may lie beside it.
    pub fn is_open(&self) -> bool {
        self.slopes.held_by.iter().any(|hold| hold == NOT_CONVERGED)
    }

    /// Whether another motion is this one: in period and in what motions of the model gain and cost, or, where it names none of that, in
    /// all outputs with derivatives.
    fn is_same(&self, other: &RefinedMotion) -> bool {
        let told_apart = told_apart(self.outputs.model());
        let mut both = told_apart.iter().map(|it| (self.outputs[*it], other.outputs[*it]));
        self.period == other.period && both.all(|(a, b)| a == b || (a - b).abs() <= SAME * a.abs())
    }

    /// The value of a coordinate (SI); that of its start is its section point.
    pub fn coordinate(&self, coordinate: Coordinate) -> f64 {
        match coordinate {
            Coordinate::Parameter(parameter) => self.parameters[parameter],
            Coordinate::Start(of_state) => {
                State::at_section(self.parameters.model(), &self.section)[of_state]
            }
            Coordinate::StartPhase | Coordinate::SectionPhase => self.phase,
        }
    }
}

/// How gain and price of a periodic motion change with the parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Slopes {
    /// Percent of gain and of price per percent of each parameter that is not zero.
    pub sensitivity: Vec<(Parameter, [f64; 2])>,
    /// The largest relative slope of gain left at this price, for the whole range of a parameter [-]; none where no parameter
    /// is free.
    pub stationarity: Option<f64>,
    /// What keeps it from being better, in words.
    pub held_by: Vec<String>,
}

/// What searches have led to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Led {
    /// Motions to which plain integration leads, and that keep the conditions.
    pub motions: Vec<RefinedMotion>,
    /// How many orbits were found that are none of these.
    pub unsettled: usize,
}

impl Led {
    /// Adds an orbit that was found: a motion, or none.
    pub(super) fn add(&mut self, found: Option<RefinedMotion>) {
        match found {
            Some(motion) => self.motions.push(motion),
            None => self.unsettled += 1,
        }
    }
}

/// Motions that agree in these to this share are one.
const SAME: f64 = 1e-8;

/// The outputs by which motions are told apart.
fn told_apart(model: &'static Description) -> Vec<Output> {
    match model.has_trade_off() {
        true => vec![model.speed(), model.work(), model.power(), model.energy_per_distance()],
        false => model.outputs().filter(|it| it.is_smooth()).collect(),
    }
}

/// The motions without those that another search has led to already; of equal ones that with the least slope left.
pub fn distinct(found: Vec<RefinedMotion>) -> Vec<RefinedMotion> {
    let mut distinct: Vec<RefinedMotion> = Vec::new();
    for motion in found {
        match distinct.iter_mut().find(|other| other.is_same(&motion)) {
            Some(other) if motion.slopes.stationarity < other.slopes.stationarity => {
                *other = motion;
            }
            Some(_) => {}
            None => distinct.push(motion),
        }
    }
    distinct
}

/// What holds a motion, in words.
pub(super) fn words(holds: &[Hold], family: &Family) -> Vec<String> {
    let words = holds.iter().map(|hold| match hold {
        Hold::Interior => "interior".to_owned(),
        Hold::Bound(place, side) => {
            let side = if *side == Side::Lower { "lower" } else { "upper" };
            format!("{side} bound of {}", family.free[*place].0.symbol())
        }
        Hold::Limit(place) => format!("limit of {}", family.limits[*place].output.name()),
        Hold::Fold => "fold".to_owned(),
        Hold::PeriodDoubling => "period doubling".to_owned(),
        Hold::NeimarkSacker => "Neimark-Sacker".to_owned(),
        Hold::Grazing => "grazing".to_owned(),
        Hold::EventSequence => "event sequence".to_owned(),
        Hold::Steps => NOT_CONVERGED.to_owned(),
    });
    words.collect()
}
