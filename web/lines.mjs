// The lines of code by which an engine loads kiln's files, out of the engine's page of the
// documentation (docs/engines), which the build copies to engines/NAME.md.

// The first block of code after `from` that contains `word`.
function block(text, from, word = '') {
    for (const found of text.slice(from).matchAll(/^```[a-z]*\n([^]*?)\n```$/gm))
        if (found[1].includes(word))
            return found[1];
    return '';
}

// Numbered steps, where an engine has no code, without Markdown's marks.
const steps = (text) => (text.match(/^\d\. .*(\n {3}.*)*/gm) ?? []).join('\n').replace(/[*`]/g, '');

// The example that bakes files in a format for the engine `name`, or else in the default format.
const example = (text, name, format) => [`${name} --format ${format}`, name]
    .map((words) => text.match(new RegExp(`^    kiln bake \\S+ --for ${words} -o (\\S+)$`, 'm'))).find(Boolean);

// Takes three texts for the engine `name` and a format out of `text`, the engine's page of the documentation: the name
// of the file that the page's example bakes (the panorama of these examples is called city), the lines of code that
// load the file, and the lines that add lights. Each is empty if the page does not have it.
export function linesOf(text, name, format) {
    const { 1: output = '', index: at = -1 } = example(text, name, format) ?? {};
    const heading = '\n## Lights that were taken out\n', lights = text.indexOf(heading);
    return {
        output: output.replace(/^.*\//, ''),
        load: at < 0 ? '' : block(text, at, output) || steps(text.slice(at)),
        lights: lights < 0 ? '' : block(text, lights),
    };
}

// The lines with the file names of a panorama called `stem`, and of the lights' file. Modules of the npm
// package stand beside the files, as in the bundle.
export function named(lines, stem, lightsName) {
    return lines.replace(/\bcity\/city/g, stem).replace(/\bcity(?=[._'"])/g, stem).replaceAll('sun.json', lightsName)
        .replace(/'kiln-ibl\/([\w-]+)'/g, "'./$1.mjs'");
}
