// kiln-ibl/three shows the right pixels in versions of three.js from the oldest to the newest, and refuses the file
// of the other layout by an error. With a built package, bakeEnvironment() shows the pixels of the command's file.
import fs from 'node:fs';
import path from 'node:path';
import { three, threeCubeUv, threeCubeUvApproximate } from './models.mjs';
import { CELL, ROUGHNESS, builtPackage, check, dot, folder, kiln, makeFiles, makeViews, panorama, prove, readFile }
    from './rig.mjs';

const cubes = { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 }, real: { rms: 1e-3, most: 5e-3 } };
// The default format is rgb9e5, whose texels err by 2^-9 of their largest channel at most. `cubes` is for halves.
const byDefault = { ...cubes, real: { rms: 1e-3, most: 0.02 } };
// models.mjs, which says what the engine should draw, takes faces as continuous. In CubeUV layout faces have only 14
// texels along an edge from roughness 0.21 on, and their interpolation makes the difference that `real` allows.
const pictures = { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
                   real: [{ rows: [0.45, 1], rms: 5e-3, most: 0.02 }, { rows: [0.1, 0.1], rms: 0.015, most: 0.1 },
                          { rms: 0.05 }] };
// Where the reflection is bent by r^2, some of the directions at r = 0.1 lie at the border of a lamp.
const older = { ...pictures, real: [pictures.real[0], { rows: [0.1, 0.1], rms: 0.025, most: 0.25 }, { rms: 0.05 }] };

const views = makeViews();
async function checkRefusal(file, pattern, draw, say) {
    const sentence = await draw(file, views, ROUGHNESS, CELL, { refused: true });
    say(`refuses ${file}: ${sentence}`);
    check(pattern.test(sentence), `${file} is not refused by the right sentence: ${sentence}`);
}

// The highlight of a material with roughness 1, F0 = 0 and F90 = 1, divided by the light's irradiance: n.l D V F, where
// D = 1 / pi, V = 1 / (2 (n.l + n.v)) and F is the approximation of (1 - v.h)^5 in three.js.
function highlight(nol, nov, vol) {
    const voh = Math.sqrt((1 + vol) / 2);
    return nol / (2 * Math.PI * (nol + nov)) * 2 ** ((-5.55473 * voh - 6.98316) * voh);
}

// A light adds irradiance * max(0, n . l) / pi to white diffuse patches, whatever a version means by an intensity.
// WebGPURenderer of r186 also adds the highlight of F90 = 1, although the patches' specularIntensity is 0.
const LIGHT = { direction: [0.36, 0.48, 0.8], irradiance: [3, 2, 1] };
async function checkLight({ name, ending, model }, version, draw, say) {
    const { toKiln } = model(6, 64), show = (lights) => draw(`${name}-white${ending}`, views, [1], CELL,
                                                             { diffuse: true, lights });
    const [dark, lit] = [await show([]), await show([LIGHT])], towards = (n) => dot(toKiln(n), LIGHT.direction);
    const off = views.flatMap(({ toEye, normals }, side) => normals.flatMap((n, i) => {
        const nol = Math.max(0, towards(n));
        const more = version === 'three-r186,webgpu' ? highlight(nol, dot(n, toEye), towards(toEye)) : 0;
        return LIGHT.irradiance.map((e, c) =>
            Math.abs(lit[side][0][i][c] - dark[side][0][i][c] - e * (nol / Math.PI + more)));
    }));
    const most = Math.max(...off);
    say(`light: off by ${most.toExponential(1)} of 0.95 at most`);
    check(most < 1e-5, `the light is off by ${most}`);
}

// The panorama where pages find it; it is copied once, since a page may be reading it.
function servePanorama() {
    const place = path.join(folder, 'picture.exr');
    if (!fs.existsSync(place))
        fs.copyFileSync(panorama, place);
}

// What the package bakes of an address has the native command's bytes, so that pixels are equal. EXRLoader rounds the
// panorama's floats to halves, which are off by up to 4.9e-4.
const BAKES = { 'three-r150': ['address', 'texture'], 'three-r170': ['address'], 'three-r186': ['texture'],
                'three': ['address', 'texture'], 'three,webgpu': ['address'] };
async function checkBakes(version, { name, ending }, draw, say) {
    if (!builtPackage || !BAKES[version])
        return;
    const show = async (file, asked) => (await draw(file, views, ROUGHNESS, CELL, asked)).flat(3);
    await kiln('bake', panorama, '--for', name, '-q', '-o', `${name}-native${ending}`);
    servePanorama();
    const native = await show(`${name}-native${ending}`);
    for (const bake of BAKES[version]) {
        const pixels = await show('picture.exr', { bake });
        const off = Math.max(...pixels.map((x, i) => Math.abs(x - native[i]) / native[i]));
        say(`baked of ${bake === 'address' ? 'an address' : 'a texture'}: off by ${off.toExponential(1)} at most`);
        check(bake === 'address' ? off === 0 : off < 2e-3,
              `${version}: bakeEnvironment() of the ${bake} shows other pixels, by ${off}`);
    }
}

// The same texels in other containers show the same pixels: a cube whose KTX2 file is compressed by zstd, and a CubeUV
// picture in KTX2, which KTX2Loader reads.
async function checkContainers(version, { name, ending }, { files }, draw, say) {
    const show = async (file, asked) => (await draw(file, views, ROUGHNESS, CELL, asked)).flat(3);
    const [first, second] = name === 'three'
        ? [await show('unzipped.ktx2'), await show('zipped.ktx2')]
        : [await show(`${files}-real${ending}`), await show(`${files}-real${ending}`, { header: 'flat.ktx2' })];
    const off = first.filter((x, i) => x !== second[i]).length;
    say(`${first.length - off} values of ${first.length} are equal in ${name === 'three' ? 'zstd' : 'KTX2'}`);
    check(off === 0, `${off} values are others in another container`);
    await (name === 'three' ? checkCube : checkFlat)(version, first, draw, say);
}

// A file of UASTC HDR, which has 8 bits a texel, shows nearly what the file of halves shows.
async function checkCompressed(file, halves, bound, draw, say) {
    const pixels = (await draw(file, views, ROUGHNESS, CELL, { transcode: true })).flat(3);
    const root = (values) => Math.sqrt(values.reduce((sum, x) => sum + x * x, 0));
    const off = root(pixels.map((x, i) => x - halves[i])) / root(halves);
    say(`UASTC HDR: off by ${(100 * off).toFixed(2)} % rms`);
    check(off > 0 && off < bound, `${file} of UASTC HDR is off by ${off}`);
    await checkRefusal(file, /its texels have the VkFormat 1000066000, which KTX2Loader reads; pass/, draw, say);
    return pixels;
}

// For WebGPURenderer a cube must be mirrored, which compressed texels do not allow.
async function checkCube(version, halves, draw, say) {
    return version.endsWith('webgpu')
        ? checkRefusal('uastc.ktx2', /for WebGPURenderer the cube must be mirrored, which its VkFormat 1000066000/,
                       draw, say)
        : checkCompressed('uastc.ktx2', halves, 0.02, draw, say);
}

// The picture of the command, by the package and by KTX2Loader alone. Faces of 14 texels have steeper colours in a
// block of 4 x 4 texels than the faces of a cube have.
async function checkFlat(version, halves, draw, say) {
    if (Number(version.match(/r(\d+)/)[1]) < 170)
        return checkRefusal('flat-uastc.ktx2', /KTX2Loader reads UASTC HDR from r170 on, and this is r1[56]\d; bake an/,
                            draw, say);
    const pixels = await checkCompressed('flat-uastc.ktx2', halves, 0.05, draw, say);
    const alone = (await draw('flat-uastc.ktx2', views, ROUGHNESS, CELL, { transcode: 'alone' })).flat(3);
    const off = alone.filter((x, i) => x !== pixels[i]).length;
    say(`KTX2Loader alone: ${alone.length - off} values of ${alone.length} are equal`);
    return check(off === 0, `${version}: KTX2Loader alone shows ${off} other values`);
}
async function makeContainers() {
    await kiln('bake', panorama, '-q', '-o', 'faces.ktx2', '--size', 8, '--levels', 1);
    const flat = readFile('faces.ktx2');
    flat.writeUInt32LE(1, 36); // the number of faces
    fs.writeFileSync(path.join(folder, 'flat.ktx2'), flat);
    const roughness = Array.from({ length: 6 }, (_, k) => 1 - Math.sqrt(1 - k / 5)).join();
    const words = ['-q', '--size', 256, '--levels', 6, '--roughness', roughness];
    await kiln('bake', panorama, '-o', 'unzipped.ktx2', ...words);
    await kiln('bake', panorama, '-o', 'zipped.ktx2', '--zstd', ...words);
    await kiln('bake', panorama, '-o', 'uastc.ktx2', '--zstd', '--format', 'uastc', ...words);
    await kiln('bake', panorama, '-o', 'flat-uastc.ktx2', '-q', '--for', 'three-cubeuv', '--format', 'uastc',
               '--tune=none');
}

const proofOf = (version, engine, bounds) => ({
    ...engine, bounds, title: version, page: `three-version.html?${version}`,
    prepare: async (proof) => {
        const [files] = await Promise.all([makeFiles(proof), makeFiles({ ...three, bounds: {} }),
                                           makeFiles({ ...threeCubeUv, bounds: {} }), makeContainers()]);
        return engine.name !== 'three' ? files
            : { ...files, halves: await makeFiles({ ...three, format: ['rgba16f', 1], bounds: cubes }) };
    },
    check: async (files, draw, say) => {
        await prove({ ...engine, bounds }, files, draw, say);
        if (files.halves)
            await prove({ ...engine, bounds: cubes }, files.halves, draw, (line) => say(`in rgba16f: ${line}`));
        const [other, pattern] = engine.name === 'three'
            ? ['three-cubeuv-real.exr', /up to r186, and this is r187; bake the panorama with --for three, or/]
            : ['three-real.ktx2', /from r187 on, and this is r1[5-8]\d; bake the file with --for three-cubeuv$/];
        await checkRefusal(other, pattern, draw, say);
        if (!version.endsWith('webgpu') || engine.name === 'three')
            await checkContainers(version, engine, files, draw, say);
        await checkBakes(version, engine, draw, say);
        await checkLight(engine, version, draw, say);
    },
});

// Files that are refused by r187, and by r150 where its reason is another. The cube of `kiln bake` without an engine
// has equal steps of roughness.
const REFUSED = {
    'plain.ktx2': [/the levels have the roughnesses 0 0.2 0.4 0.6 0.8 1, which are not those of three.js/,
                   /three.js shows cubes like this from r187 on/],
    'flat.ktx2': [/holds a flat picture and not a cube; bake it with --for three/,
                  /a picture of 8 x 8 is not an environment in CubeUV layout/],
    'flat.hdr': /is of the kind "HDR", and not an environment.*bakeEnvironment\(\) bakes panoramas/,
    'short.ktx2': /short.ktx2: the KTX2 file ends after 1000 bytes, before its texels end/,
    'page.ktx2': /the server answers with a web page, as if the file were missing/,
    'picture.exr': [/shows EXR environments up to r186/,
                    /a picture of 1024 x 512 is not an environment in CubeUV layout.*or call bakeEnvironment\(\)/],
};
async function makeRefused() {
    await makeContainers();
    const put = (name, bytes) => fs.writeFileSync(path.join(folder, name), bytes);
    await kiln('bake', panorama, '-q', '-o', 'plain.ktx2', '--size', 32, '--levels', 6);
    await kiln('bake', panorama, '-q', '-o', 'flat.hdr', '--size', 16, '--levels', 1, '--shape', 'panorama');
    put('short.ktx2', readFile('plain.ktx2').subarray(0, 1000));
    put('page.ktx2', '<!doctype html><title>Not here</title>');
    servePanorama();
}
const refusing = (version) => ({
    name: 'three', title: `refused by ${version}`, page: `three-version.html?${version}`, prepare: makeRefused,
    check: async (_, draw, say) => {
        for (const [file, patterns] of Object.entries(REFUSED))
            await checkRefusal(file, [patterns].flat().at(version === 'three' ? 0 : -1), draw, say);
    },
});

// WebGPURenderer up to r185 would show the environment upside down.
const upsideDown = {
    ...threeCubeUv, bounds: {}, title: 'three-r170,webgpu', page: 'three-version.html?three-r170,webgpu',
    check: ({ files }, draw, say) =>
        checkRefusal(`${files}-real.exr`, /^kiln-ibl.three: WebGPURenderer of three.js r170 shows/, draw, say),
};

export default [
    ...['r150', 'r152', 'r162', 'r170', 'r180'].map((r) => proofOf(`three-${r}`, threeCubeUvApproximate, older)),
    ...['r181', 'r186', 'r186,webgpu'].map((r) => proofOf(`three-${r}`, threeCubeUv, pictures)),
    proofOf('three', three, byDefault),
    proofOf('three,webgpu', three, byDefault),
    upsideDown,
    refusing('three'),
    refusing('three-r150'),
];
