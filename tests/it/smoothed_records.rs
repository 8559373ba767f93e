//! `capsulemap smooth`: polynomials are kept and differentiated exactly, parts by themselves, and what cannot be is refused.

use std::fs;

use super::program::WorkDir;

/// A record of r = 1 + 2 t - 3 t^2 + 4 t^3 [mm] and x1 = t^2 [mm], 100 samples a second, with a gap of a second.
fn record() -> String {
    let mut text = String::from("t [s],r [mm],x1 [mm]\n");
    for i in 0..200 {
        let t = 0.01 * f64::from(i) + if i < 100 { 0.0 } else { 1.0 };
        let r = 1.0 + 2.0 * t - 3.0 * t * t + 4.0 * t * t * t;
        // Another polynomial behind the gap, which a window across it would mix.
        let r = if i < 100 { r } else { -r };
        text += &format!("{t},{r},{}\n", t * t);
    }
    text
}

/// The rows of a file, and its header.
fn rows(work: &WorkDir, file: &str) -> (String, Vec<Vec<f64>>) {
    let text = fs::read_to_string(work.path(file)).expect("written");
    let mut lines = text.lines();
    let header = lines.next().expect("a header").to_owned();
    let number = |cell: &str| cell.parse().expect("a number");
    (header, lines.map(|line| line.split(',').map(number).collect()).collect())
}

/// A function of time.
type Function = fn(f64) -> f64;

#[test]
fn polynomials_are_kept_and_differentiated_on_both_sides_of_a_gap() {
    let work = WorkDir::new();
    work.put("record.csv", record());
    let derivatives: [(&str, [Function; 2]); 3] = [
        ("t [s],x1 [m],r [m]", [|t| t * t, |t| 1.0 + 2.0 * t - 3.0 * t * t + 4.0 * t * t * t]),
        ("t [s],y1 [m/s],dr/dt [m/s]", [|t| 2.0 * t, |t| 2.0 - 6.0 * t + 12.0 * t * t]),
        ("t [s],a1 [m/s2],d2r/dt2 [m/s2]", [|_| 2.0, |t| -6.0 + 24.0 * t]),
    ];
    for (order, (header, [x1, r])) in derivatives.into_iter().enumerate() {
        let file = format!("smooth-{order}.csv");
        let derivative = order.to_string();
        let arguments = ["smooth", "record.csv", "--window", "110 ms", "--output", &file];
        let ran = work.run(&[&arguments[..], &["--derivative", &derivative]].concat()).done();
        assert!(
            ran.out.contains("window: 11 samples") && ran.out.contains("a gap of"),
            "{}",
            ran.out
        );
        let (found, rows) = rows(&work, &file);
        assert_eq!((found.as_str(), rows.len()), (header, 200));
        for (i, row) in rows.iter().enumerate() {
            let (t, sign) = (row[0], if i < 100 { 1.0 } else { -1.0 });
            assert!((row[1] - 1e-3 * x1(t)).abs() < 1e-11, "{file}, row {i}: {row:?}");
            assert!((row[2] - sign * 1e-3 * r(t)).abs() < 1e-9, "{file}, row {i}: {row:?}");
        }
    }
}

#[test]
fn what_cannot_be_smoothed_is_refused_and_nothing_is_written() {
    let work = WorkDir::new();
    work.put("record.csv", record());
    for (options, part) in [
        (&["--window", "10 mm"][..], "--window"),
        (&["--window", "20 ms"], "a polynomial of order 3 needs more than 3"),
        (&["--window", "5 s"], "fewer samples than the window"),
        (&["--window", "1e300 s"], "fewer samples than the window"),
        (&["--window", "110 ms", "--order", "0", "--derivative", "1"], "--derivative"),
    ] {
        let arguments = [&["smooth", "record.csv", "--output", "smooth.csv"], options].concat();
        work.run(&arguments).refused(&[part]);
        assert!(!work.path("smooth.csv").exists(), "{options:?}");
    }
    work.put("smooth.csv", "mine");
    let arguments = ["smooth", "record.csv", "--window", "110 ms", "--output", "smooth.csv"];
    work.run(&arguments).refused(&["smooth.csv: exists", "--overwrite"]);
}
