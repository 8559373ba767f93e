//! Searches for better motions that are done, kept line by line in a file beside the results.
//!
//! What a search leads to depends on the results, on what it begins with and on what it looks for, and on nothing else. So an
//! interrupted refinement is taken up where it was, and a second one with another seed repeats nothing. The file is JSON lines:
//! first what it belongs to, then each search with the motions found, numbers with all the digits that distinguish them, each line
//! with its checksum. A line that does not fit its own is passed over, and what it held is searched again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::count::count;
use super::error::CampaignError;
use super::refined_motion::{Led, RefinedMotion, Slopes, Start};
use crate::description::{Outputs, Presence, Section};
use crate::quantity::printable::printable;
use crate::store::{Archive, LineFile, Lines, provenance, read_lines, sealed, unsealed};
use crate::study::Study;

/// The extension of the file, beside that of the results.
const EXTENSION: &str = "searches";
/// The form of the lines; the number is increased with every change.
const FORMAT: &str = "capsulemap searches 3";
/// The key of the gain of a search, which one for the gain that the model names does not have.
pub(super) const FOR: &str = "for";
/// How the form begins in every version.
const ANY_FORMAT: &str = "capsulemap searches ";

/// Searches that are done.
#[derive(Debug, Default)]
pub struct KeptSearches {
    /// What each has led to, by what it begins with and looks for.
    known: BTreeMap<String, Led>,
    /// Lines that do not fit their checksums, one that is cut short among them.
    damaged: usize,
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
        let (known, damaged) = searches(&lines, archive, study, &path)?;
        Ok(KeptSearches { known, damaged, file: None })
    }

    /// As [`read`](Self::read), open for further searches; with `overwrite` the searches that are kept are removed, whatever they belong
    /// to.
    ///
    /// Fails, too, if another process keeps searches there now. What is no file of searches stays as it is, with `overwrite`, too.
    pub fn open(
        archive: &Archive,
        study: &Study,
        overwrite: bool,
    ) -> Result<KeptSearches, CampaignError> {
        let path = searches_path(archive.path());
        let (file, lines) = LineFile::open(&path)?;
        let mut has_head = !lines.whole.is_empty();
        let (known, damaged) = match searches(&lines, archive, study, &path) {
            Err(CampaignError::OtherSearches { .. }) | Ok(_) if overwrite => {
                file.clear()?;
                has_head = false;
                (BTreeMap::new(), 0)
            }
            kept => kept?,
        };
        if !has_head {
            file.add(&head(archive, study))?;
        }
        Ok(KeptSearches { known, damaged, file: Some(file) })
    }

    /// How many lines do not fit their checksums, in words; nothing where all of them do.
    pub fn damage(&self, archive: &Archive) -> Option<String> {
        (self.damaged > 0).then(|| {
            let path = searches_path(archive.path());
            format!(
                "{}: lines that do not fit their checksums, cut short or changed: {}; they are not used, and a refinement makes their \
                 searches again",
                printable(&path),
                count(self.damaged)
            )
        })
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
        self.known.keys().filter_map(|what| options(what)).collect()
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
            file.add(&line)?;
        }
        Ok(found)
    }
}

/// The options of the refinement that a search belongs to.
fn options(what: &str) -> Option<String> {
    let what: Value = serde_json::from_str(what).ok()?;
    let (moving, of) = (what["moving"].as_str()?, what["of"].as_str()?);
    let gain = what[FOR].as_str().map_or(String::new(), |it| format!(" --for {it}"));
    let conditions = conditions(&what).unwrap_or_default();
    Some(format!("--direction {moving} --of {of}{gain}{conditions}"))
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

/// The searches in the lines of a file, and how many lines do not fit their checksums.
fn searches(
    lines: &Lines,
    archive: &Archive,
    study: &Study,
    path: &Path,
) -> Result<(BTreeMap<String, Led>, usize), CampaignError> {
    let now = head(archive, study);
    let Some((first, rest)) = lines.whole.split_first() else {
        // A kill may have left the beginning of the first line.
        return match sealed(&now).starts_with(&lines.torn) {
            true => Ok((BTreeMap::new(), 0)),
            false => Err(CampaignError::NoSearches { path: path.to_owned() }),
        };
    };
    if !first.contains(ANY_FORMAT) {
        return Err(CampaignError::NoSearches { path: path.to_owned() });
    }
    // An older scheme has no checksums.
    let head = unsealed(first);
    let is_damaged = head.is_none();
    let first: Value = serde_json::from_str(head.as_ref().unwrap_or(first)).unwrap_or_default();
    if let Some(what) = mismatch(&first, &now) {
        return Err(CampaignError::OtherSearches { path: path.to_owned(), what });
    }
    let found: Vec<_> = rest.iter().map(|line| search(line, study)).collect();
    let damaged = found.iter().filter(|it| it.is_none()).count();
    let damaged = damaged + usize::from(!lines.torn.is_empty()) + usize::from(is_damaged);
    Ok((found.into_iter().flatten().collect(), damaged))
}

/// What a file holds whose first line is not what it would be now; none where it is.
fn mismatch(first: &Value, now: &Value) -> Option<&'static str> {
    let is_older = first["format"] != now["format"]
        && first["format"].as_str().is_some_and(|it| it.starts_with(ANY_FORMAT));
    if is_older {
        return Some("searches by another scheme, of another version of the program");
    }
    let parts = [
        ("format", "a first line that is damaged"),
        ("fingerprint", "searches of another study"),
        ("results_by", "searches of results of another program"),
        ("searches_by", "searches by another program"),
    ];
    parts.into_iter().find(|(key, _)| first[key] != now[key]).map(|(_, what)| what)
}

/// The search in a line, and what it has led to; none where the line has changed.
fn search(line: &str, study: &Study) -> Option<(String, Led)> {
    let Line { search, found, unsettled } = serde_json::from_str(&unsealed(line)?).ok()?;
    let motions: Option<_> = found.into_iter().map(|it| it.motion(study)).collect();
    Some((search.to_string(), Led { motions: motions?, unsettled }))
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
    section: Vec<f64>,
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
        let (parameters, outputs) = (motion.parameters.stated(), motion.outputs.each());
        let slopes = sensitivity.iter().map(|(it, both)| (it.symbol(), both.map(Real::from)));
        Written {
            from: motion.from,
            parameters: parameters
                .map(|(it, value)| (it.symbol().to_owned(), value.into()))
                .collect(),
            section: motion.section.to_vec(),
            phase: motion.phase,
            period: motion.period,
            outputs: outputs.map(|(it, value)| (it.name().to_owned(), value.into())).collect(),
            sensitivity: slopes.map(|(symbol, both)| (symbol.to_owned(), both)).collect(),
            stationarity: stationarity.map(Real::from),
            held_by: held_by.clone(),
        }
    }

    /// The motion; none where something is missing.
    fn motion(self, study: &Study) -> Option<RefinedMotion> {
        if self.section.len() != study.base.model().section.len() {
            return None;
        }
        // Laws of friction and resistance do not vary.
        let mut parameters = study.with_parts();
        for parameter in study.base.model().parameters() {
            if parameter.presence() == Presence::Always || parameters.is_given(parameter) {
                parameters[parameter] = (*self.parameters.get(parameter.symbol())?).into();
            }
        }
        let mut outputs = Outputs::unknown(study.base.model());
        for output in study.base.model().outputs() {
            outputs[output] = (*self.outputs.get(output.name())?).into();
        }
        let sensitivity = study.base.model().parameters().filter_map(|it| {
            let slopes = self.sensitivity.get(it.symbol())?;
            Some((it, slopes.map(f64::from)))
        });
        let slopes = Slopes {
            sensitivity: sensitivity.collect(),
            stationarity: self.stationarity.map(f64::from),
            held_by: self.held_by,
        };
        Some(RefinedMotion {
            from: self.from,
            parameters,
            section: Section::new(&self.section),
            phase: self.phase,
            period: self.period,
            outputs,
            slopes,
        })
    }
}
