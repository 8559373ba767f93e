//! A long study, and the file of a run of it without interruption.

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::program::{Ran, WorkDir};

/// A study of one or two seconds in 24 blocks.
pub const LONG_STUDY: &str = r#"title = "A long run"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "p_d"
from = "2 N"
to = "8 N"
points = 96
[[axes]]
name = "omega"
from = "18 rad/s"
to = "80 rad/s"
points = 128
[protocol]
points = 4
impact_points = 2
max_cycles = 300
exponent_cycles = 64
"#;

/// A few blocks that lie in stripes across the results, and attractors to link when they are joined.
pub const LINES: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "80 rad/s"
points = 40
[[axes]]
name = "p_d"
from = "2 N"
to = "8 N"
points = 30
[start]
inherit = "omega"
directions = ["upward", "downward"]
[protocol]
points = 4
impact_points = 0
max_cycles = 300
exponent_cycles = 64
"#;

/// So many random starts, in blocks of 512, and the two attractors that they lead to.
pub fn drawn(count: usize) -> String {
    let start = |name: &str, size: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{size}\"\nto = \"{size}\"\n")
    };
    [
        "[parameters]\nm2 = \"0.2 kg\"\nc = \"1.77 N s/m\"\nmu_s = 0.33\nmu_d = 0.165\np_d = \"2.79 N\"\n",
        "k2 = \"65.518 kN/m\"\ndelta = \"4.33 mm\"\nomega = \"158 rad/s\"\n",
        &format!("[draws]\nkind = \"uniform\"\ncount = {count}\nseed = 1\n"),
        &start("start_r", "4 mm"),
        &start("start_y1", "0.4 m/s"),
        "[protocol]\npoints = 2\nimpact_points = 0\nmax_cycles = 300\nexponent_cycles = 64\n",
    ]
    .concat()
}

/// A folder with the study, and the file of a run without interruption.
pub struct LongRun {
    /// Where it is run.
    pub dir: WorkDir,
    /// The bytes of the file.
    pub undisturbed: Vec<u8>,
}

impl LongRun {
    /// That of `LONG_STUDY`.
    pub fn new() -> LongRun {
        LongRun::of(LONG_STUDY)
    }

    /// That of a study.
    pub fn of(study: &str) -> LongRun {
        let long = LongRun { dir: WorkDir::new(), undisturbed: Vec::new() };
        long.dir.put("long.toml", study);
        long.sweep(&["--output", "whole.h5"]).done();
        let undisturbed = fs::read(long.dir.path("whole.h5")).expect("a result");
        assert!(!long.dir.path("whole.blocks").exists(), "joined blocks are removed");
        LongRun { undisturbed, ..long }
    }

    /// The command with a fixed time of creation, so that files can be compared byte for byte.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.dir.command(arguments);
        command.env("SOURCE_DATE_EPOCH", "1700000000").env_remove("SLURM_ARRAY_TASK_ID");
        command
    }

    /// Runs a command to its end.
    pub fn run(&self, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).output().expect("the program starts"))
    }

    /// Sweeps to the end, without figures.
    pub fn sweep(&self, more: &[&str]) -> Ran {
        self.run(&[&["sweep", "long.toml", "--no-figures"], more].concat())
    }

    /// Starts a sweep without figures.
    pub fn start(&self, more: &[&str]) -> Child {
        let mut command = self.command(&[&["sweep", "long.toml", "--no-figures"], more].concat());
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts")
    }

    /// The file that a sweep writes.
    pub fn file(&self) -> PathBuf {
        self.dir.path("results/long/long.h5")
    }

    /// The file of a block.
    pub fn block(&self, number: usize) -> PathBuf {
        self.dir.path(&format!("results/long/long.blocks/block-{number:07}"))
    }

    /// Names of the blocks that are there.
    pub fn blocks(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.dir.path("results/long/long.blocks"));
        let paths = entries.into_iter().flatten().map(|entry| entry.expect("an entry").path());
        let is_block = |path: &PathBuf| {
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("block-"))
        };
        paths.filter(is_block).collect()
    }

    /// Whether the joined file has been begun, and has no name yet.
    pub fn is_being_joined(&self) -> bool {
        let begun = |name: &String| name.contains("/.long.h5.") && name.ends_with(".tmp");
        self.dir.files().iter().any(begun)
    }

    /// Waits until so many blocks are there.
    pub fn wait_for(&self, blocks: usize) {
        let begun = Instant::now();
        while self.blocks().len() < blocks {
            assert!(begun.elapsed() < Duration::from_secs(120), "no {blocks} blocks came");
            sleep(Duration::from_millis(5));
        }
    }

    /// Sure that the file is that of the undisturbed run, and that nothing else is left.
    pub fn assert_undisturbed(&self) {
        let bytes = fs::read(self.file()).expect("a result");
        assert!(bytes == self.undisturbed, "the file differs from that of an undisturbed run");
        assert!(!self.dir.path("results/long/long.blocks").exists());
        let left = self.dir.files();
        assert!(left.iter().all(|name| !name.ends_with(".tmp")), "{left:?}");
    }

    /// Removes all results.
    pub fn forget(&self) {
        fs::remove_dir_all(self.dir.path("results")).expect("results to forget");
    }
}

/// What a program has said, once it has ended.
pub fn said(child: &mut Child) -> String {
    let mut text = String::new();
    let stderr = child.stderr.as_mut().expect("standard error");
    stderr.read_to_string(&mut text).expect("the program writes UTF-8");
    text
}
