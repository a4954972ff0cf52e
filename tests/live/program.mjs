// Starts `incise live` for a test, and ends it as a user would: with Ctrl+C.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';

const need = (/** @type {string} */ name) => {
    const value = process.env[name];
    if (!value) throw new Error(`the environment variable ${name} is not set`);
    return value;
};

export const program = need('INCISE_PROGRAM');
export const nodeModules = need('INCISE_NODE_MODULES');

const file = (/** @type {string} */ name) => fileURLToPath(new URL(name, import.meta.url));
/** A small body, so that the time of a test is that of the page; and one of the size that users have. */
export const block = file('soft_block.toml');
export const liver = file('../../data/scenarios/liver_live.toml');

/** Milliseconds after which what is waited for is given up. No test depends on it: it ends a test that has failed. */
export const patience = 240000;

/** @param {string} record file for what is done @param {string} [body] scenario */
export async function startLive(record, body = block) {
    const args = ['live', body, '--port', '0', '--no-open', '--record', record];
    const child = spawn(program, args, { stdio: ['ignore', 'ignore', 'pipe'] });
    let said = '';
    const address = await new Promise((found, failed) => {
        const late = setTimeout(() => failed(new Error(`no address in ${patience} ms: ${said}`)), patience);
        child.stderr.on('data', (data) => {
            said += data;
            const url = /http:\/\/\S+/.exec(said)?.[0];
            if (!url || !said.includes('\n')) return;
            clearTimeout(late);
            found(url);
        });
        child.on('error', failed);
        child.on('exit', (code) => failed(new Error(`the program ended with ${code}: ${said}`)));
    });
    return {
        /** @type {string} */
        address,
        said: () => said,
        /** Ends the program with SIGINT; returns its exit status. */
        stop: async () => {
            if (child.exitCode !== null || child.signalCode !== null) return child.exitCode;
            const ended = once(child, 'exit');
            child.kill('SIGINT');
            const [code] = await ended;
            return code;
        },
    };
}

/** Runs the program to its end. @param {string[]} args */
export async function run(args) {
    const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    let said = '';
    for (const stream of [child.stdout, child.stderr]) stream.on('data', (data) => (said += data));
    const [code] = await once(child, 'close');
    return { code, said };
}
