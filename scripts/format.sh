#!/bin/sh
# Formats every C file, or with --check fails naming those that are not formatted.
set -eu
cd "$(dirname "$0")/.."
set -- "$([ "${1:-}" = --check ] && echo '--dry-run -Werror' || echo -i)"
# shellcheck disable=SC2086 # two words on purpose
find include src cli tests examples bench fuzz viewer web \( -name '*.[ch]' -o -name '*.inl' \) \
    -not -path '*/node_modules/*' 2>/dev/null | sort | xargs clang-format $1
