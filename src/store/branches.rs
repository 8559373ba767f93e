//! The variables of the branches in a file of results, beside those of the sweep.

use super::branch_columns::OrbitTable;
use super::catalogue;
use super::catalogue::*;
use super::columns::Columns;
use super::flat::Flat;
use super::{Dataset, Values, Variable};
use crate::branch::End;
use crate::description::Parameter;
use crate::run::Continued;
use crate::study::{Continuation, Study};

/// Whether a name is that of a dimension of the branches or ramps, none of which is an axis of a study.
pub fn is_beside_cases(dimension: &str) -> bool {
    OF_BRANCHES.iter().chain(&OF_RAMPS).any(|entry| entry.name == dimension)
}

/// Whether `dataset` holds branches and ramps, be they none, which `capsulemap continue` finds.
pub fn has_branches(dataset: &Dataset) -> bool {
    dataset.coordinate(REQUEST.name).is_some()
}

/// Whether `dataset` holds what `capsulemap sweep` finds.
pub fn has_cases(dataset: &Dataset) -> bool {
    dataset.variable(OUTCOME.name).is_some()
}

/// Removes the branches and the ramps from `dataset`.
pub fn drop_branches(dataset: &mut Dataset) {
    dataset.coordinates.retain(|(name, _)| !is_beside_cases(name));
    dataset.variables.retain(|_, variable| !lies_beside_cases(variable));
    NAMES.iter().for_each(|names| drop(dataset.texts.remove(*names)));
}

/// Takes the branches and the ramps of `older` over into `dataset`.
pub fn keep_branches(dataset: &mut Dataset, older: &Dataset) {
    let coordinates = older.coordinates.iter().filter(|(name, _)| is_beside_cases(name));
    dataset.coordinates.extend(coordinates.cloned());
    let variables = older.variables.iter().filter(|(_, variable)| lies_beside_cases(variable));
    dataset.variables.extend(variables.map(|(name, variable)| (name.clone(), variable.clone())));
    let names = older.texts.iter().filter(|(name, _)| NAMES.contains(&name.as_str()));
    dataset.texts.extend(names.map(|(name, names)| (name.clone(), names.clone())));
}

/// The texts that name branches and ramps.
const NAMES: [&str; 2] = [BRANCH_NAMES, RAMP_NAMES];

fn lies_beside_cases(variable: &Variable) -> bool {
    variable.dimensions.iter().any(|it| is_beside_cases(it))
}

/// Adds what came of the `branches` of a study and of its boundaries, in their order.
pub fn add_branches(
    dataset: &mut Dataset,
    study: &Study,
    branches: &[Continuation],
    continued: &[Continued],
) {
    let flat = Flat::new(branches, continued);
    let longest = flat.points.iter().chain(&flat.specials).map(|row| row.point.section.len());
    for (dimension, length) in [
        (REQUEST, branches.len()),
        (INDEX, flat.branches.len()),
        (BRANCH_POINT, flat.points.len()),
        (BRANCH_CYCLE, longest.max().unwrap_or(0)),
        (BRANCH_MULTIPLIER, dataset.model().section.len()),
        (SPECIAL_POINT, flat.specials.len()),
        (CURVE_INDEX, flat.curves.len()),
        (CURVE_POINT, flat.curve_points.len()),
        (CODIM2_POINT, flat.codim2.len()),
    ] {
        dataset.put_coordinate(dimension, Values::count(length));
    }
    let names: Vec<&str> = branches.iter().map(|branch| branch.name.as_str()).collect();
    dataset.texts.insert(BRANCH_NAMES.to_owned(), names.join("\n"));
    add_requests(dataset, branches, continued);
    add_index(dataset, &flat);
    let along = parameters(branches.iter().map(|branch| branch.along));
    let points = OrbitTable { place: Place::Branch, own: &AT_BRANCH_POINTS, rows: &flat.points };
    points.add(dataset, &along, &study.outputs);
    let specials =
        OrbitTable { place: Place::Special, own: &AT_SPECIAL_POINTS, rows: &flat.specials };
    specials.add(dataset, &along, &study.outputs);
    add_special_kinds(dataset, &flat);
    let of_curves = of_curves(branches);
    add_curves(dataset, &of_curves, &flat);
    add_codim2(dataset, &of_curves, &flat);
}

/// The parameters among `given`, each once, in the order of the model.
fn parameters(given: impl Iterator<Item = Parameter>) -> Vec<Parameter> {
    let given: Vec<Parameter> = given.collect();
    let model = given.first().map(|it| it.model());
    let all = model.into_iter().flat_map(|model| model.parameters());
    all.filter(|parameter| given.contains(parameter)).collect()
}

/// A column of measured quantities.
fn reals(dataset: &mut Dataset, entry: Entry, values: impl Iterator<Item = f64>) {
    dataset.put_column(entry, Values::reals(values.collect()));
}

/// A column of counts, of categories or of the numbers of others.
fn integers(dataset: &mut Dataset, entry: Entry, values: impl Iterator<Item = i64>) {
    dataset.put_column(entry, Values::integers(values.collect()));
}

/// A column of parameters of the model.
fn by_symbol(dataset: &mut Dataset, entry: Entry, of: impl Iterator<Item = Parameter>) {
    let values = Values::integers(of.map(|parameter| parameter.index() as i64).collect());
    let symbols = catalogue::parameters(dataset.model());
    dataset.put_column(entry, values).flags = symbols;
}

/// The parameter, the start and the result of each branch of the study.
fn add_requests(dataset: &mut Dataset, branches: &[Continuation], continued: &[Continued]) {
    let model = dataset.model();
    let results = Values::integers(continued.iter().map(result).collect());
    dataset.put_column(REQUEST_RESULT, results).flags = catalogue::results(dataset.model());
    by_symbol(dataset, REQUEST_ALONG, branches.iter().map(|branch| branch.along));
    if model.has_drive() {
        reals(dataset, REQUEST_PHASE, branches.iter().map(|branch| branch.section_phase));
    }
    let is_told = |it: &Parameter| branches.iter().any(|branch| branch.parameters.states(*it));
    for parameter in model.parameters().filter(is_told) {
        let values = branches.iter().map(|branch| branch.parameters[parameter]);
        reals(dataset, Place::Request.of(Entry::of_parameter(parameter)), values);
    }
}

/// Where each branch comes from.
fn add_index(dataset: &mut Dataset, flat: &Flat<'_>) {
    let branches = &flat.branches;
    integers(dataset, INDEX_REQUEST, branches.iter().map(|branch| branch.request as i64));
    by_symbol(dataset, INDEX_ALONG, branches.iter().map(|branch| branch.along));
    integers(dataset, INDEX_PERIOD, branches.iter().map(|branch| branch.period as i64));
    let parents = branches.iter().map(|branch| branch.parent.map_or(-1, |(parent, _)| parent));
    integers(dataset, INDEX_PARENT, parents);
    let specials = branches.iter().map(|branch| branch.parent.map_or(-1, |(_, special)| special));
    integers(dataset, INDEX_PARENT_SPECIAL, specials);
    let ends = branches.iter().map(|branch| branch.ends);
    add_ends(dataset, [INDEX_END_FIRST, INDEX_END_LAST], ends);
}

/// Why each branch or curve ends where it does.
fn add_ends(
    dataset: &mut Dataset,
    entries: [Entry; 2],
    ends: impl Iterator<Item = [End; 2]> + Clone,
) {
    for (place, entry) in entries.into_iter().enumerate() {
        integers(dataset, entry, ends.clone().map(|ends| ends[place] as i64));
    }
}

fn add_special_kinds(dataset: &mut Dataset, flat: &Flat<'_>) {
    let specials = &flat.special_kinds;
    integers(dataset, SPECIAL_KIND, specials.iter().map(|special| special.kind as i64));
    integers(dataset, SPECIAL_AFTER, specials.iter().map(|special| special.after as i64));
    let curves = specials.iter().map(|special| special.curve.map_or(-1, |curve| curve as i64));
    integers(dataset, SPECIAL_CURVE, curves);
}

/// The curves in two parameters; a parameter that a curve does not vary is NaN on it.
fn add_curves(dataset: &mut Dataset, of_curves: &[Parameter], flat: &Flat<'_>) {
    let ends = flat.curves.iter().map(|curve| curve.ends);
    add_ends(dataset, [CURVE_END_FIRST, CURVE_END_LAST], ends);
    let mut columns = Columns { dataset, rows: &flat.curve_points };
    columns.integers(CURVE, |it| it.curve as i64);
    columns.integers(CURVE_KIND, |it| flat.curves[it.curve].kind as i64);
    columns.integers(CURVE_PERIOD, |it| flat.curves[it.curve].period as i64);
    columns.integers(CURVE_THROUGH, |it| flat.curves[it.curve].through as i64);
    for &parameter in of_curves {
        columns.reals(Place::Curve.of(Entry::of_parameter(parameter)), |it| {
            flat.curves[it.curve].value(parameter, it.parameters)
        });
    }
}

/// The parameters in which curves are continued.
fn of_curves(branches: &[Continuation]) -> Vec<Parameter> {
    let asked = branches.iter().filter(|branch| branch.second.is_some());
    parameters(asked.flat_map(Continuation::varied))
}

/// The points of codimension 2 on the curves.
fn add_codim2(dataset: &mut Dataset, of_curves: &[Parameter], flat: &Flat<'_>) {
    let count = dataset.model().section.len();
    let coordinates = section(dataset.model());
    let mut columns = Columns { dataset, rows: &flat.codim2 };
    columns.integers(CODIM2_KIND, |it| it.point.kind as i64);
    columns.integers(CODIM2_CURVE, |it| it.curve as i64);
    columns.integers(CODIM2_AFTER, |it| it.after as i64);
    columns.integers(CODIM2_PERIOD, |it| flat.curves[it.curve].period as i64);
    for &parameter in of_curves {
        columns.reals(Place::Codim2.of(Entry::of_parameter(parameter)), |it| {
            flat.curves[it.curve].value(parameter, it.point.parameters)
        });
    }
    for (i, entry) in coordinates.into_iter().enumerate() {
        columns.reals(Place::Codim2.of(entry), |it| it.point.section[i]);
    }
    columns.several(CODIM2_MULTIPLIER_REAL, count, |it, at| it.point.multipliers[at].re);
    columns.several(CODIM2_MULTIPLIER_IMAG, count, |it, at| it.point.multipliers[at].im);
}
