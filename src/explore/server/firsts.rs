//! The first number that each case has of what clicks ask for, read once: one case alone takes as long as a part of the file.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::store::catalogue::{OUTCOME, section};
use crate::store::{Archive, StoreError};

/// The most cases of a file that are read in advance.
const MOST_CASES: usize = 200_000;

/// The numbers of a file, once they are read.
#[derive(Default)]
pub struct Firsts {
    is_begun: AtomicBool,
    columns: OnceLock<BTreeMap<String, Vec<f64>>>,
}

impl Firsts {
    /// Whether nobody has begun to read them of a file of so many cases; who asks has, if so.
    pub fn begin(&self, cases: usize) -> bool {
        cases <= MOST_CASES && !self.is_begun.swap(true, Ordering::Relaxed)
    }

    /// Reads them; nothing is kept of a file that cannot be read.
    pub fn read(&self, archive: &Archive, cases: usize) {
        let model = archive.frame().model();
        let mut wanted: Vec<&str> = section(model).iter().map(|it| it.name).collect();
        wanted.push(OUTCOME.name);
        wanted.extend(model.has_trade_off().then(|| model.speed().name()));
        let Ok(dataset) = archive.labelled(|name| wanted.contains(&name)) else { return };
        let columns = wanted.into_iter().filter_map(|name| {
            let values = dataset.variable(name)?.values.to_real();
            let each = values.len().checked_div(cases).filter(|each| *each > 0)?;
            let firsts: Vec<f64> = values.iter().step_by(each).copied().collect();
            (each * cases == values.len()).then(|| (name.to_owned(), firsts))
        });
        // Those that another thread has read are the same.
        let _ = self.columns.set(columns.collect());
    }

    /// The first number that the case with a number, at a position along the axes, has of a variable; NaN if there is none.
    ///
    /// Fails if it has to be read from the file and cannot be.
    pub fn first(
        &self,
        archive: &Archive,
        name: &str,
        index: usize,
        position: &[usize],
    ) -> Result<f64, StoreError> {
        let known = self.columns.get().and_then(|columns| columns.get(name)?.get(index));
        known.map_or_else(|| archive.first(name, position), |value| Ok(*value))
    }
}
