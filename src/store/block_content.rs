//! What a block holds of its records: a summary, and columns of numbers.

use std::collections::BTreeMap;
use std::io;

use super::block_file::{self, Column, Numbers, Summary};
use super::catalogue::{CASE, RESIDUAL, end, starts};
use super::{Values, schema};
use crate::description::Description;
use crate::run::Record;
use crate::study::{Refine, Study};

/// The bytes of the block `number` of these records, of a study with this fingerprint, as its file would hold them.
///
/// Fails if the numbers cannot be packed.
pub fn block_image(
    study: &Study,
    fingerprint: &str,
    number: usize,
    records: &[Record],
) -> io::Result<Vec<u8>> {
    block_file::image(fingerprint, summary(study, number, records), &columns(study, records))
}

/// Bytes that a block of these records takes.
pub fn packed_bytes(study: &Study, records: &[Record]) -> io::Result<usize> {
    block_image(study, &study.fingerprint(), 0, records).map(|image| image.len())
}

/// A block in a few numbers.
pub fn summary(study: &Study, number: usize, records: &[Record]) -> Summary {
    let mut outcomes = BTreeMap::new();
    let cases = if study.refine.is_some() { study.cases_of_block(number) } else { records.len() };
    let own = if study.refine.is_some() { study.block_cases(number) } else { Vec::new() };
    for record in records {
        if study.refine.is_none() || own.binary_search(&record.index).is_ok() {
            *outcomes.entry(record.orbit.outcome.name().to_owned()).or_default() += 1;
        }
    }
    let cycles = records.iter().map(|record| record.orbit.cycles).sum();
    Summary { number, cases, computed: records.len(), outcomes, cycles }
}

/// The columns of a block: the variables, and what is needed to compute cases again and to find their
/// attractors.
pub fn columns(study: &Study, records: &[Record]) -> Vec<Column> {
    let variables = schema::columns(study, records).variables.into_iter();
    let mut columns: Vec<Column> = variables
        .map(|(name, variable)| {
            let numbers = match variable.values {
                Values::Real(reals) => Numbers::Real(reals.into_raw_vec_and_offset().0),
                Values::Integer(all) => Numbers::Integer(all.into_raw_vec_and_offset().0),
            };
            Column { name, numbers }
        })
        .collect();
    if study.refine.is_some() {
        let cases = records.iter().map(|record| record.index as i64).collect();
        columns.push(Column { name: CASE.to_owned(), numbers: Numbers::Integer(cases) });
    }
    let left_out =
        study.base.model().rest_share().filter(|rest_share| !study.outputs.contains(rest_share));
    // What tells the cases of a refined map apart is whether they are always at rest, too, whatever outputs are kept.
    if let (Some(Refine::Outputs(_)), Some(rest_share)) = (&study.refine, left_out) {
        columns.push(reals(rest_share.name(), records, |it| it.orbit.outputs[rest_share]));
    }
    columns.extend(beyond_variables(study.base.model(), records));
    columns
}

/// The columns of a block that are no variables of the results.
fn beyond_variables(model: &'static Description, records: &[Record]) -> Vec<Column> {
    let mut columns = Vec::new();
    for (coordinate, start) in model.start_coordinates().zip(starts(model)) {
        columns.push(reals(start.name, records, |it| it.start[coordinate]));
    }
    for (coordinate, end) in model.section_coordinates().zip(end(model)) {
        columns.push(reals(end.name, records, |it| it.orbit.end[coordinate]));
    }
    columns.push(reals(RESIDUAL.name, records, |it| it.orbit.certificate.residual));
    columns
}

/// A column of a quantity of each record.
fn reals(name: &str, records: &[Record], of: impl Fn(&Record) -> f64) -> Column {
    let numbers = Numbers::Real(records.iter().map(of).collect());
    Column { name: name.to_owned(), numbers }
}
