//! The entries of what each case has, beside its outputs, and of the dimensions along which it has several.

use super::entry::{Entry, Extent::*, Type::*, entries, shown, words};
use super::flags::{directions, outcomes, proofs, reasons};

/// The dimension of the cases of a block, which in a file of results is replaced by the axes.
pub const CASE: &str = "case";
/// The text of a file that holds the text of the study.
pub const STUDY_TEXT: &str = "study";
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
        "time in drive cycles";
    MULTIPLIER "multiplier" "1" Dimension, Whole, None,
        "Floquet multiplier of the period, the largest magnitude first";

    OUTCOME "outcome" "1" Case, Category(outcomes), words("Outcome", ""),
        "what the case turned out to be";
    PERIOD "period" "1" Case, Whole, words("Period", ""),
        "period in drive cycles, 0 unless periodic";
    CYCLES "cycles" "1" Case, Whole, None,
        "drive cycles followed, measuring included";
    FAILURE_REASON "failure_reason" "1" Case, Category(reasons), None,
        "why the case could not be followed";
    FAILURE_TIME "failure_time" "s" Case, Real, None,
        "time at which the case could not be followed on";
    CERTIFICATE "certificate" "1" Case, Category(proofs), None,
        "how the period was proven";
    MULTIPLIER_REAL "multiplier_real" "1" CaseRow(MULTIPLIER.name), Real, None,
        "real part of a Floquet multiplier of the period";
    MULTIPLIER_IMAG "multiplier_imag" "1" CaseRow(MULTIPLIER.name), Real, None,
        "imaginary part of a Floquet multiplier";
    NEUTRAL_R "neutral_r" "1" Case, Real, None,
        "part of omega r in the direction of the family of a neutral orbit";
    NEUTRAL_Y1 "neutral_y1" "1" Case, Real, None,
        "part of y1 in the direction of the family of a neutral orbit";
    NEUTRAL_Y2 "neutral_y2" "1" Case, Real, None,
        "part of y2 in the direction of the family of a neutral orbit";
    ATTRACTOR "attractor" "1" Case, Whole, None,
        "attractor that the case ends on, by its number, -1 for none";

    SECTION_R "section_r" "m" CaseRow(POINT.name), Real,
        shown("Stroboscopic", "*x*_{1} − *x*_{2}", "mm", 1e3),
        "relative displacement x1 - x2 at the stroboscopic section";
    SECTION_Y1 "section_y1" "m/s" CaseRow(POINT.name), Real,
        shown("Stroboscopic", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass at the stroboscopic section";
    SECTION_Y2 "section_y2" "m/s" CaseRow(POINT.name), Real,
        shown("Stroboscopic", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule at the stroboscopic section";
    IMPACT_PHASE "impact_phase" "rad" CaseRow(IMPACT_POINT.name), Real,
        shown("Impact phase", "*ωt*", "rad", 1.0),
        "phase of the drive at the impact, since the section";
    IMPACT_Y1 "impact_y1" "m/s" CaseRow(IMPACT_POINT.name), Real,
        shown("Impact velocity", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass at the impact";
    IMPACT_Y2 "impact_y2" "m/s" CaseRow(IMPACT_POINT.name), Real,
        shown("Impact velocity", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule at the impact";
    IMPACT_VELOCITY "impact_velocity" "m/s" CaseRow(IMPACT_POINT.name), Real,
        shown("Impact velocity", "*y*_{1} − *y*_{2}", "m/s", 1.0),
        "velocity of the mass relative to the stop at the impact";
    HISTORY_R "history_r" "m" CaseRow(HISTORY_TIME.name), Real,
        shown("", "*x*_{1} − *x*_{2}", "mm", 1e3),
        "relative displacement x1 - x2";
    HISTORY_Y1 "history_y1" "m/s" CaseRow(HISTORY_TIME.name), Real,
        shown("", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass";
    HISTORY_X2 "history_x2" "m" CaseRow(HISTORY_TIME.name), Real,
        shown("", "*x*_{2}", "mm", 1e3),
        "displacement of the capsule";
    HISTORY_Y2 "history_y2" "m/s" CaseRow(HISTORY_TIME.name), Real,
        shown("", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule";
    HISTORY_DRIVE "history_drive" "N" CaseRow(HISTORY_TIME.name), Real,
        shown("Drive", "*p*_{d} cos *ωt*", "N", 1.0),
        "force of the drive";

    END_R "end_r" "m" Block, Real, None,
        "relative displacement at the end of the case";
    END_Y1 "end_y1" "m/s" Block, Real, None,
        "velocity of the mass at the end of the case";
    END_Y2 "end_y2" "m/s" Block, Real, None,
        "velocity of the capsule at the end of the case";
    RESIDUAL "residual" "1" Block, Real, None,
        "how far the section of a periodic orbit is from repeating, relative to the motion";

    TIME "time" "s" Derived, Real, words("Time", "s"),
        "time since the history begins";
    HISTORY_X1 "history_x1" "m" Derived, Real,
        shown("", "*x*_{1}", "mm", 1e3),
        "displacement of the mass";
    HISTORY_CONTACT "history_contact" "N" Derived, Real, words("Contact force", "N"),
        "force of the stop on the mass";
    HISTORY_FRICTION "history_friction" "N" Derived, Real, words("Friction", "N"),
        "force of the friction on the capsule, against its motion";
    SPECTRUM_FREQUENCY "spectrum_frequency" "rad/s" Derived, Real,
        shown("Frequency", "", "Hz", 0.5 * std::f64::consts::FRAC_1_PI),
        "frequency of a part of a spectrum";
    VELOCITIES "velocities" "m/s" Derived, Real, shown("", "*y*_{1}, *y*_{2}", "m/s", 1.0),
        "velocities of the mass and of the capsule";
    RELATIVE_VELOCITY "relative_velocity" "m/s" Derived, Real,
        shown("", "*y*_{1} − *y*_{2}", "m/s", 1.0),
        "velocity of the mass less that of the capsule";
}

/// The coordinates of a section point.
pub const SECTION: [Entry; 3] = [SECTION_R, SECTION_Y1, SECTION_Y2];
/// The parts of the direction of the family of a neutral orbit.
pub const NEUTRAL: [Entry; 3] = [NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2];
/// Where a case ended.
pub const END: [Entry; 3] = [END_R, END_Y1, END_Y2];
