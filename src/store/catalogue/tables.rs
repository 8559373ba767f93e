//! The entries of the tables beside the cases: attractors of starts, events of attractors, and blocks.

use super::cases::MULTIPLIER;
use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::{outcomes, proofs, specials};
use crate::quantity::shown::shown;

entries! {
    ATTRACTOR_INDEX "attractor_index" "1" Dimension, Whole, None,
        "attractor of the starts of the study";
    ATTRACTOR_CYCLE "attractor_cycle" "1" Dimension, Whole, None,
        "cycle of the period of an attractor";
    ATTRACTOR_KIND "attractor_kind" "1" Table(ATTRACTOR_INDEX.name), Category(outcomes), None,
        "what the attractor is";
    ATTRACTOR_PERIOD "attractor_period" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "period of the attractor in cycles, 0 unless periodic";
    ATTRACTOR_CERTIFICATE "attractor_certificate" "1" Table(ATTRACTOR_INDEX.name), Category(proofs), None,
        "how the period of the attractor was verified";
    ATTRACTOR_CASE "attractor_case" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "first case of the attractor, counted from 0 with the last axis fastest, which the table tells of";
    ATTRACTOR_CASES "attractor_cases" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "cases that lead to the attractor";
    ATTRACTOR_SHARE "attractor_share" "1" Table(ATTRACTOR_INDEX.name), Real,
        shown("Share of the starts", "", "%", 100.0),
        "share of the cases that lead to the attractor, among all that have been computed or inferred";
    ATTRACTOR_SHARE_ERROR "attractor_share_error" "1" Table(ATTRACTOR_INDEX.name), Real, None,
        "standard error of the share: of a grid by the cells beside the boundary, not a number where starts are missing; of draws that of a binomial, not a number of a design";
    ATTRACTOR_SHARE_LOW "attractor_share_low" "1" Table(ATTRACTOR_INDEX.name), Real, None,
        "lower end of Wilson's interval of the share at 95 percent";
    ATTRACTOR_SHARE_HIGH "attractor_share_high" "1" Table(ATTRACTOR_INDEX.name), Real, None,
        "upper end of Wilson's interval of the share at 95 percent";
    ATTRACTOR_MINIMAL_CRITICAL_SHOCK "attractor_minimal_critical_shock" "m/s" Table(ATTRACTOR_INDEX.name), Real,
        shown("Distance to a boundary", "", "m/s", 1.0),
        "smallest disturbance at a section point of the attractor that is found to lead to another attractor";
    ATTRACTOR_INTEGRITY_FACTOR "attractor_integrity_factor" "m/s" Table(ATTRACTOR_INDEX.name), Real,
        shown("Distance to a boundary", "", "m/s", 1.0),
        "radius of the largest ball of starts of the grid that all lead to the attractor";
    ATTRACTOR_INTEGRITY_ERROR "attractor_integrity_error" "m/s" Table(ATTRACTOR_INDEX.name), Real, None,
        "diagonal of a cell of the grid, by which a boundary may be nearer than the integrity factor says";
    ATTRACTOR_CYCLES_MEAN "attractor_cycles_mean" "1" Table(ATTRACTOR_INDEX.name), Real, None,
        "mean number of cycles for which the starts of the attractor were followed until it was decided";
    ATTRACTOR_CYCLES_MEDIAN "attractor_cycles_median" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "number of cycles within which half of the starts of the attractor were decided";
    ATTRACTOR_CYCLES_90 "attractor_cycles_90" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "number of cycles within which 90 percent of the starts of the attractor were decided";
    ATTRACTOR_CYCLES_99 "attractor_cycles_99" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "number of cycles within which 99 percent of the starts of the attractor were decided";
    ATTRACTOR_CYCLES_MOST "attractor_cycles_most" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "largest number of cycles for which a start of the attractor was followed until it was decided";
    ATTRACTOR_MULTIPLIER_REAL "attractor_multiplier_real" "1"
        TableRow(ATTRACTOR_INDEX.name, MULTIPLIER.name), Real, None,
        "real part of a Floquet multiplier of the attractor";
    ATTRACTOR_MULTIPLIER_IMAG "attractor_multiplier_imag" "1"
        TableRow(ATTRACTOR_INDEX.name, MULTIPLIER.name), Real, None,
        "imaginary part of a Floquet multiplier of the attractor";

    SETTLED_STEP "settled_step" "1" Dimension, Whole, None,
        "number of cycles after which it is told which starts have settled, the least first";
    SETTLED_CYCLES "settled_cycles" "1" Table(SETTLED_STEP.name), Whole, None,
        "cycles from the start on";
    SETTLED_SHARE "settled_share" "1" TableRow(SETTLED_STEP.name, ATTRACTOR_INDEX.name), Real, None,
        "share of all starts that were followed which have been decided to lead to the attractor within these cycles";
    SETTLED_NEVER "settled_never" "1" Once, Whole, None,
        "starts that were followed and lead to no known attractor, which never count as settled";

    INFERRED_SAMPLE "inferred_sample" "1" Once, Whole, None,
        "inferred cases that were computed as a check";
    INFERRED_ELSEWHERE "inferred_elsewhere" "1" Once, Whole, None,
        "those of the sample that lead to another attractor than was inferred, or whose period or outputs differ more than the study allows";

    EDGE_INDEX "edge_index" "1" Dimension, Whole, None,
        "saddle on the boundary of two basins";
    EDGE_CYCLE "edge_cycle" "1" Dimension, Whole, None,
        "cycle of the period of a saddle";
    EDGE_LOW "edge_attractor_low" "1" Table(EDGE_INDEX.name), Whole, None,
        "one of the two attractors whose basins the saddle lies between, that of the lower number";
    EDGE_HIGH "edge_attractor_high" "1" Table(EDGE_INDEX.name), Whole, None,
        "the other";
    EDGE_PERIOD "edge_period" "1" Table(EDGE_INDEX.name), Whole, None,
        "period of the saddle in cycles";
    EDGE_RESIDUAL "edge_residual" "1" Table(EDGE_INDEX.name), Real, None,
        "how far the section is from repeating after the period of the saddle, relative to the motion";
    EDGE_MULTIPLIER_REAL "edge_multiplier_real" "1"
        TableRow(EDGE_INDEX.name, MULTIPLIER.name), Real, None,
        "real part of a Floquet multiplier of the saddle";
    EDGE_MULTIPLIER_IMAG "edge_multiplier_imag" "1"
        TableRow(EDGE_INDEX.name, MULTIPLIER.name), Real, None,
        "imaginary part of a Floquet multiplier of the saddle";

    BASIN_ENTROPY "basin_entropy" "1" Once, Real, None,
        "basin entropy: mean entropy of the attractors of the starts in a box, in nat";
    BASIN_ENTROPY_ERROR "basin_entropy_error" "1" Once, Real, None,
        "standard error of the basin entropy";
    BOUNDARY_BASIN_ENTROPY "boundary_basin_entropy" "1" Once, Real, None,
        "the same over the boxes that a boundary crosses";
    BOUNDARY_BASIN_ENTROPY_ERROR "boundary_basin_entropy_error" "1" Once, Real, None,
        "standard error of the boundary basin entropy";
    BASIN_ENTROPY_BOX "basin_entropy_box" "1" Once, Whole, None,
        "starts along each side of a box of the basin entropy";
    UNCERTAINTY_EXPONENT "uncertainty_exponent" "1" Once, Real, None,
        "exponent by which the share of boxes that a boundary crosses falls with their size";
    UNCERTAINTY_EXPONENT_ERROR "uncertainty_exponent_error" "1" Once, Real, None,
        "error of the uncertainty exponent, which covers what the local slopes drift";
    BOUNDARY_DIMENSION "boundary_dimension" "1" Once, Real, None,
        "dimension of the boundary of the basins: the axes less the uncertainty exponent";
    UNCERTAINTY_SCALES "uncertainty_scales" "1" Once, Whole, None,
        "1 where one exponent describes all sizes of boxes, 0 where local slopes differ by more than their errors: no power law";
    UNCERTAINTY_SIZE "uncertainty_size" "1" Dimension, Whole, None,
        "size of the boxes that a boundary may cross, the smallest first";
    UNCERTAINTY_SPAN "uncertainty_span" "1" Table(UNCERTAINTY_SIZE.name), Whole, None,
        "how far apart the ends of a box are along an axis, in starts";
    UNCERTAINTY_BOXES "uncertainty_boxes" "1" Table(UNCERTAINTY_SIZE.name), Whole, None,
        "boxes of the size";
    UNCERTAINTY_CROSSED "uncertainty_crossed" "1" Table(UNCERTAINTY_SIZE.name), Whole, None,
        "those that a boundary crosses";
    UNCERTAINTY_SLOPE "uncertainty_slope" "1" Table(UNCERTAINTY_SIZE.name), Real, None,
        "local slope: the uncertainty exponent between the size and the next that a boundary crosses";
    UNCERTAINTY_SLOPE_ERROR "uncertainty_slope_error" "1" Table(UNCERTAINTY_SIZE.name), Real, None,
        "statistical error of the local slope, by leaving out slabs of the grid";

    WADA_PAIR "wada_pair" "1" Dimension, Whole, None,
        "boundary of a basin beside that of another";
    WADA_SCALE "wada_scale" "1" Dimension, Whole, None,
        "radius to within which boundaries are compared, the smallest first";
    WADA_BOUNDARY "wada_boundary" "1" Table(ATTRACTOR_INDEX.name), Whole, None,
        "starts on the boundary between the basin of the attractor and all others merged";
    WADA_OF "wada_of" "1" Table(WADA_PAIR.name), Whole, None,
        "attractor whose boundary is looked at";
    WADA_FROM "wada_from" "1" Table(WADA_PAIR.name), Whole, None,
        "attractor from whose boundary distances are told";
    WADA_DISTANCE "wada_distance" "1" Table(WADA_PAIR.name), Real, None,
        "largest Euclidean distance of a start on the one boundary from the other, in starts along the axes";
    WADA_PAIR_FARTHER "wada_pair_farther" "1" TableRow(WADA_PAIR.name, WADA_SCALE.name), Real, None,
        "share of the starts on the one boundary that are farther from the other than the radius";
    WADA_RADIUS "wada_radius" "1" Table(WADA_SCALE.name), Whole, None,
        "radius in starts along the axes";
    WADA_FARTHER "wada_farther" "1" Table(WADA_SCALE.name), Real, None,
        "largest share of a boundary that is farther from another one than the radius: 0 where the basins are Wada to within it";
    WADA_COVERED "wada_covered" "1" Table(WADA_SCALE.name), Real, None,
        "largest share of all starts that are within the radius of one boundary: near 1 the radius tells nothing";
    WADA_LEAST_RADIUS "wada_least_radius" "1" Once, Whole, None,
        "least of the radii to within which all basins have one boundary, 0 where none is";
    WADA_UNKNOWN "wada_unknown" "1" Once, Whole, None,
        "starts without a known attractor, beside which no boundary is told";

    EVENT "event" "1" Dimension, Whole, None,
        "event of an attractor";
    EVENT_KIND "event_kind" "1" Table(EVENT.name), Category(specials), None,
        "what happens to the attractor";
    EVENT_ATTRACTOR "event_attractor" "1" Table(EVENT.name), Whole, None,
        "attractor of the event";
    EVENT_PERIOD "event_period" "1" Table(EVENT.name), Whole, None,
        "period of the orbit that changes, in cycles";
    EVENT_PLACE "event_place" "1" Table(EVENT.name), Real, None,
        "place along the path, counted from 0, with the share of the way to the next";
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
