// Which of the package's two modules this JavaScript engine can run.

// A module of one function that returns a vector of 128 bits.
const VECTORS = Uint8Array.of(
    0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, // magic and version
    1, 5, 1, 0x60, 0, 1, 0x7b, // a type: nothing to v128
    3, 2, 1, 0, // a function of this type
    10, 10, 1, 8, 0, 0x41, 0, 0xfd, 15, 0xfd, 98, 11); // i32.const 0, i8x16.splat, i8x16.popcnt

export const hasVectors = () => WebAssembly.validate(VECTORS);
