#!/bin/sh
# Reads the command and the shared library as ELF files: relocations are read-only from the start on, the stack is
# not executable, the command may lie at any address, and the objects have the stack protector, checked calls of
# the C library and landing pads.
#   elf.sh COMMAND SHARED STATIC FORTIFY   (FORTIFY: yes if the build has optimisation and no sanitizer)
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
checks=0
die() {
    echo "FAILED: $*"
    exit 1
}
# has FILE WHAT PATTERN readelf-options...: a line of what readelf prints matches.
has() {
    file=$1
    what=$2
    pattern=$3
    shift 3
    checks=$((checks + 1))
    LC_ALL=C readelf "$@" "$file" >"$work/said" 2>&1
    grep -Eq -- "$pattern" "$work/said" || die "$file: $what: no line of readelf $* matches $pattern"
}
for file in "$1" "$2"; do
    has "$file" "not position-independent" 'Type: +DYN' -hW
    has "$file" "relocations are writable" 'GNU_RELRO' -lW
    has "$file" "symbols are bound late" '\(FLAGS\).*BIND_NOW|\(FLAGS_1\).*NOW' -dW
    has "$file" "the stack is executable" 'GNU_STACK +0x0+ 0x0+ 0x0+ 0x0+ 0x0+ RW +0x' -lW
    has "$file" "no stack protector" ' UND __stack_chk_(fail|guard)' --dyn-syms -W
    [ "$4" = no ] || has "$file" "no checked calls" ' UND __v?snprintf_chk' --dyn-syms -W
    ! grep -q TEXTREL "$work/said" || die "$file: code is written to at the start"
    LC_ALL=C readelf -lW "$file" >"$work/said"
    ! grep -Eq ' LOAD .* (RWE|WE) ' "$work/said" || die "$file: memory that is writable and executable"
done
has "$1" "not a PIE" '\(FLAGS_1\).*PIE' -dW
# The C library's start files need not have landing pads, so that the linker may drop the mark: each object of
# kiln has it.
mkdir "$work/objects"
(cd "$work/objects" && ar x "$3")
count=0
for object in "$work"/objects/*.o; do
    case $(LC_ALL=C readelf -hW "$object") in
    *X86-64*) has "$object" "no landing pads" 'x86 feature: IBT, SHSTK' -nW ;;
    *AArch64*) has "$object" "no landing pads" 'AArch64 feature: BTI, PAC' -nW ;;
    esac
    count=$((count + 1))
done
[ $count -gt 100 ] || die "only $count objects in $3"
echo "$checks checks, $count objects"
