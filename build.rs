//! Tells the program which commit it was built from, for the provenance of its results.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    // Two builds with different uncommitted changes are two programs.
    let mark = match git(&["diff", "HEAD"]) {
        Some(changes) if !changes.is_empty() => {
            let mut hasher = DefaultHasher::new();
            changes.hash(&mut hasher);
            format!("+changes.{:016x}", hasher.finish())
        }
        _ => String::new(),
    };
    println!("cargo:rustc-env=CAPSULEMAP_COMMIT={commit}{mark}");
    for watched in [".git/HEAD", ".git/logs/HEAD", "src", "Cargo.lock"] {
        println!("cargo:rerun-if-changed={watched}");
    }
}
