//! The orbits beyond the surfaces near an orbit: they tell where events change.

use crate::orbit::matrix::dot;

use super::goal::{Measured, Objective};
use super::operating_point::{Family, OperatingPoint};
use super::quadratic::{SURFACES, Vector};
use super::surface::Surface;

/// Where an orbit towards a surface has the same events, one so many times farther is tried.
const FARTHER: f64 = 4.0;
/// Orbits beyond a surface tell of it within this many radii of trust, or nearer than this share of the ranges.
const REACH: [f64; 2] = [4.0, 1e-3];
/// Orbits with other events that are kept.
const KEPT: usize = 8;

/// Orbits with other events than the present one has, the nearest of each sequence.
pub struct Beyond<'a> {
    family: &'a Family,
    objective: Objective,
    orbits: Vec<OperatingPoint>,
}

impl<'a> Beyond<'a> {
    /// None yet.
    pub fn of(family: &'a Family, objective: Objective) -> Self {
        Beyond { family, objective, orbits: Vec::new() }
    }

    /// Keeps two orbits if their events differ; of each sequence the one that is nearer to the first of the two.
    pub fn remember(&mut self, at: &OperatingPoint, trial: &OperatingPoint) {
        if at.events == trial.events {
            return;
        }
        let nearer = self
            .orbits
            .iter()
            .find(|it| it.events == trial.events && it.apart(at) < trial.apart(at));
        let nearest = nearer.unwrap_or(trial).clone();
        self.orbits.retain(|it| it.events != at.events && it.events != trial.events);
        self.orbits.extend([at.clone(), nearest]);
        let excess = self.orbits.len().saturating_sub(KEPT);
        self.orbits.drain(..excess);
    }

    /// The nearest surfaces within reach of an orbit, each located by an orbit just beyond it, and none where the events
    /// straight towards it stay the same.
    pub fn located(&mut self, here: &Measured, trust: f64) -> Vec<Surface> {
        for surface in self.near(here, trust) {
            if !surface.is_located() {
                match self.just_beyond(&here.orbit, &surface) {
                    Some(beyond) => self.remember(&here.orbit, &beyond),
                    None => self.orbits.retain(|it| it.events != surface.beyond.orbit.events),
                }
            }
        }
        self.near(here, trust)
    }

    /// The first orbit with the events beyond a surface, straight towards it; none within its reach.
    fn just_beyond(&self, at: &OperatingPoint, surface: &Surface) -> Option<OperatingPoint> {
        let mut far = surface.just_beyond();
        while far < surface.reach {
            let probe = self.moved_along(at, surface, far)?;
            if probe.events == surface.beyond.orbit.events {
                return Some(probe);
            }
            // As long as the events are the same, the surface is farther than it seems.
            far *= FARTHER;
        }
        None
    }

    /// The orbit so far towards a surface, within the bounds.
    fn moved_along(
        &self,
        at: &OperatingPoint,
        surface: &Surface,
        far: f64,
    ) -> Option<OperatingPoint> {
        let along: Vector = std::array::from_fn(|i| {
            let leaves = at.shares[i] <= 0.0 && surface.normal[i] < 0.0
                || at.shares[i] >= 1.0 && surface.normal[i] > 0.0;
            if leaves { 0.0 } else { surface.normal[i] }
        });
        let steep = dot(&along, &along);
        let shares = std::array::from_fn(|i| at.shares[i] + along[i] * far / steep);
        let inside = shares.iter().all(|share| (0.0..=1.0).contains(share));
        inside.then(|| self.family.moved(at, &shares)).flatten()
    }

    /// The nearest surfaces within reach of an orbit.
    pub fn near(&self, here: &Measured, trust: f64) -> Vec<Surface> {
        let reach = (REACH[0] * trust).max(REACH[1]);
        let at = &here.orbit;
        let near = self.orbits.iter().filter(|it| it.events != at.events && it.apart(at) <= reach);
        let mut surfaces: Vec<Surface> = near
            .filter_map(|there| Surface::between(here, self.objective.measured(there.clone())))
            .collect();
        surfaces.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        surfaces.truncate(SURFACES);
        surfaces
    }
}
