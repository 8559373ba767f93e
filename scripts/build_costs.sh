#!/usr/bin/env bash
# What builds cost, in CPU seconds: of all from nothing, and of what is built anew after a change of one line in each part.
#   scripts/build_costs.sh [COMMIT]
# Prints a table of a clone of COMMIT (HEAD); takes about forty minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

commit=$(git rev-parse --short "${1:-HEAD}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
git clone --quiet . "$folder/clone"
cd "$folder/clone"
git checkout --quiet "$commit"
unset CARGO_TARGET_DIR

# The processor time of a command with its children [s].
cpu_seconds() {
    local TIMEFORMAT='%U %S'
    { time "$@" >"$folder/log" 2>&1 || { tail -n 20 "$folder/log" >&2; exit 1; }; } 2>&1 | awk '{ printf "%.0f", $1 + $2 }'
}

row() {
    echo "| $1 | $(cpu_seconds "${@:2}") |"
}

# A row for a change of one line in a file, which stays; what else depends on it is built afterwards.
touched() {
    [ -e "$1" ] || return 0
    printf '\n#[allow(dead_code)]\nconst TOUCHED: u8 = 0;\n' >>"$1"
    shift
    row "$@"
    cargo build --release --quiet
    cargo test --release --quiet --no-run
}

# The first of these files that this commit has.
first() {
    local file
    for file in "$@"; do
        [ -e "$file" ] && { echo "$file"; return; }
    done
    echo "$1"
}

program_tests=(cargo test --release --no-run --test it)
if [ -d crates/engine ]; then
    program_tests+=(-p capsulemap)
fi
all_tests=(cargo test --release --no-run)

echo "| commit $commit, $(nproc) cores, $(rustc --version | cut -d' ' -f1,2) | CPU s |"
echo "|---|---|"
row "all from nothing: \`cargo build --release\`" cargo build --release
cargo clean --quiet
row "all from nothing: the README's test command, building" "${all_tests[@]}"
cargo build --release --quiet
for part in figure/map.rs cli/sweep.rs study/axis.rs; do
    touched "src/$part" "after a line in \`src/$part\`: tests of the program" "${program_tests[@]}"
done
touched src/figure/basin.rs "after a line in \`src/figure/basin.rs\`: all tests" "${all_tests[@]}"
touched tests/it/outputs.rs "after a line in a test of the program" "${program_tests[@]}"
model=$(first crates/models/src/capsule/forces.rs src/capsule/forces.rs)
touched "$model" "after a line in \`$model\`: all tests" "${all_tests[@]}"
engine=$(first crates/engine/src/orbit/rest.rs src/orbit/rest.rs)
touched "$engine" "after a line in \`$engine\`: all tests" "${all_tests[@]}"
git -c user.name=nobody -c user.email=nobody@localhost commit --quiet --allow-empty -m "nothing"
row "after an empty commit: the program" cargo build --release
row "after an empty commit: all tests" "${all_tests[@]}"
