#!/bin/sh
# Checks what the libraries define: kiln_ and ki_ in the static one, kiln_ in the shared one. And that no
# static function of the sources has the name of a function that the library takes from elsewhere
# (write, read): wasm-ld 19 takes such a static for the definition where both lie in an archive, and
# the page does not link.
#   scripts/symbols.sh libkiln.a libkiln.so [FOLDER...]      src and viewer by default
set -eu
archive=$1
shared=$2
shift 2
[ $# -gt 0 ] || set -- "$(dirname "$0")/../src" "$(dirname "$0")/../viewer"
stray=$(nm -g --defined-only "$archive" | awk 'NF == 3 && $3 !~ /^(kiln|ki)_/ { print $3 }' |
    grep -v '^__\(asan\|odr_asan\|ubsan\|tsan\)' || true)
shown=$(nm -gD --defined-only "$shared" | awk 'NF == 3 && $3 !~ /^kiln_/ { print $3 }' |
    grep -v '^__\(asan\|odr_asan\|ubsan\|tsan\)' || true)
count=$(nm -gD --defined-only "$shared" | grep -c ' T kiln_' || true)
needed=$(nm -u "$archive" | awk 'NF == 2 { print $2 }' | sort -u)
taken=$(find "$@" \( -name '*.[ch]' -o -name '*.inl' \) \
    -exec sed -n 's/^static [^(=;]*[ *]\([a-z0-9_]*\)(.*/\1/p' {} + | sort -u | grep -Fx "$needed" || true)
[ -z "$stray" ] || printf "%s defines, without kiln_ or ki_:\n%s\n" "$archive" "$stray"
[ -z "$shown" ] || printf "%s shows, without kiln_:\n%s\n" "$shared" "$shown"
[ -z "$taken" ] || printf "static functions have the name of a function that %s needs:\n%s\n" "$archive" "$taken"
[ "$count" -gt 0 ] || echo "$shared shows no function of kiln's"
[ -z "$stray$shown$taken" ] && [ "$count" -gt 0 ]
