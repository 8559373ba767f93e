//! A periodic orbit at some values of free parameters, with the derivatives of what a trade-off is between.

use super::limit::Limit;
use super::quadratic::{MOST, Vector};
use crate::description::{Output, Outputs, Parameter, Section};
use crate::model::{Model, Setting, StableOrbit};
use crate::orbit::matrix::Complex;

/// A family of periodic orbits over free parameters, each between two bounds.
#[derive(Debug, Clone)]
pub struct Family {
    /// The model.
    pub model: &'static dyn Model,
    /// The parameters that are held, and the phase of the drive at the section.
    pub setting: Setting,
    /// The free parameters with their bounds, at most [`MOST`].
    pub free: Vec<(Parameter, [f64; 2])>,
    /// Limits of outputs within which an orbit is sought that is best, at most [`MOST_LIMITS`](super::MOST_LIMITS).
    pub limits: Vec<Limit>,
    /// Period of the orbits [cycles].
    pub period: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// A stable orbit of a family.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatingPoint {
    /// The free parameters as shares of the ranges between their bounds.
    pub shares: Vector,
    /// The section point.
    pub section: Section,
    /// The multipliers, the largest magnitude first.
    pub multipliers: Vec<Complex>,
    /// The cyclic sequence of events, by their numbers.
    pub events: Vec<u8>,
    /// How many of them are impacts.
    pub impacts: usize,
    /// The outputs that change with parameters (SI).
    pub outputs: Outputs,
    /// The derivatives of the section point in the shares.
    pub section_slopes: [Section; MOST],
    /// The derivatives of the outputs in the shares.
    pub slopes: [Outputs; MOST],
}

impl OperatingPoint {
    /// How far it is from another, in shares of the ranges: the most of a parameter.
    pub fn apart(&self, other: &OperatingPoint) -> f64 {
        let pairs = self.shares.iter().zip(&other.shares);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    }

    /// The derivatives of an output in the shares.
    pub fn gradient(&self, output: Output, count: usize) -> Vector {
        std::array::from_fn(|i| if i < count { self.slopes[i][output] } else { 0.0 })
    }
}

impl Family {
    /// The value of the `place`th free parameter at a share of its range.
    pub fn value(&self, place: usize, share: f64) -> f64 {
        let [low, high] = self.free[place].1;
        if share == 1.0 { high } else { low + share * (high - low) }
    }

    /// The shares of the parameters of the setting.
    pub fn shares(&self) -> Vector {
        std::array::from_fn(|place| {
            self.free.get(place).map_or(0.0, |(parameter, [low, high])| {
                (self.setting.parameters[*parameter] - low) / (high - low)
            })
        })
    }

    /// The setting at these shares.
    pub fn at(&self, shares: &Vector) -> Setting {
        let mut setting = self.setting.clone();
        for (place, (parameter, _)) in self.free.iter().enumerate() {
            setting.parameters[*parameter] = self.value(place, shares[place]);
        }
        setting
    }

    /// The stable orbit at these shares near a section point; none where there is none.
    ///
    /// # Method
    ///
    /// Newton's method on the return map, down to rounding, then its sensitivity to each parameter.
    pub fn orbit(&self, shares: &Vector, guess: &Section) -> Option<OperatingPoint> {
        let setting = self.at(shares);
        let (period, tolerance) = (self.period, self.tolerance);
        let StableOrbit { section, multipliers, events, impacts } =
            self.model.stable_orbit(&setting, guess, period, tolerance)?;
        let unknown = Outputs::unknown(setting.parameters.model());
        let mut point = OperatingPoint {
            shares: *shares,
            section,
            multipliers,
            events,
            impacts,
            outputs: unknown.clone(),
            section_slopes: [Section::new(&[]); MOST],
            slopes: std::array::from_fn(|_| unknown.clone()),
        };
        for (place, (parameter, [low, high])) in self.free.iter().enumerate() {
            let found =
                self.model.sensitivity(&setting, &section, period, tolerance, *parameter)?;
            let range = high - low;
            point.outputs = found.outputs;
            point.section_slopes[place] =
                found.section_slope.iter().map(|slope| slope * range).collect();
            point.slopes[place] = found.slopes.map(|slope| slope * range);
        }
        Some(point)
    }

    /// The stable orbit at other shares, sought where that at `from` leads along its tangent.
    pub fn moved(&self, from: &OperatingPoint, shares: &Vector) -> Option<OperatingPoint> {
        let slopes = &from.section_slopes[..self.free.len()];
        let guess = (0..from.section.len()).map(|coordinate| {
            let along = slopes.iter().zip(shares.iter().zip(&from.shares));
            let moved: f64 = along.map(|(slope, (to, at))| slope[coordinate] * (to - at)).sum();
            from.section[coordinate] + moved
        });
        self.orbit(shares, &guess.collect())
    }
}
