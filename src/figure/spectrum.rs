//! Amplitudes of a history over frequency.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::axis::AxisRequest;
use super::canvas::{Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, sources};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::panel::Pointing;
use super::scale::{Scale, Spacing};
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, ONE_COLUMN, REFERENCE_WIDTH, TWO_COLUMNS};
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

/// Draws the spectra that `view` asks for: a row for each quantity, a column for each case.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let cases = case_panels(view)?;
    let outputs = outputs(view.drawing, view.model());
    let mut spectra = Vec::new();
    for output in &outputs {
        for panel in &cases {
            spectra.push(spectrum(panel, output)?);
        }
    }
    let frequencies = frequencies(&spectra);
    let notes: Vec<Option<Text>> = cases.iter().map(CasePanel::note).collect();
    let cases = cases.len();
    let columns = if outputs.len() == 1 { cases.min(3) } else { cases };
    let mut rows: Vec<Vec<PanelRequest>> = Vec::new();
    for (index, spectrum) in spectra.iter().enumerate() {
        let is_lowest = index + columns >= spectra.len();
        let x = AxisRequest::new(view.quantity(SPECTRUM_FREQUENCY.name), frequencies);
        let y = view.quantity(&spectrum.output).preceded_by("Amplitude of");
        let y = AxisRequest::new(y, spectrum.amplitudes());
        let legend = if index == 0 { legend(view, spectrum) } else { Vec::new() };
        let panel = PanelRequest {
            x: AxisRequest { labelled: is_lowest, ..x },
            y: AxisRequest { empty: spectrum.lines.is_empty(), ..y },
            header: Header {
                letter: letter(index, spectra.len()),
                note: notes.get(index).cloned().flatten(),
                legend,
            },
        };
        match rows.last_mut().filter(|row| row.len() < columns) {
            Some(row) => row.push(panel),
            None => rows.push(vec![panel]),
        }
    }
    let page = PageRequest {
        drawing: view.drawing,
        width_mm: if columns > 1 { TWO_COLUMNS } else { ONE_COLUMN },
        heights: vec![HEIGHT; rows.len()],
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Inward,
    };
    let (mut canvas, panels) = page.lay_out();
    for (panel, spectrum) in panels.iter().flatten().zip(&spectra) {
        let drive = [(spectrum.drive, panel.y.scale.low), (spectrum.drive, panel.y.scale.high)];
        if view.shows("drive") {
            panel.curve(&mut canvas, &drive, DRIVE);
        }
        panel.curve(&mut canvas, &spectrum.lines, Stroke::solid(BLUE, CURVE_WIDTH));
        panel.record(&mut canvas, &spectrum.output, spectrum.lines.iter().copied());
        panel.finish(&mut canvas);
    }
    let about = view.about(&outputs, &[]);
    Ok(canvas.finish(&format!("{about}: amplitudes of the spectrum, with a Hann window")))
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

/// The amplitudes of a quantity over as many whole cycles as its history has.
///
/// Method: the mean is taken off, and from displacements, which go on, their mean advance; a Hann window; amplitudes are those of
/// sinusoids that fit the cycles, which also show with half their amplitude on both sides.
fn spectrum(panel: &CasePanel<'_>, output: &str) -> Result<Spectrum, FigureError> {
    let (view, case) = (&panel.view, panel.case);
    let free: &[&str] = &panel.free();
    let motion = Motion::sampled(view, free, case);
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
    let found = |lines: Vec<(f64, f64)>| Spectrum {
        output: output.to_owned(),
        lines,
        drive,
        cycles: cycles as usize,
    };
    // A case that failed has no motion.
    if values.iter().any(|value| !value.is_finite()) {
        return Ok(found(Vec::new()));
    }
    let kind = view.model().signal(output).map(|it| it.kind);
    let goes_on = kind == Some(SignalKind::Drifting);
    let advance = if goes_on { (values[count] - values[0]) / count as f64 } else { 0.0 };
    let level: Vec<f64> =
        values[..count].iter().enumerate().map(|(at, value)| value - advance * at as f64).collect();
    let mean = level.iter().sum::<f64>() / count as f64;
    let window = |at: usize| 0.5 - 0.5 * (TAU * at as f64 / count as f64).cos();
    let sample = |(at, value): (usize, &f64)| Complex::new((value - mean) * window(at), 0.0);
    let mut samples: Vec<Complex<f64>> = level.iter().enumerate().map(sample).collect();
    FftPlanner::new().plan_fft_forward(count).process(&mut samples);
    // The window's mean is a half, and a sinusoid has half its amplitude at a positive frequency.
    let line = |at: usize| (at as f64 / cycles * drive, 4.0 * samples[at].norm() / count as f64);
    Ok(found((1..count.div_ceil(2)).map(line).collect()))
}
