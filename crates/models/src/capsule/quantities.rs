//! The quantities of the capsule beside its parameters and outputs: of its starts, sections, impacts and histories.

use crate::quantity::shown::{shown, words};
use crate::quantity::{Dimension, Quantity};

/// Quantities as constants: constant, name, dimension and shown form in a first line, the meaning in a second.
macro_rules! quantities {
    ($($constant:ident $name:literal $dimension:ident, $shown:expr, $meaning:literal;)*) => {
        $(
            #[doc = concat!("`", $name, "`: ", $meaning, ".")]
            pub const $constant: Quantity = Quantity {
                name: $name,
                dimension: Dimension::$dimension,
                meaning: $meaning,
                shown: $shown,
            };
        )*
    };
}

quantities! {
    START_R "start_r" Length, shown("Initial", "*x*_{1} − *x*_{2}", "mm", 1e3),
        "relative displacement at the start";
    START_Y1 "start_y1" Velocity, shown("Initial", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass at the start";
    START_X2 "start_x2" Length, shown("Initial", "*x*_{2}", "mm", 1e3),
        "displacement of the capsule at the start";
    START_Y2 "start_y2" Velocity, shown("Initial", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule at the start";

    START_PLACE "start_place" Number, words("Initial place between folds", ""),
        "place of the capsule between two folds at the start, in spacings";

    NEUTRAL_R "neutral_r" Number, None,
        "part of omega r in the direction of the family of a neutral orbit";
    NEUTRAL_Y1 "neutral_y1" Number, None,
        "part of y1 in the direction of the family of a neutral orbit";
    NEUTRAL_Y2 "neutral_y2" Number, None,
        "part of y2 in the direction of the family of a neutral orbit";
    NEUTRAL_PLACE "neutral_place" Number, None,
        "part of omega x2 in the direction of the family of a neutral orbit";

    SECTION_R "section_r" Length, shown("Stroboscopic", "*x*_{1} − *x*_{2}", "mm", 1e3),
        "relative displacement x1 - x2 at the stroboscopic section";
    SECTION_Y1 "section_y1" Velocity, shown("Stroboscopic", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass at the stroboscopic section";
    SECTION_Y2 "section_y2" Velocity, shown("Stroboscopic", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule at the stroboscopic section";
    SECTION_PLACE "section_place" Number, words("Stroboscopic place between folds", ""),
        "place of the capsule between two folds at the stroboscopic section, in spacings from a top on";
    IMPACT_PHASE "impact_phase" Angle, shown("Impact phase", "*ωt*", "rad", 1.0),
        "phase of the drive at the impact, since the section";
    IMPACT_Y1 "impact_y1" Velocity, shown("Impact velocity", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass at the impact";
    IMPACT_Y2 "impact_y2" Velocity, shown("Impact velocity", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule at the impact";
    IMPACT_VELOCITY "impact_velocity" Velocity, shown("Impact velocity", "*y*_{1} − *y*_{2}", "m/s", 1.0),
        "velocity of the mass relative to the stop at the impact";

    HISTORY_R "history_r" Length, shown("", "*x*_{1} − *x*_{2}", "mm", 1e3),
        "relative displacement x1 - x2";
    HISTORY_Y1 "history_y1" Velocity, shown("", "*y*_{1}", "m/s", 1.0),
        "velocity of the mass";
    HISTORY_X2 "history_x2" Length, shown("", "*x*_{2}", "mm", 1e3),
        "displacement of the capsule";
    HISTORY_Y2 "history_y2" Velocity, shown("", "*y*_{2}", "m/s", 1.0),
        "velocity of the capsule";
    HISTORY_PLACE "history_place" Number, words("Place between folds", ""),
        "place of the capsule between two folds, in spacings from a top on";
    HISTORY_DRIVE "history_drive" Force, words("Force of the drive", "N"),
        "force of the drive";
    HISTORY_X1 "history_x1" Length, shown("", "*x*_{1}", "mm", 1e3),
        "displacement of the mass";
    HISTORY_CONTACT "history_contact" Force, words("Contact force", "N"),
        "force of the stop on the mass";
    HISTORY_REAR_CONTACT "history_rear_contact" Force, words("Force of the rear stop", "N"),
        "force of the rear stop on the mass, forward positive";
    HISTORY_FRICTION "history_friction" Force, words("Friction", "N"),
        "force of the friction on the capsule, against its motion";
    HISTORY_FOLDS "history_folds" Force, words("Force of the folds", "N"),
        "force of the folds on the capsule, forward positive";
    VELOCITIES "velocities" Velocity, shown("", "*y*_{1}, *y*_{2}", "m/s", 1.0),
        "velocities of the mass and of the capsule";
    RELATIVE_VELOCITY "relative_velocity" Velocity, shown("", "*y*_{1} − *y*_{2}", "m/s", 1.0),
        "velocity of the mass less that of the capsule";

    EDGE_SECTION_R "edge_section_r" Length, None,
        "relative displacement x1 - x2 of the saddle at the stroboscopic section";
    EDGE_SECTION_Y1 "edge_section_y1" Velocity, None,
        "velocity of the mass on the saddle at the stroboscopic section";
    EDGE_SECTION_Y2 "edge_section_y2" Velocity, None,
        "velocity of the capsule on the saddle at the stroboscopic section";
    EDGE_SECTION_PLACE "edge_section_place" Number, None,
        "place of the capsule between two folds on the saddle at the stroboscopic section, in spacings";

    END_R "end_r" Length, None,
        "relative displacement at the end of the case";
    END_Y1 "end_y1" Velocity, None,
        "velocity of the mass at the end of the case";
    END_Y2 "end_y2" Velocity, None,
        "velocity of the capsule at the end of the case";
    END_PLACE "end_place" Number, None,
        "place of the capsule between two folds at the end of the case, in spacings";
}
