// A ball that is pressed into the surface: the probe, which pushes, and the burr, which removes.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { poseOf } from '../hand.js';
import { Mode } from './mode.js';

/** Seconds in which the ball goes to where the pointer is, so that it pushes rather than strikes. */
const ease = 0.12;

export class Ball extends Mode {
    #kind;
    #radius;
    #depth;
    /** @type {{point: Vector3, into: Vector3}|null} */
    #goal = null;
    /** @type {Vector3|null} */
    #at = null;
    /** @type {Vector3|null} */
    #into = null;

    /**
     * @param {import('./mode.js').Bench} bench
     * @param {'probe'|'carver'} kind
     * @param {'probe'|'burr'} radius the setting of the radius
     * @param {'press'|'bite'} depth the setting of the depth
     */
    constructor(bench, kind, radius, depth) {
        super(bench);
        this.#kind = kind;
        this.#radius = radius;
        this.#depth = depth;
    }

    /** @returns {import('../types.js').ToolDefinition} */
    #definition() {
        const shape = { sphere: { radius: this.bench.settings[this.#radius] } };
        return this.#kind === 'probe' ? { kind: 'probe', shape, friction: 0.1 } : { kind: this.#kind, shape };
    }

    /** The centre of a ball that lies `depth` deep in the surface. @param {Vector3} point @param {Vector3} into @param {number} depth */
    #centre(point, into, depth) {
        return point.clone().addScaledVector(into, depth - this.bench.settings[this.#radius]);
    }

    /** @param {number} x @param {number} y */
    #aim(x, y) {
        const { aim } = this.bench;
        const hit = aim.pick(x, y);
        if (hit) this.#goal = { point: hit.point, into: aim.into(hit, x, y) };
        else {
            const point = this.#goal ? aim.across(x, y, this.#goal.point) : aim.beside(x, y);
            this.#goal = { point, into: this.#goal?.into ?? aim.view(x, y) };
        }
    }

    /** @param {number} x @param {number} y @override */
    begin(x, y) {
        this.#goal = null;
        // The tissue gives way under the probe. Aiming at the surface as it was when the drag began
        // keeps the probe from sinking deeper with each movement of the pointer.
        if (this.#kind === 'probe') this.bench.aim.freeze();
        this.#aim(x, y);
        const { point, into } = /** @type {{point: Vector3, into: Vector3}} */ (/** @type {unknown} */ (this.#goal));
        this.#into = into.clone();
        this.#at = this.#centre(point, into, -0.02 * this.bench.settings[this.#radius]);
        this.bench.hand.take(this.#definition(), poseOf(this.#at, this.#into));
    }

    /** @param {number} x @param {number} y @override */
    move(x, y) {
        this.#aim(x, y);
    }

    /** @override */
    end() {
        this.bench.aim.thaw();
        super.end();
    }

    /** @param {number} seconds @override */
    step(seconds) {
        if (!this.#goal || !this.#at || !this.#into || this.bench.hand.isEmpty) return false;
        const part = 1 - Math.exp(-seconds / ease);
        this.#into.lerp(this.#goal.into, part).normalize();
        const goal = this.#centre(this.#goal.point, this.#goal.into, this.bench.settings[this.#depth]);
        const rest = this.#at.distanceTo(goal);
        if (rest < 1e-5 * this.bench.diagonal()) return false;
        this.#at.lerp(goal, part);
        this.bench.hand.move(poseOf(this.#at, this.#into));
        return true;
    }

    /** @param {number} notches @override */
    deepen(notches) {
        const { settings } = this.bench;
        settings[this.#depth] = Math.max(settings[this.#depth] + (notches * settings[this.#radius]) / 12, 0);
        this.bench.changed();
        return true;
    }

    /** @param {number} x @param {number} y @override */
    preview(x, y) {
        const hit = this.bench.aim.pick(x, y);
        if (!hit) return null;
        const into = this.bench.aim.into(hit, x, y);
        return { tool: this.#definition(), pose: poseOf(this.#centre(hit.point, into, 0), into) };
    }
}

/** @type {import('./mode.js').ModeFacts} */
export const probe = {
    name: 'probe',
    kind: 'probe',
    title: 'Probe',
    tip: 'drag to press',
    hint: 'Drag to press. The wheel presses deeper.',
    icon: '<path d="M20.5 3.5 11 13"/><circle cx="8.5" cy="15.5" r="3.5"/><path d="M2.5 19.5c2 2.5 10 2.5 12 0"/>',
    sliders: [
        { id: 'probe', label: 'Radius', says: 'Radius of the probe', least: 0.5, most: 0.12 },
        { id: 'press', label: 'Press', says: 'How deep the probe presses', least: 0.1, most: 0.2 },
    ],
    suitable: (element, diagonal) => ({
        probe: Math.max(1.5 * element, 0.03 * diagonal),
        press: Math.max(1.2 * element, 0.02 * diagonal),
    }),
    make: (bench) => new Ball(bench, 'probe', 'probe', 'press'),
};

/** @type {import('./mode.js').ModeFacts} */
export const burr = {
    name: 'burr',
    kind: 'carver',
    title: 'Burr',
    tip: 'drag to remove tissue',
    hint: 'Drag to remove tissue. The wheel goes deeper.',
    icon: '<path d="M20.5 3.5 13 11"/><circle cx="9" cy="15" r="5"/><path d="M5.8 11.2 12.5 18.5M4.2 14.5l5.5 5.400M9 10l4.8 5"/>',
    sliders: [
        { id: 'burr', label: 'Radius', says: 'Radius of the burr', least: 0.7, most: 0.12 },
        { id: 'bite', label: 'Depth', says: 'Depth of the burr', least: 0.1, most: 0.15 },
    ],
    suitable: (element, diagonal) => {
        const burr = Math.max(1.5 * element, 0.02 * diagonal);
        return { burr, bite: 0.6 * burr };
    },
    make: (bench) => new Ball(bench, 'carver', 'burr', 'bite'),
};
