//! Searches for better motions that are done, kept line by line in a file beside the results.
//!
//! What a search leads to depends on the results, on what it begins with and on what it looks for, and on nothing else. So an
//! interrupted refinement is taken up where it was, and a second one with another seed repeats nothing. The file is JSON lines:
//! first what it belongs to, then each search with the motions found, numbers with all the digits that distinguish them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::capsule::{Output, Outputs, Parameter};
use crate::store::{Archive, LineFile, provenance, read_lines};
use crate::study::Study;

use super::error::CampaignError;
use super::refined_motion::{Led, RefinedMotion, Slopes, Start};

/// The extension of the file, beside that of the results.
const EXTENSION: &str = "searches";
/// The form of the lines; the number is increased with every change.
const FORMAT: &str = "capsulemap searches 2";
/// How the form begins in every version.
const ANY_FORMAT: &str = "capsulemap searches ";

/// Searches that are done.
#[derive(Debug, Default)]
pub struct KeptSearches {
    /// What each has led to, by what it begins with and looks for.
    known: BTreeMap<String, Led>,
    /// Where further ones are kept.
    file: Option<LineFile>,
}

/// The file of the searches between the cases of the results at `path`.
pub fn searches_path(path: &Path) -> PathBuf {
    path.with_extension(EXTENSION)
}

impl KeptSearches {
    /// The searches between the cases of `archive`, the results of `study`, that are kept beside it; nothing is written.
    ///
    /// Fails if the file cannot be read, or is of something else.
    pub fn read(archive: &Archive, study: &Study) -> Result<KeptSearches, CampaignError> {
        let path = searches_path(archive.path());
        let lines = read_lines(&path)?;
        Ok(KeptSearches { known: searches(&lines, (archive, study), &path)?, file: None })
    }

    /// As [`read`](Self::read), open for further searches; with `overwrite` what is kept is removed.
    ///
    /// Fails, too, if another process keeps searches there now.
    pub fn open(
        archive: &Archive,
        study: &Study,
        overwrite: bool,
    ) -> Result<KeptSearches, CampaignError> {
        let path = searches_path(archive.path());
        let (file, mut lines) = LineFile::open(&path)?;
        if overwrite {
            file.clear()?;
            lines.clear();
        }
        let known = searches(&lines, (archive, study), &path)?;
        if lines.is_empty() {
            file.add(&head(archive, study).to_string())?;
        }
        Ok(KeptSearches { known, file: Some(file) })
    }

    /// Number of searches.
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }

    /// Each search in JSON, with what it has led to.
    pub(super) fn each(&self) -> impl Iterator<Item = (&String, &Led)> {
        self.known.iter()
    }

    /// The options of the refinements whose searches are kept, the direction first.
    pub fn refinements(&self) -> BTreeSet<String> {
        let read = |what: &String| -> Option<String> {
            let what: Value = serde_json::from_str(what).ok()?;
            let options =
                format!("--direction {} --of {}", what["moving"].as_str()?, what["of"].as_str()?);
            Some(options + &conditions(&what).unwrap_or_default())
        };
        self.known.keys().filter_map(read).collect()
    }

    /// What a search has led to; it is done now and kept if it has not been.
    pub(super) fn kept_or_found(
        &self,
        what: &Value,
        search: impl FnOnce() -> Result<Led, CampaignError>,
    ) -> Result<Led, CampaignError> {
        if let Some(known) = self.known.get(&what.to_string()) {
            return Ok(known.clone());
        }
        let found = search()?;
        if let Some(file) = &self.file {
            let Led { motions, unsettled } = &found;
            let motions: Vec<Written> = motions.iter().map(Written::of).collect();
            let line = json!({ "search": what, "found": motions, "unsettled": unsettled });
            file.add(&line.to_string())?;
        }
        Ok(found)
    }
}

/// The option of the conditions that a search has kept.
fn conditions(what: &Value) -> Option<String> {
    let parts: Option<Vec<&str>> = what["where"].as_array()?.iter().map(Value::as_str).collect();
    Some(format!(" --where \"{}\"", parts?.join(" and ")))
}

/// What the searches belong to.
fn head(archive: &Archive, study: &Study) -> Value {
    json!({
        "format": FORMAT,
        "fingerprint": study.fingerprint(),
        "results_by": provenance::program(&archive.frame().attributes),
        "searches_by": provenance::program(&provenance::attributes()),
    })
}

/// The searches in the lines of a file.
fn searches(
    lines: &[String],
    (archive, study): (&Archive, &Study),
    path: &Path,
) -> Result<BTreeMap<String, Led>, CampaignError> {
    let other = |what| CampaignError::OtherSearches { path: path.to_owned(), what };
    let Some((first, rest)) = lines.split_first() else { return Ok(BTreeMap::new()) };
    let first: Value =
        serde_json::from_str(first).map_err(|_| other("something else than searches"))?;
    let now = head(archive, study);
    let is_older = first["format"] != now["format"]
        && first["format"].as_str().is_some_and(|it| it.starts_with(ANY_FORMAT));
    if is_older {
        return Err(other("searches by another scheme, of another version of the program"));
    }
    for (key, what) in [
        ("format", "something else than searches"),
        ("fingerprint", "searches of another study"),
        ("results_by", "searches of results of another program"),
        ("searches_by", "searches by another program"),
    ] {
        if first[key] != now[key] {
            return Err(other(what));
        }
    }
    let mut known = BTreeMap::new();
    for line in rest {
        let damaged = || other("a line that is damaged");
        let Line { search, found, unsettled } =
            serde_json::from_str(line).map_err(|_| damaged())?;
        let motions: Option<_> = found.into_iter().map(|it| it.motion(study)).collect();
        let motions = motions.ok_or_else(damaged)?;
        known.insert(search.to_string(), Led { motions, unsettled });
    }
    Ok(known)
}

/// A search and what it has led to.
#[derive(Deserialize)]
struct Line {
    search: Value,
    found: Vec<Written>,
    unsettled: usize,
}

/// A motion as it is written.
#[derive(Serialize, Deserialize)]
struct Written {
    from: Start,
    parameters: BTreeMap<String, Real>,
    section: [f64; 3],
    phase: f64,
    period: u64,
    outputs: BTreeMap<String, Real>,
    sensitivity: BTreeMap<String, [Real; 2]>,
    stationarity: Option<Real>,
    held_by: Vec<String>,
}

/// A number; where JSON has none for it, its name.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(untagged)]
enum Real {
    Finite(f64),
    Other(Other),
}

#[derive(Clone, Copy, Serialize, Deserialize)]
enum Other {
    #[serde(rename = "inf")]
    Infinity,
    #[serde(rename = "-inf")]
    MinusInfinity,
    #[serde(rename = "NaN")]
    NotANumber,
}

impl From<f64> for Real {
    fn from(value: f64) -> Self {
        match value {
            f64::INFINITY => Real::Other(Other::Infinity),
            f64::NEG_INFINITY => Real::Other(Other::MinusInfinity),
            _ if value.is_nan() => Real::Other(Other::NotANumber),
            _ => Real::Finite(value),
        }
    }
}

impl From<Real> for f64 {
    fn from(real: Real) -> Self {
        match real {
            Real::Finite(value) => value,
            Real::Other(Other::Infinity) => f64::INFINITY,
            Real::Other(Other::MinusInfinity) => f64::NEG_INFINITY,
            Real::Other(Other::NotANumber) => f64::NAN,
        }
    }
}

impl Written {
    fn of(motion: &RefinedMotion) -> Written {
        let Slopes { sensitivity, stationarity, held_by } = &motion.slopes;
        let parameter = |it: &Parameter| (it.symbol().to_owned(), motion.parameters[*it].into());
        let output = |it: &Output| (it.name().to_owned(), motion.outputs[*it].into());
        let both =
            |(it, slopes): &(Parameter, [f64; 2])| (it.symbol().to_owned(), slopes.map(Real::from));
        Written {
            from: motion.from,
            parameters: Parameter::ALL.iter().map(parameter).collect(),
            section: motion.section,
            phase: motion.phase,
            period: motion.period,
            outputs: Output::ALL.iter().map(output).collect(),
            sensitivity: sensitivity.iter().map(both).collect(),
            stationarity: stationarity.map(Real::from),
            held_by: held_by.clone(),
        }
    }

    /// The motion; none where something is missing.
    fn motion(self, study: &Study) -> Option<RefinedMotion> {
        // Laws of friction and resistance do not vary.
        let mut parameters = study.base.clone();
        for parameter in Parameter::ALL {
            parameters[*parameter] = (*self.parameters.get(parameter.symbol())?).into();
        }
        let mut outputs = Outputs::unknown();
        for output in Output::ALL {
            outputs[*output] = (*self.outputs.get(output.name())?).into();
        }
        let both = |it: &Parameter| {
            let slopes = self.sensitivity.get(it.symbol())?;
            Some((*it, slopes.map(f64::from)))
        };
        let slopes = Slopes {
            sensitivity: Parameter::ALL.iter().filter_map(both).collect(),
            stationarity: self.stationarity.map(f64::from),
            held_by: self.held_by,
        };
        Some(RefinedMotion {
            from: self.from,
            parameters,
            section: self.section,
            phase: self.phase,
            period: self.period,
            outputs,
            slopes,
        })
    }
}
