# What the tests of the command share. Sourced with KILN, the command, as the first argument; works
# in an empty folder of its own.
# shellcheck shell=sh
set -eu
KILN=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir log
checks=0

die() {
    printf 'FAILED: %s\n' "$*"
    [ ! -s log/err ] || sed 's/^/  stderr: /' log/err
    [ ! -s log/out ] || sed 's/^/  stdout: /' log/out
    exit 1
}

# expect CODE PATTERN kiln-arguments...: the exit code, and a line of standard error that matches
# the pattern ('' for an empty standard error). Failures say one sentence and print nothing else.
expect() {
    code=$1
    pattern=$2
    shift 2
    checks=$((checks + 1))
    got=0
    "$KILN" "$@" >log/out 2>log/err || got=$?
    [ "$got" = "$code" ] || die "kiln $*: exit $got, not $code"
    if [ -z "$pattern" ]; then
        [ ! -s log/err ] || die "kiln $*: standard error is not empty"
    else
        grep -q -- "$pattern" log/err || die "kiln $*: no line of standard error matches: $pattern"
    fi
    case $code in
    1) [ "$(wc -l <log/err)" = 1 ] || die "kiln $*: more than one line" ;;
    2) [ "$(wc -l <log/err)" = 2 ] || die "kiln $*: a sentence and a hint are two lines" ;;
    esac
    if [ "$code" != 0 ]; then
        grep -q '^kiln: ' log/err || die "kiln $*: the sentence does not start with kiln:"
        [ ! -s log/out ] || die "kiln $*: failed, but printed something"
    fi
}

# The only files here, besides log/, are those named.
only() {
    checks=$((checks + 1))
    have=$(find . -type f -not -path './log/*' | sed 's|^\./||' | sort | tr '\n' ' ')
    want=$(printf '%s\n' "$@" | sort | tr '\n' ' ')
    [ "$have" = "$want" ] || die "there is: $have; there should be: $want"
}

same() {
    checks=$((checks + 1))
    cmp "$1" "$2" || die "$1 and $2 differ"
}

passed() { echo "$checks checks"; }
