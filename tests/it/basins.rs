//! Basins: the table of the attractors that starts lead to, its numbers and its shares.

use std::fs;

use capsulemap::attractor::Estimate;
use capsulemap::capsule::Output;
use capsulemap::lane::Instructions;
use capsulemap::orbit::{Outcome, Proof};
use capsulemap::run::{self, AttractorRow, AttractorTable, Attractors, Machine, Record};
use capsulemap::store;
use capsulemap::study::Study;

use super::explorer::Explorer;
use super::program::{TWO_MOTIONS, WorkDir};

/// A study over starts of the capsule with two motions, by the values of two axes.
fn starts(r: &[f64], y1: &[f64]) -> Study {
    let axis = |name: &str, values: &[f64], unit: &str| {
        let values: Vec<String> = values.iter().map(|it| format!("\"{it} {unit}\"")).collect();
        format!("[[axes]]\nname = \"{name}\"\nvalues = [{}]\n", values.join(", "))
    };
    let axes = axis("start_r", r, "mm") + &axis("start_y1", y1, "m/s");
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}");
    Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"))
}

struct Found {
    records: Vec<Record>,
    attractors: Attractors,
    rows: Vec<AttractorRow>,
    table: AttractorTable,
}

fn found(study: &Study) -> Found {
    let machine = Machine::default();
    let chains: Vec<usize> = (0..study.chains()).collect();
    let records = run::run_sample(study, machine, &chains, || ()).expect("the study runs");
    let motions = run::final_motions(study, &records);
    let attractors = run::attractors(study, &motions, machine, || ()).expect("threads");
    let table =
        run::attractor_table(study, &attractors, &motions, machine, |_| ()).expect("threads");
    Found { records, attractors, rows: table.rows.clone(), table }
}

const R: [f64; 5] = [-6.0, -3.0, 0.0, 3.0, 6.0];
const Y1: [f64; 7] = [-1.5, -1.0, -0.4, 0.0, 0.3, 0.8, 1.5];

#[test]
fn every_case_does_what_the_table_says_of_its_attractor() {
    let Found { records, attractors, rows, .. } = found(&starts(&R, &Y1));
    assert_eq!(rows.len(), 2);
    for (number, row) in rows.iter().enumerate() {
        let here: Vec<&Record> = records
            .iter()
            .filter(|record| attractors.of_case[record.index] == Some(number as u32))
            .collect();
        assert_eq!((row.share.starts, row.attractor.case), (here.len(), here[0].index));
        assert!((row.share.value - here.len() as f64 / records.len() as f64).abs() < 1e-15);
        let orbit = &row.record.orbit;
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        let speed = |record: &Record| record.orbit.outputs[Output::ProgressionSpeed];
        assert!(here.iter().all(|it| (speed(it) - speed(&row.record)).abs() < 1e-10));
        // The section points of all its cases, each measured from where it settled.
        for record in here {
            for (a, b) in record.orbit.section[0].iter().zip(row.attractor.points[0].iter()) {
                assert!((a - b).abs() < 1e-10, "{record:?}");
            }
        }
    }
    // The one that shakes in place has the lesser r; see `studies/hysteresis.toml`.
    let speeds: Vec<f64> =
        rows.iter().map(|row| row.record.orbit.outputs[Output::ProgressionSpeed]).collect();
    assert!(speeds[0].abs() < 1e-10 && (speeds[1] - 0.067).abs() < 1e-3, "{speeds:?}");
}

#[test]
fn numbers_do_not_depend_on_the_order_of_the_starts() {
    let ordered = found(&starts(&R, &Y1)).attractors.of_case;
    let reversed = |values: &[f64]| values.iter().rev().copied().collect::<Vec<_>>();
    let backward = found(&starts(&reversed(&R), &reversed(&Y1))).attractors.of_case;
    assert!(backward.iter().rev().eq(&ordered));
    // The first starts of the two lead to different motions, so that the order of appearance is another.
    assert_ne!(ordered.first(), backward.first());
}

#[test]
fn the_file_has_the_table_along_its_own_dimension() {
    let folder = WorkDir::new();
    let axes = "[[axes]]\nname = \"start_r\"\nfrom = \"-6 mm\"\nto = \"6 mm\"\npoints = 6\n\
                [[axes]]\nname = \"start_y1\"\nfrom = \"-1.5 m/s\"\nto = \"1.5 m/s\"\npoints = 5\n\
                [[figures]]\nname = \"basin\"\nkind = \"basin\"\n";
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}");
    folder.put("study.toml", &text);
    folder.run(&["sweep", "study.toml"]).done();
    let file = folder.path("results/study/study.h5");
    let dataset = store::read(&file).expect("a file of results");
    let real = |name: &str| -> Vec<f64> {
        let variable = dataset.variable(name).unwrap_or_else(|| panic!("no {name}"));
        variable.values.to_real().into_iter().collect()
    };
    let labels = real("attractor");
    let count = |number: f64| labels.iter().filter(|it| **it == number).count() as f64;
    assert_eq!(real("attractor_period"), [1.0, 1.0]);
    assert_eq!(real("attractor_cases"), [count(0.0), count(1.0)]);
    assert_eq!(real("attractor_share"), [count(0.0) / 30.0, count(1.0) / 30.0]);
    for name in ["attractor_section_r", "attractor_section_y1", "attractor_section_y2"] {
        let variable = dataset.variable(name).expect("section points");
        assert_eq!(variable.dimensions, ["attractor_index", "attractor_cycle"]);
        assert!(real(name).iter().all(|it| it.is_finite()));
    }
    for name in ["attractor_progression_speed", "attractor_work_positive", "attractor_share_error"]
    {
        let variable = dataset.variable(name).expect("a column");
        assert_eq!(variable.dimensions, ["attractor_index"]);
    }
    for format in ["png", "svg", "pdf"] {
        assert!(folder.path(&format!("results/study/basin.{format}")).exists(), "{format}");
    }
    let svg = fs::read_to_string(folder.path("results/study/basin.svg")).expect("a figure");
    // What the legend says stands in the description, too; a disc for the point of each orbit, a dashed impact surface.
    let told = [
        "attractor over start_r, start_y1: attractor 0: period 1, 0 mm/s, ",
        "; attractor 1: period 1, 67.0 mm/s, ",
    ];
    for words in told.into_iter().chain(["#0072b2", "#d55e00", "stroke-dasharray"]) {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn a_figure_that_a_study_cannot_have_is_a_fault_of_the_study() {
    let work = WorkDir::new();
    let axes = "[[axes]]\nname = \"omega\"\nvalues = [\"153 rad/s\", \"158 rad/s\"]\n\
                [[axes]]\nname = \"start_y1\"\nvalues = [\"0 m/s\", \"1 m/s\"]\n";
    let figure = "[[figures]]\nname = \"basin\"\nkind = \"basin\"\n";
    work.put("one.toml", format!("{TWO_MOTIONS}{axes}{figure}"));
    let told = "figure `basin`: basins lie over two of start_r, start_y1, start_y2, and `omega` is none of these";
    for command in ["check", "sweep"] {
        work.run(&[command, "one.toml"]).refused(&[told]);
    }
    assert!(!work.path("results").exists(), "nothing is computed");
}

#[test]
fn basins_are_drawn_over_starts_alone() {
    let folder = WorkDir::new();
    let axes = "[[axes]]\nname = \"start_r\"\nvalues = [\"0 mm\", \"1 mm\"]\n\
                [[axes]]\nname = \"omega\"\nvalues = [\"150 rad/s\", \"155 rad/s\"]\n\
                [[figures]]\nname = \"basin\"\nkind = \"basin\"\n";
    folder.put("study.toml", format!("{TWO_MOTIONS}{axes}"));
    let ran = folder.run(&["sweep", "study.toml"]);
    ran.refused(&[
        "figure `basin`",
        "basins lie over two of start_r, start_y1, start_y2",
        "`omega`",
    ]);
}

/// With `STARTS=1000000` so many starts, else some thousands.
#[test]
fn early_decisions_are_those_of_following_to_the_end() {
    let wanted = std::env::var("STARTS").map_or(3600, |it| it.parse().expect("a number"));
    let side = (f64::from(wanted)).sqrt() as usize;
    let text = |early: bool| {
        format!(
            "{TWO_MOTIONS}omega = \"155 rad/s\"\n\
             [[axes]]\nname = \"start_r\"\nfrom = \"-6 mm\"\nto = \"6 mm\"\npoints = {side}\n\
             [[axes]]\nname = \"start_y1\"\nfrom = \"-1.5 m/s\"\nto = \"1.5 m/s\"\npoints = {side}\n\
             [protocol]\npoints = 1\nimpact_points = 0\n[basin]\nearly_decision = {early}\n"
        )
    };
    let [early, late] = [true, false].map(|early| {
        let study = Study::parse("study.toml", &text(early)).expect("a study");
        found(&study)
    });
    assert_eq!(early.attractors.of_case, late.attractors.of_case);
    assert!(early.attractors.of_case.iter().all(Option::is_some));
    let by_neighbourhood = |found: &Found| {
        let proof = |record: &&Record| record.orbit.certificate.proof == Proof::Neighbourhood;
        found.records.iter().filter(proof).count()
    };
    let (decided, all) = (by_neighbourhood(&early), side * side);
    let cycles = |found: &Found| found.records.iter().map(|it| it.orbit.cycles).sum::<u64>();
    println!("{decided} of {all} decided early; {} cycles, not {}", cycles(&early), cycles(&late));
    assert!(decided > all / 2 && by_neighbourhood(&late) == 0);
    // What is measured is that of the attractor, to its rounding.
    for (a, b) in early.records.iter().zip(&late.records) {
        let [a, b] = [a, b].map(|it| it.orbit.outputs[Output::ProgressionSpeed]);
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    // The boundary of the two basins is smooth.
    let exponent = early.table.uncertainty.as_ref().map(|it| it.exponent);
    println!("uncertainty exponent {exponent:?}, entropy {:?}", early.table.entropy);
    if let Some(Estimate { value, error }) = exponent {
        assert!((value - 1.0).abs() < 3.0 * error + 0.05, "{value} +- {error}");
    }
    assert_eq!(
        (&early.table.entropy, &early.table.uncertainty),
        (&late.table.entropy, &late.table.uncertainty)
    );
    // The table is that of cases that are followed to the end, in both.
    for (a, b) in early.rows.iter().zip(&late.rows) {
        assert_eq!((&a.record, a.share), (&b.record, b.share));
    }
}

#[test]
fn shares_along_a_parameter_end_where_the_motion_does() {
    let folder = WorkDir::new();
    // Only moving on exists below 151 rad/s, and only shaking in place above 164; see `studies/hysteresis.toml`.
    let axes = "[[axes]]\nname = \"start_y1\"\nfrom = \"-1.5 m/s\"\nto = \"1.5 m/s\"\npoints = 9\n\
                [[axes]]\nname = \"omega\"\nvalues = [\"149 rad/s\", \"157 rad/s\", \"166 rad/s\"]\n\
                [[axes]]\nname = \"start_r\"\nfrom = \"-6 mm\"\nto = \"6 mm\"\npoints = 5\n\
                [[figures]]\nname = \"shares\"\nkind = \"shares\"\n";
    folder.put("study.toml", format!("{TWO_MOTIONS}{axes}"));
    folder.run(&["sweep", "study.toml", "--formats", "svg"]).done();
    let dataset = store::read(&folder.path("results/study/study.h5")).expect("a file of results");
    let variable = dataset.variable("attractor_share").expect("shares");
    assert_eq!(variable.dimensions, ["omega", "attractor_index"]);
    let shares: Vec<f64> = variable.values.to_real().into_iter().collect();
    assert_eq!(shares.len(), 6);
    // The one keeps its number to where it has folded, and the other appears in between.
    assert_eq!((shares[0], shares[1]), (1.0, 0.0));
    assert!(shares[2] > 0.1 && shares[3] > 0.1 && (shares[2] + shares[3] - 1.0).abs() < 1e-12);
    assert_eq!((shares[4], shares[5]), (0.0, 1.0));
    // Counted anew from the labels and the speeds of the cases: those of the one move.
    let of = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect("there").values.to_real().into_iter().collect()
    };
    for (label, speed) in of("attractor").iter().zip(of("progression_speed")) {
        assert_eq!(*label == 0.0, speed > 0.01, "attractor {label}: {speed} m/s");
    }
    let here = of("attractor").chunks(15).flat_map(|row| row[5..10].to_vec()).collect::<Vec<_>>();
    let moving = here.iter().filter(|label| **label == 0.0).count();
    assert!((shares[2] - moving as f64 / here.len() as f64).abs() < 1e-12);
    let periods = dataset.variable("attractor_period").expect("periods").values.to_real();
    assert_eq!(periods.into_iter().collect::<Vec<_>>(), [1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    assert!(folder.path("results/study/shares.svg").exists());
    // A share for each value is no list of attractors.
    let listed = folder.run(&["inspect", "results/study/study.h5", "--json"]).json();
    assert_eq!(listed["attractors"].as_array().map_or(0, Vec::len), 0, "{listed}");
    let others = "[[axes]]\nname = \"omega\"\nvalues = [\"149 rad/s\", \"157 rad/s\"]\n\
                  [[axes]]\nname = \"m1\"\nvalues = [\"1 kg\", \"1.1 kg\"]\n\
                  [[figures]]\nname = \"shares\"\nkind = \"shares\"\n";
    folder.put("other.toml", format!("{TWO_MOTIONS}{others}"));
    let ran = folder.run(&["sweep", "other.toml"]);
    ran.refused(&["shares lie along the one parameter of a study whose other axes are starts"]);
}

#[test]
fn early_decisions_have_the_same_bits_on_any_machine() {
    let axis = |name: &str, most: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = 32\n")
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}");
    let study = Study::parse("study.toml", &text).expect("a study");
    let on = |threads, instructions, chains: &[usize]| {
        let machine = Machine { threads: Some(threads), instructions: Some(instructions) };
        run::run_sample(&study, machine, chains, || ()).expect("the study runs")
    };
    let all: Vec<usize> = (0..study.chains()).collect();
    // Text, because a number that is not known does not equal itself.
    let told = |records: &[Record]| records.iter().map(|it| format!("{it:?}")).collect::<Vec<_>>();
    let expected = told(&on(1, Instructions::Scalar, &all));
    assert!(expected.iter().filter(|it| it.contains("Neighbourhood")).count() > 512);
    for instructions in Instructions::available() {
        for threads in [1, 2, 3] {
            assert!(told(&on(threads, instructions, &all)) == expected, "{instructions:?}");
        }
    }
    // Some of the cases by themselves, as a run that goes on after a kill computes them.
    let some: Vec<usize> = (0..all.len()).step_by(37).collect();
    let alone = told(&on(2, Instructions::widest(), &some));
    assert!(some.iter().zip(alone).all(|(case, record)| record == expected[*case]));
}

/// The shares at a value of a parameter are counted among the starts there, in the figure and on the page.
#[test]
fn a_figure_of_basins_tells_the_shares_at_the_value_that_is_held() {
    let work = WorkDir::new();
    let axis = |name: &str, most: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = 24\n")
    };
    let omega = "[[axes]]\nname = \"omega\"\nvalues = [\"153 rad/s\", \"158 rad/s\"]\n";
    let starts = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    work.put("two.toml", format!("{TWO_MOTIONS}{omega}{starts}"));
    work.run(&["sweep", "two.toml", "--output", "two.h5", "--no-figures"]).done();
    let file = store::read(&work.path("two.h5")).expect("results");
    let labels = file.variable("attractor").expect("numbers").values.to_real();
    let explorer = Explorer::new(&work, &["two.h5"]);
    let mut told = Vec::new();
    for (place, omega) in [(0, "153"), (1, "158")] {
        let here = labels.index_axis(ndarray::Axis(0), place);
        let counts = [0.0, 1.0].map(|number| here.iter().filter(|it| **it == number).count());
        let shares = counts.map(|count| count as f64 / here.len() as f64);
        assert!(shares.iter().all(|it| *it > 0.1), "{shares:?}");
        let figure = format!(
            "\"$0\" figure two.h5 --kind basin --at 'omega={omega} rad/s' --name b{omega} --folder . --formats svg"
        );
        work.shell(&figure).done();
        let svg = fs::read_to_string(work.path(&format!("b{omega}.svg"))).expect("a figure");
        let basins = format!("/api/stored-basin?x=start_r&y=start_y1&omega={omega}");
        let page = explorer.object(&basins);
        for (number, share) in shares.into_iter().enumerate() {
            let words = format!("attractor {number}: period 1, ");
            let (_, rest) = svg.split_once(&words).expect("it is in the legend");
            let written: f64 = rest
                .split_once(" ±")
                .expect("a share")
                .0
                .rsplit(' ')
                .next()
                .unwrap_or("")
                .parse()
                .expect("a number");
            assert!((written - 100.0 * share).abs() < 0.06, "{omega}: {written} % for {share}");
            let on_page = page["attractors"][number]["share"][0].as_f64().expect("a share");
            assert!((on_page - share).abs() < 1e-12, "{omega}: {on_page} for {share}");
        }
        told.push(shares);
    }
    assert!((told[0][0] - told[1][0]).abs() > 0.05, "the shares differ: {told:?}");
    // Where it is not held, the first value is shown, over the starts.
    work.shell("\"$0\" figure two.h5 --kind basin --name first --folder . --formats svg").done();
    let [first, held] = ["first", "b153"].map(|name| {
        let svg = fs::read_to_string(work.path(&format!("{name}.svg"))).expect("a figure");
        svg.split_once("attractor 0: ").expect("a legend").1.split(';').next().map(str::to_owned)
    });
    assert_eq!(first, held);
}
