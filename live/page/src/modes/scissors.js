// Scissors that close where the drag begins, while they are held.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Quaternion, Vector3 } from 'three';
import { poseOf } from '../hand.js';
import { Mode } from './mode.js';

/** Radians between the blades. */
const angle = 0.9;
/** Seconds until they are closed. */
const closingTime = 0.15;
/** Part of the blades that is outside when they close. */
const outside = 0.3;
/** Radians by which a notch of the wheel turns them about their axis. */
const notch = Math.PI / 12;

export class Scissors extends Mode {
    wheelsWhenIdle = true;
    /** Where they closed. @type {Vector3|null} */
    #point = null;
    #into = new Vector3(0, 0, -1);
    #turn = 0;
    /** Length of the blades, which stays while they are held. */
    #length = 0;
    /** The pointer is over the body: there the wheel turns them, elsewhere it zooms. */
    #isOver = false;

    /** @returns {import('../types.js').ToolDefinition} */
    #definition() {
        return { kind: 'scissors', length: this.#length, angle, closing_time: closingTime };
    }

    /** @param {Vector3} point of the surface @param {Vector3} into @returns {import('../types.js').Pose} */
    #pose(point, into) {
        const pose = poseOf(point.clone().addScaledVector(into, -outside * this.#length), into);
        const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), this.#turn);
        return { at: pose.at, rotation: new Quaternion().fromArray(pose.rotation).multiply(turn).toArray() };
    }

    /** @param {number} x @param {number} y @override */
    begin(x, y) {
        const { aim, hand } = this.bench;
        const hit = aim.pick(x, y);
        this.#point = null;
        if (!hit) return;
        this.#length = this.bench.settings.blades;
        this.#point = hit.point.clone();
        this.#into = aim.into(hit, x, y);
        hand.take(this.#definition(), this.#pose(this.#point, this.#into));
        hand.close();
    }

    /** @param {number} x @param {number} y @override */
    move(x, y) {
        if (!this.#point || this.bench.hand.isEmpty) return;
        this.bench.hand.move(this.#pose(this.bench.aim.across(x, y, this.#point), this.#into));
    }

    /** @param {number} notches @override */
    deepen(notches) {
        if (!this.bench.hand.isEmpty) return true;
        if (!this.#isOver) return false;
        this.#turn += notches * notch;
        this.bench.changed();
        return true;
    }

    /** @override */
    end() {
        super.end();
        this.#point = null;
    }

    /** @param {number} x @param {number} y @override */
    preview(x, y) {
        const { aim } = this.bench;
        const hit = aim.pick(x, y);
        this.#isOver = hit !== null;
        this.#length = this.bench.settings.blades;
        return hit ? { tool: this.#definition(), pose: this.#pose(hit.point, aim.into(hit, x, y)) } : null;
    }
}

/** @type {import('./mode.js').ModeFacts} */
export const scissors = {
    name: 'scissors',
    kind: 'scissors',
    title: 'Scissors',
    tip: 'hold to close and cut',
    hint: 'Hold until the blades have closed. The wheel turns them.',
    icon: '<circle cx="6.5" cy="17.5" r="3"/><circle cx="17.500" cy="17.5" r="3"/><path d="M8.500 15.300 18 3M15.500 15.300 6 3"/>',
    sliders: [{ id: 'blades', label: 'Blades', says: 'Length of the blades', least: 1, most: 0.4 }],
    suitable: (element, diagonal) => ({ blades: Math.max(4 * element, 0.15 * diagonal) }),
    make: (bench) => new Scissors(bench),
    draw: (tool, { ribbon, shaft, size }) => {
        const length = tool.length ?? 0;
        const across = length * Math.tan((tool.angle ?? angle) / 2);
        for (const side of [-1, 1]) {
            // The branches behind the pivot stand out of the body, and show how the blades lie.
            const edge = [[-0.9 * side * across, 0, 0.9 * length], [0, 0, 0], [side * across, 0, -length]];
            // Flat in their plane, and thick enough to be seen from behind.
            ribbon(edge, 0.12 * length, [side, 0, 0]);
            ribbon(edge, 0.06 * length, [0, side, 0]);
        }
        shaft(0.012 * size);
    },
    shown: ({ tool, closed }) => (closed ? { ...tool, angle: 0.06 } : tool),
};
