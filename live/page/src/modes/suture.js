// A thread through points of the surface. Clicks add points, Enter ties, the wheel tightens.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Mode } from './mode.js';

export class Suture extends Mode {
    /** Rest coordinates of the points so far. @type {number[][]} */
    points = [];
    wheelsWhenIdle = true;
    #lastClick = 0;

    /** @param {number} x @param {number} y @override */
    begin(x, y) {
        const now = performance.now();
        const again = now - this.#lastClick < 350;
        this.#lastClick = now;
        if (again && this.points.length >= 2) {
            this.tie();
            return;
        }
        const hit = this.bench.aim.pick(x, y);
        const rest = hit && this.bench.aim.tissue.restOfHit(hit);
        if (!rest) return;
        this.points.push(rest);
        this.bench.changed();
    }

    /** @override */
    end() {}

    /** Ties a thread through the points. Returns false if there are fewer than two. */
    tie() {
        if (this.points.length < 2) return false;
        this.bench.send({ do: 'sew', points: this.points, stiffness: this.bench.settings.stiffness });
        this.points = [];
        this.bench.changed();
        return true;
    }

    back() {
        if (!this.points.pop()) return false;
        this.bench.changed();
        return true;
    }

    forget() {
        this.points = [];
    }

    /** The thread that was tied last. */
    get last() {
        const tied = (this.bench.state()?.tools ?? []).filter((tool) => tool.kind === 'suture' && tool.present);
        return tied.length ? tied[tied.length - 1] : null;
    }

    /** Shortens (below 1) or lengthens the last thread. @param {number} factor */
    tighten(factor) {
        const { last } = this;
        if (!last) return false;
        this.bench.send({ do: 'tighten', name: last.name, factor });
        return true;
    }

    untie() {
        const { last } = this;
        if (last) this.bench.send({ do: 'untie', name: last.name });
        return Boolean(last);
    }

    /** @param {number} notches @override */
    deepen(notches) {
        return this.points.length === 0 && this.tighten(0.95 ** notches);
    }
}

/** @type {import('./mode.js').ModeFacts} */
export const suture = {
    name: 'suture',
    kind: 'suture',
    title: 'Suture',
    tip: 'click points, Enter ties',
    hint: 'Click points; Enter or a double click ties. Then the wheel tightens.',
    icon: '<path d="M4 15C6 6 15 3 20.5 8"/><path d="M4 15c-1 4 3 6 6 4s4-5 7-4 3 4 1.5 6"/><path d="m20.5 8-1-3.5M20.5 8 17 8.3"/>',
    suitable: () => ({ stiffness: 200 }),
    make: (bench) => new Suture(bench),
};
