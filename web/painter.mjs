// Draws frames such that no frame keeps the graphics processor, or the processor that stands in for
// it, for long: while the view changes, frames have one ray a pixel and as few pixels as a short
// time allows. After a pause the picture is drawn again in bands of rows, with more and more rays.
const RESTS = 180;       // ms without a change before the picture becomes finer
const SHORT = 120;       // ms that a coarse frame or a band should take
const SMALLEST = 1 / 4;  // smallest scale of coarse frames

const pause = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

export class Painter {
    // `stage` is a started Stage, `gl` its context. onDrawn(serial, how) tells that a view has been
    // drawn 'coarsely' or 'finely'. `batch` is the number of rays that take SHORT, which is guessed
    // low before the first frame has been measured.
    constructor(stage, gl, onDrawn) {
        Object.assign(this, { stage, gl, onDrawn, batch: 25000, serial: 0, wanted: null, waiting: [] });
    }

    // Asks for a view. Only the newest view is drawn to its end. `samples` of the view squared is the
    // number of rays a pixel of the finest picture.
    want(view, width, height, serial) {
        this.wanted = { view, width, height, serial };
        this.since = performance.now();
        this.waiting.splice(0).forEach((wake) => wake());
        this.working ??= this.work().finally(() => { this.working = null; });
    }

    // Runs `task`, which draws by itself, between two bands.
    async aside(task) {
        this.turn = (this.turn ?? Promise.resolve()).then(task, task);
        return this.turn;
    }

    async work() {
        while (this.wanted && this.serial !== this.wanted.serial) {
            const wanted = this.wanted;
            await this.coarse(wanted);
            if (wanted === this.wanted && await this.finer(wanted))
                this.serial = wanted.serial;
        }
    }

    // Waits until what was drawn is done, and corrects the number of rays of the next batch. A draw takes
    // some time whatever its size, so the correction is by a factor of 2 at most.
    async done(rays) {
        const { gl } = this, began = performance.now();
        const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        while (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost())
            await pause(2);
        gl.deleteSync(fence);
        const factor = SHORT / Math.max(1, performance.now() - began);
        if (factor < 1 || rays > 0.5 * this.batch)
            this.batch *= Math.min(2, Math.max(0.5, factor));
    }

    resize(width, height) {
        const { canvas } = this.gl;
        if (canvas.width === width && canvas.height === height)
            return;
        [canvas.width, canvas.height] = [width, height];
        this.gl.deleteFramebuffer(this.frame);
        this.gl.deleteTexture(this.texture);
        this.frame = null;
    }

    // A framebuffer for coarse frames.
    bindFrame(width, height) {
        const { gl } = this;
        if (!this.frame) {
            this.frame = gl.createFramebuffer();
            this.texture = gl.createTexture();
            gl.activeTexture(gl.TEXTURE0);
            gl.bindTexture(gl.TEXTURE_2D, this.texture);
            gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    }

    async coarse({ view, width, height, serial }) {
        const { gl, stage } = this, one = { ...view, samples: 1 };
        const scale = Math.min(1, Math.max(SMALLEST, Math.sqrt(this.batch / (width * height))));
        await this.aside(async () => {
            this.resize(width, height);
            if (scale > 0.9) {
                stage.draw(one, width, height);
                return this.done(width * height);
            }
            const [w, h] = [Math.ceil(scale * width), Math.ceil(scale * height)];
            this.bindFrame(width, height);
            stage.draw(one, w, h);
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.frame);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
            gl.blitFramebuffer(0, 0, w, h, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.LINEAR);
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            return this.done(w * h);
        });
        this.sharp = scale > 0.9;
        this.onDrawn(serial, 'coarsely');
    }

    // Draws finer pictures until the finest. Returns false as soon as another view is wanted.
    async finer(wanted) {
        const { view, serial } = wanted;
        for (let left; wanted === this.wanted && (left = this.since + RESTS - performance.now()) > 0;)
            await Promise.race([pause(left), new Promise((wake) => { this.waiting.push(wake); })]);
        const finest = Math.round(view.samples), steps = [1, 2, 4].filter((n) => n < finest);
        if (wanted !== this.wanted)
            return false;
        for (const samples of [...steps, finest].filter((n) => n > 1 || !this.sharp))
            if (!await this.bands(wanted, samples))
                return false;
        // The browser shows what a worker drew with its next frame.
        await new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); });
        this.onDrawn(serial, 'finely');
        return wanted === this.wanted;
    }

    async bands(wanted, samples) {
        const { gl, stage } = this, { view, width, height } = wanted;
        for (let top = height; top > 0;) {
            const rays = width * samples * samples;
            const rows = Math.min(top, Math.max(4, Math.floor(this.batch / rays)));
            top -= rows;
            await this.aside(() => {
                gl.enable(gl.SCISSOR_TEST);
                gl.scissor(0, top, width, rows);
                stage.draw({ ...view, samples }, width, height);
                gl.disable(gl.SCISSOR_TEST);
                return this.done(rows * rays);
            });
            if (wanted !== this.wanted)
                return false;
        }
        return true;
    }
}
