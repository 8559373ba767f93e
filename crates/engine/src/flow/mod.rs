//! Integrates any switched system by Taylor steps and locates every event.

pub mod breakdown;
pub mod cycle;
pub mod defect;
mod expand;
pub mod guard;
mod locate;
pub mod metric;
pub mod motion;
pub mod observer;
mod obey;
mod pace;
mod step;
mod step_end;
pub mod stop;
pub mod switched;
pub mod system;
mod own_system;
mod taylor;

pub use breakdown::Breakdown;
pub use cycle::{Reason, STEPS_PER_CYCLE, cycle, cycle_changed_by};
pub use metric::Metric;
pub use motion::Motion;
pub use observer::Observer;
pub use pace::longest_step;
pub use step::Step;
pub use stop::Stop;
pub use switched::{Event, Field, MAX_GUARDS, NoEvent, Stroboscopic, Switched, Zeros};
pub use system::System;
pub use taylor::Taylor;
