#!/bin/sh
# Makes a bare Debian by debootstrap, puts a clone of this tree's HEAD into it, and runs ./do demo and
# ./do test there as a newcomer would: with no package but what `--variant=minbase` has. Then says how
# long both took.
#   scripts/test-bare.sh [bookworm|trixie]      as root; both in turn by default
#
# What this machine needs to reach the network is passed on: proxies, certificates, the settings of apt
# and npm. Everything runs in mount and process namespaces of its own, so that whatever ends the script,
# no process is left and nothing stays mounted.
set -eu
cd "$(dirname "$0")/.."
fail() { printf 'test-bare: %s\n' "$*" >&2; exit 1; }

# ------------------------------------------------------------------------------------------- outside

# Runs this script for one Debian in namespaces. An interruption ends all that runs in them.
in_namespaces() {
    rm -rf --one-file-system "build/bare/$1" "build/bare/$1.result"
    unshare --mount --propagation private --pid --fork --kill-child scripts/test-bare.sh --inside "$1" &
    inside=$!
    trap 'kill -KILL $inside; sleep 1; rm -rf --one-file-system "build/bare/$1"; exit 130' INT TERM HUP
    status=0
    wait $inside || status=$?
    trap - INT TERM HUP
    rm -rf --one-file-system "build/bare/$1"
    return $status
}

if [ "${1:-}" != --inside ]; then
    [ $# -gt 0 ] || set -- bookworm trixie
    for suite; do
        case $suite in
        bookworm | trixie) ;;
        *) fail "'$suite' is neither bookworm nor trixie" ;;
        esac
    done
    [ "$(id -u)" = 0 ] || fail "a root file system can only be made by root: sudo -E ./do test-bare"
    mkdir -p build/bare
    failed=
    for suite; do
        in_namespaces "$suite" || failed=yes
    done
    echo
    for suite; do
        cat "build/bare/$suite.result" 2>/dev/null || echo "$suite: did not come as far as its commands"
    done
    [ -z "$failed" ]
    exit
fi

# -------------------------------------------------------------------------------------------- inside

suite=$2
place=build/bare/$suite
trap 'exit 130' INT TERM HUP

. scripts/bare.sh

# Seconds of CPU of this shell's ended children, into `used`.
cpu() {
    times >"$place.times" # in this very shell
    used=$(tail -n 1 "$place.times" | tr 'ms' '  ' | awk '{ printf "%d", $1 * 60 + $2 + $3 * 60 + $4 }')
}

minutes() { printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); }

# run COMMAND: ./do COMMAND in the new root; its times are added to the result.
run() {
    log=build/bare/$suite-$1.log
    echo "$suite: ./do $1 runs, what it prints goes to $log"
    start=$(date +%s)
    cpu
    before=$used
    status=0
    enter ". $host/environment && cd /root/kiln && ./do $1" >"$log" 2>&1 || status=$?
    wall=$(($(date +%s) - start))
    cpu
    used=$((used - before))
    said=passes
    [ $status = 0 ] || said="FAILS with exit code $status"
    echo "$suite: ./do $1 $said after $(minutes $wall), $(minutes $used) of CPU"
    printf '; ./do %s %s in %s (%s of CPU)' "$1" "$said" "$(minutes $wall)" "$(minutes $used)" >>"$place.line"
    [ $status = 0 ] || { tail -n 40 "$log"; failed=yes; }
}

make_root
printf '[safe]\n\tdirectory = *\n' >build/bare/gitconfig # root clones what another user owns
GIT_CONFIG_GLOBAL=$PWD/build/bare/gitconfig git clone -q --depth 1 "file://$PWD" "$place/root/kiln"

mount_root

failed=
{ . "$place/etc/os-release" && printf '%s (%s)' "$suite" "$PRETTY_NAME"; } >"$place.line"
run demo
run test
{ cat "$place.line"; echo; } >"$place.result"
rm -f "$place.line" "$place.times"
[ -z "$failed" ]
