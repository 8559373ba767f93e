//! A record of the states of an oscillator given as text, with the case that it is of.

use capsulemap_text::described::period;

use super::course::varies;
use super::history::Channel;
use super::recording::{GAP, Recording, Sensed};
use super::simulated_span::{check_span, check_wait};
use crate::description::{Description, Parameters, State};
use crate::motion::Case;

/// So many cycles of the drive before or after the first sample time zero is far.
const FAR: f64 = 1000.0;
/// Samples that a fit needs.
const LEAST: usize = 16;
/// So many gaps are named.
const NAMED: usize = 3;

/// A recorded history of an oscillator given as text.
#[derive(Debug, Clone, PartialEq)]
pub struct TextRecord {
    /// Parameters as they were set; those that are fitted are replaced.
    pub parameters: Parameters,
    /// The start of the study, for states of which the record says nothing.
    pub start: State,
    /// The phase of the drive at time zero of the record [rad].
    pub phase: f64,
    /// The time of the first sample [s].
    pub first: f64,
    /// Times since the first sample [s], the first of which is zero.
    pub times: Vec<f64>,
    /// The states that were recorded by their places, with their values at those of the times at which they were.
    pub states: Vec<(usize, Sensed)>,
}

impl TextRecord {
    /// The states of a `recording` of a case, whose start phase is that of the drive at time zero.
    ///
    /// Fails where the recording has no state, where one does not vary, or where it spans more cycles than its samples allow.
    pub fn new(recording: &Recording, case: &Case) -> Result<TextRecord, String> {
        let model = case.parameters.model();
        let times = recording.required("t");
        let mut states = Vec::new();
        for (place, it) in model.coordinates.iter().enumerate() {
            states.extend(recording.sensed(it.name).map(|sensed| (place, sensed.clone())));
        }
        if states.is_empty() {
            return Err(no_state(model, &recording.others));
        }
        for (place, sensed) in &states {
            varies(model.coordinates[*place].name, &sensed.values)?;
        }
        let first = times[0];
        let times: Vec<f64> = times.iter().map(|time| time - first).collect();
        let sampling = recording.sampling();
        match case.parameters.period_of_drive() {
            Some(period) => check_span(&times, &sampling, period)?,
            None => check_wait(&times, &sampling, period(&case.parameters))?,
        }
        let (parameters, start) = (case.parameters.clone(), case.start.clone());
        Ok(TextRecord { parameters, start, phase: case.start_phase, first, times, states })
    }

    /// Its samples up to this time since the first [s].
    ///
    /// Fails where these are fewer than sixteen, or a state does not vary in them.
    pub fn up_to(mut self, span: f64) -> Result<TextRecord, String> {
        let count = self.times.partition_point(|time| *time <= span);
        if count < LEAST {
            let all = self.times.len();
            return Err(format!(
                "{count} of its {all} samples are used; at least {LEAST} are needed: give more --cycles"
            ));
        }
        self.times.truncate(count);
        for (place, sensed) in &mut self.states {
            *sensed = sensed.first(count);
            varies(self.parameters.model().coordinates[*place].name, &sensed.values)?;
        }
        Ok(self)
    }

    /// What a state is called and measures.
    pub fn channel(&self, place: usize) -> Channel {
        let described = &self.parameters.model().coordinates[place];
        Channel { name: described.name, dimension: described.start.dimension }
    }

    /// What makes its `recording` doubtful, in sentences.
    pub fn doubts(&self, recording: &Recording) -> Vec<String> {
        let mut doubts = recording.notes.clone();
        if !recording.others.is_empty() {
            let (others, names) = (recording.others.join(", "), names(self.parameters.model()));
            doubts.push(format!("left out: {others}; the states are {names}"));
        }
        let gaps = recording.sampling().gaps;
        if !gaps.is_empty() {
            let told = gaps.iter().take(NAMED).map(|(at, length)| format!("{length} at t = {at}"));
            let told = told.collect::<Vec<_>>().join(", ");
            let more = gaps.len().saturating_sub(NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            doubts.push(format!(
                "gaps of {told}{more} (more than {GAP} times the median interval); the motion is simulated through them: where the \
                 clock was set there, cut the file there and take the parts by themselves"
            ));
        }
        let cycles = self.parameters.period_of_drive().map(|period| self.first / period);
        if let Some(cycles) = cycles.filter(|it| it.abs() > FAR) {
            doubts.push(format!(
                "time zero, at which the drive has the start_phase of the study, is {:.0} cycles {} the first sample",
                cycles.abs(),
                if cycles > 0.0 { "before" } else { "after" }
            ));
        }
        doubts
    }
}

/// The names of the states of a model.
fn names(model: &Description) -> String {
    model.coordinates.iter().map(|it| it.name).collect::<Vec<_>>().join(", ")
}

/// That a recording has no state.
fn no_state(model: &Description, others: &[String]) -> String {
    let has = match others {
        [] => "t alone".to_owned(),
        others => format!("t, {}", others.join(", ")),
    };
    let (name, names) = (model.name, names(model));
    format!("has no column of a state of {name}; expected one of {names}; the columns are {has}")
}
