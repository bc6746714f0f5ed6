#!/bin/sh
# Makes a Debian package of a build: the command with its manual and completions, the library, headers, and what CMake
# and pkg-config read.
#   packaging/deb.sh BUILD OUT
# BUILD is configured with CMAKE_INSTALL_PREFIX=/usr. The file is OUT/kiln_VERSION_ARCHITECTURE.deb. Its bytes follow
# from the build and from SOURCE_DATE_EPOCH, the seconds since 1970 that files have as their date.
set -eu
build=$(cd "$1" && pwd)
out=$(cd "$2" && pwd)
work=$build/deb
root=$work/debian/kiln
umask 022
rm -rf "$work"
mkdir -p "$root/DEBIAN"

DESTDIR=$root cmake --install "$build" >"$work/log" || { cat "$work/log" >&2; exit 1; }
mv "$root/usr/share/doc/kiln/LICENSE" "$root/usr/share/doc/kiln/copyright"
gzip -n9 "$root/usr/share/man/man1/kiln.1" "$root/usr/share/doc/kiln/CHANGELOG.md"
mv "$root/usr/share/doc/kiln/CHANGELOG.md.gz" "$root/usr/share/doc/kiln/changelog.gz"
strip --remove-section=.comment --remove-section=.note "$root/usr/bin/kiln"
library=$(find "$root/usr/lib" -name 'libkiln.so.*.*.*')
strip --strip-unneeded --remove-section=.comment --remove-section=.note "$library"
strip --strip-debug --enable-deterministic-archives "$(find "$root/usr/lib" -name libkiln.a)"

version=$(sed -n 's/^Version: //p' "$(find "$root" -name kiln.pc)")
architecture=$(dpkg --print-architecture)
cd "$work"
printf 'Source: kiln\nPackage: kiln\nArchitecture: any\n' >debian/control # which dpkg-shlibdeps asks for
needed=$(dpkg-shlibdeps -O "$root/usr/bin/kiln" "$library" 2>log | sed -n 's/^shlibs:Depends=//p')
[ -n "$needed" ] || { cat log >&2; exit 1; }
cat >"$root/DEBIAN/control" <<CONTROL
Package: kiln
Version: $version
Architecture: $architecture
Maintainer: kiln <kiln@localhost>
Installed-Size: $(find "$root/usr" -type f -printf '%s\n' | awk '{ n += int(($1 + 1023) / 1024) } END { print n }')
Depends: $needed
Recommends: libegl1, libgl1-mesa-dri
Suggests: libzstd-dev, libdeflate-dev, libjpeg-dev
Section: graphics
Priority: optional
Description: exact image-based lighting
 kiln computes the prefiltered environment maps, irradiance and spherical
 harmonics by which real-time engines light surfaces. This package has the
 command, the C library, and its headers. The suggested packages are needed to
 link the static library.
CONTROL
cat >"$root/DEBIAN/triggers" <<'TRIGGERS'
activate-noawait ldconfig
TRIGGERS
(cd "$root" && find usr -type f | LC_ALL=C sort | xargs md5sum) >"$root/DEBIAN/md5sums"
find "$root" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
dpkg-deb --root-owner-group --threads-max=1 -Zxz --build "$root" "$out/kiln_${version}_$architecture.deb" >log ||
    { cat log >&2; exit 1; }
