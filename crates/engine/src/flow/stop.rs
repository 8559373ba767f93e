//! Ends computations early for which nobody waits any more.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    /// What ends the computation of this thread, if anything does.
    static STOP: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// Asks a computation to end.
///
/// Method: a motion asks after each step whether the computation of its thread is to end, and cannot go on if so. So all that
/// follows motions ends within a few steps, whatever it computes; what is computed then has no meaning.
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Ends the computations that [obey] it.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether they are to end.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What ends the computation of this thread, for the threads that it starts.
pub fn current() -> Option<Stop> {
    STOP.with_borrow(Clone::clone)
}

/// Lets `stop` end what this thread computes from now on.
pub fn obey(stop: Option<Stop>) {
    STOP.set(stop);
}

/// Whether what this thread computes is to end.
// A call, as loops over lanes are long without it.
#[inline(never)]
pub fn is_asked() -> bool {
    STOP.with_borrow(|stop| stop.as_ref().is_some_and(Stop::is_asked))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_obeys_its_own_stop_alone() {
        let stop = Stop::default();
        obey(Some(stop.clone()));
        assert!(!is_asked());
        stop.ask();
        assert!(is_asked() && current().is_some_and(|it| it.is_asked()));
        let other = std::thread::spawn(|| (is_asked(), current().is_none()));
        assert_eq!(other.join().expect("it ends"), (false, true));
        obey(None);
        assert!(!is_asked());
    }
}
