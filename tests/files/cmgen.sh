#!/bin/sh
# cmgen.sh KILN FOLDER: a cube that Filament's cmgen writes as KTX 1 from a smooth panorama is read by kiln, with the
# directions and values of the panorama. Panoramas that cmgen writes as DDS, and mipgen as KTX 1, are read with the texels
# that oiiotool reads from the same panorama.
# shellcheck disable=SC2086 # $options and $same are several words
set -eu
kiln=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
for program in cmgen mipgen oiiotool; do
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

# The same panorama as DDS and as OpenEXR, both of halfs. (DDS files of 32-bit floats by cmgen
# hold 3.0 in every texel.)
same="--shape panorama --levels 1 --format rgba32f -q"
for format in exr dds; do
    cmgen -q -t equirect -f $format -s 16 --extract=$format smooth.exr
done
"$kiln" bake dds/smooth/skybox.dds -o dds.exr $same --size 16
oiiotool dds.exr exr/smooth/skybox.exr --fail 0 --diff

# KTX 1 of 8 bits, whose rows of 30 bytes mipgen does not fill up to a multiple of 4.
oiiotool --pattern noise:type=uniform:min=0:max=1:seed=3 10x5 3 -d uint8 -o bytes.png
mipgen -q -f ktx bytes.png bytes.ktx
"$kiln" bake bytes.ktx -o bytes.exr $same --size 5
oiiotool bytes.png -d float -o linear.exr
oiiotool bytes.exr linear.exr --fail 1e-7 --diff # oiiotool multiplies by 1 / 255
