// A histogram of the source's brightness in stops, with the end of half floats.
const CLIP = 65504; // largest half float

const words = (value) => (value >= 1e4 || value < 0.01 ? value.toExponential(1).replace('e+', 'e')
                                                       : String(Number(value.toPrecision(3))));

// Draws `histogram`, in the form of Baker.histogram, on a canvas in the colours of the page. Returns a
// sentence about the picture's range.
export function showHistogram(canvas, { first, parts, largest }) {
    const style = getComputedStyle(document.documentElement), color = (name) => style.getPropertyValue(name);
    const scale = Math.min(window.devicePixelRatio || 1, 2), pen = canvas.getContext('2d', { willReadFrequently: true });
    const width = canvas.clientWidth * scale, height = canvas.clientHeight * scale;
    const clip = Math.log2(CLIP) - first, foot = 2 * scale, head = 18 * scale, step = width / parts.length;
    [canvas.width, canvas.height] = [width, height];
    // The square root keeps the few texels of a sun visible beside the sky.
    const most = Math.sqrt(Math.max(...parts));
    parts.forEach((part, i) => {
        const tall = part > 0 ? Math.max(2 * scale, Math.sqrt(part) / most * (height - foot - head)) : 0;
        pen.fillStyle = color(i >= Math.floor(clip) ? '--wrong' : '--ember');
        pen.fillRect(i * step, height - foot - tall, Math.max(1, step - scale), tall);
    });
    pen.fillStyle = color('--line');
    pen.fillRect(0, height - scale, width, scale);
    pen.fillStyle = color('--wrong');
    pen.fillRect(clip * step, 0, scale, height);
    pen.font = `${11 * scale}px system-ui, sans-serif`;
    pen.textBaseline = 'top';
    pen.fillText('half floats end', clip * step - pen.measureText('half floats end').width - 4 * scale, 3 * scale);
    pen.fillStyle = color('--quiet');
    pen.fillText('dark', 4 * scale, 3 * scale);
    pen.fillText('bright', width - pen.measureText('bright').width - 4 * scale, 3 * scale);
    return largest > CLIP
        ? `Brightest value ${words(largest)}: half floats end at ${CLIP}, and files of halves cut the rest off.`
        : `Brightest value ${words(largest)}; half floats, which end at ${CLIP}, hold all.`;
}
