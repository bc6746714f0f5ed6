#!/bin/sh
# The sun and other lights: kiln lights, and what kiln bake does with --sun, --clamp and --lights.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 128 --elevation 30 --azimuth 90 --quiet
expect 0 "" sky -o dusk.exr --size 64 --elevation -2 --quiet

# The sun stands at the right, 30 degrees high, and holds some 44 % of the light.
expect 0 "" lights sky.exr
grep -q '^sky.exr: 1 compact light with 4[34][.][0-9]* % of the light$' log/out || die "the sun"
expect 0 "" lights dusk.exr
grep -q '^dusk.exr: 0 compact lights with 0.00 % of the light$' log/out || die "dusk"
expect 0 "" lights sky.exr --json -o sun.json
cp log/out sun-printed.json
node -e '
    const fs = require("fs");
    const printed = JSON.parse(fs.readFileSync("sun-printed.json")), saved = JSON.parse(fs.readFileSync("sun.json"));
    const near = (a, b, bound) => Math.abs(a - b) <= bound;
    const [sun] = printed.lights, [same] = saved.lights, half = Math.PI / 128 / 2;
    const wanted = [Math.cos(Math.PI / 6), 0.5, 0];
    const good = printed.lights.length === 1 && saved.lights.length === 1 &&
        sun.direction.every((x, i) => near(x, wanted[i], half) && near(x, same.direction[i], 1e-8)) &&
        sun.irradiance.every((x, i) => x > 40 && near(x / same.irradiance[i], 1, 1e-8)) &&
        sun.angular_radius > 0.2 && sun.angular_radius < 1.5 && near(sun.share, 0.438, 0.01) &&
        sun.texels === same.texels && sun.texels > 0;
    process.exit(good ? 0 : 1);' || die "the values of the sun"

# kiln info lists the same lights, where it is asked to.
expect 0 "" info --lights --json sky.exr dusk.exr
node -e '
    const fs = require("fs"), [sky, dusk] = JSON.parse(fs.readFileSync("log/out"));
    const same = JSON.stringify(sky.lights) === JSON.stringify(JSON.parse(fs.readFileSync("sun-printed.json")).lights);
    process.exit(same && dusk.lights.length === 0 ? 0 : 1);' || die "the lights of kiln info"
expect 0 "" info --lights dusk.exr
grep -q '^  lights       none that are compact$' log/out || die "no lights"
expect 0 "" info sky.exr
! grep -q light log/out || die "lights that nobody asked for"

# A bake without its sun: the note, the file, the report; and what remains is dimmer by the share.
small="--size 16 --exposure -8"
# shellcheck disable=SC2086 # $small is several words
{
    expect 0 "sky.exr: 1 light with 43.8 % of the light was taken out and written to out.json" \
        bake sky.exr -o out.ktx2 $small --sun extract --lights-file out.json --sh out-sh.json --json
    cp log/out report.json
    expect 0 "" bake sky.exr -o all.ktx2 $small --sh all-sh.json --rotate 90
    node -e '
        const fs = require("fs"), read = name => JSON.parse(fs.readFileSync(name));
        const report = read("report.json"), [sun] = read("out.json").lights, [before] = read("sun.json").lights;
        const rest = read("out-sh.json").coefficients[0], whole = read("all-sh.json").coefficients[0];
        const sum = c => c[0] + c[1] + c[2];
        const good = report.lights.length === 1 && report.output.lights === "out.json" &&
            report.output.file_count === 3 && Math.abs(report.lights[0].share - sun.share) < 1e-8 &&
            sun.irradiance.every((x, i) => Math.abs(x * 256 / before.irradiance[i] - 1) < 1e-6) &&
            Math.abs(sum(rest) / sum(whole) - (1 - sun.share)) < 1e-4;
        process.exit(good ? 0 : 1);' || die "the bake without its sun"
    # The content of a panorama moves to the left: the sun comes from the right to the centre.
    expect 0 "taken out" bake sky.exr -o out.ktx2 $small --sun extract --lights-file out.json --rotate 90
    node -e '
        const [sun] = JSON.parse(require("fs").readFileSync("out.json")).lights;
        process.exit(Math.abs(sun.direction[0]) < 0.02 && sun.direction[2] < -0.8 ? 0 : 1);' || die "the turned sun"
    expect 0 "dusk.exr: no compact light was found, and nothing was taken out" bake dusk.exr -o out.ktx2 $small --sun extract
    expect 0 "" bake sky.exr -o out.ktx2 $small --sun extract -q

    # A .glb holds the sun as a directional light: its node's +Z points to the sun, and colour times intensity
    # is the irradiance.
    for turn in 0 90 200; do
        expect 0 "taken out" bake sky.exr --for gltf --size 32 --exposure -8 -o sun.glb --sun extract --rotate $turn \
            --lights-file out.json
        node -e '
            const fs = require("fs"), file = fs.readFileSync("sun.glb");
            const gltf = JSON.parse(file.toString("utf8", 20, 20 + file.readUInt32LE(12)));
            const [sun] = JSON.parse(fs.readFileSync("out.json")).lights;
            const [light] = gltf.extensions.KHR_lights_punctual.lights, [node] = gltf.nodes;
            const [x, y, z, w] = node.rotation;
            const axis = [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)];
            const near = (a, b) => Math.abs(a - b) < 1e-6;
            const good = axis.every((a, i) => near(a, sun.direction[i])) && light.type === "directional" &&
                light.color.every((c, i) => c <= 1 && near(c * light.intensity, sun.irradiance[i])) &&
                gltf.extensionsUsed.includes("KHR_lights_punctual") && node.extensions.KHR_lights_punctual.light === 0 &&
                gltf.scenes[0].nodes.length === 1 && gltf.scenes[0].nodes[0] === 0 &&
                gltf.scenes[0].extensions.EXT_lights_image_based.light === 0;
            process.exit(good ? 0 : 1);' || die "the sun of a .glb, turned by $turn degrees"
    done
    expect 0 "" info sun.glb
    expect 0 "" bake sky.exr --for gltf --size 32 --exposure -8 -o sun.glb
    ! grep -q -a KHR_lights sun.glb || die "a .glb has a light that was not taken out"
    rm sun.glb

    expect 0 "sky.exr: [0-9]* texels above 0.1 were made as dark as this, which lost 44[0-9.]* % of the light" \
        bake sky.exr -o a.ktx2 $small --sun clamp=0.1
    expect 0 "above 0.1 were" bake sky.exr -o b.ktx2 $small --clamp 0.1 --json
    same a.ktx2 b.ktx2
    node -e '
        const { clamp } = JSON.parse(require("fs").readFileSync("log/out"));
        process.exit(clamp.limit === 0.1 && clamp.texels > 0 && clamp.light_share > 0.4 ? 0 : 1);' || die "the clamp"
    expect 0 "which lost 4[0-9.]* % of the light" bake sky.exr -o a.ktx2 $small --clamp auto
    expect 0 "which lost 4[0-9.]* % of the light" bake sky.exr -o b.ktx2 $small --sun clamp=auto
    same a.ktx2 b.ktx2
    expect 0 "taken out" bake sky.exr -o level.exr --size 8 --levels 1 --shape panorama --sun extract --method textbook --samples 4
    rm out.ktx2 a.ktx2 b.ktx2 all.ktx2

    expect 2 "sun is 'off', it must be keep, extract, clamp=RADIANCE or clamp=auto" bake sky.exr -o a.ktx2 --sun off
    expect 2 "sun clamp= is '-3', it must be auto or a radiance above 0" bake sky.exr -o a.ktx2 --sun clamp=-3
    expect 2 "clamp is 'much', it must be auto or a radiance above 0" bake sky.exr -o a.ktx2 --clamp much
    expect 2 "--clamp and --sun contradict each other" bake sky.exr -o a.ktx2 --clamp 3 --sun extract
    expect 2 "lights needs --sun extract" bake sky.exr -o a.ktx2 --lights 3
    expect 2 "lights-share needs --sun extract" bake sky.exr -o a.ktx2 --lights-share 0.1 --clamp 2
    expect 2 "lights-file needs --sun extract" bake sky.exr -o a.ktx2 --lights-file a.json
    expect 2 "lights-file sun.txt: must end in .json" bake sky.exr -o a.ktx2 --sun extract --lights-file sun.txt
    expect 2 "sh and --lights-file are the same file" bake sky.exr -o a.ktx2 --sun extract --lights-file a.json --sh a.json
    expect 1 "there is no folder none" bake sky.exr -o a.ktx2 --sun extract --lights-file none/a.json
    expect 2 "lights is 65, it must be from 1 to 64" lights sky.exr --lights 65
    expect 2 "output sun.txt: must end in .json" lights sky.exr -o sun.txt
    expect 2 "no input is named" lights
}
only sky.exr dusk.exr sun.json sun-printed.json out.json report.json out-sh.json all-sh.json level.exr
passed
