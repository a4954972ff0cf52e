// Bundles the page into dist/: four files that `incise live` serves, and that name nothing else.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, 'dist');
// Whoever has the page has the licence of what is in it.
const licence = readFileSync(join(here, 'node_modules', 'three', 'LICENSE'), 'utf8').trim();
rmSync(dist, { recursive: true, force: true });
mkdirSync(dist);
await build({
    entryPoints: [join(here, 'src', 'main.js'), join(here, 'style.css')],
    entryNames: '[name]',
    outdir: dist,
    bundle: true,
    minify: true,
    format: 'esm',
    target: ['chrome110', 'firefox110', 'safari16'],
    legalComments: 'inline',
    banner: { js: `/*! This file has parts of three.js (https://threejs.org):\n\n${licence}\n*/` },
    logLevel: 'warning',
});
copyFileSync(join(dist, 'main.js'), join(dist, 'app.js'));
rmSync(join(dist, 'main.js'));
for (const file of ['index.html', 'favicon.svg']) copyFileSync(join(here, file), join(dist, file));
console.log(readdirSync(dist).sort().join(' '));
