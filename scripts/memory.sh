#!/usr/bin/env bash
# Runs a command and says the most memory that it held.
#   scripts/memory.sh [--for SECONDS] [--most MIB] COMMAND [ARGUMENT...]
# With --for the command is interrupted after so long, as by Ctrl-C; with --most more memory is a failure.
set -euo pipefail

limit='' most=''
while [ $# -gt 0 ]; do
    case $1 in
        --for) limit=${2:?} ;;
        --most) most=${2:?} ;;
        *) break ;;
    esac
    shift 2
done
[ $# -gt 0 ] || { echo "usage: scripts/memory.sh [--for SECONDS] [--most MIB] COMMAND [ARGUMENT...]" >&2; exit 2; }
[ -r /proc/self/status ] || { echo "memory.sh: needs /proc, as Linux has it" >&2; exit 1; }

# Job control, without which what runs in the background does not hear an interrupt.
set -m
"$@" &
child=$!
trap 'kill -TERM $child 2>/dev/null' INT TERM
peak=0
# The kernel remembers the peak, so that nothing is missed but the last moment.
while held=$(awk '/^VmHWM/ { print $2 }' "/proc/$child/status" 2>/dev/null) && [ -n "$held" ]; do
    peak=$held
    if [ -n "$limit" ] && [ "$SECONDS" -ge "$limit" ]; then
        kill -INT "$child"
        limit=
    fi
    sleep 0.05
done
wait "$child" && code=0 || code=$?
echo "memory.sh: at most $((peak / 1024)) MiB" >&2
if [ -n "$most" ] && [ "$peak" -gt $((most * 1024)) ]; then
    echo "memory.sh: that is more than $most MiB" >&2
    exit 1
fi
exit "$code"
