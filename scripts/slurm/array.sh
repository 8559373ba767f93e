#!/bin/sh
# Computes a study in the tasks of a Slurm array; submit.sh submits it, with the join after it. By hand:
#   sbatch --array=1-8 scripts/slurm/array.sh studies/million.toml 8
# The 8 stands there again because a task that failed is run again alone, and is still one of 8:
#   sbatch --array=3 scripts/slurm/array.sh studies/million.toml 8
# Submit it from the folder that shall have the results; all nodes must see that folder. A task computes
# only blocks that are not there yet, so it may be run again as often as it takes.

# What to change for your cluster, here or by options of sbatch, which go before these lines.
# Cores of a task, all of one node; the program starts as many threads.
#SBATCH --cpus-per-task=8
# Memory, with one # less, as --mem or --mem-per-cpu, of which Slurm takes one; the program needs little, and
# `capsulemap sweep STUDY.toml --dry-run` says how much. submit.sh asks for 1G a core unless an option says otherwise.
##SBATCH --mem-per-cpu=1G
# The longest that a task may take, as hours:minutes:seconds; short jobs are started sooner.
#SBATCH --time=04:00:00
# Where your cluster asks for them, with one # less:
##SBATCH --partition=NAME
##SBATCH --account=NAME

# What to leave as it is.
#SBATCH --job-name=capsulemap
#SBATCH --output=%x-%A-%a.log
# A task that loses its node or makes room for others goes back to the queue, and its log is continued.
#SBATCH --requeue --open-mode=append
# A minute before its time is over the program is asked to stop. B means this script, and exec below
# puts the program in its place: without exec the signal would reach the shell alone.
#SBATCH --signal=B:TERM@60
set -eu

[ $# -eq 2 ] || { echo "usage: sbatch --array=1-TASKS array.sh STUDY.toml TASKS" >&2; exit 2; }
study=$1
tasks=$2

# If the program comes from a module, load it here. It is the capsulemap on the PATH, or $CAPSULEMAP.
exec "${CAPSULEMAP:-capsulemap}" sweep --task "$SLURM_ARRAY_TASK_ID/$tasks" -- "$study"
