//! Computations that ask for returns, many at a time, so that the returns are followed side by side.

use corosensei::stack::DefaultStack;
use corosensei::{Coroutine, CoroutineResult, Yielder};

use crate::flow::{Reason, System};
use crate::lane::Instructions;

use super::passage::{Integrator, Passage, ReturnRequest, passages};

/// Room for the stack of a computation [bytes]; only what is used is taken.
const STACK: usize = 4 << 20;

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

impl<M: System<D>, const D: usize> Integrator<M, D> for Waiting<'_, M, D> {
    fn passage(&self, request: ReturnRequest<M, D>) -> Returned<M, D> {
        self.0.suspend(request).expect("it goes on once the return is there")
    }
}

impl<M: System<D>, T: 'static, const D: usize> Batch<M, T, D> {
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

    /// Follows as many returns as there are lanes, of those that have waited longest and of others as long; the
    /// results of the computations that end with them.
    pub fn advance(&mut self) -> Vec<T> {
        let Some((_, oldest)) = self.waiting.first() else { return Vec::new() };
        let longest = oldest.cycles.count;
        let mut order: Vec<usize> = (0..self.waiting.len()).collect();
        order.sort_by_key(|&place| self.waiting[place].1.cycles.count.abs_diff(longest));
        order.truncate(self.instructions.lanes_of_a_vector());
        let requests: Vec<_> = order.iter().map(|&place| &self.waiting[place].1).collect();
        let mut returned: Vec<_> = passages(self.instructions, &requests)
            .into_iter()
            .zip(order)
            .map(|(returned, place)| (place, returned))
            .collect();
        returned.sort_by_key(|(place, _)| *place);
        let mut returned = returned.into_iter().peekable();
        let mut done = Vec::new();
        for (place, (coroutine, request)) in
            std::mem::take(&mut self.waiting).into_iter().enumerate()
        {
            match returned.next_if(|(number, _)| *number == place) {
                Some((_, returned)) => done.extend(self.resume(coroutine, Some(returned))),
                None => self.waiting.push((coroutine, request)),
            }
        }
        done
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
