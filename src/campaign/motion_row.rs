//! What is told of each motion of a trade-off: its case, its numbers, and how to compute it again.

use super::margins::Margins;
use super::mean_errors::MeanErrors;
use super::refined_motion::{RefinedMotion, Slopes};
use super::robustness::Robustness;
use crate::description::{Description, Section, State};
use crate::motion::Case;
use crate::of::default_model;
use crate::orbit::{Outcome, Protocol};
use crate::store::catalogue::{ATTRACTOR, ATTRACTOR_SHARE, OUTCOME, PERIOD};
use crate::store::{Archive, CaseTable, Column, StoreError};
use crate::study::Coordinate;
use crate::tradeoff::{Candidate, GainAndCost};

/// The columns from which the rows are read.
pub struct Rows {
    /// The parameters and coordinates of the start, by name, and whether they vary.
    coordinates: Vec<(Coordinate, Vec<f64>, bool)>,
    outcomes: Option<Column>,
    periods: Option<Column>,
    attractors: Option<Column>,
    /// The share of each attractor of the starts.
    shares: Vec<f64>,
    file: String,
}

/// A motion of a trade-off.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its case; none where it lies between the cases.
    pub case: Option<usize>,
    /// Its parameters and start [SI], and whether each varies in the file.
    pub coordinates: Vec<(Coordinate, f64, bool)>,
    /// What it gains, by the output that was asked for [SI].
    pub gain: f64,
    /// What it costs, by the output that was asked for [SI].
    pub price: f64,
    /// The cost per gain, of a speed the energy per distance [SI].
    pub per_gain: f64,
    /// The name of its outcome.
    pub outcome: String,
    /// Its period [cycles]; none where it does not repeat.
    pub period: Option<u64>,
    /// The number of its attractor, where attractors are told apart.
    pub attractor: Option<u64>,
    /// The share of the starts that lead to it, where they are all that varies.
    pub share: Option<f64>,
    /// Standard errors of its means, where it does not repeat and orbits are computed again.
    pub errors: Option<MeanErrors>,
    /// How it changes with the parameters, and what holds it.
    pub slopes: Slopes,
    /// What tolerances leave of it, if that was asked for and it repeats.
    pub robustness: Option<Robustness>,
    /// How far each parameter may fall and rise before it ends or loses its stability, if that was asked for and it repeats.
    pub margins: Vec<Margins>,
    /// The command that computes it again.
    pub replay: String,
}

impl Row {
    /// Its start as a section point (SI).
    pub fn start(&self, model: &'static Description) -> Section {
        let values = Coordinate::of_section(model).map(|wanted| {
            let found = self.coordinates.iter().find(|(it, ..)| *it == wanted);
            found.map_or(0.0, |(_, value, _)| *value)
        });
        values.collect()
    }
}

impl Rows {
    /// The columns of the cases in `archive`, called `file`.
    pub fn of(table: &CaseTable<'_>, archive: &Archive, file: &str) -> Result<Rows, StoreError> {
        let mut coordinates = Vec::new();
        for coordinate in Coordinate::all(archive.frame().model()) {
            let Some(Column { values, .. }) = table.column(coordinate.name())? else { continue };
            let varies = values.iter().any(|value| *value != values[0]);
            coordinates.push((coordinate, values, varies));
        }
        let shares = archive.variable(ATTRACTOR_SHARE.name)?;
        let has_starts_alone = shares.as_ref().is_some_and(|it| it.dimensions.len() == 1);
        let shares = shares.filter(|_| has_starts_alone);
        Ok(Rows {
            coordinates,
            outcomes: table.column(OUTCOME.name)?,
            periods: table.column(PERIOD.name)?,
            attractors: table.column(ATTRACTOR.name)?,
            shares: shares.map_or(Vec::new(), |it| it.values.to_real().into_iter().collect()),
            file: file.to_owned(),
        })
    }

    /// What is told of a motion.
    pub fn row(&self, motion: &Candidate) -> Row {
        let case = motion.case;
        let outcome = self.outcomes.as_ref().and_then(|it| {
            let code = it.values[case];
            it.flags.iter().find(|(known, _)| *known as f64 == code).map(|(_, name)| name.clone())
        });
        let attractor = whole(self.attractors.as_ref(), case);
        let coordinates = self.coordinates.iter();
        Row {
            case: Some(case),
            coordinates: coordinates
                .map(|(it, values, varies)| (*it, values[case], *varies))
                .collect(),
            gain: motion.gain,
            price: motion.price,
            per_gain: motion.per_gain,
            outcome: outcome.unwrap_or_default(),
            period: whole(self.periods.as_ref(), case).filter(|period| *period > 0),
            attractor,
            share: attractor.and_then(|it| self.shares.get(it as usize).copied()),
            errors: None,
            slopes: Slopes::default(),
            robustness: None,
            margins: Vec::new(),
            replay: format!("capsulemap simulate --study {} --case {case}", quoted(&self.file)),
        }
    }

    /// The period of each case; zero where it does not repeat or is not known.
    pub fn periods(&self, cases: usize) -> Vec<f64> {
        self.periods.as_ref().map_or_else(|| vec![0.0; cases], |it| it.values.clone())
    }

    /// What is told of a motion between the cases, with this gain and this cost.
    pub fn refined(&self, motion: &RefinedMotion, of: GainAndCost, protocol: &Protocol) -> Row {
        let all = self.coordinates.iter();
        Row {
            case: None,
            coordinates: all
                .map(|(it, _, varies)| (*it, motion.coordinate(*it), *varies))
                .collect(),
            gain: motion.outputs[of.gain],
            price: motion.outputs[of.cost],
            per_gain: of.per_gain(&motion.outputs),
            outcome: Outcome::Periodic.name().to_owned(),
            period: Some(motion.period),
            attractor: None,
            share: None,
            errors: None,
            slopes: motion.slopes.clone(),
            robustness: None,
            margins: Vec::new(),
            replay: replay(motion, protocol, &self.file),
        }
    }
}

/// The number of a case in a column of counts; none where it has none.
fn whole(column: Option<&Column>, case: usize) -> Option<u64> {
    let value = column?.values[case];
    (value >= 0.0).then_some(value as u64)
}

/// The command that computes a motion between the cases.
fn replay(motion: &RefinedMotion, protocol: &Protocol, file: &str) -> String {
    let RefinedMotion { parameters, section, phase, .. } = motion;
    let start = State::at_section(parameters.model(), section);
    command(&Case::at_section(parameters.clone(), start, *phase), protocol, file)
}

/// The command that computes a case from its start, with the tolerance and the budget of cycles of a protocol; a system that is a text is
/// taken from the `file` of a study or of results.
pub fn command(case: &Case, protocol: &Protocol, file: &str) -> String {
    let Case { parameters, start, start_phase, section_phase } = case;
    let mut text = "capsulemap simulate".to_owned();
    if parameters.model().equations.is_some() {
        text += &format!(" --system {}", quoted(file));
    } else if parameters.model().without_own() != default_model() {
        text += &format!(" --model {}", parameters.model().name);
    }
    for (parameter, value) in parameters.stated() {
        if value != parameter.default_value() || parameters.is_given(parameter) {
            text += &format!(" --set {}={value:?}", parameter.symbol());
        }
    }
    let model = parameters.model();
    let given = model.start_coordinates().map(|it| format!("{}={:?}", it.name(), start[it]));
    text += &format!(" --start {}", given.collect::<Vec<_>>().join(","));
    if let Some(drift) = model.drift().filter(|it| start[*it] != 0.0) {
        text += &format!(",{}={:?}", drift.name(), start[drift]);
    }
    if start_phase == section_phase && *section_phase != 0.0 {
        text += &format!(" --phase {section_phase:?}");
    }
    if start_phase != section_phase {
        text += &format!(" --start-phase {start_phase:?} --section-phase {section_phase:?}");
    }
    let Protocol { tolerance, max_cycles, .. } = protocol;
    text += &format!(" --tolerance {tolerance:?} --max-cycles {max_cycles}");
    for (name, chosen) in parameters.unusual_choices() {
        text += &format!(" --{} {chosen}", name.replace('_', "-"));
    }
    text
}

/// A file as a shell takes it for one word.
pub fn quoted(file: &str) -> String {
    let mut characters = file.chars();
    let is_plain = characters.all(|it| it.is_ascii_alphanumeric() || "/._-+=:,".contains(it));
    match is_plain && !file.is_empty() {
        true => file.to_owned(),
        false => format!("'{}'", file.replace('\'', "'\\''")),
    }
}
