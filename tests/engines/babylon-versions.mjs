// The oldest version of Babylon.js for which kiln writes files shows the right pixels, within the bounds of the newest.
import newest from './babylon.mjs';

// Version 5.0.0 does not go over from radiance to irradiance as materials get rough.
const older = (model) => (...sizes) => ({ ...model(...sizes), shade: () => [1, 0] });

export default newest.map((proof) => ({ ...proof, title: `${proof.name} in 5.0.0`, model: older(proof.model),
                                        page: 'babylon.html?babylonjs-5' }));
