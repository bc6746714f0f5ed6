// Where balls appear on the screen, and how far the camera must stand so that all balls are whole.
// A camera orbits its target at an azimuth and an elevation in degrees and has a vertical field of
// view in degrees, as view_camera in viewer/viewer.h.
const DEGREE = Math.PI / 180;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// The camera's axes right, up and backwards, as view_camera_axes computes them.
function axes({ azimuth, elevation }) {
    const [sa, ca] = [Math.sin(azimuth * DEGREE), Math.cos(azimuth * DEGREE)];
    const [se, ce] = [Math.sin(elevation * DEGREE), Math.cos(elevation * DEGREE)];
    return [[ca, 0, -sa], [-se * sa, ce, -se * ca], [ce * sa, se, ce * ca]];
}

// A point's coordinates along the camera's axes, from the target.
function inCamera(view, point) {
    const from = [point[0] - view.targetX, point[1] - view.targetY, point[2] - view.targetZ];
    return axes(view).map((axis) => dot(axis, from));
}

// Parts of the picture that the balls fill at most; the labels need the rest.
const FILLED = { across: 0.95, down: 0.8 }, FILLED_BY_GRID = { across: 0.74, down: 0.8 };

// Distance of the camera from its target at which the silhouettes of all balls fill FILLED of a picture
// whose width is `aspect` times its height. A plane through the eye touches a ball of radius
// r if (distance - z) t = |x| + r sqrt(1 + t^2), with t the tangent of the plane's angle.
export function wholeDistance(view, balls, aspect) {
    const slope = Math.tan(view.fov / 2 * DEGREE);
    const towards = { ...view, azimuth: 0 }, filled = view.scene === 'grid' ? FILLED_BY_GRID : FILLED;
    return Math.max(...balls.map((ball) => {
        const [x, y, z] = inCamera(towards, ball);
        const along = (offset, t) => z + (Math.abs(offset) + ball[3] * Math.hypot(1, t)) / t;
        return Math.max(along(x, filled.across * slope * aspect), along(y, filled.down * slope));
    }));
}

// Place of a point in a picture, as parts of its width and height from the top left corner.
export function project(view, aspect, point) {
    const slope = Math.tan(view.fov / 2 * DEGREE);
    const [x, y, z] = inCamera(view, point);
    const depth = (view.distance - z) * slope;
    return { x: 0.5 + 0.5 * x / (depth * aspect), y: 0.5 - 0.5 * y / depth };
}
