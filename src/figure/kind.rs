//! What a kind of figure says of itself: what must be there, what it reads, and how it is drawn.

use std::collections::BTreeSet;

use super::canvas::Drawn;
use super::error::FigureError;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::Entry;
use crate::study::Drawing;

/// What must be in a file of results before a figure can be drawn from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// The cases of a sweep.
    Cases,
    /// Branches of continued orbits.
    Branches,
    /// One of both.
    CasesOrBranches,
}

/// A kind of figure; what its keys may name stands with its name, in [`crate::study::DrawingKind`].
pub struct Kind {
    /// What must be there.
    pub needs: Needs,
    /// The variables whose numbers a figure of this kind reads, those that are there of them.
    pub reads: fn(&Drawing, &'static Description) -> Names,
    /// Fetches what a figure of this kind shows, once, into a struct of its file, and then draws it.
    pub draw: fn(&View<'_>) -> Result<Drawn, FigureError>,
}

/// Names of variables.
#[derive(Debug, Default)]
pub struct Names(BTreeSet<String>);

impl Names {
    /// The names of these entries of the catalogue.
    pub fn of(entries: impl IntoIterator<Item = Entry>) -> Names {
        Names::default().and(entries)
    }

    /// With the names of these entries of the catalogue.
    pub fn and(self, entries: impl IntoIterator<Item = Entry>) -> Names {
        self.and_named(entries.into_iter().map(|entry| entry.name.to_owned()))
    }

    /// With these names.
    pub fn and_named(mut self, names: impl IntoIterator<Item = String>) -> Names {
        self.0.extend(names);
        self
    }

    /// With all of `other`.
    pub fn and_all(self, other: Names) -> Names {
        self.and_named(other.0)
    }

    /// The names, in their order.
    pub fn into_set(self) -> BTreeSet<String> {
        self.0
    }
}
