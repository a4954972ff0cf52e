// Messages below the picture, the newest first. They stay long enough to be read, and longer under the pointer.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** @typedef {'info'|'warning'|'error'} Level */

const most = 4;
/** Milliseconds that a message stays, and how much longer for each letter. */
const stay = { info: 5000, warning: 9000, error: 12000 };
const perLetter = 50;

export class Messages {
    /** All messages so far, the oldest first. @type {{level: Level, text: string}[]} */
    all = [];
    #list;

    /** @param {HTMLElement} list with aria-live */
    constructor(list) {
        this.#list = list;
    }

    /** @param {Level} level @param {string} text */
    show(level, text) {
        this.all.push({ level, text });
        if (this.all.length > 500) this.all.shift();
        const short = text.length > 600 ? `${text.slice(0, 600)} …` : text;
        for (const old of this.#list.children)
            if (old instanceof HTMLElement && old.dataset.text === short) old.remove();
        while (this.#list.children.length >= most) this.#list.lastElementChild?.remove();

        const item = document.createElement('div');
        item.className = `message ${level}`;
        item.dataset.text = short;
        const body = document.createElement('span');
        body.textContent = short;
        const close = document.createElement('button');
        close.type = 'button';
        close.textContent = '×';
        close.setAttribute('aria-label', 'Dismiss');
        close.onclick = () => item.remove();
        item.append(body, close);
        this.#list.prepend(item);

        const leave = () => {
            if (item.matches(':hover, :focus-within')) setTimeout(leave, 1500);
            else item.remove();
        };
        setTimeout(leave, stay[level] + perLetter * short.length);
    }
}
