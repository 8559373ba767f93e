//! A dataset on disk: it comes back the same, byte for byte alike each time, and never half-written.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use capsulemap::store::{self, Dataset, StoreError, Values, Variable};
use ndarray::{Array1, ArrayD};
use proptest::prelude::*;

fn real(dimensions: &[&str], unit: &str, values: ArrayD<f64>) -> Variable {
    labelled(dimensions, unit, Values::Real(values))
}

fn integer(dimensions: &[&str], values: ArrayD<i64>) -> Variable {
    labelled(dimensions, "1", Values::Integer(values))
}

fn labelled(dimensions: &[&str], unit: &str, values: Values) -> Variable {
    let dimensions = dimensions.iter().map(|name| name.to_string()).collect();
    let long_name = format!("a quantity in {unit}, in µ and ω");
    Variable { dimensions, unit: unit.into(), long_name, values, flags: Vec::new() }
}

fn array<T>(shape: &[usize], number: impl Fn(usize) -> T) -> ArrayD<T> {
    let size = shape.iter().product();
    let numbers = (0..size).map(number).collect::<Array1<T>>();
    numbers.into_shape_with_order(shape).expect("the size is the product of the shape")
}

/// A study in small with everything a result may contain, and one array large enough to compress.
pub fn rich() -> Dataset {
    let mut direction = integer(&["direction"], array(&[2], |i| i as i64));
    direction.flags = vec![(0, "up".into()), (1, "down".into())];
    let mut outcome = integer(&["direction", "p_d", "omega"], array(&[2, 3, 5], |i| i as i64 % 3));
    outcome.flags = vec![(-1, "failed".into()), (0, "periodic".into()), (2, "not-decided".into())];
    let coordinates = vec![
        ("omega".into(), real(&["omega"], "rad/s", array(&[5], |i| 10.0 + i as f64))),
        ("direction".into(), direction),
        ("p_d".into(), real(&["p_d"], "N", array(&[3], |i| 0.1 * i as f64))),
        ("point".into(), integer(&["point"], array(&[4000], |i| i as i64))),
    ];
    let speed = |i| if i % 7 == 0 { f64::NAN } else { 1e-3 / i as f64 };
    let mut cost = array(&[3, 5], |i| -(i as f64));
    cost[[1, 2]] = f64::INFINITY;
    let variables = BTreeMap::from([
        ("outcome".into(), outcome),
        ("speed".into(), real(&["direction", "p_d", "omega"], "m/s", array(&[2, 3, 5], speed))),
        ("cost_of_transport".into(), real(&["p_d", "omega"], "1", cost)),
        ("section".into(), real(&["point", "omega"], "m", array(&[4000, 5], |i| (i as f64).sin()))),
        ("impacts".into(), integer(&["omega"], array(&[5], |i| 70_000 * i as i64))),
        ("steps".into(), integer(&["omega"], array(&[5], |i| i64::MAX - i as i64))),
        ("mass".into(), real(&[], "kg", array(&[], |_| 0.11))),
    ]);
    Dataset {
        coordinates,
        variables,
        attributes: BTreeMap::from([
            ("title".into(), "Vitesse à ω".into()),
            ("note".into(), String::new()),
        ]),
        texts: BTreeMap::from([
            ("study".into(), "k2 = 2.42 # kN/m, µ\n".repeat(10_000)),
            ("empty".into(), String::new()),
        ]),
    }
}

/// A coordinate along which there is nothing.
pub fn nothing_along(name: &str) -> (String, Variable) {
    (name.into(), real(&[name], "s", array(&[0], |_| 0.0)))
}

/// A folder of its own for each test, and the path of a result in it.
fn place() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("result.nc");
    (folder, path)
}

fn entries(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be listed");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    entries.map(|entry| name(entry.expect("an entry"))).collect()
}

/// Prints a line even when the test passes: the usual macros print on failure only.
pub fn say(line: &str) {
    writeln!(std::io::stderr(), "{line}").expect("a line can be printed");
}

fn assert_round_trip(dataset: &Dataset) {
    let (_folder, path) = place();
    store::write(dataset, &path).expect("it is written");
    let back = store::read(&path).expect("it is read");
    assert_eq!(store::difference(dataset, &back), None);
}

#[test]
fn everything_comes_back() {
    assert_round_trip(&rich());
}

#[test]
fn an_empty_dataset_and_zero_axes_come_back() {
    assert_round_trip(&Dataset::default());
    let mut single = Dataset::default();
    single.variables.insert("speed".into(), real(&[], "m/s", array(&[], |_| f64::NAN)));
    single.variables.insert("period".into(), integer(&[], array(&[], |_| 3)));
    assert_round_trip(&single);
}

#[test]
fn an_axis_without_points_comes_back() {
    let mut dataset = rich();
    dataset.coordinates.push(("none".into(), real(&["none"], "s", array(&[0], |_| 0.0))));
    let empty = real(&["none", "omega"], "m", array(&[0, 5], |_| 0.0));
    dataset.variables.insert("empty_section".into(), empty);
    assert_round_trip(&dataset);
}

#[test]
fn an_array_that_is_not_in_order_in_memory_comes_back() {
    let mut dataset = rich();
    let turned = array(&[5, 3], |i| i as f64).reversed_axes();
    dataset.variables.insert("turned".into(), real(&["p_d", "omega"], "1", turned));
    assert_round_trip(&dataset);
}

#[test]
fn the_difference_names_what_differs() {
    let dataset = rich();
    let mut other = rich();
    if let Some(Values::Real(mass)) = other.variables.get_mut("mass").map(|mass| &mut mass.values) {
        mass.fill(0.12);
    }
    let said = store::difference(&dataset, &other).expect("they differ");
    assert!(said.contains("the values of mass"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_shapes_come_back(
        lengths in prop::collection::vec(1_usize..9, 0..5),
        real_bits in prop::collection::vec(any::<u64>(), 64),
        integers in prop::collection::vec(any::<i64>(), 64),
        small in any::<bool>(),
    ) {
        let names: Vec<String> = (0..lengths.len()).map(|axis| format!("axis_{axis}")).collect();
        let dimensions: Vec<&str> = names.iter().map(String::as_str).collect();
        let number = |i: usize| f64::from_bits(real_bits[i % 64]);
        let count = |i: usize| if small { integers[i % 64] % 100 } else { integers[i % 64] };
        let mut dataset = Dataset::default();
        // Coordinates in another order than the names' alphabet, to see that the order is kept.
        for (name, length) in dimensions.iter().zip(&lengths).rev() {
            let axis = real(&[name], "1", array(&[*length], number));
            dataset.coordinates.push((name.to_string(), axis));
        }
        for kept in 0..=dimensions.len() {
            let shape = &lengths[..kept];
            let values = real(&dimensions[..kept], "m", array(shape, number));
            dataset.variables.insert(format!("real_{kept}"), values);
            let values = integer(&dimensions[..kept], array(shape, count));
            dataset.variables.insert(format!("integer_{kept}"), values);
        }
        assert_round_trip(&dataset);
    }
}

#[test]
fn the_same_dataset_gives_the_same_bytes() {
    let (folder, path) = place();
    let again = folder.path().join("other-name.nc");
    store::write(&rich(), &path).expect("it is written");
    // Times in HDF5 are whole seconds: wait until one has passed, or equality would prove nothing.
    std::thread::sleep(Duration::from_millis(1100));
    store::write(&rich(), &again).expect("it is written");
    let (first, second) = (fs::read(&path).expect("bytes"), fs::read(&again).expect("bytes"));
    assert!(first == second, "two files of one dataset differ");
}

#[test]
fn a_new_file_replaces_an_older_one() {
    let (folder, path) = place();
    store::write(&Dataset::default(), &path).expect("it is written");
    store::write(&rich(), &path).expect("it is replaced");
    assert_eq!(store::difference(&rich(), &store::read(&path).expect("it is read")), None);
    assert_eq!(entries(folder.path()), ["result.nc"]);
}

#[test]
fn a_failing_write_leaves_nothing_behind() {
    let (folder, path) = place();
    // A folder has the file's name.
    fs::create_dir(&path).expect("a folder in the way");
    fs::write(path.join("something"), "kept").expect("a file in it");
    let refused = store::write(&rich(), &path).expect_err("a folder is in the way");
    assert!(matches!(refused, StoreError::NoPlace { .. }), "{refused}");
    assert_eq!(entries(folder.path()), ["result.nc"]);
    assert_eq!(entries(&path), ["something"]);

    let nowhere = folder.path().join("missing").join("result.nc");
    let refused = store::write(&rich(), &nowhere).expect_err("its folder is missing");
    assert!(refused.to_string().contains("folder exists"), "{refused}");
    assert_eq!(entries(folder.path()), ["result.nc"]);
}

#[test]
fn an_unfit_dataset_is_refused_and_the_older_file_kept() {
    let (folder, path) = place();
    store::write(&rich(), &path).expect("it is written");
    let mut unfit = rich();
    unfit.variables.insert("lost".into(), real(&["nowhere"], "m", array(&[2], |_| 0.0)));
    let refused = store::write(&unfit, &path).expect_err("a dimension has no coordinate");
    assert!(refused.to_string().contains("nowhere"), "{refused}");
    assert_eq!(store::difference(&rich(), &store::read(&path).expect("still there")), None);
    assert_eq!(entries(folder.path()), ["result.nc"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_keeps_the_older_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let disk = folder.path();
    let mount = |program: &str, options: &[&str]| {
        let status = Command::new(program).args(options).arg(disk).output();
        status.is_ok_and(|done| done.status.success())
    };
    if !mount("mount", &["-t", "tmpfs", "-o", "size=512k", "capsulemap-test"]) {
        say("SKIPPED: a full disk was not tried, mounting a small one is not allowed here");
        return;
    }
    let path = disk.join("result.nc");
    let kept = Dataset { texts: rich().texts, ..Dataset::default() };
    let first = store::write(&kept, &path);
    let mut large = rich();
    let noise = |i: usize| (i as f64 * 12.9898).sin() * 43758.5453;
    large
        .variables
        .insert("noise".into(), real(&["point", "omega"], "m", array(&[4000, 5], noise)));
    let second = store::write(&large, &path);
    let (back, left) = (store::read(&path), entries(disk));
    // Lazily: a child that another test starts holds this test's open files until its exec, and the disk is busy until then.
    assert!(mount("umount", &["--lazy"]), "the small disk is taken away again");
    first.expect("the first file fits");
    let refused = second.expect_err("the second does not fit");
    assert!(refused.to_string().contains("free some space"), "{refused}");
    assert_eq!(store::difference(&kept, &back.expect("the older file is whole")), None);
    assert_eq!(left, ["result.nc"]);
}

#[test]
fn what_is_not_a_result_is_refused_with_a_message() {
    let (folder, path) = place();
    let missing = store::read(&path).expect_err("there is no file");
    assert!(missing.to_string().contains("result.nc"), "{missing}");
    store::read(folder.path()).expect_err("a folder is no file");
    for bytes in [&b""[..], b"k2 = 3", b"\x89HDF\r\n\x1a\n", b"\x89HDF\r\n\x1a\nand then noise"] {
        fs::write(&path, bytes).expect("a file is made");
        store::read(&path).expect_err("it is no result");
    }
}

/// A file that HDF5 locks while it is open: the lock of one that was closed stays until the child of another test, which is starting,
/// has given up what it inherited.
fn opened(open: impl Fn() -> hdf5::Result<hdf5::File>) -> hdf5::File {
    for _ in 0..100 {
        match open() {
            Err(error) if error.to_string().contains("unable to lock file") => {
                std::thread::sleep(Duration::from_millis(50));
            }
            done => return done.expect("HDF5 opens it"),
        }
    }
    panic!("the file stays locked")
}

#[test]
fn a_file_that_hdf5_opens_to_change_and_closes_stays_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("r.h5");
    store::write(&rich(), &path).expect("it is written");
    let whole = fs::read(&path).expect("a file");
    for _ in 0..3 {
        let file = opened(|| hdf5::File::open_rw(&path));
        assert!(!file.member_names().expect("names").is_empty());
        file.close().expect("it closes");
        assert!(fs::read(&path).expect("a file") == whole);
    }
    assert!(store::difference(&rich(), &store::read(&path).expect("it is whole")).is_none());
    // What is added or changed is seen.
    let file = opened(|| hdf5::File::append(&path));
    file.new_attr::<i32>().create("mine").expect("an attribute").write_scalar(&1).expect("it");
    file.close().expect("it closes");
    assert!(store::read(&path).is_err());
}

#[test]
fn a_damaged_file_is_refused() {
    let (_folder, path) = place();
    store::write(&rich(), &path).expect("it is written");
    let whole = fs::read(&path).expect("its bytes");
    for part in 1..40 {
        fs::write(&path, &whole[..whole.len() * part / 40]).expect("it is cut short");
        store::read(&path).expect_err("it is cut short");
    }
    let mut damaged = whole.clone();
    for place in (0..whole.len() - 14).step_by(97) {
        damaged[place] ^= 0x10;
        fs::write(&path, &damaged).expect("a byte is changed");
        store::read(&path).expect_err("a byte was changed");
        damaged[place] ^= 0x10;
    }
}
