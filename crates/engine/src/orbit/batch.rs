//! Computations that ask for returns and measured cycles, many at a time, so that these are followed side by side.

use std::fmt::{self, Debug, Formatter};

use corosensei::stack::DefaultStack;
use corosensei::{Coroutine, CoroutineResult, Yielder};

use crate::flow::{Reason, System};
use crate::lane::Instructions;

use super::measuring::{MeasureRequest, Measured};
use super::measuring_all::measured_side_by_side;
use super::passage::{Integrator, Passage, PlainRequest, PlainReturns, ReturnRequest};
use super::passages::passages;
use super::returns::plain_returns;

/// Room for the stack of a computation [bytes]; only what is used is taken.
const STACK: usize = 4 << 20;

/// Motions that a lane follows one after the other: among many few lanes are empty while the last end.
const EACH_LANE: usize = 32;
/// Returns without derivatives that take as long as one with them.
const PLAIN: usize = 6;
/// What some wait for is passed over at most so many times: among endlessly many others they would wait for ever.
const PATIENCE: usize = 32;
/// Computations that wait at a time at most, as each has a stack.
const MOST: usize = 256;

type Returned<M, const D: usize> = Result<Passage<<M as System<D>>::Event, D>, Reason>;
/// What a computation asks for.
enum Request<M: System<D>, const D: usize> {
    Return(ReturnRequest<M, D>),
    Measure(MeasureRequest<M, D>),
    Plain(PlainRequest<M, D>),
}
/// What is answered together.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Plain,
    Return,
    Measure,
}
/// What it is given for it.
enum Answer<M: System<D>, const D: usize> {
    Returned(Returned<M, D>),
    Measured(Measured<M, D>),
    Plain(PlainReturns<M::Event, D>),
}
/// A computation that waits for an answer; the first time it is resumed for nothing.
type Computation<M, T, const D: usize> =
    Coroutine<Option<Answer<M, D>>, Request<M, D>, T, DefaultStack>;

/// Computations that are interrupted where they ask for a return, or for cycles to be measured.
///
/// Method: each has a stack of its own. What it asks for waits until there is enough for the lanes; then a group of
/// motions is followed side by side, and each computation goes on with its own.
/// Guarantees: the bits of a computation by itself.
pub struct Batch<M: System<D>, T, const D: usize> {
    instructions: Instructions,
    /// Computations that wait for a return.
    returns: Vec<(Computation<M, T, D>, ReturnRequest<M, D>)>,
    /// Computations that wait for their cycles to be measured.
    measures: Vec<(Computation<M, T, D>, MeasureRequest<M, D>)>,
    /// Computations that wait for returns without derivatives, each for many.
    plain: Vec<(Computation<M, T, D>, PlainRequest<M, D>)>,
    /// How many times in a row each kind has been passed over while some waited for it.
    passed_over: [usize; 3],
    stacks: Vec<DefaultStack>,
}

/// Interrupts a computation until the answer is there that it asks for.
struct Waiting<'a, M: System<D>, const D: usize>(&'a Yielder<Option<Answer<M, D>>, Request<M, D>>);

impl<M: System<D>, const D: usize> Debug for Waiting<'_, M, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Waiting").finish_non_exhaustive()
    }
}

impl<M: System<D>, const D: usize> Integrator<M, D> for Waiting<'_, M, D> {
    fn passage(&self, request: ReturnRequest<M, D>) -> Returned<M, D> {
        match self.0.suspend(Request::Return(request)) {
            Some(Answer::Returned(returned)) => returned,
            _ => panic!("the computation goes on with the return"),
        }
    }

    fn measured(&self, request: MeasureRequest<M, D>) -> Measured<M, D> {
        match self.0.suspend(Request::Measure(request)) {
            Some(Answer::Measured(measured)) => measured,
            _ => panic!("the computation goes on with what is measured"),
        }
    }

    fn plain_returns(&self, request: PlainRequest<M, D>) -> PlainReturns<M::Event, D> {
        match self.0.suspend(Request::Plain(request)) {
            Some(Answer::Plain(returns)) => returns,
            _ => panic!("the computation goes on with the returns"),
        }
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
        let (returns, measures, plain) = (Vec::new(), Vec::new(), Vec::new());
        Batch { instructions, returns, measures, plain, passed_over: [0; 3], stacks: Vec::new() }
    }

    /// How many wait for what most of them wait for; returns without derivatives count by the number that take as long as
    /// one with them.
    pub fn waiting(&self) -> usize {
        self.returns.len().max(self.measures.len()).max(self.plain_waiting())
    }

    fn plain_waiting(&self) -> usize {
        let points: usize = self.plain.iter().map(|(_, it)| it.points.len()).sum();
        points.div_ceil(PLAIN)
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

    /// Answers those that have waited longest for what most wait for, or for what has been passed over too often, a few for
    /// each lane; the results of the computations that end with it.
    pub fn advance(&mut self) -> Vec<T> {
        let most = EACH_LANE * self.instructions.lanes_of_a_vector();
        let (computations, answers): (Vec<_>, Vec<_>) = match self.next_kind() {
            Kind::Plain => {
                let (computations, requests): (Vec<_>, Vec<_>) = self.plain.drain(..).unzip();
                let returned = plain_returns(self.instructions, &requests);
                (computations, returned.into_iter().map(Answer::Plain).collect())
            }
            Kind::Return => {
                let (computations, requests) = first(&mut self.returns, most);
                let returned = passages(self.instructions, &requests.iter().collect::<Vec<_>>());
                (computations, returned.into_iter().map(Answer::Returned).collect())
            }
            Kind::Measure => {
                let (computations, requests) = first(&mut self.measures, most);
                let measured = measured_side_by_side(self.instructions, requests);
                (computations, measured.into_iter().map(Answer::Measured).collect())
            }
        };
        let resumed = computations.into_iter().zip(answers);
        resumed.filter_map(|(it, answer)| self.resume(it, Some(answer))).collect()
    }

    /// What is answered next: what most wait for, but for what has been passed over too often while some waited for it.
    fn next_kind(&mut self) -> Kind {
        let kinds = [Kind::Plain, Kind::Return, Kind::Measure];
        let waiting = [self.plain_waiting(), self.returns.len(), self.measures.len()];
        let overdue = (0..kinds.len()).find(|kind| self.passed_over[*kind] >= PATIENCE);
        let most = || (0..kinds.len()).rev().max_by_key(|kind| waiting[*kind]);
        let chosen = overdue.or_else(most).expect("there are kinds");
        for (kind, passed_over) in self.passed_over.iter_mut().enumerate() {
            let is_passed_over = kind != chosen && waiting[kind] > 0;
            *passed_over = if is_passed_over { *passed_over + 1 } else { 0 };
        }
        kinds[chosen]
    }

    fn resume(
        &mut self,
        mut coroutine: Computation<M, T, D>,
        with: Option<Answer<M, D>>,
    ) -> Option<T> {
        match coroutine.resume(with) {
            CoroutineResult::Yield(Request::Return(request)) => {
                self.returns.push((coroutine, request));
                None
            }
            CoroutineResult::Yield(Request::Measure(request)) => {
                self.measures.push((coroutine, request));
                None
            }
            CoroutineResult::Yield(Request::Plain(request)) => {
                self.plain.push((coroutine, request));
                None
            }
            CoroutineResult::Return(result) => {
                self.stacks.push(coroutine.into_stack());
                Some(result)
            }
        }
    }
}

/// Takes the first of those that wait, so many at `most`.
fn first<A, B>(waiting: &mut Vec<(A, B)>, most: usize) -> (Vec<A>, Vec<B>) {
    waiting.drain(..waiting.len().min(most)).unzip()
}
