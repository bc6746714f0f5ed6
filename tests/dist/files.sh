#!/bin/sh
# Checks the folder build/dist, which `./do dist` makes: the files are those that docs/downloads.md lists, SHA256SUMS
# has their checksums, each archive has the licences of what it links, and no program contains a path of this machine.
#   files.sh SOURCE
set -eu
source=$1
cd "$source/build/dist"
die() { echo "FAILED: $*"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

version=$(sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
sed -n 's/^| `\([^`]*\)` |.*/\1/p' "$source/docs/downloads.md" | sed "s/VERSION/$version/" >"$work/patterns"
[ "$(wc -l <"$work/patterns")" -ge 8 ] || die "docs/downloads.md lists too few files"
while read -r pattern; do
    # shellcheck disable=SC2086 # a pattern
    [ -s "$(echo $pattern)" ] || die "docs/downloads.md lists $pattern, which is not there"
done <"$work/patterns"
[ "$(find . -type f | wc -l)" = "$(wc -l <"$work/patterns")" ] || { ls; die "there are files that docs/downloads.md lacks"; }
sha256sum --quiet -c SHA256SUMS
[ "$(wc -l <SHA256SUMS)" = "$(($(wc -l <"$work/patterns") - 1))" ] || die "SHA256SUMS does not list every file"

# licences FOLDER PART...: the parts that LICENSES.txt names, each with the text of a licence.
licences() {
    file=$1/LICENSES.txt
    shift
    for part; do
        grep -q "^$part, Debian version [0-9]" "$file" || die "$file has no licence of $part"
    done
    [ "$(grep -c '^kiln$\|, Debian version ' "$file")" = $(($# + 1)) ] || die "$file has other parts"
    for words in 'Permission is hereby granted, free of charge' 'Copyright' 'Redistributions in binary form' \
        'GCC Runtime Library Exception'; do
        grep -qi "$words" "$file" || die "$file lacks '$words'"
    done
}
for system in linux-x86_64 linux-aarch64; do
    tar -x -z -f "kiln-$version-$system.tar.gz" -C "$work"
    licences "$work/kiln-$version-$system" musl "GCC's runtime library" zstd libdeflate libjpeg-turbo
done
(cd "$work" && python3 -m zipfile -e "$OLDPWD/kiln-$version-windows-x86_64.zip" .)
licences "$work/kiln-$version-windows-x86_64" mingw-w64 "GCC's runtime library" zstd libdeflate libjpeg-turbo

# No program, library or archive in it names the folder of the build or the home of who built it.
dpkg-deb -x "kiln_${version}_"*.deb "$work/deb"
python3 -m zipfile -e kiln_ibl-*.whl "$work/wheel"
for path in "$source" "$HOME/"; do
    [ "$path" != "//" ] || continue
    ! grep -rlF "$path" "$work" || die "$path is in the files above"
done

# The installed library as other programs meet it, out of the Debian package.
pc=$(dirname "$(find "$work/deb" -name kiln.pc)")
export PKG_CONFIG_PATH="$pc"
# shellcheck disable=SC2046 # flags are words
cc -std=c17 $(pkg-config --cflags kiln) "$source/tests/package/consumer/main.c" -o "$work/consumer" \
    $(pkg-config --libs kiln)
LD_LIBRARY_PATH=$(dirname "$pc") "$work/consumer"
for name in bin/kiln share/man/man1/kiln.1.gz share/doc/kiln/copyright share/bash-completion/completions/kiln; do
    [ -s "$work/deb/usr/$name" ] || die "the Debian package lacks /usr/$name"
done
(cd "$work/deb" && dpkg-deb --ctrl-tarfile "$source/build/dist/kiln_${version}_"*.deb | tar -x -f - ./md5sums -O |
    md5sum --quiet -c)
