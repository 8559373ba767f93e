//! The file of a study's results: where it lies, whose results it holds, and what can be drawn from it.

use std::path::{Path, PathBuf};

use super::figure::{draw_all, file_stem};
use super::{Failure, tell};
use crate::figure::{Needs, needs};
use crate::store::catalogue::STUDY_TEXT;
use crate::store::schema::FINGERPRINT;
use crate::store::{self, Archive, Dataset, has_branches, has_cases};
use crate::study::{Drawing, DrawingKind, Study};

/// The study in the file at `path`.
pub fn read_study(path: &Path) -> Result<Study, Failure> {
    Study::parse(&path.display().to_string(), &text(path)?).map_err(Failure::request)
}

/// The text of a study file.
fn text(path: &Path) -> Result<String, Failure> {
    let name = path.display();
    let bytes = std::fs::read(path)
        .map_err(|error| Failure::request(format!("{name}: cannot be read: {error}")))?;
    if bytes.starts_with(b"\x89HDF") {
        let message = format!("{name}: is a file of results; give the study, a TOML file");
        return Err(Failure::request(message));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|&&byte| byte == b'\n').count() + 1;
        Failure::request(format!("{name}: line {line}: is not text in UTF-8"))
    })
}

/// The file that the results of `study` go to: `output`, or one called as the study is.
pub fn output_path(study: &Path, output: Option<&Path>) -> Result<PathBuf, Failure> {
    let stem = file_stem(study)?;
    let default = || Path::new("results").join(&stem).join(format!("{stem}.h5"));
    let output = output.map_or_else(default, Path::to_owned);
    if output.exists() && !output.is_file() {
        let what = if output.is_dir() { "a folder" } else { "not a plain file" };
        let message = format!("{}: is {what}; name a file", output.display());
        return Err(Failure::request(message));
    }
    if output.extension().is_some_and(|ending| ending == "blocks") {
        let message = format!("{}: that ending is for the folder of blocks", output.display());
        return Err(Failure::request(message));
    }
    // Where a link leads, so that not the link is replaced.
    let output =
        std::fs::canonicalize(&output).ok().filter(|_| output.is_symlink()).unwrap_or(output);
    let same = |path: &Path| std::fs::canonicalize(path).ok();
    if same(&output).is_some_and(|output| Some(output) == same(study)) {
        let message = format!("{}: is the study itself; name another file", output.display());
        return Err(Failure::request(message));
    }
    Ok(output)
}

/// A file of results that is there already.
pub struct Kept {
    /// The file.
    pub archive: Archive,
    /// Whether its study is word for word the same, and not only one with the same cases, of which titles,
    /// figures and branches may differ.
    pub same_words: bool,
}

/// The file `output` of results, if those of the cases of this study by this very program are there; others
/// are refused, or given up where they may be overwritten.
pub fn kept(output: &Path, study: &Study, overwrite: bool) -> Result<Option<Kept>, Failure> {
    if !output.exists() {
        return Ok(None);
    }
    let shown = output.display();
    let advice = "name another --output, or replace it with --overwrite";
    let archive = match store::open(output) {
        Ok(archive) => archive,
        Err(_) if overwrite => return Ok(None),
        Err(error) => {
            return Err(Failure::request(format!("{error}\n{shown} is kept: {advice}")));
        }
    };
    let frame = archive.frame();
    let same_program = store::provenance::is_ours(&frame.attributes);
    let same_words = frame.texts.get(STUDY_TEXT) == Some(&study.text);
    let same_cases = frame.attributes.get(FINGERPRINT) == Some(&study.fingerprint());
    if same_program && (same_words || same_cases) {
        return Ok(Some(Kept { archive, same_words }));
    }
    if overwrite {
        return Ok(None);
    }
    let what = if same_program { "study" } else { "version of the program or study" };
    Err(Failure::request(format!("{shown}: holds results of another {what}; {advice}")))
}

/// The branches that a file of results holds beside which cases are to be put; those of a study in other
/// words are refused, or given up where they may be overwritten.
pub fn branches_of(
    kept: Option<Kept>,
    output: &Path,
    overwrite: bool,
) -> Result<Option<Dataset>, Failure> {
    match kept {
        Some(Kept { archive, same_words: true }) => {
            archive.branches().map(Some).map_err(Failure::machine)
        }
        Some(Kept { archive, .. }) if has_branches(archive.frame()) && !overwrite => {
            Err(Failure::request(format!(
                "{}: holds branches of a study in other words; name another --output, or give them up with \
                 --overwrite",
                output.display()
            )))
        }
        _ => Ok(None),
    }
}

/// Makes the folder of the results, and sees that a file can be written there before a long run.
pub fn prepare(folder: &Path) -> Result<(), Failure> {
    let shown = folder.display();
    let file = folder.ancestors().find(|ancestor| ancestor.is_file());
    if let Some(file) = file {
        return Err(Failure::request(format!(
            "{shown}: {} is a file, not a folder; name another --output",
            file.display()
        )));
    }
    let advice = "choose a place that you may use with --output";
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::machine(format!("{shown}: cannot be made: {error}; {advice}")))?;
    tempfile::tempfile_in(folder).map(drop).map_err(|error| {
        Failure::machine(format!("{shown}: no file can be written there: {error}; {advice}"))
    })
}

/// What a file of results holds.
#[derive(Debug, Clone, Copy)]
pub struct Holds {
    cases: bool,
    branches: bool,
}

impl From<&Dataset> for Holds {
    fn from(dataset: &Dataset) -> Self {
        Holds { cases: has_cases(dataset), branches: has_branches(dataset) }
    }
}

impl From<&Archive> for Holds {
    fn from(archive: &Archive) -> Self {
        Holds { cases: archive.has_cases(), branches: has_branches(archive.frame()) }
    }
}

/// Draws the figures from results without a single value, so that a mistake in one of them is told
/// before a long run and not after it.
pub fn rehearse(empty: &Dataset, drawings: &[Drawing]) -> Result<(), Failure> {
    let ready: Vec<Drawing> =
        drawings.iter().filter(|it| waits_for(it.kind, empty.into()).is_none()).cloned().collect();
    // In no format at all, nothing is written.
    draw_all(empty, &ready, Path::new("."), &[])
}

/// The figures among `drawings` for which there is all that they show; of the others it is told what
/// they wait for.
pub fn ready(holds: Holds, drawings: &[Drawing]) -> Vec<Drawing> {
    let is_ready = |drawing: &&Drawing| match waits_for(drawing.kind, holds) {
        None => true,
        Some(command) => {
            tell(&format!("figure `{}`: waits for `capsulemap {command}`", drawing.name));
            false
        }
    };
    drawings.iter().filter(is_ready).cloned().collect()
}

/// The command that finds what a figure shows and is not there.
fn waits_for(kind: DrawingKind, Holds { cases, branches }: Holds) -> Option<&'static str> {
    match needs(kind) {
        Needs::Branches => (!branches).then_some("follow"),
        Needs::CasesOrBranches => (!cases && !branches).then_some("sweep"),
        Needs::Cases => (!cases && branches).then_some("sweep"),
    }
}
