//! Pictures of an identification and of a comparison: what was measured beside what a model gives.

use crate::capsule::{CapsuleParameters as _, Parameter};
use crate::experiment::friction::coast_down;
use crate::experiment::identification::Evidence;
use crate::experiment::line::Line;
use crate::experiment::recording::GAP;
use crate::experiment::{
    Coasting, Comparison, Difference, FreeVibration, Given, Recording, Sampling, Signal,
    StateDifference, Test, TextComparison, Verdict,
};
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
        Evidence::Decay(decay) => Some(decay_plot(test, recording, decay, given)),
        Evidence::Line(line) if test == Test::StaticForce => {
            let load = DrawnColumn {
                values: recording.required("force"),
                factor: 1.0,
                name: "Load",
                unit: "N",
            };
            let values = recording.required("deflection");
            let deflection = DrawnColumn { values, factor: 1e3, name: "Deflection", unit: "mm" };
            Some(line_plot(test, line, &load, &deflection))
        }
        Evidence::Line(line) => {
            let values = recording.required("current");
            let current = DrawnColumn { values, factor: 1.0, name: "Current", unit: "A" };
            let values = recording.required("force");
            let force = DrawnColumn { values, factor: 1.0, name: "Force", unit: "N" };
            Some(line_plot(test, line, &current, &force))
        }
        Evidence::Coasting(coasting) => {
            Some(coasting_plot(test, recording.required("v"), coasting))
        }
        Evidence::None => None,
    }
}

/// The free vibration, with the fitted decay and what it leaves.
fn decay_plot(test: Test, recording: &Recording, decay: &FreeVibration, given: &Given) -> Plot {
    let (t, r) = (recording.required("t"), recording.required("r"));
    let model: Vec<f64> = t.iter().map(|time| decay.decay(given.m1, *time)).collect();
    let from = match decay.from_release {
        true => 0,
        false => t.partition_point(|time| *time < decay.begins),
    };
    let left: Vec<f64> = r.iter().zip(&model).map(|(r, model)| r - model).collect();
    let fitted = scaled(&t[from..], &model[from..], [1.0, 1e3]);
    let left = scaled(&t[from..], &left[from..], [1.0, 1e3]);
    let zero = vec![(t[from], 0.0), (t[t.len() - 1], 0.0)];
    let about =
        "free vibration: relative displacement as recorded, the fitted decay, and their difference";
    plot(
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
                vec![series("", Look::Measured, left), series("", Look::Reference, zero)],
            ),
        ],
    )
}

/// A column of a recording as it is drawn.
struct DrawnColumn<'a> {
    /// Its values (SI).
    values: &'a [f64],
    /// What they are multiplied by.
    factor: f64,
    /// What it is called.
    name: &'static str,
    /// The unit in which it is shown.
    unit: &'static str,
}

impl DrawnColumn<'_> {
    fn label(&self) -> String {
        format!("{} ({})", self.name, self.unit)
    }
}

/// Points with their line, and what it leaves of them.
fn line_plot(test: Test, line: &Line, x: &DrawnColumn<'_>, y: &DrawnColumn<'_>) -> Plot {
    let factors = [x.factor, y.factor];
    let ends = [f64::min, f64::max].map(|end| x.values.iter().copied().reduce(end).unwrap_or(0.0));
    let on_line = ends
        .map(|end| (end * x.factor, (line.intercept.value + line.slope.value * end) * y.factor));
    let mut residuals = panel(
        &x.label(),
        &format!("{} less line ({})", y.name, y.unit),
        vec![
            series("", Look::Measured, scaled(x.values, &line.residuals, factors)),
            series("", Look::Reference, ends.map(|end| (end * x.factor, 0.0)).to_vec()),
        ],
    );
    if line.curvature.is_some() {
        residuals.note = "curved: not one straight line".to_owned();
    }
    let points = panel(
        &x.label(),
        &y.label(),
        vec![
            series("measured", Look::Measured, scaled(x.values, y.values, factors)),
            series("line", Look::Model, on_line.to_vec()),
        ],
    );
    plot(
        test,
        "the points of the test with the fitted line, and what it leaves of them",
        vec![points, residuals],
    )
}

/// The coefficients of Eq. (2) over the initial speed, with what the accepted law predicts of them, and the law itself.
fn coasting_plot(test: Test, speeds: &[f64], coasting: &Coasting) -> Plot {
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    let (mu_d, v_s) = (coasting.by_coast_down.mu_d.value, coasting.by_coast_down.v_s.value);
    let law = curve(fastest, |v| mu_d * (1.0 + (-v / v_s).exp()));
    // Gravity cancels; at rest the prediction is the law itself.
    let predicted = curve(fastest, |v| match v > 0.0 {
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

/// What a law gives from rest to a little beyond the fastest test.
fn curve(fastest: f64, law: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let speeds = (0..=SMOOTH).map(|i| 1.02 * fastest * i as f64 / SMOOTH as f64);
    speeds.map(|v| (v, law(v))).collect()
}

/// The points of a curve, broken at the gaps of a record.
fn broken(points: Vec<(f64, f64)>, sampling: &Sampling) -> Vec<(f64, f64)> {
    let longest = GAP * sampling.interval;
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
pub fn comparison_plot(asked: &AskedPlot<'_>, comparison: &Comparison) -> Plot {
    let span = asked.cycles as f64 * comparison.motion.parameters.drive_period();
    let count = comparison.times.partition_point(|time| *time <= span);
    let is_cut = count < comparison.times.len();
    let panels = comparison.differences.iter().map(|it| signal_panel(it, comparison, count));
    let mut rows = asked.rows(panels);
    if is_cut {
        note_cut(&mut rows, asked.cycles, comparison.cycles);
    }
    asked.plot(rows)
}

/// What is asked of the picture of a comparison.
pub struct AskedPlot<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it shows, in a sentence.
    pub about: &'a str,
    /// Cycles of the drive that are shown.
    pub cycles: u64,
    /// Whether what is recorded less what is simulated stands below each signal.
    pub residuals: bool,
}

impl AskedPlot<'_> {
    /// A row for each panel of a signal, and one for its residuals, if they are asked for.
    fn rows(&self, panels: impl Iterator<Item = PlotPanel>) -> Vec<Vec<PlotPanel>> {
        let rows = panels.flat_map(|panel| {
            let residuals = self.residuals.then(|| residual_panel(&panel)).flatten();
            [panel].into_iter().chain(residuals).map(|it| vec![it])
        });
        rows.collect()
    }

    fn plot(&self, rows: Vec<Vec<PlotPanel>>) -> Plot {
        let more = if self.residuals { ", with the differences below each signal" } else { "" };
        Plot {
            name: self.name.to_owned(),
            about: format!("{}{more}", self.about),
            rows,
            height: 0.8 * HEIGHT,
        }
    }
}

/// What is recorded less what is simulated, of a panel that has both first.
fn residual_panel(of: &PlotPanel) -> Option<PlotPanel> {
    let [recorded, simulated, ..] = &of.series[..] else { return None };
    let both = recorded.points.iter().zip(&simulated.points);
    let left: Vec<(f64, f64)> = both.map(|(it, model)| (it.0, it.1 - model.1)).collect();
    let ends = [left.first()?.0, left.last()?.0];
    let all = vec![
        series("recorded less simulated", Look::Record, left),
        series("", Look::Reference, ends.map(|t| (t, 0.0)).to_vec()),
    ];
    Some(panel(&of.x, &format!("Residual of {}", of.y), all))
}

/// Notes in the first panel how many of all cycles are shown.
fn note_cut(rows: &mut [Vec<PlotPanel>], cycles: u64, all: f64) {
    if let Some(first) = rows.first_mut().and_then(|row| row.first_mut()) {
        let decimals = usize::from((all - all.round()).abs() >= 0.05);
        first.note = format!("{cycles} of {all:.decimals$} cycles");
    }
}

/// A comparison with an oscillator given as text: a panel for each recorded state, recorded and simulated, over so many cycles.
pub fn text_comparison_plot(asked: &AskedPlot<'_>, it: &TextComparison) -> Plot {
    let span = asked.cycles as f64 * it.cycle;
    let count = it.times.partition_point(|time| *time <= span);
    let mut rows = asked.rows(it.differences.iter().map(|state| state_panel(state, it, count)));
    if count < it.times.len() {
        note_cut(&mut rows, asked.cycles, it.times[it.times.len() - 1] / it.cycle);
    }
    asked.plot(rows)
}

/// A state, recorded and simulated, over so many samples.
fn state_panel(state: &StateDifference, it: &TextComparison, count: usize) -> PlotPanel {
    let [recorded, simulated] = [&state.recorded, &state.simulated]
        .map(|values| broken(scaled(&it.times[..count], &values[..count], [1.0; 2]), &it.sampling));
    let states = &it.motion.parameters.model().coordinates;
    let has_units = states.iter().any(|it| it.start.dimension != Dimension::Number);
    let time = if has_units { "Time (s)" } else { "Time" };
    let label = match state.channel.dimension {
        Dimension::Number => state.channel.name.to_owned(),
        dimension => format!("{} ({})", state.channel.name, dimension.unit()),
    };
    let all = vec![
        series("recorded", Look::Record, recorded),
        series("simulated", Look::Simulated, simulated),
    ];
    panel(time, &label, all)
}

/// A signal, recorded and simulated, over so many samples.
fn signal_panel(it: &Difference, comparison: &Comparison, count: usize) -> PlotPanel {
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
    let times = &comparison.times[..count];
    let [recorded, simulated] = [&it.recorded, &it.simulated]
        .map(|values| broken(scaled(times, &values[..count], [1.0, factor]), &comparison.sampling));
    let mut all = vec![
        series("recorded", Look::Record, recorded),
        series("simulated", Look::Simulated, simulated),
    ];
    if it.signal == Signal::R {
        let delta = factor * comparison.motion.parameters[Parameter::Delta];
        let ends = [comparison.times[0], comparison.times[count - 1]];
        all.push(series("$\\delta$", Look::Reference, ends.map(|t| (t, delta)).to_vec()));
    }
    panel("Time (s)", &format!("{symbol} ({unit})"), all)
}
