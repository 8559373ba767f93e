#!/bin/sh
# Submits a study to Slurm: its tasks as an array, and the join of what they computed as a job after them.
# Run it from the folder that shall have the results.
set -eu

usage() {
    echo "usage: scripts/slurm/submit.sh STUDY.toml [TASKS [SBATCH-OPTION...]]"
    echo "TASKS is 8 by default; the options go to both jobs, as in"
    echo "  scripts/slurm/submit.sh studies/million.toml 20 --partition=short --mem-per-cpu=2G"
}

fail() {
    echo "submit.sh: $1" >&2
    exit "${2:-1}"
}

case ${1:-} in
    -h | --help) usage; exit 0 ;;
    "") usage >&2; exit 2 ;;
esac
study=$1
tasks=${2:-8}
case $tasks in
    *[!0-9]* | 0*) fail "TASKS is a whole number from 1, not '$tasks'" 2 ;;
esac
[ -f "$study" ] || fail "there is no study $study" 2
command -v sbatch >/dev/null || fail "there is no sbatch here: Slurm's login node has it"
shift "$(($# < 2 ? $# : 2))"
scripts=$(dirname "$0")

# Slurm takes one option for memory, so that there is one of our own only where the caller has none.
memory=--mem-per-cpu=1G
for option; do
    case $option in
        --mem | --mem=* | --mem-per-[cg]pu | --mem-per-[cg]pu=*) memory='' ;;
    esac
done
set -- ${memory:+"$memory"} "$@"

# Where there are several clusters, sbatch adds the name of one after a semicolon.
array=$(sbatch --parsable --array="1-$tasks" "$@" "$scripts/array.sh" "$study" "$tasks")
array=${array%%;*}
echo "tasks: job $array, 1 to $tasks, each with a log capsulemap-$array-TASK.log"

# The join follows the tasks however they end (afterany). After afterok it would wait for ever, and
# say nothing, once a task has failed; so it fails itself, and its log lists what is missing.
join=$(sbatch --parsable --dependency="afterany:$array" "$@" "$scripts/join.sh" "$study") ||
    fail "the tasks are submitted, their join is not: scancel $array takes them back"
join=${join%%;*}
echo "join: job $join, after the tasks, with the log capsulemap-join-$join.log"

cat <<END
If tasks fail, run them again alone, here numbers 3 and 5, and then the join:
  sbatch --array=3,5${*:+ $*} $scripts/array.sh $study $tasks
  sbatch${*:+ $*} $scripts/join.sh $study
END
