// A browser with the live page in it. Points of the page come from the body itself, never from
// fixed pixels; what is waited for is a state, never a time.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { nodeModules, patience } from './program.mjs';
import { readPng } from './picture.mjs';

const { chromium } = createRequire(join(nodeModules, 'x.js'))('playwright-core');

export async function launch() {
    return chromium.launch({
        executablePath: process.env.INCISE_CHROMIUM ?? '/usr/bin/chromium',
        args: [
            '--use-gl=angle',
            '--use-angle=swiftshader',
            '--enable-unsafe-swiftshader',
            '--no-sandbox',
            // Files that a test puts in place of the program's have no address, and may not connect.
            ...(process.env.INCISE_PAGE ? ['--disable-features=LocalNetworkAccessChecks'] : []),
        ],
    });
}

/**
 * Takes the files of the page from a folder in place of the program, to test a page without building
 * the program anew.
 * @param {string|undefined} folder @param {any} page
 */
async function serveFrom(folder, page) {
    if (!folder) return;
    await page.route(/\/(app\.js|style\.css|favicon\.svg|)(\?.*)?$/, (/** @type {any} */ route) => {
        const name = new URL(route.request().url()).pathname.slice(1) || 'index.html';
        return route.fulfill({ path: join(folder, name) });
    });
}

/** @typedef {{x: number, y: number}} Point */

export class LivePage {
    /** Errors of the console and of scripts, and answers that are no success. @type {string[]} */
    errors = [];

    /** @param {any} page of playwright */
    constructor(page) {
        this.page = page;
        page.setDefaultTimeout(patience);
        page.on('console', (/** @type {any} */ message) => {
            if (message.type() === 'error') this.errors.push(message.text());
        });
        page.on('pageerror', (/** @type {Error} */ error) => this.errors.push(String(error)));
        page.on('response', (/** @type {any} */ answer) => {
            if (answer.status() >= 400) this.errors.push(`${answer.status()} ${answer.url()}`);
        });
    }

    /**
     * Opens the page in a tab of its own, and waits for the body.
     * @param {any} browser @param {string} address @param {{width: number, height: number}} [viewport]
     */
    static async open(browser, address, viewport = { width: 1000, height: 680 }) {
        const live = new LivePage(await browser.newPage({ viewport }));
        await serveFrom(process.env.INCISE_PAGE, live.page);
        await live.page.goto(`${address}#low`);
        await live.ready();
        return live;
    }

    async ready() {
        await this.until(() => window.incise?.framesReceived() > 1 && window.incise.numVertices() > 0 && window.incise.state() !== null && document.getElementById('loading')?.hidden);
    }

    /** Makes this page the operator of a body as it was in the beginning. */
    async beginAnew() {
        if ((await this.ask(() => window.incise.hello().role)) !== 'operator') await this.send({ do: 'take_over' });
        await this.until(() => window.incise.hello()?.role === 'operator');
        const greeted = await this.ask(() => window.incise.greetings());
        await this.send({ do: 'reset' });
        await this.until((before) => window.incise.greetings() > before && window.incise.state()?.edits === 0 && !window.incise.state().can_undo, greeted);
        await this.send({ do: 'pause', on: false });
        await this.send({ do: 'show', field: 'none' });
        await this.send({ do: 'speed', factor: 1 });
        await this.until(() => {
            const state = window.incise.state();
            return state && !state.paused && state.field === 'none' && state.speed === 1 && window.incise.hello();
        });
    }

    /** @param {Record<string, unknown>} order */
    send(order) {
        return this.page.evaluate((/** @type {any} */ what) => window.incise.send(what), order);
    }

    /** @param {Function} question @param {any} [argument] */
    ask(question, argument) {
        return this.page.evaluate(question, argument);
    }

    /**
     * Waits until a function of the page gives something true, and returns that.
     * @param {Function} condition @param {any} [argument]
     * @param {'raf'|number} [polling] number: milliseconds, for a page that draws nothing
     */
    async until(condition, argument, polling = 'raf') {
        try {
            return await (await this.page.waitForFunction(condition, argument, { polling })).jsonValue();
        } catch (error) {
            const facts = await this.ask(() => [window.incise?.mode(), window.incise?.state(), window.incise?.messages()]).catch(String);
            throw new Error(`${error}\nwaiting for ${condition}\nwith ${JSON.stringify(facts)}`);
        }
    }

    state() {
        return this.ask(() => window.incise.state());
    }

    /** @param {string} key */
    press(key) {
        return this.page.keyboard.press(key);
    }

    /** A picture of the page, with the pointer away from the body and all frames drawn. */
    async picture() {
        await this.page.mouse.move(2, 2);
        await this.drawn();
        return readPng(await this.page.screenshot());
    }

    /** Waits until the page has drawn what came so far. */
    async drawn() {
        await this.ask(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    }

    /** The visible vertex nearest to the middle of all that is visible. @returns {Promise<Point>} */
    middle() {
        return this.ask(() => {
            const { incise } = window;
            const seen = [];
            const stride = Math.max(1, Math.floor(incise.numVertices() / 300));
            for (let vertex = 0; vertex < incise.numVertices(); vertex += stride) {
                const at = incise.vertexOnScreen(vertex);
                if (at.visible && document.elementFromPoint(at.x, at.y)?.tagName === 'CANVAS') seen.push(at);
            }
            const mean = (/** @type {'x'|'y'} */ axis) => seen.reduce((sum, at) => sum + at[axis], 0) / seen.length;
            const centre = { x: mean('x'), y: mean('y') };
            const far = (/** @type {Point} */ at) => Math.hypot(at.x - centre.x, at.y - centre.y);
            const { x, y } = seen.reduce((best, at) => (far(at) < far(best) ? at : best));
            return { x, y };
        });
    }

    /**
     * The chord of the body through a point of the page: where a line in a direction leaves the body.
     * @param {Point} through @param {number} angle degrees
     * @returns {Promise<{from: Point, to: Point, clear: boolean, length: number}>} clear: the ends are on the
     *     picture with 25 pixels to spare
     */
    chord(through, angle) {
        return this.ask(
            ([{ x, y }, degrees]) => {
                const dx = Math.cos((degrees * Math.PI) / 180);
                const dy = Math.sin((degrees * Math.PI) / 180);
                const end = (/** @type {number} */ sign) => {
                    let last = 0;
                    for (let far = 0; far < 2000; far += 2) {
                        const at = [x + sign * far * dx, y + sign * far * dy];
                        if (at[0] < 0 || at[1] < 0 || at[0] > innerWidth || at[1] > innerHeight) break;
                        if (window.incise.pick(at[0], at[1])) last = far;
                    }
                    return sign * last;
                };
                const [first, second] = [end(-1), end(1)];
                const on = (/** @type {number} */ far) => ({ x: x + far * dx, y: y + far * dy });
                const clear = [first - 25, second + 25].every((far) => {
                    const at = on(far);
                    return document.elementFromPoint(at.x, at.y)?.tagName === 'CANVAS';
                });
                return { from: on(first), to: on(second), clear, length: second - first };
            },
            [through, angle]
        );
    }

    /** The shortest chord whose ends are clear of panels. @param {Point} through */
    async shortestChord(through) {
        let best = null;
        for (let angle = 0; angle < 180; angle += 15) {
            const chord = await this.chord(through, angle);
            if (chord.clear && (!best || chord.length < best.length)) best = chord;
        }
        if (!best) throw new Error('the body leaves no room for a stroke over its edge');
        return best;
    }

    /**
     * Drags with the left button. Each movement waits for a frame, as the hand of a person does.
     * @param {Point} from @param {Point} to @param {{steps?: number, release?: boolean}} [how]
     */
    async drag(from, to, { steps = 12, release = true } = {}) {
        await this.page.mouse.move(from.x, from.y);
        await this.page.mouse.down();
        await this.movePressed(from, to, steps);
        if (release) await this.page.mouse.up();
    }

    /** @param {Point} from @param {Point} to @param {number} steps */
    async movePressed(from, to, steps) {
        for (let i = 1; i <= steps; ++i) {
            const part = i / steps;
            const before = await this.ask(() => window.incise.framesReceived());
            await this.page.mouse.move(from.x + part * (to.x - from.x), from.y + part * (to.y - from.y));
            await this.until((count) => window.incise.framesReceived() > count || window.incise.state().paused, before);
        }
    }

    /** Gives the page another size, and waits until it is drawn in it. @param {number} width @param {number} height */
    async resize(width, height) {
        await this.page.setViewportSize({ width, height });
        await this.until(
            ([wanted, tall]) => {
                const { clientWidth } = /** @type {Element} */ (document.querySelector('canvas'));
                return innerWidth === wanted && innerHeight === tall && clientWidth === wanted;
            },
            [width, height]
        );
        await this.drawn();
    }

    close() {
        return this.page.close();
    }
}

/** A point between two. @param {Point} a @param {Point} b @param {number} part */
export const between = (a, b, part) => ({ x: a.x + part * (b.x - a.x), y: a.y + part * (b.y - a.y) });
/** A point beyond the second, on the line from the first. @param {Point} a @param {Point} b @param {number} pixels */
export const beyond = (a, b, pixels) => between(a, b, 1 + pixels / Math.hypot(b.x - a.x, b.y - a.y));
