// What the user chose for the tools. Lengths are in metres and begin at what suits the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { modes } from './modes/index.js';

/**
 * Sliders of the modes set numbers; each mode says what they mean.
 * @typedef {Record<string, any> & {depth: number, through: boolean, resistance: boolean, stiffness: number}} Settings
 */

/**
 * @param {number} element mean edge
 * @param {number} diagonal of the body
 * @param {boolean} [touches] tools touch tissue: without that a blade has no force
 * @returns {Settings}
 */
export function suitable(element, diagonal, touches = true) {
    const all = modes.map((mode) => mode.suitable?.(element, diagonal, touches) ?? {});
    return /** @type {Settings} */ (Object.assign({}, ...all));
}
