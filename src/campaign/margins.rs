//! How far the parameters of a motion may fall and rise before it ends or its events change.

use crate::capsule::{AsPrinted, CapsuleSystem, Filippov, Parameter, Reading, Switching};
use crate::run::on_all_threads;
use crate::tradeoff::{Family, Margins, Side, margin};

use super::error::CampaignError;
use super::motion_row::Row;
use super::refined_front::{Refinement, Whereabouts};

/// So far a parameter is followed down and up, as a share of its value.
pub const REACH: f64 = 0.5;

impl Refinement<'_> {
    /// The margins of each of some motions along each parameter that varies and is not zero, whatever the bounds of the study; none
    /// where a motion does not repeat or is not stable. Calls `done` after each motion. See [`margin`].
    ///
    /// Fails if the file cannot be read or a case cannot be computed again.
    pub fn margins(
        &self,
        rows: &[&Row],
        (threads, done): (Option<usize>, impl Fn() + Sync),
    ) -> Result<Vec<Vec<Margins>>, CampaignError> {
        let found = on_all_threads(threads, rows.len(), |number| {
            let whereabouts = self.whereabouts(rows[number])?;
            let found = whereabouts.map_or(Vec::new(), |motion| self.around(&motion));
            done();
            Ok(found)
        })?;
        found.into_iter().collect()
    }

    fn around(&self, motion: &Whereabouts) -> Vec<Margins> {
        let free = self.free().into_iter().map(|(parameter, _)| parameter);
        let both = |parameter: Parameter| match self.study.base.switching {
            Switching::Filippov => self.along::<Filippov>(motion, parameter),
            Switching::AsPrinted => self.along::<AsPrinted>(motion, parameter),
        };
        free.filter(|it| motion.parameters[*it] > 0.0).filter_map(both).collect()
    }

    fn along<R: Reading>(&self, motion: &Whereabouts, parameter: Parameter) -> Option<Margins> {
        let value = motion.parameters[parameter];
        let system = CapsuleSystem::<R>::new(motion.parameters.clone(), motion.phase);
        let free = vec![(parameter, [value * (1.0 - REACH), value * (1.0 + REACH)])];
        let tolerance = self.study.protocol.tolerance;
        let family = Family { system, free, period: motion.period, tolerance };
        let at = family.orbit(&family.shares(), &motion.section)?;
        let [down, up] = [Side::Lower, Side::Upper].map(|side| margin(&family, &at, side));
        Some(Margins { parameter, down, up })
    }
}
