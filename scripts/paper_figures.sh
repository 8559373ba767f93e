#!/usr/bin/env bash
# Computes the paper's Figs 5, 6 and 7 and its statement that best progression and least energy lie at different parameters
# (studies/best.toml, some ten minutes on two cores), and draws them into results/paper/, from where scripts/gallery.sh takes the
# pictures that git keeps.
# Further arguments go to every sweep and figure, as in: scripts/paper_figures.sh --formats png,svg,pdf
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cargo build --release
for figure in fig5 fig6 fig7; do
    target/release/capsulemap sweep "studies/$figure.toml" \
        --output "results/paper/$figure.h5" --overwrite --formats png "$@"
done
best=results/best/best.h5
target/release/capsulemap sweep studies/best.toml --output "$best" --overwrite --no-figures
for direction in forward backward; do
    target/release/capsulemap tradeoff "$best" --refine --direction "$direction"
done
target/release/capsulemap figure "$best" --folder results/paper --formats png "$@"
target/release/capsulemap report "$best"
