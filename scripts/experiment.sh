#!/bin/sh
# The experiment of docs/experiment.md: the recordings of a rig that is a simulation, what is identified from them, and the picture of the comparison.
set -eu
cd "$(dirname "$0")/.."
program=${CAPSULEMAP:-cargo run --release --}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

$program synthesize studies/fig5.toml --output "$work/rig"
$program identify "$work/rig" --m1 "0.11 kg" --m2 "0.53 kg" --output "$work/identified.toml" --figures "$work/figures"
$program fit "$work/rig/motion.csv" --study studies/fig5.toml --vary "k2=1 kN/m..5 kN/m,mu_d=0.1..0.6,mu_s=0..0.6"
$program compare "$work/rig/motion.csv" studies/fig5.toml --output "$work/comparison"

mkdir -p docs/pictures/experiment
cp "$work/comparison.png" "$work/figures/coasting.png" "$work/figures/free-vibration.png" docs/pictures/experiment/
