//! How large the file of results will be, by a sample of its cases.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::run::Record;
use crate::study::Study;

use super::catalogue::CASE;
use super::element::Element;
use super::encode::{self, COMPRESSED_FROM_BYTES, COMPRESSION};
use super::slab::{Filling, Slab};
use super::{Dataset, StoreError, Values, Variable, schema};

/// Cases with which every real variable is compressed.
const COMPRESSED_CASES: usize = COMPRESSED_FROM_BYTES / size_of::<f64>();

/// Some cases of a study.
struct Sample<'a> {
    study: &'a Study,
    /// How many they are.
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
    let sample = Sample { study, cases, records: records.to_vec(), places };
    sample.file_bytes(study.cases() as f64 / cases as f64)
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
    let records = sample.records.len() as f64;
    sample.file_bytes(computed * study.cases() as f64 / records)
}

impl Sample<'_> {
    /// Bytes of the file, whose compressed numbers take so many times the bytes of those of the sample.
    fn file_bytes(&self, factor: f64) -> Result<f64, StoreError> {
        let cases = self.study.cases();
        // What stands in the file of a study without cases, as the values that were drawn, is there for all of them.
        let of_frame: BTreeSet<String> = schema::frame(self.study).variables.into_keys().collect();
        let without = bytes(&self.blank(0).dataset())?;
        // An array that is compressed takes room even where all its numbers are the same.
        let same = self.blank(cases.min(COMPRESSED_CASES)).dataset();
        let beside = bytes(&same)? - without;
        let coordinates = same.coordinates.iter().filter(|(name, _)| name == CASE);
        let variables = same.variables.iter().filter(|(name, _)| !of_frame.contains(*name));
        let coordinates = coordinates.map(|(_, it)| it);
        let plain = coordinates.chain(variables.map(|(_, it)| it)).map(plain_bytes);
        let beside = (beside - plain.sum::<usize>() as f64).max(0.0);
        let mut numbers = 0.0;
        for (name, variable) in &self.dataset().variables {
            if of_frame.contains(name) {
                continue;
            }
            let per_case = byte_count(variable) as f64 / self.cases as f64;
            let all = per_case * cases as f64;
            let is_plain = all < COMPRESSED_FROM_BYTES as f64;
            numbers += if is_plain {
                all
            } else {
                factor * compressed_bytes(&self.study.shape(), variable) as f64
            };
        }
        Ok(without + beside + numbers)
    }

    /// So many cases of the study, none of which has been computed.
    fn blank(&self, cases: usize) -> Sample<'_> {
        Sample { study: self.study, cases, records: Vec::new(), places: Vec::new() }
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

/// Bytes of a dataset in a file.
fn bytes(dataset: &Dataset) -> Result<f64, StoreError> {
    Ok(encode::image(dataset, Path::new("a sample of the file"))?.len() as f64)
}

/// Bytes of the numbers of a variable.
fn byte_count(variable: &Variable) -> usize {
    element(variable).bytes() * variable.values.shape().iter().product::<usize>()
}

/// The same where it is too small to be compressed, else none.
fn plain_bytes(variable: &Variable) -> usize {
    Some(byte_count(variable)).filter(|bytes| *bytes < COMPRESSED_FROM_BYTES).unwrap_or(0)
}

fn element(variable: &Variable) -> Element {
    Element::of(variable, variable.values.range())
}

/// Bytes of the numbers of a variable along the cases of a sample as HDF5 compresses them: chunk by chunk, of each first the
/// lowest byte of each number, then the next.
///
/// In the file the cases lie along the axes of the study, `shape`, and a chunk has some values of each; here it has as many
/// cases.
fn compressed_bytes(shape: &[usize], variable: &Variable) -> usize {
    let width = element(variable).bytes();
    let numbers: Vec<[u8; 8]> = match &variable.values {
        Values::Real(all) => all.iter().map(|number| number.to_le_bytes()).collect(),
        Values::Integer(all) => all.iter().map(|number| number.to_le_bytes()).collect(),
    };
    let sample = variable.values.shape();
    let (cases, of_case) = (sample[0], &sample[1..]);
    let chunk = encode::chunk_shape(&[shape, of_case].concat(), width);
    let (together, of_chunk) = chunk.split_at(shape.len());
    let together = together.iter().product::<usize>().max(1);
    let size: usize = of_case.iter().product();
    let mut bytes = 0;
    for first in (0..cases).step_by(together) {
        for places in chunks(of_case, of_chunk) {
            let mut chunk = Vec::new();
            for case in first..(first + together).min(cases) {
                chunk.extend(places.iter().map(|place| numbers[case * size + place]));
            }
            bytes += deflated_bytes(&chunk, width);
        }
    }
    bytes
}

/// The places of an array that lie in each of its chunks.
fn chunks(shape: &[usize], chunk: &[usize]) -> Vec<Vec<usize>> {
    let mut all = vec![vec![0]];
    for (&length, &along) in shape.iter().zip(chunk) {
        let mut split = Vec::new();
        for places in &all {
            for first in (0..length).step_by(along.max(1)) {
                let part = first..(first + along).min(length);
                let mut of_chunk = Vec::new();
                for place in places {
                    of_chunk.extend(part.clone().map(|it| place * length + it));
                }
                split.push(of_chunk);
            }
        }
        all = split;
    }
    all
}

/// Bytes of numbers that are packed together, each of so many bytes.
fn deflated_bytes(numbers: &[[u8; 8]], width: usize) -> usize {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(u32::from(COMPRESSION)));
    for byte in 0..width {
        let bytes: Vec<u8> = numbers.iter().map(|number| number[byte]).collect();
        encoder.write_all(&bytes).expect("memory takes all");
    }
    encoder.finish().expect("memory takes all").len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_lies_in_one_chunk_beside_its_neighbours() {
        assert_eq!(chunks(&[], &[]), [[0]]);
        assert_eq!(chunks(&[5], &[2]), [vec![0, 1], vec![2, 3], vec![4]]);
        assert_eq!(chunks(&[2, 3], &[2, 2]), [vec![0, 1, 3, 4], vec![2, 5]]);
    }
}
