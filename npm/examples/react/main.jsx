// Balls in an environment: baked by `npm start` or, after a click, a panorama that is baked in the browser.
import { Environment } from '@react-three/drei';
import { Canvas } from '@react-three/fiber';
import { useBakedEnvironmentMap, useEnvironmentMap } from 'kiln-ibl/react';
import { Suspense, useState } from 'react';
import { createRoot } from 'react-dom/client';

function Loaded() {
    return <Environment map={useEnvironmentMap('sky.ktx2')} background />;
}

function Baked({ panorama }) {
    return <Environment map={useBakedEnvironmentMap(panorama, { exposure: -5, size: 128 })} background />;
}

function App() {
    const [bakes, setBakes] = useState(false);
    return <>
        <Canvas camera={{ position: [0, 0.6, 12], fov: 30 }}>
            <Suspense fallback={null}>
                {bakes ? <Baked panorama="sky.exr" /> : <Loaded />}
                {[0, 0.5, 1].map((roughness, i) => (
                    <mesh key={roughness} position={[2 * i - 2, 0, 0]}>
                        <sphereGeometry args={[0.9, 64, 32]} />
                        <meshStandardMaterial metalness={1} roughness={roughness} />
                    </mesh>
                ))}
            </Suspense>
        </Canvas>
        <p><button onClick={() => setBakes(true)}>Bake sky.exr here</button></p>
    </>;
}

createRoot(document.getElementById('root')).render(<App />);
