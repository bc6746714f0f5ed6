// drei's <Environment>, which drei.mjs bundles into the page drei.html.
import { Environment } from '@react-three/drei';
import { Canvas, useThree } from '@react-three/fiber';
import { Suspense, useEffect } from 'react';
import { createRoot } from 'react-dom/client';
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

const SIZE = 256, DISTANCE = 4; // of the picture of a ball, and from the ball
const root = createRoot(document.getElementById('root'));

// Tells the state of @react-three/fiber, once what stands beside it in the same <Suspense> has loaded.
function Loaded({ tell }) {
    const state = useThree();
    useEffect(() => tell(state));
    return null;
}

// A ball of metal in the light of a panorama, and behind it the panorama.
const show = (file, roughness) => new Promise((done) => root.render(
    <Canvas key={file} frameloop="never" camera={{ position: [0, 0, DISTANCE], fov: 50 }}>
        <Suspense fallback={null}>
            <Environment files={file} background />
            <mesh>
                <sphereGeometry args={[1, 64, 32]} />
                <meshStandardMaterial metalness={1} roughness={roughness} />
            </mesh>
            <Loaded tell={done} />
        </Suspense>
    </Canvas>));

// Linear red, green, blue and alpha of a picture that `render` draws, the lowest row first.
function readPixels(gl, width, height, render) {
    const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
    const data = new Float32Array(4 * width * height);
    gl.setRenderTarget(target);
    render();
    gl.readRenderTargetPixels(target, 0, 0, width, height, data);
    gl.setRenderTarget(null);
    target.dispose();
    return { width, height, data };
}

// The texels of a texture, which a square of the size of the picture shows.
function readTexels(gl, texture) {
    const { width, height } = texture.image;
    const square = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
        uniforms: { map: { value: texture } },
        vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position, 1.0); }',
        fragmentShader: 'uniform sampler2D map; varying vec2 at; void main() { gl_FragColor = texture2D(map, at); }',
    }));
    square.frustumCulled = false;
    return readPixels(gl, width, height, () => gl.render(square, new THREE.Camera()));
}

// How far two pictures are from each other where inside(x, y) is true: RMS and, of values of at least a hundredth of the
// mean, the largest relative difference.
function compare(a, b, inside = () => true) {
    if (a.width !== b.width || a.height !== b.height)
        throw new Error(`${a.width} x ${a.height} is not ${b.width} x ${b.height}`);
    const pairs = [...b.data.entries()].filter(([i]) => i % 4 < 3 && inside((i >> 2) % b.width, Math.floor((i >> 2) / b.width)))
        .map(([i, wanted]) => [a.data[i], wanted]);
    const sum = (f) => pairs.reduce((total, pair) => total + f(pair), 0);
    const least = sum(([, wanted]) => wanted) / pairs.length / 100;
    return { count: pairs.length, rms: Math.sqrt(sum(([x, wanted]) => (x - wanted) ** 2) / sum(([, wanted]) => wanted ** 2)),
             most: pairs.reduce((most, [x, wanted]) => (wanted > least ? Math.max(most, Math.abs(x - wanted) / wanted) : most), 0) };
}

// Whether a pixel of a picture of a ball shows the ball, or the sky: not those at the ball's edge.
const edge = SIZE / 2 / Math.tan(25 * Math.PI / 180) / Math.sqrt(DISTANCE ** 2 - 1);
const radius = (x, y) => Math.hypot(x + 0.5 - SIZE / 2, y + 0.5 - SIZE / 2);
const onBall = (x, y) => radius(x, y) < edge - 2, inSky = (x, y) => radius(x, y) > edge + 2;

// Compares the panorama that <Environment> loads with the texels of the EXR file asked.with, or else pictures in its light
// with pictures in the light of asked.like: those of a ball of each roughness, then that of the sky.
export async function draw(file, views, roughness, cell, asked) {
    if (asked.with) {
        const { gl, scene } = await show(file, 1);
        const { image } = await new EXRLoader().setDataType(THREE.FloatType).loadAsync(new URL(asked.with, file).href);
        return compare(readTexels(gl, scene.environment), image);
    }
    const pictures = [];
    for (const name of [file, new URL(asked.like, file).href]) {
        pictures.push([]);
        for (const r of roughness) {
            const { gl, scene, camera } = await show(name, r);
            pictures.at(-1).push(readPixels(gl, SIZE, SIZE, () => gl.render(scene, camera)));
        }
    }
    const [ours, wanted] = pictures;
    return [...ours.map((picture, i) => compare(picture, wanted[i], onBall)), compare(ours[0], wanted[0], inSky)];
}
