#!/usr/bin/env bash
# What `capsulemap sweep --dry-run` tells of time, memory and disk, beside what the sweep takes, for each kind of study.
#   scripts/forecasts.sh [STUDY...]
# Without other work on the machine, as the times are those of a clock.
set -euo pipefail
cd "$(dirname "$0")/.."
program=$PWD/target/release/capsulemap memory=$PWD/scripts/memory.sh
[ -x "$program" ] || { echo "forecasts.sh: cargo build --release first" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

capsule='[parameters]
c = "0.44 N s/m"
mu_s = 0.437
mu_d = 0.2185
delta = "2.45 mm"
'
drive='k2 = "86.8 kN/m"
'
still='omega = "40 rad/s"
p_d = "3.4 N"
'
few='[protocol]
points = 1
impact_points = 0
'
# An axis, or without a number of points what is drawn: NAME FROM TO UNIT [POINTS]
axis() {
    printf '[[axes]]\nname = "%s"\nfrom = "%s %s"\nto = "%s %s"\n' "$1" "$2" "$4" "$3" "$4"
    [ $# -lt 5 ] || printf 'points = %s\n' "$5"
}
map() { axis p_d 1 5 N "$1" && axis omega 30 100 rad/s "$2"; }
starts() { axis start_r -8 4 mm "$@" && axis start_y1 -0.8 0.8 m/s "$@"; }

study() {
    case $1 in
        grid) echo "$capsule$drive$(map 60 200)" ;;
        inherited) echo "$capsule$drive$(map 40 150)
[start]
inherit = \"omega\"" ;;
        histories) echo "$capsule$drive$(map 40 120)
[history]
cycles = 5
samples_per_cycle = 200" ;;
        refined-map) echo "$capsule$drive$few$(map 257 257)
[map]
refine = { progression_speed = \"1 mm/s\" }" ;;
        basin) echo "$capsule${still}k2 = \"16 kN/m\"
$few$(starts 300)" ;;
        refined-basin) echo "$capsule${still}k2 = \"16 kN/m\"
$few$(starts 1025)
[basin]
refine = true" ;;
        shares) echo "$capsule$still$few$(axis k2 14 19 kN/m 25)
$(starts 24)" ;;
        draws) echo "$capsule$drive$few[draws]
count = 20000
$(axis p_d 1 5 N)
$(axis omega 30 100 rad/s)" ;;
        drawn-histories) echo "$capsule$drive[draws]
count = 4000
$(axis p_d 1 5 N)
$(axis omega 30 100 rad/s)
[history]
cycles = 5
samples_per_cycle = 200" ;;
        drawn-starts) echo "$capsule${still}k2 = \"16 kN/m\"
$few[draws]
count = 40000
$(starts)" ;;
        *) echo "forecasts.sh: no study $1" >&2 && exit 2 ;;
    esac
}

# The first quantity after a word in what a dry run says, in seconds or megabytes; with a second word the first one before it.
told() {
    awk -v word="$1" -v before="${2:-}" '
        $1 == word {
            if (before != "") sub(" " before ".*", "")
            for (at = 2; at < NF; at++) if ($at + 0 > 0) {
                unit = $(at + 1); sub(/[,:]$/, "", unit)
                factor = unit == "GB" ? 1000 : unit == "kB" ? 1e-3 : unit == "min" ? 60 : unit == "ms" ? 1e-3 : 1
                value = $at * factor
                if (before == "") break
            }
            print value
        }' dry
}

printf '%-16s %20s %20s %20s\n' study 'time [s]' 'memory [MB]' 'file [MB]'
[ $# -gt 0 ] || set -- grid inherited histories refined-map basin refined-basin shares draws drawn-histories drawn-starts
for name; do
    study "$name" >study.toml
    "$program" sweep study.toml --dry-run >dry
    begun=$(date +%s.%N)
    "$memory" "$program" sweep study.toml --output study.h5 --no-figures --overwrite >run 2>log
    ended=$(date +%s.%N)
    held=$(awk '/memory.sh: at most/ { print $4 * 1.048576 }' log)
    size=$(stat -c %s study.h5)
    awk -v name="$name" -v time="$(told time)" -v memory="$(told memory)" -v joining="$(told memory ' while they are joined')" \
        -v file="$(told room ' for the file')" -v begun="$begun" -v ended="$ended" -v held="$held" -v size="$size" 'BEGIN {
        if (joining > memory) memory = joining
        took = ended - begun
        printf "%-16s %7.1f %5.1f %6.2f %7.0f %5.0f %6.2f %7.1f %5.1f %6.2f\n", name,
            time, took, time / took, memory, held, memory / held, file, size / 1e6, file / size * 1e6
    }'
    rm -rf study.h5 study.h5.blocks
done
