//! Where motions go when the parameter of a file of basins steps, from the file.

use std::path::Path;

use super::error::CampaignError;
use super::study_source::study_of;
use crate::attractor::Label;
use crate::quantity::Dimension;
use crate::run::{self, Machine, Step, Steps, Tipping};
use crate::store::catalogue::{ATTRACTOR, ATTRACTOR_AXIS, OUTCOME};
use crate::store::{Archive, Values};
use crate::study::{Axis, Study};

/// A file of basins along a parameter.
#[derive(Debug)]
pub struct BasinsAlong {
    study: Study,
    axis: Axis,
    labels: Vec<Label>,
}

/// What steps: a parameter, or the place along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its dimension.
    pub dimension: Dimension,
}

impl BasinsAlong {
    /// Those of an archive, the file at `path`.
    ///
    /// Fails where it has none, cannot be read, or cases were inferred or are missing.
    pub fn of(archive: &Archive, path: &Path) -> Result<BasinsAlong, CampaignError> {
        let none = || {
            CampaignError::of_path(
                path,
                "holds no basins along a parameter: a grid of one parameter whose other axes are starts",
            )
        };
        let study = study_of(archive, path)?;
        let along = archive.frame().attributes.get(ATTRACTOR_AXIS).ok_or_else(none)?;
        let mut axes = study.axes().iter();
        let axis = axes.find(|it| it.name() == along).ok_or_else(none)?.clone();
        let others = study.axes().iter().filter(|it| it.name() != along);
        let is_start = others.clone().all(Axis::is_of_starts);
        if !is_start || others.count() == 0 || study.inherit().is_some() {
            return Err(none());
        }
        let numbers = archive.variable(ATTRACTOR.name)?.ok_or_else(none)?;
        let Values::Integer(numbers) = &numbers.values else { return Err(none()) };
        let outcomes = archive.variable(OUTCOME.name)?.ok_or_else(none)?;
        if outcomes.names().contains(&Some("missing")) {
            return Err(CampaignError::of_path(path, "lacks cases; complete it first"));
        }
        let label =
            |number: &i64| u32::try_from(*number).map_or(Label::Undecided, Label::Attractor);
        let labels = numbers.iter().map(label).collect();
        Ok(BasinsAlong { study, axis, labels })
    }

    /// The parameter, or the path, whose places are counted from 0.
    pub fn along(&self) -> Stepping<'_> {
        let dimension =
            self.axis.single().map_or(Dimension::Number, |it| it.coordinate.dimension());
        let single = self.axis.single().map(|it| it.coordinate.name());
        Stepping { name: single.unwrap_or(self.axis.name()), dimension }
    }

    /// The steps from each value of the parameter to the next, or the one between the values that are nearest to two.
    pub fn steps(&self, between: Option<[f64; 2]>) -> Vec<Step> {
        let count = self.axis.places();
        let single = self.axis.single();
        let nearest = |wanted: f64| {
            let places = 0..count;
            let value = |place: usize| single.map_or(place as f64, |it| it.values[place]);
            let off = |place: &usize| (value(*place) - wanted).abs();
            places.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
        };
        match between {
            Some(ends) => vec![ends.map(nearest)],
            None => (1..count).map(|at| [at - 1, at]).collect(),
        }
    }

    /// What some steps do to each attractor, see [`run::tipping`].
    ///
    /// Fails if the threads cannot be started.
    pub fn tipping(
        &self,
        steps: &[Step],
        drawn: &Steps,
        machine: Machine,
    ) -> Result<Vec<Tipping>, CampaignError> {
        let found = run::tipping(&self.study, &self.labels, steps, drawn, machine)?;
        Ok(found.unwrap_or_default())
    }
}
