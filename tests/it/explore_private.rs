//! What `capsulemap explore` keeps from other users of the machine: the token that opens the page, and partial results.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use super::explorer::{Explorer, coarse_overview};
use super::program::WorkDir;

/// A browser that writes down what it was started with, and what the file of that name has.
const BROWSER: &str = "#!/bin/sh\necho \"$@\" > \"$0.told\"\ncp \"$1\" \"$0.page\"\n";

/// Results, a folder for temporary files and a program that is taken for the desktop's browser.
fn prepared() -> WorkDir {
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([2, 3]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    for folder in ["temporary", "programs"] {
        fs::create_dir(work.path(folder)).expect("a folder");
    }
    for name in ["programs/xdg-open", "programs/open"] {
        work.put(name, BROWSER);
        let mode = fs::Permissions::from_mode(0o755);
        fs::set_permissions(work.path(name), mode).expect("a program");
    }
    work
}

/// The program with its own folder for temporary files.
fn command(work: &WorkDir, arguments: &[&str]) -> Command {
    let mut command = work.command(arguments);
    let path = format!("{}:/usr/bin:/bin", work.path("programs").display());
    command.env("TMPDIR", work.path("temporary")).env("PATH", path);
    command
}

/// What lies in the folder of temporary files.
fn temporary(work: &WorkDir) -> Vec<PathBuf> {
    let entries = fs::read_dir(work.path("temporary")).expect("a folder");
    entries.map(|it| it.expect("an entry").path()).collect()
}

fn mode(path: &Path) -> u32 {
    fs::symlink_metadata(path).expect("it is there").permissions().mode() & 0o777
}

#[test]
fn the_browser_is_started_with_a_file_that_only_its_user_reads() {
    let work = prepared();
    let explorer = Explorer::begun(command(&work, &["explore", "map.h5"]));
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let told = work.path(&format!("programs/{program}.told"));
    let page = work.path(&format!("programs/{program}.page"));
    let begun = Instant::now();
    while !page.exists() && begun.elapsed() < Duration::from_secs(10) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = fs::read_to_string(told).expect("the browser is started");
    assert!(!told.contains(&explorer.token), "{told}");
    let file = Path::new(told.trim());
    let folder = file.parent().expect("a folder");
    assert_eq!(temporary(&work), [folder]);
    assert_eq!((mode(file), mode(folder)), (0o600, 0o700));
    let page = fs::read_to_string(page).expect("the page");
    let address = format!("http://127.0.0.1:{}/open?token={}", explorer.port, explorer.token);
    assert!(page.contains(&format!("content=\"0; url={address}\"")), "{page}");
    // It is of no use once the token was used.
    let opened = explorer.opened();
    assert!(!file.exists() && folder.exists());
    assert_eq!(opened.object("/api/file")["cases"], 6);
}

#[test]
fn looking_at_the_address_does_not_use_the_token_up() {
    let work = prepared();
    let explorer = Explorer::unopened(&work, &["map.h5"]);
    let (port, token) = (explorer.port, &explorer.token);
    for token in [token, "0"] {
        let request = format!(
            "HEAD /open?token={token} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n"
        );
        let looked = explorer.raw(request.as_bytes()).expect("an answer");
        assert_eq!((looked.status, looked.header("set-cookie")), (204, None), "{}", looked.head);
    }
    assert_eq!(explorer.opened().object("/api/file")["cases"], 6);
}

#[test]
fn partial_results_are_kept_from_others_and_removed_after_a_kill() {
    let work = prepared();
    let many = coarse_overview([20, 60]).replace("inherit = \"omega\"", "r = \"0 mm\"");
    work.put("many.toml", many);
    work.run(&["sweep", "many.toml", "--task", "1/2", "--no-figures"]).done();
    let explore = ["explore", "many.toml", "--no-browser"];
    let mut killed = Explorer::begun(command(&work, &explore));
    let folder = temporary(&work).pop().expect("a folder");
    let file = folder.join("partial/many.h5");
    assert_eq!((mode(&folder), mode(&file)), (0o700, 0o600));
    killed.child.kill().expect("killed");
    killed.child.wait().expect("it has ended");
    assert!(file.exists());
    // The next one removes what it has left, and not what another keeps.
    let second = Explorer::begun(command(&work, &explore));
    assert!(!folder.exists());
    let others = temporary(&work);
    let third = Explorer::begun(command(&work, &["explore", "map.h5", "--no-browser"]));
    assert_eq!(temporary(&work).len(), 2);
    assert!(others.iter().all(|it| it.join("partial/many.h5").exists()));
    assert_eq!(second.opened().object("/api/file")["cases"], 1200);
    drop(third);
}
