#!/bin/sh
# Puts what the tasks of array.sh have computed together to one file, and draws the study's figures.
# submit.sh submits it after the array. By hand, from the same folder:
#   sbatch scripts/slurm/join.sh studies/million.toml
# If blocks are missing, the job fails and its log lists them.

# What to change for your cluster, as in array.sh. A study of ten million cases takes less than 1 GB.
#SBATCH --cpus-per-task=4
##SBATCH --mem-per-cpu=1G
#SBATCH --time=01:00:00
##SBATCH --partition=NAME
##SBATCH --account=NAME

# What to leave as it is.
#SBATCH --job-name=capsulemap-join
#SBATCH --output=%x-%j.log
#SBATCH --requeue --open-mode=append
set -eu

[ $# -eq 1 ] || { echo "usage: sbatch join.sh STUDY.toml" >&2; exit 2; }

# If the program comes from a module, load it here. It is the capsulemap on the PATH, or $CAPSULEMAP.
exec "${CAPSULEMAP:-capsulemap}" join -- "$1"
