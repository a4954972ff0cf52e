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

    /** @param {string} name @param {string} unitInFiles "1" for plain numbers @param {{low: number, high: number}} range */
    show(name, unitInFiles, { low, high }) {
        const unit = unitInFiles === '1' ? '' : unitInFiles.replace('m3', 'm³').replace('m2', 'm²');
        element('legend').hidden = false;
        write('legend-name', name.replace(/_/g, ' '));
        write('legend-low', withUnit(low, unit));
        write('legend-middle', withUnit((low + high) / 2, unit));
        write('legend-high', withUnit(high, unit));
    }
}
