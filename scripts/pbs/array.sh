#!/bin/sh
# Computes a study in the elements of an array of PBS Pro, OpenPBS or Torque. Submit it from the folder that shall have the results;
# all nodes must see that folder:
#   qsub -J 1-8 -v STUDY=studies/million.toml,TASKS=8 scripts/pbs/array.sh    # PBS Pro, OpenPBS
#   qsub -t 1-8 -v STUDY=studies/million.toml,TASKS=8 scripts/pbs/array.sh    # Torque
# and when all have ended, in that folder: capsulemap join studies/million.toml
# Elements that failed are submitted again alone, as one of 8 still; these are they:
#   capsulemap join studies/million.toml --missing 8
# A task computes only blocks that are not there yet, so it may be run again as often as it takes.

# What to change for your cluster, here or by options of qsub. PBS Pro and OpenPBS say in NCPUS how many processors there are; for Torque
# write "nodes=1:ppn=8" in the place of "select=..." and "export OMP_NUM_THREADS=8" below.
#PBS -l select=1:ncpus=8:mem=8gb
#PBS -l walltime=04:00:00

# What to leave as it is.
#PBS -N capsulemap
#PBS -r y
set -eu

cd "${PBS_O_WORKDIR:-.}"
index=${PBS_ARRAY_INDEX:-${PBS_ARRAYID:-}}
[ -n "$index" ] && [ -n "${STUDY:-}" ] && [ -n "${TASKS:-}" ] || {
    echo "usage: qsub -J 1-TASKS -v STUDY=STUDY.toml,TASKS=TASKS array.sh" >&2
    exit 2
}

# If the program comes from a module, load it here. It is the capsulemap on the PATH, or $CAPSULEMAP.
exec "${CAPSULEMAP:-capsulemap}" sweep --task "$index/$TASKS" -- "$STUDY"
