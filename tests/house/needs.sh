#!/bin/sh
# What ./do does on a machine that lacks something: without apt-get, or without root and sudo, one
# sentence names each missing package of four systems once and nothing is built; with apt-get and root
# all of them are installed by one command, which waits for a held lock. The machine is a PATH of a few
# tools, so that nothing that is needed is found.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/tree/scripts" "$work/bin"
cp "$root/do" "$work/tree/"
cp "$root/scripts/needs.txt" "$root/scripts/test-bare.sh" "$work/tree/scripts/"
for tool in sh dirname mkdir awk grep find env cat; do
    ln -s "$(command -v $tool)" "$work/bin/$tool"
done
die() {
    echo "FAILED: $*"
    cat "$work/said"
    exit 1
}
# tool NAME SCRIPT: a program of the machine.
tool() {
    printf '#!/bin/sh\n%s\n' "$2" >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}
# run CODE ARGUMENTS...: ./do on that machine, and the exit code it should have.
run() {
    wanted=$1
    shift
    code=0
    (cd "$work/tree" && PATH="$work/bin" ./do "$@") >"$work/said" 2>&1 || code=$?
    [ "$code" = "$wanted" ] || die "./do $*: exit $code, not $wanted"
}
# once PART NAME: the words after "by PART" up to the semicolon name the package once.
once() {
    count=$(tr ';' '\n' <"$work/said" | grep "by $1 " | tr ' ' '\n' | grep -cFx -- "$2" || true)
    [ "$count" = 1 ] || die "$2 is named $count times for $1"
}

# Another system: no apt-get.
tool id 'echo 0'
run 1 web
[ "$(wc -l <"$work/said")" = 1 ] || die "more than a sentence"
grep -q '^do: please install what is missing, named by Debian ' "$work/said" || die "another sentence"
for name in cmake ninja-build nodejs npm emscripten; do once Debian $name; done
for name in cmake ninja-build nodejs nodejs-npm emscripten; do once Fedora $name; done
for name in cmake ninja nodejs npm emscripten; do once Arch $name; done
for name in cmake ninja node emscripten; do once Homebrew $name; done
run 1 build
once Fedora libglvnd-devel # which is two packages elsewhere
once Arch libglvnd
once Homebrew cmake
# Who builds the command is not asked for what the tests or the page need.
for name in libcmocka-dev libopenexr-dev libpng-dev emscripten chromium; do
    ! grep -qw "$name" "$work/said" || die "./do build asks for $name"
done

# What is there is not named.
tool cmake ''
run 1 web
! grep -qw cmake "$work/said" || die "cmake is there and is named"
rm "$work/bin/cmake"

# A Debian without root and sudo, and the same with root.
tool apt-get 'echo "$*" >>"$0.log"; echo "apt-get $*"; exit 1'
tool id 'echo 1000'
run 1 web
once Debian emscripten
run 1 test-bare
grep -q 'only root can do' "$work/said" || die "test-bare does not say that root is needed"
[ ! -e "$work/bin/apt-get.log" ] || die "apt-get was called"
tool id 'echo 0'
run 1 web
grep -q '^do: cannot install: cmake ' "$work/said" || die "a failed apt-get is not told"
grep -q 'DPkg::Lock::Timeout=[0-9].* cmake ninja-build nodejs npm emscripten$' "$work/bin/apt-get.log" ||
    die "apt-get does not wait for the lock"
[ ! -e "$work/tree/build/release" ] || die "something was built"

# Every row of the table is whole.
awk '!/^#/ && NF != 6 { print FILENAME ":" FNR ": has " NF " fields, not 6"; bad = 1 } END { exit bad }' \
    "$root/scripts/needs.txt"
