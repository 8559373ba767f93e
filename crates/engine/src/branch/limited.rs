//! An integrator that does no more than so much.

use std::cell::Cell;

use crate::flow::{Reason, System};
use crate::orbit::measuring::{MeasureRequest, Measured};
use crate::orbit::passage::{Integrator, Passage, PlainRequest, PlainReturns, ReturnRequest};

/// An integrator that refuses further returns with derivatives after so many cycles of them.
///
/// A refused return looks like one that cannot be followed, so that nothing may be concluded once it is spent.
#[derive(Debug)]
pub struct Limited<'a, M: System<D>, const D: usize> {
    integrator: &'a dyn Integrator<M, D>,
    left: Cell<Option<u64>>,
}

impl<'a, M: System<D>, const D: usize> Limited<'a, M, D> {
    /// An integrator of so many cycles.
    pub fn to(cycles: u64, integrator: &'a dyn Integrator<M, D>) -> Self {
        Limited { integrator, left: Cell::new(Some(cycles)) }
    }

    /// Whether a return has been refused.
    pub fn is_spent(&self) -> bool {
        self.left.get().is_none()
    }
}

impl<M: System<D>, const D: usize> Integrator<M, D> for Limited<'_, M, D> {
    fn passage(&self, request: ReturnRequest<M, D>) -> Result<Passage<M::Event, D>, Reason> {
        self.left.set(self.left.get().and_then(|left| left.checked_sub(request.cycles.count)));
        if self.is_spent() {
            return Err(Reason::OutOfSteps);
        }
        self.integrator.passage(request)
    }

    fn measured(&self, request: MeasureRequest<M, D>) -> Measured<M, D> {
        self.integrator.measured(request)
    }

    fn plain_returns(&self, request: PlainRequest<M, D>) -> PlainReturns<M::Event, D> {
        self.integrator.plain_returns(request)
    }
}
