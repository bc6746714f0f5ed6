#!/bin/sh
# Formats every C file by clang-format 14; versions differ in what they call formatted.
#   scripts/format.sh            formats
#   scripts/format.sh --check    fails naming the files that are not formatted
#   scripts/format.sh --tool     prints the name of clang-format 14, or fails where there is none
set -eu
cd "$(dirname "$0")/.."
version=14

tool=
for name in clang-format-$version clang-format; do
    if "$name" --version 2>/dev/null | grep -q "version $version\."; then
        tool=$name
        break
    fi
done
if [ -z "$tool" ]; then
    echo "format: clang-format $version is not installed (Debian 12: clang-format; elsewhere: pip install 'clang-format==$version.*')" >&2
    exit 1
fi
case ${1:-} in
--tool)
    echo "$tool"
    exit 0
    ;;
--check) set -- --dry-run -Werror ;;
*) set -- -i ;;
esac
find include src cli tests examples bench fuzz viewer web \( -name '*.[ch]' -o -name '*.inl' \) \
    -not -path '*/node_modules/*' 2>/dev/null | sort | xargs "$tool" "$@"
