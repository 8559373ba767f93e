//! The entries called after other variables at a place, and all entries together.

use std::sync::LazyLock;

use super::branches::{BRANCH_CYCLE, BRANCH_POINT, CURVE_POINT, REQUEST, SPECIAL_POINT};
use super::entry::{Entry, Extent};
use super::model::{edges, end, neutral, section};
use super::tables::{ATTRACTOR_CYCLE, ATTRACTOR_INDEX, EVENT};
use super::{branches, cases, tables};
use crate::of::default_model;
use crate::study::Coordinate;

/// A table with columns called after parameters, outputs and section points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The attractors of starts.
    Attractor,
    /// The events of attractors.
    Event,
    /// The branches that the study asks for.
    Request,
    /// The points of the branches.
    Branch,
    /// The special points of the branches.
    Special,
    /// The points of the curves.
    Curve,
}

impl Place {
    const ALL: [Place; 6] = [
        Place::Attractor,
        Place::Event,
        Place::Request,
        Place::Branch,
        Place::Special,
        Place::Curve,
    ];

    /// What the names of its columns begin with.
    fn prefix(self) -> &'static str {
        match self {
            Place::Attractor => "attractor_",
            Place::Event => "event_",
            Place::Request => "request_",
            Place::Branch => "branch_",
            Place::Special => "special_",
            Place::Curve => "curve_",
        }
    }

    /// The name here of the column called after the variable `name`.
    pub fn name(self, name: &str) -> String {
        format!("{}{name}", self.prefix())
    }

    /// The variable that the column called `name` is called after, if it is one of these columns.
    pub fn base(self, name: &str) -> Option<&str> {
        name.strip_prefix(self.prefix())
    }

    /// The column here that is called after `entry`, a parameter, an output or a section point.
    ///
    /// # Panics
    ///
    /// If the table has no such column.
    pub fn of(self, entry: Entry) -> Entry {
        *named(&self.name(entry.name)).expect("a column of the catalogue")
    }

    /// The columns called after the parameters.
    pub fn parameters(self) -> impl Iterator<Item = Entry> {
        default_model().parameters().map(move |parameter| self.of(Entry::of_parameter(parameter)))
    }

    /// The column here that is called after `entry`.
    fn column(self, entry: Entry, meaning: &'static str) -> Entry {
        let name = self.name(entry.name).leak();
        let extent = match (self, entry.extent) {
            (Place::Attractor, Extent::CaseRow(_)) => {
                Extent::TableRow(ATTRACTOR_INDEX.name, ATTRACTOR_CYCLE.name)
            }
            (Place::Attractor, _) => Extent::Table(ATTRACTOR_INDEX.name),
            (Place::Event, _) => Extent::Table(EVENT.name),
            (Place::Request, _) => Extent::Table(REQUEST.name),
            (Place::Curve, _) => Extent::Table(CURVE_POINT.name),
            (Place::Branch, Extent::CaseRow(_)) => {
                Extent::TableRow(BRANCH_POINT.name, BRANCH_CYCLE.name)
            }
            (Place::Branch, _) => Extent::Table(BRANCH_POINT.name),
            (Place::Special, Extent::CaseRow(_)) => {
                Extent::TableRow(SPECIAL_POINT.name, BRANCH_CYCLE.name)
            }
            (Place::Special, _) => Extent::Table(SPECIAL_POINT.name),
        };
        Entry { name, meaning, extent, ..entry }
    }

    /// The column called after another variable, with what it is here.
    fn here(self, entry: Entry) -> Entry {
        let place = match self {
            Place::Attractor => "attractor",
            Place::Event => "event",
            Place::Request => "first orbit",
            Place::Branch => "branch",
            Place::Special => "special point",
            Place::Curve => "curve",
        };
        self.column(entry, format!("{place}: {}", entry.meaning).leak())
    }

    /// All columns called after other variables.
    fn columns(self) -> Vec<Entry> {
        // All attractors of starts have the same parameters.
        let parameters = default_model().parameters().filter(|_| self != Place::Attractor);
        let mut columns: Vec<Entry> =
            parameters.map(|it| self.here(Entry::of_parameter(it))).collect();
        let of_orbits = matches!(self, Place::Attractor | Place::Branch | Place::Special);
        if of_orbits || self == Place::Event {
            columns.extend(section(default_model()).into_iter().map(|entry| self.here(entry)));
        }
        if of_orbits {
            let outputs = default_model().outputs().map(Entry::of_output);
            columns.extend(outputs.map(|entry| self.here(entry)));
        }
        columns
    }
}

/// Every entry: of the study, of its cases, and of the tables beside them.
pub fn all() -> &'static [Entry] {
    // The names of the columns are put together once, and live as long as the program.
    static ALL: LazyLock<Vec<Entry>> = LazyLock::new(|| {
        let study = Coordinate::all().map(Entry::of_coordinate);
        let outputs = default_model().outputs().map(Entry::of_output);
        let fixed = [cases::FIXED, cases::DESCRIBED, tables::FIXED, branches::FIXED].concat();
        let described = [neutral, end, edges].map(|of| of(default_model())).concat();
        let columns = Place::ALL.into_iter().flat_map(Place::columns);
        study.chain(outputs).chain(fixed).chain(described).chain(columns).collect()
    });
    &ALL
}

/// The entry called `name`.
pub fn named(name: &str) -> Option<&'static Entry> {
    all().iter().find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_name_stands_once_and_is_found() {
        let names: BTreeSet<&str> = all().iter().map(|entry| entry.name).collect();
        assert_eq!(names.len(), all().len());
        assert!(all().iter().all(|entry| named(entry.name).is_some()));
        assert!(named("nothing").is_none());
    }

    #[test]
    fn what_lies_along_a_dimension_names_one() {
        for entry in all() {
            for name in entry.dimensions() {
                let along = named(name).map(|it| it.extent);
                assert_eq!(along, Some(Extent::Dimension), "{}", entry.name);
            }
        }
    }
}
