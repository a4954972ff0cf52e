// The cursor that stands for the pointer when the tool is moved with keys.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { element } from './dom.js';

export class Cursor {
    /** @type {{x: number, y: number}|null} */
    at = null;
    holds = false;

    /** Moves by pixels, from where the cursor is or from the middle. @param {number} x @param {number} y @param {{x: number, y: number}} start @param {DOMRect} bounds */
    move(x, y, start, bounds) {
        const from = this.at ?? start;
        this.at = {
            x: Math.min(Math.max(from.x + x, bounds.left), bounds.right),
            y: Math.min(Math.max(from.y + y, bounds.top), bounds.bottom),
        };
        this.show();
    }

    hide() {
        this.at = null;
        this.holds = false;
        this.show();
    }

    show() {
        const mark = element('cursor');
        mark.hidden = this.at === null;
        mark.classList.toggle('holds', this.holds);
        if (!this.at) return;
        mark.style.left = `${this.at.x}px`;
        mark.style.top = `${this.at.y}px`;
    }
}
