#!/bin/sh
# Fetches the packages of npm that carry the C sources of zstd and libjpeg-turbo, into node_modules of this folder.
# Nothing of these packages runs. `npm ci` would also install the hundred packages that they run with, and npm 9, which
# Debian has, cannot leave those out. The list has each package's version and the SHA-512 of its archive.
set -eu
cd "$(dirname "$0")"
while read -r package sum; do
    folder=node_modules/${package%@*}
    [ "$(cat "$folder/.sum" 2>/dev/null)" != "$sum" ] || continue
    echo "fetching $package"
    part=$(mktemp -d)
    npm pack --silent --pack-destination "$part" "$package" >"$part/name"
    archive=$part/$(cat "$part/name")
    echo "$sum  $archive" | sha512sum --check --quiet || { echo "$package is not the package that was tested" >&2; exit 1; }
    rm -rf "$folder"
    mkdir -p "$folder"
    tar -xzf "$archive" -C "$folder" --strip-components=1
    echo "$sum" >"$folder/.sum"
    rm -rf "$part"
done <packages.txt
