//! `capsulemap explore`: a file of results in the browser.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use clap::Args;

use super::failure::Failure;
use super::terminal::{notify, print};
use crate::explore::{Explored, Server};
use crate::store;

const EXAMPLES: &str = "\
Examples:
  capsulemap explore results/overview/overview.h5
  capsulemap explore FILE.h5 --no-browser --port 8123

Click a cell of the map for its motion, computed at once. The page is on this machine alone (127.0.0.1), and the address that is \
printed opens it once, in one browser. On another machine, pass the port on with `ssh -L 8123:127.0.0.1:8123 HOST` and open the \
address there. Ctrl-C ends it.";

/// Look at a file of results in the browser: click a cell of a map, see its motion.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Explore {
    /// The file of results.
    file: PathBuf,
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
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let explored = Explored::new(archive, &self.file)?;
        let server = Server::bind(self.port).map_err(|said| {
            Failure::request(format!("--port {}: cannot be listened on: {said}", self.port))
        })?;
        let address = server.address().map_err(Failure::machine)?;
        print(&format!("{address}\n"))?;
        if !self.no_browser && !opened(&address) {
            notify("no browser could be opened: open the address above by hand; Ctrl-C ends");
        }
        server.run(explored).map_err(Failure::machine)
    }
}

/// Whether the browser of the desktop was started on an address.
fn opened(address: &str) -> bool {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let begun = Command::new(program)
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    // Another program waits for it, so that it leaves no process behind that has ended.
    begun.map(|mut it| std::thread::spawn(move || it.wait())).is_ok()
}
