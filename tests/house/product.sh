#!/bin/sh
# Only src/bake/environment.c goes from a source to levels, irradiance and harmonics: the command, the page
# and the window call kiln_bake, so that they agree. Fails on a planted call, too.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)

# Prints the calls in a tree that make a part of an environment by another way.
calls() {
    (cd "$1" && find cli web viewer -name node_modules -prune -o -name '*.[ch]' \
        -exec grep -nE 'kiln_spectrum_[a-z]+|kiln_prefilter *\(' /dev/null {} + || true)
}
found=$(calls "$root")
[ -z "$found" ] || { echo "$found"; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for line in 'kiln_prefilter(context, &map' 'kiln_spectrum_sh(spectrum' '    kiln_spectrum_analyze (c'; do
    mkdir -p "$work/cli" "$work/web" "$work/viewer"
    echo "$line" >"$work/viewer/a.c"
    [ -n "$(calls "$work")" ] || { echo "not found: $line"; exit 1; }
done
echo 'kiln_prefilter_def def = {0}; kiln_bake(context' >"$work/viewer/a.c"
[ -z "$(calls "$work")" ] || { echo "found where there is none"; exit 1; }
