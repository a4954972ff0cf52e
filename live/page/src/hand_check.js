// Compares the tool in the hand of this page with what the states of the server say of it.
// States come one after the other, but late: a slow page still reads old ones long after it took a
// tool. So the names of tools count. Each take that succeeds brings a new name.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** How many states in a row, and milliseconds, tell if no name does. */
const afterRefusal = { states: 180, time: 3000 };
const atLast = { states: 600, time: 10000 };

/** @typedef {'agreed'|'waiting'|'gone'|'left'} Verdict gone: from the hand; left: in it by the server alone */

export class HandCheck {
    /** Takes that were sent, and those of them that states have shown. */
    #taken = 0;
    #shown = 0;
    #name = '';
    /** The order or state from which on the states count. */
    #since = 0;
    #states = 0;
    #refused = false;

    /** The server knows nothing of what was sent before. */
    connected() {
        this.#taken = this.#shown = 0;
        this.#name = '';
    }

    /** @param {unknown} what was ordered @param {number} now milliseconds */
    sent(what, now) {
        if (what === 'move') return;
        if (what === 'take') ++this.#taken;
        this.#refused = false;
        this.#restart(now);
    }

    /** True if the last take may have been refused: then the server knows of no tool to move. */
    get doubts() {
        return this.#refused && this.#shown < this.#taken;
    }

    /** The server refused an order, maybe the last take. @param {number} now milliseconds */
    refused(now) {
        if (this.#refused) return;
        this.#refused = true;
        this.#restart(now);
    }

    /**
     * @param {string} own name of the tool that the server holds for this page; empty without one
     * @param {boolean} holds this page has a tool in the hand
     * @param {number} now milliseconds
     * @returns {Verdict}
     */
    look(own, holds, now) {
        if (own && own !== this.#name) {
            this.#name = own;
            this.#shown = Math.min(this.#shown + 1, this.#taken);
        }
        ++this.#states;
        if ((own !== '') === holds) {
            // Takes that no state has shown were too short, or refused.
            if (!holds && this.#lasts(atLast, now)) this.#shown = this.#taken;
            if (holds) {
                this.#restart(now);
                this.#refused = false;
            }
            return 'agreed';
        }
        if (holds && this.#shown === this.#taken) return 'gone';
        if (!this.#lasts(this.#refused || !holds ? afterRefusal : atLast, now)) return 'waiting';
        this.#restart(now);
        if (!holds) return 'left';
        this.#shown = this.#taken;
        return 'gone';
    }

    /** @param {{states: number, time: number}} wait @param {number} now */
    #lasts(wait, now) {
        return this.#states > wait.states && now - this.#since > wait.time;
    }

    /** @param {number} now */
    #restart(now) {
        this.#since = now;
        this.#states = 0;
    }
}
