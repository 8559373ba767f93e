//! What a capsule over folds says of itself: what one on even ground does, and where it is between two folds.

use super::description::{ON_EVEN_GROUND, OUTPUTS, PARAMETERS};
use super::output::Output;
use super::quantities::{
    EDGE_SECTION_PLACE, EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2, END_PLACE, END_R, END_Y1,
    END_Y2, NEUTRAL_PLACE, NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2, SECTION_PLACE, SECTION_R, SECTION_Y1,
    SECTION_Y2, START_PLACE, START_R, START_X2, START_Y1, START_Y2,
};
use super::signals;
use crate::description::{CoordinateDescription, Description, Roles};

/// The capsule on a way with evenly spaced folds. Its displacement drifts, as on even ground; its place between two folds is a
/// coordinate of the section, so that a motion that repeats there passes a whole number of folds in its period.
pub static CAPSULE_OVER_FOLDS: Description = Description {
    name: "capsule-over-folds",
    extends: Some(&super::description::CAPSULE),
    parameters: PARAMETERS,
    coordinates: &[
        CoordinateDescription { name: "r", tag: "StartR", start: START_R },
        CoordinateDescription { name: "y1", tag: "StartY1", start: START_Y1 },
        CoordinateDescription { name: "x2", tag: "StartX2", start: START_X2 },
        CoordinateDescription { name: "y2", tag: "StartY2", start: START_Y2 },
        CoordinateDescription { name: "place", tag: "StartPlace", start: START_PLACE },
    ],
    on_section: &[0, 1, 3, 4],
    section: &[SECTION_R, SECTION_Y1, SECTION_Y2, SECTION_PLACE],
    compared_as: &["omega r", "y1", "y2", "omega x2"],
    neutral: &[NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2, NEUTRAL_PLACE],
    edge: &[EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2, EDGE_SECTION_PLACE],
    end: &[END_R, END_Y1, END_Y2, END_PLACE],
    motion: signals::MOTION_OVER_FOLDS,
    outputs: OUTPUTS,
    roles: Roles {
        key_outputs: &[
            Output::ProgressionSpeed as usize,
            Output::ProgressionPerCycle as usize,
            Output::FoldsPerPeriod as usize,
            Output::WorkNet as usize,
            Output::WorkPositive as usize,
            Output::FrictionLoss as usize,
            Output::DamperLoss as usize,
            Output::Power as usize,
            Output::EnergyPerMetre as usize,
            Output::CostOfTransport as usize,
            Output::ImpactsPerCycle as usize,
            Output::StickShare as usize,
            Output::LyapunovExponent as usize,
        ],
        ..ON_EVEN_GROUND.roles
    },
    ..ON_EVEN_GROUND
};
