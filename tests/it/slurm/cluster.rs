//! A Slurm of one machine that lives as long as a test: daemons, ports, keys and logs of its own, no root.

use std::fs::{self, Permissions};
use std::io::Read;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Nothing that is waited for takes longer, or something is wrong.
const PATIENCE: Duration = Duration::from_secs(180);
/// A command that Slurm answers at once is ended after so many seconds.
const ANSWER: &str = "30";
/// The daemons; the sbin folders are not on everybody's path.
const DAEMONS: [&str; 3] = ["munged", "slurmctld", "slurmd"];
/// States that a job does not leave by itself.
const ENDED: [&str; 6] =
    ["COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY"];

/// The daemons, and the folder that all they write is in.
pub struct Cluster {
    folder: TempDir,
    daemons: Vec<Child>,
}

impl Cluster {
    /// What this machine lacks for one.
    pub fn lacks() -> Option<String> {
        let others = ["sbatch", "scontrol", "squeue", "scancel", "sinfo", "setpriv", "timeout"];
        let missing: Vec<&str> =
            DAEMONS.into_iter().chain(others).filter(|name| found(name).is_none()).collect();
        (!missing.is_empty()).then(|| missing.join(", "))
    }

    /// Starts one whose node counts as two cores, and waits until it takes jobs.
    pub fn start() -> Self {
        let folder = tempfile::Builder::new().prefix("slurm").tempdir().expect("a folder");
        let mut cluster = Cluster { folder, daemons: Vec::new() };
        cluster.prepare();
        let [munged, control, node] = DAEMONS;
        let [socket, key, pid, seed] = ["munge.socket", "munge.key", "munged.pid", "munge.seed"]
            .map(|name| cluster.path(name).display().to_string());
        let own = [
            format!("--socket={socket}"),
            format!("--key-file={key}"),
            format!("--pid-file={pid}"),
            format!("--seed-file={seed}"),
        ];
        cluster.daemon(munged, &[&["--foreground".into()], own.as_slice()].concat());
        wait("munged", || {
            cluster.assert_alive();
            Path::new(&socket).exists()
        });
        cluster.daemon(control, &["-D".into()]);
        cluster.daemon(node, &["-D".into()]);
        wait("the node to be idle", || {
            cluster.assert_alive();
            cluster.asked("sinfo", &["-h", "-o", "%T"]).0 == "idle"
        });
        cluster
    }

    /// A folder for the jobs.
    pub fn dir(&self) -> PathBuf {
        self.path("dir")
    }

    /// A command that is to be run in the jobs' folder, talks to this cluster, and never hangs.
    pub fn command(&self, program: impl AsRef<Path>) -> Command {
        let mut command = Command::new("timeout");
        command.args(["--kill-after=5", ANSWER]).arg(program.as_ref());
        command.current_dir(self.dir()).env("SLURM_CONF", self.path("slurm.conf"));
        command.stdin(Stdio::null());
        command
    }

    /// Runs a command of Slurm; returns what it printed.
    pub fn run(&self, program: &str, arguments: &[&str]) -> String {
        said(self.command(program).args(arguments))
    }

    /// What Slurm knows of a job by a name of `scontrol show job`, as `JobState`.
    pub fn job(&self, job: &str, name: &str) -> String {
        let shown = self.run("scontrol", &["-o", "show", "job", job]);
        let mut fields = shown.split_whitespace().filter_map(|field| field.split_once('='));
        let field = fields.find(|(key, _)| *key == name);
        field.unwrap_or_else(|| panic!("{name} of job {job}: {shown}")).1.to_owned()
    }

    /// Waits until a job is in `state`, and fails if it has ended in another.
    pub fn wait_for(&self, job: &str, state: &str) {
        wait(&format!("job {job} to be {state}"), || {
            let found = self.job(job, "JobState");
            let ended = ENDED.contains(&found.as_str());
            assert!(found == state || !ended, "job {job} is {found}, not {state}");
            found == state
        });
    }

    /// Waits until a running job has `done` something, and fails if it ends before.
    pub fn wait_while_running(&self, job: &str, done: impl Fn() -> bool) {
        self.wait_for(job, "RUNNING");
        wait(&format!("what job {job} does"), || {
            let running = self.job(job, "JobState") == "RUNNING";
            assert!(done() || running, "job {job} has ended too early");
            done()
        });
    }

    /// Standard output of a command, and whether it succeeded.
    fn asked(&self, program: &str, arguments: &[&str]) -> (String, bool) {
        let output = self.command(program).args(arguments).output().expect("timeout starts");
        (text(&output.stdout), output.status.success())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Puts down what the daemons read. The key is new, so no other user can submit here.
    fn prepare(&self) {
        // munged refuses a folder that not everybody may enter.
        let everybody = Permissions::from_mode(0o755);
        fs::set_permissions(self.folder.path(), everybody).expect("the folder is ours");
        for name in ["dir", "state", "spool"] {
            fs::create_dir(self.path(name)).expect("a folder");
        }
        let mut key = [0; 128];
        let mut random = fs::File::open("/dev/urandom").expect("random bytes");
        random.read_exact(&mut key).expect("random bytes");
        fs::write(self.path("munge.key"), key).expect("a file");
        let owner = Permissions::from_mode(0o400);
        fs::set_permissions(self.path("munge.key"), owner).expect("the key is ours");
        fs::write(self.path("slurm.conf"), self.configuration()).expect("a file");
    }

    /// The shortest configuration of Slurm.
    fn configuration(&self) -> String {
        let user = said(Command::new("id").arg("-un"));
        // Held both at once, so that they differ.
        let ports = [(); 2].map(|()| TcpListener::bind("127.0.0.1:0").expect("a free port"));
        let [control, node] = ports.map(|port| port.local_addr().expect("a port").port());
        let folder = self.folder.path().display();
        // A job that is requeued waits for cred_expire; 5 s is the shortest allowed, 120 s the default.
        // What the node has is only said to be so: nothing here depends on it.
        format!(
            "\
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={control}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SlurmdParameters=config_overrides
KillWait=10
MinJobAge=3600
ReturnToService=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 RealMemory=64000 State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"
        )
    }

    /// Starts a daemon in the foreground, its log being what it prints.
    fn daemon(&mut self, name: &str, arguments: &[String]) {
        let log = fs::File::create(self.path(&format!("{name}.log"))).expect("a file");
        let same = log.try_clone().expect("the same file");
        // Should the test be killed, and have no time to stop it, the kernel does.
        let mut command = Command::new("setpriv");
        command.args(["--pdeathsig", "KILL"]).arg(found(name).expect("it is installed"));
        command.args(arguments).env("SLURM_CONF", self.path("slurm.conf"));
        command.current_dir(self.folder.path());
        command.stdin(Stdio::null()).stdout(log).stderr(same);
        self.daemons.push(command.spawn().expect("the daemon starts"));
    }

    /// Sure that no daemon has given up.
    fn assert_alive(&mut self) {
        for (name, daemon) in DAEMONS.iter().zip(&mut self.daemons) {
            let ended = daemon.try_wait().expect("it is ours");
            assert!(ended.is_none(), "{name} has ended by itself: {ended:?}");
        }
    }

    /// Ends all jobs, so that none outlives the daemons.
    fn end_jobs(&self) {
        let user = said(Command::new("id").arg("-un"));
        let (_, cancelled) = self.asked("scancel", &["--user", &user]);
        let end = Instant::now() + Duration::from_secs(20);
        while cancelled && Instant::now() < end {
            if self.asked("squeue", &["-h"]) == (String::new(), true) {
                return;
            }
            sleep(Duration::from_millis(100));
        }
        eprintln!("the jobs could not be ended");
    }

    /// The last lines of every log, of the daemons and of the jobs.
    fn show_logs(&self) {
        for folder in [self.folder.path(), &self.dir()] {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let path = entry.path();
                if path.extension().is_some_and(|extension| extension == "log") {
                    let log = text(&fs::read(&path).unwrap_or_default());
                    let lines: Vec<&str> = log.lines().collect();
                    let last = lines[lines.len().saturating_sub(40)..].join("\n");
                    eprintln!("== {}\n{last}", path.display());
                }
            }
        }
    }
}

impl Drop for Cluster {
    /// Stops everything, whatever became of the test, and shows the logs if it failed.
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.show_logs();
        }
        if self.daemons.len() == DAEMONS.len() {
            self.end_jobs();
        }
        for daemon in self.daemons.iter_mut().rev() {
            // One that has died by itself needs no end.
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

/// Waits until `done`, and fails if that takes too long.
fn wait(what: &str, mut done: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < end, "waited for {what} in vain");
        sleep(Duration::from_millis(50));
    }
}

/// Runs a command that must succeed; returns what it printed.
pub fn said(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().expect("it starts");
    assert!(status.success(), "{command:?}: {status}\n{}{}", text(&stdout), text(&stderr));
    text(&stdout)
}

/// Where a program is.
fn found(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let sbin = ["/usr/local/sbin", "/usr/sbin", "/sbin"].map(PathBuf::from);
    let mut places = std::env::split_paths(&path).chain(sbin).map(|folder| folder.join(name));
    places.find(|place| place.is_file())
}

/// What was printed, without the end of its last line.
fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_end().to_owned()
}
