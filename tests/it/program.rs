//! The program as its users run it: the real binary, in a folder of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use capsulemap::capsule::Parameter;
use capsulemap::description::Presence;
use serde_json::Value;
use tempfile::TempDir;

/// The paper's Fig 5 as the beginning of a study.
pub const FIG5: &str = "\
[parameters]
omega = \"77.91 rad/s\"
p_d = \"4 N\"
k2 = \"2.42 kN/m\"
delta = \"3.5 mm\"
";

/// The capsule of `studies/hysteresis.toml`, which has two motions, without a frequency.
pub const TWO_MOTIONS: &str = r#"[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
p_d = "2.79 N"
k2 = "65.518 kN/m"
delta = "4.33 mm"
"#;

/// A study that is quickly swept and continued.
pub const CASES_AND_BRANCH: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "30 rad/s"
points = 40
[protocol]
points = 1
impact_points = 0
[[branches]]
name = "b"
along = "omega"
at = { omega = "20.73 rad/s" }
from = "19 rad/s"
to = "28 rad/s"
"#;

/// The parameters that every capsule has.
pub fn of_the_paper() -> impl Iterator<Item = &'static Parameter> {
    Parameter::ALL.iter().filter(|it| it.presence() == Presence::Always)
}

/// An empty folder to run the program in.
pub struct WorkDir {
    folder: TempDir,
    /// The program.
    program: PathBuf,
}

/// What came of a run.
pub struct Ran {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl WorkDir {
    /// A new, empty one.
    pub fn new() -> Self {
        WorkDir::of(PathBuf::from(env!("CARGO_BIN_EXE_capsulemap")))
    }

    /// A new, empty one to run another program in.
    pub fn of(program: PathBuf) -> Self {
        WorkDir { folder: TempDir::new().expect("a folder for the test"), program }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// Puts a file there.
    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("a file of the test");
    }

    /// The program, to be started with `arguments` in the folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(self.folder()).stdin(Stdio::null());
        command
    }

    /// Runs the program to its end.
    pub fn run(&self, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).output().expect("the program starts"))
    }

    /// Runs the program with its output in `shell` words: `$0` is the program.
    pub fn shell(&self, script: &str) -> Ran {
        let mut bash = Command::new("bash");
        bash.args(["-c", script]).arg(&self.program);
        Ran::from(bash.current_dir(self.folder()).output().expect("bash starts"))
    }

    /// Every file and folder below, in order.
    pub fn files(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![self.folder().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("a folder can be listed") {
                let path = entry.expect("an entry of a folder").path();
                let inside = path.strip_prefix(self.folder()).expect("it lies below");
                found.push(inside.to_string_lossy().into_owned());
                if path.is_dir() {
                    folders.push(path);
                }
            }
        }
        found.sort();
        found
    }
}

impl Ran {
    /// What came of a run that has ended.
    pub fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program writes UTF-8");
        Ran {
            code: output.status.code().expect("the program was not killed"),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }

    /// The same, sure that the exit code was zero.
    pub fn done(self) -> Self {
        assert_eq!(self.code, 0, "{}", self.err);
        self
    }

    /// The one JSON object on standard output.
    pub fn json(&self) -> Value {
        assert_eq!(self.code, 0, "{}", self.err);
        serde_json::from_str(&self.out).expect("one JSON object")
    }

    /// Sure that a person's mistake was reported, each of `parts` named, and nothing else printed.
    pub fn refused(&self, parts: &[&str]) {
        assert_eq!((self.code, self.out.as_str()), (2, ""), "{}", self.err);
        for part in parts {
            assert!(self.err.contains(part), "{part:?} is missing from:\n{}", self.err);
        }
        assert!(!self.err.contains("panicked"), "{}", self.err);
    }

    /// A number of the orbit that `simulate --json` printed; not a number where that is null, as infinity is.
    pub fn printed(&self, key: &str) -> f64 {
        self.json()["orbit"].get(key).expect(key).as_f64().unwrap_or(f64::NAN)
    }
}
