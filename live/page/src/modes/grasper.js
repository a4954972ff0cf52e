// Jaws that close where the drag begins, and then move in the plane across the view.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { poseOf } from '../hand.js';
import { Mode } from './mode.js';

export class Grasper extends Mode {
    /** Where the jaws closed. @type {Vector3|null} */
    #grip = null;
    #into = new Vector3(0, 0, -1);
    #shift = 0;
    #x = 0;
    #y = 0;

    /** @returns {import('../types.js').ToolDefinition} */
    #definition() {
        return { kind: 'grasper', shape: { sphere: { radius: this.bench.settings.grip } } };
    }

    /** @param {number} x @param {number} y @override */
    begin(x, y) {
        const { aim, hand } = this.bench;
        const hit = aim.pick(x, y);
        this.#grip = null;
        if (!hit) return;
        [this.#x, this.#y] = [x, y];
        this.#shift = 0;
        this.#grip = hit.point.clone();
        this.#into = aim.into(hit, x, y);
        hand.take(this.#definition(), poseOf(this.#grip, this.#into));
        hand.close();
    }

    /** @param {number} x @param {number} y @override */
    move(x, y) {
        [this.#x, this.#y] = [x, y];
        if (!this.#grip || this.bench.hand.isEmpty) return;
        const { aim, hand } = this.bench;
        const at = aim.across(x, y, this.#grip).addScaledVector(aim.view(x, y), this.#shift);
        hand.move(poseOf(at, this.#into));
    }

    /** @param {number} notches @override */
    deepen(notches) {
        if (this.bench.hand.isEmpty) return false;
        this.#shift += notches * 0.01 * this.bench.diagonal();
        this.move(this.#x, this.#y);
        return true;
    }

    /** @override */
    end() {
        if (!this.bench.hand.isEmpty) {
            this.bench.hand.flush();
            this.bench.hand.open();
        }
        super.end();
        this.#grip = null;
    }

    /** @param {number} x @param {number} y @override */
    preview(x, y) {
        const { aim } = this.bench;
        const hit = aim.pick(x, y);
        return hit ? { tool: this.#definition(), pose: poseOf(hit.point, aim.into(hit, x, y)) } : null;
    }
}

/** @type {import('./mode.js').ModeFacts} */
export const grasper = {
    name: 'grasper',
    kind: 'grasper',
    title: 'Grasper',
    tip: 'drag to hold and pull',
    hint: 'Press to close the jaws, drag to pull. The wheel moves them along the view.',
    icon: '<path d="M21 3 14.5 9.5"/><circle cx="13.5" cy="10.5" r="1.5"/><path d="M12 10C7.5 9.5 4 12 3.5 17.500M14 12c.5 4.5-2 8-7.5 8.5"/>',
    sliders: [
        { id: 'grip', label: 'Radius', says: 'Radius of the grip', least: 0.5, most: 0.12 },
    ],
    suitable: (element, diagonal) => ({ grip: Math.max(1.5 * element, 0.02 * diagonal) }),
    make: (bench) => new Grasper(bench),
};
