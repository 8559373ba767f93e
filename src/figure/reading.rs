//! What a figure reads of the results, so that no more has to be held in memory.

use crate::orbit::Output;
use crate::store::catalogue::{CERTIFICATE, CYCLES};
use crate::study::{Drawing, DrawingKind};

/// Outputs that figures show by default or judge cases by.
const USUAL: [Output; 4] =
    [Output::ProgressionSpeed, Output::WorkPositive, Output::LyapunovExponent, Output::StickShare];
/// Of what each case has several numbers, which take the most room.
const ROWS: [&str; 4] = ["section_", "impact_", "history_", "multiplier_"];
/// Of each case or block, and in figures only where they are named.
const NAMED: [&str; 4] = [CYCLES.name, "failure_", CERTIFICATE.name, "block_"];

/// Whether `drawing` needs the numbers of the variable `name`, as far as that can be told by its name.
pub fn reads(drawing: &Drawing, name: &str) -> bool {
    let begins = |with: &&str| name.starts_with(with);
    let shown = drawing.of.iter().chain(&drawing.x).chain(&drawing.y);
    if shown.into_iter().any(|it| it == name) || USUAL.iter().any(|it| it.name() == name) {
        return true;
    }
    if Output::ALL.iter().any(|output| output.name() == name) || NAMED.iter().any(begins) {
        return false;
    }
    if ROWS.iter().any(begins) {
        return match drawing.kind {
            DrawingKind::PhasePortrait => true,
            DrawingKind::History => name.starts_with("history_"),
            DrawingKind::Bifurcation => name.starts_with("section_"),
            DrawingKind::Map | DrawingKind::TradeOff | DrawingKind::Curves => false,
        };
    }
    true
}
