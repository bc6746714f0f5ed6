// Adds directional lights to a scene of Babylon.js: those that `kiln bake --sun extract --lights-file sun.json` took
// out of the environment and wrote to sun.json.
//     addLights(scene, await (await fetch('sun.json')).json());
// The intensity of a light is set to the irradiance of a surface that faces the light. A white diffuse surface of
// PBRMaterial then reflects the radiance irradiance / pi. A direction (x, y, z) of kiln is (x, y, -z) in Babylon's
// left-handed scenes.
//
// `shadows` is the radius of the sphere around the origin in which meshes cast and receive shadows. Each light then
// has a shadow generator, which must be told the meshes: light.getShadowGenerator().addShadowCaster(mesh). Meshes
// with receiveShadows show the shadows. `babylon` holds Babylon's classes where they are not global: Color3,
// DirectionalLight, ShadowGenerator and Vector3 of @babylonjs/core. Returns the lights.
export function addLights(scene, { lights }, { shadows = 0, babylon = globalThis.BABYLON } = {}) {
    const { Color3, DirectionalLight, ShadowGenerator, Vector3 } = babylon;
    return lights.map(({ direction: [x, y, z], irradiance }, i) => {
        const light = new DirectionalLight(`kiln light ${i}`, new Vector3(-x, -y, z), scene); // the way it shines
        light.intensity = Math.max(...irradiance);
        light.diffuse = new Color3(...irradiance.map((e) => e / light.intensity));
        light.specular = light.diffuse;
        if (shadows) {
            light.position = light.direction.scale(-2 * shadows);
            Object.assign(light, { shadowFrustumSize: 2 * shadows, shadowMinZ: shadows, shadowMaxZ: 3 * shadows });
            new ShadowGenerator(2048, light);
        }
        return light;
    });
}
