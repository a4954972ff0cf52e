// The legend of the field that colours the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { mapColour } from './colours.js';
import { element, write } from './dom.js';
import { withUnit } from './format.js';


export class Legend {
    constructor() {
        const bar = /** @type {HTMLCanvasElement} */ (element('legend-bar'));
        const context = bar.getContext('2d');
        for (let i = 0; context && i < bar.width; ++i) {
            context.fillStyle = `rgb(${mapColour(i / (bar.width - 1)).map(Math.round).join(' ')})`;
            context.fillRect(i, 0, 1, 1);
        }
    }

    hide() {
        element('legend').hidden = true;
    }

    /** @param {string} name @param {string} unit @param {{low: number, high: number}} range */
    show(name, unit, { low, high }) {
        element('legend').hidden = false;
        write('legend-name', name.replace(/_/g, ' '));
        write('legend-low', withUnit(low, unit));
        write('legend-middle', withUnit((low + high) / 2, unit));
        write('legend-high', withUnit(high, unit));
    }
}
