//! Starts that are drawn from a normal distribution, cut at the ends of a range.

use capsulemap::attractor::{Label, shares_of_draws};
use capsulemap::store;
use capsulemap::study::{CaseSet, DrawKind, Draws, Study};
use statrs::distribution::{ContinuousCDF, Normal};

use super::program::{TWO_MOTIONS, WorkDir};

fn study(draws: &str, axis: &str) -> String {
    format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n[draws]\n{draws}\n[[axes]]\n{axis}\n")
}

fn read(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn drawn(study: &Study) -> &Draws {
    let CaseSet::Draws(draws) = &study.case_set else { panic!("no draws") };
    draws
}

const Y1: &str = "name = \"start_y1\"\nmean = \"0.4 m/s\"\ndeviation = \"500 mm/s\"";

#[test]
fn draws_have_the_distribution_that_is_asked_for() {
    let normal = Normal::new(0.4, 0.5).expect("a distribution");
    for (ends, low, high) in [("", -2.6, 3.4), ("\nfrom = \"0 m/s\"\nto = \"2 m/s\"", 0.0, 2.0)] {
        for kind in [DrawKind::Uniform, DrawKind::LowDiscrepancy] {
            let count = 4000;
            let head = format!("kind = \"{}\"\ncount = {count}\nseed = 5", kind.name());
            let study = read(&study(&head, &format!("{Y1}{ends}")));
            let draws = drawn(&study);
            let range = draws.ranges[0];
            assert!((range.from - low).abs() < 1e-12 && (range.to - high).abs() < 1e-12);
            let mut values: Vec<f64> = (0..count).map(|index| draws.value(index, 0)).collect();
            values.sort_by(f64::total_cmp);
            assert!(values[0] >= low && values[count - 1] <= high);
            let all = normal.cdf(high) - normal.cdf(low);
            let below = |value: f64| (normal.cdf(value) - normal.cdf(low)) / all;
            // The statistic of Kolmogorov and Smirnov: 1.63/sqrt(n) is exceeded once in a hundred times.
            let apart = values.iter().enumerate().map(|(place, value)| {
                let [before, after] = [place, place + 1].map(|it| it as f64 / count as f64);
                (below(*value) - before).abs().max((below(*value) - after).abs())
            });
            let most = apart.fold(0.0, f64::max) * (count as f64).sqrt();
            println!("{kind:?} {low} {high}: {most:.3}");
            let limit = if kind == DrawKind::Uniform { 1.63 } else { 0.1 };
            assert!(most < limit, "{most}");
            let remark = format!(
                "start_y1 is drawn from a normal distribution of mean 0.4 m/s and deviation 0.5 m/s, cut at {}",
                range.from
            );
            assert!(study.remarks.iter().any(|it| it.starts_with(&remark)), "{:?}", study.remarks);
            assert_eq!(read(&study.to_toml()).case_set, study.case_set);
        }
    }
}

#[test]
fn the_interval_of_a_share_has_the_closed_form_in_95_of_100_studies() {
    // Starts below 0.9 m/s lead to the one attractor.
    let truth = Normal::new(0.4, 0.5).expect("a distribution").cdf(0.9);
    const REPETITIONS: u64 = 1000;
    let mut within = 0;
    for seed in 0..REPETITIONS {
        let study = read(&study(&format!("count = 150\nseed = {seed}"), Y1));
        let draws = drawn(&study);
        let label = |index: usize| Label::Attractor(u32::from(draws.value(index, 0) < 0.9));
        let [low, high] = shares_of_draws(150, label, 2)[1].interval.expect("an interval");
        within += u64::from((low..=high).contains(&truth));
    }
    let percent = 100.0 * within as f64 / REPETITIONS as f64;
    println!("Wilson's interval has the share in {percent:.1} of 100 studies");
    assert!((percent - 95.0).abs() <= 3.0, "{percent}");
}

#[test]
fn a_parameter_is_cut_at_its_bounds_and_the_file_says_so() {
    let folder = WorkDir::new();
    // Six deviations below the mean the damping would be negative.
    let axis = "name = \"c\"\nmean = \"1.77 N s/m\"\ndeviation = \"0.5 N s/m\"";
    let text = study("count = 5", axis).replace("c = \"1.77 N s/m\"\n", "");
    folder.put("damped.toml", text);
    folder.run(&["sweep", "damped.toml", "--no-figures"]).done();
    let dataset = store::read(&folder.path("results/damped/damped.h5")).expect("a file");
    let remarks = dataset.attributes.get("study_remarks").expect("remarks");
    assert!(
        remarks.contains("cut at 0 N s/m and 4.77 N s/m, which leaves out 2.0e-4 of it"),
        "{remarks}"
    );
}

#[test]
fn what_is_wrong_in_a_distribution_is_told_at_once() {
    let folder = WorkDir::new();
    let axis = "name = \"start_y1\"\nmean = \"1 kg\"\nspacing = \"linear\"\n\
                [[axes]]\nname = \"start_r\"\nmean = \"0 mm\"\ndeviation = \"0 mm\"\n\
                [[axes]]\nname = \"start_y2\"\nmean = \"0 m/s\"\ndeviation = \"1 m/s\"\nfrom = \"30 m/s\"\nto = \"40 m/s\"";
    folder.put("wrong.toml", study("count = 5", axis));
    folder.run(&["sweep", "wrong.toml"]).refused(&[
        "mean and deviation, of a normal distribution",
        "does not go with `mean` and `deviation`",
        "a finite number above zero",
        "leaves nothing to draw from 30 to 40",
    ]);
    // Draws that are evenly distributed have the fingerprint that they had.
    let even = read(&study("count = 5", "name = \"start_y1\"\nfrom = \"0 m/s\"\nto = \"1 m/s\""));
    let range = format!("{:?}", drawn(&even).ranges[0]);
    assert!(range.ends_with("from: 0.0, to: 1.0, spacing: Linear }"), "{range}");
}
