#!/bin/sh
# cmgen.sh KILN FOLDER: a cube that Filament's cmgen writes as KTX 1 from a smooth panorama is read by kiln, with the
# directions and values of the panorama.
set -eu
kiln=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
for program in cmgen oiiotool; do
    command -v $program >/dev/null || { echo "$program is missing: install libfilament-tools and openimageio-tools"; exit 1; }
done
"$kiln" sky -o sky.exr --size 32 --azimuth 50 -q
"$kiln" bake sky.exr -o smooth.exr --lobe lambert --shape panorama --size 512 --format rgba32f -q
options="--size 16 --levels 1 --shape panorama --format rgba32f"
"$kiln" bake smooth.exr -o wanted.exr $options -q
cmgen -q -f ktx -s 64 -x made smooth.exr
"$kiln" bake made/made_skybox.ktx -o found.exr $options --rotate 180 2>log
grep -q "the cube is one for Filament" log
"$kiln" info made/made_ibl.ktx | grep -q "ktx1, b10g11r11"
# Values go to 35. A value of b10g11r11 has an error of 2^-6 at most, and cmgen reads the nearest texel of a panorama of
# 512 rows, up to 0.25 degrees away, where the panorama changes by 0.4 a degree.
oiiotool found.exr wanted.exr --fail 0.35 --diff
"$kiln" bake smooth.exr -o mirrored.exr $options --mirror -q
if oiiotool mirrored.exr wanted.exr --fail 3 --diff >log; then
    echo "the panorama does not tell left from right"
    exit 1
fi
