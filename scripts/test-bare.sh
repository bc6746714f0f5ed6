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
host=/etc/kiln-host # in the new root, what is passed on as files
trap 'exit 130' INT TERM HUP

# The mirror that this machine's apt takes Debian from, if it is a Debian.
mirror() {
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 2>/dev/null |
        grep -v security | sort -u | head -n 1 | grep . || echo http://deb.debian.org/debian
}

# pass NAME VALUE: sets an environment variable in the new root.
pass() {
    printf "export %s='%s'\n" "$1" "$(printf '%s' "$2" | sed "s/'/'\\\\''/g")" >>"$place$host/environment"
}

# pass_file NAME PATH: the same for one that names a file or a folder, which is copied.
pass_file() {
    [ -e "$2" ] || return 0
    cp -rL "$2" "$place$host/$1"
    pass "$1" "$host/$1"
}

pass_environment() {
    for name in http_proxy https_proxy ftp_proxy all_proxy no_proxy HTTP_PROXY HTTPS_PROXY FTP_PROXY ALL_PROXY \
        NO_PROXY; do
        eval "value=\${$name:-}"
        [ -z "$value" ] || pass "$name" "$value"
    done
    for name in NODE_EXTRA_CA_CERTS SSL_CERT_FILE SSL_CERT_DIR REQUESTS_CA_BUNDLE CURL_CA_BUNDLE GIT_SSL_CAINFO; do
        eval "value=\${$name:-}"
        [ -z "$value" ] || pass_file "$name" "$value"
    done
}

# npm's own settings win over its defaults only, so that a lock file's packages come from where this
# machine's come from.
pass_npm() {
    command -v npm >/dev/null 2>&1 || return 0
    for key in registry proxy https-proxy noproxy strict-ssl cafile; do
        value=$(npm config get "$key" 2>/dev/null || true)
        name=npm_config_$(echo "$key" | tr - _)
        case $key,$value in
        *,null | *,undefined | *,) ;;
        cafile,*) pass_file "$name" "$value" ;;
        *) pass "$name" "$value" ;;
        esac
    done
    [ ! -e ~/.npmrc ] || grep -v '^ *cafile *=' ~/.npmrc >"$place/root/.npmrc" || true
}

pass_apt() {
    apt-config dump 2>/dev/null | grep -iE '^Acquire::(https?|ftp|proxy|retries|check-|allow|forceip|max)' \
        >"$place/etc/apt/apt.conf.d/90host" || true
    # A mirror behind TLS: minbase has no certificates.
    case $(mirror) in
    https:*)
        cp -L /etc/ssl/certs/ca-certificates.crt "$place$host/apt.crt"
        grep -q CaInfo "$place/etc/apt/apt.conf.d/90host" ||
            echo "Acquire::https::CaInfo \"$host/apt.crt\";" >>"$place/etc/apt/apt.conf.d/90host"
        ;;
    esac
    # Files that these settings name, such as a gateway's certificate, keep their paths.
    sed -n 's/^[^"]*"\(\/[^"]*\)";$/\1/p' "$place/etc/apt/apt.conf.d/90host" | while read -r path; do
        [ -f "$path" ] && [ ! -e "$place$path" ] || continue
        mkdir -p "$place$(dirname "$path")"
        cp "$path" "$place$path"
    done
    for path in /etc/apt/auth.conf /etc/apt/auth.conf.d /etc/apt/trusted.gpg.d /usr/local/share/ca-certificates; do
        [ ! -e "$path" ] || { mkdir -p "$place$path" 2>/dev/null || true; cp -r "$path" "$place$(dirname "$path")/"; }
    done
}

enter() {
    chroot "$place" /usr/bin/env -i HOME=/root TERM=dumb LANG=C.UTF-8 \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin sh -c "$1"
}

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

echo "$suite: debootstrap from $(mirror)"
debootstrap --variant=minbase "$suite" "$place" "$(mirror)" >"build/bare/$suite-debootstrap.log" 2>&1 || {
    tail -n 20 "build/bare/$suite-debootstrap.log"
    fail "debootstrap cannot make $suite"
}
mkdir -p "$place$host"
echo "# set by scripts/test-bare.sh" >"$place$host/environment"
pass_environment
pass_npm
pass_apt
cp /etc/resolv.conf /etc/hosts "$place/etc/"
printf '[safe]\n\tdirectory = *\n' >build/bare/gitconfig # root clones what another user owns
GIT_CONFIG_GLOBAL=$PWD/build/bare/gitconfig git clone -q --depth 1 "file://$PWD" "$place/root/kiln"

mount -t proc proc "$place/proc"
mount --rbind /sys "$place/sys"
mount --rbind /dev "$place/dev"
mountpoint -q "$place/dev/pts" || mount -t devpts devpts "$place/dev/pts"
mount -t tmpfs -o mode=1777 shm "$place/dev/shm"

failed=
{ . "$place/etc/os-release" && printf '%s (%s)' "$suite" "$PRETTY_NAME"; } >"$place.line"
run demo
run test
{ cat "$place.line"; echo; } >"$place.result"
rm -f "$place.line" "$place.times"
[ -z "$failed" ]
