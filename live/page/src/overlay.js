// The scale bar and the small axes, which follow the camera.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { round } from './format.js';

/** The greatest of 1, 2, 5 times a power of ten that is not above the value. @param {number} value */
export function roundDown(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    const first = value / power;
    return (first >= 5 ? 5 : first >= 2 ? 2 : 1) * power;
}

/** Pixels. On small pages other panels are near. */
const longestBar = (/** @type {number} */ width) => (width < 900 ? 60 : 110);

export class Overlay {
    #bar = /** @type {HTMLElement} */ (document.getElementById('scale-bar'));
    #text = /** @type {HTMLElement} */ (document.getElementById('scale-text'));
    #axes = [...document.querySelectorAll('#axes g')];
    #shown = '';

    /** @param {import('./scene.js').Scene} scene */
    update(scene) {
        const metres = roundDown(longestBar(scene.stage.clientWidth) * scene.metresPerPixel);
        const width = metres / scene.metresPerPixel;
        const turned = ['x', 'y', 'z'].map((axis) => {
            const end = new Vector3(Number(axis === 'x'), Number(axis === 'y'), Number(axis === 'z'));
            end.transformDirection(scene.camera.matrixWorldInverse);
            return { axis, x: end.x, y: -end.y, z: end.z };
        });
        const key = [width, ...turned.flatMap(({ x, y }) => [x, y])].map((value) => value.toFixed(2)).join();
        if (key === this.#shown) return;
        this.#shown = key;
        this.#bar.style.width = `${width.toFixed(1)}px`;
        this.#text.textContent = round(metres, 'm');
        for (const { axis, x, y } of turned) {
            const group = this.#axes.find((part) => part.getAttribute('data-axis') === axis);
            const [line, text] = group?.children ?? [];
            line?.setAttribute('x2', (18 * x).toFixed(2));
            line?.setAttribute('y2', (18 * y).toFixed(2));
            text?.setAttribute('x', (25 * x).toFixed(2));
            text?.setAttribute('y', (25 * y).toFixed(2));
        }
        // The axis that points at the viewer is drawn last.
        turned.sort((a, b) => a.z - b.z);
        for (const { axis } of turned) {
            const group = this.#axes.find((part) => part.getAttribute('data-axis') === axis);
            if (group) group.parentElement?.append(group);
        }
    }
}
