// A blade that is drawn over the surface. It goes on beside the body, so that a stroke parts the edge.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { poseOf } from '../hand.js';
import { Mode } from './mode.js';

/** Toughness of soft tissue that the blade feels, J/m^2. */
const toughness = 160;
/** Part of a new direction that a sample of the pointer takes over. */
const follow = 0.2;

export class Scalpel extends Mode {
    /** The last point on the body in this stroke. @type {Vector3|null} */
    #anchor = null;
    /** @type {Vector3|null} */
    #into = null;
    /** Shift along the blade by the wheel; the edge itself is fixed while it is held. */
    #shift = 0;
    #x = 0;
    #y = 0;
    #moved = false;

    /** @returns {import('../types.js').ToolDefinition} */
    #definition() {
        const { settings } = this.bench;
        const size = this.bench.diagonal();
        const edge = settings.through
            ? [[0, 0, size], [0, 0, -2 * size]]
            : [[0, 0, Math.max(settings.depth, 0.03 * size)], [0, 0, -settings.depth]];
        return { kind: 'blade', edge, ...(settings.resistance ? { toughness } : {}) };
    }

    /** @param {number} x @param {number} y */
    #aim(x, y) {
        const { aim, settings } = this.bench;
        const hit = aim.pick(x, y);
        if (hit) this.#anchor = hit.point.clone();
        const at = hit?.point ?? (this.#anchor ? aim.across(x, y, this.#anchor) : aim.beside(x, y));
        const wanted = settings.through || !hit ? null : aim.into(hit, x, y);
        if (settings.through) this.#into = aim.view(x, y);
        else if (!this.#into) this.#into = wanted ?? aim.view(x, y);
        else if (wanted) this.#into.lerp(wanted, follow).normalize();
        return poseOf(at.addScaledVector(this.#into, this.#shift), this.#into);
    }

    /** @param {number} x @param {number} y @override */
    begin(x, y) {
        this.#anchor = this.#into = null;
        this.#shift = 0;
        this.#moved = false;
        [this.#x, this.#y] = [x, y];
        this.bench.hand.take(this.#definition(), this.#aim(x, y));
    }

    /** @param {number} x @param {number} y @override */
    move(x, y) {
        [this.#x, this.#y] = [x, y];
        this.#moved = true;
    }

    /** @override */
    step() {
        if (this.#moved) this.bench.hand.move(this.#aim(this.#x, this.#y));
        this.#moved = false;
        return false;
    }

    /** @param {number} notches @override */
    deepen(notches) {
        const { settings, hand } = this.bench;
        if (settings.through) return !hand.isEmpty;
        const by = (notches * settings.depth) / 10;
        if (hand.isEmpty) {
            settings.depth = Math.max(settings.depth + by, 1e-6);
            this.bench.changed();
            return true;
        }
        this.#shift += by;
        this.#moved = true;
        return true;
    }

    /** How deep the tip of the blade in the hand is. */
    get depth() {
        return this.bench.settings.depth + (this.bench.hand.isEmpty ? 0 : this.#shift);
    }

    /** @override */
    end() {
        this.step();
        super.end();
        this.#shift = 0;
        this.bench.changed();
    }

    /** @param {number} x @param {number} y @override */
    preview(x, y) {
        const { aim, settings } = this.bench;
        const hit = aim.pick(x, y);
        if (!hit) return null;
        const into = settings.through ? aim.view(x, y) : aim.into(hit, x, y);
        return { tool: this.#definition(), pose: poseOf(hit.point, into) };
    }
}

/** @type {import('./mode.js').ModeFacts} */
export const scalpel = {
    name: 'scalpel',
    kind: 'blade',
    title: 'Scalpel',
    tip: 'drag to cut',
    hint: 'Drag to cut. The wheel moves the blade in and out. A stroke over the edge parts the body.',
    icon: '<path d="m20.5 3.5-7.8 7.800M21 6.500l-7 7-2.8-2.6"/><path d="m11.2 10.9 2.8 2.600c-1.5 3.5-5 6-10.5 7 1-4.5 4-8 7.7-9.600z"/>',
    sliders: [
        { id: 'depth', label: 'Depth', says: 'Depth of the cut', least: 0.3, most: 0.35 },
    ],
    suitable: (element, _diagonal, touches) => ({ depth: 1.5 * element, through: false, resistance: touches }),
    make: (bench) => new Scalpel(bench),
};
