// Vite would bundle kiln-ibl's modules apart from the worker and the WebAssembly that they find beside them.
export default {
    optimizeDeps: { exclude: ['kiln-ibl'], include: ['@react-three/fiber', 'three'] },
    esbuild: { jsx: 'automatic' },
};
