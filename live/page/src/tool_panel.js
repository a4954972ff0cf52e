// The settings of the tool that is chosen.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { button, element, input, write } from './dom.js';
import { length, withUnit } from './format.js';
import { modeOf, modes } from './modes/index.js';

const sliders = modes.flatMap((mode) => (mode.sliders ?? []).map((slider) => ({ ...slider, mode: mode.name })));

/** Puts the sliders of all modes into the settings. */
function addSliders() {
    for (const { id, label, says, mode } of [...sliders].reverse()) {
        const row = document.createElement('label');
        row.dataset.for = mode;
        const value = document.createElement('output');
        value.id = `${id}-value`;
        const range = document.createElement('input');
        Object.assign(range, { id, type: 'range', min: '0', max: '100', step: '1' });
        range.setAttribute('aria-label', says);
        row.append(`${label} `, value, range);
        element('tool-hint').after(row);
    }
}

export class ToolPanel {
    #settings;
    #suture;
    #element = 0.005;
    #diagonal = 0.1;

    /**
     * @param {import('./settings.js').Settings} settings
     * @param {import('./modes/suture.js').Suture} suture
     */
    constructor(settings, suture) {
        this.#settings = settings;
        this.#suture = suture;
        addSliders();
        for (const { id, least, most } of sliders)
            input(id).oninput = () => {
                const [low, high] = this.#range(least, most);
                settings[id] = low * (high / low) ** (Number(input(id).value) / 100);
                this.show();
            };
        input('through').onchange = () => {
            settings.through = input('through').checked;
            this.show();
        };
        input('resistance').onchange = () => (settings.resistance = input('resistance').checked);
        button('tie').onclick = () => suture.tie();
        button('back').onclick = () => suture.back();
        button('tighten').onclick = () => suture.tighten(0.95);
        button('loosen').onclick = () => suture.tighten(1 / 0.95);
        button('untie').onclick = () => suture.untie();
    }

    /** @param {number} least in element sizes @param {number} most part of the body's diagonal */
    #range(least, most) {
        const low = least * this.#element;
        return [low, Math.max(most * this.#diagonal, 2 * low)];
    }

    /** @param {number} elementSize @param {number} diagonal @param {boolean} touches tools touch tissue */
    setBody(elementSize, diagonal, touches) {
        input('resistance').disabled = !touches;
        this.#element = elementSize;
        this.#diagonal = diagonal;
        this.show();
    }

    /** @param {string} mode */
    setMode(mode) {
        const { title, hint } = modeOf(mode);
        write('tool-title', title);
        write('tool-hint', hint);
        for (const part of document.querySelectorAll('#tool-settings [data-for]'))
            if (part instanceof HTMLElement) part.hidden = part.dataset.for !== mode;
        this.show();
    }

    /** Shows the settings as they are. */
    show() {
        for (const { id, least, most } of sliders) {
            const [low, high] = this.#range(least, most);
            const value = this.#settings[id];
            input(id).value = String((100 * Math.log(Math.max(value, low) / low)) / Math.log(high / low));
            input(id).setAttribute('aria-valuetext', length(value));
            write(`${id}-value`, length(value));
        }
        input('through').checked = this.#settings.through;
        input('depth').disabled = this.#settings.through;
        input('resistance').checked = this.#settings.resistance;
        this.showThread();
    }

    /** Shows how far the thread is. */
    showThread() {
        const { points, last } = this.#suture;
        button('tie').disabled = points.length < 2;
        button('back').disabled = points.length === 0;
        for (const id of ['tighten', 'loosen', 'untie']) button(id).disabled = !last || points.length > 0;
        const force = last?.force ? Math.hypot(...last.force) : 0;
        if (points.length) write('thread', `${points.length} ${points.length === 1 ? 'point' : 'points'} laid`);
        else if (last) write('thread', `${last.name}${last.tool?.length ? `: ${length(last.tool.length)}` : ''}${force ? `, ${withUnit(force, 'N')}` : ''}`);
        else write('thread', '');
        element('thread').hidden = element('tool-title').textContent !== 'Suture' || !element('thread').textContent;
    }
}
