//! Ramps drawn at random.

use capsulemap::quantity::Allowed;
use capsulemap::study::{Beginning, Coordinate, Ramp, Study};

use super::Random;

impl Random {
    pub(super) fn ramp(&mut self, study: &Study, name: String) -> Ramp {
        let varied = study.case_set.varied();
        let along = self.free_of(&varied);
        let mut parameters = study.base.clone();
        for coordinate in varied {
            if let Coordinate::Parameter(parameter) = coordinate
                && parameter != along
            {
                parameters[parameter] = self.number(parameter.allowed());
            }
        }
        let mut ends = self.ends(along.allowed());
        if self.is_so() {
            ends.reverse();
        }
        let mut parameters = parameters.with_part(along.into());
        parameters[along] = ends[0];
        let ramp = Ramp {
            name,
            along: along.into(),
            ends,
            rate: 1.0,
            parameters,
            start: self.state().into(),
            start_phase: self.number(Allowed::Finite),
            section_phase: self.number(Allowed::Finite),
            begins: self.one(&Beginning::NAMES).1,
            parts: 1 + self.below(1024) as u32,
        };
        // As many cycles as are allowed.
        let cycles = ramp.most_cycles().expect("a drive");
        Ramp { rate: cycles / self.uniform(1.0, 1e5), ..ramp }
    }
}
