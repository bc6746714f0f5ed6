// Engines show what kiln wrote for them: node prove.mjs KILN WRITE PANORAMA FOLDER ENGINE...
//
// ENGINE.mjs exports proofs: what prove() of rig.mjs takes, or { name, page, prepare(), check(files, draw, say) }.
// All are drawn in one browser, each page visited once for all its proofs, pages side by side, while kiln
// bakes. A fault names its engine and keeps no other from being proven.
import path from 'node:path';
import { withBrowser } from '../web/browser.mjs';
import { makeFiles, makeSite, openEngine, prove } from './rig.mjs';

// Nobody sees the pages, and they run no faster in processes of their own.
const FLAGS = ['--renderer-process-limit=1', '--disable-gpu-compositing'];

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
    let { name } = proofs[0];
    return visit(async (browser, fault) => {
        const draw = await openEngine(browser, address, page);
        for (const proof of proofs) {
            name = proof.name;
            const say = (line) => console.log(`  ${proof.name}: ${line}`);
            try {
                const files = await proof.files;
                await (proof.check ? proof.check(files, draw, say) : prove(proof, files, draw, say));
            } catch (error) {
                fault(error.stack);
            }
        }
    }, () => `${name}: `);
})), FLAGS);
