#!/bin/sh
# The one entry: ./do help
set -eu
cd "$(dirname "$0")"

usage() {
    cat <<'HELP'
./do build     builds the command: build/release/bin/kiln
./do test      builds and runs every test but those of ./do test-dist
./do test-dist builds and runs the tests of what is handed out, which take long
./do test-cluster   bakes on a Slurm cluster of two nodes on this machine, one of which dies
./do demo      bakes a sky and a real panorama into a page: build/demo/index.html
./do web [N]   builds the page that bakes in the browser, serves it on loopback (port N, else 8420)
./do web --build DIR   builds this page as static files in the folder DIR, for any web server
./do docs [DIR]   makes the documentation and the C library's reference as static pages (DIR, else build/docs)
./do python    builds the Python package and its wheel in build/release/python
./do npm       builds the npm package: build/npm/kiln-ibl-VERSION.tgz
./do dist      makes the downloads in build/dist: programs for Linux and Windows, a Debian package, a wheel
./do bench     measures speed and accuracy beside other bakers
./do lint      clang-tidy, cppcheck, shellcheck, formatting, layers
./do format    formats the sources
./do fuzz [TARGET|all|process [S]]   runs a fuzz target, every one, or the command for S seconds (60)
./do test-bare [bookworm|trixie]   demo and test on a bare Debian 12, 13 or both, made by debootstrap
./do clean     removes what was built and fetched

Each sets up what it needs. On Debian and Ubuntu, missing packages are installed when root or sudo
can do it; elsewhere their names are printed.
HELP
}

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'do: %s\n' "$*" >&2; exit 1; }

# is_there WHAT: whether that which a row of scripts/needs.txt is shown by is there.
is_there() {
    case $1 in
    pkg:*) pkg-config --exists "${1#pkg:}" 2>/dev/null ;;
    lib:*) { ldconfig -p || /sbin/ldconfig -p; } 2>/dev/null | grep -qF "${1#lib:}" ;;
    @swrast) [ -n "$(find /usr/lib* -maxdepth 3 -name swrast_dri.so 2>/dev/null)" ] ;;
    @wine) [ -x /usr/lib/wine/wine64 ] || command -v wine64 wine >/dev/null 2>&1 ;;
    @numpy) /usr/bin/python3 -c 'import numpy' 2>/dev/null || python3 -c 'import numpy' 2>/dev/null ;;
    @fuzzer) [ -n "$(find "$(clang -print-resource-dir 2>/dev/null || echo /none)" -name '*fuzzer*.a' 2>/dev/null)" ] ;;
    /*) [ -e "$1" ] ;;
    *) command -v "$1" >/dev/null 2>&1 ;;
    esac
}

# names COLUMN: the packages of that column, each once, of the rows of standard input.
names() {
    awk -v at="$1" 'NF && $at != "-" && !seen[$at]++ { printf " %s", $at }'
}

# install_by_apt PACKAGE...: as root or by sudo; waits for another program that installs.
install_by_apt() {
    root=$([ "$(id -u)" = 0 ] || echo sudo)
    wait="-o DPkg::Lock::Timeout=600"
    say "installing $*"
    install="$root env DEBIAN_FRONTEND=noninteractive apt-get install $wait -q -y --no-install-recommends $*"
    $install || { $root apt-get update $wait -q && $install; } || fail "cannot install: $*"
}

# need PART...: installs by apt what the parts' rows of scripts/needs.txt name and is not there, or
# says its names.
need() {
    missing=$(for part; do
        awk -v part="$part" '!/^#/ && index("," $1 ",", "," part ",")' scripts/needs.txt
    done | while read -r parts shown rest; do
        is_there "$shown" || echo "$parts $shown $rest"
    done)
    debian=$(echo "$missing" | names 3)
    [ -n "$debian" ] || return 0
    if command -v apt-get >/dev/null 2>&1 && { [ "$(id -u)" = 0 ] || command -v sudo >/dev/null 2>&1; }; then
        # shellcheck disable=SC2086 # a list is split on purpose
        install_by_apt $debian
        return
    fi
    fedora=$(echo "$missing" | names 4)
    arch=$(echo "$missing" | names 5)
    homebrew=$(echo "$missing" | names 6)
    fail "please install what is missing, named by Debian$debian; by Fedora$fedora; by Arch$arch; by Homebrew$homebrew"
}

# build PRESET [-D...]: `low` is what the compilers are run by, such as nice, or is empty.
low=
build() {
    preset=$1
    shift
    say "building $preset"
    cmake --preset "$preset" "$@" >"build/$preset.log" 2>&1 || { cat "build/$preset.log"; exit 1; }
    $low cmake --build --preset "$preset"
}

# build_release [PART...]: the command, and of TESTS, GOLDEN, BENCH, EXAMPLES and PYTHON the named parts only. All
# commands of this script share build/release, so that each source is compiled once.
build_release() {
    parts=$*
    set --
    for part in TESTS GOLDEN BENCH EXAMPLES PYTHON; do
        case " $parts " in
        *" $part "*) set -- "$@" "-DKILN_$part=ON" ;;
        *) set -- "$@" "-DKILN_$part=OFF" ;;
        esac
    done
    build release "$@"
}

# build_npm: the npm package of the command as WebAssembly, once with vectors and once without.
build_npm() {
    mkdir -p build/npm
    for preset in wasm wasm-scalar; do
        say "building $preset"
        cmake --preset $preset >"build/$preset.log" 2>&1 || { cat "build/$preset.log"; exit 1; }
        cmake --build --preset $preset --target kiln_npm
    done
    say "packing"
    node npm/tools/pack.mjs build/npm build/wasm/npm/kiln.wasm build/wasm-scalar/npm/kiln.wasm
}

# build_asan: tests of the library; the command and the renderer are not run under the sanitizers. The low priority
# leaves the processor to the release tests, which run at the same time and wait much of theirs.
build_asan() {
    low="nice -n 19"
    build asan -DKILN_BENCH=OFF -DKILN_EXAMPLES=OFF -DKILN_CLI=OFF -DKILN_VIEWER=OFF
}

# start BUILD [PART...]: builds while the shell goes on, to what downloads, unpacks or tests; await waits for the
# build and shows what it printed.
start() {
    "$@" >build/compiling.log 2>&1 &
    compiling=$!
}
await() {
    wait $compiling || { cat build/compiling.log; exit 1; }
    cat build/compiling.log
}

panoramas() {
    say "panoramas"
    scripts/panoramas.sh ||
        { [ -n "$(find /var/lib/apt/lists -name '*Packages*' 2>/dev/null)" ] && return 1; } ||
        { $([ "$(id -u)" = 0 ] || echo sudo) apt-get update -q && scripts/panoramas.sh; }
}

# npm_packages FOLDER...: packages as the folder's lock file, or its script fetch.sh, names them.
npm_packages() {
    for folder; do
        [ ! -e "$folder/fetch.sh" ] || "$folder/fetch.sh"
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
    # One test more than there are cores: those with a browser, an emulator or a lock wait much of the time.
    ctest --test-dir "build/$preset" --output-on-failure -j$(($(nproc 2>/dev/null || echo 2) + 1)) --output-junit "$PWD/$results" "$@" || true
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
    need build render
    build_release
    say "the command is build/release/bin/kiln"
    ;;
test)
    need build
    start build_release EXAMPLES
    need render web test
    panoramas
    npm_packages web npm/codecs tests/web tests/files/assets tests/files/ktx tests/brdf/witness tests/engines
    await
    start build wasm
    build_release TESTS GOLDEN BENCH EXAMPLES PYTHON
    await
    start build_asan
    run_tests release -LE dist
    await
    run_tests asan -L unit -LE slow
    printf '\n%d passed, %d failed\n' "$passed" "$failed"
    [ "$failed" = 0 ]
    ;;
test-dist)
    need build render web test python dist docs test-dist
    panoramas
    npm_packages web npm/codecs tests/web tests/files/assets tests/engines tests/engines/versions tests/engines/cesium \
        tests/engines/galacean tests/engines/drei tests/engines/model-viewer tests/engines/godot4 tests/npm/types
    build wasm
    build_release TESTS GOLDEN EXAMPLES PYTHON
    run_tests release -L dist "$@"
    printf '\n%d passed, %d failed\n' "$passed" "$failed"
    [ "$failed" = 0 ]
    ;;
test-cluster)
    need build cluster
    build_release
    tests/cluster/cluster.sh "$PWD/build/release/bin/kiln"
    ;;
python)
    need build python
    build_release PYTHON
    say "the wheel is build/release/python/$(cat build/release/python/wheel.txt)"
    ;;
npm)
    need web
    npm_packages web npm/codecs
    build_npm
    say "the package is build/npm/$(cat build/npm/name.txt)"
    ;;
dist)
    need build python web dist
    packaging/dist.sh
    ;;
web)
    need web
    npm_packages web npm/codecs
    build wasm
    if [ "${1:-}" = --build ]; then
        [ $# = 2 ] || fail "say in which folder:  ./do web --build DIR"
        mkdir -p "$2"
        cp -R build/wasm/site/. "$2"
        say "the page is $2/index.html"
        exit
    fi
    node web/serve.mjs build/wasm/site "$@"
    ;;
docs)
    need docs
    packaging/docs/make.sh "${1:-build/docs}"
    say "the pages begin at ${1:-build/docs}/index.html"
    ;;
demo)
    need build
    panoramas || echo "No real panorama can be had: the demo shows the sky alone."
    mkdir -p build/demo
    set -- build/data/blender/city.exr
    if [ -e "$1" ]; then
        start build_release EXAMPLES
        need demo
        npm_packages tests/web tests/engines
        await
        say "drawing in the engines"
        node examples/gallery.mjs build/release/bin build/gallery build/demo/gallery.part \
            build/data/blender/courtyard.exr
    else
        shift
        build_release EXAMPLES
    fi
    say "baking"
    build/release/bin/demo build/demo "$@"
    rm -f build/demo/gallery.part
    say "open $PWD/build/demo/index.html"
    ;;
bench)
    need build web bench
    panoramas
    npm_packages web npm/codecs tests/web tests/engines tests/engines/cesium tests/engines/galacean tests/files/assets \
        bench/blocks
    build_release BENCH
    build wasm
    bench/run.sh "$@"
    ;;
lint)
    need build web lint
    say "layers" && scripts/layers.sh
    say "formatting" && scripts/format.sh --check
    say "shellcheck"
    shellcheck -S warning ./do .ci/run
    find scripts packaging contrib tests bench -name "*.sh" -not -path "*/node_modules/*" -exec shellcheck -x -P SCRIPTDIR -S warning {} +
    build strict
    sources=$(find src cli viewer bench examples tests -name '*.c' -not -path '*/node_modules/*')
    say "cppcheck"
    # ctuuninitvar follows a load report into another file and does not see that loading fills the report.
    # shellcheck disable=SC2086 # a list is split on purpose
    cppcheck --quiet --error-exitcode=1 --inline-suppr --std=c11 -I include -I src \
        --enable=warning,performance,portability --suppress=missingInclude --suppress=ctuuninitvar $sources
    say "clang-tidy"
    printf '%s\n' "$sources" | grep -vE '/os_(thread_)?(windows|host)\.c$' |
        xargs -n 1 -P 2 clang-tidy --quiet -p build/strict 2>build/tidy.log
    # The sources for Windows and those for WebAssembly, by the commands that the cross compilers are called with;
    # nothing is compiled.
    cmake --preset mingw >build/mingw.log 2>&1 || { cat build/mingw.log; exit 1; }
    clang-tidy --quiet -p build/mingw src/base/os_windows.c cli/os_windows.c \
        cli/os_thread_windows.c 2>>build/tidy.log
    npm_packages web npm/codecs
    cmake --preset wasm >build/wasm.log 2>&1 || { cat build/wasm.log; exit 1; }
    clang-tidy --quiet -p build/wasm --extra-arg=--target=wasm32-unknown-emscripten \
        --extra-arg=--sysroot="$(em-config CACHE)/sysroot" web/*.c src/base/os_host.c cli/os_host.c \
        2>>build/tidy.log
    ;;
format)
    need format
    scripts/format.sh
    ;;
fuzz)
    need build fuzz
    case ${1:-all} in
    *[!0-9]*) ;;
    *) set -- all "$1" ;; # seconds alone
    esac
    build fuzz
    fuzz/run.sh build/fuzz/bin "$@"
    ;;
test-bare)
    [ "$(id -u)" = 0 ] ||
        fail "test-bare makes root file systems by debootstrap, which only root can do: sudo -E ./do test-bare"
    need bare
    exec scripts/test-bare.sh "$@"
    ;;
clean)
    rm -rf build web/node_modules npm/*/node_modules tests/*/node_modules tests/*/*/node_modules
    ;;
help | -h | --help)
    usage
    ;;
*)
    usage >&2
    exit 2
    ;;
esac
