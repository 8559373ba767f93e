//! The entries of the tables beside the cases: events of attractors, and blocks.

use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::specials;

entries! {
    EVENT "event" "1" Dimension, Whole, None,
        "event of an attractor";
    EVENT_KIND "event_kind" "1" Table(EVENT.name), Category(specials), None,
        "what happens to the attractor";
    EVENT_ATTRACTOR "event_attractor" "1" Table(EVENT.name), Whole, None,
        "attractor of the event";
    EVENT_PERIOD "event_period" "1" Table(EVENT.name), Whole, None,
        "period of the orbit that changes, in drive cycles";
    EVENT_UNCERTAINTY "event_uncertainty" "" Table(EVENT.name), Real, None,
        "how far the true value may be";

    BLOCK "block" "1" Dimension, Whole, None,
        "block of cases, the unit in which the study was computed";
    BLOCK_MAKER "block_maker" "1" Table(BLOCK.name), CategoryOfFile, None,
        "program, commit and machine that made the block";
    BLOCK_FIRST_CASE "block_first_case" "1" Table(BLOCK.name), Whole, None,
        "first case of the block, counted from 0 with the last axis fastest";
    BLOCK_CASES "block_cases" "1" Table(BLOCK.name), Whole, None,
        "cases of the block";
}
