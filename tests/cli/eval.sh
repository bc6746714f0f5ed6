#!/bin/sh
# kiln eval: values that were computed elsewhere, lines from standard input, and bad ones.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# check ERROR WANTED...: what was printed last, number by number.
check() {
    error=$1
    shift
    checks=$((checks + 1))
    printf '%s\n' "$@" | paste log/out - >log/pairs
    awk -v e="$error" 'NF != 2 || !($1 - $2 <= e && $2 - $1 <= e) { print; bad = 1 }
        END { exit bad || NR == 0 }' log/pairs || die "these differ by more than $error"
}

# E with 10 digits, by two-dimensional brute force in 25-digit arithmetic.
printf '%s\n' ".05 .01" ".25 .1" ".5 .5" ".75 .5" "1 .1" >log/points
printf '%s\n' .25 .5 1 >log/averages
both() {
    expect 0 "" eval e --g "$1" <log/points
    shift
    check 5.1e-11 "$1" "$2" "$3" "$4" "$5"
}
both schlick-text .0060856150 .1963985825 .5852642069 .5080071844 .5579142172
both schlick-k2 .7928232340 .6823584692 .7470809150 .5799818067 .5579142172
both smith .9645480233 .8967696353 .8572634356 .6631758453 .7602104727
both smith-uncorrelated .9642524855 .8924726019 .8550985344 .6474433943 .5579142172
average() {
    expect 0 "" eval eavg --g "$1" <log/averages
    check 5.1e-11 "$2" "$3" "$4"
}
average schlick-text .7832275764 .6798469390 .3766346112
average schlick-k2 .9453994702 .8017224932 .3766346112
average smith .9872502767 .8823233826 .4091370926
average smith-uncorrelated .9870565602 .8794556695 .3766346112

# E(1) = 1 - ln 2 at roughness 1, and its averages.
expect 0 "" eval e --g schlick-k2 --roughness 1 --mu 1
check 1e-12 .306852819440055
expect 0 "" eval eavg --g smith-uncorrelated --roughness 1
check 1e-12 .376634611192799
expect 0 "" eval eavg --roughness 1
check 1e-11 .409137092586740

# E = A + B, and other functions by their formulas.
expect 0 "" eval e --d beckmann --roughness .4 --mu .3
e=$(cat log/out)
expect 0 "" eval a --d beckmann --roughness .4 --mu .3
a=$(cat log/out)
expect 0 "" eval b --d beckmann --roughness .4 --mu .3
check 1e-11 "$(awk "BEGIN { printf \"%.15f\", $e - $a }")"
expect 0 "" eval d --roughness 1 --noh .3
check 1e-12 .318309886183791
expect 0 "" eval d --roughness 0 --noh 1
[ "$(cat log/out)" = inf ] || die "D of a mirror"
expect 0 "" eval schlick --f0 .04 --voh .5
check 1e-12 .07
expect 0 "" eval schlick-avg --f0 .04
check 1e-12 .085714285714286
expect 0 "" eval dielectric --ior 1.5 --voh 1
check 1e-12 .04
expect 0 "" eval conductor --n 1 --k 1 --voh 1
check 1e-12 .2
expect 0 "" eval f-add --roughness 1 --f 1
check 1e-11 1
expect 0 "" eval f-add --f-add assignment --roughness 1 --f .5
check 1e-11 .290345839832866
expect 0 "" eval kulla-conty --roughness 1 --mu 1 --nol 1 --g schlick-k2
check 1e-11 "$(awk 'BEGIN { e = 1 - log(2); printf "%.15f",
    (1 - e) ^ 2 / (3.14159265358979 * (1 - 4 * e ^ 2)) }')"
for quantity in sheen g specular turquin conductor-avg dielectric-avg dielectric-avg-fit \
    conductor-avg-fit; do
    echo .5 .5 .5 .5 | cut -d' ' -f"1-$(case $quantity in
    specular) echo 4 ;; g | turquin) echo 3 ;; sheen | con*) echo 2 ;; *) echo 1 ;; esac)" >log/in
    expect 0 "" eval $quantity <log/in
    grep -qx '[0-9.]*' log/out || die "eval $quantity"
done

# One argument fixed, the other on lines; the same numbers as both on lines.
seq 0 .125 1 >log/in
expect 0 "" eval e --roughness .25 <log/in
cp log/out log/fixed
sed 's/^/.25 /' log/in >log/both
expect 0 "" eval e <log/both
same log/out log/fixed
expect 0 "" eval e --mu .25 --json <log/in
cp log/out log/many
expect 0 "" eval e --mu .25 --roughness .125 --json
cp log/out log/one
expect 0 "" eval d --roughness 0 --noh 1 --json
node -e '
    const read = (name) => JSON.parse(require("fs").readFileSync("log/" + name, "utf8"));
    const many = read("many"), one = read("one"), inf = read("out");
    const good = many.length === 9 && many[1].roughness === 0.125 && many[1].mu === 0.25 &&
        JSON.stringify(many[1]) === JSON.stringify(one) && one.quantity === "e" &&
        one.d === "ggx" && one.g === "smith" && one.value > 0.9 && inf.value === null;
    process.exit(good ? 0 : 1);' || die "JSON"
: >log/in
expect 0 "" eval e <log/in
[ ! -s log/out ] || die "no lines, no values"

# Bad lines: their number, and not a single value printed.
bad() {
    printf '.5 .5\n%b' "$2" >log/in
    expect 1 "$1" eval e <log/in
}
bad "line 2 must be numbers for 'roughness mu'" '.5\n'
bad "line 2 must be numbers for 'roughness mu'" '\n.5 .5\n'
bad "line 2 must be numbers" '.5 x\n'
bad "line 2 must be numbers" '.5,.5\n'
bad "line 2 must be numbers" '.5x .5\n'
bad "line 3 has more numbers than 'roughness mu'" '.5 .5\n.5 .5 .5'
bad "line 2: mu is 1.5, it must be from 0 to 1" '.5 1.5'
bad "line 2: roughness is nan" 'nan 1'
bad "line 2: mu is -0.5" '1 -.5'
bad "line 2" '.5 .5\0 7'
seq 0 .00001 1 >log/in
expect 0 "" eval e --roughness .7 <log/in
[ "$(wc -l <log/out)" = "$(wc -l <log/in)" ] || die "as many values as lines"
passed
