#!/bin/sh
# Runs fuzz targets: fuzz/run.sh FOLDER_OF_PROGRAMS [TARGET|all|process [SECONDS]]
# What a target has learned is kept in build/corpus/TARGET, and bytes that break a law or a sanitizer's rule
# are written to build/finds. The last lines name executions, edges and finds of each target.
set -eu
bin=$(cd "$1" && pwd)
wanted=${2:-all}
seconds=${3:-60}
cd "$(dirname "$0")/.."
corpus=build/corpus
seeds=build/seeds
finds=build/finds
mkdir -p "$corpus" "$seeds" "$finds"
"$bin/seeds" "$seeds"
for file in tests/files/good/*.exr tests/files/bad/*; do
    ending=${file##*.}
    [ "$ending" = bin ] || cp "$file" "$seeds/$ending/"
done

mkdir -p "$seeds/rows"
cp "$seeds"/exr/* "$seeds"/hdr/* "$seeds/rows/"
[ ! -d tests/corpus ] || cp -r tests/corpus/. "$seeds/"

if [ "$wanted" = process ]; then
    exec "$bin/process" "$bin/kiln" "$seeds" "$finds" "$seconds"
fi

# run NAME: one target. Inputs are at most 8 kB, more than any law here needs.
run() {
    target=$1
    log=build/fuzz-$target.log
    mkdir -p "$corpus/$target" "$seeds/$target"
    "$bin/fuzz_$target" -max_total_time="$seconds" -max_len=8192 -rss_limit_mb=2048 -timeout=10 \
        -dict="fuzz/dict/$target.dict" -artifact_prefix="$finds/$target-" -print_final_stats=1 \
        "$corpus/$target" "$seeds/$target" >"$log" 2>&1 || true
    count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    found=$(find "$finds" -name "$target-*" | wc -l)
    printf '%-12s %9s executions %6s edges %3s finds\n' "$target" "${count:-?}" "${edges:-?}" "$found"
}

for dictionary in fuzz/dict/*.dict; do
    name=$(basename "$dictionary" .dict)
    if [ "$wanted" = all ] || [ "$wanted" = "$name" ]; then
        run "$name"
    fi
done
failed=$(find "$finds" -type f | wc -l)
[ "$failed" = 0 ] || {
    echo "$failed finds lie in $finds; run one by $bin/fuzz_TARGET FILE"
    exit 1
}
