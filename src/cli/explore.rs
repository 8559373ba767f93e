//! `capsulemap explore`: results in the browser, of a file or of a run that is under way.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

use clap::Args;

use super::arguments::study_arguments;
use super::failure::Failure;
use super::stop::say_when_stopped;
use super::terminal::{notify, print};
use crate::campaign::{CampaignError, output_path, read_study};
use crate::explore::{PrivateFolder, Server, Source};
use crate::quantity::printable::printable;
use crate::store::{self, StoreError};

const EXAMPLES: &str = "\
Examples:
  capsulemap explore results/overview/overview.h5
  capsulemap explore STUDY.toml
  capsulemap explore FILE.h5 --no-browser --port 8123

Click a cell of the map for its motion, computed at once. Of a study whose run is under way, the map shows what is computed so \
far and grows. The page is on this machine alone (127.0.0.1), and the address that is printed opens it once, in one browser. On \
another machine, pass the port on with `ssh -L 8123:127.0.0.1:8123 HOST` and open the address there. Ctrl-C ends it.";

/// Look at results in the browser: click a cell of a map, see its motion.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Explore {
    /// The file of results, or a study, a TOML file, whose run is under way or done.
    #[arg(value_name = "FILE.h5|STUDY.toml")]
    file: PathBuf,
    /// The file that the sweep of a study writes; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Port of the page; one that is free by default.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Print the address and open no browser.
    #[arg(long)]
    no_browser: bool,
}

impl Explore {
    /// Carries the command out; it ends when the program is stopped.
    pub fn run(&self) -> Result<(), Failure> {
        let folder = Arc::new(private_folder()?);
        let source = self.source(folder.clone())?;
        let server = Server::bind(self.port, folder.clone()).map_err(|said| {
            Failure::request(format!("--port {}: cannot be listened on: {said}", self.port))
        })?;
        let address = server.address().map_err(Failure::machine)?;
        say_when_stopped(move || {
            folder.close();
            "the page has ended".to_owned()
        })?;
        print(&format!("{address}\n"))?;
        if !self.no_browser && !server.redirect().is_ok_and(|page| opened(&page)) {
            notify("no browser could be opened: open the address above by hand; Ctrl-C ends");
        }
        server.run(source).map_err(Failure::machine)
    }

    /// The results to look at; those of a run that is under way are joined in `folder`.
    fn source(&self, folder: Arc<PrivateFolder>) -> Result<Arc<Source>, Failure> {
        if !is_study(&self.file) {
            if self.output.is_some() {
                let why = "--output: goes with a study, and the results are named already";
                return Err(Failure::request(why));
            }
            let archive = store::open(&self.file).map_err(Failure::request)?;
            return Ok(Arc::new(Source::of_file(archive, &self.file)?));
        }
        let study = read_study(&self.file)?;
        let output = output_path(&self.file, self.output.as_deref())?;
        Source::of_study(study, &output, folder).map_err(|error| match error {
            CampaignError::Store(StoreError::NoBlocks { .. }) => {
                let arguments = study_arguments(&self.file, self.output.as_deref());
                let file = printable(&self.file);
                Failure::request(format!(
                    "{file}: nothing is computed yet; `capsulemap sweep {arguments}` begins"
                ))
            }
            // Nothing is replaced by looking at it.
            error @ (CampaignError::OtherResults { .. }
            | CampaignError::Store(StoreError::Changed { .. })) => {
                Failure::request(format!("{error}; name another --output"))
            }
            error => Failure::from(error),
        })
    }
}

/// Whether a file is called as studies are.
fn is_study(file: &Path) -> bool {
    file.extension().is_some_and(|it| it.eq_ignore_ascii_case("toml"))
}

/// The folder for what the server keeps while it runs.
fn private_folder() -> Result<PrivateFolder, Failure> {
    PrivateFolder::new().map_err(|said| {
        Failure::from(CampaignError::Refused {
            folder: std::env::temp_dir(),
            refused: "no folder can be created there",
            said,
        })
    })
}

/// Whether the browser of the desktop was started on a page of the disk.
fn opened(page: &Path) -> bool {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let begun = Command::new(program)
        .arg(page)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    // Waited for, so that no ended process stays behind.
    begun.map(|mut it| std::thread::spawn(move || it.wait())).is_ok()
}
