#!/bin/sh
# Checks what the libraries define: kiln_ and ki_ in the static one, kiln_ in the shared one.
#   scripts/symbols.sh libkiln.a libkiln.so
set -eu
stray=$(nm -g --defined-only "$1" | awk 'NF == 3 && $3 !~ /^(kiln|ki)_/ { print $3 }' |
    grep -v '^__\(asan\|odr_asan\|ubsan\|tsan\)' || true)
shown=$(nm -gD --defined-only "$2" | awk 'NF == 3 && $3 !~ /^kiln_/ { print $3 }' |
    grep -v '^__\(asan\|odr_asan\|ubsan\|tsan\)' || true)
count=$(nm -gD --defined-only "$2" | grep -c ' T kiln_' || true)
[ -z "$stray" ] || printf "%s defines, without kiln_ or ki_:\n%s\n" "$1" "$stray"
[ -z "$shown" ] || printf "%s shows, without kiln_:\n%s\n" "$2" "$shown"
[ "$count" -gt 0 ] || echo "$2 shows no function of kiln's"
[ -z "$stray$shown" ] && [ "$count" -gt 0 ]
