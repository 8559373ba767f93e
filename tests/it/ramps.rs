//! Motions along ramps, against integrators of another kind and against the motions at rest on the ramp.

use std::f64::consts::PI;

use capsulemap::run::{Ramped, follow_ramps};
use capsulemap::study::{Ramp, Study};

use super::program::{TWO_MOTIONS, WorkDir};

/// A hardening oscillator whose response jumps where its frequency rises past the fold.
const DUFFING: &str = r#"
[system]
name = "hardening oscillator"
states = { x = "1", v = "1" }
section = { every = "2*pi/w" }
[system.parameters]
c = 0.1
p = 0.3
w = 1.0
[system.rates]
x = "v"
v = "p*cos(w*t) - c*v - x - x^3"
"#;

fn ramp_of(from: f64, to: f64, rate: f64, rest: &str) -> String {
    format!(
        "[[ramps]]\nname = \"a\"\nalong = \"w\"\nfrom = {from:?}\nto = {to:?}\nrate = \"{rate}/s\"\n{rest}\n"
    )
}

/// The ramp of a study of one, and what came of it.
fn followed(text: &str) -> (Ramp, Ramped) {
    let study = Study::parse("ramp.toml", text).expect("a study");
    let mut ramped = follow_ramps(&study, Some(1), || ()).expect("threads");
    (study.ramps[0].clone(), ramped.remove(0))
}

/// A point of a ramp of the oscillator: time, frequency, displacement and velocity.
type Point = [f64; 4];

/// The same ramp by Runge and Kutta's method of fourth order in the phase of the drive, whose rate rises steadily with time: in the
/// phase p of a drive with w^2 = w0^2 + 2 a p, x' = v/w.
fn by_runge_kutta(ramp: &Ramp, from: [f64; 2], cycles: usize) -> Vec<Point> {
    let (start, slope) = (ramp.ends[0], ramp.slope());
    let frequency = |phase: f64| (start * start + 2.0 * slope * phase).sqrt();
    let rates = |phase: f64, [x, v]: [f64; 2]| {
        let force = 0.3 * phase.cos() - 0.1 * v - x - x * x * x;
        [v / frequency(phase), force / frequency(phase)]
    };
    let steps = 2000;
    let h = 2.0 * PI / f64::from(steps);
    let mut state = from;
    let mut points = Vec::new();
    for cycle in 0..=cycles {
        let turned = 2.0 * PI * cycle as f64;
        let now = frequency(turned);
        points.push([(now - start) / slope, now, state[0], state[1]]);
        for step in 0..steps {
            let phase = turned + h * f64::from(step);
            let moved =
                |by: f64, rate: [f64; 2]| [state[0] + by * rate[0], state[1] + by * rate[1]];
            let k1 = rates(phase, state);
            let k2 = rates(phase + 0.5 * h, moved(0.5 * h, k1));
            let k3 = rates(phase + 0.5 * h, moved(0.5 * h, k2));
            let k4 = rates(phase + h, moved(h, k3));
            for i in 0..2 {
                state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
    }
    points
}

/// The points of a ramp that was followed.
fn points(ramped: &Ramped) -> Vec<Point> {
    let point = |it: &capsulemap::run::RampPoint| {
        [it.time, it.value, it.state.values()[0], it.state.values()[1]]
    };
    ramped.points.iter().map(point).collect()
}

/// How far the states of two ramps are apart, at most.
fn apart(some: &[Point], others: &[Point]) -> f64 {
    let differences = some.iter().zip(others).flat_map(|(a, b)| [a[2] - b[2], a[3] - b[3]]);
    differences.fold(0.0, |most, it| most.max(it.abs()))
}

#[test]
fn a_motion_along_a_ramp_is_that_of_a_steady_change() {
    let along =
        |parts: u32| followed(&(ramp_of(1.0, 2.4, 0.004, &format!("parts = {parts}")) + DUFFING));
    let (ramp, fine) = along(64);
    let own = points(&fine);
    let other = by_runge_kutta(&ramp, [own[0][2], own[0][3]], own.len() - 1);
    // The last point is past the end of the ramp, where the frequency stays.
    let cycles = own.len() - 1;
    for (a, b) in own[..cycles].iter().zip(&other) {
        assert!((a[0] - b[0]).abs() < 1e-9 * b[0].max(1.0), "time {} {}", a[0], b[0]);
        assert!((a[1] - b[1]).abs() < 1e-11, "frequency {} {}", a[1], b[1]);
    }
    // The error falls with the square of the number of parts.
    let [coarse, middle] = [16, 32].map(|parts| points(&along(parts).1));
    let errors = [coarse, middle, own].map(|it| apart(&it[..cycles], &other));
    assert!(errors[2] < 5e-6, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    // It jumps once, from the upper branch, where the other integrator says.
    let drop = (1..other.len())
        .max_by(|a, b| {
            let fall = |at: usize| (other[at][2] - other[at - 1][2]).abs();
            fall(*a).total_cmp(&fall(*b))
        })
        .expect("points");
    assert_eq!(fine.jumps.len(), 1, "{:?}", fine.jumps);
    let jump = fine.jumps[0];
    assert!(jump.point.abs_diff(drop) <= 3, "{jump:?} {drop}");
    assert!(jump.size > 0.3, "{jump:?}");
}

#[test]
fn a_slow_ramp_shows_the_motions_at_rest_on_it() {
    // On a branch, the motion lags behind that of the frequency which it has by what the frequency changes in a time that the
    // damping sets: the distance falls with the rate.
    let rest = |w: f64| {
        let (_, ramped) = followed(&(ramp_of(w, w + 1.0, 1.0, "") + DUFFING));
        points(&ramped)[0]
    };
    let lag = |rate: f64| {
        let (_, ramped) = followed(&(ramp_of(1.0, 1.4, rate, "parts = 64") + DUFFING));
        let points = points(&ramped);
        let near = points.iter().find(|it| it[1] >= 1.3).expect("a point");
        apart(&[*near], &[rest(near[1])])
    };
    let lags = [4e-3, 2e-3, 1e-3].map(lag);
    for pair in lags.windows(2) {
        assert!((1.7..2.3).contains(&(pair[0] / pair[1])), "{lags:?}");
    }
    assert!(lags[2] < 0.02, "{lags:?}");
}

/// The hysteresis capsule along a rise of its frequency, by steps of a fixed length in which the friction holds the capsule or
/// drives it: the sections of so many cycles, by r, y1 and y2.
fn by_fixed_steps(start: [f64; 3], [from, slope]: [f64; 2], cycles: usize) -> Vec<[f64; 3]> {
    let (m1, m2, k1, c, k2, delta) = (0.11, 0.2, 1420.0, 1.77, 65_518.0, 4.33e-3);
    let (mu_s, mu_d, v_s, p_d) = (0.33, 0.165, 0.3, 2.79);
    let weight = (m1 + m2) * 9.81;
    let [mut r, mut y1, mut y2] = start;
    let mut points = vec![start];
    let steps = 20_000;
    for cycle in 0..cycles {
        for step in 0..steps {
            let phase = 2.0 * PI * (cycle as f64 + (f64::from(step) + 0.5) / f64::from(steps));
            let h = 2.0 * PI / f64::from(steps) / (from * from + 2.0 * slope * phase).sqrt();
            let force = k1 * r + c * (y1 - y2) + k2 * (r - delta).max(0.0);
            // Velocities first, then the displacement by them, which keeps the energy of the springs.
            y1 += h * (p_d * phase.cos() - force) / m1;
            let limit =
                if y2 == 0.0 { mu_s } else { mu_d * (1.0 + (-y2.abs() / v_s).exp()) } * weight;
            let free = y2 + h * force / m2;
            let most = h * limit / m2;
            y2 = if free.abs() <= most { 0.0 } else { free - most * free.signum() };
            r += h * (y1 - y2);
        }
        points.push([r, y1, y2]);
    }
    points
}

#[test]
fn the_capsule_drops_out_where_fixed_steps_drop_out() {
    let text = format!(
        "{TWO_MOTIONS}omega = \"150 rad/s\"\n[[ramps]]\nname = \"up\"\nalong = \"omega\"\nfrom = \"150 rad/s\"\nto = \"175 rad/s\"\n\
         rate = \"4 rad/s^2\"\nstart = {{ y1 = \"0.3 m/s\" }}\nbegins = \"settled\"\n"
    );
    let (ramp, ramped) = followed(&text);
    let own: Vec<[f64; 3]> = ramped
        .points
        .iter()
        .map(|it| {
            let section = it.state.section();
            [section[0], section[1], section[2]]
        })
        .collect();
    let other = by_fixed_steps(own[0], [ramp.ends[0], ramp.slope()], own.len() - 1);
    // While it progresses, the displacement at the section agrees as well as steps of first order allow.
    let before = own.len() / 4;
    let size = own.iter().fold(0.0, |most: f64, it| most.max(it[0].abs()));
    for (a, b) in own[..before].iter().zip(&other) {
        assert!((a[0] - b[0]).abs() < 2e-3 * size, "{a:?} {b:?}");
    }
    // The jump: the cycle in which the velocity of the capsule at the section falls away for good.
    let dropped = |points: &[[f64; 3]]| {
        let last = points[points.len() - 1][0];
        let near = |it: &[f64; 3]| (it[0] - last).abs() < 0.3 * (points[0][0] - last).abs();
        points.iter().rposition(|it| !near(it)).expect("a point before the jump")
    };
    let places = [dropped(&own), dropped(&other)];
    assert!(places[0].abs_diff(places[1]) <= 2, "{places:?} of {}", own.len());
    assert_eq!(ramped.jumps.len(), 1, "{:?}", ramped.jumps);
    assert!(ramped.jumps[0].point.abs_diff(places[0]) <= 12, "{:?} {places:?}", ramped.jumps);
}

#[test]
fn ramps_are_kept_drawn_and_shown() {
    let work = WorkDir::new();
    let text = ramp_of(1.0, 1.3, 0.01, "")
        + "[[ramps]]\nname = \"down\"\nalong = \"w\"\nfrom = 1.3\nto = 1.0\nrate = \"0.01/s\"\nbegins = \"start\"\n\
           [[figures]]\nname = \"diagram\"\nkind = \"bifurcation\"\nx = \"w\"\nof = [\"section_x\"]\n"
        + DUFFING;
    work.put("ramp.toml", &text);
    let run = work.run(&["continue", "ramp.toml", "--formats", "svg", "--threads", "2"]).done();
    assert!(run.out.contains("\na: w from 1 to 1.3, 0.01 per second, "), "{}", run.out);
    assert!(run.out.contains(", from a motion of period 1\n"), "{}", run.out);
    assert!(run.out.contains(", from the start\n"), "{}", run.out);
    let figure = [
        "figure",
        "results/ramp/ramp.h5",
        "--kind",
        "bifurcation",
        "--x",
        "w",
        "--of",
        "section_x",
    ];
    work.run(&[&figure[..], &["--formats", "svg", "--svg-text", "--data"]].concat()).done();
    for end in ["svg", "csv"] {
        let path = format!("results/ramp/bifurcation-section_x.{end}");
        let text = std::fs::read_to_string(work.path(&path)).expect("a figure");
        assert!(text.contains("down"), "{end}");
    }
    let again = work.run(&["continue", "ramp.toml", "--no-figures"]).done();
    assert!(again.err.contains("are there already"), "{}", again.err);

    let file = capsulemap::store::read(&work.path("results/ramp/ramp.h5")).expect("a file");
    let column = |name: &str| -> Vec<f64> {
        file.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let (ramps, times, values) = (column("ramp_number"), column("ramp_time"), column("ramp_w"));
    assert_eq!(
        column("ramp_beginning"),
        [1.0, -1.0].map(|it| if it > 0.0 { outcome(&file) } else { it })
    );
    for (place, ramp) in ramps.iter().enumerate() {
        let expected =
            if *ramp == 0.0 { 1.0 + 0.01 * times[place] } else { 1.3 - 0.01 * times[place] };
        let expected = expected.clamp(1.0, 1.3);
        assert!((values[place] - expected).abs() < 1e-12, "{place}");
    }
    // One thread writes the same file, but for its time.
    work.run(&["continue", "ramp.toml", "--no-figures", "--threads", "1", "--output", "one.h5"])
        .done();
    let one = capsulemap::store::read(&work.path("one.h5")).expect("a file");
    assert_eq!(one.variables, file.variables);
}

/// The number of periodic motions in the file.
fn outcome(file: &capsulemap::store::Dataset) -> f64 {
    let flags = &file.variable("ramp_beginning").expect("a column").flags;
    flags.iter().find(|(_, name)| name == "periodic").expect("periodic").0 as f64
}

#[test]
fn faults_of_ramps_are_told_at_once() {
    let work = WorkDir::new();
    let ramp = |lines: &str| format!("{TWO_MOTIONS}omega = \"150 rad/s\"\n[[ramps]]\n{lines}\n");
    for (lines, faults) in [
        ("name = \"a\"\nalong = \"omega\"", vec!["from", "to", "rate", "per s or per min"]),
        (
            "name = \"a\"\nalong = \"omega\"\nfrom = \"1 rad/s\"\nto = \"1 rad/s\"\nrate = \"1 rad/s\"",
            vec!["\"1 rad/s\" must be the change", "as \"0.1 rad/s/s\""],
        ),
        (
            "name = \"a\"\nalong = \"k2\"\nfrom = \"1 kN/m\"\nto = \"2 kN/m\"\nrate = \"1e-6 N/m/s\"\nparts = 0",
            vec!["parts", "1.0e9 seconds"],
        ),
        (
            "name = \"a\"\nalong = \"omega\"\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\nrate = \"0 Hz/s\"\nbegins = \"now\"",
            vec!["must be above zero", "now", "settled"],
        ),
    ] {
        work.put("bad.toml", ramp(lines));
        let expected: Vec<&str> = faults.into_iter().filter(|it| !it.contains("seconds")).collect();
        work.run(&["check", "bad.toml"]).refused(&expected);
    }
    work.put("belt.toml", std::fs::read_to_string("systems/belt.toml").expect("a text"));
    let autonomous = "system = \"belt.toml\"\n[[ramps]]\nname = \"a\"\nalong = \"mu_s\"\nfrom = 1\nto = 2\nrate = \"1/s\"\n";
    work.put("bad.toml", autonomous);
    work.run(&["check", "bad.toml"]).refused(&["has no drive"]);
    work.put("bad.toml", format!("{}[[ramps]]\nname = \"a\"\nalong = \"w\"\nfrom = 1.0\nto = 2.0\nrate = \"1e-9/s\"\n{DUFFING}", ""));
    work.run(&["check", "bad.toml"]).refused(&["cycles; at most 1e6 are followed"]);
}
