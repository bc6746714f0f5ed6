// Runs the command of kiln.wasm. In: the compiled module, the words of a command line, and a system: an object with
// functions for files, streams and progress (memory.mjs, disk.mjs). Out: the exit code. The functions of a system
// throw errors with a code such as ENOENT, which the command gets as the number that its C library has for this code.

// Numbers of errors in WASI, which the C library of the module shares.
const NUMBERS = {
    EACCES: 2, EAGAIN: 6, EBADF: 8, EBUSY: 10, EDQUOT: 19, EEXIST: 20, EFBIG: 22, EINTR: 27, EINVAL: 28, EIO: 29,
    EISDIR: 31, ELOOP: 32, EMFILE: 33, ENAMETOOLONG: 37, ENFILE: 41, ENODEV: 43, ENOENT: 44, ENOMEM: 48, ENOSPC: 51,
    ENOTDIR: 54, ENOTEMPTY: 55, ENOTSUP: 58, ENXIO: 60, EPERM: 63, EPIPE: 64, EROFS: 69, ESPIPE: 70, ETXTBSY: 74,
    EXDEV: 75,
};

class Exit {
    constructor(code) {
        this.code = code;
    }
}

// Returns f with errors as negative numbers.
const guarded = (f) => (...values) => {
    try {
        return f(...values) ?? 0;
    } catch (error) {
        if (typeof error?.code !== 'string')
            throw error;
        return -(NUMBERS[error.code] ?? NUMBERS.EIO);
    }
};

// The memory of a module and what lies in it. A view is made anew for each use, since memory may grow.
class Memory {
    bytes(at, size) {
        return new Uint8Array(this.memory.buffer, at >>> 0, size >>> 0);
    }

    text(at) {
        const from = new Uint8Array(this.memory.buffer, at >>> 0);
        return new TextDecoder().decode(from.subarray(0, from.indexOf(0)));
    }

    set(at, number) {
        new DataView(this.memory.buffer).setUint32(at >>> 0, number, true);
    }

    get(at) {
        return new DataView(this.memory.buffer).getUint32(at >>> 0, true);
    }
}

// What src/base/os_host.c and cli/os_host.c import.
function systemCalls(memory, system) {
    let listed;
    const path = (name) => guarded((at) => system[name](memory.text(at)));
    return {
        kind: path('kind'),
        open: path('open'),
        create: path('create'),
        create_or_empty: path('createOrEmpty'),
        remove: path('remove'),
        make_folder: path('makeFolder'),
        remove_folder: path('removeFolder'),
        writable: path('writable'),
        copy_mode: guarded((file, at) => system.copyMode(file, memory.text(at))),
        size: (file) => system.size(file),
        read: guarded((file, at, size) => system.read(file, memory.bytes(at, size))),
        write: guarded((file, at, size) => system.write(file, memory.bytes(at, size))),
        sync: guarded((file) => system.sync(file)),
        close: guarded((file) => system.close(file)),
        replace: guarded((from, to) => system.replace(memory.text(from), memory.text(to))),
        link: guarded((at, target, room) => {
            const bytes = new TextEncoder().encode(`${system.follow(memory.text(at))}\0`);
            if (bytes.length > room)
                throw Object.assign(new Error('too long'), { code: 'ENAMETOOLONG' });
            memory.bytes(target, room).set(bytes);
        }),
        list: guarded((at, names, room) => {
            if (!room)
                listed = new TextEncoder().encode(system.list(memory.text(at)).map((name) => `${name}\0`).join(''));
            else
                memory.bytes(names, room).set(listed);
            return listed.length;
        }),
        process: () => system.process(),
        seconds: () => performance.now() / 1000,
        terminal: (stream) => (system.isTerminal(stream) ? 1 : 0),
        columns: () => system.columns(),
        signal: () => system.signal(),
        reader_gone: () => (system.readerGone ? 1 : 0),
        progress: (stage, fraction) => system.progress(fraction, memory.text(stage)),
    };
}

// What the C library of the module imports: WASI's functions for arguments and streams.
function libraryCalls(memory, words, system) {
    const encoded = words.map((word) => new TextEncoder().encode(`${word}\0`));
    // Calls f with each of `count` pieces of memory until f takes less than a piece holds.
    const pieces = (f) => guarded((file, at, count, total) => {
        let sum = 0;
        for (let i = 0; i < count; i++) {
            const size = memory.get(at + 8 * i + 4);
            const done = size ? f(file, memory.bytes(memory.get(at + 8 * i), size)) : 0;
            sum += done;
            if (done < size)
                break;
        }
        memory.set(total, sum);
    });
    const number = (f) => (...values) => -f(...values);
    return {
        args_sizes_get(count, size) {
            memory.set(count, encoded.length);
            memory.set(size, encoded.reduce((sum, word) => sum + word.length, 0));
            return 0;
        },
        args_get(pointers, at) {
            for (const [i, word] of encoded.entries()) {
                memory.set(pointers + 4 * i, at);
                memory.bytes(at, word.length).set(word);
                at += word.length;
            }
            return 0;
        },
        environ_sizes_get(count, size) {
            memory.set(count, 0);
            memory.set(size, 0);
            return 0;
        },
        environ_get: () => 0,
        proc_exit(code) {
            throw new Exit(code);
        },
        fd_write: number(pieces((file, bytes) => system.write(file, bytes))),
        fd_read: number(pieces((file, bytes) => system.read(file, bytes))),
        fd_close: number(guarded((file) => system.close(file))),
        fd_seek: () => NUMBERS.ESPIPE,
    };
}

export function run(module, words, system) {
    const memory = new Memory();
    let high = 0; // a register of the compiler's, by which setjmp returns its second value
    const imports = {
        kiln: systemCalls(memory, system),
        wasi_snapshot_preview1: libraryCalls(memory, ['kiln', ...words], system),
        env: {
            emscripten_notify_memory_growth() {},
            setTempRet0(value) {
                high = value;
            },
            getTempRet0: () => high,
        },
    };
    const instance = new WebAssembly.Instance(module, imports);
    memory.memory = instance.exports.memory;
    try {
        instance.exports._start();
        return 0;
    } catch (error) {
        if (error instanceof Exit)
            return error.code;
        throw error;
    }
}
