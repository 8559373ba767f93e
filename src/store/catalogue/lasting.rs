//! Texts that are put together while the program runs, and last as long as it does.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// A text that is put together, and lives as long as the program: each is kept once.
pub fn lasting(text: String) -> &'static str {
    static TEXTS: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut texts = TEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = texts.get(&*text) {
        return known;
    }
    let text: &'static str = text.leak();
    texts.insert(text);
    text
}
