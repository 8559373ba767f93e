//! The two outputs that a trade-off is between: what should be large, and what should be small.

use super::front::{REST, speed_at_rest};
use crate::description::{Description, Output, Outputs};
use crate::quantity::Dimension;

/// The outputs that a trade-off is between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GainAndCost {
    /// What should be large, in one of two directions.
    pub gain: Output,
    /// What should be small.
    pub cost: Output,
}

/// What a motion is the best in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Optimum {
    /// The most gain.
    MostGain,
    /// The knee of the front.
    Knee,
    /// The least cost per gain.
    LeastPerGain,
    /// The most gain for no more than a budget.
    MostWithinBudget,
    /// The least cost for a gain that is wanted.
    LeastForGain,
    /// The most gain that tolerances leave.
    MostUnderTolerances,
}

impl GainAndCost {
    /// The gain that a model names, if it names one: the speed of the capsule.
    pub fn own_gain(model: &'static Description) -> Option<Output> {
        model.has_trade_off().then(|| model.speed())
    }

    /// A cost against the gain that its model names; none where that names none.
    pub fn of_cost(cost: Output) -> Option<GainAndCost> {
        GainAndCost::own_gain(cost.model()).map(|gain| GainAndCost { gain, cost })
    }

    /// Whether the gain is the one that the model names, which is told in the words of a speed.
    pub fn has_own_gain(self) -> bool {
        GainAndCost::own_gain(self.gain.model()) == Some(self.gain)
    }

    /// Both outputs.
    pub fn both(self) -> [Output; 2] {
        [self.gain, self.cost]
    }

    /// The output of the model that is told as the cost per gain, whatever the cost; none where it is the cost over the gain.
    pub fn told_per_gain(self) -> Option<Output> {
        self.has_own_gain().then(|| self.gain.model().energy_per_distance())
    }

    /// What is told as the cost per gain of a motion with these outputs (SI).
    pub fn per_gain(self, outputs: &Outputs) -> f64 {
        let told = self.told_per_gain().map(|output| outputs[output]);
        told.unwrap_or_else(|| cost_per_gain(outputs[self.gain], outputs[self.cost]))
    }

    /// The gain up to which a motion counts as one without gain, among motions with these gains (SI): that of [`speed_at_rest`]
    /// where it is a velocity, else a millionth of the largest, as what rounding leaves of others is not known.
    pub fn at_rest(self, gains: impl IntoIterator<Item = f64>) -> f64 {
        match self.gain.dimension() {
            Dimension::Velocity => speed_at_rest(gains),
            _ => gains.into_iter().fold(0.0, |most: f64, gain| most.max(REST * gain.abs())),
        }
    }
}

impl Optimum {
    /// Its name in JSON and in tables.
    pub fn name(self, of: GainAndCost) -> &'static str {
        let [of_speed, of_others] = match self {
            Optimum::MostGain => ["fastest", "most_gain"],
            Optimum::Knee => ["knee"; 2],
            Optimum::LeastPerGain => ["lowest_cost_of_transport", "least_cost_per_gain"],
            Optimum::MostWithinBudget => ["fastest_within_budget", "most_gain_within_budget"],
            Optimum::LeastForGain => ["least_for_speed", "least_cost_for_gain"],
            Optimum::MostUnderTolerances => {
                ["fastest_under_tolerances", "most_gain_under_tolerances"]
            }
        };
        if of.has_own_gain() { of_speed } else { of_others }
    }
}

/// The cost over the magnitude of the gain; infinite where there is no gain, and NaN where the cost is below zero, so that less of it
/// per gain would be worse.
pub fn cost_per_gain(gain: f64, cost: f64) -> f64 {
    if cost >= 0.0 { cost / gain.abs() } else { f64::NAN }
}

/// The unit of an output as it stands behind a number; nothing where it has none.
pub fn unit_behind(output: Output) -> String {
    match output.unit() {
        "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capsule;

    #[test]
    fn the_speed_is_told_in_its_own_words_and_others_as_gains() {
        let cost = Output::from(capsule::Output::Power);
        let own = GainAndCost::of_cost(cost).expect("the capsule has a speed");
        assert_eq!(own.gain, Output::from(capsule::Output::ProgressionSpeed));
        assert_eq!(own.told_per_gain(), Some(Output::from(capsule::Output::EnergyPerMetre)));
        let other = GainAndCost { gain: capsule::Output::WorkNet.into(), ..own };
        assert!(own.has_own_gain() && !other.has_own_gain() && other.told_per_gain().is_none());
        let names = [own, other].map(|of| Optimum::LeastPerGain.name(of));
        assert_eq!(names, ["lowest_cost_of_transport", "least_cost_per_gain"]);
        // Only of a velocity is it known what rounding leaves.
        let least = [own, other].map(|of| of.at_rest([1e-17, -3e-17]));
        assert_eq!(least, [1e-10, REST * 3e-17]);
    }

    #[test]
    fn a_cost_below_zero_has_no_least_per_gain() {
        assert_eq!(cost_per_gain(-2.0, 3.0), 1.5);
        assert_eq!(cost_per_gain(0.0, 3.0), f64::INFINITY);
        assert!(cost_per_gain(1.0, -3.0).is_nan() && cost_per_gain(0.0, 0.0).is_nan());
    }
}
