// Balls in an environment that `npm start` bakes. A panorama that is dropped on the page is baked in the browser.
import * as babylon from '@babylonjs/core';
import { addLights, bakeEnvironment, loadEnvironment } from 'kiln-ibl/babylon';

const { ArcRotateCamera, Engine, MeshBuilder, PBRMaterial, Scene, Vector3 } = babylon;
const engine = new Engine(document.querySelector('canvas'), true);
const scene = new Scene(engine);
new ArcRotateCamera('camera', -Math.PI / 2, 1.53, 16, Vector3.Zero(), scene).attachControl();
scene.activeCamera.fov = 0.5;
scene.imageProcessingConfiguration.toneMappingEnabled = true;

// A row of metal balls and a row of white plastic ones. Their roughness grows from 0 to 1.
for (const metallic of [0, 1])
    for (let i = 0; i < 5; i++) {
        const ball = MeshBuilder.CreateSphere('ball', { diameter: 1.8, segments: 48 }, scene);
        ball.position.set(2 * i - 4, metallic ? 1 : -1, 0);
        ball.material = Object.assign(new PBRMaterial('material', scene), { metallic, roughness: i / 4 });
    }

scene.environmentTexture = await loadEnvironment('sky.env', scene, { babylon });
let sky = scene.createDefaultSkybox(scene.environmentTexture, true);
// The sun, which `npm start` takes out of the environment, is a directional light.
const suns = addLights(scene, await (await fetch('sun.json')).json(), { babylon });

addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', async (event) => {
    event.preventDefault();
    const line = document.querySelector('p');
    try {
        const baked = await bakeEnvironment(event.dataTransfer.files[0], scene, {
            babylon,
            onProgress: (fraction, stage) => { line.textContent = `${stage} ${Math.round(100 * fraction)} %`; },
        });
        sky.dispose();
        scene.environmentTexture = baked;
        sky = scene.createDefaultSkybox(baked, true);
        suns.splice(0).forEach((sun) => sun.dispose()); // the panorama holds its own sun
        line.textContent = baked.name;
    } catch (error) {
        line.textContent = error.message;
    }
});

addEventListener('resize', () => engine.resize());
engine.runRenderLoop(() => scene.render());
