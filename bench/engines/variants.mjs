import path from 'node:path'; import fs from 'node:fs';
import * as models from '../../tests/engines/models.mjs';
import { makeSite, openEngine } from '../../tests/engines/rig.mjs';
import { withPage } from '../../tests/web/browser.mjs';
import { CELL, ROUGHNESS, VIEWS, errors, overAll, percent, truth } from './measure.mjs';
import { makePanorama, makeWays } from './ways.mjs';
const [bin, panoramas, folder] = process.argv.slice(2, 5).map((n) => path.resolve(n));
const variants = JSON.parse(process.argv[5]);
const NAMES = (process.argv[6] ?? 'courtyard,sunrise').split(',');
makeSite(folder);
for (const n of NAMES) makePanorama(bin, folder, path.join(panoramas, `${n}.exr`), `${n}.hdr`);
await withPage(folder, async (browser, address) => {
  browser.setDefaultTimeout(300000);
  for (const [key, words] of variants) for (const n of NAMES) {
    const base = Object.values(models).find((m) => m.name === key);
    const engine = { ...base, words: [...words, ...base.words ?? []], filtersNothing: true };
    const wanted = truth(bin, engine, path.join(folder, `${n}.hdr`));
    for (const { maker, make } of makeWays(bin, folder, ['--tune=none'])(engine)) {
      const file = await make(`${n}.hdr`);
      const draw = await openEngine(browser, address, engine.page);
      const rms = errors(await draw(file, VIEWS, ROUGHNESS, CELL, engine.asked), wanted);
      console.log(`${key} ${words.join(' ').padEnd(24)} ${n.padEnd(9)} ${maker.padEnd(16)}${[.1,.2,.3,.5,.7,1].map((r) => percent(rms[ROUGHNESS.indexOf(r)])).join('')} ${percent(overAll(rms))}${percent(Math.max(...rms))}`);
    } } });
