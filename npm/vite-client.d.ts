// Types of imports that the Vite plugin bakes: `/// <reference types="kiln-ibl/vite/client" />`. TypeScript knows only
// patterns with one asterisk. For other queries, write kiln last: './city.hdr?for=three&size=128&kiln'.
declare module '*&kiln' {
    import type { Harmonics, Light } from 'kiln-ibl';
    /** Address of the file that the engine loads; of the first one where there are several. */
    const address: string;
    export default address;
    /** Addresses of all files, by their names. */
    export const files: Record<string, string>;
    /** Size in texels and roughness of each mip level. */
    export const levels: { size: number; roughness: number }[];
    /** Spherical harmonics of the radiance. */
    export const sh: Harmonics;
    /** The lights that were taken out with sun=extract. */
    export const lights: Light[];
}
declare module '*?kiln' {
    export { default, files, levels, sh, lights } from '&kiln';
}
declare module '*?kiln&for=three' {
    export { default, files, levels, sh, lights } from '&kiln';
}
declare module '*?kiln&for=three&sun=extract' {
    export { default, files, levels, sh, lights } from '&kiln';
}
declare module '*?kiln&for=three-cubeuv' {
    export { default, files, levels, sh, lights } from '&kiln';
}
declare module '*?kiln&for=babylon' {
    export { default, files, levels, sh, lights } from '&kiln';
}
