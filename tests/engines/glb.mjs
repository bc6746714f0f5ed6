// Patches as a glTF model, for engines that draw them by their own glTF loader.

// Returns the bytes of a GLB with one mesh for each roughness, whose material makeMaterial(roughness) gives. The meshes
// are rows of patches in the plane that the view's camera sees.
export function makeGlb(view, roughness, makeMaterial) {
    const columns = view.normals.length, rows = roughness.length, corners = 6 * columns;
    const numbers = new Float32Array(rows * corners * 6);
    const json = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [] }], nodes: [], meshes: [],
                   materials: [], accessors: [], bufferViews: [],
                   buffers: [{ byteLength: numbers.byteLength }], extensionsUsed: ['KHR_materials_specular'] };
    let at = 0;
    const accessor = (values) => {
        numbers.set(values, at / 4);
        json.bufferViews.push({ buffer: 0, byteOffset: at, byteLength: 4 * values.length });
        at += 4 * values.length;
        const box = (pick) => [0, 1, 2].map((c) => pick(...values.filter((_, i) => i % 3 === c)));
        return json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType: 5126,
            count: corners, type: 'VEC3', min: box(Math.min), max: box(Math.max) }) - 1;
    };
    roughness.forEach((r, row) => {
        const positions = [], normals = [];
        view.normals.forEach((normal, i) => {
            for (const [x, y] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) {
                positions.push(...view.right.map((v, c) => (i + x - columns / 2) * v +
                                                           (row + y - rows / 2) * view.up[c]).map(Math.fround));
                normals.push(...normal);
            }
        });
        json.materials.push(makeMaterial(r));
        json.meshes.push({ primitives: [{ material: row,
            attributes: { POSITION: accessor(positions), NORMAL: accessor(normals) } }] });
        json.nodes.push({ mesh: row });
        json.scenes[0].nodes.push(row);
    });
    return join(new TextEncoder().encode(JSON.stringify(json).padEnd(65536)), numbers);
}

// The bytes of a GLB with JSON, whose length is a multiple of four, and a buffer.
function join(text, numbers) {
    const bytes = new Uint8Array(28 + text.length + numbers.byteLength);
    const words = new DataView(bytes.buffer);
    [0x46546c67, 2, bytes.length, text.length, 0x4e4f534a].forEach((w, i) => words.setUint32(4 * i, w, true));
    bytes.set(text, 20);
    words.setUint32(20 + text.length, numbers.byteLength, true);
    words.setUint32(24 + text.length, 0x004e4942, true);
    bytes.set(new Uint8Array(numbers.buffer), 28 + text.length);
    return bytes;
}

// Returns the bytes of a GLB with a ball of radius 1, whose positions are its normals.
export function makeBall(material) {
    const rings = 32, columns = 64, normals = [];
    const at = (i, j) => {
        const down = Math.PI * i / rings, around = 2 * Math.PI * j / columns;
        return [Math.sin(down) * Math.cos(around), Math.cos(down), -Math.sin(down) * Math.sin(around)];
    };
    for (let i = 0; i < rings; i++)
        for (let j = 0; j < columns; j++)
            for (const [y, x] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
                normals.push(...at(i + y, j + x));
    const numbers = new Float32Array(normals), count = normals.length / 3;
    const accessor = { bufferView: 0, componentType: 5126, count, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] };
    const text = new TextEncoder().encode(JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], materials: [material],
        meshes: [{ primitives: [{ material: 0, attributes: { POSITION: 0, NORMAL: 0 } }] }], accessors: [accessor],
        bufferViews: [{ buffer: 0, byteLength: numbers.byteLength }], buffers: [{ byteLength: numbers.byteLength }],
    }).padEnd(2048));
    return join(text, numbers);
}
