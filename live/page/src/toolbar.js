// The buttons of the modes.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { element, write } from './dom.js';
import { modes } from './modes/index.js';

export class Toolbar {
    /** @type {Map<string, HTMLButtonElement>} */
    #buttons = new Map();

    /** @param {(mode: string, byMouse: boolean) => void} chosen */
    constructor(chosen) {
        modes.forEach(({ name, title, tip, icon }, i) => {
            const button = document.createElement('button');
            button.type = 'button';
            button.dataset.mode = name;
            button.title = `${title}: ${tip} (${i + 1})`;
            button.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true">${icon}</svg><span>${title}</span>`;
            button.onclick = (event) => chosen(name, event.detail > 0);
            this.#buttons.set(name, button);
        });
        element('tools').replaceChildren(...this.#buttons.values());
        element('mode-keys').innerHTML = `<kbd>1</kbd> – <kbd>${modes.length}</kbd>`;
        write('mode-names', modes.map((mode) => mode.title.toLowerCase()).join(', '));
    }

    /** Offers the modes whose tools the body can have. @param {import('./types.js').Hello} hello */
    offer(hello) {
        for (const { name, kind } of modes) this.#button(name).hidden = kind !== '' && !hello.kinds.includes(kind);
    }

    /** @param {boolean} isOperator the page may take tools; otherwise it only looks */
    enable(isOperator) {
        for (const { name, kind } of modes) this.#button(name).disabled = !isOperator && kind !== '';
    }

    /** Shows which mode is chosen. @param {string} name */
    choose(name) {
        for (const [mode, button] of this.#buttons) button.setAttribute('aria-pressed', String(mode === name));
    }

    /** The mode with this number, from 0; null if it is not offered. @param {number} index */
    offered(index) {
        const mode = modes[index];
        return mode && !this.#button(mode.name).hidden ? mode.name : null;
    }

    /** @param {string} name */
    #button(name) {
        return /** @type {HTMLButtonElement} */ (this.#buttons.get(name));
    }
}
