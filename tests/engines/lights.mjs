// The sun of sunrise.exr, which holds 57 % of the light and stands 8 degrees high, is taken out of the environment
// and put back into engines as a light.
//
// The ball: white diffuse patches of 192 normals, lit by the file without the sun and by the light that addLights()
// or the page makes of lights.json, show irradiance / pi of the whole environment, which kiln integrates exactly.
// The ground: patches below a ball. Whether a patch lies in the ball's shadow follows from lights.json alone;
// there the rest shows, and elsewhere the light is added.
import path from 'node:path';
import { babylon, filament, playcanvas, three } from './models.mjs';
import { CELL, COLUMNS, add, bakePlain, check, dot, kiln, makeViews, panorama, readFile, readLevel }
    from './rig.mjs';

export const INPUT = path.join(path.dirname(panorama), 'sunrise.exr');
export const BALL_VIEWS = makeViews([[1, 0.1, 0], [-1, 0.1, 0], [0.1, 1, 0], [0.1, -1, 0], [0, 0.1, 1], [0, 0.1, -1]]);
const GROUND = { toEye: [0, 1, 0], right: [1, 0, 0], up: [0, 0, -1], normals: Array(COLUMNS).fill([0, 1, 0]) };
const ROWS = Array(COLUMNS).fill(1);
const ALONE = 1e-5; // relative error of what the light adds, which has the rounding of floats
// Filament rounds the colour of a dielectric without reflection to halves. The light alone is a difference of three
// such colours, each of which is rounded by 1/2048 of itself at most.
const HALVES = 3 / 2048;
const BALL = { centre: [0, 1.7, 0], radius: 1.5 };

// The file is tuned, as by default.
let exactly;
async function prepare({ name, ending, size, original }) {
    const bake = (kind, ...more) => kiln('bake', INPUT, '--for', name, '-o', `${kind}-${name}${ending}`,
                                         ...(size ? ['--size', size] : []), '-q', ...more);
    await bake('lights', '--sun', 'extract', '--lights-file', `lights-${name}.json`);
    if (original)
        await bake('original');
    exactly ??= bakePlain(64, [1], INPUT);
    const [whole] = await exactly;
    return { whole, lights: JSON.parse(readFile(`lights-${name}.json`)) };
}

// The largest difference of numbers [view][row][normal][channel] as a part of the largest number, and the RMS
// difference as a part of the RMS number.
function compare(shown, wanted) {
    const a = shown.flat(3), b = wanted.flat(3);
    const root = (values) => Math.sqrt(values.reduce((sum, x) => sum + x * x, 0));
    const off = a.map((x, i) => x - b[i]);
    return { most: Math.max(...off.map(Math.abs)) / Math.max(...b), rms: root(off) / root(b) };
}
const percent = (x) => `${(100 * x).toFixed(2)} %`;

// Reports what differs between numbers and those wanted, and checks that it is less than a bound.
function prove(what, shown, wanted, bound, say) {
    const { rms, most } = compare(shown, wanted);
    say(`${what}: ${percent(rms)} rms and ${percent(most)} at most`);
    check(rms < bound && most < bound, `${what}: ${rms} rms, ${most} at most, bound ${bound}`);
}

const overBall = (toKiln, value) => BALL_VIEWS.map(({ normals }) => [normals.map((n) => value(toKiln(n)))]);

// Compares what the light adds to the ball with irradiance * max(least, n . l) / pi.
export function compareLight(added, { lights: [{ direction, irradiance }] }, toKiln, bound, say, least = 0) {
    const wanted = overBall(toKiln, (n) => irradiance.map((e) => e * Math.max(least, dot(n, direction)) / Math.PI));
    prove('the light alone', added, wanted, bound, say);
}

// Errors are parts of the ball's brightest number: near zero, on the side away from the sun, engines show coarse levels
// and three bands of harmonics, with or without the light. Where `original` is set, the ball is also compared with the
// ball that the engine shows of the environment with the sun. The other engines show that environment less exactly
// than 1 %.
async function checkBall({ name, model, loads, asked, original, alone = ALONE }, { whole, lights }, draw, say) {
    const { toKiln } = model(6, 64);
    const show = (more, kind = 'lights') =>
        draw(`${kind}-${name}${loads}`, BALL_VIEWS, [1], CELL, { diffuse: true, ...asked, ...more });
    const exact = overBall(toKiln, (n) => readLevel(whole, n));
    const rest = await show({}), both = await show({ lights });
    prove('ball, from the exact', both, exact, 0.01, say);
    if (original) {
        const lit = await show({}, 'original');
        prove('ball lit by the whole environment, from the exact', lit, exact, 0.01, say);
        prove('ball, from the ball lit by the whole environment', both, lit, 0.01, say);
    }
    const added = both.map((view, v) => [view[0].map((value, x) => value.map((e, c) => e - rest[v][0][x][c]))]);
    compareLight(added, lights, toKiln, alone, say);
}

// The distance of the ball's centre from the ray towards the light, as far as it lies in front.
function missOf(place, toLight, centre) {
    const way = add(centre, -1, place), along = Math.max(0, dot(way, toLight));
    return Math.hypot(...add(way, -along, toLight));
}

async function checkGround({ name, model, loads }, { lights }, draw, say) {
    const { toKiln } = model(6, 64), [{ direction, irradiance }] = lights.lights;
    const toLight = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => dot(toKiln(axis), direction));
    const show = (more) => draw(`lights-${name}${loads}`, [GROUND], ROWS, CELL, { diffuse: true, ...more });
    const [dark] = await show({}), [shown] = await show({ lights, ball: BALL, shadows: 30 });
    const counts = { lit: 0, shadow: 0 };
    let most = 0;
    shown.forEach((row, y) => row.forEach((value, x) => {
        const at = (i) => i + 0.5 + 0.5 / CELL - COLUMNS / 2;
        const place = add([at(x), 0, 0], at(y), GROUND.up);
        const miss = missOf(place, toLight, BALL.centre) - BALL.radius;
        const hidden = Math.hypot(place[0], place[2]) < BALL.radius + 0.3;
        if (hidden || Math.abs(miss) < 0.3) // below the ball, or at the shadow's edge
            return;
        counts[miss < 0 ? 'shadow' : 'lit']++;
        value.forEach((v, c) => {
            const wanted = dark[y][x][c] + (miss < 0 ? 0 : irradiance[c] * toLight[1] / Math.PI);
            most = Math.max(most, Math.abs(v - wanted) / wanted);
        });
    }));
    say(`ground: ${counts.shadow} patches in the shadow and ${counts.lit} in the light, ` +
        `off by ${percent(most)} at most`);
    check(counts.shadow > 20 && counts.lit > 500, `the ground has ${counts.shadow} and ${counts.lit} patches`);
    check(most < 0.01, `the ground is off by ${most}`);
}

const proofOf = (engine) => ({
    title: `lights in ${engine.name}`, ...engine, prepare: () => prepare(engine),
    check: async (files, draw, say) => {
        await checkBall(engine, files, draw, say);
        if (engine.ground)
            await checkGround(engine, files, draw, say);
    },
});
export default [
    proofOf({ ...three, size: 64, ground: true }),
    proofOf({ ...babylon, size: 64, ground: true }),
    proofOf({ ...filament, size: 64, original: true, alone: HALVES }),
    proofOf({ ...filament, title: 'lights in filament by harmonics', size: 64, asked: { harmonics: true },
              alone: HALVES }),
    proofOf(playcanvas),
];
