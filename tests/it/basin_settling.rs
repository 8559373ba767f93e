//! How fast the starts of basins settle, counted anew from the cases of the file, and shares under a distribution of starts.

use capsulemap::attractor::{Label, shares_of_grid, weighted_shares_of_grid};
use capsulemap::store::{self, Dataset};
use capsulemap::study::Normal;
use serde_json::Value;
use statrs::distribution::{ContinuousCDF, Normal as Expected};

use super::program::{TWO_MOTIONS, WorkDir};

/// A folder with the basins of two motions on a grid of 24 by 20 starts.
fn basins() -> WorkDir {
    let axes = "[[axes]]\nname = \"start_r\"\nfrom = \"-6 mm\"\nto = \"6 mm\"\npoints = 24\n\
                [[axes]]\nname = \"start_y1\"\nfrom = \"1.5 m/s\"\nto = \"-1.5 m/s\"\npoints = 20\n";
    let folder = WorkDir::new();
    folder.put("two.toml", format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}"));
    folder.run(&["sweep", "two.toml", "--no-figures"]).done();
    folder
}

const FILE: &str = "results/two/two.h5";

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    let variable = dataset.variable(name).unwrap_or_else(|| panic!("no {name}"));
    variable.values.to_real().into_iter().collect()
}

fn number(told: &Value) -> f64 {
    told.as_f64().unwrap_or_else(|| panic!("no number: {told}"))
}

#[test]
fn quantiles_and_curves_are_those_of_a_direct_count() {
    let folder = basins();
    let dataset = store::read(&folder.path(FILE)).expect("a file of results");
    let (labels, cycles) = (column(&dataset, "attractor"), column(&dataset, "cycles"));
    let [median, ninety, ninety_nine, most] = ["median", "90", "99", "most"]
        .map(|it| column(&dataset, &format!("attractor_cycles_{it}")));
    for number in 0..2 {
        let cases = labels.iter().zip(&cycles).filter(|(label, _)| **label == number as f64);
        let mut own: Vec<f64> = cases.map(|(_, cycles)| *cycles).collect();
        own.sort_by(f64::total_cmp);
        // The start at this place of so many settles last among this part of them.
        let at = |share: f64| own[(share * own.len() as f64).ceil() as usize - 1];
        assert_eq!(median[number], at(0.5));
        assert_eq!(ninety[number], at(0.9));
        assert_eq!(ninety_nine[number], at(0.99));
        assert_eq!(most[number], own[own.len() - 1]);
        assert!(own[0] < most[number] && median[number] > 0.0, "{own:?}");
    }
    let within = |number: f64, most: f64| {
        let settled = labels.iter().zip(&cycles).filter(|it| *it.0 == number && *it.1 <= most);
        settled.count() as f64 / labels.len() as f64
    };
    let (steps, shares) = (column(&dataset, "settled_cycles"), column(&dataset, "settled_share"));
    for (at, cycles) in steps.iter().enumerate() {
        assert_eq!(shares[2 * at..2 * at + 2], [within(0.0, *cycles), within(1.0, *cycles)]);
    }
    let never = labels.iter().filter(|it| **it < 0.0).count() as f64;
    assert_eq!(column(&dataset, "settled_never"), [never]);
    // At last all have settled that do.
    let last: f64 = shares[shares.len() - 2..].iter().sum();
    assert!((last - (1.0 - never / labels.len() as f64)).abs() < 1e-12, "{last}");

    let asked = folder.run(&["inspect", FILE, "--settled-within", "7,40", "--json"]).json();
    for (told, cycles) in asked["settling"]["settled"].as_array().expect("two").iter().zip([7, 40])
    {
        assert_eq!(told["within"], cycles);
        let shares = [0, 1].map(|it| number(&told["shares"][it]));
        assert_eq!(shares, [within(0.0, f64::from(cycles)), within(1.0, f64::from(cycles))]);
    }
    let quantiles = &asked["settling"]["attractors"][1]["quantiles"];
    assert_eq!([0, 1, 2].map(|it| number(&quantiles[it])), [median[1], ninety[1], ninety_nine[1]]);
    let text = folder.run(&["inspect", FILE, "--settled-within", "7"]).done().out;
    let line = format!("  {:>8} {:>9.6} {:>9.6}", 7, within(0.0, 7.0), within(1.0, 7.0));
    assert!(text.contains(&line), "{text}");
}

#[test]
fn shares_under_a_distribution_are_sums_over_its_cells() {
    let folder = basins();
    let dataset = store::read(&folder.path(FILE)).expect("a file of results");
    let labels = column(&dataset, "attractor");
    let axis = |name: &str| -> Vec<f64> {
        dataset.coordinate(name).expect(name).values.to_real().into_iter().collect()
    };
    // Each start stands for what is nearer to it than to its neighbours.
    let cells = |values: &[f64], mean: f64, deviation: f64| -> Vec<f64> {
        let normal = Expected::new(mean, deviation).expect("a distribution");
        let half = (values[1] - values[0]).abs() / 2.0;
        values.iter().map(|it| normal.cdf(it + half) - normal.cdf(it - half)).collect()
    };
    let r = cells(&axis("start_r"), 1e-3, 2e-3);
    let y1 = cells(&axis("start_y1"), 0.2, 0.5);
    let weights: Vec<f64> = r.iter().flat_map(|r| y1.iter().map(move |y1| r * y1)).collect();
    let all: f64 = weights.iter().sum();
    let asked = ["--density", "start_r=1 mm,2 mm", "--density", "start_y1=0.2,0.5"];
    let told = folder.run(&[&["inspect", FILE, "--json"][..], &asked].concat()).json();
    assert!((number(&told["weighted"]["inside"]) - all).abs() < 1e-10, "{told}");
    for attractor in 0..2 {
        let own = labels.iter().zip(&weights).filter(|(label, _)| **label == attractor as f64);
        let expected = own.map(|(_, weight)| weight).sum::<f64>() / all;
        let told = &told["weighted"]["shares"][attractor];
        // The error function of statrs has eleven digits.
        assert!((number(&told["share"]) - expected).abs() < 1e-10, "{told} {expected}");
        // The even share is another one.
        let even = column(&dataset, "attractor_share")[attractor];
        assert!((expected - even).abs() > 0.02, "{expected} {even}");
    }
    let text = folder.run(&[&["inspect", FILE][..], &asked].concat()).done().out;
    assert!(text.contains("\nshares of starts that are drawn from the distribution\n"), "{text}");
}

#[test]
fn a_density_that_is_none_is_refused_with_all_faults() {
    let folder = basins();
    let asked = ["start_q=0,1", "start_r=0", "start_y1=0,\"-1 m/s\"", "start_y1=0,1 kg"];
    let words: Vec<&str> = asked.iter().flat_map(|it| ["--density", *it]).collect();
    folder.run(&[&["inspect", FILE][..], &words].concat()).refused(&[
        "start_q",
        "start_r, start_y1, start_y2",
        "expected NAME=MEAN,DEVIATION",
        "--density start_y1=0,1 kg",
    ]);
    folder.run(&["inspect", FILE, "--density", "start_y1=0,-1"]).refused(&["above zero"]);
    folder
        .run(&["inspect", FILE, "--density", "start_y2=0,1"])
        .refused(&["start_y2 is no axis of the basins (allowed: start_r, start_y1)"]);
    let draws =
        "[draws]\ncount = 4\n[[axes]]\nname = \"start_y1\"\nfrom = \"0 m/s\"\nto = \"1 m/s\"\n";
    folder.put("drawn.toml", format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{draws}"));
    folder.run(&["sweep", "drawn.toml", "--no-figures"]).done();
    let ran = folder.run(&["inspect", "results/drawn/drawn.h5", "--density", "start_y1=0,1"]);
    ran.refused(&["--density: the starts of the file are drawn"]);
    let other = "[[axes]]\nname = \"omega\"\nvalues = [\"150 rad/s\", \"155 rad/s\"]\n";
    folder.put("other.toml", format!("{TWO_MOTIONS}{other}"));
    folder.run(&["sweep", "other.toml", "--no-figures"]).done();
    let ran = folder.run(&["inspect", "results/other/other.h5", "--settled-within", "5"]);
    ran.refused(&["--settled-within: the basins vary along omega"]);
}

#[test]
fn weighted_shares_of_a_half_plane_are_those_of_the_normal_distribution() {
    // Starts above a line through the plane lead to the one attractor: under a normal distribution the distance from the line is
    // normal, too, whatever the direction of the line.
    let (mut within, mut squares) = (0, 0.0);
    let mut random = fastrand::Rng::with_seed(21);
    const REPETITIONS: usize = 200;
    const SIDE: usize = 61;
    for _ in 0..REPETITIONS {
        let (angle, offset) = (random.f64() * std::f64::consts::TAU, 2.0 * random.f64() - 1.0);
        let values: Vec<f64> = (0..SIDE).map(|at| -6.0 + 12.0 * at as f64 / 60.0).collect();
        let (cells, all) = Normal { mean: 0.0, deviation: 1.0 }.cells(&values);
        assert!((1.0 - all).abs() < 1e-8);
        let label = |start: usize| {
            let (x, y) = (values[start / SIDE], values[start % SIDE]);
            Label::Attractor(u32::from(x * angle.cos() + y * angle.sin() < offset))
        };
        let weight = |start: usize| cells[start / SIDE] * cells[start % SIDE];
        let share = weighted_shares_of_grid(&[SIDE, SIDE], label, 2, weight)[1];
        let truth = Expected::standard().cdf(offset);
        let off = (share.value - truth) / share.error;
        within += usize::from(off.abs() <= 2.0);
        squares += off * off;
        // Without weights it is another number by far, unless the line goes through the middle.
        let even = shares_of_grid(&[SIDE, SIDE], label, 2)[1];
        assert!((even.value - truth).abs() > share.error || offset.abs() < 0.3);
    }
    let spread = (squares / REPETITIONS as f64).sqrt();
    println!("within two standard errors {within} of {REPETITIONS}; spread {spread:.2}");
    assert!(within >= 190 && (0.2..1.2).contains(&spread), "{within} {spread}");
}
