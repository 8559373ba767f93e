//! The parameters in which the orbits of a file of results were continued, or motions followed along ramps.

use crate::store::catalogue::{CURVE_POINT, Entry, Place, RAMP_ALONG, REQUEST_ALONG};
use crate::store::dataset::Dataset;

/// What is read here.
pub const READS: [Entry; 2] = [REQUEST_ALONG, RAMP_ALONG];

/// The parameters along which orbits were continued or motions followed, in the order of the study.
pub fn along(dataset: &Dataset) -> Vec<&str> {
    let mut names = Vec::new();
    for variable in READS.iter().filter_map(|entry| dataset.variable(entry.name)) {
        for code in variable.values.to_real() {
            let flag = variable.flags.iter().find(|(value, _)| *value as f64 == code);
            names.extend(flag.map(|(_, name)| name.as_str()).filter(|it| !names.contains(it)));
        }
    }
    names
}

/// The parameters that branches or curves run in.
pub fn varied(dataset: &Dataset) -> Vec<&str> {
    let over_curves =
        dataset.variables.iter().filter(|(_, it)| it.dimensions == [CURVE_POINT.name]);
    let columns = over_curves.filter_map(|(name, _)| Place::Curve.base(name));
    // What the curves are stands over their points, too.
    let second = columns.filter(|name| dataset.model().parameter(name).is_some());
    along(dataset).into_iter().chain(second).collect()
}
