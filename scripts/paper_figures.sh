#!/usr/bin/env bash
# Computes the paper's Figs 5, 6 and 7 and draws them into results/paper/, whose pictures are kept in git.
# Further arguments go to every sweep, as in: scripts/paper_figures.sh --formats png,svg,pdf
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cargo build --release
for figure in fig5 fig6 fig7; do
    target/release/capsulemap sweep "studies/$figure.toml" \
        --output "results/paper/$figure.h5" --overwrite --formats png "$@"
done
