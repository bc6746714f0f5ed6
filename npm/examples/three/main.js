// Balls in an environment that `npm start` bakes. A panorama that is dropped on the page is baked in the browser.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { addLights, bakeEnvironment, loadEnvironment } from 'kiln-ibl/three';

const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.toneMapping = THREE.ACESFilmicToneMapping;
renderer.shadowMap.enabled = true;
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
camera.position.set(0, 0.6, 16);
const controls = new OrbitControls(camera, renderer.domElement);

// A row of metal balls and a row of white plastic ones. Their roughness grows from 0 to 1.
const sphere = new THREE.SphereGeometry(0.9, 64, 32);
for (const metalness of [0, 1])
    for (let i = 0; i < 5; i++) {
        const ball = new THREE.Mesh(sphere, new THREE.MeshStandardMaterial({ metalness, roughness: i / 4 }));
        ball.position.set(2 * i - 4, metalness ? 1 : -1, 0);
        ball.castShadow = ball.receiveShadow = true;
        scene.add(ball);
    }

// Three.js up to r186 would load the second file, later versions load the first.
scene.environment = await loadEnvironment({ 'three': 'sky.ktx2', 'three-cubeuv': 'sky-cubeuv.exr' }, renderer);
scene.background = scene.environment;
// The sun, which `npm start` takes out of the environment, is a directional light with shadows.
const suns = addLights(scene, await (await fetch('sun.json')).json(), { shadows: 6, renderer });

addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', async (event) => {
    event.preventDefault();
    const line = document.querySelector('p');
    try {
        const baked = await bakeEnvironment(event.dataTransfer.files[0], renderer, {
            onProgress: (fraction, stage) => { line.textContent = `${stage} ${Math.round(100 * fraction)} %`; },
        });
        scene.environment.dispose();
        scene.environment = scene.background = baked;
        suns.splice(0).forEach((sun) => scene.remove(sun)); // the panorama holds its own sun
        line.textContent = baked.name;
    } catch (error) {
        line.textContent = error.message;
    }
});

renderer.setAnimationLoop(() => {
    const { innerWidth: width, innerHeight: height } = window;
    if (renderer.domElement.clientWidth !== width || camera.aspect !== width / height) {
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
        renderer.setSize(width, height);
    }
    controls.update();
    renderer.render(scene, camera);
});
