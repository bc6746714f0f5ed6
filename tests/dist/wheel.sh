#!/bin/sh
# The Python wheel has the same bytes from two source folders with paths of different length, time zones,
# locales, permissions and dates. No object is taken from a compiler cache.
#   wheel.sh SOURCE
set -eu
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset CMAKE_C_COMPILER_LAUNCHER

# copy FOLDER: the files that git knows.
copy() {
    mkdir -p "$1"
    (cd "$source" && git ls-files -z --cached --exclude-standard | xargs -0 sh -c 'for f; do [ ! -f "$f" ] || echo "$f"; done' sh |
        tar -c -T - -f -) | tar -x -f - -C "$1"
}

# wheel FOLDER: builds the wheel of the sources in this folder, and prints its path.
wheel() {
    set -- "$1" -DCMAKE_BUILD_TYPE=Release -DKILN_PYTHON=ON
    for part in TESTS GOLDEN BENCH EXAMPLES CLI VIEWER; do set -- "$@" "-DKILN_$part=OFF"; done
    folder=$1
    shift
    { cmake -S "$folder" -B "$folder/out" -G Ninja "$@" &&
        cmake --build "$folder/out" -j 1 --target kiln_wheel; } >"$work/log" 2>&1 ||
        { tail -n 60 "$work/log" >&2; exit 1; }
    echo "$folder/out/python/$(cat "$folder/out/python/wheel.txt")"
}

copy "$work/a"
a=$(TZ=UTC LC_ALL=C wheel "$work/a")
(umask 077 && copy "$work/a much longer name/below")
find "$work/a much longer name" -exec touch -d 2001-02-03 {} +
b=$(umask 077 && TZ=Asia/Tokyo LC_ALL=C.UTF-8 wheel "$work/a much longer name/below")

[ "$(basename "$a")" = "$(basename "$b")" ] || { echo "$a and $b have two names"; exit 1; }
cmp "$a" "$b"
echo "$(basename "$a"): twice the same $(wc -c <"$a") bytes"
