// Engines show what kiln wrote for them: node prove.mjs KILN WRITE PANORAMA FOLDER ENGINE...
//
// ENGINE.mjs exports proofs: what prove() of rig.mjs takes, or { name, page, prepare(), check(files, draw, say) },
// with a title where the name is not enough.
// All are drawn in one browser, each page visited once for all its proofs, pages side by side, while kiln
// bakes. A fault names its engine and keeps no other from being proven.
import path from 'node:path';
import { HIDDEN, withBrowser } from '../web/browser.mjs';
import { makeFiles, makeSite, openEngine, prove } from './rig.mjs';

// A page that hangs is told by name, before ctest ends all.
const PATIENCE = 120000;
class Hangs extends Error {}
function inTime(work) {
    let timer;
    const late = new Promise((_, fail) => {
        timer = setTimeout(() => fail(new Hangs(`nothing is shown after ${PATIENCE / 1000} s`)), PATIENCE);
    });
    return Promise.race([work, late]).finally(() => clearTimeout(timer));
}

const folder = path.resolve(process.argv[5]);
makeSite(folder);
const pages = new Map();
for (const engine of process.argv.slice(6))
    for (const proof of (await import(`./${engine}.mjs`)).default) {
        const files = (proof.prepare ?? makeFiles)(proof);
        files.catch(() => {}); // is told where it is waited for
        pages.set(proof.page, [...pages.get(proof.page) ?? [], { ...proof, files }]);
    }

await withBrowser(folder, (visit, address) => Promise.all([...pages].map(([page, proofs]) => {
    let title = proofs.map((proof) => proof.name).join();
    return visit(async (browser, fault) => {
        browser.setDefaultTimeout(PATIENCE);
        const draw = await openEngine(browser, address, page);
        for (const proof of proofs) {
            title = proof.title ?? proof.name;
            const say = (line) => console.log(`  ${proof.title ?? proof.name}: ${line}`);
            try {
                const files = await proof.files;
                await inTime(proof.check ? proof.check(files, draw, say) : prove(proof, files, draw, say));
            } catch (error) {
                fault(error.stack);
                if (error instanceof Hangs)
                    return;
            }
        }
    }, () => `${title}: `);
})), HIDDEN);
