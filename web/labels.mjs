// Words on the picture: the roughness of each column of balls, and what sets the rows apart.
import { project } from './camera.mjs';

// What the upper row and the lower row of balls show, for each scene with two rows.
const ADDED = ['Light that bounces more than once is added back', 'Without that light, rough balls are too dark'];
const ROWS = {
    ibl: ADDED,
    compare: ADDED,
    check: ADDED,
    furnace: ['With all light added back, the balls are invisible', 'The light that is lost shows as grey'],
    assignment: ['Lost light added back', 'Without the lost light'],
    three: ['three.js with kiln\'s file', 'three.js with its own filter'],
};
const ONE_ROW = 'None of these balls adds lost light back';

function label(words, x, y, kind) {
    const mark = document.createElement('span');
    mark.className = kind;
    mark.textContent = words;
    mark.style.left = `${100 * x}%`;
    mark.style.top = `${100 * y}%`;
    return mark;
}

const percent = (value) => Number(value.toFixed(2)).toString();

// Two rows: numbers in the gap between the rows, words above and below.
function twoRows(view, aspect, balls) {
    const at = (ball, up) => project(view, aspect, [ball[0], up, ball[2]]);
    const upper = balls.filter((ball) => ball[1] > 0), radius = balls[0][3];
    const order = upper.map((ball) => ball[4]), most = Math.max(...order), least = Math.min(...order);
    const numbers = upper.map((ball) => {
        const { x, y } = at(ball, 0), word = ball[4] === most ? 'rough ' : ball[4] === least ? 'glossy ' : '';
        return label(`${word}${percent(ball[4])}`, x, y, 'roughness');
    });
    const middle = upper[Math.floor(upper.length / 2)];
    const above = at(middle, middle[1] + radius), below = at(middle, -middle[1] - radius);
    const rows = view.scene !== 'three' && view.method === 'single' ? [ONE_ROW, ONE_ROW] : ROWS[view.scene];
    return [...numbers, label(rows[0], above.x, above.y, 'row above'), label(rows[1], below.x, below.y, 'row below')];
}

function grid(view, aspect, balls) {
    const low = Math.min(...balls.map((ball) => ball[1])), left = Math.min(...balls.map((ball) => ball[0]));
    const bottom = balls.filter((ball) => ball[1] === low), side = balls.filter((ball) => ball[0] === left);
    const under = (ball) => project(view, aspect, [ball[0], low - 1.35 * ball[3], ball[2]]);
    const beside = (ball) => project(view, aspect, [left - 1.1 * ball[3], ball[1], ball[2]]);
    const words = (i, last, lowest, highest) => (i === 0 ? lowest : i === last ? highest : '');
    return [...bottom.map((ball, i) => {
        const { x, y } = under(ball);
        return label(words(i, bottom.length - 1, 'mirror 0', 'rough 1') || percent(ball[4]), x, y, 'roughness');
    }), ...side.map((ball, i) => {
        const { x, y } = beside(ball);
        return label(words(i, side.length - 1, 'paint', 'metal'), x, y, 'side');
    })];
}

// Puts the labels of a view into `box`. `balls` are those of the view's scene.
export function showLabels(box, view, aspect, balls) {
    const marks = view.scene === 'grid' ? grid(view, aspect, balls) : twoRows(view, aspect, balls);
    box.replaceChildren(...marks.filter((mark) => mark.textContent));
}
