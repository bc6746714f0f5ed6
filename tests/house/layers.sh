#!/bin/sh
# The layers script finds nothing here, and finds each violation that is planted.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
"$root/scripts/layers.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
plant() {
    file=$1
    line=$2
    mkdir -p "$work/tree/$(dirname "$file")" "$work/tree/src" "$work/tree/cli"
    printf '// two lines\n#  include %s\n' "$line" >"$work/tree/$file"
    if "$root/scripts/layers.sh" "$work/tree" >"$work/said"; then
        echo "not found: $line in $file"
        exit 1
    fi
    grep -q "^$file:2: " "$work/said" || { echo "not named $file:2:"; cat "$work/said"; exit 1; }
    rm -r "$work/tree"
}
plant src/base/a.c '"math/math.h"'
plant src/image/a.h '"codec/codec.h"'
plant src/codec/a.c '"sphere/lobe.h"'
plant src/sphere/a.inl '"brdf/ggx.h"'
plant src/tune/a.c '"bake/prefilter.h"'
plant src/table/a.c '"tune/tune.h"'
plant src/course/a.c '"table/table.h"'
plant src/bake/a.c '"engine/x.h"'
plant src/math/a.c '"math.h"'
plant src/new/a.c '"base/base.h"'
plant cli/a.c '"../src/base/base.h"'
plant bench/a.c '<kiln/other.h>'
plant examples/a.c '"base/base.h"'
plant viewer/a.c '"brdf/brdf.h"'

# And what is allowed passes.
mkdir -p "$work/tree/src/engine" "$work/tree/cli"
printf '#include "codec/codec.h"\n#include <kiln/kiln.h>\n#include <stdio.h>\n' >"$work/tree/src/engine/a.c"
printf '#include "cli.h"\n#include <kiln/kiln.h>\n#include <kiln/brdf.h>\n#include <kiln/course.h>\n#include <sys/stat.h>\n' >"$work/tree/cli/a.c"
"$root/scripts/layers.sh" "$work/tree"
