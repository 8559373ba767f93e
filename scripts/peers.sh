#!/usr/bin/env bash
# Runs capsulemap and its peers side by side on the same cases, on one core, and prints Markdown tables.
# With --jobs whole jobs instead: a basin of 10 000 starts, and a map of periods.
# The peers are installed from PyPI into target/; some minutes, with --short about one after the builds.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(heyoka==7.13.2 numpy==2.4.6 scipy==1.17.1 numba==0.68.1 pynamicalsys==1.7.0)
place=$PWD/target/peers-python
log=$PWD/target/peers-python.log

usage() {
    echo "usage: scripts/peers.sh [--jobs] [--short]" >&2
    exit "$1"
}

missing() {
    echo "peers: $1" >&2
    exit 1
}

check_tools() {
    command -v cargo >/dev/null || missing "Rust is missing: see https://rustup.rs"
    command -v gcc >/dev/null || missing "gcc is missing: apt-get install gcc libc6-dev, or dnf install gcc"
    command -v python3 >/dev/null || missing "python3 is missing"
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
        missing "python3 is older than 3.11: $(python3 --version)"
    python3 -c 'import venv, ensurepip' 2>/dev/null ||
        missing "python3 has no venv: apt-get install python3-venv"
}

# A list beside the packages shows whether they are the pinned ones.
install_peers() {
    local pinned="${packages[*]}"
    [ "$(cat "$place/installed" 2>/dev/null)" = "$pinned" ] && return
    echo "installing $pinned into $place" >&2
    { python3 -m venv --clear "$place" &&
        "$place/bin/python" -m pip install -q --disable-pip-version-check --only-binary :all: "${packages[@]}"; } \
        >"$log" 2>&1 || missing "pip could not install the peers, see $log"
    echo "$pinned" >"$place/installed"
}

build() {
    mkdir -p target/peers
    gcc -O3 -march=native -o target/peers/rk4 scripts/peers/rk4.c -lm ||
        missing "gcc could not build scripts/peers/rk4.c: it needs the C library's headers"
    { cargo bench --quiet --bench peers --no-run &&
        cargo bench --quiet -p capsulemap-engine --bench duffing_basin --no-run; } ||
        missing "capsulemap does not build here: scripts/setup.sh installs what it needs"
}

report=compare.py
short=()
for option; do
    case $option in
        --jobs) report=jobs.py ;;
        --short) short=(--short) ;;
        -h | --help) usage 0 ;;
        *) usage 2 ;;
    esac
done

mkdir -p target
check_tools
install_peers
build
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1
exec "$place/bin/python" "scripts/peers/$report" "${short[@]}"
