//! Many computations on all threads, each thread with several side by side.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

/// A thread more is worth so many computations, as fewer leave its lanes empty.
const LEAST: usize = 64;

/// What a thread computes of the places that it is given one after another, each with its place.
pub(super) type OfThread<'a, T> =
    dyn Fn(&mut dyn FnMut() -> Option<usize>) -> Vec<(usize, T)> + Sync + 'a;

/// Computations on all threads, begun in the order of these places, each by the thread that has room for it. Their results by
/// rising places.
pub(super) fn together<T: Send>(places: Vec<usize>, of_thread: &OfThread<'_, T>) -> Vec<T> {
    let taken = AtomicUsize::new(0);
    let threads = rayon::current_num_threads().min(places.len().div_ceil(LEAST));
    let mut results: Vec<(usize, T)> = (0..threads)
        .into_par_iter()
        .flat_map_iter(|_| {
            of_thread(&mut || places.get(taken.fetch_add(1, Ordering::Relaxed)).copied())
        })
        .collect();
    results.sort_by_key(|(place, _)| *place);
    results.into_iter().map(|(_, result)| result).collect()
}
