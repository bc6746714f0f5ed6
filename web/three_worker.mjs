// The worker in which three.js draws (three_view.mjs). In: a canvas, a panorama and kiln's file for
// three.js, views. A direction (x, y, z) of kiln is (-z, y, x) in three.js.
import * as THREE from './three/three.module.js';
import { loadEnvironment } from './three/loader.mjs';

const toThree = ([x, y, z]) => new THREE.Vector3(-z, y, x);
let renderer, maps;

// The panorama as three.js' HDRLoader hands it over: halves, with the top row first and flipped.
function texture({ width, height, texels }) {
    const halves = new Uint16Array(4 * width * height);
    for (let i = 0; i < width * height; i++) {
        for (let c = 0; c < 3; c++)
            halves[4 * i + c] = THREE.DataUtils.toHalfFloat(Math.min(texels[3 * i + c], 65504));
        halves[4 * i + 3] = 0x3c00;
    }
    const made = new THREE.DataTexture(halves, width, height, THREE.RGBAFormat, THREE.HalfFloatType);
    Object.assign(made, { mapping: THREE.EquirectangularReflectionMapping, flipY: true, needsUpdate: true,
                          colorSpace: THREE.LinearSRGBColorSpace, minFilter: THREE.LinearFilter,
                          magFilter: THREE.LinearFilter, generateMipmaps: false });
    return made;
}

function makeBall([x, y, z, radius, roughness, metalness, , r, g, b]) {
    const material = new THREE.MeshStandardMaterial({ roughness, metalness, envMap: y > 0 ? maps.kiln : maps.own });
    material.color.setRGB(r, g, b, THREE.LinearSRGBColorSpace);
    const ball = new THREE.Mesh(new THREE.SphereGeometry(radius, 64, 48), material);
    ball.position.copy(toThree([x, y, z]));
    return ball;
}

function makeScene({ balls, rotation, background }) {
    const scene = new THREE.Scene(), turn = -rotation * Math.PI / 180;
    scene.background = maps.kiln;
    scene.backgroundBlurriness = background;
    scene.backgroundRotation.set(0, turn, 0);
    for (const ball of balls.map(makeBall)) {
        ball.material.envMapRotation.set(0, turn, 0);
        scene.add(ball);
    }
    return scene;
}

// The scene that was drawn last. It is used again while only the camera moves, because making a scene takes longer
// than drawing one.
let kept = { key: '', scene: new THREE.Scene() };
function sceneOf({ balls, rotation, background }) {
    const key = JSON.stringify([balls, rotation, background, maps.kiln.id]);
    if (key !== kept.key) {
        const before = kept.scene;
        kept = { key, scene: makeScene({ balls, rotation, background }) };
        before.children.forEach(({ geometry, material }) => [geometry, material].forEach((thing) => thing.dispose()));
    }
    return kept.scene;
}

function makeCamera({ fov, aspect, azimuth, elevation, distance, targetX, targetY, targetZ }) {
    const [a, e] = [azimuth, elevation].map((degrees) => degrees * Math.PI / 180);
    const target = toThree([targetX, targetY, targetZ]);
    const camera = new THREE.PerspectiveCamera(fov, aspect, distance / 100, 10 * distance);
    camera.position.copy(target).addScaledVector(
        toThree([Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)]), distance);
    camera.lookAt(target);
    return camera;
}

const WORK = {
    start(canvas) {
        renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        renderer.toneMapping = THREE.NeutralToneMapping;
    },
    async light(panorama, bytes) {
        const filter = new THREE.PMREMGenerator(renderer), source = texture(panorama), gl = renderer.getContext();
        maps?.target.dispose();
        maps?.kiln.dispose();
        const began = performance.now(), target = filter.fromEquirectangular(source);
        gl.finish();
        const milliseconds = performance.now() - began;
        source.dispose();
        filter.dispose();
        maps = { target, own: target.texture, kiln: await loadEnvironment(bytes, renderer) };
        return { milliseconds };
    },
    // Draws with a part of the picture's pixels, and waits until the picture is there.
    async draw(view, width, height, scale) {
        const scene = sceneOf(view), gl = renderer.getContext();
        renderer.setSize(Math.ceil(scale * width), Math.ceil(scale * height), false);
        renderer.toneMappingExposure = 2 ** view.exposure;
        renderer.render(scene, makeCamera(view));
        const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        while (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost())
            await new Promise((wake) => { setTimeout(wake, 4); });
        gl.deleteSync(fence);
    },
};

onmessage = async ({ data: { id, work, values } }) => {
    try {
        postMessage({ id, result: await WORK[work](...values) });
    } catch (error) {
        postMessage({ id, error: error.message });
    }
};
