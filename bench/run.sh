#!/bin/sh
# Makes the inputs of the benchmarks and runs cases: bench/run.sh [--update] [CASE...]
# Results go to bench/results/MACHINE/CASE.csv. Further cases than those of `bench --list` are:
#   stream   measures the bakes of panoramas of 16384 x 8192 and 32768 x 16384, whose files take 3 GB on the disk
#   count    counts the instructions of a fixed bake; --update makes the new count the reference
#   web      compares kiln and three.js in a page of a browser
#   engines  compares the pixels of engines with kiln's files and with the engines' own bakes
#   engines-lights  measures the pixels with kiln's files after suns and lamps were taken out of the panoramas
#   load     measures the time from fetch to the first picture of pages of three.js that load kiln's files, and of pages
#            that load panoramas, which three.js filters itself
#   formats  measures the bytes and the errors of each format of each engine
#   reflections  measures the errors of the ways to look reflections up, and the time of a frame of each way
#   blocks   compares BC6H and UASTC HDR by kiln and by Basis Universal
#   batch    bakes a library of 200 panoramas by kiln batch, and some of them by cmgen
set -eu
cd "$(dirname "$0")/.."
bin=build/release/bin
inputs=build/bench
results=bench/results
reference=$results/instructions.csv

have() { command -v "$1" >/dev/null 2>&1; }
fail() { printf 'bench: %s\n' "$*" >&2; exit 1; }

update=no
if [ "${1:-}" = --update ]; then
    update=yes
    shift
fi
[ $# -gt 0 ] || set -- accuracy probe threads instructions files scaling peer memory tables tune count web engines blocks
for part in bench bench_reference kiln; do
    [ -x $bin/$part ] || fail "$bin/$part is missing: run ./do bench"
done
[ -s build/data/blender/city.exr ] || fail "the panoramas are missing: run scripts/panoramas.sh"
mkdir -p $inputs

# picture NAME WIDTHxHEIGHT: makes NAME.exr from the panorama city, enlarged, as half floats compressed by ZIP.
picture() {
    [ ! -s "$inputs/$1.exr" ] || return 0
    have oiiotool || fail "oiiotool is missing: install Debian's openimageio-tools"
    oiiotool build/data/blender/city.exr --resize "$2" -d half --compression zip \
        -o "$inputs/part.exr"
    mv "$inputs/part.exr" "$inputs/$1.exr"
}

# enlarged NAME WIDTHxHEIGHT OPTIONS...: makes NAME from the panorama city by oiiotool with these options.
enlarged() {
    file=$1 size=$2
    shift 2
    [ ! -s "$inputs/$file" ] || return 0
    have oiiotool || fail "oiiotool is missing: install Debian's openimageio-tools"
    oiiotool build/data/blender/city.exr --resize "$size" "$@" -o "$inputs/part.${file##*.}"
    mv "$inputs/part.${file##*.}" "$inputs/$file"
}

# Instructions executed by `bench fixed`, which are the same in every run of the same build.
count() {
    have valgrind || fail "valgrind is missing: install Debian's valgrind"
    printf '\ncount: instructions of one small bake (AVX2)\n'
    valgrind --tool=callgrind --callgrind-out-file=/dev/null $bin/bench fixed \
        >$inputs/count.log 2>&1 || { cat $inputs/count.log >&2; fail "valgrind failed"; }
    now=$(sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' $inputs/count.log)
    [ -n "$now" ] || fail "valgrind printed no count: see $inputs/count.log"
    compiler=$(sed -n 's/^CMAKE_C_COMPILER:[A-Z]*=//p' build/release/CMakeCache.txt)
    version=$("$compiler" -dumpfullversion 2>/dev/null || echo unknown)
    if [ $update = yes ] || [ ! -s $reference ]; then
        mkdir -p $results
        printf 'case,compiler,instructions\nfixed,%s,%s\n' "$version" "$now" >$reference
    fi
    compiled=$(sed -n 's/^fixed,\([^,]*\),.*/\1/p' $reference)
    before=$(sed -n 's/^fixed,[^,]*,//p' $reference)
    awk -v now="$now" -v before="$before" -v by="$compiled" -v version="$version" 'BEGIN {
        ratio = now / before
        printf "  %.1f million by gcc %s, reference %.1f million by gcc %s: %+.2f %%\n",
            now / 1e6, version, before / 1e6, by, 100 * (ratio - 1)
        if (ratio > 1.02 && version == by) {
            print "  the count grew by more than 2 %: MISSED (bench/run.sh --update count makes it the reference)"
            exit 1
        }
    }'
}

# Compares kiln's WebAssembly and three.js's PMREMGenerator in one browser.
web() {
    have chromium || fail "chromium is missing: install Debian's chromium"
    [ -s build/wasm/site/baker.wasm ] || fail "build/wasm/site is missing: run ./do bench"
    for folder in tests/web tests/engines; do
        [ -d $folder/node_modules ] || fail "packages are missing: run  npm ci --prefix $folder"
    done
    printf '\nweb: bakes in a page by kiln and by three.js, compared with brute force\n'
    node bench/web/pmrem.mjs build/release/bin build/wasm/site build/data/blender $inputs/web \
        "$results/$($bin/bench --machine)/web.csv"
}

# engine_pixels SCRIPT CASE: measures the pixels of engines by bench/engines/SCRIPT.mjs.
engine_pixels() {
    have chromium || fail "chromium is missing: install Debian's chromium"
    for folder in tests/web tests/engines tests/engines/cesium tests/engines/galacean; do
        [ -d $folder/node_modules ] || fail "packages are missing: run  npm ci --prefix $folder"
    done
    printf '\n%s: errors of pixels, compared with brute force\n' "$2"
    node "bench/engines/$1.mjs" build/release/bin build/data/blender "$inputs/$2" \
        "$results/$($bin/bench --machine)/$2.csv"
}

# With kiln's files and with the engines' own filters, of which Filament's is the program cmgen.
engines() {
    have cmgen || fail "cmgen is missing: install Debian's libfilament-tools"
    engine_pixels displayed engines
}

# Compares BC6H and UASTC HDR by kiln and by Basis Universal; oiiotool decodes BC6H.
blocks() {
    have oiiotool || fail "oiiotool is missing: install Debian's openimageio-tools"
    [ -d bench/blocks/node_modules ] || fail "packages are missing: run  npm ci --prefix bench/blocks"
    printf '\n'
    assets=tests/files/assets/node_modules/@pmndrs/assets/hdri
    [ -d $assets ] || fail "panoramas are missing: run  npm ci --prefix tests/files/assets"
    node bench/blocks/blocks.mjs build/release/bin build/data/blender $assets $inputs/blocks \
        "$results/$($bin/bench --machine)/blocks.csv"
}

# Errors and cost of kiln render --reflections.
reflections() {
    machine=$results/$($bin/bench --machine)
    printf '\nreflections: errors in steps of 255, and the time of a frame\n'
    bench/reflections.sh | tee "$machine/reflections.csv"
    $bin/bench_shading build/data/blender/courtyard.exr | tee "$machine/shading.csv"
}

status=0
for name; do
    case $name in
    count)
        count || status=1
        continue
        ;;
    web)
        web || status=1
        continue
        ;;
    engines)
        engines || status=1
        continue
        ;;
    load)
        engine_pixels load load || status=1
        continue
        ;;
    engines-lights)
        engine_pixels lights engines-lights || status=1
        continue
        ;;
    formats)
        have zstd || fail "zstd is missing: install Debian's zstd"
        engine_pixels formats formats || status=1
        continue
        ;;
    blocks)
        blocks || status=1
        continue
        ;;
    reflections)
        reflections || status=1
        continue
        ;;
    batch)
        bench/batch.sh $inputs/batch "$results/$($bin/bench --machine)/batch.csv" || status=1
        continue
        ;;
    peer)
        have cmgen || fail "cmgen is missing: install Debian's libfilament-tools"
        picture city2k 2048x1024
        ;;
    files) picture city2k 2048x1024 ;;
    memory) picture city8k 8192x4096 ;;
    stream)
        # Noise keeps the files from being as small as those of an enlarged picture. The largest takes 10 GB of memory.
        noise="--noise:type=uniform:min=0:max=0.02"
        enlarged city16k.exr 16384x8192 "$noise" -d float --compression zip
        enlarged city16k_piz.exr 16384x8192 "$noise" -d half --compression piz
        enlarged city16k.hdr 16384x8192 "$noise"
        enlarged city32k.exr 32768x16384 -d half --compression zip
        ;;
    esac
    $bin/bench --results $results --inputs $inputs --kiln $bin/kiln "$name" || status=1
done
exit $status
