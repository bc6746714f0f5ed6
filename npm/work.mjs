// One command in a worker, in memory. In: a message with the compiled module, the words, the files and standard input.
// Out: messages of progress, and one with the exit code and all that the command wrote; or one with an error.
import { run } from './host.mjs';
import { MemorySystem } from './memory.mjs';

const STEP = 0.01; // of progress, which is told for a new stage and after each such step

// Returns a function that passes progress on to `tell`, without what says nothing new.
function sparing(tell) {
    let last = [0, ''];
    return (fraction, stage) => {
        if (stage === last[1] && fraction < last[0] + STEP)
            return;
        last = [fraction, stage];
        tell(last);
    };
}

// Calls post(message, buffers that change hands).
export function work({ module, words, files, input }, post) {
    const system = new MemorySystem(files, words, input, sparing((progress) => post({ progress }, [])));
    try {
        const code = run(module, words, system);
        const done = {
            code,
            stdout: system.output.take(),
            stderr: new TextDecoder().decode(system.errors.take()),
            files: system.written(),
        };
        post({ done }, [done.stdout.buffer, ...done.files.map(({ bytes }) => bytes.buffer)]);
    } catch (error) {
        post({ error: `kiln-ibl: the command broke down: ${error.message}` }, []);
    }
}
