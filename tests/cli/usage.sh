#!/bin/sh
# Wrong command lines: a sentence, a hint, exit 2, and nothing written.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

got=0
"$KILN" >log/out 2>log/err || got=$?
[ $got = 2 ] && grep -q 'Usage: kiln' log/err && [ ! -s log/out ] || die "kiln alone"
expect 2 "frob: no such command" frob
expect 2 "frob: no such command" help frob
expect 2 "one command at a time" help bake sky
expect 2 "\-\-frob: no such option" --frob
expect 0 "" --help
grep -q 'kiln bake' log/out || die "help without the commands"
expect 0 "" --version
grep -qx 'kiln [0-9]*\.[0-9]*\.[0-9]*' log/out || die "version"
commands="bake completions engines eval fit help info sky tables"
! "$KILN" --help | grep -q 'kiln render' || commands="$commands render view assignment"
for command in $commands; do
    expect 0 "" help $command
    cp log/out log/help
    grep -q '^Examples:' log/out || die "no examples"
    expect 0 "" $command --help
    same log/out log/help
    expect 2 "kiln $command --help" $command --frob
done

# Inputs and outputs.
expect 2 "no input" bake
expect 2 "no input" bake -o out.ktx2
expect 2 "no output" bake in.exr
expect 2 "2 inputs" bake a.exr b.exr -o out.ktx2
expect 2 "7 inputs" bake 1 2 3 4 5 6 7 -o out.ktx2
expect 2 "do not tell which face each is" bake a b c d e f_px.exr -o out.ktx2
expect 2 "standard input" bake a b c d e - -o out.ktx2
expect 2 "must end in" bake in.exr -o out
expect 2 "must end in" bake in.exr -o out.gif
expect 2 "out.jpg: .jpg is a file for <model-viewer> and drei, which filter by themselves, add --for model-viewer" bake in.exr -o out.jpg
expect 2 "must end in" bake in.exr -o .exr
expect 2 "standard output holds one file, and this environment takes several" bake in.exr -o -.exr
expect 2 "standard output holds one file, and this environment takes several" bake in.exr -o - --for filament
expect 2 "leave out --json" bake in.exr -o - --json
expect 2 "leave out --irradiance" bake in.exr -o - --irradiance d.ktx2
expect 2 "only --output can be standard output" bake in.exr -o a.ktx2 --irradiance -
expect 2 "write {name} in the output for several" bake a.exr b.exr -o out.ktx2
expect 2 "a/x.exr and b/x.hdr would both be written to x.ktx2" bake a/x.exr b/x.hdr -o '{name}.ktx2'
expect 1 "there is no folder none" bake a.exr b.exr -o 'none/{name}.ktx2'
expect 2 "same file" bake in.exr -o out.exr --irradiance out.exr
expect 2 "must end in .json" bake in.exr -o out.ktx2 --sh sh.xml
expect 1 "there is no folder nowhere" bake in.exr -o nowhere/out.ktx2
expect 1 "there is no folder nowhere" bake in.exr -o out.ktx2 --sh nowhere/sh.json

# Engines.
expect 2 "for is 'frob', it must be three, .* or unreal$" bake in.exr -o out.ktx2 --for frob
expect 2 "tune needs --for ENGINE" bake in.exr -o out.ktx2 --tune sharp
expect 2 "tune is 'hard', it must be none, sharp or soft" bake in.exr -o out.ktx2 --for three --tune=hard
expect 2 "fit: this option is --tune sharp, --tune soft or --tune none since" bake in.exr -o out.ktx2 \
    --for three --fit
expect 2 "fit: this option is --tune sharp" bake in.exr -o out.ktx2 --for three --fit=none
expect 2 "out.dds: --for three writes .ktx2" bake in.exr -o out.dds --for three
expect 2 "decides what --lobe is" bake in.exr -o out.ktx2 --for three --lobe ggx
expect 2 "for filament: format is bc6h, it must be b10g11r11 or rgba16f" \
    bake in.exr -o out --for filament --format bc6h
expect 2 "for babylon: the engine.s files have one format only, leave the format out" bake in.exr -o out.env --for babylon --format rgba16f
expect 2 "three: size is 100, it must be a power of two from 16 to 4096" \
    bake in.exr -o out.ktx2 --for three --size 100
expect 2 "three: level_count is 1, a cube of size 32 may have 2 to 6 levels" \
    bake in.exr -o out.ktx2 --for three --size 32 --levels 1
expect 2 "one engine at a time" engines three babylon
expect 2 "frob: no such engine, it must be three, .* or unreal" engines frob
expect 2 "name one shell" completions
expect 2 "no such shell, it must be bash, zsh or fish" completions tcsh

# Values out of their range, with the range.
expect 2 "size is 0, it must be from 1 to 32768" bake in.exr -o out.ktx2 --size 0
expect 2 "size is 32769, it must be from 1 to 32768" bake in.exr -o out.ktx2 --size 32769
expect 2 "size is 99999999999999999999" bake in.exr -o out.ktx2 --size 99999999999999999999
expect 2 "whole number" bake in.exr -o out.ktx2 --size 1e3
expect 2 "whole number" bake in.exr -o out.ktx2 --size ''
expect 2 "\-\-size needs a value" bake in.exr -o out.ktx2 --size
expect 2 "from 1 to 16" bake in.exr -o out.ktx2 --levels 17
expect 2 "levels is 5, a map of size 8 has 4 levels" bake in.exr -o out.ktx2 --size 8 --levels 5
expect 2 "from 1 to 22" bake in.exr -o out.ktx2 --zstd=23
expect 2 "from 1 to 5" bake in.exr -o out.ktx2 --sh-bands 6
expect 2 "from 1 to 256" bake in.exr -o out.ktx2 --threads 0
expect 2 "must be from -64 to 64" bake in.exr -o out.ktx2 --exposure 65
expect 2 "must be from -64 to 64" bake in.exr -o out.ktx2 --exposure nan
expect 2 "must be a number" bake in.exr -o out.ktx2 --rotate left
expect 2 "must be a number" bake in.exr -o out.ktx2 --rotate 1,2,3,4
expect 2 "number 2 is 3601, it must be from -3600 to 3600" bake in.exr -o out.ktx2 --rotate 0,3601
expect 2 "up is 'x', it must be" bake in.exr -o out.ktx2 --up x
expect 2 "turns about the vertical axis only" bake in.exr -o out.ktx2 --method textbook --rotate 0,1
expect 2 "number 2 is 1.5" bake in.exr -o out.ktx2 --roughness 0,1.5
expect 2 "commas" bake in.exr -o out.ktx2 --roughness 0,,1
expect 2 "commas" bake in.exr -o out.ktx2 --roughness 0,1,
expect 2 "commas" bake in.exr -o out.ktx2 --roughness ''
expect 2 "more than 16" bake in.exr -o out.ktx2 --roughness 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0
for option in lobe shape method format layout; do
    expect 2 "$option is 'frob', it must be .* or " bake in.exr -o out.ktx2 --$option frob
done

# What does not go together.
expect 2 "given twice" bake in.exr -o out.ktx2 --size 8 --size 8
expect 2 "contradict" bake in.exr -o out.ktx2 --quiet --verbose
expect 2 "contradict" bake in.exr -o out.ktx2 --json --verbose
expect 2 "contradict" bake in.exr -o out.ktx2 --sh a.json --sh-radiance --sh-irradiance
expect 2 "2 numbers, but --levels is 3" bake in.exr -o out.ktx2 --roughness 0,1 --levels 3
expect 2 "needs --sh" bake in.exr -o out.ktx2 --sh-window 4
expect 2 "needs --sh" bake in.exr -o out.ktx2 --sh-irradiance
expect 2 "needs --sh" bake in.exr -o out.dds --sh-bands 4
expect 2 "needs --irradiance" bake in.exr -o out.ktx2 --irradiance-size 8
expect 2 "for --method textbook" bake in.exr -o out.ktx2 --samples 8
expect 2 "for --method textbook" bake in.exr -o out.ktx2 --phi-steps 8
expect 2 "not charlie" bake in.exr -o out.ktx2 --method textbook --lobe charlie
expect 2 "leave --roughness out" bake in.exr -o out.ktx2 --method textbook --roughness 0,1
expect 2 "for --lobe ggx" bake in.exr -o out.ktx2 --method textbook --lobe lambert --samples 8
expect 2 "are for irradiance" bake in.exr -o out.ktx2 --method textbook --phi-steps 8
expect 2 "levels is 3, it must be 1 for --lobe lambert" bake in.exr -o out.ktx2 --lobe lambert --levels 3
expect 2 "files hold cubes only, save a" bake in.exr -o out.ktx2 --shape panorama
expect 2 "files hold cubes only, save a" bake in.exr -o out.dds --shape octahedron
expect 2 "files hold cubes only, save a" bake in.exr -o out.exr --shape panorama --irradiance diffuse.ktx2
expect 2 "can be written to .ktx2 and .dds only" bake in.exr -o out.exr --format rgb9e5
expect 2 "rgbm can be written to .png only" bake in.exr -o out.exr --format rgbm
expect 2 "rgbp can be written to .png only" bake in.exr -o out.ktx2 --format rgbp
expect 2 "bc6h can be written to .ktx2 and .dds only" bake in.exr -o out.png --format bc6h
expect 2 "one format only" bake in.exr -o out.hdr --format rgba16f
expect 2 "format rgba32f can be written to .ktx2 .dds and .exr only" bake in.exr -o out.png --format rgba32f
expect 2 "files hold cubes only, save a" bake in.exr -o OUT.KTX2 --shape panorama
expect 2 "zstd is for .ktx2" bake in.exr -o out.dds --zstd
expect 2 "leave it out for six faces" bake 1 2 3 4 5 6 -o out.ktx2 --layout cross

expect 2 "no output" sky
expect 2 "takes no input" sky in.exr -o out.exr
expect 2 "must end in .exr or .hdr" sky -o out.png
expect 2 "from -5 to 90" sky -o out.exr --elevation 91
expect 2 "from 1.7 to 10" sky -o out.exr --turbidity 1
expect 2 "from 0 to 1" sky -o out.exr --albedo 2
expect 2 "from 16 to 8192" sky -o out.exr --size 8
expect 2 "no output" tables
expect 2 "it must be textbook" tables -o out.exr --method exact
expect 2 "must end in" tables -o out.ktx2 --method textbook
expect 2 "from 2 to 4096" tables -o out.exr --method textbook --size 1
expect 2 "size is '3x+5'" tables -o out.exr --size 3x+5
expect 2 "name another file" tables -o out.exr --average out.exr
expect 2 "name another file" tables -o out.ktx2 --average out_lookup.h --lookup
expect 2 "name is '1x', it must be letters" tables -o out.h --name 1x
expect 2 "name is 'a__b'" fit e -o out.glsl --name a__b
expect 2 "name is 'int'" tables -o out.h --name int
expect 2 "name is 'vec3'" fit e -o e.glsl --name vec3
expect 2 "no input" info
expect 2 "no quantity is named, name e, eavg" eval
expect 2 "frob: no such quantity, it must be e, .* or turquin" eval frob
expect 2 "one quantity at a time" eval e a --mu 1
expect 2 "from 0 to 1" eval e --roughness 1.5 --mu 1
expect 2 "from 0 to 1" eval e --roughness nan --mu 1
expect 2 "must be a number" eval e --roughness rough --mu 1
expect 2 "from 0 to 1e+08" eval dielectric --ior -1 --voh 1
expect 2 "eavg does not depend on --mu" eval eavg --roughness 1 --mu 1
expect 2 "d is 'frob', it must be ggx or beckmann" eval e --d frob
expect 2 "g is 'frob', it must be smith, .* or schlick-text" eval e --g frob
expect 2 "sheen is 'frob'" eval sheen --sheen frob
expect 2 "no quantity is named, name e, eavg" fit -o e.h
expect 2 "no such quantity, it must be e, eavg, dfg or sheen" fit a -o e.h
expect 2 "one quantity at a time" fit e eavg -o e.h
expect 2 "no output" fit e
expect 2 "must end in .h or .glsl" fit e -o e.c
expect 2 "error is 1e-7, it must be from 1e-06 to 0.5" fit e -o e.h --error 1e-7
expect 2 "from 0 to 0.9" fit e -o e.h --roughness-min 1
expect 2 "from 1 to 160" fit e -o e.h --max-coefficients 161
expect 2 "form is 'frob', it must be auto, polynomial or rational" fit e -o e.h --form frob
expect 2 "name is '2e', it must be letters" fit e -o e.h --name 2e
expect 2 "name is 'e;', it must be letters" fit e -o e.h --name 'e;'
expect 2 "a model of its own" fit sheen -o e.h --g smith

case $commands in
*render*)
    expect 2 "no output" render
    expect 2 "must end in .png, .exr or .hdr" render -o out.jpg
    expect 2 "2 inputs" render a.exr b.exr -o out.png
    expect 2 "WIDTHxHEIGHT" render -o out.png --size 640
    expect 2 "from 1 to 16384" render -o out.png --size 0x10
    expect 2 "from 1 to 8" render -o out.png --samples 9
    expect 2 "has no environment" render a.exr -o out.png --scene furnace
    expect 2 "for --scene assignment" render -o out.png --scene ibl --as-printed
    expect 2 "for --scene compare" render -o out.png --split 0.5
    expect 2 "needs --debug level" render -o out.png --level 1
    expect 2 "has its own" render -o out.png --material gold
    expect 2 "2 inputs" view a.exr b.exr
    expect 2 "for --scene compare" view --split 0.5
    expect 1 "there is no folder nowhere" view --screenshot nowhere/out.png
    expect 2 "must end in .png" view --screenshot out.exr
    expect 2 "contradict" render -o out.png --reference --error
    expect 2 "needs --reference or --error" render -o out.png --noise 0.1
    expect 2 "\-\-walk needs" render -o out.png --walk
    expect 2 "light comes from one direction" render -o out.png --walk --reference
    expect 2 "from 0.0001 to 1" render -o out.png --reference --noise 0
    expect 2 "leave --reference and --error out" render -o out.png --reference --debug e
    expect 2 "cannot hold negative errors" render -o out.hdr --error
    expect 1 "there is no folder nowhere" render -o nowhere/out.png
    for option in scene method material debug diffuse; do
        expect 2 "$option is 'frob', it must be .* or " render -o out.png --$option frob
    done
    ;;
esac

[ -z "$(find . -type f -not -path './log/*')" ] || die "something was written"
passed
