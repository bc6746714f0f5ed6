// glTF with EXT_lights_image_based: Khronos' validator finds no fault with it, the light has what its
// specification asks for, and Babylon.js' loader reads it. That loader takes the radiance, which it has
// decoded, for gamma-coded, and its level for log2(256 alpha) / 2, where the specification spaces
// roughness evenly; so both are in the model, the first one until a scene says that it is not so.
import validator from 'gltf-validator';
import { check, makeFiles, readFile } from './rig.mjs';

const slope = (r) => r * r + 0.0005;
const model = (count, size) => ({
    toKiln: (direction) => direction, // of Babylon's world
    lod: (r) => Math.min(count - 1, Math.log2(size * slope(r)) * (count - 1) / Math.log2(size)),
    shade: (nov, r) => [1 - slope(r), slope(r)],
    harmonics: true,
    distance: 20000,
});
const bounds = { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
                 real: { rms: 5e-3, most: 0.03 } };

async function validate({ files }, say) {
    const bytes = readFile(`${files}-real.glb`);
    const report = await validator.validateBytes(new Uint8Array(bytes));
    check(!report.issues.numErrors && !report.issues.numWarnings, JSON.stringify(report.issues.messages));
    // What it says beside: that it does not know the extension, so that nothing it knows uses an image.
    const said = new Set(report.issues.messages.map((message) => message.code));
    check([...said].sort().join() === 'UNSUPPORTED_EXTENSION,UNUSED_OBJECT', `it says ${[...said]}`);

    const gltf = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
    const light = gltf.extensions.EXT_lights_image_based.lights[gltf.scenes[gltf.scene].extensions.EXT_lights_image_based.light];
    check(light.irradianceCoefficients.length === 9 &&
          light.irradianceCoefficients.every((row) => row.length === 3 && row.every(Number.isFinite)),
          'irradianceCoefficients are not 9 x 3 numbers');
    check(light.specularImages.length > 1, 'there is one level');
    light.specularImages.forEach((faces, level) => faces.forEach((index) => {
        const { image } = report.info.resources.find(({ pointer }) => pointer === `/images/${index}`);
        const edge = light.specularImageSize >> level;
        check(faces.length === 6 && image.width === edge && image.height === edge && image.format === 'rgba' &&
              image.bits === 8, `image ${index} of level ${level} is ${JSON.stringify(image)}`);
    }));
    say(`valid: ${report.issues.numInfos} notes, all of the unknown extension`);
}

const gltf = { name: 'gltf', page: 'babylon.html', ending: '.glb', loads: '.glb', model, bounds, asked: { linear: true } };
export default [gltf, {
    ...gltf, title: 'gltf as loaded', asked: {}, bounds: { real: { rms: 1e-2, most: 0.06 } },
    model: (...size) => ({ ...model(...size), curve: (x) => x ** 2.2 }),
}, {
    ...gltf, title: 'gltf for its validator', prepare: () => makeFiles(gltf), check: (files, _, say) => validate(files, say),
}];
