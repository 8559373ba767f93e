//! A disk that fills up in the middle of a run and while blocks are joined, and has room again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::kept_searches::{self, REFINE, SEARCHES};
use super::program::WorkDir;
use super::store::say;

/// More than a megabyte of blocks.
const STUDY: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "p_d"
from = "2 N"
to = "8 N"
points = 80
[[axes]]
name = "omega"
from = "18 rad/s"
to = "80 rad/s"
points = 100
[protocol]
max_cycles = 40
exponent_cycles = 0
points = 8
impact_points = 0
"#;

/// A file system of a size that can be changed, in memory.
struct Disk(PathBuf);

impl Disk {
    /// One of so many kB; none where the system does not let us.
    fn mount(folder: &Path, kilobytes: usize) -> Option<Disk> {
        fs::create_dir(folder).expect("a folder to mount on");
        let size = format!("size={kilobytes}k");
        let mount =
            Command::new("mount").args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(folder).output();
        mount.is_ok_and(|it| it.status.success()).then(|| Disk(folder.to_owned()))
    }

    fn resize(&self, kilobytes: usize) {
        let size = format!("remount,size={kilobytes}k");
        let done = Command::new("mount").args(["-o", &size]).arg(&self.0).status();
        assert!(done.expect("mount starts").success(), "the disk has another size");
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // A test that fails leaves the disk busy at worst; it goes with the machine.
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

#[test]
fn a_disk_that_fills_stops_the_run_and_room_lets_it_go_on() {
    let dir = WorkDir::new();
    let Some(disk) = Disk::mount(&dir.path("disk"), 600) else {
        say("SKIPPED: a disk that fills (a file system cannot be mounted here)");
        return;
    };
    dir.put("a.toml", STUDY);
    let sweep = |output: &str| {
        let mut command = dir.command(&["sweep", "a.toml", "--no-figures", "--output", output]);
        let output = command.env("SOURCE_DATE_EPOCH", "1700000000").output();
        super::program::Ran::from(output.expect("the program starts"))
    };
    sweep("whole.h5").done();
    let undisturbed = fs::read(dir.path("whole.h5")).expect("a result");
    // While cases are computed, and while blocks are joined.
    let mut stops = [0, 0];
    let mut kilobytes = 600;
    loop {
        let ran = sweep("disk/a.h5");
        if ran.code == 0 {
            break;
        }
        stops[usize::from(ran.err.contains("a.h5: making room for the results"))] += 1;
        assert_eq!((ran.code, ran.out.as_str()), (3, ""), "{}", ran.err);
        assert!(ran.err.contains("No space left on device"), "{}", ran.err);
        assert!(ran.err.contains("free some space and run again"), "{}", ran.err);
        assert!(!ran.err.contains("panicked"), "{}", ran.err);
        assert!(!dir.path("disk/a.h5").exists(), "nothing half-written has the name of a result");
        kilobytes += 400;
        disk.resize(kilobytes);
        assert!(kilobytes < 40_000, "there is room enough: {}", ran.err);
    }
    assert!(stops.iter().all(|count| *count > 0), "the disk was full in both: {stops:?}");
    assert!(fs::read(dir.path("disk/a.h5")).expect("a result") == undisturbed);
    assert_eq!(
        fs::read_dir(dir.path("disk")).expect("the disk").count(),
        1,
        "nothing else is left"
    );
}

#[test]
fn a_disk_that_fills_stops_a_refinement_and_keeps_its_searches() {
    let dir = kept_searches::swept(kept_searches::STUDY);
    let whole = dir.run(&REFINE).done();
    let all = kept_searches::lines(&dir);
    let bytes = fs::metadata(dir.path(SEARCHES)).expect("searches").len();
    // The results go to a disk with room for no search.
    fs::rename(dir.path("results/study"), dir.path("kept")).expect("it is moved");
    let Some(disk) = Disk::mount(&dir.path("results/study"), 4096) else {
        say("SKIPPED: a disk that fills in a refinement (a file system cannot be mounted here)");
        return;
    };
    let size = fs::copy(dir.path("kept/study.h5"), dir.path("results/study/study.h5"));
    let mut kilobytes = size.expect("a copy").div_ceil(4096) as usize * 4 + 8;
    disk.resize(kilobytes);
    let (mut stops, mut kept) = (0, 0);
    loop {
        let ran = dir.run(&REFINE);
        let now = kept_searches::lines(&dir);
        assert!(now.len() >= kept && now.is_subset(&all), "a search is lost");
        kept = now.len();
        if ran.code == 0 {
            assert_eq!(ran.out, whole.out);
            break;
        }
        stops += 1;
        assert_eq!((ran.code, ran.out.as_str()), (3, ""), "{}", ran.err);
        assert!(ran.err.contains("No space left on device"), "{}", ran.err);
        assert!(!ran.err.contains("panicked"), "{}", ran.err);
        kilobytes += bytes as usize / 3000 + 4;
        disk.resize(kilobytes);
        assert!(stops < 12, "there is room enough: {}", ran.err);
    }
    assert!(stops > 1 && kept_searches::lines(&dir) == all, "{stops}");
}
