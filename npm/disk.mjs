// The system of a command in Node (host.mjs): real files and streams. Paths are Node's. The functions wait for what
// they ask, so they belong into a thread.
import fs from 'node:fs';
import path from 'node:path';
import tty from 'node:tty';

const FILE = 1, FOLDER = 2, OTHER = 3;
const MOST_LINKS = 40;

// Calls f again while a stream, such as a pipe, has no bytes or no room.
function patiently(f) {
    for (;;)
        try {
            return f();
        } catch (error) {
            if (error.code === 'EOF') // the end of standard input on Windows
                return 0;
            if (error.code !== 'EAGAIN')
                throw error;
            Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 5);
        }
}

// `flag` is a shared Int32Array whose first number is the signal that asks the process to stop, or 0. `columns` is
// the width of the terminal of standard output, 0 if there is none.
export const disk = (flag, columns) => ({
    kind(name) {
        const status = fs.statSync(name);
        return status.isFile() ? FILE : status.isDirectory() ? FOLDER : OTHER;
    },
    open: (name) => fs.openSync(name, 'r'),
    create: (name) => fs.openSync(name, 'wx', 0o666),
    createOrEmpty: (name) => fs.openSync(name, 'w', 0o666),
    copyMode(file, name) {
        const status = fs.statSync(name, { throwIfNoEntry: false });
        if (status)
            fs.fchmodSync(file, status.mode & 0o777);
    },
    size(file) {
        const status = fs.fstatSync(file);
        return status.isFile() ? status.size : 0;
    },
    read: (file, bytes) => patiently(() => fs.readSync(file, bytes)),
    readerGone: false, // whether the reader of standard output has closed the pipe
    write(file, bytes) {
        try {
            return patiently(() => fs.writeSync(file, bytes));
        } catch (error) {
            this.readerGone ||= file === 1 && error.code === 'EPIPE';
            throw error;
        }
    },
    sync: (file) => fs.fsyncSync(file),
    close: (file) => fs.closeSync(file),
    follow(name) {
        for (let i = 0; i < MOST_LINKS; i++) {
            const status = fs.lstatSync(name, { throwIfNoEntry: false });
            if (!status?.isSymbolicLink())
                return name;
            const link = fs.readlinkSync(name), slash = name.lastIndexOf('/');
            name = path.isAbsolute(link) ? link : name.slice(0, slash + 1) + link;
        }
        throw Object.assign(new Error('too many links'), { code: 'ELOOP' });
    },
    replace: (from, to) => fs.renameSync(from, to),
    remove: (name) => fs.unlinkSync(name),
    makeFolder: (name) => fs.mkdirSync(name),
    removeFolder: (name) => fs.rmdirSync(name),
    list: (name) => fs.readdirSync(name),
    writable: (name) => fs.accessSync(name, fs.constants.W_OK | fs.constants.X_OK),
    process: () => process.pid,
    isTerminal: (stream) => tty.isatty(stream),
    columns: () => columns,
    signal: () => Atomics.load(flag, 0),
    progress() {},
});
