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
