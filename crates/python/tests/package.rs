//! Runs the tests of the Python package with the module that is built beside this program.

use std::env;
use std::fs;
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The module as cargo calls it.
const MODULE: &str = if cfg!(windows) {
    "capsulemap_python.dll"
} else if cfg!(target_os = "macos") {
    "libcapsulemap_python.dylib"
} else {
    "libcapsulemap_python.so"
};

/// The module as Python looks for it.
const IMPORTED: &str = if cfg!(windows) { "_capsulemap.pyd" } else { "_capsulemap.abi3.so" };

/// The Python that has what the tests need; a printed line and none where there is none.
fn python() -> Option<String> {
    let python = env::var("CAPSULEMAP_PYTHON").unwrap_or_else(|_| "python3".into());
    let needs = "import sys, numpy, xarray, h5netcdf; assert sys.version_info >= (3, 10)";
    let probe = Command::new(&python).args(["-c", needs]).output();
    let has = probe.is_ok_and(|done| done.status.success());
    if !has {
        // Past what the runner of the tests captures.
        let told = format!(
            "SKIPPED: {python} is not 3.10 or later with numpy, xarray and h5netcdf, as scripts/check.sh installs them"
        );
        let _ = writeln!(stderr(), "{told}");
    }
    has.then_some(python)
}

/// The module in the folder of this program, or above.
fn module() -> PathBuf {
    let program = env::current_exe().expect("this program has a path");
    let folders = program.ancestors().skip(1).take(2);
    let mut found = folders.map(|folder| folder.join(MODULE)).filter(|it| it.is_file());
    found.next().expect("cargo has built the module beside this program")
}

#[test]
fn the_package_passes_its_tests() {
    let Some(python) = python() else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let package = root.join("python");
    // Renamed, as a process may have the older one open.
    let unfinished = package.join("capsulemap/_capsulemap.unfinished");
    fs::copy(module(), &unfinished).expect("the module is copied");
    fs::rename(&unfinished, package.join("capsulemap").join(IMPORTED)).expect("it gets its name");
    let done = Command::new(python)
        .args(["-m", "unittest", "discover", "-s", "python/tests"])
        .current_dir(&root)
        .env("PYTHONPATH", "python")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output();
    let done = done.expect("python runs");
    let said = [done.stdout, done.stderr].concat();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&said));
}
