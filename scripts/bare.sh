# shellcheck shell=sh disable=SC2154
# Functions that make a bare Debian by debootstrap, which only root can do. A script sets `suite`, the Debian's name,
# and `place`, a path for the new root, and has a function `fail`; then it includes this file and calls make_root,
# mount_root and enter.
#
# What this machine needs to reach the network is passed on: proxies, certificates, the settings of apt and npm.
# mount_root is called in a mount namespace of the script's own, so that nothing stays mounted.
host=/etc/kiln-host # in the new root, what is passed on as files

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

# make_root: the root file system that debootstrap's variant minbase is.
make_root() {
    echo "$suite: debootstrap from $(mirror)"
    debootstrap --variant=minbase "$suite" "$place" "$(mirror)" >"$place.debootstrap.log" 2>&1 || {
        tail -n 20 "$place.debootstrap.log"
        fail "debootstrap cannot make $suite"
    }
    mkdir -p "$place$host"
    echo "# set by scripts/bare.sh" >"$place$host/environment"
    pass_environment
    pass_npm
    pass_apt
    cp /etc/resolv.conf /etc/hosts "$place/etc/"
}

# mount_root: proc, sys and dev in the new root.
mount_root() {
    mount -t proc proc "$place/proc"
    mount --rbind /sys "$place/sys"
    mount --rbind /dev "$place/dev"
    mountpoint -q "$place/dev/pts" || mount -t devpts devpts "$place/dev/pts"
    mount -t tmpfs -o mode=1777 shm "$place/dev/shm"
}
