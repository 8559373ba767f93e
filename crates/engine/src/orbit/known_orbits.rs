//! Orbits that are known before other cases of the same system are followed.

use std::sync::Arc;

use crate::flow::{Stroboscopic, System};
use crate::lane::Instructions;

use super::OrbitOf;
use super::certificate::Proof;
use super::neighbourhood::Neighbourhood;
use super::passage::ReturnRequest;
use super::passages::passages;
use super::return_map::Cycles;

/// Orbits of one system that are known before other cases are followed, with their neighbourhoods.
pub struct KnownOrbits<M: System<D>, const D: usize> {
    orbits: Vec<OrbitOf<M, D>>,
    neighbourhoods: Arc<Vec<Neighbourhood<D>>>,
}

impl<M: System<D>, const D: usize> KnownOrbits<M, D> {
    /// The different orbits among what cases of a system have settled to, as far as they have neighbourhoods.
    pub fn among(
        system: &M,
        settled: Vec<OrbitOf<M, D>>,
        instructions: Instructions,
        tolerance: f64,
    ) -> Self {
        let (mut orbits, mut neighbourhoods) = (Vec::new(), Vec::<Neighbourhood<D>>::new());
        for orbit in settled {
            let is_proven =
                orbit.certificate.proof == Proof::Newton && orbit.certificate.is_stable();
            if !is_proven {
                continue;
            }
            let begins = M::Single::point(&orbit.begins);
            let points = points_of(system, (begins, orbit.period), instructions, tolerance);
            if points.iter().any(|point| neighbourhoods.iter().any(|it| it.contains(point))) {
                continue;
            }
            let of = (begins, orbit.period);
            if let Some(new) = Neighbourhood::of(system, of, instructions, tolerance) {
                neighbourhoods.push(new);
                orbits.push(orbit);
            }
        }
        KnownOrbits { orbits, neighbourhoods: Arc::new(neighbourhoods) }
    }

    /// The neighbourhoods of the orbits.
    pub fn neighbourhoods(&self) -> &Arc<Vec<Neighbourhood<D>>> {
        &self.neighbourhoods
    }

    /// The orbit with this number, as what a case has reached that has followed so many cycles.
    pub(super) fn reached(&self, number: usize, cycles: u64) -> OrbitOf<M, D> {
        let mut orbit = self.orbits[number].clone();
        orbit.cycles = cycles;
        orbit.certificate.proof = Proof::Neighbourhood;
        orbit
    }
}

/// The section points of an orbit, as far as it can be followed.
fn points_of<M: System<D>, const D: usize>(
    system: &M,
    (begins, period): ([f64; D], u64),
    instructions: Instructions,
    tolerance: f64,
) -> Vec<[f64; D]> {
    let mut points = vec![begins];
    for _ in 1..period {
        let request = ReturnRequest {
            system: system.clone(),
            along: None,
            point: points[points.len() - 1],
            units: [1.0; D],
            cycles: Cycles { count: 1, tolerance },
            watched: false,
            directions: None,
        };
        let Some(Ok(passage)) = passages(instructions, &[&request]).pop() else { break };
        points.push(passage.end);
    }
    points
}
