// Keys: one for each button, and a cursor that moves the tool without a mouse.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** Pixels of the page that a short press of an arrow moves the cursor, and pixels in a second after that. */
const tap = 6;
const pace = 180;
const slow = 0.25;
/** Seconds until a key that is held down moves the cursor evenly. */
const wait = 0.2;

/** @type {Record<string, [number, number]>} */
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * @typedef {Object} Commands
 * @property {(index: number) => void} mode
 * @property {() => void} pause
 * @property {() => void} step
 * @property {() => void} undo
 * @property {() => void} reset
 * @property {(up: boolean) => void} speed
 * @property {() => void} section
 * @property {() => void} field
 * @property {() => void} fit
 * @property {() => void} help
 * @property {() => boolean} enter used
 * @property {() => boolean} back used
 * @property {() => void} escape
 * @property {(notches: number) => void} deepen
 * @property {(x: number, y: number) => boolean} moveCursor by pixels; used
 */

export class Keyboard {
    #commands;
    /** Arrows that are down, with the seconds since. @type {Map<string, number>} */
    #down = new Map();
    #shift = false;

    /** @param {Commands} commands @param {() => void} wake asks for a picture */
    constructor(commands, wake) {
        this.#commands = commands;
        addEventListener('keydown', (event) => {
            if (event.defaultPrevented || !this.#press(event)) return;
            event.preventDefault();
            wake();
        });
        addEventListener('keyup', (event) => this.#down.delete(event.key));
        addEventListener('blur', () => this.#down.clear());
    }

    /** True while arrows move the cursor. */
    get isMoving() {
        return this.#down.size > 0;
    }

    /** Moves the cursor while arrows are down. @param {number} seconds @returns {boolean} wants another picture */
    move(seconds) {
        let x = 0;
        let y = 0;
        for (const [key, since] of this.#down) {
            this.#down.set(key, since + seconds);
            if (since < wait) continue;
            x += arrows[key][0];
            y += arrows[key][1];
        }
        const by = pace * seconds * (this.#shift ? slow : 1);
        if (x || y) this.#commands.moveCursor(x * by, y * by);
        return this.isMoving;
    }

    /** @param {KeyboardEvent} event @returns {boolean} used */
    #press(event) {
        const { key } = event;
        const target = event.target instanceof HTMLElement ? event.target : document.body;
        this.#shift = event.shiftKey;
        if (target.closest('dialog[open]')) return false;
        const typing = target.matches('select, textarea, input:not([type="checkbox"], [type="range"])');
        const sliding = target.matches('input[type="range"], select');
        if (typing) return false;
        if (event.ctrlKey || event.metaKey || event.altKey) {
            if (key.toLowerCase() !== 'z' || event.altKey || event.shiftKey) return false;
            this.#commands.undo();
            return true;
        }
        // Enter and Space work the control that has the focus.
        const control = target.matches('button, a, input, select');
        if (key === 'Enter') return !control && this.#commands.enter();
        if (key === 'Backspace') return this.#commands.back();
        if (key in arrows) return !sliding && this.#arrow(event);
        if (key === 'PageDown' || key === 'PageUp') {
            if (sliding) return false;
            this.#commands.deepen(key === 'PageDown' ? 1 : -1);
            return true;
        }
        if (key === '+' || key === '=' || key === '-') {
            this.#commands.speed(key !== '-');
            return true;
        }
        if (event.repeat) return false;
        if (key === ' ') {
            if (control) return false;
            this.#commands.pause();
            return true;
        }
        if (/^[1-9]$/.test(key)) {
            this.#commands.mode(Number(key) - 1);
            return true;
        }
        /** @type {Record<string, () => void>} */
        const letters = {
            v: () => this.#commands.mode(0),
            '.': this.#commands.step,
            z: this.#commands.undo,
            r: this.#commands.reset,
            s: this.#commands.section,
            f: this.#commands.field,
            c: this.#commands.fit,
            h: this.#commands.help,
            '?': this.#commands.help,
            escape: this.#commands.escape,
        };
        const command = letters[key.toLowerCase()];
        command?.();
        return Boolean(command);
    }

    /** @param {KeyboardEvent} event */
    #arrow(event) {
        if (event.repeat) return true;
        const [x, y] = arrows[event.key];
        const by = tap * (event.shiftKey ? slow : 1);
        if (!this.#commands.moveCursor(x * by, y * by)) return false;
        this.#down.set(event.key, 0);
        return true;
    }
}
