//! Cycles that are measured: of one motion at a time, or of motions side by side.

use crate::flow::defect::defect;
use crate::flow::metric::greater;
use crate::flow::{Metric, Motion, Observer, Stroboscopic, Switched, System};

use super::trajectory::Progress;
use super::{Failure, Trajectory};

/// Cycles that are to be measured.
pub struct MeasureRequest<M: System<D>, const D: usize> {
    /// The system.
    pub system: M,
    /// Its motion, at the section.
    pub motion: Motion<f64, M::Single>,
    /// How far it has come.
    pub progress: Progress,
    /// How many cycles.
    pub cycles: u64,
    /// In how many batches what is observed is told, too; none for zero.
    pub batches: u64,
    /// Steps that it may take in all, those before included.
    pub max_steps: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
    /// Section points that are kept at most.
    pub points: usize,
    /// Points that the observer keeps at most of whatever it notes.
    pub observed_points: usize,
}

impl<M: System<D>, const D: usize> MeasureRequest<M, D> {
    /// The same of so many cycles.
    pub fn lasting(&self, cycles: u64) -> Self {
        MeasureRequest { system: self.system.clone(), cycles, ..*self }
    }
}

/// Cycles that have been measured, as far as the motion could be followed.
pub struct Measured<M: System<D>, const D: usize> {
    /// The motion after them.
    pub motion: Motion<f64, M::Single>,
    /// How far it has come.
    pub progress: Progress,
    /// What was observed.
    pub observed: M::Observer,
    /// What had been observed at the end of each batch.
    pub batches: Vec<M::Observer>,
    /// What the section and the steps say of it.
    pub kept: Kept<D>,
    /// Why it could not be followed to the end, if so.
    pub failure: Option<Failure<M::State<f64>>>,
}

/// What the section and the steps of a motion say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Kept<const D: usize> {
    /// The points of the section, as many as are kept.
    pub section: Vec<[f64; D]>,
    /// So many at most.
    points: usize,
    /// The largest size at the section, in the units of the metric.
    pub size: f64,
    /// The largest size at the start of a step.
    pub swing: f64,
    /// How far the motion gets from where its cycle began.
    pub excursion: f64,
    /// The largest defect of a step.
    pub defect: f64,
    /// Where the cycle began.
    here: [f64; D],
}

impl<const D: usize> Kept<D> {
    /// Nothing seen yet; of the section so many `points` are kept.
    pub fn new(points: usize) -> Self {
        let (section, here) = (Vec::new(), [f64::NAN; D]);
        Kept { section, points, size: 0.0, swing: 0.0, excursion: 0.0, defect: 0.0, here }
    }

    /// Takes note of the section point where a cycle begins.
    pub fn begin_cycle(&mut self, metric: &Metric<D>, here: [f64; D]) {
        self.size = self.size.max(metric.size(&here));
        if self.section.len() < self.points {
            self.section.push(here);
        }
        self.here = here;
    }

    /// Takes note of a step by the point at which it begins and its defect.
    pub fn see(&mut self, metric: &Metric<D>, begins: &[f64; D], defect: f64) {
        self.defect = greater(self.defect, defect);
        self.swing = self.swing.max(metric.size(begins));
        self.excursion = self.excursion.max(metric.distance(begins, &self.here));
    }
}

/// The cycles at which batches end of which so many are wanted: whole cycles, batches that differ by one cycle at most in length, and
/// no more than there are cycles.
pub fn batch_ends(cycles: u64, batches: u64) -> impl Iterator<Item = u64> + Clone {
    let count = batches.min(cycles);
    (1..=count)
        .map(move |batch| (u128::from(cycles) * u128::from(batch) / u128::from(count)) as u64)
}

/// The cycles of one motion by itself.
pub fn measured_alone<M: System<D>, const D: usize>(
    request: MeasureRequest<M, D>,
) -> Measured<M, D> {
    let MeasureRequest { system, motion, progress, cycles, max_steps, .. } = request;
    let (moving, metric) = (system.single(), system.metric());
    let mut trajectory =
        Trajectory::resume(&moving, motion, progress, request.tolerance).limited(max_steps);
    let mut observed = system.observer(request.observed_points);
    let mut kept = Kept::new(request.points);
    let mut failure = None;
    let mut ends = batch_ends(cycles, request.batches).peekable();
    let mut batches = Vec::new();
    for cycle in 1..=cycles {
        kept.begin_cycle(&metric, trajectory.section());
        let followed = trajectory.cycle(|step| {
            observed.see(&moving, step);
            let begins = M::Single::point(&moving.beginning(&step.jet));
            kept.see(&metric, &begins, defect(&moving, step));
        });
        if let Err(why) = followed {
            failure = Some(why);
            break;
        }
        if ends.next_if_eq(&cycle).is_some() {
            batches.push(observed.clone());
        }
    }
    let (motion, progress) = (trajectory.motion(), trajectory.progress);
    Measured { motion, progress, observed, batches, kept, failure }
}
