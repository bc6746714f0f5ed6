#!/bin/sh
# kiln render, assignment and view: what is written, what a picture holds, what is said without a
# driver or a screen.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# The assignment, all of it.
expect 0 "" assignment -o images --size 320x180
for name in balls balls_microfacet balls_as_printed Emu_MC Emu_IS Eavg; do
    [ -s "images/$name.png" ] || die "no images/$name.png"
done
grep -q 'balls_as_printed.png' images/report.md || die "the report does not show the renders"
expect 2 "no output: name a folder" assignment
expect 2 "takes no input" assignment in.exr -o d
expect 2 "it must be WIDTHxHEIGHT" assignment -o d --size 4x
expect 2 "each side must be from 1 to 16384" assignment -o d --size 0x1
[ ! -e d ] || die "a folder for a wrong command line"
"$KILN" info images/balls.png | grep -q '320 x 180' || die "the size of the assignment's pictures"

# Every scene; the same bits twice.
expect 0 "" sky -o sky.exr --size 32
for scene in assignment ibl furnace grid compare; do
    env=sky.exr
    case $scene in assignment | furnace) env= ;; esac
    # shellcheck disable=SC2086 # none or one
    expect 0 "" render $env -o a.png --scene $scene --size 64x36 --samples 1 --bake-size 16 --exposure -4
    # shellcheck disable=SC2086
    expect 0 "" render $env -o b.png --scene $scene --size 64x36 --samples 1 --bake-size 16 --exposure -4
    same a.png b.png
done
expect 0 "" render -o a.exr --size 64x36
# 4294968576 is 1280 + 2^32.
for size in 4294968576x720 720x4294968576 2147483648x1 99999999999999999999x1 16385x1 0x1; do
    expect 2 "each side must be from 1 to 16384" render -o b.png --size $size
done
for size in x 4x x4 4x4x ' 4x4' +4x4 -4x4 4x0x4; do
    expect 2 "it must be WIDTHxHEIGHT" render -o b.png --size "$size"
done
"$KILN" info a.exr | grep -q '64 x 36' || die "the picture's size"

# A baked cube is used as it is.
expect 0 "" bake sky.exr -o sky.ktx2 --size 16 --levels 3
expect 0 "" render sky.ktx2 -o a.png --size 64x36 --samples 1
expect 1 "nowhere.exr" render nowhere.exr -o a.png

# The reference stops at its noise, and the error is told.
expect 0 "" render sky.exr -o a.exr --reference --size 32x18 --samples 1 --noise 0.3
grep -q 'integrated to a noise of' log/out || die "no noise is told"
expect 0 "" render -o a.png --error --size 32x18 --samples 1
grep -q 'error RMS' log/out || die "no error is told"
grep -Eq '0\.55 +1 +single( +[0-9.]+){6}$' log/out || die "not six figures for a ball"
# Figures without a picture, as JSON; the scene assignment needs no table of lobes.
expect 0 "" render --error --json --size 32x18 --samples 1
for way in straight bent one two three; do
    grep -A5 "\"$way\":.{" log/out | tr -d '\t\n' >log/way
    grep -Eq '"roughness":\[0.15, (0[.0-9]+, ){8}0.95\],.*"rms":\[([0-9.e-]+, ){9}[0-9.e-]+\],"all":[0-9.e-]+}' log/way ||
        die "no ten balls of $way: $(cat log/way)"
done
expect 2 "json needs --error" render --json -o a.png
expect 2 "no output" render
expect 2 "is now --reflections straight" render --straight -o a.png
expect 0 "" render -o a.png --reference --size 32x18

# The sun as a disc, and the ground: the lights are told, and what does not fit together is refused.
expect 0 "" sky -o clear.exr --size 256
expect 0 "" render clear.exr -o a.png --sun extract --ground --size 64x36 --samples 1 --bake-size 16
grep -q 'light 1 .*radius 0' log/out || die "the sun's disc is not told"
expect 0 "" render clear.exr -o b.png --ground --size 64x36 --samples 1 --bake-size 16
cmp -s a.png b.png && die "the disc changes nothing"
expect 0 "" render clear.exr -o a.png --sun extract --ground --reference --size 32x18 --samples 1 --noise 0.3
expect 2 "lights needs --sun extract" render clear.exr -o a.png --lights 2
expect 2 "lights-share needs --sun extract" render clear.exr -o a.png --lights-share 0.1
expect 2 "the scene assignment has no environment" render -o a.png --ground
expect 2 "the scene furnace has no environment" render -o a.png --scene furnace --sun extract
expect 1 "levels hold the lights" render sky.ktx2 -o a.png --sun extract

# No screen, with a folder for Wayland's socket and without.
unset DISPLAY WAYLAND_DISPLAY
XDG_RUNTIME_DIR=$PWD
export XDG_RUNTIME_DIR
expect 1 "GLFW" view
unset XDG_RUNTIME_DIR
expect 1 "GLFW" view
# No driver: the loader finds none in an empty folder.
mkdir none
__EGL_VENDOR_LIBRARY_DIRS="$PWD/none"
export __EGL_VENDOR_LIBRARY_DIRS
expect 1 "EGL offers no display" render -o c.png
[ ! -e c.png ] || die "a picture without a driver"
"$KILN" assignment -o shaded -q --size 64x36 2>log/err || die "the assignment without a driver"
grep -q 'shaded on the CPU' log/err && [ -s shaded/balls.png ] || die "no balls without a driver"
passed
