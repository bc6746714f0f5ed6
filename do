#!/bin/sh
# The one entry: ./do help
set -eu
cd "$(dirname "$0")"

# What each part needs, as tool:package where a tool shows that it is there, else as a package.
build_needs="cmake:cmake ninja:ninja-build cc:gcc pkg-config:pkg-config libc6-dev libopenexr-dev
    libdeflate-dev libpng-dev libzstd-dev libcmocka-dev
    libegl-dev libgles-dev libglfw3-dev libegl1 libgl1-mesa-dri"
test_needs="node:nodejs npm:npm chromium:chromium mandoc:mandoc clang-format:clang-format script:bsdutils Xvfb:xvfb xauth:xauth
    oiiotool:openimageio-tools
    glslangValidator:glslang-tools"
web_needs="cmake:cmake ninja:ninja-build emcc:emscripten node:nodejs npm:npm"
bench_needs="cmgen:libfilament-tools oiiotool:openimageio-tools valgrind:valgrind chromium:chromium"
lint_needs="clang-tidy:clang-tidy clang-format:clang-format cppcheck:cppcheck shellcheck:shellcheck"
fuzz_needs="clang:clang libclang-rt-14-dev"

usage() {
    cat <<'HELP'
./do build     builds the command: build/release/bin/kiln
./do test      builds and runs every test
./do demo      bakes a sky and a real panorama into a page: build/demo/index.html
./do web [N]   builds the page that bakes in the browser, serves it on loopback (port N, else 8420)
./do bench     measures speed and accuracy beside other bakers
./do lint      clang-tidy, cppcheck, shellcheck, formatting, layers
./do format    formats the sources
./do fuzz [S]  runs every fuzz target for S seconds (60)
./do clean     removes what was built and fetched

Each sets up what it needs. On Debian and Ubuntu, missing packages are installed when root or sudo
can do it; elsewhere their names are printed.
HELP
}

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'do: %s\n' "$*" >&2; exit 1; }

# need ENTRY...: installs the packages that are missing, or names them.
need() {
    missing=
    for entry; do
        package=${entry#*:}
        case $entry in
        *:*) command -v "${entry%%:*}" >/dev/null 2>&1 || missing="$missing $package" ;;
        *) dpkg -s "$package" >/dev/null 2>&1 || missing="$missing $package" ;;
        esac
    done
    [ -n "$missing" ] || return 0
    command -v apt-get >/dev/null 2>&1 ||
        fail "please install what Debian 12 calls:$missing"
    root=
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null 2>&1 ||
            fail "please run as root: apt-get install$missing"
        root=sudo
    fi
    say "installing$missing"
    # shellcheck disable=SC2086 # several words on purpose
    install="$root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing"
    $install || { $root apt-get update -q && $install; } || fail "cannot install:$missing"
}

# shellcheck disable=SC2086 # a list is split on purpose
need_all() { need $1; }

# build PRESET TARGET... [-D...]
build() {
    preset=$1
    shift
    say "building $preset"
    cmake --preset "$preset" "$@" >"build/$preset.log" 2>&1 || { cat "build/$preset.log"; exit 1; }
    cmake --build --preset "$preset"
}

panoramas() {
    say "panoramas"
    scripts/panoramas.sh ||
        { [ -n "$(find /var/lib/apt/lists -name '*Packages*' 2>/dev/null)" ] && return 1; } ||
        { $([ "$(id -u)" = 0 ] || echo sudo) apt-get update -q && scripts/panoramas.sh; }
}

# npm_packages FOLDER...: packages as the folder's lock file names them.
npm_packages() {
    for folder; do
        [ -e "$folder/package-lock.json" ] || continue
        stamp=$folder/node_modules/.package-lock.json
        [ -e "$stamp" ] && [ -z "$(find "$folder/package-lock.json" -newer "$stamp")" ] && continue
        say "npm ci in $folder"
        (cd "$folder" && npm ci --no-audit --no-fund)
        touch "$stamp"
    done
}

# run_tests PRESET [ctest options]: runs, and adds up what passed and failed.
passed=0
failed=0
run_tests() {
    preset=$1
    shift
    say "testing $preset"
    results=build/$preset/results.xml
    rm -f "$results"
    ctest --test-dir "build/$preset" --output-on-failure -j2 --output-junit "$PWD/$results" "$@" || true
    [ -s "$results" ] || fail "ctest left no results"
    count() { sed -n "s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$results" | head -n 1; }
    failed=$((failed + $(count failures) + $(count disabled)))
    passed=$((passed + $(count tests) - $(count failures) - $(count skipped) - $(count disabled)))
    [ "$(count skipped)" = 0 ] || fail "$(count skipped) tests were skipped"
}

mkdir -p build
command=${1:-help}
[ $# = 0 ] || shift
case $command in
build)
    need_all "$build_needs"
    build release
    say "the command is build/release/bin/kiln"
    ;;
test)
    need_all "$build_needs $test_needs $web_needs"
    panoramas
    npm_packages web tests/web tests/files/ktx tests/brdf/witness tests/engines
    build release
    build wasm
    run_tests release
    build asan -DKILN_BENCH=OFF -DKILN_EXAMPLES=OFF
    run_tests asan -L unit -LE slow
    printf '\n%d passed, %d failed\n' "$passed" "$failed"
    [ "$failed" = 0 ]
    ;;
web)
    need_all "$web_needs"
    npm_packages web
    build wasm
    node web/serve.mjs build/wasm/site "$@"
    ;;
demo)
    need_all "$build_needs"
    panoramas || echo "No real panorama can be had: the demo shows the sky alone."
    build release
    set -- build/data/blender/city.exr
    [ -e "$1" ] || shift
    mkdir -p build/demo
    if [ $# -gt 0 ]; then
        need_all "$web_needs $bench_needs"
        npm_packages tests/web tests/engines
        say "drawing in the engines"
        node examples/gallery.mjs build/release/bin build/gallery build/demo/gallery.part \
            build/data/blender/courtyard.exr build/data/blender/sunrise.exr
    fi
    say "baking"
    build/release/bin/demo build/demo "$@"
    rm -f build/demo/gallery.part
    say "open $PWD/build/demo/index.html"
    ;;
bench)
    need_all "$build_needs $bench_needs $web_needs"
    panoramas
    npm_packages web tests/web tests/engines bench/blocks
    build release
    build wasm
    bench/run.sh "$@"
    ;;
lint)
    need_all "$build_needs $lint_needs $web_needs"
    say "layers" && scripts/layers.sh
    say "formatting" && scripts/format.sh --check
    say "shellcheck"
    shellcheck -S warning ./do .ci/run
    find scripts tests bench -name "*.sh" -not -path "*/node_modules/*" -exec shellcheck -x -P SCRIPTDIR -S warning {} +
    build strict
    sources=$(find src cli viewer bench examples tests -name '*.c' -not -path '*/node_modules/*')
    say "cppcheck"
    # shellcheck disable=SC2086 # a list is split on purpose
    cppcheck --quiet --error-exitcode=1 --inline-suppr --std=c11 -I include -I src \
        --enable=warning,performance,portability --suppress=missingInclude $sources
    say "clang-tidy"
    printf '%s\n' "$sources" | xargs -n 1 -P 2 clang-tidy --quiet -p build/strict 2>build/tidy.log
    # The page's, by the commands that emcc is called with; these need not be run.
    npm_packages web
    cmake --preset wasm >build/wasm.log 2>&1 || { cat build/wasm.log; exit 1; }
    clang-tidy --quiet -p build/wasm --extra-arg=--target=wasm32-unknown-emscripten \
        --extra-arg=--sysroot="$(em-config CACHE)/sysroot" web/*.c 2>>build/tidy.log
    ;;
format)
    need clang-format:clang-format
    scripts/format.sh
    ;;
fuzz)
    need_all "$build_needs $fuzz_needs"
    build fuzz
    for target in build/fuzz/bin/fuzz_*; do
        name=${target##*/fuzz_}
        say "fuzzing $name"
        mkdir -p "build/corpus/$name" "build/finds"
        "$target" -max_total_time="${1:-60}" -rss_limit_mb=2048 -timeout=10 \
            -artifact_prefix="build/finds/$name-" "build/corpus/$name" tests/files/good \
            tests/files/bad
    done
    ;;
clean)
    rm -rf build web/node_modules tests/*/node_modules tests/*/*/node_modules
    ;;
help | -h | --help)
    usage
    ;;
*)
    usage >&2
    exit 2
    ;;
esac
