//! How large the file of results will be, by a sample of its cases.

use std::path::Path;

use crate::run::Record;
use crate::study::Study;

use super::catalogue::CASE;
use super::slab::{Filling, Slab};
use super::{Dataset, StoreError, Values, Variable, encode, schema};

/// Some cases of a study with their records.
struct Sample<'a> {
    study: &'a Study,
    /// How many cases it has.
    cases: usize,
    /// Those that have been computed, each with its place among all.
    records: Vec<Record>,
    places: Vec<usize>,
}

/// Bytes of the file of results of `study` without its attractors, curves of special points and optima: exact if `records`
/// holds all its cases, else estimated from them.
pub fn file_bytes(study: &Study, records: &[Record]) -> Result<f64, StoreError> {
    if records.len() == study.cases() {
        return bytes(&schema::dataset(study, records));
    }
    let (cases, places) = (records.len(), (0..records.len()).collect());
    let [frame, of_cases] = Sample { study, cases, records: records.to_vec(), places }.bytes()?;
    Ok(frame + of_cases / cases as f64 * study.cases() as f64)
}

/// Bytes of the file of results of a refined study without its attractors, estimated from some `tiles`: the indices of
/// their cases in rising order, and the records of those that have been computed, which are the share `computed` of all
/// cases.
pub fn refined_file_bytes(
    study: &Study,
    tiles: &[(Vec<usize>, Vec<Record>)],
    computed: f64,
) -> Result<f64, StoreError> {
    let mut sample = Sample { study, cases: 0, records: Vec::new(), places: Vec::new() };
    for (cases, records) in tiles {
        for record in records {
            sample.places.extend(cases.binary_search(&record.index).map(|at| sample.cases + at));
        }
        sample.records.extend_from_slice(records);
        sample.cases += cases.len();
    }
    let [frame, of_cases] = sample.bytes()?;
    Ok(frame + of_cases / sample.records.len() as f64 * computed * study.cases() as f64)
}

impl Sample<'_> {
    /// Bytes of the file apart from its cases, and of the cases of the sample.
    fn bytes(&self) -> Result<[f64; 2], StoreError> {
        let without = Sample { cases: 0, records: Vec::new(), places: Vec::new(), ..*self };
        let without = bytes(&without.dataset())?;
        let dataset = self.dataset();
        // Compressed arrays take room even where all their numbers are the same.
        let blank = bytes(&blank(&dataset))?;
        let plain: usize = dataset.variables.values().map(encode::plain_bytes).sum();
        let of_cases = bytes(&dataset)? - blank + plain as f64;
        Ok([without.max(blank - plain as f64), of_cases])
    }

    /// The dataset of the study, with these of its cases only, along one dimension.
    fn dataset(&self) -> Dataset {
        let mut dataset = schema::frame(self.study);
        let columns = schema::columns(self.study, &self.records);
        let slab = Slab::whole(&[self.cases]);
        for (name, variable) in columns.variables {
            let mut filling = Filling::new(&slab, &name, &variable.values);
            let places = self.places.iter().map(|place| Some(*place));
            match &variable.values {
                Values::Real(own) => filling.put_reals(places, own.as_slice().expect("a table")),
                Values::Integer(own) => {
                    filling.put_integers(places, own.as_slice().expect("a table"));
                }
            }
            dataset.variables.insert(name, Variable { values: filling.finish(), ..variable });
        }
        let labels = ["1", CASE].map(str::to_owned);
        let along = Variable::labelled(vec![CASE.to_owned()], labels, Values::count(self.cases));
        dataset.coordinates.push((CASE.to_owned(), along));
        dataset.coordinates.extend(columns.coordinates);
        dataset
    }
}

/// The same variables with the same number everywhere in each.
fn blank(dataset: &Dataset) -> Dataset {
    let mut blank = dataset.clone();
    for variable in blank.variables.values_mut() {
        match &mut variable.values {
            Values::Real(all) => all.fill(f64::NAN),
            Values::Integer(all) => all.fill(0),
        }
    }
    blank
}

/// Bytes of a dataset in a file.
fn bytes(dataset: &Dataset) -> Result<f64, StoreError> {
    Ok(encode::image(dataset, Path::new("a sample of the file"))?.len() as f64)
}
