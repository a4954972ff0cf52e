// What the user chose for the tools. Lengths are in metres and begin at what suits the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later

/**
 * @typedef {Object} Settings
 * @property {number} depth of the scalpel's tip below the surface
 * @property {boolean} through the scalpel parts all that it passes over
 * @property {boolean} resistance the scalpel feels the toughness of the tissue
 * @property {number} probe radius
 * @property {number} press depth of the probe
 * @property {number} grip radius of the grasper
 * @property {number} burr radius
 * @property {number} bite depth of the burr
 * @property {number} stiffness of a suture, N/m
 */

/** Toughness of soft tissue that the blade feels, J/m^2. */
export const toughness = 160;

/**
 * @param {number} element mean edge
 * @param {number} diagonal of the body
 * @param {boolean} [touches] tools touch tissue: without that a blade has no force
 * @returns {Settings}
 */
export function suitable(element, diagonal, touches = true) {
    const burr = Math.max(1.5 * element, 0.02 * diagonal);
    return {
        depth: 1.5 * element,
        through: false,
        resistance: touches,
        probe: Math.max(1.5 * element, 0.03 * diagonal),
        press: Math.max(1.2 * element, 0.02 * diagonal),
        grip: Math.max(1.5 * element, 0.02 * diagonal),
        burr,
        bite: 0.6 * burr,
        stiffness: 200,
    };
}
