#!/bin/sh
# kiln bake while the rows of a file pass by: the same bytes as from standard input, which is read as a whole, and a
# peak of memory far below the size of the picture.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# The peak of memory that a bake reports, in bytes.
peak() { node -pe 'JSON.parse(require("fs").readFileSync("log/out")).peak_memory.process'; }

expect 0 "" sky -o sky.hdr --size 2048 --quiet
expect 0 "" bake sky.hdr -o rows.ktx2 --size 64 --threads 2 --quiet --json
passed_by=$(peak)
"$KILN" bake - -o whole.ktx2 --size 64 --threads 2 --quiet --json <sky.hdr >log/out
whole=$(peak)
same rows.ktx2 whole.ktx2
checks=$((checks + 2))
# The picture of 4096 x 2048 texels takes 100.7 MB.
[ "$passed_by" -lt 64000000 ] || die "the bake took $passed_by bytes"
[ "$whole" -gt 110000000 ] || die "the whole picture took $whole bytes: is the comparison right?"

# Mirrored, exposed and turned; and a bake that takes the sun out, which needs the whole picture.
expect 0 "" sky -o small.exr --size 256 --quiet
for options in "--mirror --exposure 1 --rotate 30" "--sun extract" "--for three" "--layout panorama --negative zero"; do
    # shellcheck disable=SC2086
    expect 0 "" bake small.exr -o rows.ktx2 --size 64 --irradiance rows-diffuse.ktx2 --sh rows.json --quiet $options
    # shellcheck disable=SC2086
    "$KILN" bake - -o whole.ktx2 --size 64 --irradiance whole-diffuse.ktx2 --sh whole.json --quiet $options <small.exr
    same rows.ktx2 whole.ktx2
    same rows-diffuse.ktx2 whole-diffuse.ktx2
    same rows.json whole.json
done
passed
