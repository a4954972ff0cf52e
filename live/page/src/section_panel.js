// The controls of the section plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { element, input, write } from './dom.js';

const degree = Math.PI / 180;

export class SectionPanel {
    #section;
    #changed;

    /**
     * @param {import('./section.js').Section} section
     * @param {() => Vector3} viewDirection
     * @param {() => void} changed
     */
    constructor(section, viewDirection, changed) {
        this.#section = section;
        this.#changed = changed;
        input('section').onchange = () => this.toggle(input('section').checked);
        for (const id of ['turn', 'tilt', 'offset']) input(id).oninput = () => this.#read();
        /** @type {Record<string, () => Vector3>} */
        const directions = {
            x: () => new Vector3(1, 0, 0),
            y: () => new Vector3(0, 1, 0),
            z: () => new Vector3(0, 0, -1),
            view: viewDirection,
            flip: () => section.direction.clone().negate(),
        };
        for (const one of document.querySelectorAll('[data-direction]'))
            if (one instanceof HTMLElement)
                one.onclick = () => {
                    const name = one.dataset.direction ?? 'y';
                    if (name === 'flip') section.offset = 1 - section.offset;
                    this.#turnTo(directions[name]());
                };
        this.#turnTo(section.direction);
    }

    /** @param {boolean} [on] */
    toggle(on = !this.#section.on) {
        this.#section.on = on;
        input('section').checked = on;
        element('section-settings').hidden = !on;
        this.#changed();
    }

    /** @param {Vector3} direction */
    #turnTo(direction) {
        // At the poles the turn is free; it stays where it is.
        const flat = Math.hypot(direction.x, direction.y);
        if (flat > 1e-6) input('turn').value = String(Math.round(Math.atan2(direction.x, direction.y) / degree));
        input('tilt').value = String(Math.round(Math.atan2(direction.z, flat) / degree));
        input('offset').value = String(this.#section.offset);
        this.#section.direction.copy(direction);
        this.#write();
        this.#changed();
    }

    #read() {
        const turn = Number(input('turn').value) * degree;
        const tilt = Number(input('tilt').value) * degree;
        this.#section.direction.set(Math.sin(turn) * Math.cos(tilt), Math.cos(turn) * Math.cos(tilt), Math.sin(tilt));
        this.#section.offset = Number(input('offset').value);
        this.#write();
        this.#changed();
    }

    #write() {
        write('turn-value', `${input('turn').value}°`);
        write('tilt-value', `${input('tilt').value}°`);
        write('offset-value', `${Math.round(100 * this.#section.offset)} %`);
    }
}
