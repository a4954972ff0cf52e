// The live page in a browser, with the program behind it.
// The environment names the program (INCISE_PROGRAM) and the folder with playwright-core
// (INCISE_NODE_MODULES). The tests want both cores of a small machine, and wait as long as they must.
// SPDX-License-Identifier: LGPL-3.0-or-later
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, beforeEach, describe, test } from 'node:test';
import { HandCheck } from '../../live/page/src/hand_check.js';
import { between, beyond, launch, LivePage } from './page.mjs';
import { colourAt, countChanged, difference } from './picture.mjs';
import { block, liver, patience, run, startLive } from './program.mjs';

const folder = mkdtempSync(join(tmpdir(), 'incise-live-'));
/** Milliseconds for one test, and for a group of them: more than a single wait. */
const timeout = 2 * patience;
const whole = 20 * patience;
/** A block on a table, with a blade that stays above it. */
const onTable = `
[mesh]
box = { size = [0.1, 0.04, 0.02], cells = [5, 2, 1] }
[[material]]
density = 1000
young   = 10e3
poisson = 0.3
[dynamics]
end_time = 1
damping  = 20
[[constraint]]
where = { box = { min = [-1, -1, -1], max = [1, 1, 1] } }
fix   = "xyz"
[[tool]]
name = "knife"
kind = "blade"
edge = [[0, -0.01, 0], [0, 0.05, 0]]
path = [{ time = 0, at = [0.05, 0, 0.025] }, { time = 1000, at = [0.05, 0, 0.03] }]
[[obstacle]]
name  = "table"
shape = { half_space = { point = [0, 0, -0.001], normal = [0, 0, 1] } }
`;
/** @type {Awaited<ReturnType<typeof startLive>>} */
let session;
/** @type {any} */
let browser;

before(async () => {
    browser = await launch();
    session = await startLive(join(folder, 'record.jsonl'));
}, { timeout });

after(async () => {
    await browser?.close();
    await session?.stop();
    rmSync(folder, { recursive: true, force: true });
}, { timeout });

/** A shallow stroke of the scalpel across the middle of the body. @param {LivePage} live */
async function cutAcross(live) {
    const middle = await live.middle();
    const { from, to } = await live.chord(middle, 0);
    await live.press('2');
    const ends = [between(from, to, 0.3), between(from, to, 0.65)];
    await live.drag(ends[0], ends[1]);
    await live.until(() => window.incise.state().edits > 0 && !window.incise.state().tools.some((tool) => tool.mine && tool.present));
    return ends;
}

/** The box round a stroke. @param {import('./page.mjs').Point} from @param {import('./page.mjs').Point} to */
const around = (from, to) => ({
    left: Math.min(from.x, to.x) - 30,
    right: Math.max(from.x, to.x) + 30,
    top: Math.min(from.y, to.y) - 40,
    bottom: Math.max(from.y, to.y) + 40,
});

describe('the hand and the states', () => {
    /** What a check says of states that come 60 times a second. @param {HandCheck} check @param {string} own @param {boolean} holds @param {number[]} ticks */
    const looks = (check, own, holds, [from, to]) => {
        const verdicts = new Set();
        for (let tick = from; tick < to; ++tick) verdicts.add(check.look(own, holds, (1000 * tick) / 60));
        return [...verdicts];
    };

    test('OldStatesDoNotEmptyTheHand', () => {
        const check = new HandCheck();
        check.sent('take', 0);
        assert.deepEqual(looks(check, '', true, [0, 500]), ['waiting']);
        assert.deepEqual(looks(check, 'blade_1', true, [500, 510]), ['agreed']);
        check.sent('drop', 8500);
        check.sent('take', 8600);
        // States of the first stroke, of the time after it, and of the second.
        assert.deepEqual(looks(check, 'blade_1', true, [516, 600]), ['agreed']);
        assert.deepEqual(looks(check, '', true, [600, 800]), ['waiting']);
        assert.deepEqual(looks(check, 'blade_2', true, [800, 810]), ['agreed']);
    });

    test('ToolThatIsTakenAwayIsGoneAtOnce', () => {
        const check = new HandCheck();
        check.sent('take', 0);
        looks(check, 'blade_1', true, [0, 10]);
        assert.equal(check.look('', true, 200), 'gone');
    });

    test('RefusedTakeIsGoneAfterSomeSeconds', () => {
        const check = new HandCheck();
        check.sent('take', 0);
        check.refused(100);
        assert.ok(check.doubts);
        assert.deepEqual(looks(check, '', true, [6, 180]), ['waiting']);
        assert.ok(looks(check, '', true, [180, 250]).includes('gone'));
    });

    test('ToolThatOnlyTheServerHoldsIsLeft', () => {
        const check = new HandCheck();
        check.sent('take', 0);
        looks(check, 'probe_1', true, [0, 10]);
        check.sent('undo', 200);
        assert.deepEqual(looks(check, 'probe_1', false, [12, 180]), ['waiting']);
        assert.ok(looks(check, 'probe_1', false, [180, 250]).includes('left'));
    });
});

describe('loading', { timeout: whole }, () => {
    test('BodyComesWithoutErrors', { timeout }, async () => {
        const own = await startLive(join(folder, 'liver.jsonl'), liver);
        const live = await LivePage.open(browser, own.address);
        const icon = await live.ask(async () => (await fetch('/favicon.svg')).status);
        assert.equal(icon, 200);
        assert.deepEqual(live.errors, []);
        const picture = await live.picture();
        const { x, y } = await live.middle();
        const corner = colourAt(picture, 200, picture.height - 8);
        assert.ok(difference(colourAt(picture, x, y), corner) > 30, 'the body is not seen');
        await cutAcross(live);
        await live.close();
        await own.stop();
    });

    test('PageFollowsReload', { timeout }, async () => {
        const live = await LivePage.open(browser, session.address);
        await live.beginAnew();
        await cutAcross(live);
        const { edits } = await live.state();
        await live.page.reload();
        await live.ready();
        assert.equal((await live.state()).edits, edits);
        assert.ok(await live.ask(() => [...Array(window.incise.numVertices()).keys()].some((i) => window.incise.isCut(i))));
        assert.deepEqual(live.errors, []);
        await live.close();
    });
});

describe('hands', { timeout: whole }, () => {
    /** @type {LivePage} */
    let live;
    beforeEach(async () => {
        live = await LivePage.open(browser, session.address);
        await live.beginAnew();
    }, { timeout });
    afterEach(async () => {
        await live.close();
        assert.deepEqual(live.errors, []);
    });

    test('OrbitTurnsOnlyTheView', { timeout }, async () => {
        await live.press('Space');
        await live.until(() => window.incise.state().paused);
        const before = await live.picture();
        const sent = await live.ask(() => window.incise.ordersSent());
        const { x, y } = await live.middle();
        await live.page.mouse.move(x, y);
        await live.page.mouse.down({ button: 'right' });
        await live.page.mouse.move(x + 90, y + 30, { steps: 5 });
        await live.page.mouse.up({ button: 'right' });
        assert.ok(countChanged(before, await live.picture()) > 500);
        assert.equal(await live.ask(() => window.incise.ordersSent()), sent);
    });

    test('ShallowStrokeOpensOneBody', { timeout }, async () => {
        const before = await live.picture();
        const [from, to] = await cutAcross(live);
        const state = await live.state();
        assert.ok(state.edits > 0);
        assert.ok(state.cut_area > 0);
        assert.equal(state.components, 1);
        await live.press('1');
        const picture = await live.picture();
        assert.ok(countChanged(before, picture, around(from, to)) > 60, 'the cut is not seen');
        // The page writes its readings some time after it knows them.
        await live.until(() => Number(document.querySelector('#edits').textContent.replace(/\D/g, '')) > 0);
    });

    test('StrokeOverTheEdgePartsTheBody', { timeout }, async () => {
        await live.press('2');
        await live.page.check('#through');
        const { from, to } = await live.shortestChord(await live.middle());
        await live.drag(beyond(to, from, 20), beyond(from, to, 20), { steps: 24 });
        await live.until(() => window.incise.state().components === 2);
        await live.until(() => document.querySelector('#pieces').textContent === '2');
    });

    test('StrokeFromBesideCutsWhatItReaches', { timeout }, async () => {
        const middle = await live.middle();
        const { from } = await live.shortestChord(middle);
        await live.press('2');
        await live.drag(beyond(middle, from, 20), middle, { steps: 20 });
        await live.until(() => window.incise.state().edits > 0);
    });

    test('GrasperFeelsForceWhileItHolds', { timeout }, async () => {
        const middle = await live.middle();
        await live.press('4');
        await live.drag(middle, { x: middle.x + 20, y: middle.y - 60 }, { release: false });
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine && tool.held > 0 && Math.hypot(...tool.force) > 0));
        await live.until(() => /[1-9].* (m|µ)?N$/.test(document.getElementById('force')?.textContent ?? ''));
        await live.page.mouse.up();
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine && tool.present && Math.hypot(...tool.force) > 0));
    });

    test('ScissorsCutWhileTheyAreHeld', { timeout }, async () => {
        const middle = await live.middle();
        await live.press('7');
        assert.equal(await live.ask(() => document.getElementById('tool-title')?.textContent), 'Scissors');
        // Over the body the wheel turns them, and does not zoom.
        await live.page.mouse.move(middle.x, middle.y);
        const camera = await live.ask(() => window.incise.camera());
        await live.page.mouse.wheel(0, 100);
        await live.page.mouse.down();
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine && tool.kind === 'scissors' && tool.closed));
        await live.until(() => window.incise.state().edits > 0);
        await live.page.mouse.up();
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine && tool.present));
        const moved = (await live.ask(() => window.incise.camera())).map((value, i) => Math.abs(value - camera[i]));
        assert.ok(Math.max(...moved) < 1e-9);
        assert.ok((await live.state()).cut_area > 0);
    });

    test('BurrRemovesElementsAndShowsTheInside', { timeout }, async () => {
        const { elements } = await live.state();
        const middle = await live.middle();
        const before = await live.picture();
        await live.press('6');
        await live.drag(middle, { x: middle.x + 40, y: middle.y });
        await live.until((count) => window.incise.state().elements < count, elements);
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine && tool.present));
        // Where vertices of cut faces are in sight, there is another colour than that of the skin before.
        await live.press('1');
        const picture = await live.picture();
        const seen = await live.ask(() =>
            [...Array(window.incise.numVertices()).keys()]
                .filter((vertex) => window.incise.isCut(vertex))
                .map((vertex) => window.incise.vertexOnScreen(vertex))
                .filter((at) => at.visible)
        );
        assert.ok(seen.length >= 3, 'no cut face is in sight');
        const changed = seen.filter(({ x, y }) => {
            for (const dx of [-1, 0, 1])
                for (const dy of [-1, 0, 1])
                    if (difference(colourAt(picture, x + dx, y + dy), colourAt(before, x + dx, y + dy)) > 20) return true;
            return false;
        });
        assert.ok(changed.length >= seen.length / 4, `${changed.length} of ${seen.length} look cut`);
    });

    test('ProbePressesAndLetsGo', { timeout }, async () => {
        if (!(await live.ask(() => window.incise.hello().has_contact))) return;
        const middle = await live.middle();
        await live.press('3');
        await live.drag(middle, { x: middle.x + 3, y: middle.y }, { release: false });
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine && tool.kind === 'probe' && Math.hypot(...tool.force) > 0));
        await live.page.mouse.up();
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine && tool.present));
    });

    test('SutureTiesClickedPoints', { timeout }, async () => {
        const middle = await live.middle();
        const { from, to } = await live.chord(middle, 0);
        await live.press('5');
        for (const part of [0.4, 0.6]) {
            const at = between(from, to, part);
            await live.page.mouse.click(at.x, at.y);
        }
        await live.until(() => document.getElementById('thread')?.textContent === '2 points laid');
        await live.press('Enter');
        await live.until(() => window.incise.state().tools.some((tool) => tool.kind === 'suture'));
    });

    test('PauseHoldsTimeAndStepIsOneTick', { timeout }, async () => {
        await live.press('Space');
        await live.until(() => window.incise.state().paused);
        const { tick, time } = await live.state();
        const field = await live.ask(() => window.incise.hello().fields[1].name);
        // Another order is answered with a state; in it the time is the same.
        await live.send({ do: 'show', field });
        await live.until((name) => window.incise.state().field === name, field);
        assert.equal((await live.state()).tick, tick);
        assert.equal((await live.state()).time, time);
        await live.press('.');
        await live.until((before) => window.incise.state().tick !== before, tick);
        await live.send({ do: 'show', field: 'none' });
        await live.until(() => window.incise.state().field === 'none');
        assert.equal((await live.state()).tick, tick + 1);
        assert.equal(await live.page.getAttribute('#pause', 'aria-pressed'), 'true');
    });

    test('UndoRestoresElementsAndPicture', { timeout }, async () => {
        await live.press('2');
        const middle = await live.middle();
        const { from, to } = await live.chord(middle, 0);
        await live.press('Space');
        await live.until(() => window.incise.state().paused);
        const before = await live.picture();
        const { elements } = await live.state();
        const [first, last] = [between(from, to, 0.3), between(from, to, 0.65)];
        await live.page.mouse.move(first.x, first.y);
        await live.page.mouse.down();
        await live.press('Space');
        await live.until(() => !window.incise.state().paused);
        await live.movePressed(first, last, 12);
        await live.page.mouse.up();
        await live.until(() => window.incise.state().edits > 0);
        await live.press('Space');
        await live.until(() => window.incise.state().paused);
        const box = around(first, last);
        const cut = countChanged(before, await live.picture(), box);
        await live.press('z');
        await live.until((count) => window.incise.state().elements === count && window.incise.state().edits === 0, elements);
        await live.until(() => ![...Array(window.incise.numVertices()).keys()].some((vertex) => window.incise.isCut(vertex)));
        const undone = countChanged(before, await live.picture(), box);
        assert.ok(cut > 60, `the cut changed ${cut} pixels`);
        assert.ok(undone < cut / 10, `${undone} pixels differ after undo, ${cut} before`);
    });

    test('ResetAsksTwice', { timeout }, async () => {
        await cutAcross(live);
        const asks = () => live.ask(() => !document.getElementById('reset-ask')?.hidden);
        // Whatever the clock says: a page that has just opened asks, and one that is slow still does.
        await live.ask(() => (performance.now = () => 1000));
        await live.press('r');
        assert.ok(await asks(), 'the page does not ask');
        await live.press('2');
        assert.ok(!(await asks()), 'another key is no answer');
        await live.press('r');
        assert.ok((await live.state()).edits > 0);
        await live.ask(() => (performance.now = () => 1e9));
        const greeted = await live.ask(() => window.incise.greetings());
        await live.press('r');
        await live.until((before) => window.incise.greetings() > before && window.incise.state().edits === 0, greeted);
        assert.ok(!(await asks()));
    });

    test('KeyboardAloneCuts', { timeout }, async () => {
        await live.press('2');
        const target = await live.middle();
        await live.press('ArrowLeft');
        const cursor = () => live.ask(() => {
            const { left, top, width, height } = /** @type {Element} */ (document.getElementById('cursor')).getBoundingClientRect();
            return { x: left + width / 2, y: top + height / 2 };
        });
        // A key that a slow page sees down for long moves the cursor farther: so each looks where it is.
        for (const [axis, less, more] of [['x', 'ArrowLeft', 'ArrowRight'], ['y', 'ArrowUp', 'ArrowDown']])
            for (let way = 1; Math.abs((way = target[axis] - (await cursor())[axis])) > 6; ) await live.press(way < 0 ? less : more);
        await live.press('Enter');
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine && tool.present));
        for (let i = 0; i < 14; ++i) {
            const seen = await live.ask(() => window.incise.framesReceived());
            await live.press('ArrowRight');
            await live.until((count) => window.incise.framesReceived() > count, seen);
        }
        await live.press('Enter');
        await live.until(() => window.incise.state().edits > 0 && !window.incise.state().tools.some((tool) => tool.mine && tool.present));
    });

    test('ButtonsSayWhichToolIsChosen', { timeout }, async () => {
        const names = await live.ask(() =>
            [...document.querySelectorAll('[data-mode]')].filter((one) => !one.hidden).map((one) => one.dataset.mode)
        );
        assert.ok(names.length >= 4);
        for (const name of names) {
            await live.page.click(`[data-mode="${name}"]`);
            const pressed = await live.ask(() => [...document.querySelectorAll('[data-mode][aria-pressed="true"]')].map((one) => one.dataset.mode));
            assert.deepEqual(pressed, [name]);
        }
    });

    test('FieldColoursTheBody', { timeout }, async () => {
        await live.send({ do: 'pause', on: true });
        await live.until(() => window.incise.state().paused);
        const before = await live.picture();
        await live.press('f');
        await live.until(() => window.incise.state().field !== 'none' && !document.getElementById('legend')?.hidden);
        assert.ok(countChanged(before, await live.picture()) > 1000);
        const unit = await live.ask(() => window.incise.hello().fields.find((field) => field.name === window.incise.state().field).unit ?? '');
        assert.ok((await live.page.textContent('#legend-high')).endsWith(unit));
    });

    test('SectionPlaneClosesTheOuterShape', { timeout }, async () => {
        await live.send({ do: 'pause', on: true });
        await live.until(() => window.incise.state().paused);
        const before = await live.picture();
        const sent = await live.ask(() => window.incise.ordersSent());
        await live.press('s');
        const half = await live.picture();
        assert.ok(countChanged(before, half) > 1000);
        await live.page.click('[data-direction="x"]');
        assert.ok(countChanged(half, await live.picture()) > 1000);
        await live.press('s');
        assert.ok(countChanged(before, await live.picture()) < 1000);
        assert.equal(await live.ask(() => window.incise.ordersSent()), sent);
    });

    test('BodyFitsBetweenThePanels', { timeout }, async () => {
        // What a part of the page covers of the box round the body, and of the page.
        const hidden = () => live.ask(() => {
            const at = window.incise.corners();
            const [xs, ys] = [at.map(({ x }) => x), at.map(({ y }) => y)];
            const box = { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
            const outside = box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight;
            const covers = (/** @type {string} */ id) => {
                const part = /** @type {HTMLElement} */ (document.getElementById(id)).getBoundingClientRect();
                return part.right > box.left && part.left < box.right && part.bottom > box.top && part.top < box.bottom;
            };
            const parts = ['top', 'tools', 'readings', 'settings', 'transport', 'corner'].filter(covers);
            return { outside, parts, size: Math.max(box.right - box.left, box.bottom - box.top) };
        });
        for (const [width, height] of [[1280, 800], [760, 520], [480, 460], [375, 700]]) {
            await live.resize(width, height);
            const { outside, parts, size } = await hidden();
            assert.ok(!outside, `the body leaves a page of ${width} x ${height}`);
            assert.deepEqual(parts, [], `panels cover the body on ${width} x ${height}`);
            assert.ok(size > 120, `the body is ${size} pixels wide on ${width} x ${height}`);
        }
        await live.page.mouse.move(187, 300);
        for (let i = 0; i < 6; ++i) await live.page.mouse.wheel(0, -200);
        await live.until(() => {
            const xs = window.incise.corners().map(({ x }) => x);
            return Math.max(...xs) - Math.min(...xs) > innerWidth;
        });
        await live.press('c');
        await live.drawn();
        const { outside, parts } = await hidden();
        assert.ok(!outside && parts.length === 0, `C does not fit the body: ${parts}`);
    });

    test('StrokeOutlastsASlowPage', { timeout }, async () => {
        await live.ask(() => {
            const { send } = WebSocket.prototype;
            window.sent = [];
            WebSocket.prototype.send = function (data) {
                window.sent.push(JSON.parse(String(data)).do);
                send.call(this, data);
            };
        });
        await live.press('2');
        await live.press('ArrowLeft');
        // A busy page takes the tool, and only then reads the states that came meanwhile: hundreds.
        await live.send({ do: 'speed', factor: 4 });
        await live.until(() => window.incise.state().speed === 4);
        await live.ask(() => {
            const end = performance.now() + 1200;
            while (performance.now() < end);
            document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }));
        });
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine && tool.present));
        for (let i = 0; i < 3; ++i) {
            await live.press('ArrowRight');
            await live.ask(() => {
                const end = performance.now() + 300;
                while (performance.now() < end);
            });
        }
        const { tick } = await live.state();
        await live.until((before) => window.incise.state().tick > before + 30, tick);
        assert.ok((await live.state()).tools.some((tool) => tool.mine && tool.present), 'the tool is dropped');
        // The way to where the tool is dropped belongs to the stroke, though no picture comes between.
        await live.ask(() => {
            for (const key of ['ArrowRight', 'Enter'])
                document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
        });
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine));
        const sent = await live.ask(() => window.sent);
        assert.deepEqual(sent.slice(-2), ['move', 'drop']);
        for (const what of ['take', 'drop']) assert.equal(sent.filter((one) => one === what).length, 1, `${sent}`);
    });

    test('HandMovesBetweenPictures', { timeout }, async () => {
        const middle = await live.middle();
        await live.press('4');
        await live.page.mouse.move(middle.x, middle.y);
        await live.page.mouse.down();
        await live.until(() => window.incise.state().tools.some((tool) => tool.mine));
        // No picture comes any more; orders go nevertheless.
        const sent = await live.ask(() => {
            window.requestAnimationFrame = () => 0;
            return window.incise.ordersSent();
        });
        await live.page.mouse.move(middle.x + 10, middle.y - 20, { steps: 4 });
        await live.until((before) => window.incise.ordersSent() > before, sent, 50);
        await live.page.mouse.up();
        await live.until(() => !window.incise.state().tools.some((tool) => tool.mine), null, 50);
    });

    test('NarrowPageLeavesTheMiddleFree', { timeout }, async () => {
        await live.resize(375, 700);
        const look = () => live.ask(() =>
            ['top', 'readings', 'tools', 'transport', 'more', 'settings', 'corner', 'legend', 'strip']
                .map((id) => ({ id, part: /** @type {HTMLElement} */ (document.getElementById(id)) }))
                .filter(({ part }) => part.offsetParent !== null || getComputedStyle(part).position === 'fixed')
                .map(({ id, part }) => {
                    const { left, top, right, bottom } = part.getBoundingClientRect();
                    return { id, left, top, right, bottom };
                })
                .filter(({ left, right, top, bottom }) => right > left && bottom > top)
        );
        for (const open of [false, true]) {
            if (open) await live.page.click('#more');
            const parts = await look();
            for (const part of parts) {
                assert.ok(part.left >= 0 && part.right <= 375 && part.bottom <= 700, `${part.id} leaves the page`);
                const middle = part.left < 187 && part.right > 187 && part.top < 350 && part.bottom > 350;
                assert.ok(!middle, `${part.id} covers the middle`);
                for (const other of parts) {
                    if (part.id >= other.id) continue;
                    const apart = part.right <= other.left || other.right <= part.left || part.bottom <= other.top || other.bottom <= part.top;
                    assert.ok(apart, `${part.id} overlaps ${other.id}`);
                }
            }
        }
    });

    test('MessagesLeaveTheBodyToTheTools', { timeout }, async () => {
        await live.send({ do: 'pause', on: true });
        const other = await LivePage.open(browser, session.address);
        /** Makes the page show messages, and returns what of them lies over the picture. @param {LivePage} page @param {number} count */
        const told = async (page, [width, height], count) => {
            await page.resize(width, height);
            for (let i = 0; i < 4; ++i) await page.send({ do: `${i} ${'a wish that nobody knows '.repeat(20)}` });
            return page.until((least) => {
                if (document.querySelectorAll('.message').length < least) return false;
                const { left, top, right, bottom } = /** @type {Element} */ (document.querySelector('canvas')).getBoundingClientRect();
                const over = new Set();
                for (let x = left + 1; x < right; x += 16)
                    for (let y = top + 1; y < bottom; y += 16) {
                        const part = document.elementFromPoint(x, y)?.closest('.message, #notice');
                        if (part) over.add(part.className || part.id);
                    }
                return { over: [...over], notice: !document.getElementById('notice')?.hidden };
            }, count);
        };
        const [narrow, wide] = [[375, 700], [1000, 680]];
        for (const size of [narrow, wide]) assert.deepEqual(await told(other, size, 1), { over: [], notice: true }, `${size}`);
        await other.close();
        for (const size of [[760, 520], [480, 460], narrow, wide])
            assert.deepEqual(await told(live, size, 4), { over: [], notice: false }, `${size}`);
        // A stroke through what lies where messages would hide the body.
        const from = await live.ask(() => {
            const x = innerWidth / 2 - 90;
            for (let y = 100; y < 500; ++y) if (window.incise.pick(x, y)) return { x, y };
        });
        await live.send({ do: 'pause', on: false });
        await live.press('2');
        await live.drag(from, { x: from.x, y: from.y + 60 });
        await live.until(() => window.incise.state().edits > 0);
    });

    test('TwoPagesSeeOneBody', { timeout }, async () => {
        const other = await LivePage.open(browser, session.address);
        assert.equal(await other.ask(() => window.incise.hello().role), 'watcher');
        assert.equal(await live.ask(() => window.incise.hello().role), 'operator');
        assert.match(await other.page.textContent('#notice'), /Another page holds the tools/);
        await cutAcross(live);
        await live.send({ do: 'pause', on: true });
        await live.until(() => window.incise.state().paused);
        const { tick, edits, elements } = await live.state();
        await other.until((now) => window.incise.state().paused && window.incise.state().tick === now, tick);
        assert.deepEqual([edits, elements], await other.ask(() => [window.incise.state().edits, window.incise.state().elements]));
        const body = () => [window.incise.numVertices(), ...window.incise.vertex(5), ...window.incise.vertex(50)];
        await other.until((count) => window.incise.numVertices() === count, (await live.ask(body))[0]);
        await other.drawn();
        await live.drawn();
        assert.deepEqual(await live.ask(body), await other.ask(body));
        await other.page.click('#take-over');
        await other.until(() => window.incise.hello()?.role === 'operator');
        await live.until(() => window.incise.hello()?.role === 'watcher');
        assert.deepEqual(other.errors, []);
        await other.close();
    });

    test('HostileMessagesAreAnswered', { timeout }, async () => {
        const answers = await live.ask(async (longest) => {
            const pose = { at: [0, 0, 0], rotation: [0, 0, 0, 1] };
            const blade = { kind: 'blade', edge: [[0, 0, 0.01], [0, 0, -0.01]] };
            const texts = [
                'cut it',
                '{"do":',
                '[]',
                '7',
                '{}',
                '{"do":"explode"}',
                '{"do":7}',
                '{"do":"move","pose":{"at":[NaN,0,0],"rotation":[0,0,0,1]}}',
                '{"do":"take","tool":{"kind":"blade","edge":[[0,0,1e300],[0,0,-1e300]]},"pose":{"at":[1e300,0,0],"rotation":[0,0,0,1]}}',
                JSON.stringify({ do: 'take', tool: { kind: 'spoon' }, pose }),
                JSON.stringify({ do: 'take', tool: { ...blade, edge: [[0, 0, 0]] }, pose }),
                JSON.stringify({ do: 'take', tool: blade, pose: { at: 'here', rotation: null } }),
                JSON.stringify({ do: 'take', tool: blade }),
                JSON.stringify({ do: 'sew', points: 'all' }),
                JSON.stringify({ do: 'speed', factor: 'fast' }),
                JSON.stringify({ do: 'pause', on: 'yes' }),
                JSON.stringify({ do: 'show', field: 'nothing of the kind' }),
            ];
            const socket = new WebSocket(`ws://${location.host}/ws${location.search}`);
            /** @type {string[]} */
            const errors = [];
            /** @type {() => void} */
            let heard = () => {};
            socket.onmessage = ({ data }) => {
                if (typeof data !== 'string') return;
                const message = JSON.parse(data);
                if (message.type !== 'message' || message.level !== 'error') return;
                errors.push(message.text);
                heard();
            };
            await new Promise((opened) => (socket.onopen = opened));
            socket.send('{"do":"take_over"}');
            /** @type {[string, boolean][]} */
            const results = [];
            for (const text of texts) {
                const answered = new Promise((done) => {
                    heard = () => done(true);
                    setTimeout(() => done(false), longest);
                });
                socket.send(text);
                results.push([text.slice(0, 80), Boolean(await answered)]);
            }
            const refused = new Promise((done) => {
                heard = () => done(true);
                socket.onclose = () => done(true);
                setTimeout(() => done(false), longest);
            });
            socket.send(`{"do":"show","field":"${'x'.repeat(100 * 1024)}"}`);
            results.push(['100 KiB', Boolean(await refused)]);
            socket.close();
            return results;
        }, patience);
        assert.deepEqual(answers.filter(([, answered]) => !answered).map(([text]) => text), []);
        const { tick } = await live.state();
        await live.until((before) => window.incise.state().tick > before + 2, tick);
    });
});

describe('tools of a scenario', { timeout: whole }, () => {
    test('TableAndBladeAreDrawn', { timeout }, async (context) => {
        const body = join(folder, 'on_table.toml');
        writeFileSync(body, onTable);
        const own = await startLive(join(folder, 'on_table.jsonl'), body);
        try {
            const live = await LivePage.open(browser, own.address);
            if (!(await live.ask(() => window.incise.hello().scripted_tools))) return context.skip('an older program');
            await live.until(() => window.incise.scriptedDrawn().length === 2);
            await live.send({ do: 'pause', on: true });
            await live.until(() => window.incise.state().paused);
            assert.deepEqual((await live.ask(() => window.incise.scriptedDrawn())).sort(), ['knife', 'table']);
            const picture = await live.picture();
            // The table before the body is lighter than the ground, and the blade stands over the body.
            const [table, knife] = await live.ask(() => [
                window.incise.screenPointOf([0.05, -0.03, 0]),
                window.incise.screenPointOf(window.incise.state().scripted[0].pose.at),
            ]);
            const ground = colourAt(picture, 150, 60);
            assert.ok(difference(colourAt(picture, table.x, table.y), ground) > 12, 'the table is not seen');
            const near = [0, 2, 4, 6, 8].map((up) => colourAt(picture, knife.x, knife.y - up));
            assert.ok(near.some(([red, , blue]) => blue > 0.8 * red && red > 90), `no steel at the blade: ${near}`);
            assert.deepEqual(live.errors, []);
            await live.close();
        } finally {
            await own.stop();
        }
    });
});

describe('records', { timeout: whole }, () => {
    test('RecordOfASessionRunsAgain', { timeout }, async () => {
        const record = join(folder, 'again.jsonl');
        const own = await startLive(record);
        try {
            const live = await LivePage.open(browser, own.address);
            await cutAcross(live);
            const middle = await live.middle();
            await live.press('4');
            await live.drag(middle, { x: middle.x, y: middle.y - 30 });
            await live.until(() => !window.incise.state().tools.some((tool) => tool.mine && tool.present));
            const status = await own.stop();
            assert.ok([0, 130].includes(status), `ended with ${status}: ${own.said()}`);
            // The page says that the program is gone.
            await live.until(() => document.getElementById('status')?.dataset.status === 'lost');
            await live.close();
        } finally {
            await own.stop();
        }
        const again = await run(['run', block, '--replay', record, '--out', join(folder, 'again.out')]);
        assert.equal(again.code, 0, again.said);
    });
});
