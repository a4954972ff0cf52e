// Short ways to the elements of index.html.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** The element with this id. @param {string} id */
export const element = (id) => /** @type {HTMLElement} */ (document.getElementById(id));
/** @param {string} id */
export const input = (id) => /** @type {HTMLInputElement} */ (document.getElementById(id));
/** @param {string} id */
export const button = (id) => /** @type {HTMLButtonElement} */ (document.getElementById(id));

/** Changes a text only where it differs, so that nothing is laid out in vain. @param {string} id @param {string} text */
export function write(id, text) {
    const target = element(id);
    if (target.textContent !== text) target.textContent = text;
}
