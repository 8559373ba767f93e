//! Oscillators given as text: a table of rates, events, switches, friction and pulses, from which everything else follows.
//!
//! `docs/systems.md` says what a text may have. [`read`] makes a [`Text`] of it, or tells all its faults; [`program::Program`] has the
//! instructions for its values, and [`system::TextSystem`] is the system that the engine moves.
//!
//! ```
//! let text = "
//! [system]
//! name = \"pendulum\"
//! states = { angle = \"rad\", rate = \"rad/s\" }
//! section = { every = \"2*pi/w\" }
//!
//! [system.parameters]
//! w = 0.7
//! damping = 0.1
//! torque = 1.2
//!
//! [system.rates]
//! angle = \"rate\"
//! rate = \"torque*cos(w*t) - damping*rate - sine(angle)\"
//! ";
//! let faults = capsulemap_text::read(text).expect_err("there is no such function");
//! assert_eq!(faults[0].line, 14);
//! let text = capsulemap_text::read(&text.replace("sine", "sin")).expect("no fault");
//! assert_eq!((text.states.len(), text.guards()), (2, 0));
//! ```

pub mod text;

pub use text::{
    Fault, Text, derived, described, linear_rates, mode, model, own, program, read, read_in,
    sampled, system, tables, unit,
};
