//! What the friction of a capsule says of its parameters beside each other.

use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::resistance::{Resistance, Switching};
use crate::description::{self, NotGiven, Parameters, Remark, Threshold};

/// That static friction is too small to have an effect.
pub(super) fn idle_static_friction(parameters: &Parameters) -> Option<Remark> {
    let about = [Parameter::MuS, Parameter::MuD].map(description::Parameter::from).to_vec();
    parameters.idle_static_friction().map(|text| Remark { about, text })
}

/// Static friction has no effect below the friction at the onset of sliding, as rest ends where the force exceeds the larger of both. In
/// Eq. (1) as printed it always has one.
pub(super) fn no_effect_below(
    parameters: &Parameters,
    parameter: description::Parameter,
) -> Option<Threshold> {
    let is_bounded = parameter == Parameter::MuS && parameters.switching() == Switching::Filippov;
    let is_bounded = is_bounded && !parameters.shape().has_friction_by_direction();
    is_bounded.then(|| Threshold {
        value: parameters.onset_factor() * parameters[Parameter::MuD],
        in_words: parameters.onset_in_words(),
        why: "where rest ends with the friction at the onset of sliding",
    })
}

/// The other of the two coefficients of friction; none of what is no coefficient.
fn other(parameter: Parameter) -> Option<Parameter> {
    match parameter {
        Parameter::MuS => Some(Parameter::MuD),
        Parameter::MuD => Some(Parameter::MuS),
        _ => None,
    }
}

/// Whether those of the two directions stand in the place of a coefficient.
fn is_told_by_direction(coefficient: Parameter, is_told: description::rules::Which<'_>) -> bool {
    coefficient.directions().all(|it| is_told(it.into()))
}

/// The coefficient of Coulomb's law that is neither given nor on an axis, where the other is on an axis: it is one number for all
/// cases, so it cannot follow the axis.
pub(super) fn missing(
    parameters: &Parameters,
    given: description::rules::Which<'_>,
    on_axis: description::rules::Which<'_>,
) -> Option<NotGiven> {
    let open = [Parameter::MuS, Parameter::MuD].into_iter().find(|&it| {
        let of_axis = other(it).is_some_and(|other| on_axis(other.into()));
        let is_told = |it| on_axis(it) || given(it);
        of_axis && !is_told(it.into()) && !is_told_by_direction(it, &is_told)
    })?;
    if parameters.resistance() != Resistance::Coulomb {
        return None;
    }
    let hint = if open == Parameter::MuS { "; with 0, rest ends at mu_d N" } else { "" };
    let axis = other(open)?.symbol();
    let why = format!(
        "a value, as {axis} is on an axis and Coulomb's law takes one coefficient for the other only where it is constant{hint}"
    );
    Some(NotGiven { parameter: open.into(), why })
}

/// Completes the friction where one of mu_s and mu_d is given and the other is not: Coulomb's law knows one coefficient, so there the
/// other takes its value.
pub(super) fn complete(
    parameters: &mut Parameters,
    given: description::rules::Which<'_>,
) -> Option<NotGiven> {
    let (from, to) = match (given(Parameter::MuS.into()), given(Parameter::MuD.into())) {
        (true, false) => (Parameter::MuS, Parameter::MuD),
        (false, true) => (Parameter::MuD, Parameter::MuS),
        _ => return None,
    };
    if parameters.resistance() != Resistance::Coulomb || is_told_by_direction(to, given) {
        return None;
    }
    parameters[to] = parameters[from];
    let ([to_symbol, from], value) = ([to, from].map(Parameter::symbol), parameters[to]);
    let why = format!(
        "{to_symbol} is not given: Coulomb's law knows one coefficient, so {to_symbol} = {from} = {value}"
    );
    Some(NotGiven { parameter: to.into(), why })
}
