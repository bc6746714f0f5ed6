#!/bin/sh
# Measures reflections.csv: the errors of each way to look reflections up on gold balls, against the
# reference with a noise of 0.01, for each panorama. An error is the mean over the balls of roughness 0.35
# to 0.95 with single bounces of the RMS in steps of 255. Takes some minutes of processor time a panorama.
# Run by bench/run.sh reflections.
set -eu
cd "$(dirname "$0")/.."
echo "panorama,noise,straight,bent,one,two,three"
for panorama in build/data/blender/*.exr; do
    build/release/bin/kiln render "$panorama" --error --alone --noise 0.01 --size 192x108 \
        --fov 45 --distance 330 --bake-size 512 2>/dev/null |
        awk -v name="$(basename "$panorama" .exr)" '
            $3 == "single" && $1 > 0.3 { n++; for (i = 4; i <= 9; i++) sum[i] += $i }
            END { printf "%s", name; for (i = 4; i <= 9; i++) printf ",%.2f", sum[i] / n; print "" }'
done
