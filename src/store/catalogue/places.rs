//! The entries called after other variables at a place, and all entries together.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use super::branches::{
    BRANCH_CYCLE, BRANCH_POINT, CODIM2_POINT, CURVE_POINT, REQUEST, SPECIAL_POINT,
};
use super::entry::{Entry, Extent};
use super::lasting::lasting;
use super::manifolds::{STABLE_POINT, UNSTABLE_POINT};
use super::model::{derived, edges, end, histories, impacts, neutral, section};
use super::ramps::{RAMP_INDEX, RAMP_POINT, ramp_outputs};
use super::tables::{ATTRACTOR_CYCLE, ATTRACTOR_INDEX, EVENT};
use super::{branches, cases, manifolds, ramps, tables};
use crate::description::Description;
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
    /// Their points of codimension 2.
    Codim2,
    /// The points of the ramps.
    Ramp,
    /// Where the ramps begin.
    RampFirst,
    /// The points of the curves on which basins meet.
    Stable,
    /// The points of the unstable manifolds of saddles.
    Unstable,
}

impl Place {
    const ALL: [Place; 11] = [
        Place::Attractor,
        Place::Event,
        Place::Request,
        Place::Branch,
        Place::Special,
        Place::Curve,
        Place::Codim2,
        Place::Ramp,
        Place::RampFirst,
        Place::Stable,
        Place::Unstable,
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
            Place::Codim2 => "codim2_",
            Place::Ramp => "ramp_",
            Place::RampFirst => "ramp_first_",
            Place::Stable => "stable_",
            Place::Unstable => "unstable_",
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

    /// The columns called after the parameters of a model.
    pub fn parameters(self, model: &'static Description) -> impl Iterator<Item = Entry> {
        model.parameters().map(move |parameter| self.of(Entry::of_parameter(parameter)))
    }

    /// The column called after another variable, with what it is here.
    fn column(self, entry: Entry, meaning: &'static str) -> Entry {
        let name = lasting(self.name(entry.name));
        let extent = match (self, entry.extent) {
            (Place::Attractor, Extent::CaseRow(_)) => {
                Extent::TableRow(ATTRACTOR_INDEX.name, ATTRACTOR_CYCLE.name)
            }
            (Place::Attractor, _) => Extent::Table(ATTRACTOR_INDEX.name),
            (Place::Event, _) => Extent::Table(EVENT.name),
            (Place::Request, _) => Extent::Table(REQUEST.name),
            (Place::Curve, _) => Extent::Table(CURVE_POINT.name),
            (Place::Codim2, _) => Extent::Table(CODIM2_POINT.name),
            (Place::Ramp, _) => Extent::Table(RAMP_POINT.name),
            (Place::RampFirst, _) => Extent::Table(RAMP_INDEX.name),
            (Place::Stable, _) => Extent::Table(STABLE_POINT.name),
            (Place::Unstable, _) => Extent::Table(UNSTABLE_POINT.name),
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

    /// The column here that is called after `entry`, a parameter, an output or a section point.
    pub fn of(self, entry: Entry) -> Entry {
        let place = match self {
            Place::Attractor => "attractor",
            Place::Event => "event",
            Place::Request => "first orbit",
            Place::Branch => "branch",
            Place::Special => "special point",
            Place::Curve => "curve",
            Place::Codim2 => "point of codimension 2",
            Place::Ramp => "ramp",
            Place::RampFirst => "where the ramp begins",
            Place::Stable => "curve on which two basins meet",
            Place::Unstable => "unstable manifold",
        };
        self.column(entry, lasting(format!("{place}: {}", entry.meaning)))
    }

    /// All columns called after other variables of a model.
    fn columns(self, model: &'static Description) -> Vec<Entry> {
        // All attractors of starts have the same parameters, and so has all that lies in the plane of the starts.
        let of_one = matches!(self, Place::Attractor | Place::Stable | Place::Unstable);
        let parameters = self.parameters(model).filter(|_| !of_one);
        let mut columns: Vec<Entry> = parameters.collect();
        let of_orbits = matches!(self, Place::Attractor | Place::Branch | Place::Special);
        if of_orbits || matches!(self, Place::Event | Place::Codim2 | Place::Ramp) {
            columns.extend(section(model).into_iter().map(|entry| self.of(entry)));
        }
        if of_orbits {
            let outputs = model.outputs().map(Entry::of_output);
            columns.extend(outputs.map(|entry| self.of(entry)));
        }
        if self == Place::Unstable {
            columns.extend(section(model).into_iter().map(|entry| self.of(entry)));
        }
        if self == Place::Stable {
            columns
                .extend(Coordinate::of_section(model).map(|it| self.of(Entry::of_coordinate(it))));
        }
        if self == Place::Ramp {
            columns.extend(ramp_outputs(model).map(|output| self.of(Entry::of_output(output))));
        }
        columns
    }
}

/// The entries whose names stand in the files of this folder.
const FIXED: [&[Entry]; 5] =
    [cases::FIXED, tables::FIXED, branches::FIXED, ramps::FIXED, manifolds::FIXED];

/// Every entry of the results of a model: of the study, of its cases, and of the tables beside them.
pub fn all(model: &'static Description) -> &'static [Entry] {
    type OfModels = Vec<(&'static Description, &'static [Entry])>;
    static KNOWN: Mutex<OfModels> = Mutex::new(Vec::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, all)) = known.iter().find(|(other, _)| *other == model) {
        return all;
    }
    let mut all = with_repeated(model);
    let mut names = BTreeSet::new();
    all.retain(|entry| names.insert(entry.name));
    let all: &'static [Entry] = all.leak();
    known.push((model, all));
    all
}

/// Every entry, those too whose name an earlier one has.
fn with_repeated(model: &'static Description) -> Vec<Entry> {
    let study = Coordinate::all(model).map(Entry::of_coordinate);
    let outputs = model.outputs().map(Entry::of_output);
    let fixed = FIXED.concat();
    let described =
        [section, neutral, impacts, histories, derived, end, edges].map(|of| of(model)).concat();
    let columns = Place::ALL.into_iter().flat_map(|place| place.columns(model));
    study.chain(outputs).chain(described).chain(fixed).chain(columns).collect()
}

/// The names that a model has for something which results have for something else, too.
pub fn taken_twice(model: &'static Description) -> BTreeSet<&'static str> {
    let mut names =
        BTreeSet::from([cases::CASE, cases::STUDY_TEXT, cases::SYSTEM_TEXT, cases::OWN_TEXT]);
    let repeated = with_repeated(model).into_iter().filter(|entry| !names.insert(entry.name));
    repeated.map(|entry| entry.name).collect()
}

/// Whether a dimension of files is called so that is no axis of a study, whatever its model.
pub fn is_dimension(name: &str) -> bool {
    let mut fixed = FIXED.into_iter().flatten();
    fixed.any(|entry| entry.name == name && entry.extent == Extent::Dimension)
}

/// The entry called `name` of the results of a model.
pub fn named(name: &str, model: &'static Description) -> Option<&'static Entry> {
    all(model).iter().find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::of::default_model;

    #[test]
    fn every_name_stands_once_and_is_found() {
        let names: BTreeSet<&str> = all(default_model()).iter().map(|entry| entry.name).collect();
        assert_eq!(names.len(), all(default_model()).len());
        assert!(
            all(default_model()).iter().all(|entry| named(entry.name, default_model()).is_some())
        );
        assert!(named("nothing", default_model()).is_none());
        assert_eq!(taken_twice(default_model()), BTreeSet::new());
    }

    #[test]
    fn what_lies_along_a_dimension_names_one() {
        for entry in all(default_model()) {
            for name in entry.dimensions() {
                let along = named(name, default_model()).map(|it| it.extent);
                assert_eq!(along, Some(Extent::Dimension), "{}", entry.name);
            }
        }
    }
}
