#!/usr/bin/env bash
# Runs the benches and keeps what they print, with the date, the commit and the machine, so that a loss is seen.
#   scripts/record_benches.sh [FOLDER]
# Without FOLDER it is benches/records. Takes a quarter of an hour after the build; compare records of one machine only.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-benches/records}
[ -z "$(git status --porcelain --untracked-files=no)" ] || {
    echo "record_benches.sh: there are changes that no commit has; a record names its commit" >&2
    exit 2
}
processor=$(awk -F': *' '/^model name/ { print $2; exit }' /proc/cpuinfo 2>/dev/null || true)
processor=${processor:-$(uname -m)}
commit=$(git rev-parse --short HEAD)
record=$folder/$(date -u +%Y-%m-%d)-$commit-$(tr -cs 'A-Za-z0-9\n' '-' <<<"$processor").md
mkdir -p "$folder"
part=$(mktemp "$folder/.record.XXXXXX")
trap 'rm -f "$part"' EXIT
{
    echo "# $(date -u +%Y-%m-%d), commit $commit"
    echo
    echo "$processor, $(nproc) cores; $(rustc --version)."
    for bench in cycles study; do
        echo
        echo "## cargo bench --bench $bench"
        echo
        cargo bench --quiet --bench "$bench"
    done
} >"$part"
chmod 644 "$part"
mv "$part" "$record"
echo "$record"
