//! A refined study of starts: the labels of the full one, the same bytes on any machine and after any interruption, and what is
//! inferred is said.

use capsulemap::store::{self, Dataset, Values};

use super::program::WorkDir;

/// Starts along the two axes: as many as SIDE says along both, else so many that there are four tiles.
fn points() -> [usize; 2] {
    std::env::var("SIDE").map_or([160, 130], |it| [it.parse().expect("a number"); 2])
}

/// The capsule of `studies/basin.toml`: two motions, one of which moves on.
fn study(basin: &str) -> String {
    let [r, y1] = points();
    format!(
        "[parameters]\nm2 = \"0.2 kg\"\nc = \"1.77 N s/m\"\nmu_s = 0.33\nmu_d = 0.165\np_d = \"2.79 N\"\n\
         k2 = \"65.518 kN/m\"\ndelta = \"4.33 mm\"\nomega = \"155 rad/s\"\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-6 mm\"\nto = \"6 mm\"\npoints = {r}\n\
         [[axes]]\nname = \"start_y1\"\nfrom = \"-1.5 m/s\"\nto = \"1.5 m/s\"\npoints = {y1}\n\
         [protocol]\npoints = 1\nimpact_points = 0\n\
         [[figures]]\nname = \"basin\"\nkind = \"basin\"\n\
         [[figures]]\nname = \"settling\"\nkind = \"settling\"\n\
         [basin]\n{basin}"
    )
}

/// All numbers of a file by the names of their variables, bit for bit.
fn numbers(dataset: &Dataset) -> Vec<(String, Vec<u64>)> {
    let bits = |values: &Values| match values {
        Values::Real(all) => all.iter().map(|it| it.to_bits()).collect(),
        Values::Integer(all) => all.iter().map(|it| *it as u64).collect(),
    };
    // Which machine wrote a block may differ.
    let named = dataset.variables.iter().filter(|(name, _)| !name.starts_with("block"));
    named.map(|(name, it)| (name.clone(), bits(&it.values))).collect()
}

fn swept(folder: &WorkDir, name: &str, arguments: &[&str]) -> Dataset {
    let file = format!("{name}.toml");
    folder.run(&[&["sweep", &file, "--formats", "svg"], arguments].concat()).done();
    read(folder, name)
}

fn read(folder: &WorkDir, name: &str) -> Dataset {
    store::read(&folder.path(&format!("results/{name}/{name}.h5"))).expect("a file of results")
}

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect("it is there").values.to_real().into_iter().collect()
}

#[test]
fn a_refined_basin_is_the_full_one_for_less() {
    let folder = WorkDir::new();
    folder.put("full.toml", study(""));
    folder.put("refined.toml", study("refine = true\n"));
    folder.put("late.toml", study("refine = true\nearly_decision = false\n"));
    let full = swept(&folder, "full", &[]);
    let ran = folder.run(&["sweep", "refined.toml", "--formats", "svg"]).done();
    let refined = read(&folder, "refined");
    let outcomes = refined.variable("outcome").expect("outcomes");
    assert_eq!(outcomes.flags[0], (-2, "inferred".to_owned()));
    let codes = column(&refined, "outcome");
    let computed: Vec<bool> = codes.iter().map(|code| *code >= 0.0).collect();
    let share = computed.iter().filter(|it| **it).count() as f64 / computed.len() as f64;
    println!("{:.2} % computed", 100.0 * share);
    // The finer the grid, the smaller the part of it beside the boundary.
    let most = if points()[1] >= 1000 { 0.03 } else { 0.5 };
    assert!(share > 0.0 && share < most, "{share}");
    assert!(ran.out.contains(" computed ("), "{}", ran.out);
    // The terminal counts what the file has.
    let count = |spaced: &str| spaced.replace(' ', "").parse::<usize>().ok();
    let periodic = ran.out.lines().find_map(|line| count(line.trim().strip_prefix("periodic")?));
    assert_eq!(periodic, Some(codes.iter().filter(|code| **code == 0.0).count()), "{}", ran.out);
    let cycles: f64 = column(&refined, "cycles").iter().sum();
    assert!(ran.out.replace(' ', "").contains(&format!(",{cycles}cycles")), "{}", ran.out);
    // Labels and measures are those of the full grid, and so is every number that is there.
    let of_refined = numbers(&refined).into_iter();
    for (name, bits) in of_refined.filter(|(name, _)| !name.starts_with("inferred_")) {
        let (_, of_full) =
            numbers(&full).into_iter().find(|(other, _)| *other == name).expect("it");
        if bits.len() == of_full.len() && bits.len() == computed.len() && name != "attractor" {
            let both = bits.iter().zip(&of_full).zip(&computed);
            assert!(both.filter(|(_, there)| **there).all(|((a, b), _)| a == b), "{name}");
        } else if bits.len() < computed.len() || name == "attractor" {
            assert_eq!(bits, of_full, "{name}");
        }
    }
    // A sample of what is inferred has been computed as a check.
    assert_eq!(column(&refined, "inferred_sample"), [1000.0]);
    assert_eq!(column(&refined, "inferred_elsewhere"), [0.0]);
    let speeds = column(&refined, "progression_speed");
    assert!(speeds.iter().zip(&computed).all(|(speed, there)| speed.is_nan() != *there));
    let late = swept(&folder, "late", &[]);
    assert_eq!(column(&late, "attractor"), column(&full, "attractor"));
    assert_eq!(column(&late, "outcome"), codes);
    let picture =
        std::fs::read_to_string(folder.path("results/refined/basin.svg")).expect("a picture");
    assert!(picture.contains("the others inferred") && picture.contains("saddles on the boundary"));
    let picture = std::fs::read_to_string(folder.path("results/refined/settling.svg"));
    assert!(picture.expect("a picture").contains("inferred, not followed"));
    // Inferred starts are not drawn.
    let said = folder.run(&["verify", "results/refined/refined.h5", "--cases", "300"]).done().out;
    assert!(said.contains("300 cases"), "{said}");
    let shown = folder.run(&["inspect", "results/refined/refined.h5"]).done().out;
    assert!(
        shown.contains("saddles on the boundaries") && shown.contains(" 1  period "),
        "{shown}"
    );
    let listed = folder.run(&["inspect", "results/refined/refined.h5", "--json"]).json();
    let shares = column(&refined, "attractor_share");
    assert_eq!(listed["attractors"].as_array().map(Vec::len), Some(shares.len()));
    let second = listed["attractors"][1]["share"].as_f64().expect("a share");
    assert!((second - shares[1]).abs() < 1e-12, "{second}");
}

#[test]
fn a_refined_basin_has_the_same_numbers_on_any_machine_and_in_parts() {
    let folder = WorkDir::new();
    for name in ["one", "two", "parts"] {
        folder.put(&format!("{name}.toml"), study("refine = true\n"));
    }
    let one = swept(&folder, "one", &["--threads", "1", "--instructions", "scalar"]);
    let two = swept(&folder, "two", &["--threads", "2"]);
    assert!(numbers(&one) == numbers(&two));
    // Each tile by another task, as after an interruption.
    for task in ["4/4", "1/4", "3/4", "2/4"] {
        folder.run(&["sweep", "parts.toml", "--task", task, "--threads", "1"]).done();
    }
    folder.run(&["join", "parts.toml"]).done();
    assert!(numbers(&one) == numbers(&read(&folder, "parts")));
}

#[test]
fn only_a_grid_of_starts_is_refined() {
    let folder = WorkDir::new();
    let other = study("refine = true\n")
        .replace("start_r", "m1")
        .replace("mm\"", "kg\"")
        .replace("-6 kg", "1 kg");
    folder.put("other.toml", other.replace("4.33 kg", "4.33 mm"));
    let ran = folder.run(&["sweep", "other.toml"]);
    ran.refused(&[
        "basin.refine",
        "is for grids (not [draws]) whose cases differ in their starts alone",
    ]);
}
