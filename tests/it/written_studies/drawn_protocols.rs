//! Protocols drawn at random.

use capsulemap::orbit::{Exponents, HistorySpan, Protocol};

use super::Random;

impl Random {
    pub(super) fn protocol(&mut self) -> Protocol {
        let tolerance = |random: &mut Random| libm::exp10(random.uniform(-15.0, -3.0));
        let from = HistorySpan {
            cycles: 1 + self.below(9) as u32,
            per_cycle: 1 + self.below(99) as u32,
            from_start: self.is_so(),
        };
        let exponent_cycles = self.one(&[0, 16, 2048, 1_000_000]);
        let all = exponent_cycles > 0 && self.is_so();
        Protocol {
            exponents: if all { Exponents::All } else { Exponents::Largest },
            mean_error: self.is_so().then(|| self.uniform(1e-5, 0.5)),
            tolerance: tolerance(self).clamp(1e-15, 1e-3),
            recurrence: tolerance(self).clamp(1e-15, 1e-3),
            max_cycles: 1 + (self.bits() >> self.one(&[1, 50])) / 2,
            max_steps: 1 + (self.bits() >> self.one(&[1, 50])) / 2,
            max_period: 1 + self.below(100_000),
            measured_cycles: 1 + self.below(1000) as u64,
            exponent_cycles,
            exponent_error: self.uniform(1e-4, 0.1),
            points: self.below(100),
            impact_points: self.below(100),
            accelerate: self.is_so(),
            history: self.is_so().then_some(from),
        }
    }
}
