// Vite would bundle kiln-ibl's modules apart from the worker and the WebAssembly that they find beside them. The page
// waits at its top level, which Vite's default target forbids.
export default { optimizeDeps: { exclude: ['kiln-ibl'] }, build: { target: 'es2022' } };
