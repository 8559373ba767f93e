//! Which variables the followed orbits have in a file of results, beside those of the sweep.

use crate::branch::{End, SpecialKind};
use crate::capsule::Parameter;
use crate::orbit::{Outcome, Reason};
use crate::run::{Followed, Unfollowed};
use crate::study::{Continuation, Study};

use super::branch_columns::{CYCLE, Columns, MULTIPLIER, Place, add_points};
use super::flat::Flat;
use super::schema::{coordinate, count};
use super::{Dataset, Variable};

/// Dimension: the branches that the study asks for.
const REQUEST: &str = "branch_request";
/// Dimension: the branches that were followed, those that doubling led to included.
const BRANCH: &str = "branch_index";
/// Dimension: the points of all branches.
const POINT: &str = "branch_point";
/// Dimension: the special points of all branches.
const SPECIAL: &str = "special_point";
/// Dimension: the curves in two parameters.
const CURVE: &str = "curve_index";
/// Dimension: the points of all curves.
const CURVE_POINT: &str = "curve_point";

/// The dimensions of the branches, none of which is an axis of a study.
pub const DIMENSIONS: [&str; 8] =
    [REQUEST, BRANCH, POINT, CYCLE, MULTIPLIER, SPECIAL, CURVE, CURVE_POINT];

/// The text that names the branches of the study, one a line.
pub const NAMES: &str = "branch_names";

/// Whether `dataset` holds what `capsulemap follow` finds.
pub fn has_branches(dataset: &Dataset) -> bool {
    dataset.coordinate(REQUEST).is_some()
}

/// Whether `dataset` holds what `capsulemap sweep` finds.
pub fn has_cases(dataset: &Dataset) -> bool {
    dataset.variable("outcome").is_some()
}

/// Removes the branches from `dataset`.
pub fn drop_branches(dataset: &mut Dataset) {
    let ours = |name: &str| DIMENSIONS.contains(&name);
    dataset.coordinates.retain(|(name, _)| !ours(name));
    dataset.variables.retain(|_, variable| !variable.dimensions.iter().any(|name| ours(name)));
    dataset.texts.remove(NAMES);
}

/// Takes the branches of `older` over into `dataset`.
pub fn keep_branches(dataset: &mut Dataset, older: &Dataset) {
    let ours = |name: &str| DIMENSIONS.contains(&name);
    let coordinates = older.coordinates.iter().filter(|(name, _)| ours(name));
    dataset.coordinates.extend(coordinates.cloned());
    let of_branches = |variable: &Variable| variable.dimensions.iter().any(|name| ours(name));
    let variables = older.variables.iter().filter(|(_, variable)| of_branches(variable));
    dataset.variables.extend(variables.map(|(name, variable)| (name.clone(), variable.clone())));
    let names = older.texts.get(NAMES);
    dataset.texts.extend(names.map(|names| (NAMES.to_owned(), names.clone())));
}

/// Adds what came of the branches of `study`, in its order.
pub fn add_branches(dataset: &mut Dataset, study: &Study, followed: &[Followed]) {
    let flat = Flat::new(&study.branches, followed);
    let longest = flat.points.iter().chain(&flat.specials).map(|row| row.point.section.len());
    for (name, length, meaning) in [
        (REQUEST, study.branches.len(), "branch that the study asks for"),
        (BRANCH, flat.branches.len(), "branch that was followed"),
        (POINT, flat.points.len(), "point of the branches, one branch after the other"),
        (CYCLE, longest.max().unwrap_or(0), "drive cycle within the period"),
        (MULTIPLIER, 3, "Floquet multiplier, the largest magnitude first"),
        (SPECIAL, flat.specials.len(), "special point of the branches, one branch after the other"),
        (CURVE, flat.curves.len(), "curve in two parameters"),
        (CURVE_POINT, flat.curve_points.len(), "point of the curves, one curve after the other"),
    ] {
        dataset.coordinates.push(coordinate(name, "1", meaning, count(length)));
    }
    let names: Vec<&str> = study.branches.iter().map(|branch| branch.name.as_str()).collect();
    dataset.texts.insert(NAMES.to_owned(), names.join("\n"));
    add_requests(dataset, study, followed);
    add_index(dataset, &flat);
    let along = parameters(study.branches.iter().map(|branch| branch.along));
    let point = Place { dimension: POINT, prefix: "branch", on: "on the branch" };
    add_points(dataset, &point, &flat.points, &along, &study.outputs);
    let special = Place { dimension: SPECIAL, prefix: "special", on: "at the special point" };
    add_points(dataset, &special, &flat.specials, &along, &study.outputs);
    add_special_kinds(dataset, &flat);
    add_curves(dataset, study, &flat);
}

/// The parameters among `given`, each once, in the order of the model.
fn parameters(given: impl Iterator<Item = Parameter>) -> Vec<Parameter> {
    let given: Vec<Parameter> = given.collect();
    Parameter::ALL.iter().copied().filter(|parameter| given.contains(parameter)).collect()
}

/// What each branch of the study follows and from where, and what came of it.
fn add_requests(dataset: &mut Dataset, study: &Study, followed: &[Followed]) {
    let branches = &study.branches;
    let mut columns = Columns::new(dataset, REQUEST);
    let results = followed.iter().map(result);
    columns.flags("request_result", "what came of the branch", results, results_by_name());
    let along = branches.iter().map(|branch| branch.along as i64);
    columns.flags("request_along", "parameter that is followed", along, symbols());
    let phases = branches.iter().map(|branch| branch.section_phase);
    columns.reals("request_phase", "rad", "phase of the drive at the section", phases);
    for &parameter in Parameter::ALL {
        let values = branches.iter().map(|branch| branch.parameters[parameter]);
        let (name, unit) =
            (format!("request_{}", parameter.symbol()), parameter.dimension().unit());
        let meaning = format!("{} at the first orbit", parameter.meaning());
        columns.reals(&name, unit, &meaning, values);
    }
}

/// The number of what came of a branch.
fn result(followed: &Followed) -> i64 {
    let reasons = Reason::NAMES.len() as i64;
    match followed {
        Ok(_) => 0,
        Err(Unfollowed::Failed(reason)) => *reason as i64,
        Err(Unfollowed::NoOrbit) => reasons + 1,
        Err(Unfollowed::AsPrinted) => reasons + 2,
        Err(Unfollowed::Neutral) => reasons + 3,
        // No outcome that is told here has the number zero.
        Err(Unfollowed::Unsettled(outcome)) => reasons + 3 + *outcome as i64,
    }
}

/// Everything that may come of a branch.
fn results_by_name() -> Vec<(i64, String)> {
    let reasons =
        Reason::NAMES.map(|(reason, name)| (Err(Unfollowed::Failed(reason)), name.to_owned()));
    let no_orbit = (Err(Unfollowed::NoOrbit), "no-orbit".to_owned());
    let as_printed = (Err(Unfollowed::AsPrinted), "as-printed".to_owned());
    let neutral = (Err(Unfollowed::Neutral), "neutral".to_owned());
    let unsettled = Outcome::ALL
        .into_iter()
        .filter(|outcome| !matches!(outcome, Outcome::Periodic | Outcome::Failed))
        .map(|outcome| (Err(Unfollowed::Unsettled(outcome)), outcome.name().to_owned()));
    let failures = reasons.into_iter().chain([no_orbit, as_printed, neutral]).chain(unsettled);
    let followed = std::iter::once((0, "followed".to_owned()));
    followed.chain(failures.map(|(why, name)| (result(&why), name))).collect()
}

/// The parameters by their symbols.
fn symbols() -> Vec<(i64, String)> {
    Parameter::ALL.iter().map(|&it| (it as i64, it.symbol().to_owned())).collect()
}

/// Where each branch comes from.
fn add_index(dataset: &mut Dataset, flat: &Flat<'_>) {
    let mut columns = Columns::new(dataset, BRANCH);
    let branches = &flat.branches;
    let requests = branches.iter().map(|branch| branch.request as i64);
    columns.integers("index_request", "branch of the study that led here", requests);
    let along = branches.iter().map(|branch| branch.along as i64);
    columns.flags("index_along", "parameter that is followed", along, symbols());
    let periods = branches.iter().map(|branch| branch.period as i64);
    columns.integers("index_period", "period of its orbits in drive cycles", periods);
    let parents = branches.iter().map(|branch| branch.parent.map_or(-1, |(parent, _)| parent));
    columns.integers("index_parent", "branch that it left at a period doubling, or -1", parents);
    let specials = branches.iter().map(|branch| branch.parent.map_or(-1, |(_, special)| special));
    columns.integers("index_parent_special", "special point where it left, or -1", specials);
    add_ends(&mut columns, "index", "branch", branches.iter().map(|branch| branch.ends));
}

/// Why each branch or curve ends where it does.
fn add_ends(
    columns: &mut Columns<'_>,
    prefix: &str,
    what: &str,
    ends: impl Iterator<Item = [End; 2]> + Clone,
) {
    let reasons = || End::NAMES.map(|(name, end)| (end as i64, name.to_owned())).to_vec();
    for (place, which) in ["first", "last"].into_iter().enumerate() {
        let codes = ends.clone().map(|ends| ends[place] as i64);
        let (name, meaning) =
            (format!("{prefix}_end_{which}"), format!("why the {what} ends at its {which} point"));
        columns.flags(&name, &meaning, codes, reasons());
    }
}

fn kinds() -> Vec<(i64, String)> {
    SpecialKind::NAMES.map(|(name, kind)| (kind as i64, name.to_owned())).to_vec()
}

fn add_special_kinds(dataset: &mut Dataset, flat: &Flat<'_>) {
    let mut columns = Columns::new(dataset, SPECIAL);
    let specials = &flat.special_kinds;
    let codes = specials.iter().map(|special| special.kind as i64);
    columns.flags("special_kind", "what happens at the special point", codes, kinds());
    let after = specials.iter().map(|special| special.after as i64);
    columns.integers("special_after", "point of the branch that it comes after", after);
    let curves = specials.iter().map(|special| special.curve.map_or(-1, |curve| curve as i64));
    columns.integers("special_curve", "curve that goes through it, or -1", curves);
}

/// The curves in two parameters; a parameter that a curve does not vary is NaN on it.
fn add_curves(dataset: &mut Dataset, study: &Study, flat: &Flat<'_>) {
    let mut columns = Columns::new(dataset, CURVE);
    add_ends(&mut columns, "curve", "curve", flat.curves.iter().map(|curve| curve.ends));
    let mut columns = Columns::new(dataset, CURVE_POINT);
    let curve = |at: &(usize, [f64; 2])| &flat.curves[at.0];
    let points = &flat.curve_points;
    columns.integers("curve", "curve in two parameters", points.iter().map(|it| it.0 as i64));
    let codes = points.iter().map(|it| curve(it).kind as i64);
    columns.flags("curve_kind", "what happens on the curve", codes, kinds());
    let periods = points.iter().map(|it| curve(it).period as i64);
    columns.integers("curve_period", "period of its orbits in drive cycles", periods);
    let through = points.iter().map(|it| curve(it).through as i64);
    columns.integers("curve_through", "special point that it was followed from", through);
    let asked = study.branches.iter().filter(|branch| branch.second.is_some());
    for parameter in parameters(asked.flat_map(Continuation::varied)) {
        let values = points.iter().map(|it| {
            let varied = curve(it).varied;
            let place = varied.iter().position(|&varied| varied == Some(parameter));
            place.map_or(f64::NAN, |place| it.1[place])
        });
        let meaning = format!("{} on the curve", parameter.meaning());
        let (name, unit) = (format!("curve_{}", parameter.symbol()), parameter.dimension().unit());
        columns.reals(&name, unit, &meaning, values);
    }
}
