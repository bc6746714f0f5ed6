#!/bin/sh
# Installs a build, moves it, and builds the consumer from it in every way that is promised.
#   package.sh BUILD_FOLDER
set -eu
build=$1
consumer=$(cd "$(dirname "$0")" && pwd)/consumer
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

say() { printf '%s\n' "$*"; }

cmake --install "$build" --prefix "$work/first" >"$work/log" || { cat "$work/log"; exit 1; }
# Nothing may know where it was installed first.
mv "$work/first" "$work/moved"
prefix=$work/moved
pc=$(find "$prefix" -name kiln.pc)
libdir=$(dirname "$(dirname "$pc")")

for static in OFF ON; do
    {
        cmake -S "$consumer" -B "$work/cmake-$static" -G Ninja -DSTATIC=$static \
            -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release &&
            cmake --build "$work/cmake-$static"
    } >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    say "find_package, STATIC=$static: $("$work/cmake-$static/consumer")"
done

export PKG_CONFIG_PATH="$libdir/pkgconfig"
flags="-std=c17 -Wall -Wextra -Werror"
# shellcheck disable=SC2046,SC2086 # flags are words
cc $flags $(pkg-config --cflags kiln) "$consumer/main.c" -o "$work/shared" \
    $(pkg-config --libs kiln)
say "pkg-config, shared: $(LD_LIBRARY_PATH=$libdir "$work/shared")"
# Until 1.0 a minor version may change the interface, so the name that programs ask for carries it.
version=$(pkg-config --modversion kiln)
[ -e "$libdir/libkiln.so.${version%.*}" ] || { say "no libkiln.so.${version%.*}"; ls "$libdir"; exit 1; }
rm "$libdir"/libkiln.so*
# shellcheck disable=SC2046,SC2086
cc $flags $(pkg-config --cflags kiln) "$consumer/main.c" -o "$work/static" \
    $(pkg-config --static --libs kiln)
say "pkg-config, static: $("$work/static")"

# Other packages are not asked for: pkg-config knows none here.
only=$(PKG_CONFIG_LIBDIR="$libdir/pkgconfig" pkg-config --cflags --libs kiln)
[ -n "$only" ]
PKG_CONFIG_LIBDIR="$libdir/pkgconfig" pkg-config --static --libs kiln >/dev/null

[ "$("$prefix/bin/kiln" --version)" = "kiln $(pkg-config --modversion kiln)" ]
[ -s "$prefix/share/man/man1/kiln.1" ]
grep -q 'complete .* kiln$' "$prefix/share/bash-completion/completions/kiln"
grep -q '^#compdef kiln$' "$prefix/share/zsh/site-functions/_kiln"
grep -q '^complete -c kiln ' "$prefix/share/fish/vendor_completions.d/kiln.fish"

# Each header stands alone, in C and in C++, where its functions keep their C names.
compile() {
    language=$1
    header=$2
    call=$3
    printf '#include <kiln/%s.h>\n#include <kiln/%s.h>\nint main(void) { return (%s); }\n' \
        "$header" "$header" "$call" >"$work/alone.$language"
    case $language in
        c) set -- cc -std=c17 ;;
        *) set -- c++ -std=c++17 ;;
    esac
    # shellcheck disable=SC2046
    "$@" -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags kiln) -c "$work/alone.$language" \
        -o "$work/alone.o"
    nm "$work/alone.o" | grep -q " U ${call%%(*}\$" ||
        { say "kiln/$header.h in .$language: ${call%%(*} is not a C function"; exit 1; }
}
headers=$(cd "$prefix/include/kiln" && echo *.h)
[ "$headers" = "brdf.h check.h course.h kiln.h" ] || { say "installed headers: $headers"; exit 1; }
languages=c
if command -v c++ >/dev/null; then languages="c cpp"; fi
for language in $languages; do
    compile "$language" kiln 'kiln_version() == 0'
    compile "$language" brdf 'kiln_turquin(1, 1) < 0'
    compile "$language" course 'kiln_textbook_brdf(0, 2, 1, 0, 0) == KILN_OK'
done
say "each header alone: $languages"
