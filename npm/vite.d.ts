import type { Plugin } from 'vite';

/** Vite plugin for imports such as `import env from './city.hdr?kiln&for=three'`: bakes the panorama when the project
 * is built, and gives the address of the baked file. The query names options of `kiln bake`. With `for=three`, files
 * are baked for the version of three.js that the project has installed. `cache` is a folder for what is baked, by
 * default the folder kiln-ibl in Vite's cacheDir. */
export default function kiln(options?: { cache?: string }): Plugin;
