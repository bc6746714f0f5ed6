import kiln from 'kiln-ibl/vite';

export default { plugins: [kiln()], build: { target: 'es2022' } };
