// kiln-ibl in browsers: work runs in workers. node.mjs is the same for Node. index.d.ts describes the functions.
export { engines, version } from './engines.mjs';

export async function bake() {
    throw new Error('kiln-ibl: the module is not built yet');
}

export async function kiln() {
    throw new Error('kiln-ibl: the module is not built yet');
}
