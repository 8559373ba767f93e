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
use super::outcome;
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::Panel;
use super::scale::{Scale, Spacing, finite_range};
use super::style::{BLUE, CURVE_WIDTH, INK, REFERENCE_WIDTH};
use super::text::Text;
use super::view::View;
use crate::description::{Description, SignalKind};
use crate::store::catalogue::{Entry, PERIOD, SPECTRUM_FREQUENCY};
use crate::store::schema::{FROM_START, HISTORY_FROM};
use crate::study::Drawing;

/// Height of a frame [pt].
const HEIGHT: f64 = 100.0;
/// Amplitudes down to this share of the largest are shown, unless limits are set.
const SHOWN: f64 = 1e-6;
/// By how much of its range a history may miss itself a period later and still repeat.
const MISSED: f64 = 1e-6;
/// Frequencies are shown up to the last amplitude of this share of the largest, unless limits are set.
const REACH: f64 = 1e-2;

/// What is said of a spectrum of a history that begins at the start of its case and does not repeat.
const TRANSIENT: &str =
    "the history begins at the start of the case, so that the spectrum has the transient in it";

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What spectra are of.
fn outputs(drawing: &Drawing, model: &'static Description) -> Vec<String> {
    match model.motion.portrait.filter(|_| drawing.of.is_empty()) {
        Some([_, usual]) => vec![usual.to_owned()],
        None => drawing.of.clone(),
    }
}

/// What a spectrum reads: the motion, the frequency of the drive, and whether the motion repeats.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let outputs = outputs(drawing, model);
    let needed: Vec<Entry> = outputs.iter().flat_map(|name| sources(name, model)).collect();
    let frequency = model.drive_frequency().map(Entry::of_parameter);
    let repeating = outcome::READS.into_iter().chain([PERIOD]);
    Names::of(needed).and(frequency).and(repeating).and_named(outputs)
}

/// The spectrum of a quantity of a case, in the units of the figure.
struct Spectrum {
    output: String,
    /// Frequencies with their amplitudes.
    lines: Vec<(f64, f64)>,
    /// The frequency of the drive.
    drive: f64,
    /// What it is taken over.
    span: Span,
}

/// What a spectrum is taken over.
#[derive(Clone, Copy, PartialEq)]
enum Span {
    /// A period of a history that repeats, of so many cycles: its lines are those of the motion.
    Period(usize),
    /// So many whole cycles, with a Hann window.
    Windowed(usize),
}

impl Span {
    /// In words.
    fn told(self) -> String {
        let (count, words) = match self {
            Span::Period(count) => (count, "Fourier series over"),
            Span::Windowed(count) => (count, "Hann window over"),
        };
        format!("{words} {count} cycle{}", if count == 1 { "" } else { "s" })
    }
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
        let legend = spectrum.legend(view, index.checked_sub(1).map(|before| &spectra[before]));
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
    let mut spans: Vec<String> = spectra.iter().map(|it| it.span.told()).collect();
    spans.dedup();
    let begins = view.dataset.attributes.get(HISTORY_FROM);
    let is_windowed = spectra.iter().any(|it| matches!(it.span, Span::Windowed(_)));
    let has_transient = is_windowed && begins.is_some_and(|from| from == FROM_START);
    let drawn =
        canvas.finish(&format!("{about}: amplitudes of the spectrum ({})", spans.join(", ")));
    Ok(drawn.noting(has_transient.then(|| TRANSIENT.to_owned())))
}

impl<'a> Spectra<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Spectra<'a>, FigureError> {
        let cases = case_panels(view)?;
        let outputs = outputs(view.drawing, view.model());
        view.check_signals(outputs.iter().map(String::as_str))?;
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
const DRIVE: Stroke = Stroke::dashed(INK, REFERENCE_WIDTH);

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
        let period = panel.period()?.filter(|it| *it as f64 <= cycles);
        let repeats = period.map(|it| (it, (it as f64 / step).round() as usize));
        let repeats = repeats.filter(|(_, count)| repeats_after(&values, *count, goes_on));
        let (span, samples) = match repeats {
            Some((period, count)) => (Span::Period(period), level(&values, count, goes_on)),
            None => {
                let samples = level(&values, count, goes_on);
                (Span::Windowed(cycles as usize), windowed(&samples))
            }
        };
        // A case that failed has no motion.
        let lines = match values.iter().all(|value| value.is_finite()) {
            true => amplitudes(samples, span, drive),
            false => Vec::new(),
        };
        Ok(Spectrum { output: output.to_owned(), lines, drive, span })
    }

    /// What its marks mean, as far as those of the spectrum before do not say it.
    fn legend(&self, view: &View<'_>, before: Option<&Spectrum>) -> Vec<(Mark, Text)> {
        let drive = (view.shows("drive") && before.is_none())
            .then(|| (Mark::Line(DRIVE), Text::plain("drive frequency")));
        let span = before
            .is_none_or(|it| it.span != self.span)
            .then(|| (Mark::Nothing, Text::plain(&self.span.told())));
        drive.into_iter().chain(span).collect()
    }

    /// Draws the amplitudes, and a line at the frequency of the drive if it is shown.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, shows_drive: bool) {
        let stroke = Stroke::solid(BLUE, CURVE_WIDTH);
        match self.span {
            Span::Windowed(_) => panel.curve(canvas, &self.lines, stroke),
            Span::Period(_) => {
                let low = panel.y.scale.low;
                for &(frequency, amplitude) in self.lines.iter().filter(|line| line.1 > low) {
                    panel.curve(canvas, &[(frequency, low), (frequency, amplitude)], stroke);
                }
            }
        }
        // Over the line of the spectrum that stands there.
        if shows_drive {
            let drive = [(self.drive, panel.y.scale.low), (self.drive, panel.y.scale.high)];
            panel.curve(canvas, &drive, DRIVE);
        }
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

    /// The amplitude from which the axis goes: below the least line of a series that is shown, none of which may be less than a share of
    /// the largest.
    fn least(&self) -> f64 {
        let (least, last) = (SHOWN * self.largest(), self.last());
        let shown = self.lines.iter().filter(|line| line.0 <= last && line.1 >= least);
        match self.span {
            Span::Period(_) => {
                shown.map(|line| 0.3 * line.1).fold(f64::INFINITY, f64::min).max(least)
            }
            Span::Windowed(_) => least,
        }
    }

    /// The range of amplitudes.
    fn amplitudes(&self) -> Scale {
        let largest = self.largest();
        match largest > 0.0 {
            true => Scale { spacing: Spacing::Log, low: self.least(), high: 2.0 * largest },
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

/// Whether a history is the same so many samples later, but for the mean advance of what goes on.
fn repeats_after(samples: &[f64], count: usize, goes_on: bool) -> bool {
    let later = samples.iter().skip(count);
    let advance = if goes_on { samples[count] - samples[0] } else { 0.0 };
    let range = finite_range(samples.iter().copied()).map_or(f64::NAN, |(low, high)| high - low);
    samples.iter().zip(later).all(|(a, b)| (b - advance - a).abs() <= MISSED * range)
}

/// Samples over whole cycles without their mean, times the Hann window, doubled so that its mean is one.
fn windowed(samples: &[f64]) -> Vec<f64> {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let window = |at: usize| 1.0 - (TAU * at as f64 / count).cos();
    samples.iter().enumerate().map(|(at, value)| (value - mean) * window(at)).collect()
}

/// Frequencies with the amplitudes of samples, where the drive has the frequency `drive`.
///
/// Of a period they are those of the terms of its Fourier series; through the window those of sinusoids that fit the cycles,
/// which also show with half their amplitude on both sides.
fn amplitudes(samples: Vec<f64>, span: Span, drive: f64) -> Vec<(f64, f64)> {
    let (Span::Period(cycles) | Span::Windowed(cycles)) = span;
    let count = samples.len();
    let mut terms: Vec<Complex<f64>> =
        samples.into_iter().map(|it| Complex::new(it, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(count).process(&mut terms);
    // A sinusoid has half its amplitude at a positive frequency.
    (1..count.div_ceil(2))
        .map(|at| (at as f64 / cycles as f64 * drive, 2.0 * terms[at].norm() / count as f64))
        .collect()
}
