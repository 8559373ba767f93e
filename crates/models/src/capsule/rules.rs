//! What the capsule says of its parameters beside each other: what has no effect, what cannot be, and which member of the family it is.

use super::friction_rules::{complete, idle_static_friction, missing, no_effect_below};
use super::general::balance::Balance;
use super::general::edge_at;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::resistance::Switching;
use super::shape::{DriveKind, Reaction, Release};
use crate::description::{self, Parameters, Remark, Rules};

/// What the capsule says of values beside each other.
pub const RULES: Rules =
    Rules { no_effect, no_effect_below, remarks, conflicts, member, missing, complete };

/// Why a parameter has no effect by what is chosen and given.
fn no_effect(parameters: &Parameters, parameter: description::Parameter) -> Option<String> {
    parameters.shape().no_effect(Parameter::which(parameter))
}

/// That static friction is too small to have an effect, and that nothing holds the mean force.
fn remarks(parameters: &Parameters) -> Vec<Remark> {
    let own = [
        idle_static_friction(parameters),
        runaway(parameters),
        idle_reaction(parameters),
        idle_release(parameters),
        idle_folds(parameters),
    ];
    own.into_iter().flatten().collect()
}

/// That a prescribed relative motion acts on the capsule whatever is said of its reaction.
fn idle_reaction(parameters: &Parameters) -> Option<Remark> {
    let shape = parameters.shape();
    let is_idle = shape.reaction == Reaction::Capsule && shape.drive.is_prescribed();
    is_idle.then(|| Remark {
        about: Vec::new(),
        text: format!(
            "drive_reaction = \"capsule\" has no effect: the mass acts on the capsule in any case where its relative motion is `{}`",
            shape.drive.name()
        ),
    })
}

/// That stops without damping are left where their force falls to zero in any case.
fn idle_release(parameters: &Parameters) -> Option<Remark> {
    let shape = parameters.shape();
    let is_idle = shape.release == Release::Force && !shape.releases_by_force();
    is_idle.then(|| Remark {
        about: described(&[Parameter::K2Damping, Parameter::K3Damping]),
        text: "release = \"force\" has no effect: no stop that acts has a damping".to_owned(),
    })
}

/// That a way whose folds neither resist nor push is even.
fn idle_folds(parameters: &Parameters) -> Option<Remark> {
    let about = [Parameter::FoldFriction, Parameter::FoldForce];
    let is_idle = parameters.shape().over_folds && about.iter().all(|it| parameters[*it] == 0.0);
    is_idle.then(|| Remark {
        about: described(&about),
        text: "fold_friction = 0 and fold_force = 0: the folds have no effect".to_owned(),
    })
}

/// These parameters, as a remark is about them.
fn described(parameters: &[Parameter]) -> Vec<description::Parameter> {
    parameters.iter().map(|it| (*it).into()).collect()
}

/// That the capsule accelerates for ever once it slides on.
fn runaway(parameters: &Parameters) -> Option<Remark> {
    if !parameters.form().is_of_family() {
        return None;
    }
    let balance = Balance::of(parameters);
    let Balance { mean, sliding, break_away, .. } = balance;
    let about = described(&[
        Parameter::Pd,
        Parameter::P0,
        Parameter::PLow,
        Parameter::Duty,
        Parameter::Incline,
        Parameter::Load,
        Parameter::MuD,
        Parameter::MuDForward,
        Parameter::MuDBackward,
    ]);
    let exceeds = format!(
        "the mean force along the ground, {mean:.4} N, exceeds the friction of fast sliding, {sliding:.4} N"
    );
    let text = match mean.abs() > break_away {
        true => format!(
            "{exceeds}, and what holds the capsule at rest: it accelerates for ever, and its case fails as `runaway`"
        ),
        false => format!(
            "{exceeds}, though not the force at which rest ends, {break_away:.4} N: a capsule that gets fast accelerates for ever, and its \
             case fails as `runaway`"
        ),
    };
    (!balance.holds()).then_some(Remark { about, text })
}

/// What cannot be computed, with the drive at `phase` at the section [rad].
fn conflicts(parameters: &Parameters, phase: f64) -> Vec<Remark> {
    let conflicts = [
        as_printed(parameters),
        long_edges(parameters),
        long_phases(parameters),
        on_edge(parameters, phase),
    ];
    conflicts.into_iter().flatten().collect()
}

/// That the equation as printed has no other members.
fn as_printed(parameters: &Parameters) -> Option<Remark> {
    let is_member = parameters.shape().is_member();
    let is_printed = parameters.switching() == Switching::AsPrinted;
    let text = "the reading `as-printed` knows a harmonic drive, one stop and even ground without folds alone; the family of capsules has the reading `filippov`";
    let about = parameters.stated().map(|(it, _)| it).filter(|it| parameters.is_given(*it));
    (is_member && is_printed).then(|| Remark { about: about.collect(), text: text.to_owned() })
}

/// That the edges of a pulse do not fit into the period.
fn long_edges(parameters: &Parameters) -> Option<Remark> {
    let [duty, rise] = [Parameter::Duty, Parameter::Rise].map(|it| parameters[it]);
    let is_long = parameters.shape().drive == DriveKind::Trapezoid && rise > duty.min(1.0 - duty);
    is_long.then(|| Remark {
        about: described(&[Parameter::Rise, Parameter::Duty]),
        text: format!(
            "rise = {rise} with duty = {duty}: an edge must be no longer than the pulse and than what is left of the period"
        ),
    })
}

/// That two of three phases leave none of the period for the third.
fn long_phases(parameters: &Parameters) -> Option<Remark> {
    let [first, second] = [Parameter::Share1, Parameter::Share2].map(|it| parameters[it]);
    let is_long = parameters.shape().drive == DriveKind::ThreePhase && first + second >= 1.0;
    is_long.then(|| Remark {
        about: described(&[Parameter::Share1, Parameter::Share2]),
        text: format!(
            "share_1 = {first} with share_2 = {second}: together they must be below 1, as the third phase is what is left of the period"
        ),
    })
}

/// That a section lies on an edge of the drive which other parameters move, or at which the velocity jumps.
fn on_edge(parameters: &Parameters, phase: f64) -> Option<Remark> {
    let edge = edge_at(parameters, phase)?;
    let allowed = match parameters.shape().drive {
        DriveKind::TwoPhase => {
            "the velocities jump there: take another `section_phase`, as \"90 deg\""
        }
        _ => "only the edge at phase 0 may be a section, which is just before it",
    };
    let about = match parameters.shape().drive {
        DriveKind::ThreePhase => [Parameter::Share1, Parameter::Share2],
        _ => [Parameter::Duty, Parameter::Rise],
    };
    Some(Remark {
        about: described(&about),
        text: format!(
            "the section at phase {phase} rad lies on the edge of the drive at {edge} of its period; {allowed}"
        ),
    })
}

/// Which member of the family a capsule is, in words; none where it is that of the paper.
fn member(parameters: &Parameters) -> Option<String> {
    if !parameters.form().is_of_family() {
        return None;
    }
    let shape = parameters.shape();
    let drive = match shape.drive {
        DriveKind::Prescribed => "prescribed relative motion of the mass".to_owned(),
        DriveKind::TwoPhase | DriveKind::ThreePhase => {
            format!("{} relative motion of the mass", shape.drive.name())
        }
        force => format!("{} drive", force.name()),
    };
    let mut parts = vec![drive];
    if shape.reaction == Reaction::Capsule {
        parts.push("its reaction on the capsule".to_owned());
    }
    for (is_part, name) in [
        (shape.over_folds, "folds across the way"),
        (shape.has(Parameter::Incline), "an incline"),
        (shape.has(Parameter::Load), "a load"),
        (shape.has_rear_stop(), "a rear stop"),
        (shape.is_rigid(), "a rigid stop"),
        (shape.has(Parameter::PreloadGap) && !shape.drive.is_prescribed(), "a preloaded spring"),
        (shape.has_damped_stops(), "damped stops"),
        (shape.releases_by_force(), "released by their force"),
        (shape.has_cubic_terms(), "cubic terms"),
        (shape.has_friction_by_direction(), "resistance by direction"),
        (shape.has_drag() && !shape.is_medium(), "drag beside friction"),
    ] {
        if is_part {
            parts.push(name.to_owned());
        }
    }
    Some(parts.join(", "))
}
