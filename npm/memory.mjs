// The system of a command whose files lie in memory (host.mjs). In: files, the words of the command line, and what is
// told of the progress. Out: the files that were written, and the bytes of standard output and standard error. Every
// folder that a word or the name of a file leads through is there from the start.

const FILE = 1, FOLDER = 2;

const fail = (code) => {
    throw Object.assign(new Error(code), { code });
};

// A name without ".", ".." and empty parts: "./a//b", "/a/b" and "../a/c/../b" are "a/b". No folder lies above the
// files in memory, and a caller who writes files by their names writes them into his own folder.
export function plain(name) {
    const parts = [];
    for (const part of name.split('/'))
        if (part === '..')
            parts.pop();
        else if (part && part !== '.')
            parts.push(part);
    return parts.join('/');
}

const folderOf = (name) => name.slice(0, Math.max(0, name.lastIndexOf('/')));

// Bytes that are appended to; the room doubles.
class Growing {
    bytes = new Uint8Array(1 << 12);
    size = 0;

    append(bytes) {
        if (this.size + bytes.length > this.bytes.length) {
            const larger = new Uint8Array(Math.max(2 * this.bytes.length, this.size + bytes.length));
            larger.set(this.bytes.subarray(0, this.size));
            this.bytes = larger;
        }
        this.bytes.set(bytes, this.size);
        this.size += bytes.length;
        return bytes.length;
    }

    take() {
        return this.bytes.slice(0, this.size);
    }
}

export class MemorySystem {
    output = new Growing();
    errors = new Growing();
    #files = new Map(); // name to bytes, or to what is still written
    #folders = new Set(['']);
    #given = new Set();
    #open = new Map(); // descriptor to { bytes, at } or { growing }
    #next = 3;
    #input;

    constructor(files, words, input, progress) {
        this.progress = progress;
        this.#input = { bytes: input ?? new Uint8Array(0), at: 0 };
        for (const { name, bytes } of files) {
            this.#files.set(plain(name), bytes);
            this.#given.add(plain(name));
        }
        for (const path of [...this.#given, ...words.map((word) => word.replace(/^--[^=]*=/, ''))])
            for (let folder = folderOf(path); folder; folder = folderOf(folder))
                this.#folders.add(plain(folder));
    }

    // The files that are not those that were given, in the order in which they appeared.
    written() {
        return [...this.#files].filter(([name]) => !this.#given.has(name))
            .map(([name, file]) => ({ name, bytes: file instanceof Growing ? file.take() : file }));
    }

    #add(name, file) {
        if (!this.#folders.has(folderOf(name)))
            fail('ENOENT');
        this.#files.delete(name);
        this.#given.delete(name);
        this.#files.set(name, file);
    }

    kind(name) {
        name = plain(name);
        return this.#files.has(name) ? FILE : this.#folders.has(name) ? FOLDER : fail('ENOENT');
    }

    open(name) {
        const file = this.#files.get(plain(name)) ?? fail('ENOENT');
        this.#open.set(this.#next, { bytes: file instanceof Growing ? file.take() : file, at: 0 });
        return this.#next++;
    }

    create(name) {
        if (this.#files.has(plain(name)))
            fail('EEXIST');
        return this.createOrEmpty(name);
    }

    createOrEmpty(name) {
        const growing = new Growing();
        this.#add(plain(name), growing);
        this.#open.set(this.#next, { growing });
        return this.#next++;
    }

    size(file) {
        return this.#open.get(file)?.bytes?.length ?? 0;
    }

    read(file, bytes) {
        const from = file === 0 ? this.#input : this.#open.get(file) ?? fail('EBADF');
        const part = from.bytes.subarray(from.at, from.at + bytes.length);
        bytes.set(part);
        from.at += part.length;
        return part.length;
    }

    write(file, bytes) {
        const streams = [undefined, this.output, this.errors];
        return (streams[file] ?? this.#open.get(file)?.growing ?? fail('EBADF')).append(bytes);
    }

    close(file) {
        this.#open.delete(file);
    }

    replace(from, to) {
        const file = this.#files.get(plain(from)) ?? fail('ENOENT');
        this.#files.delete(plain(from));
        this.#add(plain(to), file);
    }

    remove(name) {
        if (!this.#files.delete(plain(name)))
            fail('ENOENT');
    }

    makeFolder(name) {
        name = plain(name);
        if (this.#files.has(name) || this.#folders.has(name))
            fail('EEXIST');
        if (!this.#folders.has(folderOf(name)))
            fail('ENOENT');
        this.#folders.add(name);
    }

    removeFolder(name) {
        if (this.list(name).length)
            fail('ENOTEMPTY');
        this.#folders.delete(plain(name));
    }

    list(name) {
        name = plain(name);
        if (!this.#folders.has(name))
            fail('ENOENT');
        return [...this.#files.keys(), ...this.#folders].filter((each) => each && folderOf(each) === name)
            .map((each) => each.slice(name ? name.length + 1 : 0));
    }

    follow(name) {
        return name;
    }

    copyMode() {}
    sync() {}
    writable() {}

    process() {
        return 1;
    }

    isTerminal() {
        return false;
    }

    columns() {
        return 0;
    }

    signal() {
        return 0;
    }
}
