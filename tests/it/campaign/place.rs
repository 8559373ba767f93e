//! A folder for a campaign, short studies, and the file of a campaign that nothing interrupts.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use capsulemap::campaign::{Campaign, Complete, Done, Event, Task, block_path, silent};
use capsulemap::store;
use capsulemap::study::Study;
use tempfile::TempDir;

use crate::interrupted_runs::LONG_STUDY;

/// A quarter of a study of many blocks: 6 blocks of 512 cases.
pub fn long_study() -> Study {
    parse(&LONG_STUDY.replace("points = 96", "points = 24"))
}

/// The study in `text`, which has no fault.
pub fn parse(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// An empty folder, and the file of results in it.
pub fn place() -> (TempDir, PathBuf) {
    let folder = TempDir::new().expect("a folder for the test");
    let output = folder.path().join("a.h5");
    (folder, output)
}

/// The names of what is in a folder.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder can be listed");
    entries.map(|it| it.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

/// The bytes of a file of results but for the time in `created`, and the checksum of all that is at the end.
pub fn timeless(path: &Path) -> Vec<u8> {
    let archive = store::open(path).expect("a result");
    let created = archive.frame().attributes["created"].clone().into_bytes();
    let mut bytes = fs::read(path).expect("a result");
    bytes.truncate(bytes.len() - 4);
    let found = |bytes: &[u8]| bytes.windows(created.len()).position(|it| it == created);
    let at = found(&bytes).expect("the time is in the file");
    bytes[at..at + created.len()].fill(b'-');
    assert_eq!(found(&bytes), None, "the time is in one place");
    bytes
}

/// The file of a campaign that nothing interrupts, without its time.
pub fn uninterrupted(study: &Study) -> Vec<u8> {
    let (_folder, output) = place();
    let done = Campaign::new(study, &output).run(Task::WHOLE, &silent).expect("the study runs");
    assert!(matches!(done, Done::Complete(Complete { path, .. }) if path == output));
    assert!(!block_path(&output).exists());
    timeless(&output)
}

/// A listener that asks to stop when so many events that are `counted` have come.
pub fn after(
    most: usize,
    counted: impl Fn(Event<'_>) -> bool + Sync,
) -> impl Fn(Event<'_>) -> ControlFlow<()> + Sync {
    let seen = AtomicUsize::new(0);
    move |event| match counted(event) && seen.fetch_add(1, Ordering::Relaxed) + 1 >= most {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}
