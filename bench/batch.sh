#!/bin/sh
# Bakes a library of 200 panoramas of 1024 x 512 for three.js by kiln batch, and a few of them by cmgen in a loop: CPU
# time with the system's, use of the cores, memory.
#   bench/batch.sh FOLDER-OF-INPUTS CSV
# The panoramas are those of Debian's blender-data and of the npm package @pmndrs/assets, 26 in all, each turned about
# the vertical axis by several angles. KILN_COUNT and KILN_PEERS change the numbers of panoramas.
set -eu
bin=build/release/bin
inputs=$1
csv=$2
count=${KILN_COUNT:-200}
peers=${KILN_PEERS:-4}
assets=tests/files/assets/node_modules/@pmndrs/assets/hdri
fail() { printf 'bench: %s\n' "$*" >&2; exit 1; }
command -v cmgen >/dev/null || fail "cmgen is missing: install Debian's libfilament-tools"
[ -d $assets ] || fail "packages are missing: run  npm ci --prefix tests/files/assets"

mkdir -p "$inputs/originals" "$inputs/library" "$inputs/out" "$inputs/cmgen" "$(dirname "$csv")"
if [ "$(find "$inputs/originals" -name '*.exr' | wc -l)" -lt 26 ]; then
    for file in build/data/blender/*.exr; do
        cp "$file" "$inputs/originals/blender-$(basename "$file")"
    done
    for file in "$assets"/*.exr.js; do
        sed 's/.*base64,//; s/[^A-Za-z0-9+\/=].*//' "$file" | base64 -d >"$inputs/originals/pmndrs-$(basename "$file" .js)"
    done
fi
set -- "$inputs"/originals/*.exr
originals=$#
made=0
while [ $made -lt "$count" ]; do
    for file; do
        [ $made -lt "$count" ] || break
        turned=$inputs/library/$(printf %04d $made)-$(basename "$file")
        [ -s "$turned" ] || $bin/kiln bake "$file" -q -o "$turned" --shape panorama --size 512 --levels 1 --roughness 0 \
            --format rgba16f --rotate $((made / originals * 360 / (count / originals + 1)))
        made=$((made + 1))
    done
done
[ "$(find "$inputs/library" -name '*.exr' | wc -l)" = "$count" ] || fail "$inputs/library holds other files, remove it"

# used COMMAND...: seconds of CPU time of a command, in its own code and in the system's.
used() {
    sh -c '"$@" >/dev/null 2>&1; times' sh "$@" | awk 'END {
        split($1, own, "m"); split($2, kernel, "m")
        print 60 * own[1] + own[2] + 60 * kernel[1] + kernel[2]
    }'
}
value() { sed -n "s/.*\"$1\": \([0-9.e+-]*\).*/\1/p" "$inputs/summary"; }

printf '\nbatch: %d panoramas of 1024 x 512 for three.js, exact levels of 256\n' "$count"
$bin/kiln batch "$inputs/library" -o "$inputs/out/{name}.ktx2" --for three --tune none --force --json \
    >"$inputs/report" 2>"$inputs/notes" &
pid=$!
# What Linux counts for each thread: nanoseconds on a core, and nanoseconds of waiting for one.
: >"$inputs/threads"
while kill -0 $pid 2>/dev/null; do
    cat /proc/$pid/task/*/schedstat >"$inputs/threads.now" 2>/dev/null && cp "$inputs/threads.now" "$inputs/threads"
    sleep 0.1
done
wait $pid || fail "$(cat "$inputs/notes")"
tail -n 1 "$inputs/report" >"$inputs/summary"
ready=$(awk '{ sum += $1 + $2 } END { print sum / 1e9 }' "$inputs/threads")
[ "$(value baked)" = "$count" ] || fail "$(cat "$inputs/summary")"
again=$(used $bin/kiln batch "$inputs/library" -o "$inputs/out/{name}.ktx2" --for three --tune none -q)
sum=0
done=0
for file in "$inputs"/library/*.exr; do
    [ $done -lt "$peers" ] || break
    sum="$sum $(used cmgen -q -f exr --size=256 --ibl-ld="$inputs/cmgen" "$file")"
    done=$((done + 1))
done
echo "$sum" | awk -v count="$count" -v peers="$peers" -v again="$again" -v csv="$csv" -v seconds="$(value seconds)" \
    -v cpu="$(value cpu_seconds)" -v threads="$(value threads)" -v peak="$(value peak_memory)" \
    -v limit="$(value memory_limit)" -v ready="$ready" '{
    for (i = 1; i <= NF; i++)
        cmgen += $i
    cmgen /= peers
    each = cpu / count
    busy = 100 * cpu / (seconds * threads)
    ratio = cmgen / each
    print "quantity,value,unit" >csv
    row("kiln batch, an environment", 1000 * each, "ms of CPU time")
    row("kiln batch, an environment that is kept", 1000 * again / count, "ms of CPU time")
    row("cmgen --ibl-ld --size=256, an environment", cmgen, "s of CPU time")
    row("cores busy", busy, "%")
    if (ready > 0) # on a machine with other work the cores are busy with that, too
        row("threads that run or wait for a core", ready / seconds, "on average")
    row("peak memory", peak / 1e6, "MB")
    row("limit of memory", limit / 1e6, "MB")
    row("environments in a core-hour", 3600 / each, "")
    bar("cores busy", busy, 90)
    bar("CPU time of cmgen / kiln", ratio, 100)
    exit missed
}
function row(name, value, unit) {
    printf "  %-42s %10.4g %s\n", name, value, unit
    printf "%s,%.6g,%s\n", name, value, unit >csv
}
function bar(name, value, least) {
    printf "  %-42s %10.4g  at least %g: %s\n", name, value, least, (value < least ? "MISSED" : "met")
    missed = missed || value < least
}'
