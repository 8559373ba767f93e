//! A refined map of outputs over parameters: what is inferred is that of the full map within what the study allows, and is said.

use capsulemap::store::{self, Dataset, Values};
use capsulemap::study::{Refine, Study};

use super::program::WorkDir;

/// The capsule of studies/plane.toml over a part of its plane, where it rests, and moves in period 1 and 2.
fn study(map: &str) -> String {
    format!(
        "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\nk2 = \"86.8 kN/m\"\ndelta = \"2.45 mm\"\n\
         [[axes]]\nname = \"p_d\"\nfrom = \"1 N\"\nto = \"2.5 N\"\npoints = 129\n\
         [[axes]]\nname = \"omega\"\nfrom = \"92 rad/s\"\nto = \"125 rad/s\"\npoints = 161\n\
         [protocol]\npoints = 1\nimpact_points = 0\n\
         [[figures]]\nname = \"speed\"\nkind = \"map\"\n\
         [[figures]]\nname = \"loss\"\nkind = \"map\"\nof = [\"friction_loss\"]\n\
         [[figures]]\nname = \"period\"\nkind = \"map\"\nof = [\"period\"]\n{map}"
    )
}

const REFINE: &str =
    "[map]\nrefine = { progression_speed = \"1 mm/s\", work_positive = \"2 mJ\" }\n";

fn read(folder: &WorkDir, name: &str) -> Dataset {
    store::read(&folder.path(&format!("results/{name}/{name}.h5"))).expect("a file of results")
}

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect("it is there").values.to_real().into_iter().collect()
}

#[test]
fn a_refined_map_is_the_full_one_within_what_the_study_allows() {
    let folder = WorkDir::new();
    folder.put("full.toml", study(""));
    folder.put("refined.toml", study(REFINE));
    folder.run(&["sweep", "full.toml", "--formats", "svg"]).done();
    let ran = folder.run(&["sweep", "refined.toml", "--formats", "svg"]).done();
    assert!(ran.out.contains("the others inferred"), "{}", ran.out);
    let (full, refined) = (read(&folder, "full"), read(&folder, "refined"));
    let outcomes = column(&refined, "outcome");
    let computed: Vec<bool> = outcomes.iter().map(|code| *code >= 0.0).collect();
    let share = computed.iter().filter(|it| **it).count() as f64 / computed.len() as f64;
    println!("{:.2} % computed", 100.0 * share);
    assert!(share > 0.02 && share < 0.7, "{share}");
    let [of_full, of_refined] = [&full, &refined].map(|it| {
        ["period", "progression_speed", "work_positive", "friction_loss", "stick_share"]
            .map(|name| column(it, name))
    });
    let (mut other, mut inferred) = (0, 0);
    for case in 0..computed.len() {
        let [[period, speed, work, loss, stick], [period_2, speed_2, work_2, loss_2, stick_2]] =
            [&of_full, &of_refined].map(|it| it.each_ref().map(|column| column[case]));
        if computed[case] {
            let pairs = [(period, period_2), (speed, speed_2), (work, work_2), (loss, loss_2)];
            assert!(pairs.iter().all(|(a, b)| a.to_bits() == b.to_bits()), "{case}");
            continue;
        }
        inferred += 1;
        assert!(loss_2.is_nan() && (stick_2.is_nan() || stick_2 == 1.0));
        let rests = (stick >= 1.0) == (stick_2 == 1.0);
        let near = (speed - speed_2).abs() <= 1e-3 && (work - work_2).abs() <= 2e-3;
        other += usize::from(!(period == period_2 && rests && near));
    }
    // Regions thinner than a coarse cell that touch none of its corners are missed.
    println!("{other} of {inferred} inferred differ");
    assert!(100 * other <= inferred, "{other} of {inferred}");
    let [sample, elsewhere] =
        ["inferred_sample", "inferred_elsewhere"].map(|name| column(&refined, name)[0]);
    assert!(sample == 1000.0 && elsewhere <= 30.0, "{sample} {elsewhere}");
    let picture = |name: &str| {
        let path = folder.path(&format!("results/refined/{name}.svg"));
        std::fs::read_to_string(path).expect("a picture")
    };
    for name in ["speed", "period", "loss"] {
        assert!(folder.path(&format!("results/refined/{name}.svg")).exists());
    }
    assert_ne!(picture("speed"), picture("loss"));
    // What shows all cases would leave most out.
    let ran = folder.run(&["figure", "results/refined/refined.h5", "--kind", "trade-off"]);
    ran.refused(&["most of a refined grid are inferred"]);
    folder.run(&["verify", "results/refined/refined.h5", "--cases", "200"]).done();
}

#[test]
fn what_outputs_leave_out_does_not_change_what_is_inferred_and_checked() {
    // From forces on at which the capsule rests whatever the frequency, so that rest is inferred.
    let from_rest = |map: &str| study(map).replace("from = \"1 N\"", "from = \"0.1 N\"");
    let few =
        format!("outputs = [\"progression_speed\", \"work_positive\"]\n{}", from_rest(REFINE));
    let few =
        few.replace("[[figures]]\nname = \"loss\"\nkind = \"map\"\nof = [\"friction_loss\"]\n", "");
    let folder = WorkDir::new();
    for (name, text) in [("all", from_rest(REFINE)), ("few", few), ("full", from_rest(""))] {
        folder.put(&format!("{name}.toml"), text);
        folder.run(&["sweep", &format!("{name}.toml"), "--no-figures"]).done();
    }
    let [all, few, full] = ["all", "few", "full"].map(|name| read(&folder, name));
    for name in ["outcome", "period", "progression_speed", "work_positive"] {
        let bits = |dataset: &Dataset| -> Vec<u64> {
            column(dataset, name).into_iter().map(f64::to_bits).collect()
        };
        assert!(bits(&all) == bits(&few), "{name}");
    }
    // The full grid says how many inferred cases differ; those of the sample are as many in a thousand.
    let [period, speed, work, stick] =
        ["period", "progression_speed", "work_positive", "stick_share"].map(|name| {
            column(&full, name).into_iter().zip(column(&all, name)).collect::<Vec<(f64, f64)>>()
        });
    let outcomes = column(&all, "outcome");
    let inferred: Vec<usize> = (0..outcomes.len()).filter(|case| outcomes[*case] < 0.0).collect();
    let differs = |case: &&usize| {
        let at = **case;
        let rests = |share: f64| share >= 1.0;
        period[at].0 != period[at].1
            || rests(stick[at].0) != rests(stick[at].1)
            || (speed[at].0 - speed[at].1).abs() > 1e-3
            || (work[at].0 - work[at].1).abs() > 2e-3
    };
    let expected = 1000.0 * inferred.iter().filter(differs).count() as f64 / inferred.len() as f64;
    let rest = inferred.iter().filter(|case| stick[**case].1 == 1.0).count();
    assert!(10 * rest > inferred.len(), "rest is inferred of {rest} of {} only", inferred.len());
    for dataset in [&all, &few] {
        let elsewhere = column(dataset, "inferred_elsewhere")[0];
        let spread = 4.0 * expected.max(1.0).sqrt();
        assert!((elsewhere - expected).abs() <= spread, "{elsewhere}, {expected} expected");
    }
}

#[test]
fn a_refined_map_has_the_same_numbers_on_any_machine_and_in_parts() {
    let folder = WorkDir::new();
    for name in ["one", "parts"] {
        folder.put(&format!("{name}.toml"), study(REFINE));
    }
    let machine = ["--threads", "1", "--instructions", "scalar", "--formats", "svg"];
    folder.run(&[&["sweep", "one.toml"][..], &machine].concat()).done();
    for task in ["2/2", "1/2"] {
        folder.run(&["sweep", "parts.toml", "--task", task, "--threads", "2"]).done();
    }
    folder.run(&["join", "parts.toml"]).done();
    let bits = |dataset: &Dataset| {
        let bits = |values: &Values| -> Vec<u64> {
            match values {
                Values::Real(all) => all.iter().map(|it| it.to_bits()).collect(),
                Values::Integer(all) => all.iter().map(|it| *it as u64).collect(),
            }
        };
        let named = dataset.variables.iter().filter(|(name, _)| !name.starts_with("block"));
        named.map(|(name, it)| (name.clone(), bits(&it.values))).collect::<Vec<_>>()
    };
    assert!(bits(&read(&folder, "one")) == bits(&read(&folder, "parts")));
}

#[test]
fn what_cannot_be_refined_is_refused() {
    let faults = |text: &str| Study::parse("study.toml", text).expect_err("faults").to_string();
    let of_starts = study(REFINE).replace(
        "p_d\"\nfrom = \"1 N\"\nto = \"2.5 N\"",
        "start_r\"\nfrom = \"1 mm\"\nto = \"4 mm\"",
    );
    assert!(faults(&of_starts).contains("map.refine: is for grids of 2 to 5 axes of parameters"));
    let one = |within: &str| faults(&study(&format!("[map]\nrefine = {within}\n")));
    assert!(one("{ speed = \"1 mm/s\" }").contains("unknown output of this study \"speed\""));
    assert!(one("{ progression_speed = \"1 mJ\" }").contains("is an energy; expected a velocity"));
    assert!(one("{ progression_speed = \"0 mm/s\" }").contains("0 m/s must be above 0"));
    assert!(one("{}").contains("expected at least one output"));
    assert!(one("true").contains("expected a table"));
    assert!(faults(&study("[map]\n")).contains("map.refine: missing"));
    let front = "[[figures]]\nname = \"front\"\nkind = \"trade-off\"\n";
    assert!(
        faults(&study(&format!("{front}{REFINE}")))
            .contains("which only maps and curves allow for")
    );
}

#[test]
fn a_refined_study_is_read_back_as_it_was_written() {
    let study = Study::parse("study.toml", &study(REFINE)).expect("a study");
    let again = Study::parse("again.toml", &study.to_toml()).expect("a study");
    assert!(matches!(&again.refine, Some(Refine::Outputs(within)) if within.len() == 2));
    assert_eq!(again.refine, study.refine);
    assert_eq!(again.fingerprint(), study.fingerprint());
}
