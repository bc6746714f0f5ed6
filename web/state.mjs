// Converts the page's state to the part of the address behind # and back. Only values that differ
// from the defaults are written. Numbers out of range are clamped; unknown words are ignored.
export const number = (value, low, high, digits = 2) => ({ value, low, high, digits });
export const word = (value, ...words) => ({ value, words });
export const flag = (value) => ({ value, flag: true });
export const text = (value) => ({ value, text: true });

// Clamps or replaces a value until it is valid for its kind.
export function bounded(kind, value) {
    if (kind.flag)
        return Boolean(value);
    if (kind.words)
        return kind.words.includes(value) ? value : kind.value;
    if (kind.text)
        return String(value).slice(0, 200);
    return Number.isFinite(value) ? Math.min(Math.max(value, kind.low), kind.high) : kind.value;
}

function read(kind, given) {
    if (kind.flag)
        return given !== '0';
    return bounded(kind, kind.words || kind.text ? given
                         : given.trim() === ''   ? NaN
                                                 : Number(given));
}

function write(kind, value) {
    if (kind.flag)
        return value ? '1' : '0';
    return typeof value === 'number' ? String(Number(value.toFixed(kind.digits))) : value;
}

export function defaults(kinds) {
    return Object.fromEntries(Object.entries(kinds).map(([name, kind]) => [name, kind.value]));
}

export function fromHash(kinds, hash) {
    const state = defaults(kinds);
    for (const [name, given] of new URLSearchParams(hash.replace(/^#/, '')))
        if (Object.hasOwn(kinds, name))
            state[name] = read(kinds[name], given);
    return state;
}

export function toHash(kinds, state) {
    const changed = new URLSearchParams();
    for (const [name, kind] of Object.entries(kinds))
        if (write(kind, state[name]) !== write(kind, kind.value))
            changed.set(name, write(kind, state[name]));
    const hash = changed.toString();
    return hash ? `#${hash}` : '';
}
