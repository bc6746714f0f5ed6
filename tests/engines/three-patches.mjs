// Patches of white metal in three.js, whichever version a page calls 'three'.
import * as THREE from 'three';

function patches(view, row, rows, material) {
    const positions = [], normals = [], columns = view.normals.length;
    view.normals.forEach((normal, i) => {
        const at = (x, y) => view.right.map((r, c) => (i + x - columns / 2) * r + (row + y - rows / 2) * view.up[c]);
        for (const [x, y] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) {
            positions.push(...at(x, y));
            normals.push(...normal);
        }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normals, 3));
    return new THREE.Mesh(geometry, material);
}

// WebGPURenderer where 'three' is the build that has it, with its backend of WebGL.
const gpu = 'WebGPURenderer' in THREE;
export const renderer = gpu ? new THREE.WebGPURenderer({ forceWebGL: true }) : new THREE.WebGLRenderer();
renderer.shadowMap.enabled = true;
if (gpu)
    await renderer.init();

// The floats of what is drawn, the lowest row first.
async function draw(scene, camera, width, height) {
    const target = new (gpu ? THREE.RenderTarget : THREE.WebGLRenderTarget)(width, height, { type: THREE.FloatType });
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    if (gpu) // of which the upper row comes first
        return renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
    const pixels = new Float32Array(4 * width * height);
    renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    return pixels;
}

// White metal, or, where a page is asked for it, white without any reflection: diffuse light alone. asked.physical: other
// properties of the latter.
const white = (roughness, asked) => (asked.diffuse || asked.physical
    ? new THREE.MeshPhysicalMaterial({ color: 0xffffff, metalness: 0, roughness, specularIntensity: 0, ...asked.physical })
    : new THREE.MeshStandardMaterial({ color: new THREE.Color(...asked.f0 ?? [1, 1, 1]), metalness: 1, roughness }));

// The ball that casts its shadow on the patches.
function makeBall({ centre, radius }) {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(radius, 64, 32), white(1, { diffuse: true }));
    ball.position.set(...centre);
    ball.castShadow = true;
    return ball;
}

// What three.js itself makes of a panorama.
export async function filterPanorama(file) {
    const { HDRLoader } = await import('three/addons/loaders/HDRLoader.js'); // RGBELoader up to r179
    const panorama = await new HDRLoader().setDataType(THREE.FloatType).loadAsync(file);
    panorama.mapping = THREE.EquirectangularReflectionMapping;
    return new THREE.PMREMGenerator(renderer).fromEquirectangular(panorama).texture;
}

// asked: diffuse or physical, of materials; turn, of the environment about y, from r162 on; f0, the colour of metal; ball, which casts a shadow. finish(scene) adds what else lights
// the scene, and changes materials.
export async function drawPatches(environment, views, roughness, cell, asked = {}, finish = () => {}) {
    const shown = [];
    for (const view of views) {
        const columns = view.normals.length, rows = roughness.length;
        const scene = new THREE.Scene();
        scene.environment = environment;
        roughness.forEach((r, row) => scene.add(patches(view, row, rows, white(r, asked))));
        scene.children.forEach((mesh) => { mesh.receiveShadow = true; });
        if (asked.ball)
            scene.add(makeBall(asked.ball));
        scene.environmentRotation?.set(0, asked.turn ?? 0, 0);
        await finish(scene);
        const camera = new THREE.OrthographicCamera(-columns / 2, columns / 2, rows / 2, -rows / 2, 1, 100);
        camera.position.fromArray(view.toEye).multiplyScalar(50);
        camera.up.fromArray(view.up);
        camera.lookAt(0, 0, 0);
        const pixels = await draw(scene, camera, columns * cell, rows * cell);
        shown.push(roughness.map((_, row) => view.normals.map((_, i) => {
            const at = 4 * ((row * cell + cell / 2) * columns * cell + i * cell + cell / 2);
            return [...pixels.slice(at, at + 3)];
        })));
    }
    return shown;
}
