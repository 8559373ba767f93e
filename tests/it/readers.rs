//! What others read of our files: real Python packages open them and find names, coordinates, units and bits.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use capsulemap::store::{self, Dataset, Values};
use capsulemap::study::{Coordinate, Draws};
use serde_json::{Value, json};

use super::program::WorkDir;
use super::store::{rich, say};

/// What the Python side must find, read from the dataset in memory and not from the file.
fn expectation(dataset: &Dataset) -> Value {
    let coordinates = dataset.coordinates.iter().map(|(name, variable)| (name, variable));
    let variables: BTreeMap<&String, Value> = coordinates
        .chain(&dataset.variables)
        .map(|(name, variable)| {
            let values: Vec<String> = match &variable.values {
                Values::Real(reals) => reals.iter().map(f64::to_string).collect(),
                Values::Integer(integers) => integers.iter().map(i64::to_string).collect(),
            };
            let kind = if matches!(variable.values, Values::Real(_)) { "real" } else { "integer" };
            let about = json!({
                "dimensions": variable.dimensions, "shape": variable.values.shape(),
                "units": variable.unit, "long_name": variable.long_name, "kind": kind,
                "values": values, "flags": variable.flags,
            });
            (name, about)
        })
        .collect();
    let coordinates: Vec<&String> = dataset.coordinates.iter().map(|(name, _)| name).collect();
    // What varies along a path lies over its dimension, and is no dimension itself.
    let along_paths = Coordinate::all(dataset.model()).map(Coordinate::name);
    let along_paths = along_paths.filter_map(|it| dataset.variables.get_key_value(it));
    let along_paths = along_paths
        .filter(|(_, it)| it.dimensions.len() == 1 && it.dimensions != [Draws::DIMENSION]);
    let auxiliary: Vec<&String> = along_paths.map(|(name, _)| name).collect();
    json!({
        "coordinates": coordinates, "auxiliary": auxiliary, "variables": variables,
        "attributes": dataset.attributes, "texts": dataset.texts,
    })
}

/// The Python that has the readers; a printed line and none where there is none.
pub(super) fn python() -> Option<String> {
    let python = std::env::var("CAPSULEMAP_PYTHON").unwrap_or_else(|_| "python3".into());
    let readers = "import h5py, netCDF4, h5netcdf, xarray";
    let probe = Command::new(&python).args(["-c", readers]).output();
    let has = probe.is_ok_and(|done| done.status.success());
    if !has {
        say(&format!("SKIPPED: {python} cannot import h5py, netCDF4, h5netcdf and xarray"));
    }
    has.then_some(python)
}

/// Sure that every reader finds in the file at `path` what `dataset` holds.
pub(super) fn assert_readers_find(python: &str, path: &Path, dataset: &Dataset) {
    let expected = path.with_extension("expected.json");
    fs::write(&expected, expectation(dataset).to_string()).expect("it is written");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/check_dataset.py");
    let done = Command::new(python).arg(script).args([path, &expected]).output();
    let done = done.expect("python runs");
    let said = [done.stdout, done.stderr].concat();
    assert!(done.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&said));
}

#[test]
fn every_python_reader_finds_names_coordinates_and_units() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rich.nc");
    let mut dataset = rich();
    dataset.coordinates.push(super::store::nothing_along("none"));
    store::write(&dataset, &path).expect("it is written");
    assert_readers_find(&python, &path, &dataset);
}

/// Everything that a file may hold: several directions, histories, points, attractors, branches.
const STUDY: &str = r#"title = "µ, δ and all"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "80 rad/s"
points = 160
[[axes]]
name = "start_y1"
values = ["0 m/s", "0.2 m/s"]
[start]
inherit = "omega"
directions = ["upward", "downward"]
[history]
cycles = 1
samples_per_cycle = 8
[protocol]
points = 3
impact_points = 2
max_cycles = 100
exponent_cycles = 64
[[branches]]
name = "b"
along = "omega"
at = { omega = "20.73 rad/s" }
from = "20 rad/s"
to = "24 rad/s"
"#;

#[test]
fn every_file_that_the_program_writes_opens_with_all_its_labels() {
    let Some(python) = python() else { return };
    let dir = WorkDir::new();
    dir.put("all.toml", STUDY);
    let read = |path: &Path| store::read(path).expect("a result");
    // Branches alone; then, beside them, a look at a part of the cases; then all.
    let file = dir.path("results/all/all.h5");
    dir.run(&["continue", "all.toml"]).done();
    assert_readers_find(&python, &file, &read(&file));
    dir.run(&["sweep", "all.toml", "--task", "1/2"]).done();
    dir.run(&["join", "all.toml", "--partial"]).done();
    let partial = dir.path("results/all/partial/all.h5");
    assert_readers_find(&python, &partial, &read(&partial));
    dir.run(&["sweep", "all.toml"]).done();
    let whole = read(&file);
    for name in ["progression_speed", "branch_stable", "attractor", "history_r", "block_maker"] {
        assert!(whole.variable(name).is_some(), "{name}");
    }
    assert_readers_find(&python, &file, &whole);
}

/// A sweep in both directions through chaotic motions, which have no period.
const CHAOS: &str = r#"[parameters]
k2 = "60 kN/m"
c = "0.2 N s/m"
mu_s = 0.3
mu_d = 0.25
delta = "2 mm"
p_d = "5 N"
[[axes]]
name = "omega"
from = "12 rad/s"
to = "18 rad/s"
points = 7
[start]
inherit = "omega"
directions = ["upward", "downward"]
[protocol]
points = 2
impact_points = 0
"#;

#[test]
fn xarray_selects_by_name_and_keeps_constants_apart() {
    let Some(python) = python() else { return };
    let dir = WorkDir::new();
    dir.put("all.toml", CHAOS);
    dir.run(&["sweep", "all.toml", "--no-figures"]).done();
    let script = r#"
import numpy, xarray
runs = xarray.open_dataset("results/all/all.h5", engine="h5netcdf")
up, down = (runs.sel(direction=name) for name in ("upward", "downward"))
assert up.progression_speed.dims == ("omega",), up.progression_speed.dims
assert not numpy.array_equal(up.section_r.values, down.section_r.values, equal_nan=True)
assert runs.k2.shape == () and float(runs.k2) == 60000.0 and "k2" in runs.coords
fast = runs.where(runs.progression_speed > 1e-3)
assert fast.k2.shape == () and fast.study.shape == ()
assert isinstance(runs.attrs["protocol_max_cycles"] + 1, (int, numpy.integer))
assert runs.attrs["protocol_tolerance"] == 1e-12
other = runs.outcome.values != 0
assert other.any() and numpy.isnan(runs.period.values[other]).all()
assert (runs.period.values[~other] >= 1).all()
names = [variable.attrs["long_name"] for variable in runs.variables.values() if "long_name" in variable.attrs]
twice = {name for name in names if names.count(name) > 1}
assert not twice, twice
table = runs.progression_speed.to_dataframe()
assert len(table) == runs.progression_speed.size
"#;
    let done = Command::new(&python).args(["-c", script]).current_dir(dir.folder()).output();
    let done = done.expect("python runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn libraries_that_open_a_file_to_change_it_and_close_it_leave_it_whole() {
    let Some(python) = python() else { return };
    let dir = WorkDir::new();
    dir.put("hysteresis.toml", CHAOS);
    dir.run(&["sweep", "hysteresis.toml", "--no-figures"]).done();
    let path = dir.path("results/hysteresis/hysteresis.h5");
    let whole = fs::read(&path).expect("results");
    for (library, opens) in [("h5py", "File"), ("netCDF4", "Dataset")] {
        let script = format!("import sys, {library}; {library}.{opens}(sys.argv[1], 'a').close()");
        let mut command = Command::new(&python);
        let done = command.args(["-c", &script]).arg(&path).output().expect("python runs");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        assert!(fs::read(&path).expect("results") == whole, "{library}");
        dir.run(&["inspect", "results/hysteresis/hysteresis.h5"]).done();
    }
}

#[test]
fn what_xarray_adds_to_a_file_is_drawn_on_request() {
    let Some(python) = python() else { return };
    let dir = WorkDir::new();
    dir.put("hysteresis.toml", CHAOS);
    dir.run(&["sweep", "hysteresis.toml", "--no-figures"]).done();
    let document = fs::read_to_string("docs/results.md").expect("it is there");
    let mut blocks = document.split("```python\n").skip(1).filter_map(|it| it.split("```").next());
    let script = blocks.find(|it| it.contains("speed_per_power")).expect("it is there");
    let done = Command::new(&python).args(["-c", script]).current_dir(dir.folder()).output();
    let done = done.expect("python runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let kind = ["--kind", "bifurcation", "--of", "speed_per_power", "--formats", "svg", "--data"];
    let figure = [&["figure", "own.h5"], &kind[..]].concat();
    dir.run(&figure).refused(&["own.h5", "the checksum at its end is missing", "--unchecked"]);
    let set = ["--unchecked", "--svg-text", "--limits", "speed_per_power=-2,2", "--decimals"];
    let ran = dir.run(&[&figure[..], &set, &["speed_per_power=3"]].concat()).done();
    assert!(ran.err.contains("another program has changed it"), "{}", ran.err);
    let file = |end: &str| {
        fs::read_to_string(dir.path(&format!("bifurcation-speed_per_power.{end}"))).expect(end)
    };
    let (svg, csv) = (file("svg"), file("csv"));
    assert!(svg.contains(">power</tspan>") && svg.contains("2.000"), "{svg}");
    assert!(csv.lines().filter(|it| it.starts_with('1')).count() >= 7, "{csv}");
    // No other command takes it.
    for command in ["verify", "tradeoff", "report", "inspect"] {
        dir.run(&[command, "own.h5"]).refused(&["the checksum at its end is missing"]);
    }
    dir.run(&[&figure[..], &["--unchecked", "--limits", "speed_per_powr=1,2"]].concat())
        .refused(&["unknown quantity \"speed_per_powr\""]);
}
