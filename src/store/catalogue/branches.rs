//! The entries of the branches, their special points and their curves.

use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::{codim2_kinds, ends, pair_states, request_kinds, specials, stabilities};

/// The text of a file that names the branches of the study, one a line.
pub const BRANCH_NAMES: &str = "branch_names";

entries! {
    REQUEST "branch_request" "1" Dimension, Whole, None,
        "branch that the study asks for";
    REQUEST_RESULT "request_result" "1" Table(REQUEST.name), CategoryOfFile, None,
        "what came of the branch";
    REQUEST_ALONG "request_along" "1" Table(REQUEST.name), CategoryOfFile, None,
        "parameter that is followed";
    REQUEST_PHASE "request_phase" "rad" Table(REQUEST.name), Real, None,
        "phase of the drive at the section";

    REQUEST_KIND "request_kind" "1" Table(REQUEST.name), Category(request_kinds), None,
        "whether the study asks for the branch, or it leads from a case of its map over a boundary to its neighbour";

    INDEX "branch_index" "1" Dimension, Whole, None,
        "branch that was followed";
    INDEX_REQUEST "index_request" "1" Table(INDEX.name), Whole, None,
        "branch of the study that led here";
    INDEX_ALONG "index_along" "1" Table(INDEX.name), CategoryOfFile, None,
        "parameter that is followed";
    INDEX_PERIOD "index_period" "1" Table(INDEX.name), Whole, None,
        "period of its orbits in cycles";
    INDEX_PARENT "index_parent" "1" Table(INDEX.name), Whole, None,
        "branch that it left at a period doubling, or -1";
    INDEX_PARENT_SPECIAL "index_parent_special" "1" Table(INDEX.name), Whole, None,
        "special point where it left, or -1";
    INDEX_END_FIRST "index_end_first" "1" Table(INDEX.name), Category(ends), None,
        "why the branch ends at its first point";
    INDEX_END_LAST "index_end_last" "1" Table(INDEX.name), Category(ends), None,
        "why the branch ends at its last point";

    BRANCH_POINT "branch_point" "1" Dimension, Whole, None,
        "point of the branches, one branch after the other";
    BRANCH_CYCLE "branch_cycle" "1" Dimension, Whole, None,
        "cycle within the period";
    BRANCH_MULTIPLIER "branch_multiplier" "1" Dimension, Whole, None,
        "Floquet multiplier, the largest magnitude first";
    BRANCH "branch" "1" Table(BRANCH_POINT.name), Whole, None,
        "branch that the orbit is on";
    BRANCH_PERIOD "branch_period" "1" Table(BRANCH_POINT.name), Whole, None,
        "period in cycles";
    BRANCH_STABLE "branch_stable" "1" Table(BRANCH_POINT.name), Category(stabilities), None,
        "whether neighbours approach the orbit";
    BRANCH_RESIDUAL "branch_residual" "1" Table(BRANCH_POINT.name), Real, None,
        "how far the section is from repeating, relative to the motion";
    BRANCH_SEQUENCE "branch_sequence" "1" Table(BRANCH_POINT.name), Whole, None,
        "which sequence of events of its branch";
    BRANCH_MULTIPLIER_REAL "branch_multiplier_real" "1"
        TableRow(BRANCH_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "real part of the Floquet multipliers of the period";
    BRANCH_MULTIPLIER_IMAG "branch_multiplier_imag" "1"
        TableRow(BRANCH_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "imaginary part of the Floquet multipliers of the period";

    SPECIAL_POINT "special_point" "1" Dimension, Whole, None,
        "special point of the branches, one branch after the other";
    SPECIAL_KIND "special_kind" "1" Table(SPECIAL_POINT.name), Category(specials), None,
        "what happens at the special point";
    SPECIAL_AFTER "special_after" "1" Table(SPECIAL_POINT.name), Whole, None,
        "point of the branch that it comes after";
    SPECIAL_CURVE "special_curve" "1" Table(SPECIAL_POINT.name), Whole, None,
        "curve that goes through it, or -1";
    SPECIAL_BRANCH "special_branch" "1" Table(SPECIAL_POINT.name), Whole, None,
        "branch that the orbit is on";
    SPECIAL_PERIOD "special_period" "1" Table(SPECIAL_POINT.name), Whole, None,
        "period in cycles";
    SPECIAL_STABLE "special_stable" "1" Table(SPECIAL_POINT.name), Category(stabilities), None,
        "whether neighbours approach the orbit";
    SPECIAL_RESIDUAL "special_residual" "1" Table(SPECIAL_POINT.name), Real, None,
        "how far the section is from repeating, relative to the motion";
    SPECIAL_SEQUENCE "special_sequence" "1" Table(SPECIAL_POINT.name), Whole, None,
        "which sequence of events of its branch";
    SPECIAL_MULTIPLIER_REAL "special_multiplier_real" "1"
        TableRow(SPECIAL_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "real part of the Floquet multipliers of the period";
    SPECIAL_MULTIPLIER_IMAG "special_multiplier_imag" "1"
        TableRow(SPECIAL_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "imaginary part of the Floquet multipliers of the period";

    CURVE_INDEX "curve_index" "1" Dimension, Whole, None,
        "curve in two parameters";
    CURVE_END_FIRST "curve_end_first" "1" Table(CURVE_INDEX.name), Category(ends), None,
        "why the curve ends at its first point";
    CURVE_END_LAST "curve_end_last" "1" Table(CURVE_INDEX.name), Category(ends), None,
        "why the curve ends at its last point";
    CURVE_POINT "curve_point" "1" Dimension, Whole, None,
        "point of the curves, one curve after the other";
    CURVE "curve" "1" Table(CURVE_POINT.name), Whole, None,
        "curve in two parameters";
    CURVE_KIND "curve_kind" "1" Table(CURVE_POINT.name), Category(specials), None,
        "what happens on the curve";
    CURVE_PERIOD "curve_period" "1" Table(CURVE_POINT.name), Whole, None,
        "period of its orbits in cycles";
    CURVE_THROUGH "curve_through" "1" Table(CURVE_POINT.name), Whole, None,
        "special point that it was followed from";

    CODIM2_POINT "codim2_point" "1" Dimension, Whole, None,
        "point of codimension 2 on the curves, one curve after the other";
    CODIM2_KIND "codim2_kind" "1" Table(CODIM2_POINT.name), Category(codim2_kinds), None,
        "what happens at the point of codimension 2";
    CODIM2_CURVE "codim2_curve" "1" Table(CODIM2_POINT.name), Whole, None,
        "curve that it lies on";
    CODIM2_AFTER "codim2_after" "1" Table(CODIM2_POINT.name), Whole, None,
        "point of the curve that it comes after";
    CODIM2_PERIOD "codim2_period" "1" Table(CODIM2_POINT.name), Whole, None,
        "period of its orbit in cycles";
    CODIM2_MULTIPLIER_REAL "codim2_multiplier_real" "1"
        TableRow(CODIM2_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "real part of the Floquet multipliers of the period";
    CODIM2_MULTIPLIER_IMAG "codim2_multiplier_imag" "1"
        TableRow(CODIM2_POINT.name, BRANCH_MULTIPLIER.name), Real, None,
        "imaginary part of the Floquet multipliers of the period";

    BOUNDARY_STATE "boundary_state" "1" Dimension, Whole, None,
        "what is known of two neighbouring cases of a map whose motions are of two kinds, by period and impacts, of which one at least repeats";
    BOUNDARY_STATE_NAME "boundary_state_name" "1" Table(BOUNDARY_STATE.name), Category(pair_states), None,
        "name of what is known";
    BOUNDARY_PAIRS "boundary_pairs" "1" Table(BOUNDARY_STATE.name), Whole, None,
        "pairs of neighbouring cases of which it is known";
    BOUNDARY_TRIES "boundary_tries" "1" Table(BOUNDARY_STATE.name), Whole, None,
        "those of them between which the orbits of both were continued to find a boundary";
}

/// The dimensions of the branches, in the order of files.
pub const OF_BRANCHES: [Entry; 10] = [
    REQUEST,
    INDEX,
    BRANCH_POINT,
    BRANCH_CYCLE,
    BRANCH_MULTIPLIER,
    SPECIAL_POINT,
    CURVE_INDEX,
    CURVE_POINT,
    CODIM2_POINT,
    BOUNDARY_STATE,
];

/// The columns of every orbit on a branch that are called after no variable of the cases.
#[derive(Debug, Clone, Copy)]
pub struct OrbitColumns {
    /// The branch that the orbit is on.
    pub branch: Entry,
    /// Its period.
    pub period: Entry,
    /// Whether it is stable.
    pub stable: Entry,
    /// How far its section is from repeating.
    pub residual: Entry,
    /// Its sequence of events.
    pub sequence: Entry,
    /// The real and the imaginary parts of its Floquet multipliers.
    pub multipliers: [Entry; 2],
}

/// The orbits at the points of the branches.
pub const AT_BRANCH_POINTS: OrbitColumns = OrbitColumns {
    branch: BRANCH,
    period: BRANCH_PERIOD,
    stable: BRANCH_STABLE,
    residual: BRANCH_RESIDUAL,
    sequence: BRANCH_SEQUENCE,
    multipliers: [BRANCH_MULTIPLIER_REAL, BRANCH_MULTIPLIER_IMAG],
};

/// The orbits at the special points.
pub const AT_SPECIAL_POINTS: OrbitColumns = OrbitColumns {
    branch: SPECIAL_BRANCH,
    period: SPECIAL_PERIOD,
    stable: SPECIAL_STABLE,
    residual: SPECIAL_RESIDUAL,
    sequence: SPECIAL_SEQUENCE,
    multipliers: [SPECIAL_MULTIPLIER_REAL, SPECIAL_MULTIPLIER_IMAG],
};
