#!/bin/sh
# Adds up the reports of all shards. Fails if a shard has not ended, or if an environment failed.
#   merge.sh SHARDS REPORTS
set -eu
cd "$2"
cat shard-*.jsonl | awk -v shards="$1" '
# The number behind a name of a line of JSON.
function number(name) {
    return match($0, "\"" name "\": [0-9.e+-]+") ? substr($0, RSTART + length(name) + 4, RLENGTH - length(name) - 4) + 0 : 0
}
/^\{"outcome": "baked"/ { baked++ }
/^\{"outcome": "failed"/ { failed++; print }
/^\{"summary"/ {
    ended[number("shard")] = 1
    environments[number("shard")] = number("environments")
    cpu += number("cpu_seconds")
    longest = number("seconds") > longest ? number("seconds") : longest
    memory = number("peak_memory") > memory ? number("peak_memory") : memory
}
END {
    for (i = 1; i <= shards; i++) {
        all += environments[i]
        if (!ended[i])
            missing = missing " " i
    }
    printf "%d environments in %d shards: %d baked, %d failed; %.1f s the longest shard, %.1f s of CPU time, %.0f MB at most\n",
        all, shards, baked, failed, longest, cpu, memory / 1e6
    if (missing != "")
        print "these shards have not ended:" missing
    exit failed || missing != ""
}'
