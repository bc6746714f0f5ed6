#!/bin/sh
# The help, the manual page and the shells' completions, which are all written from the same rows.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"
page=$(cd "$(dirname "$0")/../../man" && pwd)/kiln.1

commands=$("$KILN" --help | sed -n 's/^  kiln \([a-z]*\)  .*[.]$/\1/p')
[ "$(echo "$commands" | wc -w)" -ge 9 ] || die "commands: $commands"

# Every line within 80 characters, or within the terminal's width; options with range and default.
for command in $commands; do
    expect 0 "" help "$command"
    awk -v c="$command" 'length > 80 && !/^  [a-z]/ { print c ": " $0; bad = 1 } END { exit bad }' log/out ||
        die "wider than 80"
done
expect 0 "" help bake
tr -s ' \n' '  ' <log/out >log/flat
has() { grep -q -F -- "$1" log/flat || die "the help does not say: $1"; }
has "--size N texels along the edge of a face, or rows of a panorama (1 to 32768, default 256, or the engine's with --for)"
has "--levels N mip levels to write (1 to 16, default all, down to 1 texel, or the engine's with --for)"
has '(ggx, lambert, charlie or phong; default ggx)'
has '--zstd[=LEVEL] compress KTX2 files by Zstandard (1 to 22, 3 without LEVEL)'
has '--exposure STOPS multiply the radiance by 2^STOPS (-64 to 64, default 0)'
has '--irradiance FILE write a map of the irradiance divided by pi'
has '-q, --quiet print nothing but errors'
! grep -q -- '--fit' log/out || die "the option that has gone is in the help"
if command -v script >log/which; then
    script -q -e -c "stty cols 60; '$KILN' help bake" /dev/null </dev/null | tr -d '\r' >log/out
    awk 'length > 60 && !/^  [a-z]/ { exit 1 }' log/out || die "wider than the terminal"
    awk 'length > 50 { n++ } END { exit n < 20 }' log/out || die "narrower than the terminal"
    checks=$((checks + 1))
fi

# The manual page of the sources is what the rows say. (Without the viewer some commands are missing.)
case $commands in
*render*)
    "$KILN" help --man >log/kiln.1
    diff "$page" log/kiln.1 >log/out || die "man/kiln.1 is not what 'kiln help --man' writes"
    ;;
esac
for option in size tune zstd irradiance elevation axis max-coefficients; do
    grep -q "^\.It.* Fl -$option" "$page" || die "the manual has no --$option"
done
tr '\n' ' ' <"$page" | grep -q '(1 to 32768, default 256, or the' || die "the manual has no range"
checks=$((checks + 3))

# What bash completes.
if command -v bash >log/which; then
    "$KILN" completions bash >log/kiln.bash
    cat >log/complete.bash <<'BASH'
# complete.bash WORD...: the completions of the last word, in one line.
. log/kiln.bash
COMP_WORDS=(kiln "$@")
COMP_CWORD=$#
_kiln
echo "${COMPREPLY[*]}"
BASH
    completes() {
        want=$1
        shift
        checks=$((checks + 1))
        got=$(bash log/complete.bash "$@")
        [ "$got" = "$want" ] || die "bash completes '$*' with '$got', not '$want'"
    }
    completes "bake batch" b
    completes "engines eval" e
    completes "--size" bake in.exr --siz
    completes "--sh-bands --sh-radiance --sh-irradiance --sh-window" bake --sh-
    completes "three three-cubeuv" bake in.exr --for th
    completes "ggx" bake --lobe = g
    completes "none sharp soft" bake --tune ""
    completes "none sharp soft" bake --tune =
    completes "" bake -o "fi"
    completes "" bake --size ""
    completes "babylon babylon-dds" tables --for bab
    completes "schlick schlick-avg" eval schl
    completes "babylon babylon-dds" engines bab
    completes "bake" help bak
    completes "zsh" completions z
    completes "--mirror" bake --zstd --mi
    completes "--shard" batch --shar
    completes "three three-cubeuv" batch in.exr --for th
    completes "--memory --method --mirror" batch --m
fi
# The other shells' are read by those shells, where they are.
for shell in bash zsh fish; do
    expect 0 "" completions $shell
    mv log/out log/kiln.$shell
    [ "$(grep -c -- 'irradiance-size' log/kiln.$shell)" -ge 1 ] || die "$shell has no --irradiance-size"
    ! grep -q 'the option that has gone\|-l fit\|--fit\b' log/kiln.$shell || die "$shell completes --fit"
    if command -v $shell >log/which; then
        $shell -n log/kiln.$shell || die "$shell does not read its completions"
        checks=$((checks + 1))
    fi
done
passed
