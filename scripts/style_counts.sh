#!/usr/bin/env bash
# Counts what makes code hard to read: functions past 40 lines, closures that a function names, arguments packed into a tuple.
#   scripts/style_counts.sh [COMMIT]
# Prints a table by folder of the source as it is, or as COMMIT has it.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=.
if [ $# -gt 0 ]; then
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    git archive "$1" | tar -x -C "$folder"
fi
cd "$folder"

# Source that rustfmt has laid out: a function ends with a brace at its own depth, and tests within files are left out.
find src crates/*/src -name '*.rs' 2>/dev/null | sort | xargs awk '
    FNR == 1 {
        part = FILENAME
        sub(/^crates\/[a-z]+\/src\//, "", part)
        sub(/^src\//, "", part)
        sub(/[\/.].*/, "", part)
        in_tests = 0
        of_tests = 0
        end = ""
    }
    # A module of tests that stands in the file; one in a file of its own is a line here.
    /^#\[cfg\((all\()?test/ { of_tests = FNR }
    /^mod [a-z_]+ \{$/ && of_tests == FNR - 1 { in_tests = 1 }
    in_tests { next }
    end == "" && /^ *(pub(\([a-z]+\))? )?(const )?fn / {
        match($0, /^ */)
        end = substr($0, 1, RLENGTH) "}"
        begun = FNR
        in_head = 1
        functions[part]++
        parts[part] = 1
    }
    end != "" && in_head && /;$/ { end = ""; next }
    end != "" && in_head && /\([a-z_]+(: [A-Za-z_&]+)?, [a-z_, ]+\): \(/ { tuples[part]++ }
    end != "" && /\{$/ { in_head = 0 }
    end != "" && /^ +let (mut )?[a-z_0-9]+(: [^=]+)? =( move)? ?\|/ { closures[part]++ }
    end != "" && /^ +let (mut )?[a-z_0-9]+(: [^=]+)? =$/ { open = 1; next }
    open && /^ +(move )?\|/ { closures[part]++ }
    { open = 0 }
    end != "" && $0 == end {
        if (FNR - begun + 1 > 40) long[part]++
        end = ""
    }
    END {
        print "| folder | functions | past 40 lines | named closures | tuples of arguments |"
        print "|---|---|---|---|---|"
        for (part in parts) {
            printf "| %s | %d | %d | %d | %d |\n", part, functions[part], long[part], closures[part], tuples[part] | "sort"
            all["f"] += functions[part]; all["l"] += long[part]; all["c"] += closures[part]; all["t"] += tuples[part]
        }
        close("sort")
        printf "| all | %d | %d | %d | %d |\n", all["f"], all["l"], all["c"], all["t"]
    }'
