// kiln-ibl finds its worker and its WebAssembly beside its modules, which Vite's bundling of dependencies would separate.
export default {
    optimizeDeps: { exclude: ['kiln-ibl'], include: ['@react-three/fiber', 'three'] },
    esbuild: { jsx: 'automatic' },
};
