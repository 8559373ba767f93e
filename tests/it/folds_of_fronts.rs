//! Motions of a refined front that are held by a fold: continuation finds the fold where they are.

use serde_json::{Value, json};

use super::program::WorkDir;

/// Where the paper's capsule hardly moves and its fastest motion for a power ends in a fold.
const STUDY: &str = "[parameters]\nk2 = \"100 kN/m\"\ndelta = \"0.22 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"1.2 N\"\nto = \"1.3 N\"\npoints = 5\n\
     [[axes]]\nname = \"omega\"\nfrom = \"31.5 rad/s\"\nto = \"32.5 rad/s\"\npoints = 6\n";
/// The range of the frequency, of which a fold may be a billionth away [rad/s].
const RANGE: f64 = 1.0;
/// The code of a fold in files of results.
const FOLD: i64 = 0;

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// How far the folds are from the frequency of a motion that are found along it from there [rad/s].
fn distances(folder: &WorkDir, point: &Value) -> Vec<f64> {
    let omega = number(&point["parameters"], "omega");
    let start = |key: &str| number(&point["start"], key);
    let study = format!(
        "[parameters]\nk2 = \"100 kN/m\"\ndelta = \"0.22 mm\"\np_d = \"{:?} N\"\n\
         [[axes]]\nname = \"omega\"\nfrom = \"{:?} rad/s\"\nto = \"{:?} rad/s\"\npoints = 3\n\
         [[branches]]\nname = \"along omega\"\nalong = \"omega\"\nat = {{ omega = \"{omega:?} rad/s\" }}\n\
         orbit = \"newton\"\nperiod = {}\n\
         start = {{ r = \"{:?} m\", y1 = \"{:?} m/s\", y2 = \"{:?} m/s\" }}\n",
        number(&point["parameters"], "p_d"),
        omega - 0.01,
        omega + 0.01,
        point["period"],
        start("start_r"),
        start("start_y1"),
        start("start_y2")
    );
    folder.put("branch.toml", study);
    folder.run(&["continue", "branch.toml", "--overwrite"]).done();
    let file = hdf5::File::open(folder.path("results/branch/branch.h5")).expect("a file");
    let column = |name: &str| file.dataset(name).and_then(|it| it.read_raw::<f64>());
    let kinds = file.dataset("special_kind").and_then(|it| it.read_raw::<i64>());
    let (Ok(frequencies), Ok(kinds)) = (column("special_omega"), kinds) else { return Vec::new() };
    let folds = frequencies.into_iter().zip(kinds).filter(|(_, kind)| *kind == FOLD);
    folds.map(|(found, _)| (found - omega).abs()).collect()
}

/// Some lie in the fold to rounding, where continuation says that it cannot begin.
#[test]
fn a_motion_held_by_a_fold_is_where_continuation_finds_that() {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml"]).done();
    // Fewer starts than usual find fold after fold.
    let refine = "tradeoff results/study/study.h5 --refine --starts 16 --direction forward --json";
    let refine: Vec<&str> = refine.split(' ').collect();
    let answer = folder.run(&refine).json();
    let front = answer["front"].as_array().expect("a front");
    let held: Vec<&Value> = front.iter().filter(|it| it["held_by"] == json!(["fold"])).collect();
    let found: Vec<f64> = held.iter().flat_map(|point| distances(&folder, point)).collect();
    assert!(found.len() >= 8, "{} of {}", found.len(), held.len());
    assert!(found.iter().all(|apart| *apart <= 1e-9 * RANGE), "{found:?}");
}
