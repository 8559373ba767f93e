#!/usr/bin/env bash
# The one list of checks: what a person runs before handing in, and what .ci/run runs.
set -euo pipefail
cd "$(dirname "$0")/.."
# The logs of what is installed lie there, and a new machine has no such folder.
mkdir -p target

# Readers of the result files, and a second computation of hypervolumes, as tried; the tests that need them say so when they are skipped.
readers=(h5py==3.16.0 netCDF4==1.7.5.1.post1 h5netcdf==1.8.2 xarray==2026.9.0 numpy==2.4.6 moocore==0.3.2)

chromium=${CAPSULEMAP_CHROMIUM:-/usr/bin/chromium}

step() {
    local name=$1 start=$SECONDS
    shift
    echo "== $name"
    "$@" </dev/null || { echo "== $name: FAILED after $((SECONDS - start)) s" >&2; exit 1; }
    echo "== $name: $((SECONDS - start)) s"
}

python_readers() {
    local place=target/check-python log=target/check-python.log
    local python=$place/bin/python
    if ! command -v python3 >/dev/null; then
        echo "no python3 here: the tests with Python readers will be skipped"
    elif "$python" -c 'import h5py, netCDF4, h5netcdf, xarray, moocore' 2>/dev/null ||
        { python3 -m venv "$place" && "$python" -m pip install -q --only-binary :all: "${readers[@]}"; } >"$log" 2>&1; then
        CAPSULEMAP_PYTHON=$PWD/$python
        export CAPSULEMAP_PYTHON
    else
        echo "pip could not install the Python readers (see $log): their tests will be skipped"
    fi
}

# Kills at the n-th call of the system need it.
strace_for_kills() {
    local root=()
    if command -v strace >/dev/null; then
        return
    elif [ -z "${CI:-}" ] || ! command -v apt-get >/dev/null; then
        echo "strace is not installed: its test will be skipped"
    else
        [ "$(id -u)" -eq 0 ] || root=(sudo -n)
        "${root[@]}" apt-get install -y -q --no-install-recommends strace >target/check-strace.log 2>&1 ||
            echo "apt-get could not install strace (see target/check-strace.log): its test will be skipped"
    fi
}

# Nobody wants a workload manager installed unasked, so it comes only where CI is set.
slurm() {
    local log=target/check-slurm.log skipped="its test will be skipped"
    if has_slurm; then
        return
    elif [ -z "${CI:-}" ]; then
        echo "Slurm is not installed: $skipped (CI=true scripts/check.sh installs it)"
    elif ! command -v apt-get >/dev/null; then
        echo "no apt-get here to install Slurm: $skipped"
    elif ! { install_slurm && has_slurm; } >"$log" 2>&1; then
        echo "apt-get could not install Slurm (see $log): $skipped"
    fi
}

has_slurm() {
    local PATH=$PATH:/usr/sbin
    command -v sbatch && command -v slurmctld && command -v slurmd && command -v munged
} >/dev/null

# The lists of packages may be missing or old: try, fetch, try.
install_slurm() {
    local root=()
    [ "$(id -u)" -eq 0 ] || root=(sudo -n)
    local install=("${root[@]}" env DEBIAN_FRONTEND=noninteractive
        apt-get install -y -q --no-install-recommends slurm-wlm munge)
    "${install[@]}" || { "${root[@]}" apt-get update -q && "${install[@]}"; }
}

# What looks at the page of `capsulemap explore` as a person would: Chromium, and the packages that drive it.
browser() {
    local place=target/check-browser log=target/check-browser.log root=()
    local skipped="the test of the page will be skipped"
    mkdir -p "$place"
    if ! command -v npm >/dev/null; then
        echo "no npm here: $skipped"
        return
    fi
    if ! [ -x "$chromium" ] && [ -n "${CI:-}" ] && command -v apt-get >/dev/null; then
        [ "$(id -u)" -eq 0 ] || root=(sudo -n)
        "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends chromium >"$log" 2>&1 ||
            echo "apt-get could not install Chromium (see $log)"
    fi
    if ! [ -x "$chromium" ]; then
        echo "Chromium is not at $chromium: $skipped (CI=true scripts/check.sh installs it)"
        return
    fi
    cp tests/browser/package.json tests/browser/package-lock.json "$place"
    if npm ci --silent --prefix "$place" >"$log" 2>&1; then
        CAPSULEMAP_BROWSER=$PWD/$place
        export CAPSULEMAP_BROWSER CAPSULEMAP_CHROMIUM=$chromium
    else
        echo "npm could not install what drives Chromium (see $log): $skipped"
    fi
}

readme_test() {
    scripts/setup.sh && cargo test --release
}

# What the program's library compiles of the vector instructions: nothing, as it asks models by their door.
no_lanes_above_models() {
    local library symbols lanes
    library=$(ls -t target/release/deps/libcapsulemap-*.rlib | head -n 1)
    symbols=$(nm "$library" 2>/dev/null | grep -c capsulemap || true)
    lanes=$(nm "$library" 2>/dev/null | grep -c "4lane3x86\|Instructions6run_as" || true)
    [ "$symbols" -gt 0 ] || { echo "no symbols in $library" >&2; return 1; }
    [ "$lanes" -eq 0 ] || { echo "the library has $lanes functions over lanes: see CONTRIBUTING.md, the door" >&2; return 1; }
}

documentation() {
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps
}

# The engine for any system, without HDF5, plotters and clap.
engine_alone() {
    cargo check -p capsulemap --no-default-features --lib && cargo check -p capsulemap-engine --examples || return 1
    local count
    count=$(cargo tree -p capsulemap --no-default-features --edges normal --prefix none | sort -u | wc -l)
    echo "the engine alone needs $((count - 1)) crates"
}

# What the checks of the dependencies by a version of cargo-deny depend on.
dependencies_sum() {
    { echo "$1" && cat deny.toml Cargo.lock Cargo.toml crates/*/Cargo.toml; } | sha256sum | cut -d " " -f 1
}

# Takes minutes to build, also without optimisation, so that it comes only where CI is set and something has changed since it passed.
dependencies() {
    local version=0.20.2 log=target/check-deny.log
    if [ "$(dependencies_sum "$version")" = "$(cat deny.sum)" ]; then
        echo "the dependencies are those that cargo-deny $version has passed (deny.sum)"
        return
    fi
    if ! cargo deny --version >/dev/null 2>&1; then
        if [ -z "${CI:-}" ]; then
            echo "cargo-deny is not installed: the dependencies are not checked (cargo install --locked cargo-deny)"
            return
        fi
        cargo install --quiet --locked --debug --version "$version" cargo-deny >"$log" 2>&1 || { cat "$log" >&2; return 1; }
    fi
    # A step does not end by itself where a command of it fails.
    cargo deny check licenses bans sources || return 1
    dependencies_sum "$version" >deny.sum
    echo "deny.sum is new: commit it"
}

step "what the machine needs" scripts/setup.sh
step "formatting" cargo fmt --check
step "dependencies" dependencies
# What is soon told comes before what takes long.
step "lints" cargo clippy --all-targets -- -D warnings
step "documentation" documentation
step "Python readers" python_readers
step "Slurm" slurm
step "strace" strace_for_kills
step "browser" browser
step "tests, as in the README" readme_test
step "no lanes above the models" no_lanes_above_models
step "engine alone" engine_alone
echo "== all checks passed in $SECONDS s"
