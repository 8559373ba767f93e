//! Stretches of a motion: samples at even times, and arcs between them with every event.

use capsulemap_engine::flow::{Event as _, Step, Switched};
use capsulemap_engine::orbit::{self, HistorySpan, Trajectory};

use super::{Face, engine_case};
use crate::motion::{Case, Stretch};

/// Why the motion of a system could not be followed.
type Failure<M, const D: usize> =
    orbit::Failure<<M as capsulemap_engine::flow::System<D>>::State<f64>>;

/// The next of some even times, cycle by cycle of a history.
struct EvenTimes {
    per_cycle: u32,
    /// Length of a cycle [s].
    period: f64,
    /// When the cycle begins, since that of the drive [s].
    begins: f64,
    cycles: u32,
    /// Which of the times of the cycle it is.
    next: u32,
}

impl EvenTimes {
    /// How long after the beginning of the cycle it is [s].
    fn in_cycle(&self) -> f64 {
        f64::from(self.next) * (self.period / f64::from(self.per_cycle))
    }

    /// How long after the section it is [s].
    fn since_section(&self) -> f64 {
        self.begins + self.in_cycle()
    }

    /// How long after the start of the history it is [s].
    fn since_start(&self) -> f64 {
        f64::from(self.cycles) * self.period + self.in_cycle()
    }

    fn advance(&mut self) {
        self.next += 1;
        if self.next == self.per_cycle {
            self.next = 0;
            self.begins += self.period;
            self.cycles += 1;
        }
    }
}

/// The motion from the start of a case at even times, both ends included, each from its step's series, which is exact to
/// `tolerance` too.
///
/// # Errors
/// Where the motion cannot be followed.
pub fn samples<M: Face<D>, const D: usize>(
    case: &Case,
    span: HistorySpan,
    tolerance: f64,
) -> Result<Stretch, Failure<M, D>> {
    let orbit::Case { system, start, begins } = engine_case::<M, D>(case);
    let single = system.single();
    let (period, per_cycle) = (single.period(), span.per_cycle);
    let mut trajectory = Trajectory::begun(&single, start, begins, tolerance);
    let mut stretch = Stretch::of(system.description());
    let ends_at_section = begins == 0.0;
    let wanted = span.samples() - usize::from(ends_at_section);
    let mut times = EvenTimes { per_cycle, period, begins, cycles: 0, next: 0 };
    while stretch.times.len() < wanted {
        trajectory.cycle(|step| {
            let end = step.start + step.length;
            while stretch.times.len() < wanted {
                let at = times.since_section();
                if at > end || at >= period {
                    return;
                }
                let h = (at - step.start).max(0.0);
                let state = system.told(&single.at(&step.jet, h));
                stretch.push(times.since_start(), &state, &system.driven(&single, step, h));
                times.advance();
            }
        })?;
        times.begins -= period;
    }
    if ends_at_section {
        // What depends on time alone is at the last section what it was at the first.
        let coordinates = system.description().coordinates.len();
        let driven: Vec<f64> = stretch.histories[coordinates..].iter().map(|it| it[0]).collect();
        stretch.push(times.since_start(), &system.told(&trajectory.state()), &driven);
    }
    Ok(stretch)
}

/// An event whose state after it is not known yet.
struct Pending<M: Face<D>, const D: usize> {
    time: f64,
    before: M::State<f64>,
    mode: M::Mode<f64>,
    event: M::Event,
    driven: Vec<f64>,
}

/// A stretch that is being followed.
struct Following<'a, M: Face<D>, const D: usize> {
    system: &'a M,
    single: &'a M::Single,
    stretch: Stretch,
    /// When it began, since the section [s].
    begins: f64,
    pending: Option<Pending<M, D>>,
}

impl<M: Face<D>, const D: usize> Following<'_, M, D> {
    /// Adds the instant `h` after the beginning of a step.
    fn put(&mut self, step: &Step<f64, M::Single>, h: f64) {
        let state = self.system.told(&self.single.at(&step.jet, h));
        let driven = self.system.driven(self.single, step, h);
        self.stretch.push(step.start + h - self.begins, &state, &driven);
    }

    /// Remembers the event at the end of a step, if there is one.
    fn note_event(&mut self, step: &Step<f64, M::Single>) {
        self.pending = M::Event::from_code(step.event).map(|event| Pending {
            time: step.start + step.length - self.begins,
            before: self.single.at(&step.jet, step.length),
            mode: step.mode,
            event,
            driven: self.system.driven(self.single, step, step.length),
        });
    }

    /// Adds the states at the event before, which has led to a state, and to this of what depends on time alone.
    fn after_event(&mut self, after: M::State<f64>, driven_after: &[f64]) {
        let Some(Pending { time, before, mode, event, driven }) = self.pending.take() else {
            return;
        };
        for state in self.system.at_event(self.single, &mode, event, [before, after]) {
            self.stretch.push(time, &state, &driven);
        }
        if event.is_timed() {
            self.stretch.push(time, &self.system.told(&after), driven_after);
        }
    }
}

/// The time until a motion comes to the section of an autonomous system [s].
fn duration_of_cycle<M: Face<D>, const D: usize>(
    single: &M::Single,
    start: M::State<f64>,
    tolerance: f64,
) -> Result<f64, Failure<M, D>> {
    let mut trajectory = Trajectory::<M::Single, D>::begun(single, start, 0.0, tolerance);
    trajectory.cycle(|_| ())?;
    Ok(trajectory.elapsed())
}

/// The motion of a case from its start to the next section: both ends, at so many even times after the start, of which the end is
/// the last, and at every event between.
///
/// # Errors
/// Where the motion cannot be followed.
pub fn arc<M: Face<D>, const D: usize>(
    case: &Case,
    count: u32,
    tolerance: f64,
) -> Result<Stretch, Failure<M, D>> {
    let orbit::Case { system, start, begins } = engine_case::<M, D>(case);
    let single = system.single();
    let duration = match <M::Single as Switched<f64>>::AUTONOMOUS {
        true => duration_of_cycle::<M, D>(&single, start, tolerance)?,
        false => single.period() - begins,
    };
    let between = duration / f64::from(count);
    let mut trajectory = Trajectory::begun(&single, start, begins, tolerance);
    let stretch = Stretch::of(system.description());
    let mut following =
        Following { system: &system, single: &single, stretch, begins, pending: None };
    let mut next = 0;
    // What depends on time alone, at the end.
    let mut driven = Vec::new();
    trajectory.cycle(|step| {
        let begins_driven = system.driven(&single, step, 0.0);
        following.after_event(single.at(&step.jet, 0.0), &begins_driven);
        if next == 0 {
            following.stretch.push(0.0, &case.start, &system.driven(&single, step, 0.0));
            next = 1;
        }
        // The last of the even times is the end, whatever rounding makes of it.
        while next < count && begins + f64::from(next) * between <= step.start + step.length {
            following.put(step, (begins + f64::from(next) * between - step.start).max(0.0));
            next += 1;
        }
        following.note_event(step);
        driven = system.driven(&single, step, step.length);
    })?;
    following.after_event(trajectory.state(), &driven);
    following.stretch.push(duration, &system.told(&trajectory.state()), &driven);
    Ok(following.stretch)
}
