//! Pictures of an identification and of a comparison: what was measured beside what a model gives.

use crate::capsule::{CapsuleParameters as _, Parameter};
use crate::experiment::friction::coast_down;
use crate::experiment::identification::Evidence;
use crate::experiment::line::Line;
use crate::experiment::recording::GAP;
use crate::experiment::{Coasting, Comparison, Given, Recording, Signal, Test, Verdict};
use crate::figure::plot::{Look, Plot, PlotPanel, Series};
use crate::quantity::Dimension;

/// Height of a frame [pt].
const HEIGHT: f64 = 110.0;
/// Points of a drawn law.
const SMOOTH: usize = 200;

fn series(label: &str, look: Look, points: Vec<(f64, f64)>) -> Series {
    Series { label: label.to_owned(), look, points }
}

fn panel(x: &str, y: &str, series: Vec<Series>) -> PlotPanel {
    PlotPanel { x: x.to_owned(), y: y.to_owned(), series, note: String::new() }
}

fn plot(test: Test, about: &str, rows: Vec<PlotPanel>) -> Plot {
    Plot {
        name: test.name().to_owned(),
        about: about.to_owned(),
        rows: rows.into_iter().map(|panel| vec![panel]).collect(),
        height: HEIGHT,
    }
}

/// Pairs of two columns in other units.
fn scaled(x: &[f64], y: &[f64], factors: [f64; 2]) -> Vec<(f64, f64)> {
    x.iter().zip(y).map(|(x, y)| (x * factors[0], y * factors[1])).collect()
}

/// What a test measured, beside the fitted model and what it leaves; none where there is nothing to draw.
pub fn evidence_plot(
    test: Test,
    recording: &Recording,
    evidence: &Evidence,
    given: &Given,
) -> Option<Plot> {
    match evidence {
        Evidence::Decay(decay) => {
            let (t, r) = (recording.required("t"), recording.required("r"));
            let model: Vec<f64> = t.iter().map(|time| decay.decay(given.m1, *time)).collect();
            let from = t.partition_point(|time| *time < decay.begins);
            let left: Vec<f64> = r.iter().zip(&model).map(|(r, model)| r - model).collect();
            let fitted = scaled(&t[from..], &model[from..], [1.0, 1e3]);
            let about = "free vibration: relative displacement as recorded, the fitted decay, and their difference";
            Some(plot(
                test,
                about,
                vec![
                    panel(
                        "Time (s)",
                        "Relative displacement $r$ (mm)",
                        vec![
                            series("recorded", Look::Measured, scaled(t, r, [1.0, 1e3])),
                            series("fitted decay", Look::Model, fitted),
                        ],
                    ),
                    panel(
                        "Time (s)",
                        "Recorded less fitted (mm)",
                        vec![
                            series(
                                "",
                                Look::Measured,
                                scaled(&t[from..], &left[from..], [1.0, 1e3]),
                            ),
                            series(
                                "",
                                Look::Reference,
                                vec![(t[from], 0.0), (t[t.len() - 1], 0.0)],
                            ),
                        ],
                    ),
                ],
            ))
        }
        Evidence::Line(line) if test == Test::StaticForce => {
            let (force, deflection) =
                (recording.required("force"), recording.required("deflection"));
            Some(line_plot(
                test,
                line,
                (force, 1.0, "Load (N)"),
                (deflection, 1e3, "Deflection", "mm"),
            ))
        }
        Evidence::Line(line) => {
            let (current, force) = (recording.required("current"), recording.required("force"));
            Some(line_plot(test, line, (current, 1.0, "Current (A)"), (force, 1.0, "Force", "N")))
        }
        Evidence::Coasting(coasting) => {
            Some(coasting_plot(test, recording.required("v"), coasting))
        }
        Evidence::None => None,
    }
}

/// Points with their line, and what it leaves of them.
fn line_plot(
    test: Test,
    line: &Line,
    (x, x_factor, x_label): (&[f64], f64, &str),
    (y, y_factor, y_name, y_unit): (&[f64], f64, &str, &str),
) -> Plot {
    let ends = [f64::min, f64::max].map(|end| x.iter().copied().reduce(end).unwrap_or(0.0));
    let at = |x: f64| (x * x_factor, (line.intercept.value + line.slope.value * x) * y_factor);
    let mut residuals = panel(
        x_label,
        &format!("{y_name} less line ({y_unit})"),
        vec![
            series("", Look::Measured, scaled(x, &line.residuals, [x_factor, y_factor])),
            series("", Look::Reference, ends.map(|x| (x * x_factor, 0.0)).to_vec()),
        ],
    );
    if line.curvature.is_some() {
        residuals.note = "curved: not one straight line".to_owned();
    }
    plot(
        test,
        "the points of the test with the fitted line, and what it leaves of them",
        vec![
            panel(
                x_label,
                &format!("{y_name} ({y_unit})"),
                vec![
                    series("measured", Look::Measured, scaled(x, y, [x_factor, y_factor])),
                    series("line", Look::Model, ends.map(at).to_vec()),
                ],
            ),
            residuals,
        ],
    )
}

/// The coefficients of Eq. (2) over the initial speed, with what the accepted law predicts of them, and the law itself.
fn coasting_plot(test: Test, speeds: &[f64], coasting: &Coasting) -> Plot {
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    let (mu_d, v_s) = (coasting.by_coast_down.mu_d.value, coasting.by_coast_down.v_s.value);
    let curve = |of: &dyn Fn(f64) -> f64| {
        let at = |i: usize| 1.02 * fastest * i as f64 / SMOOTH as f64;
        (0..=SMOOTH).map(|i| (at(i), of(at(i)))).collect::<Vec<_>>()
    };
    let law = curve(&|v| mu_d * (1.0 + (-v / v_s).exp()));
    // Gravity cancels; at rest the prediction is the law itself.
    let predicted = curve(&|v| match v > 0.0 {
        true => v * v / (2.0 * coast_down(v, mu_d, v_s, 1.0).0),
        false => 2.0 * mu_d,
    });
    let about = "friction coefficients v^2/(2 g d) of the coasting tests over the initial speed, what the accepted law predicts of them, \
                 and the accepted law, which is friction at that speed";
    let mut frame = panel(
        "Speed (m/s)",
        "Friction coefficient",
        vec![
            series(
                "$v^2/(2gd)$ measured",
                Look::Measured,
                scaled(speeds, &coasting.coefficients, [1.0, 1.0]),
            ),
            series("$v^2/(2gd)$ by the law", Look::Model, predicted),
            series("law at speed $v$", Look::Other, law),
        ],
    );
    if coasting.by_coast_down.verdicts[0] != Verdict::Determined {
        frame.note = "one of several laws".to_owned();
    }
    plot(test, about, vec![frame])
}

/// The points of a curve, broken at the gaps of the record.
fn broken(points: Vec<(f64, f64)>, comparison: &Comparison) -> Vec<(f64, f64)> {
    let longest = GAP * comparison.sampling.interval;
    let mut all = Vec::with_capacity(points.len());
    for (place, point) in points.iter().enumerate() {
        if place > 0 && point.0 - points[place - 1].0 > longest {
            all.push((f64::NAN, f64::NAN));
        }
        all.push(*point);
    }
    all
}

/// A comparison in the style of the paper's Figs 5 to 7: a panel for each signal, recorded and simulated.
///
/// So many cycles of the drive are shown, which a note says where the record has more.
pub fn comparison_plot(name: &str, comparison: &Comparison, about: &str, cycles: u64) -> Plot {
    let span = cycles as f64 * comparison.motion.parameters.drive_period();
    let count = comparison.times.partition_point(|time| *time <= span);
    let is_cut = count < comparison.times.len();
    let row = |it: &crate::experiment::Difference| {
        let (factor, unit) = match it.signal.dimension() {
            Dimension::Length => (1e3, "mm"),
            Dimension::Velocity => (1e3, "mm/s"),
            other => (1.0, other.unit()),
        };
        let symbol = match it.signal {
            Signal::X1 => "$x_1$",
            Signal::X2 => "$x_2$",
            Signal::R => "$x_1 - x_2$",
            Signal::Y1 => "$y_1$",
            Signal::Y2 => "$y_2$",
            Signal::A1 => "$a_1$",
            Signal::Drive => "Drive",
        };
        let unit = unit.replace("m/s2", "m/s$^2$");
        let of = |values: &[f64]| {
            broken(scaled(&comparison.times[..count], &values[..count], [1.0, factor]), comparison)
        };
        let mut all = vec![
            series("recorded", Look::Record, of(&it.recorded)),
            series("simulated", Look::Simulated, of(&it.simulated)),
        ];
        if it.signal == Signal::R {
            let delta = factor * comparison.motion.parameters[Parameter::Delta];
            let ends = [comparison.times[0], comparison.times[count - 1]];
            all.push(series("$\\delta$", Look::Reference, ends.map(|t| (t, delta)).to_vec()));
        }
        vec![panel("Time (s)", &format!("{symbol} ({unit})"), all)]
    };
    let mut rows: Vec<Vec<PlotPanel>> = comparison.differences.iter().map(row).collect();
    if is_cut && let Some(first) = rows.first_mut().and_then(|row| row.first_mut()) {
        let whole = comparison.cycles.round();
        let decimals = usize::from((comparison.cycles - whole).abs() >= 0.05);
        first.note = format!("{cycles} of {:.decimals$} cycles", comparison.cycles);
    }
    Plot { name: name.to_owned(), about: about.to_owned(), rows, height: 0.8 * HEIGHT }
}
