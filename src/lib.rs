//! A bifurcation and basin mapper for the vibro-impact capsule, on an engine for any switched oscillator.
//!
//! # The capsule
//!
//! ```
//! use capsulemap::capsule::{CapsuleParameters, Output, Parameter, Parameters, State, settle};
//! use capsulemap::orbit::{Outcome, Protocol};
//!
//! // What is not named is as in Table 1 of the paper; all values are in SI units.
//! let parameters = Parameters::with(&[
//!     (Parameter::Omega, 77.91),
//!     (Parameter::Pd, 4.0),
//!     (Parameter::K2, 2.42e3),
//!     (Parameter::Delta, 3.5e-3),
//! ]);
//! let orbit = settle(&parameters, 0.0, State::default(), &Protocol::default());
//! assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
//! let speed = orbit.outputs[Output::ProgressionSpeed];
//! // The advance of a cycle is the speed times the period of the drive.
//! let advance = orbit.outputs[Output::ProgressionPerCycle];
//! assert!((advance - speed * parameters.drive_period()).abs() < 1e-15);
//! // A periodic orbit is closed: its multipliers lie inside the unit circle, its energies balance.
//! assert!(orbit.outputs[Output::EnergyResidual].abs() < 1e-9);
//! ```
//!
//! # Your own oscillator
//!
//! The engine (`lane`, `flow`, `orbit`, `branch`, `attractor`) knows no capsule. An oscillator of your own is a
//! struct of its parameters, generic over the kind of number `L`, with three short implementations:
//!
//! | trait | says | needed |
//! |---|---|---|
//! | [`flow::Switched`] | the Taylor recurrence of the field; with modes, the guards that end them and what follows | always |
//! | [`flow::Stroboscopic`] | which coordinates make a point of the section | always |
//! | [`flow::Field`] | the equations as they are written, by which every step is checked | always |
//! | [`flow::System`] | its parameters by name, and how section points are compared; [`own_system!`] writes it | always |
//! | [`flow::Observer`] | what is integrated or counted along the motion | if anything is |
//!
//! Put the implementations over `L` into [`in_lanes!`], so that they are compiled with the vector instructions
//! of the processor. Then [`orbit::settle`] and [`orbit::settle_all`] settle cases, one by one or as many side
//! by side as a vector has lanes, with the same bits; a periodic orbit comes with a certificate (closed by
//! Newton's method on the exact Jacobian), Floquet multipliers and the Lyapunov exponent;
//! [`attractor::attractors_of`] tells attractors apart, and [`branch::follow`] continues orbits in a parameter,
//! stable or not, through folds, period doublings and grazings.
//!
//! ```
//! use capsulemap::flow::{Field, NoEvent, Stroboscopic, Switched, Taylor};
//! use capsulemap::lane::elementary::{not_finite, sin_cos};
//! use capsulemap::lane::{Lane, ORDER, Series, series};
//! use capsulemap::orbit::{Case, Outcome, Protocol, settle};
//! use capsulemap::{in_lanes, own_system};
//!
//! /// x'' + c x' + x = cos(w t).
//! #[derive(Debug, Clone, Copy, PartialEq)]
//! struct Linear<L> {
//!     c: L,
//!     w: L,
//! }
//!
//! own_system!(Linear { c, w } section 2 state [L; 2], mode (), event NoEvent, scales |it| [it.w, 1.0]);
//!
//! in_lanes! {
//!     impl<L: Lane> Switched<L> for Linear<L> {
//!         type State = [L; 2];
//!         type Mode = ();
//!         type Jet = Taylor<L, 2>;
//!         type Event = NoEvent;
//!         const GUARDS: usize = 0;
//!
//!         fn period(&self) -> L {
//!             L::splat(2.0 * std::f64::consts::PI) / self.w
//!         }
//!         fn expand(&self, _: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 2>) {
//!             let (mut sin, mut cos) = sin_cos(self.w * time);
//!             jet.begin(state);
//!             for k in 0..ORDER {
//!                 let per = L::splat(series::INVERSE[k + 1]);
//!                 let force = cos - jet[0][k] - self.c * jet[1][k];
//!                 jet[0][k + 1] = jet[1][k] * per;
//!                 jet[1][k + 1] = force * per;
//!                 (sin, cos) = (self.w * cos * per, -(self.w * sin * per));
//!             }
//!         }
//!         fn pace<'a>(&self, jet: &'a Taylor<L, 2>) -> [&'a Series<L>; 2] {
//!             [&jet[0], &jet[1]]
//!         }
//!         fn at(&self, jet: &Taylor<L, 2>, h: L) -> [L; 2] {
//!             jet.at(h)
//!         }
//!         fn motion(&self, jet: &Taylor<L, 2>, h: L) -> ([L; 2], [L; 2]) {
//!             jet.motion(h)
//!         }
//!         fn lost(&self, state: &[L; 2]) -> L::Mask {
//!             not_finite(state[0] + state[1])
//!         }
//!     }
//!
//!     impl<L: Lane> Stroboscopic<L, 2> for Linear<L> {
//!         fn point(state: &[L; 2]) -> [L; 2] {
//!             *state
//!         }
//!         fn state(point: [L; 2]) -> [L; 2] {
//!             point
//!         }
//!     }
//! }
//!
//! impl Field for Linear<f64> {
//!     type Coordinates = [f64; 2];
//!     fn coordinates(state: &[f64; 2]) -> [f64; 2] {
//!         *state
//!     }
//!     fn rates(&self, _: &(), time: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
//!         [*v, (self.w * time).cos() - x - self.c * v]
//!     }
//!     fn weights(&self) -> [f64; 2] {
//!         [self.w, 1.0]
//!     }
//! }
//!
//! let linear = Linear { c: 0.1, w: 2.0 };
//! let orbit = settle(&Case::new(linear, [0.0, 0.0]), &Protocol::default());
//! assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
//! // The steady answer at the phase zero of the force: x = (1 - w^2)/((1 - w^2)^2 + (c w)^2).
//! let exact = -3.0 / (9.0 + 0.04);
//! assert!((orbit.section[0][0] - exact).abs() < 1e-11);
//! // Free vibration decays at the rate c/2.
//! assert!((orbit.exponent.value + 0.05).abs() < 1e-11);
//! ```
//!
//! `pace` names the series by which the length of a step is chosen, `weights` and `scales` what the coordinates of
//! the state and of the section are measured by. An impact is a guard (`GUARDS`, `guard`), what follows it (`switch`,
//! which sets `zeros[0] = 1` for the guard that it has put on its own surface), and two facts that have defaults and
//! without which no grazing is found: `Event::is_impact`, and `touching`, the coordinate that may touch the surface.
//! Of the examples in `crates/engine/examples`, `impact_oscillator.rs` has all of it on a page, `duffing.rs` none;
//! `relief_valve.rs` is autonomous and `belt.rs` has modes.
//!
//! What is not there yet: a law of restitution whose impacts accumulate fails with `Chatter`, and ends a branch as
//! [`branch::End::Corner`], as it needs a mode of its own for rest on the surface.
//!
//! # Traps
//!
//! - A start behind a surface is moved onto it by the first step, as its guard is due at once: that is no event.
//! - A function over `L` outside [`in_lanes!`] that is called in every step is right, but slow by up to thirty.
//! - Read [`flow::Zeros`] before writing [`flow::Switched::switch`]: a guard that the event has placed on its own
//!   surface must be told.
//! - A term that is far below the others where a step begins and grows within it (friction near rest, seen from
//!   afar) needs [`flow::Switched::step_bound`]; what is missing shows as [`orbit::Orbit::defect`].
//! - [`lane::elementary`] has `sin_cos`, `exp`, `log`, `sqrt` and `power` with the same bits in every lane, and
//!   [`lane::series`] their recurrences; functions of the standard library differ between machines.
//!
//! # The floors
//!
//! The modules are floors, and each uses only those before it: [`lane`], [`flow`], [`orbit`], [`branch`] and [`attractor`] of the crate
//! `capsulemap-engine`, [`quantity`], [`description`], [`motion`], [`face`], [`capsule`], [`model`] and [`of`] of `capsulemap-models`, and then those of this crate in the order of this file; each
//! opens with a sentence saying what it does. Nothing above the models is generic over a system: it asks [`model::Model`]. Without the
//! feature `cli` the library ends at `tradeoff` and needs neither HDF5 nor plotters nor clap.

#[doc(inline)]
pub use capsulemap_engine::{attractor, branch, flow, in_lanes, lane, orbit, own_system};
#[doc(inline)]
pub use capsulemap_models::{capsule, description, face, model, motion, of, quantity};

#[cfg(feature = "cli")]
pub mod experiment;
pub mod study;
pub mod run;
pub mod tradeoff;
#[cfg(feature = "cli")]
pub mod store;
#[cfg(feature = "cli")]
pub mod campaign;
#[cfg(feature = "cli")]
pub mod figure;
#[cfg(feature = "cli")]
pub mod explore;
#[cfg(feature = "cli")]
pub mod cli;
