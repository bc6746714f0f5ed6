#!/bin/sh
# Puts the sources of zstd, libdeflate, libjpeg-turbo and the C library musl into a folder, since Debian has their
# archives for the system's own processor and C library only.
#   packaging/sources.sh FOLDER      nothing is done when the folder has them
# Out: FOLDER/NAME for each name below, unpacked and patched as Debian builds it; FOLDER/NAME/debian/copyright has the
# licence, and the first line of FOLDER/NAME/debian/changelog the version. The sources come from the mirrors of this
# machine's apt, and apt checks them against the archive's signature. apt's own lists and settings stay as they are.
set -eu
folder=$1
names="libzstd libdeflate libjpeg-turbo musl"

whole=yes
for name in $names; do
    [ -s "$folder/$name/debian/copyright" ] || whole=no
done
[ $whole = no ] || exit 0

mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
work=$folder/work.$$
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$work/parts" "$work/unpacked"

# The same places as for packages, asked for sources.
for file in /etc/apt/sources.list.d/*.sources; do
    [ ! -e "$file" ] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$work/parts/$(basename "$file")"
done
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -e "$file" ] || sed -n 's/^deb /deb-src /p' "$file" >"$work/parts/list-$(basename "$file" .list).list"
done
apt_here() {
    apt-get -q -o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache" -o Dir::Etc::sourcelist=/dev/null \
        -o Dir::Etc::sourceparts="$work/parts" -o APT::Sandbox::User="$(id -un)" "$@"
}
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
apt_here update >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
for name in $names; do
    # A mirror may lack what its list of security updates names: then the release's own version is taken.
    (cd "$work" && { apt_here source --download-only "$name" || apt_here source --download-only "$name/$suite"; }) \
        >"$work/log" 2>&1 || { cat "$work/log" >&2; echo "sources: no source of $name" >&2; exit 1; }
    rm -rf "${folder:?}/$name"
    # Debian's patches are applied. apt has checked the hashes.
    dpkg-source --no-check --no-copy -x "$work/${name}_"*.dsc "$folder/$name" >"$work/log" 2>&1 ||
        { cat "$work/log" >&2; exit 1; }
done
