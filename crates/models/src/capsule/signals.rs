//! What the capsule says of its motion over time: signals, forces among them, impacts, events and sums.

use super::forces::Forces;
use super::output::Output;
use super::parameters::CapsuleParameters as _;
use super::quantities::{
    HISTORY_CONTACT, HISTORY_DRIVE, HISTORY_FOLDS, HISTORY_FRICTION, HISTORY_PLACE, HISTORY_R,
    HISTORY_REAR_CONTACT, HISTORY_X1, HISTORY_X2, HISTORY_Y1, HISTORY_Y2, IMPACT_PHASE,
    IMPACT_VELOCITY, IMPACT_Y1, IMPACT_Y2, RELATIVE_VELOCITY, VELOCITIES,
};
use super::state::{CapsuleState as _, State};
use crate::description::{
    self, Chart, MotionDescription, Parameters, Signal, SignalGroup, SignalKind,
};
use crate::quantity::Quantity;

/// What is told of an impact.
const IMPACT: &[Quantity] = &[IMPACT_PHASE, IMPACT_Y1, IMPACT_Y2, IMPACT_VELOCITY];

/// What is kept of a motion at each time.
const HISTORIES: &[Quantity] = &[HISTORY_R, HISTORY_Y1, HISTORY_X2, HISTORY_Y2, HISTORY_DRIVE];

/// What a motion has at each time.
const SIGNALS: [Signal; 10] = [
    Signal::of_state(HISTORY_X1, SignalKind::Drifting, |it| {
        let State { r, x2, .. } = it.capsule();
        x2 + r
    }),
    Signal::kept(HISTORY_X2, SignalKind::Drifting, 2),
    Signal::kept(HISTORY_R, SignalKind::Coordinate, 0),
    Signal::kept(HISTORY_Y1, SignalKind::Coordinate, 1),
    Signal::kept(HISTORY_Y2, SignalKind::Coordinate, 3),
    Signal::of_state(RELATIVE_VELOCITY, SignalKind::Coordinate, |it| {
        let State { y1, y2, .. } = it.capsule();
        y1 - y2
    }),
    Signal::kept(HISTORY_DRIVE, SignalKind::Force, 4),
    Signal::force(HISTORY_CONTACT, |parameters, it, kept| forces(parameters, it, kept).contact),
    Signal {
        missing: |parameters| {
            let why = "the friction at rest is not that of the equation as printed";
            (!parameters.switching().balances_at_rest()).then_some(why)
        },
        ..Signal::force(HISTORY_FRICTION, |parameters, it, kept| {
            forces(parameters, it, kept).friction
        })
    },
    Signal {
        missing: |parameters| {
            let has_rear_stop = parameters.shape().has_rear_stop();
            (!has_rear_stop).then_some("the capsule has no rear stop")
        },
        ..Signal::force(HISTORY_REAR_CONTACT, |parameters, it, kept| {
            forces(parameters, it, kept).rear_contact
        })
    },
];

/// What is kept of a motion over folds at each time.
const HISTORIES_OVER_FOLDS: &[Quantity] =
    &[HISTORY_R, HISTORY_Y1, HISTORY_X2, HISTORY_Y2, HISTORY_PLACE, HISTORY_DRIVE];

/// What a motion over folds has at each time.
const SIGNALS_OVER_FOLDS: [Signal; SIGNALS.len() + 2] = {
    let place = Signal::kept(HISTORY_PLACE, SignalKind::Repeating, 4);
    let mut all = [place; SIGNALS.len() + 2];
    let mut index = 0;
    while index < SIGNALS.len() {
        all[index] = SIGNALS[index];
        index += 1;
    }
    all[DRIVE] = Signal::kept(HISTORY_DRIVE, SignalKind::Force, 5);
    all[SIGNALS.len()] =
        Signal::force(HISTORY_FOLDS, |parameters, it, kept| forces(parameters, it, kept).folds);
    all
};

/// The place of the drive among the signals.
const DRIVE: usize = 6;

/// The forces in a state, with the force of the drive as the first that is kept beside its coordinates.
fn forces(parameters: &Parameters, state: &description::State, kept: &[f64]) -> Forces {
    Forces::of(parameters, &state.capsule(), kept[0])
}

/// What the capsule says of its motion over time.
pub(super) const MOTION: MotionDescription = MotionDescription {
    histories: HISTORIES,
    signals: &SIGNALS,
    groups: &[SignalGroup { quantity: VELOCITIES, signals: &[HISTORY_Y1.name, HISTORY_Y2.name] }],
    panels: &[HISTORY_X2.name, HISTORY_R.name, VELOCITIES.name],
    charts: &[
        Chart {
            title: "Displacement",
            signals: &[HISTORY_R.name, HISTORY_X1.name, HISTORY_X2.name],
        },
        Chart { title: "Velocity", signals: &[HISTORY_Y1.name, HISTORY_Y2.name] },
        Chart {
            title: "Force",
            signals: &[
                HISTORY_DRIVE.name,
                HISTORY_CONTACT.name,
                HISTORY_FRICTION.name,
                HISTORY_REAR_CONTACT.name,
            ],
        },
    ],
    portrait: Some([HISTORY_R.name, RELATIVE_VELOCITY.name]),
    impact: IMPACT,
    at_impact: Some(|r, told| State::of([r, told[1], 0.0, told[2]]).into()),
    events: &[
        "contact-closed",
        "contact-opened",
        "slip-forward",
        "slip-backward",
        "stick",
        "reversal",
        "rear-contact-closed",
        "rear-contact-opened",
        "drive-edge",
    ],
    // Those of which the outputs are the parts of a cycle.
    sums: &[
        Output::WorkNet.name(),
        Output::WorkPositive.name(),
        Output::WorkAbsolute.name(),
        Output::WorkActuator.name(),
        Output::FrictionLoss.name(),
        Output::DamperLoss.name(),
    ],
    counts: &["impacts"],
};

/// What a capsule over folds says of its motion over time.
pub(super) const MOTION_OVER_FOLDS: MotionDescription = MotionDescription {
    histories: HISTORIES_OVER_FOLDS,
    signals: &SIGNALS_OVER_FOLDS,
    panels: &[HISTORY_X2.name, HISTORY_PLACE.name, VELOCITIES.name],
    charts: &[
        MOTION.charts[0],
        Chart { title: "Place between folds", signals: &[HISTORY_PLACE.name] },
        MOTION.charts[1],
        Chart {
            title: "Force",
            signals: &[
                HISTORY_DRIVE.name,
                HISTORY_CONTACT.name,
                HISTORY_FRICTION.name,
                HISTORY_FOLDS.name,
                HISTORY_REAR_CONTACT.name,
            ],
        },
    ],
    ..MOTION
};
