// The canvas with its input: asks for a picture at each change, and turns pointer and keys into
// changes of the state.
export const KEYS = [
    ['arrows, drag', 'walk around the balls'],
    ['+ −, wheel', 'nearer, farther'],
    ['[ ]', 'turn the environment'],
    [', .', 'darker, brighter'],
    ['1 to 7', 'scenes'],
    ['m k', 'next material, next method'],
    ['0', 'the scene as it was'],
    ['? h', 'these keys'],
];

export class View {
    // draw(width, height) asks for a picture. onChange(name, value) is called for each change of a
    // value.
    constructor({ canvas, box, handle, draw, read, onChange, onScene, onNext, onReset }) {
        Object.assign(this, { canvas, box, handle, draw, read, onChange, onScene, onNext, onReset });
        new ResizeObserver(() => this.change()).observe(canvas);
        canvas.addEventListener('keydown', (event) => this.key(event));
        for (const name of ['pointerdown', 'pointermove'])
            box.addEventListener(name, (event) => this.point(event));
        box.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
        handle.addEventListener('pointerdown', (event) => handle.setPointerCapture(event.pointerId));
        handle.addEventListener('pointermove', (event) => this.slide(event));
        handle.addEventListener('keydown', (event) => this.slideByKey(event));
    }

    // Asks for a picture with the browser's next frame.
    change() {
        this.canvas.dataset.drawn = '';
        this.asked ||= requestAnimationFrame(() => this.frame());
    }

    frame() {
        this.asked = 0;
        const { box } = this, scale = Math.min(window.devicePixelRatio || 1, 2);
        this.draw(Math.max(1, Math.round(box.clientWidth * scale)), Math.max(1, Math.round(box.clientHeight * scale)));
    }

    // Pointers on pictures; those on the dividing line are its own.
    point(event) {
        if (event.target.tagName !== 'CANVAS')
            return;
        if (event.type === 'pointerdown')
            event.target.setPointerCapture(event.pointerId);
        else if (event.target.hasPointerCapture(event.pointerId))
            this.drag(event);
    }

    add(name, step) {
        this.onChange(name, this.read()[name] + step);
    }

    drag(event) {
        this.add('azimuth', -0.35 * event.movementX);
        this.add('elevation', 0.35 * event.movementY);
    }

    // Goes nearer or farther by a factor.
    approach(factor) {
        const { zoom } = this.read();
        this.onChange('distance', 0);
        this.onChange('zoom', zoom * factor);
    }

    // The wheel scrolls the page unless the picture has the focus.
    wheel(event) {
        if (document.activeElement !== this.canvas)
            return;
        event.preventDefault();
        this.approach(Math.exp(-0.001 * event.deltaY));
    }

    key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey)
            return;
        const steps = {
            ArrowLeft: ['azimuth', -5], ArrowRight: ['azimuth', 5],
            ArrowUp: ['elevation', 5], ArrowDown: ['elevation', -5],
            '[': ['turn', -5], ']': ['turn', 5], ',': ['stops', -0.5], '.': ['stops', 0.5],
        };
        if (steps[event.key])
            this.add(...steps[event.key]);
        else if (event.key === '+' || event.key === '=')
            this.approach(1.1);
        else if (event.key === '-')
            this.approach(1 / 1.1);
        else if (event.key >= '1' && event.key <= '7')
            this.onScene(Number(event.key) - 1);
        else if (event.key === 'm' || event.key === 'k')
            this.onNext(event.key === 'm' ? 'material' : 'method');
        else if (event.key === '0')
            this.onReset();
        else
            return;
        event.preventDefault();
    }

    slide(event) {
        if (!this.handle.hasPointerCapture(event.pointerId))
            return;
        const box = this.box.getBoundingClientRect();
        this.onChange('split', (event.clientX - box.left) / box.width);
    }

    slideByKey(event) {
        const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
        if (!step)
            return;
        this.add('split', step);
        event.preventDefault();
    }
}
