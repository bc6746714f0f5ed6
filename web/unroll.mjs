// Draws baked cube levels as panoramas, tone-mapped for a screen.

// Index of the texel in a direction (x, y, z), with the faces of OpenGL's cube maps.
function texel(level, x, y, z) {
    const ax = Math.abs(x), ay = Math.abs(y), az = Math.abs(z);
    let face, s, t, m;
    if (ax >= ay && ax >= az)
        [face, s, t, m] = x > 0 ? [0, -z, -y, ax] : [1, z, -y, ax];
    else if (ay >= az)
        [face, s, t, m] = y > 0 ? [2, x, z, ay] : [3, x, -z, ay];
    else
        [face, s, t, m] = z > 0 ? [4, x, -y, az] : [5, -x, -y, az];
    const n = level.size, at = (v) => Math.min(Math.floor((v / m + 1) * 0.5 * n), n - 1);
    return 3 * ((face * n + at(t)) * n + at(s));
}

// Tone-maps a radiance by x / (1 + x) and sRGB's curve to a byte's range, 0 to 255.
function shown(radiance) {
    const v = radiance / (1 + radiance);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
}

// Factor on the radiance that makes the mean luminance of the sphere middle grey (0.22).
export function middleGrey(harmonics) {
    const mean = (0.2126 * harmonics[0] + 0.7152 * harmonics[1] + 0.0722 * harmonics[2]) *
                 0.28209479177387814;
    return mean > 0 ? 0.22 / mean : 1;
}

// Canvases here are the processor's own (willReadFrequently): those of the graphics processor would keep the
// page waiting while the stage's shaders are compiled.
export function unroll(level, exposure, canvas, width, height) {
    canvas.width = width;
    canvas.height = height;
    const picture = new ImageData(width, height);
    for (let j = 0; j < height; j++) {
        const theta = Math.PI * (j + 0.5) / height, y = Math.cos(theta), around = Math.sin(theta);
        for (let i = 0; i < width; i++) {
            const phi = 2 * Math.PI * ((i + 0.5) / width - 0.5);
            const from = texel(level, around * Math.sin(phi), y, -around * Math.cos(phi));
            for (let c = 0; c < 3; c++)
                picture.data[4 * (j * width + i) + c] = shown(level.texels[from + c] * exposure);
            picture.data[4 * (j * width + i) + 3] = 255;
        }
    }
    canvas.getContext('2d', { willReadFrequently: true }).putImageData(picture, 0, 0);
}
