//! What a study asks to have drawn from its results.

use std::collections::BTreeMap;

use crate::capsule::Output;

/// What there is for each case besides the outputs.
const VERDICTS: [&str; 3] = ["outcome", "period", "cycles"];
/// What there is for each point of the sections.
const POINTS: [&str; 6] =
    ["section_r", "section_y1", "section_y2", "impact_phase", "impact_y1", "impact_y2"];
/// What a history shows.
const HISTORIES: [&str; 6] =
    ["history_x2", "history_r", "velocities", "history_y1", "history_y2", "history_drive"];

/// The kinds of figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingKind {
    /// Displacements and velocities over time.
    History,
    /// Relative velocity over relative displacement, with the impact surface and section points.
    PhasePortrait,
    /// A section coordinate over an axis, with the progression speed below it.
    Bifurcation,
    /// One output over two axes.
    Map,
    /// Progression speed against an energy per cycle.
    TradeOff,
    /// Special points of followed orbits as curves in two parameters.
    Curves,
}

impl DrawingKind {
    /// Each kind by its name in studies and on the command line, in the order of declaration.
    pub const NAMES: [(&str, DrawingKind); 6] = [
        ("history", DrawingKind::History),
        ("phase-portrait", DrawingKind::PhasePortrait),
        ("bifurcation", DrawingKind::Bifurcation),
        ("map", DrawingKind::Map),
        ("trade-off", DrawingKind::TradeOff),
        ("curves", DrawingKind::Curves),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        DrawingKind::NAMES[self as usize].0
    }

    /// What a figure of this kind can show of a study that keeps `outputs`.
    pub fn can_show(self, outputs: &[Output]) -> Vec<&'static str> {
        let kept = outputs.iter().map(|output| output.name());
        match self {
            DrawingKind::History => HISTORIES.to_vec(),
            DrawingKind::PhasePortrait | DrawingKind::Curves => Vec::new(),
            DrawingKind::Bifurcation => kept.chain(VERDICTS).chain(POINTS).collect(),
            DrawingKind::Map => kept.chain(VERDICTS).collect(),
            DrawingKind::TradeOff => kept.collect(),
        }
    }
}

/// One figure to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Stem of the files to write.
    pub name: String,
    /// Kind of figure.
    pub kind: DrawingKind,
    /// Heading above the axes; none by default, as captions do that in a paper.
    pub title: Option<String>,
    /// Axis along the abscissa; by default the first that is not fixed by `at`.
    pub x: Option<String>,
    /// Axis along the ordinate (maps); by default the second that is not fixed by `at`.
    pub y: Option<String>,
    /// Outputs drawn; the kind of figure has its own default.
    pub of: Vec<String>,
    /// Where the other axes are held, in SI; the nearest grid value is taken, by default the first.
    pub at: BTreeMap<String, f64>,
    /// Range of cycles shown by a history, counted from its start; all by default.
    pub cycles: Option<[f64; 2]>,
    /// Whether a bifurcation diagram shows the followed orbits, too.
    pub branches: bool,
    /// Width of the figure [mm]; by default one or two columns of a journal, as the kind needs.
    pub width_mm: Option<f64>,
}
