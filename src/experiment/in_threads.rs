//! A function of many things by several threads, in the order of the things.

use std::thread;

/// A function of each of some things, in their order, by so many threads.
pub(super) fn in_threads<T: Sync, R: Send>(
    things: &[T],
    threads: usize,
    function: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    let each = things.len().div_ceil(threads.max(1)).max(1);
    let function = &function;
    thread::scope(|scope| {
        let parts: Vec<_> = things
            .chunks(each)
            .map(|part| scope.spawn(move || part.iter().map(function).collect::<Vec<R>>()))
            .collect();
        parts.into_iter().flat_map(|part| part.join().expect("no thread panics")).collect()
    })
}
