// Babylon.js with its table replaced by kiln's: grey metals in a white furnace show the albedo
// (f0 A + B) (1 + f0 (1 / (A + B) - 1)) of exact A and B, but for the 8 bits of the picture.
import { tableReader } from './three-table.mjs';
import { CELL, ROUGHNESS, check, kiln, makeViews, readFile, write } from './rig.mjs';

const SIZE = 512, F0 = 0.5;
const views = makeViews();
// Babylon looks from the camera's place, 20000 away, even where rays are parallel.
function novOf({ toEye, right, up, normals }, row, i) {
    const half = 0.5 + 0.5 / CELL, x = i + half - normals.length / 2, y = row + half - ROUGHNESS.length / 2;
    const way = toEye.map((e, c) => 20000 * e - x * right[c] - y * up[c]);
    return way.reduce((sum, e, c) => sum + e * normals[i][c], 0) / Math.hypot(...way);
}

function compare(say, name, exact, shown) {
    let most = 0, squares = 0, count = 0;
    views.forEach((view, side) => ROUGHNESS.forEach((roughness, row) => view.normals.forEach((_, i) => {
        const [a, b] = exact(novOf(view, row, i), roughness);
        const wanted = (F0 * a + b) * (1 + F0 * (1 / (a + b) - 1));
        for (const value of shown[side][row][i]) {
            most = Math.max(most, Math.abs(value - wanted));
            squares += (value - wanted) ** 2;
            count++;
        }
    })));
    const rms = Math.sqrt(squares / count);
    say(`${name}: ${count} values, rms ${rms.toExponential(1)}, ${most.toExponential(1)} at most`);
    return { most, rms };
}

export default [{
    name: 'babylon-table', page: 'babylon.html',
    prepare: async () => {
        await write('babylon', 'white', 256, 'furnace.env');
        await kiln('tables', '--for', 'babylon', '-q', '-o', 'brdf.png');
        await kiln('tables', '--table', 'dfg', '--size', SIZE, '-q', '-o', 'exact.raw');
        const numbers = new Float32Array(new Uint8Array(readFile('exact.raw')).buffer);
        return tableReader(SIZE, (x, y) => [...numbers.subarray(2 * (y * SIZE + x), 2 * (y * SIZE + x) + 2)]);
    },
    check: async (exact, draw, say) => {
        const grey = (more) => draw('furnace.env', views, ROUGHNESS, CELL, { grey: true, ...more });
        const own = compare(say, "Babylon's own table", exact, await grey());
        const ours = compare(say, "kiln's table", exact, await grey({ brdf: 'brdf.png' }));
        // Half a step of the root is up to 0.0043 of A + B; f0 A + B moves by half of it, its factor back by a
        // quarter.
        check(ours.most < 2e-3 && ours.rms < 7e-4, `kiln's table is off by ${ours.most}, ${ours.rms} rms`);
        check(ours.rms < own.rms, `Babylon's own table is nearer: ${own.rms}`);
    },
}];
