//! Amplitudes of a history over frequency.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, sources};
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::Panel;
use super::scale::{Scale, Spacing};
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, REFERENCE_WIDTH};
use super::text::Text;
use super::view::View;
use crate::description::{Description, SignalKind};
use crate::store::catalogue::{Entry, SPECTRUM_FREQUENCY};
use crate::study::Drawing;

/// Height of a frame [pt].
const HEIGHT: f64 = 100.0;
/// Amplitudes down to this share of the largest are shown, unless limits are set.
const SHOWN: f64 = 1e-6;
/// Frequencies are shown up to the last amplitude of this share of the largest, unless limits are set.
const REACH: f64 = 1e-3;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What spectra are of.
fn outputs(drawing: &Drawing, model: &'static Description) -> Vec<String> {
    match model.motion.portrait.filter(|_| drawing.of.is_empty()) {
        Some([_, usual]) => vec![usual.to_owned()],
        None => drawing.of.clone(),
    }
}

/// What a spectrum reads: the motion, and the frequency of the drive.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let outputs = outputs(drawing, model);
    let needed: Vec<Entry> = outputs.iter().flat_map(|name| sources(name, model)).collect();
    let frequency = model.drive_frequency().map(Entry::of_parameter);
    Names::of(needed).and(frequency).and_named(outputs)
}

/// The spectrum of a quantity of a case, in the units of the figure.
struct Spectrum {
    output: String,
    /// Frequencies with their amplitudes.
    lines: Vec<(f64, f64)>,
    /// The frequency of the drive.
    drive: f64,
    /// Cycles that it is taken over.
    cycles: usize,
}

/// What a figure of spectra shows.
struct Spectra<'a> {
    cases: Vec<CasePanel<'a>>,
    outputs: Vec<String>,
    /// One for each case, quantity by quantity.
    spectra: Vec<Spectrum>,
}

/// Draws the spectra that `view` asks for: a row for each quantity, a column for each case.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let Spectra { cases, outputs, spectra } = Spectra::of(view)?;
    let columns = if outputs.len() == 1 { cases.len().min(3) } else { cases.len() };
    let frequencies = frequencies(&spectra);
    let mut requests = Vec::new();
    for (index, spectrum) in spectra.iter().enumerate() {
        let x = AxisRequest::new(view.quantity(SPECTRUM_FREQUENCY.name), frequencies);
        let y = view.quantity(&spectrum.output).preceded_by("Amplitude of");
        let y = AxisRequest::new(y, spectrum.amplitudes());
        let legend = if index == 0 { legend(view, spectrum) } else { Vec::new() };
        requests.push(PanelRequest {
            x: AxisRequest { labelled: index + columns >= spectra.len(), ..x },
            y: AxisRequest { empty: spectrum.lines.is_empty(), ..y },
            header: Header {
                letter: letter(index, spectra.len()),
                note: cases.get(index).and_then(CasePanel::note),
                legend,
            },
        });
    }
    let rows = in_rows(requests, columns);
    let (mut canvas, panels) = PageRequest::of_rows(view.drawing, rows, HEIGHT).lay_out();
    for (panel, spectrum) in panels.iter().flatten().zip(&spectra) {
        spectrum.draw(&mut canvas, panel, view.shows("drive"));
    }
    let about = view.about(&outputs, &[]);
    Ok(canvas.finish(&format!("{about}: amplitudes of the spectrum, with a Hann window")))
}

impl<'a> Spectra<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Spectra<'a>, FigureError> {
        let cases = case_panels(view)?;
        let outputs = outputs(view.drawing, view.model());
        let mut spectra = Vec::new();
        for output in &outputs {
            for panel in &cases {
                spectra.push(Spectrum::of(panel, output)?);
            }
        }
        Ok(Spectra { cases, outputs, spectra })
    }
}

/// The line at the frequency of the drive.
const DRIVE: Stroke = Stroke::dashed(FAINT_INK, REFERENCE_WIDTH);

fn legend(view: &View<'_>, spectrum: &Spectrum) -> Vec<(Mark, Text)> {
    let cycles = spectrum.cycles;
    let over = format!("Hann window over {cycles} cycles");
    let drive = view.shows("drive").then(|| (Mark::Line(DRIVE), Text::plain("drive")));
    drive.into_iter().chain([(Mark::Nothing, Text::plain(&over))]).collect()
}

impl Spectrum {
    /// The spectrum of a quantity over as many whole cycles as its history has.
    fn of(panel: &CasePanel<'_>, output: &str) -> Result<Spectrum, FigureError> {
        let view = &panel.view;
        let kind = view.model().signal(output).map(|it| it.kind);
        if kind == Some(SignalKind::Repeating) {
            return Err(
                view.unfit(format!("`{output}` begins anew again and again: it has no spectrum"))
            );
        }
        let motion = Motion::sampled(view, &panel.free, panel.case);
        let times = motion.cycles()?;
        let values = motion.shown(output)?;
        let step = times.get(1).map_or(f64::NAN, |second| second - times[0]);
        let last = (times.len() - 1) as f64 * step;
        // Rounding makes no history shorter.
        let cycles = (last + 1e-9).floor();
        let count = (cycles / step).round() as usize;
        if !(cycles >= 1.0 && count < times.len()) {
            return Err(view.unfit("a spectrum needs the history of a whole cycle"));
        }
        let omega = motion.frequency()?;
        let drive = omega * view.quantity(SPECTRUM_FREQUENCY.name).factor;
        let goes_on = kind == Some(SignalKind::Drifting);
        // A case that failed has no motion.
        let lines = match values.iter().all(|value| value.is_finite()) {
            true => amplitudes(&level(&values, count, goes_on), cycles, drive),
            false => Vec::new(),
        };
        Ok(Spectrum { output: output.to_owned(), lines, drive, cycles: cycles as usize })
    }

    /// Draws the amplitudes, and a line at the frequency of the drive if it is shown.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, shows_drive: bool) {
        if shows_drive {
            let drive = [(self.drive, panel.y.scale.low), (self.drive, panel.y.scale.high)];
            panel.curve(canvas, &drive, DRIVE);
        }
        panel.curve(canvas, &self.lines, Stroke::solid(BLUE, CURVE_WIDTH));
        panel.record(canvas, &self.output, self.lines.iter().copied());
        panel.finish(canvas);
    }

    fn largest(&self) -> f64 {
        self.lines.iter().map(|line| line.1).fold(0.0, f64::max)
    }

    /// The frequency up to which there is something to see.
    fn last(&self) -> f64 {
        let least = REACH * self.largest();
        let last = self.lines.iter().rev().find(|line| line.1 >= least).map_or(0.0, |line| line.0);
        let drive = if self.drive.is_finite() { self.drive } else { 0.0 };
        last.max(2.0 * drive)
    }

    /// The range of amplitudes.
    fn amplitudes(&self) -> Scale {
        let largest = self.largest();
        match largest > 0.0 {
            true => Scale { spacing: Spacing::Log, low: SHOWN * largest, high: 2.0 * largest },
            false => Scale::around([0.0], 0.0),
        }
    }
}

/// The range of frequencies in which there is something to see in any of `spectra`.
fn frequencies(spectra: &[Spectrum]) -> Scale {
    Scale::around([0.0, spectra.iter().map(Spectrum::last).fold(0.0, f64::max)], 0.0)
}

/// The first `count` samples, without the mean advance to the next of what goes on.
fn level(samples: &[f64], count: usize, goes_on: bool) -> Vec<f64> {
    let advance = if goes_on { (samples[count] - samples[0]) / count as f64 } else { 0.0 };
    let whole_cycles = samples[..count].iter().enumerate();
    whole_cycles.map(|(at, value)| value - advance * at as f64).collect()
}

/// Frequencies with the amplitudes of samples over whole cycles, where the drive has the frequency `drive`.
///
/// Method: the mean is taken off; a Hann window; amplitudes are those of sinusoids that fit the cycles, which also show with half
/// their amplitude on both sides.
fn amplitudes(samples: &[f64], cycles: f64, drive: f64) -> Vec<(f64, f64)> {
    let count = samples.len();
    let mean = samples.iter().sum::<f64>() / count as f64;
    let mut windowed = Vec::with_capacity(count);
    for (at, value) in samples.iter().enumerate() {
        let window = 0.5 - 0.5 * (TAU * at as f64 / count as f64).cos();
        windowed.push(Complex::new((value - mean) * window, 0.0));
    }
    FftPlanner::new().plan_fft_forward(count).process(&mut windowed);
    // The window's mean is a half, and a sinusoid has half its amplitude at a positive frequency.
    (1..count.div_ceil(2))
        .map(|at| (at as f64 / cycles * drive, 4.0 * windowed[at].norm() / count as f64))
        .collect()
}
