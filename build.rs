//! Tells the program which commit it was built from, for the provenance of its results.

use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    let changed = git(&["status", "--porcelain", "--untracked-files=no"]);
    let mark = if changed.is_some_and(|lines| !lines.is_empty()) { "+changes" } else { "" };
    println!("cargo:rustc-env=CAPSULEMAP_COMMIT={commit}{mark}");
    for watched in [".git/HEAD", ".git/logs/HEAD", "src", "Cargo.lock"] {
        println!("cargo:rerun-if-changed={watched}");
    }
}
