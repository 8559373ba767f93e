//! Computations that ask for returns, many at a time, so that the returns are followed side by side.

use std::fmt::{self, Debug, Formatter};

use corosensei::stack::DefaultStack;
use corosensei::{Coroutine, CoroutineResult, Yielder};

use crate::flow::{Reason, System};
use crate::lane::Instructions;

use super::passage::{Integrator, Passage, ReturnRequest};
use super::passages::passages;

/// Room for the stack of a computation [bytes]; only what is used is taken.
const STACK: usize = 4 << 20;

/// Returns that a lane follows one after the other.
const EACH_LANE: usize = 8;
/// Computations that wait at a time at most, as each has a stack.
const MOST: usize = 256;

type Returned<M, const D: usize> = Result<Passage<<M as System<D>>::Event, D>, Reason>;
/// A computation that waits for a return; the first time it is resumed for nothing.
type Computation<M, T, const D: usize> =
    Coroutine<Option<Returned<M, D>>, ReturnRequest<M, D>, T, DefaultStack>;

/// Computations that are interrupted where they ask for a return.
///
/// Method: each has a stack of its own. What it asks for waits until there is enough for the lanes; then all
/// returns of a group are followed side by side, and each computation goes on with its own.
/// Guarantees: the bits of a computation by itself.
pub struct Batch<M: System<D>, T, const D: usize> {
    instructions: Instructions,
    waiting: Vec<(Computation<M, T, D>, ReturnRequest<M, D>)>,
    stacks: Vec<DefaultStack>,
}

/// Interrupts a computation until the return is there that it asks for.
struct Waiting<'a, M: System<D>, const D: usize>(
    &'a Yielder<Option<Returned<M, D>>, ReturnRequest<M, D>>,
);

impl<M: System<D>, const D: usize> Debug for Waiting<'_, M, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Waiting").finish_non_exhaustive()
    }
}

impl<M: System<D>, const D: usize> Integrator<M, D> for Waiting<'_, M, D> {
    fn passage(&self, request: ReturnRequest<M, D>) -> Returned<M, D> {
        self.0.suspend(request).expect("it goes on once the return is there")
    }
}

impl<M: System<D>, T: 'static, const D: usize> Batch<M, T, D> {
    /// The results of computations, in their order; calls `done` after each.
    pub fn all<C>(
        instructions: Instructions,
        computations: impl IntoIterator<Item = C>,
        mut done: impl FnMut(),
    ) -> Vec<T>
    where
        C: FnOnce(&dyn Integrator<M, D>) -> T + 'static,
    {
        let mut batch = Batch::<M, (usize, T), D>::new(instructions);
        let mut results: Vec<(usize, T)> = Vec::new();
        let mut keep = |found: &mut dyn Iterator<Item = (usize, T)>| {
            for result in found {
                done();
                results.push(result);
            }
        };
        for (place, compute) in computations.into_iter().enumerate() {
            while batch.waiting() >= MOST {
                keep(&mut batch.advance().into_iter());
            }
            let placed = move |integrator: &dyn Integrator<M, D>| (place, compute(integrator));
            keep(&mut batch.begin(placed).into_iter());
        }
        while batch.waiting() > 0 {
            keep(&mut batch.advance().into_iter());
        }
        results.sort_by_key(|(place, _)| *place);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// No computations yet.
    pub fn new(instructions: Instructions) -> Self {
        Batch { instructions, waiting: Vec::new(), stacks: Vec::new() }
    }

    /// How many wait for a return.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Begins a computation; its result, if it asks for nothing.
    pub fn begin(
        &mut self,
        computation: impl FnOnce(&dyn Integrator<M, D>) -> T + 'static,
    ) -> Option<T> {
        let stack = self
            .stacks
            .pop()
            .unwrap_or_else(|| DefaultStack::new(STACK).expect("there is room for a stack"));
        let coroutine = Coroutine::with_stack(stack, |yielder: &Yielder<_, _>, _| {
            computation(&Waiting(yielder))
        });
        self.resume(coroutine, None)
    }

    /// Follows the returns that have waited longest, a few for each lane; the results of the computations that end
    /// with them.
    pub fn advance(&mut self) -> Vec<T> {
        let most = EACH_LANE * self.instructions.lanes_of_a_vector();
        let later = self.waiting.split_off(self.waiting.len().min(most));
        let waiting = std::mem::replace(&mut self.waiting, later);
        let requests: Vec<_> = waiting.iter().map(|(_, request)| request).collect();
        let returned = passages(self.instructions, &requests);
        let resumed = waiting.into_iter().zip(returned);
        resumed.filter_map(|((it, _), returned)| self.resume(it, Some(returned))).collect()
    }

    fn resume(
        &mut self,
        mut coroutine: Computation<M, T, D>,
        with: Option<Returned<M, D>>,
    ) -> Option<T> {
        match coroutine.resume(with) {
            CoroutineResult::Yield(request) => {
                self.waiting.push((coroutine, request));
                None
            }
            CoroutineResult::Return(result) => {
                self.stacks.push(coroutine.into_stack());
                Some(result)
            }
        }
    }
}
