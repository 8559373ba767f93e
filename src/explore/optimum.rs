//! The motion of an optimum, computed again and drawn: its history over two periods, and its phase portrait.

use crate::campaign::Row;
use crate::description::State;
use crate::figure::{FigureError, Picture, picture};
use crate::orbit::{HistorySpan, Machine, Protocol};
use crate::run::{RunError, run_sample};
use crate::store::dataset;
use crate::study::{Coordinate, Drawing, DrawingKind, Study};

/// Longest motion that is drawn [cycles]; of longer periods the first part is shown.
const MOST_CYCLES: u64 = 16;
/// Samples of a cycle.
const PER_CYCLE: u32 = 400;
/// Width of a picture [mm].
const WIDTH: f64 = 80.0;

/// The drawings of a motion.
pub struct Drawings {
    /// Its history and phase portrait.
    pub pictures: Vec<Picture>,
    /// How many cycles the history shows.
    pub cycles: u64,
}

/// Computes a periodic motion of a study again and draws it; none where it does not repeat.
///
/// Fails if the computation cannot be started, or a picture cannot be drawn.
pub fn drawings(row: &Row, of: &Study) -> Result<Option<Drawings>, Undrawn> {
    let Some(period) = row.period else { return Ok(None) };
    let cycles = (2 * period).min(MOST_CYCLES);
    let study = study(row, of, cycles as u32);
    let records = run_sample(&study, Machine::single(), &[0], || ()).map_err(Undrawn::Run)?;
    let results = dataset(&study, &records);
    let pictures = [DrawingKind::History, DrawingKind::PhasePortrait]
        .map(|kind| picture(&results, &drawing(kind)));
    let pictures: Result<Vec<Picture>, FigureError> = pictures.into_iter().collect();
    Ok(Some(Drawings { pictures: pictures.map_err(Undrawn::Figure)?, cycles }))
}

/// Why a motion was not drawn.
#[derive(Debug)]
pub enum Undrawn {
    /// It could not be computed.
    Run(RunError),
    /// It could not be drawn.
    Figure(FigureError),
}

/// The study of one case: a motion of another study, with its history.
fn study(row: &Row, of: &Study, cycles: u32) -> Study {
    let base = of.base.clone();
    let mut study =
        Study { base, outputs: vec![of.base.model().main_output()], ..Study::of(of.base.model()) };
    let mut start = State::origin(of.base.model());
    for (coordinate, value, _) in &row.coordinates {
        match coordinate {
            Coordinate::Parameter(parameter) => study.base[*parameter] = *value,
            Coordinate::Start(coordinate) => start[*coordinate] = *value,
            Coordinate::StartPhase => study.start_phase = *value,
            Coordinate::SectionPhase => study.section_phase = *value,
        }
    }
    let history = Some(HistorySpan { cycles, per_cycle: PER_CYCLE, from_start: false });
    Study { start, protocol: Protocol { history, ..of.protocol }, ..study }
}

fn drawing(kind: DrawingKind) -> Drawing {
    Drawing { width_mm: Some(WIDTH), ..Drawing::new(kind.name(), kind) }
}
