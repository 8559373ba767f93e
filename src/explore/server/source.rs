//! Where the results come from: a file, or a run that is under way, of which what is computed so far is read again and again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::answer::Refusal;
use super::explored::Explored;
use super::private_folder::PrivateFolder;
use crate::campaign::{Campaign, CampaignError, silent};
use crate::store::{self, Archive};
use crate::study::Study;

/// Between two looks at the blocks of a run.
const PAUSE: Duration = Duration::from_secs(2);
/// Blocks are joined again after so many times as long as the last joining took.
const RARELY: u32 = 4;

/// The folder of the partial results of a run, in that of the server.
const PARTIAL: &str = "partial";

/// The results that the page shows now.
pub struct Source {
    /// The file, as commands name it.
    file: PathBuf,
    now: Mutex<Now>,
}

struct Now {
    /// None where the file could not be opened anew.
    explored: Option<Arc<Explored>>,
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
    folder: Arc<PrivateFolder>,
}

impl Source {
    /// The results in `archive`, the file at `file`.
    ///
    /// Fails if the text of the study has faults for this version of the program.
    pub fn of_file(archive: Archive, file: &Path) -> Result<Source, CampaignError> {
        let explored = Some(Arc::new(Explored::new(archive, file)?));
        Ok(Source { file: file.to_owned(), now: Mutex::new(Now { explored, run: None }) })
    }

    /// The results of a study that go to `output`: all of them, or what its run has computed so far, which is joined again as
    /// the run goes on, into a file in `folder`.
    ///
    /// Fails if nothing of the study has been computed, or its blocks cannot be read or joined.
    pub fn of_study(
        study: Study,
        output: &Path,
        folder: Arc<PrivateFolder>,
    ) -> Result<Arc<Source>, CampaignError> {
        let campaign = Campaign::new(&study, output);
        if let Some(whole) = campaign.kept()?.filter(|it| it.archive.has_cases()) {
            return Ok(Arc::new(Source::of_file(whole.archive, output)?));
        }
        let followed = Followed { study, output: output.to_owned(), folder };
        let explored = Some(Arc::new(followed.joined()?));
        let run = followed.run()?;
        let now = Mutex::new(Now { explored, run: Some(run) });
        let source = Arc::new(Source { file: output.to_owned(), now });
        // Both end with the process, or when all results are there.
        let (watching, joining, followed) = (source.clone(), source.clone(), Arc::new(followed));
        let watched = followed.clone();
        thread::spawn(move || watching.watch(&watched));
        thread::spawn(move || joining.rejoin(&followed, run.done));
        Ok(source)
    }

    /// The results as they are now.
    ///
    /// Fails where their file could not be opened anew.
    pub fn explored(&self) -> Result<Arc<Explored>, Refusal> {
        self.lock().explored.clone().ok_or_else(|| Refusal::changed(&self.file))
    }

    /// How far the run is; null where all is there.
    pub fn progress(&self) -> Value {
        self.lock().run.map_or(Value::Null, |Run { done, cases, seconds_left, version }| {
            json!({ "done": done, "cases": cases, "seconds_left": seconds_left, "version": version })
        })
    }

    /// Opens the file of the results anew and checks it, after another program has changed it.
    ///
    /// Fails while what was open is read, and where the file is damaged or its study has faults for this version of the
    /// program: there are no results then until it can be opened.
    pub fn open_anew(&self) -> Result<(), Refusal> {
        // Not locked while the file is read: who asks meanwhile is told that it has changed.
        let before = {
            let mut now = self.lock();
            if now.run.is_some() {
                // What a run has computed is joined again, into a file of this program's own.
                return Ok(());
            }
            now.explored.take()
        };
        // HDF5 gives what it knows of a file as long as that is open anywhere in the process.
        if let Some(Err(read)) = before.map(Arc::try_unwrap) {
            self.lock().explored = Some(read);
            return Err(Refusal::busy());
        }
        let opened = store::open(&self.file).map_err(CampaignError::from);
        let explored = opened.and_then(|archive| Explored::new(archive, &self.file));
        let explored = explored.map_err(|error| Refusal::unfit(error.to_string()))?;
        self.lock().explored = Some(Arc::new(explored));
        Ok(())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells how far a run is, until all of its results are there, which are then shown.
    fn watch(&self, followed: &Followed) {
        loop {
            thread::sleep(PAUSE);
            if let Some(whole) = followed.whole() {
                *self.lock() = Now { explored: Some(Arc::new(whole)), run: None };
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
                now.explored = Some(Arc::new(explored));
                shown = done;
            }
            thread::sleep(RARELY * begun.elapsed());
        }
    }
}

impl Followed {
    fn campaign(&self) -> Campaign<'_> {
        Campaign::new(&self.study, &self.output)
    }

    /// What is computed so far.
    fn joined(&self) -> Result<Explored, CampaignError> {
        let name = self.output.file_name().unwrap_or_default();
        // A folder of their own, as who writes results holds the folder, and the server holds its own for as long as it lives.
        let file = self.folder.path().join(PARTIAL).join(name);
        let joined = self.campaign().join_partial_into(&file, &silent)?;
        keep_private(&file).map_err(|said| CampaignError::Refused {
            folder: self.folder.path().to_owned(),
            refused: "the partial results cannot be kept from others",
            said,
        })?;
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

/// Lets nobody but its owner read a file.
fn keep_private(file: &Path) -> io::Result<()> {
    #[cfg(unix)]
    return fs::set_permissions(file, std::os::unix::fs::PermissionsExt::from_mode(0o600));
    #[cfg(not(unix))]
    fs::metadata(file).map(drop)
}
