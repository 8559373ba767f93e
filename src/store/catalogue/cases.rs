//! The entries of what each case has, beside its outputs, and of the dimensions along which it has several.

use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::{directions, outcomes, proofs};
use crate::quantity::shown::{shown, words};

/// The dimension of the cases of a block, which in a file of results is replaced by the axes.
pub const CASE: &str = "case";
/// The text of a file that holds the text of the study.
pub const STUDY_TEXT: &str = "study";
/// The text of a file that holds the tables of the system of the study, where that is a text.
pub const SYSTEM_TEXT: &str = "system";
/// The text of a file that holds the table of the outputs that the study defines, where it does.
pub const OWN_TEXT: &str = "own_outputs";
/// The attribute of a file that names the axis along which attractors are numbered.
pub const ATTRACTOR_AXIS: &str = "attractor_axis";

entries! {
    DIRECTION "direction" "1" Study, Category(directions), None,
        "direction in which the attractor was followed";
    DRAW "draw" "1" Study, Whole, None,
        "number of the draw";
    POINT "point" "1" Dimension, Whole, None,
        "point of the section";
    IMPACT_POINT "impact_point" "1" Dimension, Whole, None,
        "point of the impact section";
    HISTORY_TIME "history_time" "1" Dimension, Real, None,
        "time in cycles";
    MULTIPLIER "multiplier" "1" Dimension, Whole, None,
        "Floquet multiplier of the period, the largest magnitude first";

    OUTCOME "outcome" "1" Case, Category(outcomes), words("Outcome", ""),
        "what the case turned out to be";
    PERIOD "period" "1" Case, Whole, words("Period", ""),
        "period in cycles, 0 unless periodic";
    CYCLES "cycles" "1" Case, Whole, None,
        "cycles followed, measuring included";
    FAILURE_REASON "failure_reason" "1" Case, CategoryOfFile, None,
        "why the case could not be followed";
    FAILURE_TIME "failure_time" "s" Case, Real, None,
        "time at which the case could not be followed on";
    CERTIFICATE "certificate" "1" Case, Category(proofs), None,
        "how the period was verified";
    MULTIPLIER_REAL "multiplier_real" "1" CaseRow(MULTIPLIER.name), Real, None,
        "real part of a Floquet multiplier of the period";
    MULTIPLIER_IMAG "multiplier_imag" "1" CaseRow(MULTIPLIER.name), Real, None,
        "imaginary part of a Floquet multiplier";
    ATTRACTOR "attractor" "1" Case, Whole, None,
        "attractor that the case ends on, by its number, -1 for none";

    RESIDUAL "residual" "1" Block, Real, None,
        "how far the section of a periodic orbit is from repeating, relative to the motion";

    TIME "time" "s" Derived, Real, words("Time", "s"),
        "time since the history begins";
    SPECTRUM_FREQUENCY "spectrum_frequency" "rad/s" Derived, Real,
        shown("Frequency", "", "Hz", 0.5 * std::f64::consts::FRAC_1_PI),
        "frequency of a part of a spectrum";
}
