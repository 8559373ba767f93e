//! The commit that a program is built from, as a text in it, so that nothing but the program is built anew after a commit.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::process::Command;

use proc_macro::TokenStream;

/// The commit of the checkout that is compiled, as a `&'static str`: twelve digits, with a mark of its uncommitted changes if it has
/// some; "unknown" outside a checkout.
///
/// The files of git that change with the commit become dependencies of the file that asks, so that it is compiled again after one.
/// Breaks: a change of another crate that is not committed is seen once the file that asks is compiled again, which it is
/// when that crate changes.
#[proc_macro]
pub fn commit(_: TokenStream) -> TokenStream {
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    let text = commit + &mark_of_changes();
    let dependencies = ["HEAD", "logs/HEAD"].into_iter().filter_map(file_of_git);
    let includes: String = dependencies
        .map(|path| format!("const _: &[u8] = include_bytes!({:?});", path.to_string_lossy()))
        .collect();
    let code = format!("{{ {includes} {text:?} }}");
    code.parse().expect("a block with a text")
}

/// Two builds with different uncommitted changes are two programs.
fn mark_of_changes() -> String {
    match git(&["diff", "HEAD"]) {
        Some(changes) if !changes.is_empty() => {
            let mut hasher = DefaultHasher::new();
            changes.hash(&mut hasher);
            format!("+changes.{:016x}", hasher.finish())
        }
        _ => String::new(),
    }
}

/// The path of a file in the folder of git, if there is such a file.
fn file_of_git(name: &str) -> Option<PathBuf> {
    let path = git(&["rev-parse", "--git-path", name])?;
    fs::canonicalize(folder().join(path)).ok()
}

/// What git says in the folder of the program, if it does.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(folder()).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

/// The folder of the package that is compiled.
fn folder() -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(PathBuf::new, PathBuf::from)
}
