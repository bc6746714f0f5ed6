// The canvas with its input. Draws a coarse frame at each change and a fine frame after a pause;
// turns pointer and keys into changes of the state.
const RESTS = 180; // ms without a change before the fine frame

export const KEYS = [
    ['arrows, drag', 'walk around the balls'],
    ['+ −, wheel', 'nearer, farther'],
    ['[ ]', 'turn the environment'],
    [', .', 'darker, brighter'],
    ['1 to 5', 'scenes'],
    ['m k', 'next material, next method'],
    ['0', 'the scene as it was'],
    ['h', 'these keys'],
];

export class View {
    // onChange(name, value) is called for each change of a value, onKeys() for the key that shows
    // the help.
    constructor({ canvas, handle, stage, read, onChange, onScene, onNext, onReset, onKeys }) {
        Object.assign(this, { canvas, handle, stage, read, onChange, onScene, onNext, onReset, onKeys });
        new ResizeObserver(() => this.change()).observe(canvas);
        canvas.addEventListener('keydown', (event) => this.key(event));
        canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
        canvas.addEventListener('pointermove', (event) => this.drag(event));
        canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
        handle.addEventListener('pointerdown', (event) => handle.setPointerCapture(event.pointerId));
        handle.addEventListener('pointermove', (event) => this.slide(event));
        handle.addEventListener('keydown', (event) => this.slideByKey(event));
    }

    // Requests a coarse frame at once and a fine frame after RESTS ms without another change.
    change() {
        this.canvas.dataset.drawn = '';
        if (!this.asked)
            this.asked = requestAnimationFrame(() => this.frame(false));
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.frame(true), RESTS);
    }

    frame(fine) {
        cancelAnimationFrame(this.asked); // a late coarse frame must not follow the fine one
        this.asked = 0;
        const { canvas, stage } = this;
        const scale = Math.min(window.devicePixelRatio || 1, 2);
        const width = Math.max(1, Math.round(canvas.clientWidth * scale));
        const height = Math.max(1, Math.round(canvas.clientHeight * scale));
        if (!stage.ready || canvas.hidden)
            return;
        if (canvas.width !== width || canvas.height !== height)
            [canvas.width, canvas.height] = [width, height];
        const view = this.read();
        this.handle.style.left = `${100 * view.split}%`;
        stage.draw(fine ? view : { ...view, samples: 1 }, width, height);
        if (fine)
            canvas.dataset.drawn = 'finely';
    }

    add(name, step) {
        this.onChange(name, this.read()[name] + step);
    }

    drag(event) {
        if (!this.canvas.hasPointerCapture(event.pointerId))
            return;
        this.add('azimuth', -0.35 * event.movementX);
        this.add('elevation', 0.35 * event.movementY);
    }

    wheel(event) {
        event.preventDefault();
        this.onChange('distance', this.read().distance * Math.exp(0.001 * event.deltaY));
    }

    key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey)
            return;
        const steps = {
            ArrowLeft: ['azimuth', -5], ArrowRight: ['azimuth', 5],
            ArrowUp: ['elevation', 5], ArrowDown: ['elevation', -5],
            '[': ['turn', -5], ']': ['turn', 5], ',': ['stops', -0.5], '.': ['stops', 0.5],
        };
        const { distance } = this.read();
        if (steps[event.key])
            this.add(...steps[event.key]);
        else if (event.key === '+' || event.key === '=')
            this.onChange('distance', distance / 1.1);
        else if (event.key === '-')
            this.onChange('distance', distance * 1.1);
        else if (event.key >= '1' && event.key <= '5')
            this.onScene(Number(event.key) - 1);
        else if (event.key === 'm' || event.key === 'k')
            this.onNext(event.key === 'm' ? 'material' : 'method');
        else if (event.key === '0')
            this.onReset();
        else if (event.key === 'h')
            this.onKeys();
        else
            return;
        event.preventDefault();
    }

    slide(event) {
        if (!this.handle.hasPointerCapture(event.pointerId))
            return;
        const box = this.canvas.getBoundingClientRect();
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
