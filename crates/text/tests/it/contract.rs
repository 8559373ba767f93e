//! What every system owes the integrator, held against texts that are drawn at random; the laws are those of the engine's own tests.

// The same laws, and what they need, as the engine holds its own systems to.
#[path = "../../../engine/tests/it/contract/lanes.rs"]
mod lanes;
#[path = "../../../engine/tests/it/contract/maps.rs"]
mod maps;
#[path = "../../../engine/tests/it/contract/orbits.rs"]
mod orbits;
#[path = "../../../engine/tests/it/contract/steps.rs"]
mod steps;
#[path = "../../../engine/tests/it/contract/subject.rs"]
mod subject;

use std::cell::Cell;

use capsulemap_engine::flow::System as _;
use capsulemap_engine::orbit::Case;
use capsulemap_text::mode::TextMode;
use capsulemap_text::system::{Autonomous, Driven};

use super::draws::Random;
use super::random_texts::{RandomText, autonomous, driven};
use subject::Subject;

/// Texts that each law is held against; the long form takes more (TEXTS=100).
const TEXTS: u64 = 6;

thread_local! {
    /// The text that is drawn.
    static TEXT: Cell<u64> = const { Cell::new(0) };
}

/// Holds a law against each of some random texts.
fn against_texts(law: impl Fn()) {
    let texts = std::env::var("TEXTS").map_or(TEXTS, |it| it.parse().expect("TEXTS is a number"));
    for text in 0..texts {
        TEXT.set(text);
        law();
    }
}

/// Random cases of one random text.
fn drawn<M, const D: usize>(
    text: impl Fn(u64) -> RandomText,
    system: impl Fn(&RandomText) -> M,
    (count, seed): (usize, u64),
) -> Vec<Case<M, D>>
where
    M: capsulemap_engine::flow::System<D, Parameter = usize, State<f64> = [f64; 5]>,
{
    let drawn = text(TEXT.get());
    let base = system(&drawn);
    let mut random = Random::new(seed);
    let mut case = || {
        let (values, start) = drawn.case(&mut random);
        let mut system = base.clone();
        for (parameter, value) in values.into_iter().enumerate() {
            system = system.with(parameter, value);
        }
        Case::new(system, start)
    };
    (0..count).map(|_| case()).collect()
}

impl Subject<3> for Driven<3, 5> {
    fn directions() -> Vec<usize> {
        driven(TEXT.get()).directions()
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 3>> {
        drawn(driven, |it| Driven::new(it.program), (count, seed))
    }

    fn terms(&self, _: usize, _: &TextMode<f64>, state: &[f64; 5]) -> f64 {
        largest_term(&driven(TEXT.get()), |it| self.value(it), state)
    }
}

impl Subject<3> for Autonomous<3, 5> {
    fn directions() -> Vec<usize> {
        autonomous(TEXT.get()).directions()
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 3>> {
        drawn(autonomous, |it| Autonomous::new(it.program), (count, seed))
    }

    fn terms(&self, _: usize, _: &TextMode<f64>, state: &[f64; 5]) -> f64 {
        largest_term(&autonomous(TEXT.get()), |it| self.value(it), state)
    }
}

/// No number in a guard of a random text is larger: a parameter times a power of a state.
fn largest_term(text: &RandomText, value: impl Fn(usize) -> f64, state: &[f64; 5]) -> f64 {
    let parameters = (0..text.program.text.parameters.len()).map(|it| value(it).abs());
    let size = state.iter().fold(1.0, |size: f64, it| size.max(it.abs()));
    parameters.fold(1.0, f64::max) * size.powi(3)
}

/// The laws, each for driven and for autonomous texts.
macro_rules! contract {
    ($($law:ident: $module:ident::$function:ident;)*) => {
        mod driven_texts {
            use super::*;
            $(
                #[test]
                fn $law() {
                    against_texts($module::$function::<Driven<3, 5>, 3>);
                }
            )*
        }
        mod autonomous_texts {
            use super::*;
            $(
                #[test]
                fn $law() {
                    against_texts($module::$function::<Autonomous<3, 5>, 3>);
                }
            )*
        }
    };
}

contract! {
    a_motion_has_the_same_bits_in_every_lane: lanes::courses;
    returns_have_the_same_bits_on_every_machine: lanes::all_returns;
    orbits_have_the_same_bits_on_every_machine: lanes::all_orbits;
    guards_keep_their_sign_between_events: steps::guard_signs;
    guards_without_derivatives_have_their_bits: steps::plain_guards;
    steps_satisfy_the_equations: steps::defects;
    sections_are_where_they_are_defined: steps::sections;
    no_return_is_missed: steps::every_return;
    the_jacobian_is_that_of_differences: maps::derivatives_along_points;
    derivatives_along_parameters_are_those_of_differences: maps::derivatives_along_parameters;
    tolerances_agree_on_a_tame_motion: maps::two_tolerances;
    certificates_hold_by_brute_force: orbits::certificates;
}
