//! The file of results that is explored, and cases near those it has.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;

use super::answer::Refusal;
use super::firsts::Firsts;
use crate::campaign::{CampaignError, study_of};
use crate::description::{Description, Output, Section, State};
use crate::figure::variables;
use crate::motion::Case;
use crate::orbit::{Outcome, Protocol};
use crate::store::catalogue::{OUTCOME, section};
use crate::store::{Archive, Dataset};
use crate::study::axis::{is_within, set};
use crate::study::{Axis, CaseSet, Coordinate, Direction, Drawing, Range, Study};

/// Which part of the results is wanted: the names of variables, and the places along axes at which cases are held.
type Part = (BTreeSet<String>, BTreeMap<String, usize>);

/// A file of results with its study.
pub struct Explored {
    /// The results.
    pub archive: Archive,
    /// Their file, as commands name it.
    pub file: PathBuf,
    /// The study.
    pub study: Study,
    /// What the last map was drawn from.
    last: Mutex<Option<(Part, Arc<Dataset>)>>,
    /// What clicks ask for.
    firsts: Firsts,
}

/// A case near those of the file.
pub struct Near {
    /// The case.
    pub case: Case,
    /// The number of the nearest case of the file.
    pub index: usize,
    /// The place of that case along each dimension of the results.
    pub position: Vec<usize>,
    /// Whether it has the parameters and the start of that case.
    pub is_exact: bool,
    /// Where it starts, in words.
    pub start: String,
}

/// What a file has of the motion of a case.
pub struct Kept {
    /// Its speed, of models that have one.
    pub speed: Option<f64>,
    /// A section point of its motion, where that does not repeat.
    pub point: Option<Section>,
}

impl Explored {
    /// The results in `archive`, the file at `file`.
    ///
    /// Fails if the text of the study has faults for this version of the program.
    pub fn new(archive: Archive, file: &Path) -> Result<Explored, CampaignError> {
        let study = study_of(&archive, file)?;
        if let Some(path) = study.axes().iter().find(|axis| axis.path.is_some()) {
            let why = format!(
                "its cases lie along the path `{}`, which the page cannot show; `capsulemap figure` draws them",
                path.name()
            );
            return Err(CampaignError::Path { path: file.to_owned(), fault: why });
        }
        let (file, last) = (file.to_owned(), Mutex::new(None));
        Ok(Explored { archive, file, study, last, firsts: Firsts::default() })
    }

    /// What `answer` gives from the results, if their file is as it was when it was opened and checked: before and after.
    pub fn answer<T>(
        &self,
        answer: impl FnOnce(&Explored) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        self.check()?;
        let told = answer(self);
        self.check().and(told)
    }

    /// Fails if the file has changed since it was opened.
    fn check(&self) -> Result<(), Refusal> {
        self.archive.check().map_err(|error| Refusal::unread(&error))
    }

    /// What a figure is drawn from.
    pub fn dataset(&self, drawing: &Drawing) -> Result<Arc<Dataset>, Refusal> {
        self.part(variables(drawing, self.archive.frame().model()), drawing)
    }

    /// The variables of these names in the plane that `drawing` names, where it names both axes; of a large file no more is
    /// read. The last that were read are kept.
    pub fn part(
        &self,
        names: BTreeSet<String>,
        drawing: &Drawing,
    ) -> Result<Arc<Dataset>, Refusal> {
        let part = (names, self.held(drawing)?);
        let mut last = self.last.lock().unwrap_or_else(|it| it.into_inner());
        if let Some((_, dataset)) = last.as_ref().filter(|it| it.0 == part) {
            return Ok(dataset.clone());
        }
        // Of large files not both are held.
        *last = None;
        let dataset = self.archive.labelled_at(&part.1, |name| part.0.contains(name));
        let dataset = Arc::new(dataset.map_err(|error| Refusal::unread(&error))?);
        *last = Some((part, dataset.clone()));
        Ok(dataset)
    }

    /// The places along the axes that a plane does not show; none where the drawing does not name both of its axes.
    ///
    /// Fails if an axis is held where it has no value.
    fn held(&self, drawing: &Drawing) -> Result<BTreeMap<String, usize>, Refusal> {
        let (Some(x), Some(y)) = (&drawing.x, &drawing.y) else { return Ok(BTreeMap::new()) };
        let mut held = BTreeMap::new();
        for axis in self.study.axes() {
            let name = axis.name();
            if name != x && name != y {
                let wanted = drawing.at.get(name);
                let place = wanted.map_or(Ok(0), |wanted| place_along(axis, *wanted))?;
                held.insert(name.to_owned(), place);
            }
        }
        Ok(held)
    }

    /// The model of its results.
    pub fn model(&self) -> &'static Description {
        self.study.base.model()
    }

    /// Whether the file has an output of its cases.
    pub fn has(&self, output: Output) -> bool {
        self.archive.unit(output.name()).is_some()
    }

    /// What the study draws; nothing where its cases lie on a grid.
    pub fn ranges(&self) -> &[Range] {
        match &self.study.case_set {
            CaseSet::Draws(draws) => &draws.ranges,
            CaseSet::Grid(_) => &[],
        }
    }

    /// How cases are integrated and judged here: with the tolerance and the budget of the study, which are what the command of
    /// a case can say.
    pub fn protocol(&self) -> Protocol {
        let own = &self.study.protocol;
        Protocol {
            max_cycles: own.max_cycles,
            max_steps: own.max_steps,
            exponents: own.exponents,
            ..Protocol::with_tolerance(own.tolerance)
        }
    }

    /// The case with these parameters and coordinates of the start; what is not given is as in the study, or at the first value
    /// of its axis.
    ///
    /// It starts as the study says, but for the coordinates of the start that are given. Where starts are inherited and none is given, it starts at a section point of the
    /// motion of the nearest case, of those swept in the direction `sweep` where there are several.
    pub fn near(
        &self,
        given: &[(Coordinate, f64)],
        sweep: Option<Direction>,
    ) -> Result<Near, Refusal> {
        let mut position = self.nearest(given);
        if let (Some(directions), Some(sweep)) = (self.study.direction_axis(), sweep) {
            let place = directions.iter().position(|it| *it == sweep);
            let place = place.ok_or_else(|| Refusal::unfit("sweep: these results have no such"))?;
            position[self.study.axes().len()] = place;
        }
        let index = position
            .iter()
            .zip(self.study.shape())
            .fold(0, |at, (place, length)| at * length + place);
        let mut case = self.study.case(index);
        let asked = case.clone();
        for (coordinate, value) in given {
            set(&mut case, *coordinate, *value);
        }
        let is_exact = case == asked;
        let faults: Vec<String> =
            case.parameters.faults().iter().map(ToString::to_string).collect();
        if !faults.is_empty() {
            return Err(Refusal::unfit(faults.join("; ")));
        }
        let start = if given.iter().any(|(it, _)| it.is_start()) {
            "where it was asked to".to_owned()
        } else if self.study.inherit().is_none() {
            "as the study says".to_owned()
        } else if self.start_at_motion(&mut case, index, &position)? {
            format!("at the motion of case {index}")
        } else {
            "as the study says: the nearest case has no motion".to_owned()
        };
        Ok(Near { case, index, position, is_exact, start })
    }

    /// Lets a case start at a section point of the motion of the case at a place; says whether that has one.
    fn start_at_motion(
        &self,
        case: &mut Case,
        index: usize,
        position: &[usize],
    ) -> Result<bool, Refusal> {
        let Some(point) = self.section_point(index, position)? else {
            return Ok(false);
        };
        case.start = State::at_section(self.model(), &point);
        case.start_phase = case.section_phase;
        Ok(true)
    }

    /// Where the nearest case is along each dimension of the results.
    fn nearest(&self, given: &[(Coordinate, f64)]) -> Vec<usize> {
        let along_axes = self.study.axes().iter().map(|axis| {
            let found = given.iter().find_map(|it| Some((axis.values_of(it.0)?, it.1)));
            found.map_or(0, |(values, wanted)| nearest(values, wanted))
        });
        along_axes.chain(std::iter::repeat(0)).take(self.study.shape().len()).collect()
    }

    /// The first section point that the file has of the motion of a case, if it has one.
    fn section_point(&self, index: usize, position: &[usize]) -> Result<Option<Section>, Refusal> {
        let coordinates = section(self.model()).into_iter();
        let point: Section = coordinates
            .map(|entry| self.first(entry.name, index, position))
            .collect::<Result<_, Refusal>>()?;
        Ok(Some(point).filter(|point| point.iter().all(|it| it.is_finite())))
    }

    fn first(&self, name: &str, index: usize, position: &[usize]) -> Result<f64, Refusal> {
        let first = self.firsts.first(&self.archive, name, index, position);
        first.map_err(|error| Refusal::unread(&error))
    }

    /// What the file has of the motion of a case, if it is one of its own.
    pub fn kept(&self, near: &Near) -> Result<Option<Kept>, Refusal> {
        let Near { index, position, .. } = near;
        if !near.is_exact || !self.archive.has_cases() {
            return Ok(None);
        }
        let code = self.first(OUTCOME.name, *index, position)?;
        let speed = match self.model().has_trade_off() {
            true => Some(self.first(self.model().speed().name(), *index, position)?),
            false => None,
        };
        // A motion that repeats is found in less time than its section point is read.
        let is_aperiodic =
            [Outcome::Chaotic, Outcome::QuasiPeriodic].iter().any(|it| *it as i64 as f64 == code);
        let point = match is_aperiodic {
            true => self.section_point(*index, position)?,
            false => None,
        };
        Ok(Some(Kept { speed: speed.filter(|it| it.is_finite()), point }))
    }

    /// Reads what clicks ask for, on a thread of its own, after the first click.
    pub fn expect_clicks(self: &Arc<Explored>) {
        let cases = self.study.cases();
        if self.firsts.begin(cases) {
            let explored = self.clone();
            // Without the thread each case is read by itself.
            let _ = thread::Builder::new()
                .spawn(move || explored.firsts.read(&explored.archive, cases));
        }
    }
}

/// The place of a value along an axis.
///
/// Fails if the axis does not have it.
fn place_along(axis: &Axis, wanted: f64) -> Result<usize, Refusal> {
    let values = axis.single().map_or(&[][..], |it| &it.values);
    let place = nearest(values, wanted);
    if is_within(wanted, &values[place..=place]) {
        return Ok(place);
    }
    let (name, near) = (axis.name(), values[place]);
    Err(Refusal::unfit(format!("{name}: its axis has no value {wanted}; the nearest is {near}")))
}

/// The place of the value that is nearest to a wanted one.
fn nearest(values: &[f64], wanted: f64) -> usize {
    let distances = values.iter().map(|value| (value - wanted).abs()).enumerate();
    distances.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(place, _)| place)
}
