// Balls in an environment that Vite bakes: the import gives the baked file's address, and the sun that was taken out.
import * as THREE from 'three';
import { addLights, loadEnvironment } from 'kiln-ibl/three';
import environment, { lights } from './sky.exr?for=three&exposure=-5&sun=extract&kiln';

const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.toneMapping = THREE.ACESFilmicToneMapping;
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(30, innerWidth / innerHeight, 0.1, 100);
camera.position.set(0, 0.6, 12);
camera.lookAt(0, 0, 0);

for (let i = 0; i < 3; i++) {
    const material = new THREE.MeshStandardMaterial({ metalness: 1, roughness: i / 2 });
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.9, 64, 32), material);
    ball.position.x = 2 * i - 2;
    scene.add(ball);
}

scene.environment = await loadEnvironment(environment, renderer);
scene.background = scene.environment;
addLights(scene, lights, { renderer });
renderer.setAnimationLoop(() => renderer.render(scene, camera));
