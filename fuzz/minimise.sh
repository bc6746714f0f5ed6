#!/bin/sh
# Makes tests/corpus of what fuzzing has learned: fuzz/minimise.sh FOLDER_OF_PROGRAMS FOLDER_OF_CORPORA...
# Of the files of each target, the smallest that together reach every edge are kept, those above 4 kB are left
# out, and each is named by the hash of its bytes. LIMIT is the number of bytes for each target, 40000 if unset;
# beyond it the larger files are left out.
set -eu
bin=$(cd "$1" && pwd)
shift
limit=${LIMIT:-40000}
top=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for dictionary in "$top"/fuzz/dict/*.dict; do
    name=$(basename "$dictionary" .dict)
    mkdir -p "$work/small" "$work/merged"
    for folder; do
        [ ! -d "$folder/$name" ] || find "$folder/$name" -type f -size -9 -exec cp {} "$work/small/" \;
    done
    find "$work/small" -type f -size +4095c -delete
    "$bin/fuzz_$name" -merge=1 -rss_limit_mb=2048 -timeout=10 "$work/merged" "$work/small" >"$work/log" 2>&1 ||
        { cat "$work/log"; exit 1; }
    rm -rf "$top/tests/corpus/$name"
    mkdir -p "$top/tests/corpus/$name"
    total=0
    # libFuzzer names files by the SHA-1 of their bytes.
    find "$work/merged" -type f -printf '%s %p\n' | sort -n >"$work/list"
    while read -r size file; do
        total=$((total + size))
        [ "$total" -gt "$limit" ] || cp "$file" "$top/tests/corpus/$name/"
    done <"$work/list"
    printf '%-12s %4s files\n' "$name" "$(find "$top/tests/corpus/$name" -type f | wc -l)"
    rm -rf "$work/small" "$work/merged"
done
