//! `capsulemap simulate`: one case in full.

use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::{named, read_quantity};
use super::failure::Failure;
use super::phases::Phases;
use super::simulation_text::summary;
use super::terminal::{notify, print};
use crate::campaign::{CampaignError, Replay, read_study_or_results, read_system, silent};
use crate::capsule::description::{CAPSULE, CAPSULE_OVER_FOLDS};
use crate::capsule::{
    self, CapsuleParameters as _, DriveKind, Reaction, Release, Resistance, Switching,
};
use crate::description::{Description, Parameter, Parameters, Remark, State};
use crate::explore::case_json;
use crate::motion::{Case, SimulationSize};
use crate::of::{all_models, default_model, model_called, model_of, settle_case};
use crate::orbit::{Exponents, Protocol};
use crate::quantity::printable::printable;
use crate::run::Machine;
use crate::study::document::{unknown, unknown_of};
use crate::study::without_effect::given_without_effect;

const EXAMPLES: &str = "\
Examples:
  capsulemap simulate --omega \"20.73 rad/s\" --k2 \"18.96 kN/m\" --json
  capsulemap simulate --set mu_s=0.4,mu_d=0.3 --start r=-2.5e-3 --cycles 50
  capsulemap simulate --drive square --set duty=0.3 --set p_low=\"-1 N\"
  capsulemap simulate --friction-switching as-printed
  capsulemap simulate --study studies/overview.toml --case 1234
  capsulemap simulate --system systems/belt.toml --start x=1

A number without a unit is in SI. What is not given is as in the paper's Table 1 and Fig 5.";

/// Compute one case from its start, then on to what it settles to.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Simulate {
    /// Take a case of this study, or of the study in this file of results, with its parameters, its start and the study's protocol.
    #[arg(long, value_name = "STUDY", conflicts_with_all = ["omega", "p_d", "k2",
        "delta", "set", "phase", "start_phase", "section_phase", "tolerance", "max_cycles", "max_steps",
        "exponents",
        "friction_switching", "resistance", "drive", "drive_reaction", "release"])]
    study: Option<PathBuf>,
    /// Its number, counted from 0 with the last axis fastest, as in the reports of failures; a study of one case needs none.
    #[arg(long, requires = "study")]
    case: Option<usize>,
    /// Another model than the capsule, of those that this program knows, as capsule-over-folds; its parameters are given by --set.
    #[arg(long, value_name = "NAME", conflicts_with = "study")]
    model: Option<String>,
    /// The oscillator of a text, as systems/belt.toml, or of a study or of results that have one; its parameters are given by --set.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["study", "model"])]
    system: Option<PathBuf>,
    /// Frequency of the drive, as "77.91 rad/s" or "12.4 Hz".
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    omega: Option<String>,
    /// Amplitude of the drive, as "4 N".
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    p_d: Option<String>,
    /// Stiffness of the stop, as "2.42 kN/m".
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    k2: Option<String>,
    /// Gap between mass and stop, as "3.5 mm".
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    delta: Option<String>,
    /// Any parameter: m1, m2, k1, c, k2, delta, p_d, omega, mu_s, mu_d, v_s, g, c1, c2, and those of the family of capsules, as
    /// duty, incline or k3 (capsulemap help book family has all); of another model or a system, those that it has. Several in a list, or each
    /// by an option of its own.
    #[arg(long, value_name = "NAME=VALUE,...")]
    set: Vec<String>,
    /// Start of the motion (r, y1, x2, y2, over folds place, too); at rest by default.
    #[arg(long, value_name = "NAME=VALUE,...", allow_hyphen_values = true)]
    start: Option<String>,
    #[command(flatten)]
    phases: Phases,
    /// Drive cycles to compute in full.
    #[arg(long, default_value_t = 20, allow_negative_numbers = true)]
    cycles: u64,
    /// Relative local error of a step.
    #[arg(long, default_value = "1e-12", allow_negative_numbers = true)]
    tolerance: f64,
    /// Drive cycles within which the motion must settle; if it does not, up to 2048 more are computed with the
    /// linearised flow to distinguish chaos from long periods, and 128 are measured.
    #[arg(long, default_value_t = 2000, allow_negative_numbers = true)]
    max_cycles: u64,
    /// Steps that all of it may take, else the case fails.
    #[arg(long, default_value_t = Protocol::default().max_steps, value_parser = clap::value_parser!(u64).range(1..))]
    max_steps: u64,
    /// Lyapunov exponents that are computed: the largest, or as many as the section has coordinates with the Kaplan-Yorke dimension.
    #[arg(long, value_parser = named(&Exponents::NAMES), default_value = "largest")]
    exponents: Exponents,
    /// Reading of the switching between stick and slip.
    #[arg(long, value_parser = named(&Switching::NAMES), default_value = "filippov")]
    friction_switching: Switching,
    /// Law of resistance to the capsule, with the normal load N = (m1 + m2) g: coulomb-stribeck is mu_d (1 + exp(-|y2|/v_s)) N
    /// while it slides, and rest ends at max(mu_s, 2 mu_d) N; coulomb is mu_d N, and rest ends at max(mu_s, mu_d) N, where one of
    /// mu_s and mu_d given alone is both; medium is c1 y2 + c2 |y2| y2 without rest.
    #[arg(long, value_parser = named(&Resistance::NAMES), default_value = "coulomb-stribeck")]
    resistance: Resistance,
    /// How the force on the mass depends on the phase of the drive: p_d cos(phase); p_0 + p_d for a share `duty` of the period, then
    /// p_0 + p_low, with edges that last a share `rise` of it in a trapezoid; or p_0 + p_d cos(phase) + p_2 cos(2 phase + phase_2).
    /// In place of a force the motion of the mass relative to the capsule may be prescribed: as a sum of two harmonics, or in two or
    /// three phases (capsulemap help book family).
    #[arg(long, value_parser = named(&DriveKind::NAMES), default_value = "harmonic")]
    drive: DriveKind,
    /// What takes up the reaction of the drive: none, as of an external field, or the capsule, as of an actuator in it.
    #[arg(long, value_parser = named(&Reaction::NAMES), default_value = "none")]
    drive_reaction: Reaction,
    /// When the mass leaves a stop that damps: where it met the stop, whose force may pull it before, or where that force falls to zero.
    #[arg(long, value_parser = named(&Release::NAMES), default_value = "geometry")]
    release: Release,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Whether a model is a capsule, on any ground, to which the options of its parameters and choices belong.
fn is_capsule(model: &'static Description) -> bool {
    [&CAPSULE, &CAPSULE_OVER_FOLDS].contains(&model)
}

/// A case as it was asked for, and how to compute it.
struct Request {
    case: Case,
    protocol: Protocol,
    /// What was taken where it was not given.
    notes: Vec<String>,
}

/// A parameter as an option gives it.
struct Given<'t> {
    /// The option, as messages name it.
    option: String,
    parameter: Parameter,
    text: &'t str,
}

impl Simulate {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let Request { case, protocol, notes } = match &self.study {
            Some(study) => self.studied(study)?,
            None => self.request()?,
        };
        let parameters = &case.parameters;
        notes.iter().for_each(|note| notify(&format!("note: {note}")));
        for Remark { text: why, .. } in (parameters.model().rules.remarks)(parameters) {
            notify(&format!("note: {why}"));
        }
        let most = SimulationSize { cycles: self.cycles, events: usize::MAX };
        let simulation = model_of(parameters).simulate(&case, most, protocol.tolerance);
        let orbit = settle_case(&case, &protocol);
        if self.json {
            print(&format!("{:#}\n", case_json(parameters, &simulation, &orbit)))
        } else {
            print(&summary(parameters, &simulation, &orbit))
        }
    }

    /// A case of a study, from another start if one is given.
    fn studied(&self, path: &Path) -> Result<Request, Failure> {
        let study = read_study_or_results(path)?;
        let (index, cases) = (self.case.unwrap_or(0), study.cases());
        if self.case.is_none() && cases != 1 {
            let (shown, last) = (printable(path), cases.saturating_sub(1));
            let why = format!("--case: missing; {shown} has {cases} cases, 0 to {last}");
            return Err(Failure::request(why));
        }
        let replay = Replay::new(&study, index).map_err(|error| match error {
            CampaignError::NoCase { index, cases } => {
                Failure::request(format!("--case {index}: {} has {cases} cases", printable(path)))
            }
            other => other.into(),
        })?;
        let case = match self.start {
            Some(_) => {
                let mut faults = Vec::new();
                let start = self.start(study.base.model(), &mut faults);
                if !faults.is_empty() {
                    return Err(Failure::requests(&faults));
                }
                Case { start, ..replay.as_asked() }
            }
            None => {
                let before = replay.cases_before();
                if before > 0 {
                    notify(&format!(
                        "case {index} starts where its neighbour settles: {before} cases come before it"
                    ));
                }
                replay.as_run(Machine::default(), &silent)?
            }
        };
        Ok(Request { case, protocol: *replay.protocol(), notes: study.remarks })
    }

    fn request(&self) -> Result<Request, Failure> {
        let mut faults = Vec::new();
        let model = match &self.system {
            Some(file) => read_system(file)?,
            None => self.chosen_model(&mut faults),
        };
        let mut parameters = Parameters::of(model);
        if is_capsule(model) {
            parameters.switch_by(self.friction_switching);
            parameters.resist_by(self.resistance);
            parameters.drive_by(self.drive);
            parameters.react_on(self.drive_reaction);
            parameters.release_by(self.release);
        } else {
            faults.extend(self.options_of_capsules().map(|option| {
                format!("{option}: is an option of capsules; parameters of the model {} are given by --set", model.name)
            }));
        }
        let given = self.given(model, &mut faults);
        set_given(&mut parameters, &given, &mut faults);
        let completed = (model.rules.complete)(&mut parameters, &|parameter| {
            given.iter().any(|it| it.parameter == parameter)
        });
        let mut notes: Vec<String> = completed.map(|it| it.why).into_iter().collect();
        let of_options: Vec<Parameter> = given.iter().map(|it| it.parameter).collect();
        notes.extend(given_without_effect(&parameters, &of_options));
        let start = self.start(model, &mut faults);
        let [start_phase, section_phase] = self.phases.read(model, &mut faults);
        if !Protocol::TOLERANCES.contains(&self.tolerance) {
            faults.push(format!("--tolerance {}: must lie between 1e-15 and 1e-3", self.tolerance));
        }
        faults.extend(parameters.faults().iter().map(ToString::to_string));
        let conflicts = (model.rules.conflicts)(&parameters, section_phase);
        faults.extend(conflicts.into_iter().map(|it| it.text));
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        let protocol = Protocol {
            max_cycles: self.max_cycles,
            max_steps: self.max_steps,
            exponents: self.exponents,
            ..Protocol::with_tolerance(self.tolerance)
        };
        let case = Case { parameters, start, start_phase, section_phase };
        Ok(Request { case, protocol, notes })
    }

    /// The parameters that options give, as they are written.
    fn given(&self, model: &'static Description, faults: &mut Vec<String>) -> Vec<Given<'_>> {
        let own = [
            ("--omega", capsule::Parameter::Omega, &self.omega),
            ("--p-d", capsule::Parameter::Pd, &self.p_d),
            ("--k2", capsule::Parameter::K2, &self.k2),
            ("--delta", capsule::Parameter::Delta, &self.delta),
        ];
        let mut given = Vec::new();
        for (option, parameter, text) in own {
            if let Some(text) = text.as_ref().filter(|_| is_capsule(model)) {
                let (option, parameter) = (option.to_owned(), parameter.into());
                given.push(Given { option, parameter, text });
            }
        }
        for (name, text) in pairs("--set", self.set.iter().flat_map(|it| it.split(',')), faults) {
            match model.parameter(name) {
                Some(parameter) => {
                    given.push(Given { option: format!("--set {name}"), parameter, text });
                }
                None if is_capsule(model) && model.choices.iter().any(|it| it.name == name) => {
                    let option = name.replace('_', "-");
                    faults.push(format!(
                        "--set {name}: is chosen, not a value: write --{option} {text}"
                    ));
                }
                None => {
                    let symbols = model.parameters().map(|parameter| parameter.symbol());
                    let fault = unknown_of(model, "parameter", name, symbols);
                    faults.push(format!("--set: {fault}"));
                }
            }
        }
        given
    }

    /// The options that only a capsule has, of those that are given otherwise than usual.
    fn options_of_capsules(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("--omega", self.omega.is_some()),
            ("--p-d", self.p_d.is_some()),
            ("--k2", self.k2.is_some()),
            ("--delta", self.delta.is_some()),
            ("--friction-switching", self.friction_switching as usize > 0),
            ("--resistance", self.resistance as usize > 0),
            ("--drive", self.drive as usize > 0),
            ("--drive-reaction", self.drive_reaction as usize > 0),
            ("--release", self.release as usize > 0),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(option, _)| option)
    }

    /// The model that is asked for; the usual one where it is not known.
    fn chosen_model(&self, faults: &mut Vec<String>) -> &'static Description {
        let Some(name) = &self.model else { return default_model() };
        let known = model_called(name);
        if known.is_none() {
            let names = all_models().into_iter().map(|it| it.name);
            faults.push(format!("--model: {}", unknown("model", name, names)));
        }
        known.unwrap_or_else(default_model)
    }

    fn start(&self, model: &'static Description, faults: &mut Vec<String>) -> State {
        let mut start = State::origin(model);
        let parts = self.start.iter().flat_map(|text| text.split(','));
        let mut given = Vec::new();
        for (name, text) in pairs("--start", parts, faults) {
            let Some(coordinate) = model.coordinates().find(|it| it.name() == name) else {
                let names = model.coordinates().map(|it| it.name());
                faults.push(format!("--start: {}", unknown("coordinate", name, names)));
                continue;
            };
            if given.contains(&name) {
                faults.push(format!("--start: {name} is given twice"));
            }
            given.push(name);
            let dimension = coordinate.start().dimension;
            let value = read_quantity(&format!("--start {name}"), text, dimension, faults);
            start[coordinate] = value.unwrap_or(0.0);
        }
        start
    }
}

/// The NAME=VALUE pairs among `texts`.
fn pairs<'t>(
    option: &str,
    texts: impl Iterator<Item = &'t str>,
    faults: &mut Vec<String>,
) -> Vec<(&'t str, &'t str)> {
    let mut found = Vec::new();
    for text in texts {
        match text.split_once('=') {
            Some((name, value)) => found.push((name.trim(), value)),
            None => faults.push(format!("{option} {text}: expected NAME=VALUE")),
        }
    }
    found
}

/// Sets the values that are given; faults are noted, as where a parameter is given twice.
fn set_given(parameters: &mut Parameters, given: &[Given<'_>], faults: &mut Vec<String>) {
    for (i, Given { option, parameter, text }) in given.iter().enumerate() {
        let stead =
            parameter.replaces().filter(|it| given.iter().any(|other| other.parameter == *it));
        if let Some(replaced) = stead {
            let (own, replaced) = (parameter.symbol(), replaced.symbol());
            faults.push(format!(
                "{option}: {own} stands in place of {replaced}: leave one of them out"
            ));
        }
        if given[..i].iter().any(|other| other.parameter == *parameter) {
            faults.push(format!("{option}: {} is given twice", parameter.symbol()));
        }
        let value = read_quantity(option, text, parameter.dimension(), faults);
        parameters[*parameter] = value.unwrap_or(parameters[*parameter]);
    }
}
