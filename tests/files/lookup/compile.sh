#!/bin/sh
# Runs the program $1, which writes code that looks tables up and a main.c that compares the code with
# kiln_table_lookup, in a folder of its own; compiles and runs main.c as C and as C++. Scripts that check GLSL too read
# this file, and go on in that folder.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" "$work"
cd "$work"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Werror"
# shellcheck disable=SC2086 # flags are words
cc -std=c99 -O1 $warnings main.c -o c -lm
./c
if command -v c++ >/dev/null; then
    cp main.c main.cpp
    # shellcheck disable=SC2086
    c++ -std=c++11 -O0 $warnings main.cpp -o cpp -lm
    ./cpp
fi
if ! command -v glslangValidator >/dev/null; then
    echo "glslangValidator is missing: install glslang-tools"
    exit 1
fi
