#!/usr/bin/env bash
# The long forms of proofs whose short forms are among the tests; takes about three hours on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cargo build --release
program=target/release/capsulemap

echo "== a hundred runs, killed at random and resumed, end in the same bytes"
KILLS=100 cargo test --release --test it -- runs_that_are_killed --nocapture

echo "== eight processes that share a study, of each of three studies 60 killed at random, end in the same bytes"
CLAIM_KILLS=60 cargo test --release --test it -- killed_at_random_end_in_the_file_of_one --nocapture

echo "== all exponents against the divergence of the field over 200 cases of each kind, and Duffing's over 60 000 cycles"
LONG_PROOFS=1 cargo test --release --test it -p capsulemap-engine -p capsulemap-text -- volumes divergence duffings_exponents --nocapture

echo "== 20 000 periods, computed again with a tenth of the tolerances and ten times the budget"
CASES=20000 cargo test --release --test it -- certificates --nocapture

echo "== settling against integration alone: 200 000 cases, and 5000 starts of each of 41 capsules with several attractors"
CASES=200000 CAPSULES=41 STARTS=5000 cargo test --release --test it -- acceleration --nocapture

echo "== branches of 300 capsules by other steps, ranges, section phases and points of the orbit; numbers along 100 axes against four times as many points"
CAPSULES=300 AXES=100 cargo test --release --test it -- random_branches no_number --nocapture

echo "== what the ways of 3000 attractors tell is what branches in small steps tell"
CAPSULES=3000 cargo test --release --test it -- successions --nocapture

echo "== periods and defects of 10 000 cases of each law over the whole box, and a second integrator on 3000"
CASES=10000 cargo test --release --test it -- wide_box --nocapture

echo "== basins of a flow are Wada to a few starts on 600 starts a side; intervals of where motions go when a parameter steps, in 1000 sets of draws"
WADA_SIDE=600 TIPPING_SEEDS=1000 cargo test --release --test it -p capsulemap -- wada tipping --nocapture

echo "== a thousand points of the boundary of basins, as curves, against brackets of two starts: the capsule's, and Duffing's two wells by a second integrator"
MANIFOLD_POINTS=1000 cargo test --release --test it -p capsulemap -- manifolds --nocapture

echo "== invariants of 4096 motions over the whole box"
PROPTEST_CASES=4096 cargo test --release --test it -- invariants --nocapture

echo "== the same files whichever of the first 200 renames, removals, syncs, writes and new folders of a thread is the last"
CALLS=200 cargo test --release --test it -- killed_calls --nocapture

echo "== 1000 damaged files of results through every command that reads them"
DAMAGES=1000 cargo test --release --test it -- no_command_takes_a_damaged_file --nocapture

echo "== 3000 mutants of studies and 3000 sets of extreme parameters"
MUTANTS=3000 EXTREMES=3000 cargo test --release --test it -- what_is_a_study extreme_parameters --nocapture

echo "== the labels of a refined grid of a million starts against those of the full one"
SIDE=1000 cargo test --release --test it -- a_refined_basin_is_the_full_one --nocapture

echo "== intervals of fits to motion hold the truth for 92 to 98 in 100 of 300 seeds"
CAPSULEMAP_SEEDS=300 cargo test --release --test it -- intervals_hold_the_truth fitted_recordings --nocapture

echo "== 2000 random studies of starts, shares, tolerances and margins, without drive and without friction among them, end in time"
STUDIES=2000 cargo test --release --test it -- random_studies --nocapture

echo "== ten minutes of random study texts, joined files and blocks"
FUZZ_SECONDS=600 cargo test --release --test it -- any_text_is a_joined_file_with a_block_with_damage of_a_file_of_searches --nocapture

echo "== ten minutes of random recordings, and faults in a million rows"
FUZZ_SECONDS=600 cargo test --release --test it -- any_recording_is_read --nocapture
ROWS=100000 cargo test --release --test it -- the_time_of_faulty_rows --nocapture

echo "== ten million cases in less than 1 GiB: while they are computed, stopped, and while they are joined"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
long_run=("$program" sweep studies/ten-million.toml --output "$folder/long.h5" --formats png)
memory=(scripts/memory.sh --most 1024)
# The first is stopped by the signal of Ctrl-C, whose status is 130.
{ "${memory[@]}" --for 120 "${long_run[@]}" 2>&1 || [ $? -eq 130 ]; } | tail -n 3
"${memory[@]}" "${long_run[@]}" 2>&1 | tail -n 5
"${memory[@]}" "$program" verify "$folder/long.h5" --cases 10000 2>&1 | tail -n 2
