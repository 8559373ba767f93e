//! The stable periodic orbit near a point of the section, closed to rounding.

use capsulemap_engine::branch::cyclic;
use capsulemap_engine::flow::Event as _;
use capsulemap_engine::orbit::matrix::eigenvalues;
use capsulemap_engine::orbit::newton::{Closed, close};
use capsulemap_engine::orbit::passage::{Integrator as _, OneByOne, ReturnRequest, image};
use capsulemap_engine::orbit::return_map::Cycles;

use crate::face::Face;
use crate::model::StableOrbit;

/// An orbit closes to this residual, relative to the motion; a larger one is seen in the outputs.
const EXACT: f64 = 1e-11;
/// How often Newton's method is begun again from the image of the point where it has ended, as beside a kink of the return
/// map it may end early.
const AGAIN: usize = 4;

/// The stable orbit of so many cycles near a guess, see [`stable_orbit`](crate::model::Model::stable_orbit).
pub(super) fn orbit<M: Face<D>, const D: usize>(
    system: M,
    guess: &[f64; D],
    cycles: Cycles,
) -> Option<StableOrbit> {
    let closed = closed_exactly(&system, guess, &cycles)?;
    let (model, multipliers) = (system.description(), eigenvalues(&closed.jacobian));
    let is_stable = multipliers[0].abs() < 1.0;
    if closed.residual > EXACT || !is_stable {
        return None;
    }
    let section = closed.point;
    let passed = OneByOne.passage(ReturnRequest {
        system,
        along: None,
        point: section,
        units: [1.0; D],
        cycles,
        watched: true,
        directions: None,
    });
    let events = cyclic(&passed.ok()?.events);
    Some(StableOrbit {
        section: model.section_point(&section),
        multipliers: multipliers[..model.section.len()].to_vec(),
        impacts: events.iter().filter(|event| event.is_impact()).count(),
        events: events.iter().map(|event| event.number()).collect(),
    })
}

/// Closes an orbit by Newton's method, begun again where it has ended early.
fn closed_exactly<M: Face<D>, const D: usize>(
    system: &M,
    guess: &[f64; D],
    cycles: &Cycles,
) -> Option<Closed<D>> {
    let size = system.metric().size(guess).max(system.expected_size());
    let mut closed = closed_near(system, guess, cycles, size)?;
    for _ in 0..AGAIN {
        if closed.residual <= EXACT {
            break;
        }
        let next = image(&OneByOne, system, &closed.point, cycles).ok()?.end;
        closed = closed_near(system, &next, cycles, size)?;
    }
    Some(closed)
}

/// Closes an orbit by Newton's method.
fn closed_near<M: Face<D>, const D: usize>(
    system: &M,
    guess: &[f64; D],
    cycles: &Cycles,
    size: f64,
) -> Option<Closed<D>> {
    let closed = close(
        |point| image(&OneByOne, system, point, cycles),
        cycles.count,
        &system.metric(),
        guess,
        size,
    );
    closed.ok().flatten()
}
