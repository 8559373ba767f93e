//! The kinds of figure: each is a file of its own, and a line here.

use super::kind::Kind;
use super::{
    basin, bifurcation, curves, history, map, phase_portrait, section, sensitivity, settling,
    shares, spectrum, trade_off, trade_off_maps,
};
use crate::study::DrawingKind;

/// The kind of figure of this name.
pub fn kind(name: DrawingKind) -> &'static Kind {
    match name {
        DrawingKind::History => &history::KIND,
        DrawingKind::PhasePortrait => &phase_portrait::KIND,
        DrawingKind::Bifurcation => &bifurcation::KIND,
        DrawingKind::Spectrum => &spectrum::KIND,
        DrawingKind::Map => &map::KIND,
        DrawingKind::Basin => &basin::KIND,
        DrawingKind::Settling => &settling::KIND,
        DrawingKind::Shares => &shares::KIND,
        DrawingKind::Section => &section::KIND,
        DrawingKind::TradeOff => &trade_off::KIND,
        DrawingKind::TradeOffMaps => &trade_off_maps::KIND,
        DrawingKind::Curves => &curves::KIND,
        DrawingKind::Sensitivity => &sensitivity::KIND,
    }
}
