// The whole project for Godot 3 of docs/engines/godot.md runs as printed there: node godot-project.mjs KILN FOLDER
// The panorama is blue above and red below. A ball of smooth metal in the middle must show blue above and red below.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { readPng } from './png.mjs';

const [kiln, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const [section] = fs.readFileSync(path.join(here, '../../docs/engines/godot.md'), 'utf8').split(/^(?=## )/m)
    .filter((text) => text.startsWith('## A whole project for Godot 3\n'));
fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const files = [...section.matchAll(/[Tt]he file `(.*)`:\n\n```[a-z]*\n([^]*?)```$/gm)];
for (const [, name, text] of files)
    fs.writeFileSync(path.join(folder, name), text);
const texels = Array.from({ length: 32 }, (_, y) => Array(64).fill(y < 16 ? [24, 48, 192, 128] : [192, 48, 24, 128]));
fs.writeFileSync(path.join(folder, 'city.exr'), Buffer.concat([
    Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'), Buffer.from(texels.flat(2))]));
const [, words] = section.match(/^    kiln bake (.*)$/m);
execFileSync(kiln, ['bake', '-q', ...words.split(' ')], { cwd: folder });

// A picture of the window is taken by a script beside the project's own.
fs.appendFileSync(path.join(folder, 'project.godot'), '\n[autoload]\n\nshot="*res://shot.gd"\n');
fs.writeFileSync(path.join(folder, 'shot.gd'), `extends Node
var frames = 0
func _process(_seconds):
\tframes += 1
\tif frames == 20:
\t\tvar image = get_viewport().get_texture().get_data()
\t\timage.flip_y()
\t\timage.save_png("res://shot.png")
\t\tget_tree().quit()
`);
execFileSync('xvfb-run', ['-a', 'godot3', '--path', folder, '--resolution', '300x200', '--audio-driver', 'Dummy'], {
    stdio: 'ignore', timeout: 200000,
    env: { ...process.env, HOME: folder, XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder, XDG_CACHE_HOME: folder },
});
const at = readPng(path.join(folder, 'shot.png')), [above, below] = [at(150, 80), at(150, 120)];
console.log(`  the project of godot.md: ${above} above, ${below} below`);
if (files.length !== 3 || !(above[2] > above[0] + 40) || !(below[0] > below[2] + 40))
    throw new Error(`${files.length} files; the ball shows ${above} above and ${below} below`);
