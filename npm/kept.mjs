// Textures that several components share, kept as long as one of them is mounted.
const GRACE = 10000; // milliseconds until a texture that no component has mounted with is disposed

export class Kept {
    #entries = new Map(); // key to { promise, texture, error, users }

    // The entry of a key, whose texture is made by start() where there is none. Throws the promise of a texture that
    // is not there yet, as React's <Suspense> expects, and the error of one that could not be made.
    read(key, start) {
        const entry = this.#entries.get(key) ?? this.#add(key, start);
        if (entry.error) {
            this.#entries.delete(key); // the next attempt starts anew
            throw entry.error;
        }
        if (!entry.texture)
            throw entry.promise;
        return entry;
    }

    #add(key, start) {
        const entry = { users: 0 };
        // A component that was unmounted while the texture loaded never uses it.
        const loaded = (texture) => {
            entry.texture = texture;
            this.#disposeLater(key, entry, GRACE);
        };
        entry.promise = start().then(loaded, (error) => { entry.error = error; });
        this.#entries.set(key, entry);
        return entry;
    }

    // Counts a component that uses the texture. Returns the function that ends the use.
    use(key, entry) {
        entry.users++;
        // A component that is mounted anew at once, as React's strict mode does, keeps the texture.
        return () => {
            entry.users--;
            this.#disposeLater(key, entry, 0);
        };
    }

    #disposeLater(key, entry, milliseconds) {
        const timer = setTimeout(() => {
            if (entry.users > 0)
                return;
            if (this.#entries.get(key) === entry)
                this.#entries.delete(key);
            entry.texture.dispose();
        }, milliseconds);
        timer.unref?.(); // in Node, does not keep the process
    }
}
