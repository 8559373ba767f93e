//! The entries of the ramps, of their points and of their jumps.

use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::beginnings;
use crate::description::{Description, Output};

/// The text of a file that names the ramps of the study, one a line.
pub const RAMP_NAMES: &str = "ramp_names";

entries! {
    RAMP_INDEX "ramp_index" "1" Dimension, Whole, None,
        "ramp that the study asks for";
    RAMP_ALONG "ramp_along" "1" Table(RAMP_INDEX.name), CategoryOfFile, None,
        "parameter that changes along the ramp";
    RAMP_BEGINNING "ramp_beginning" "1" Table(RAMP_INDEX.name), Category(beginnings), None,
        "what the motion is with which the ramp begins";
    RAMP_FAILURE "ramp_failure" "1" Table(RAMP_INDEX.name), CategoryOfFile, None,
        "why the motion could not be followed to the end of the ramp";

    RAMP_POINT "ramp_point" "1" Dimension, Whole, None,
        "end of a cycle of the ramps, one ramp after the other";
    RAMP "ramp_number" "1" Table(RAMP_POINT.name), Whole, None,
        "ramp that the motion is on";
    RAMP_TIME "ramp_time" "s" Table(RAMP_POINT.name), Real, None,
        "time since the ramp began";

    RAMP_JUMP "ramp_jump" "1" Dimension, Whole, None,
        "jump of a motion along a ramp";
    JUMP_POINT "jump_point" "1" Table(RAMP_JUMP.name), Whole, None,
        "point of the ramps at which the motion jumps";
    JUMP_SIZE "jump_size" "1" Table(RAMP_JUMP.name), Real, None,
        "how far the mean of the section jumps, relative to the extent of the ramp";
}

/// The outputs that a ramp has of each cycle: the mean speed, and what the model sums up.
pub fn ramp_outputs(model: &'static Description) -> impl Iterator<Item = Output> {
    model.outputs().filter(|output| {
        let is_speed = model.has_trade_off() && *output == model.main_output();
        is_speed || model.motion.sums.contains(&output.name())
    })
}

/// The dimensions of the ramps, in the order of files.
pub const OF_RAMPS: [Entry; 3] = [RAMP_INDEX, RAMP_POINT, RAMP_JUMP];
