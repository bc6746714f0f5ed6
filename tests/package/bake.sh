#!/bin/sh
# The project examples/environments, built from an installed kiln by Ninja: a build after a change bakes the environments
# that the change concerns, and leaves the others' files alone.
#   bake.sh BUILD_FOLDER SOURCE
set -eu
build=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { printf 'FAILED: %s\n' "$*"; cat "$work/log"; exit 1; }
cmake --install "$build" --prefix "$work/kiln" >"$work/log" || fail "install"
cp -r "$source/examples/environments" "$work/project"
sed -i 's/--for three/& --tune none/' "$work/project/CMakeLists.txt" # exact levels are quick
mkdir "$work/project/panoramas"
kiln=$work/kiln/bin/kiln
sky() { "$kiln" sky -q --size 32 -o "$work/project/panoramas/$1.exr" --elevation "$2"; }
sky noon 60
sky evening 5
sky dawn 2

# built COUNTS-OF-environments COUNTS-OF-listed: builds, and compares the summaries; "" for a target that has nothing to
# do.
built() {
    cmake --build "$work/out" >"$work/log" 2>&1 || fail "the build"
    for counts; do
        [ -z "$counts" ] || grep -q "environments*: $counts;" "$work/log" || fail "not '$counts'"
    done
    [ "$(grep -c 'environments*: ' "$work/log")" = "$(for counts; do echo "$counts"; done | grep -c .)" ] ||
        fail "a target was built that had nothing to do, or was not"
}
# A time stamp of the file system must pass between two changes.
change() {
    sleep 0.02
    "$@"
}

cmake -S "$work/project" -B "$work/out" -G Ninja -DCMAKE_PREFIX_PATH="$work/kiln" >"$work/log" 2>&1 || fail "configure"
built "3 baked, 0 kept" "2 baked, 0 kept"
built "" ""
for name in noon evening dawn; do
    "$kiln" bake "$work/project/panoramas/$name.exr" -q -o "$work/want.ktx2" --for three --tune none --size 64
    cmp "$work/want.ktx2" "$work/out/environments/$name.ktx2" || fail "$name is not what kiln bake writes"
done
[ -s "$work/out/listed/evening.json" ] || fail "a file of the list is missing"

stamps() { (cd "$work/out" && stat -c '%n %i %y' environments/*.ktx2 listed/*) }
stamps >"$work/before"
change sky dawn 20
built "1 baked, 2 kept" ""
stamps | diff "$work/before" - >"$work/diff" && fail "nothing was written"
[ "$(grep -c '^>' "$work/diff")" = 1 ] && grep -q '^> environments/dawn' "$work/diff" || fail "other files were written"
built "" ""
change touch "$work/project/panoramas/noon.exr"
built "0 baked, 3 kept" "0 baked, 2 kept"
built "" ""
change sky noon 50
built "1 baked, 2 kept" "1 baked, 1 kept"
# A picture that is added, one that is taken away, other options, an edited list, a file that was removed.
change sky night 1
built "1 baked, 3 kept" ""
change rm "$work/project/panoramas/night.exr"
built "0 baked, 3 kept" ""
change sed -i 's/--size 64/--size 32/' "$work/project/CMakeLists.txt"
built "3 baked, 0 kept" ""
change sed -i 's/"exposure": -6/"exposure": -7/' "$work/project/list.jsonl"
built "" "1 baked, 1 kept"
built "" ""

# By make, too, which has no rule for what is removed.
cmake -S "$work/project" -B "$work/make" -G "Unix Makefiles" -DCMAKE_PREFIX_PATH="$work/kiln" >"$work/log" 2>&1 ||
    fail "configure for make"
cmake --build "$work/make" >"$work/log" 2>&1 || fail "make"
change sky dawn 30
cmake --build "$work/make" >"$work/log" 2>&1 || fail "make"
grep -q '3 environments: 1 baked, 2 kept;' "$work/log" || fail "make does not bake what has changed"
cmake --build "$work/make" >"$work/log" 2>&1 || fail "make"
! grep -q 'environments: ' "$work/log" || fail "make bakes without a change"

# Mistakes in the list of arguments.
wrong() {
    printf 'cmake_minimum_required(VERSION 3.22)\nproject(x NONE)\nfind_package(kiln REQUIRED)\n%s\n' "$2" >"$work/wrong/CMakeLists.txt"
    ! cmake -S "$work/wrong" -B "$work/wrong/out" -DCMAKE_PREFIX_PATH="$work/kiln" >"$work/log" 2>&1 || fail "$2 is accepted"
    tr -s ' \n' '  ' <"$work/log" | grep -q "$1" || fail "$2: not '$1'"
}
mkdir "$work/wrong"
wrong 'kiln_bake(a): b is not expected' 'kiln_bake(a b)'
wrong 'kiln_bake(a) takes either INPUTS and OUTPUT or MANIFEST' 'kiln_bake(a INPUTS b.exr)'
echo "bakes what has changed, and nothing else"
