//! Where the results come from: a file, or a run that is under way, of which what is computed so far is read again and again.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::explored::Explored;
use crate::campaign::{Campaign, CampaignError, silent};
use crate::store::Archive;
use crate::study::Study;

/// Between two looks at the blocks of a run.
const PAUSE: Duration = Duration::from_secs(2);
/// Blocks are joined again after so many times as long as the last joining took.
const RARELY: u32 = 4;

/// The results that the page shows now.
pub struct Source {
    now: Mutex<Now>,
    /// The folder of the partial results of a run.
    folder: Option<PathBuf>,
}

struct Now {
    explored: Arc<Explored>,
    run: Option<Run>,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Run {
    /// Cases that are done.
    done: usize,
    /// Cases of the study.
    cases: usize,
    /// Time left at the rate of the last blocks [s], if it is known.
    seconds_left: Option<f64>,
    /// How often the results have been read.
    version: u64,
}

/// A run that is under way, with the partial results in a file of this program's own.
struct Followed {
    study: Study,
    output: PathBuf,
    folder: TempDir,
}

impl Source {
    /// The results in `archive`, the file at `file`.
    ///
    /// Fails if the text of the study has faults for this version of the program.
    pub fn of_file(archive: Archive, file: &Path) -> Result<Source, CampaignError> {
        let explored = Arc::new(Explored::new(archive, file)?);
        Ok(Source { now: Mutex::new(Now { explored, run: None }), folder: None })
    }

    /// The results of a study that go to `output`: all of them, or what its run has computed so far, which is joined again as
    /// the run goes on.
    ///
    /// Fails if nothing of the study has been computed, or its blocks cannot be read or joined.
    pub fn of_study(study: Study, output: &Path) -> Result<Arc<Source>, CampaignError> {
        let campaign = Campaign::new(&study, output);
        if let Some(whole) = campaign.kept()?.filter(|it| it.archive.has_cases()) {
            return Ok(Arc::new(Source::of_file(whole.archive, output)?));
        }
        let followed = Followed::new(study, output)?;
        let explored = Arc::new(followed.joined()?);
        let run = followed.run()?;
        let folder = Some(followed.folder.path().to_owned());
        let now = Mutex::new(Now { explored, run: Some(run) });
        let source = Arc::new(Source { now, folder });
        // Both end with the process, or when all results are there.
        let (watching, joining, followed) = (source.clone(), source.clone(), Arc::new(followed));
        let watched = followed.clone();
        thread::spawn(move || watching.watch(&watched));
        thread::spawn(move || joining.rejoin(&followed, run.done));
        Ok(source)
    }

    /// The results as they are now.
    pub fn explored(&self) -> Arc<Explored> {
        self.lock().explored.clone()
    }

    /// How far the run is; null where all is there.
    pub fn progress(&self) -> Value {
        self.lock().run.map_or(Value::Null, |Run { done, cases, seconds_left, version }| {
            json!({ "done": done, "cases": cases, "seconds_left": seconds_left, "version": version })
        })
    }

    /// Removes the partial results of a run, before the process ends.
    pub fn close(&self) {
        if let Some(folder) = &self.folder {
            // What cannot be removed lies in the system's folder of temporary files.
            let _ = std::fs::remove_dir_all(folder);
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells how far a run is, until all of its results are there, which are then shown.
    fn watch(&self, followed: &Followed) {
        loop {
            thread::sleep(PAUSE);
            if let Some(whole) = followed.whole() {
                *self.lock() = Now { explored: Arc::new(whole), run: None };
                return;
            }
            let run = followed.run();
            let mut now = self.lock();
            if let (Some(before), Ok(run)) = (now.run, run) {
                now.run = Some(Run { version: before.version, ..run });
            }
        }
    }

    /// Joins the blocks of a run again as there are more of them, until all of its results are shown.
    fn rejoin(&self, followed: &Followed, mut shown: usize) {
        loop {
            thread::sleep(PAUSE);
            let Some(Run { done, .. }) = self.lock().run else { return };
            if done == shown {
                continue;
            }
            let begun = Instant::now();
            // The run may have ended meanwhile, and its blocks are gone.
            if let Ok(explored) = followed.joined() {
                let mut now = self.lock();
                let Some(run) = now.run else { return };
                now.run = Some(Run { version: run.version + 1, ..run });
                now.explored = Arc::new(explored);
                shown = done;
            }
            thread::sleep(RARELY * begun.elapsed());
        }
    }
}

impl Followed {
    fn new(study: Study, output: &Path) -> Result<Followed, CampaignError> {
        let folder = tempfile::tempdir().map_err(|said| CampaignError::Refused {
            folder: std::env::temp_dir(),
            refused: "no folder can be created there",
            said,
        })?;
        Ok(Followed { study, output: output.to_owned(), folder })
    }

    fn campaign(&self) -> Campaign<'_> {
        Campaign::new(&self.study, &self.output)
    }

    /// What is computed so far.
    fn joined(&self) -> Result<Explored, CampaignError> {
        let name = self.output.file_name().unwrap_or_default();
        let joined = self.campaign().join_partial_into(&self.folder.path().join(name), &silent)?;
        Explored::new(joined.archive, &self.output)
    }

    /// All results, if they are there.
    fn whole(&self) -> Option<Explored> {
        let whole = self.campaign().kept().ok()??;
        let has_cases = whole.archive.has_cases();
        has_cases.then(|| Explored::new(whole.archive, &self.output).ok())?
    }

    /// How far the run is.
    fn run(&self) -> Result<Run, CampaignError> {
        let blocks = self.campaign().status()?.blocks;
        let pace = blocks.as_ref().and_then(|it| it.pace(&self.study));
        Ok(Run {
            done: blocks.as_ref().map_or(0, |it| it.cases()),
            cases: self.study.cases(),
            seconds_left: pace.and_then(|it| it.left).map(|it| it.value),
            version: 0,
        })
    }
}
