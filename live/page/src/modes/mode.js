// What the modes have in common. A mode turns a drag over the page into orders.
// SPDX-License-Identifier: LGPL-3.0-or-later

/**
 * What a mode works with.
 * @typedef {Object} Bench
 * @property {import('../aim.js').Aim} aim
 * @property {import('../hand.js').Hand} hand
 * @property {import('../settings.js').Settings} settings
 * @property {() => number} diagonal of the body, m
 * @property {() => import('../types.js').State|null} state
 * @property {(order: Record<string, unknown>) => void} send
 * @property {() => void} changed the settings or the marks changed
 */

/**
 * A slider goes in even ratios from `least`, in element sizes, to `most`, in diagonals of the body.
 * @typedef {{id: string, label: string, says: string, least: number, most: number}} Slider
 */

/**
 * What the page shows of a mode, beside the picture. modes/index.js lists the modes.
 * @typedef {Object} ModeFacts
 * @property {string} name
 * @property {string} kind of tool that it takes; empty without
 * @property {string} title on its button
 * @property {string} tip what to do, on its button
 * @property {string} hint what to do, in the settings
 * @property {string} icon lines of an SVG of 24 x 24
 * @property {Slider[]} [sliders] of the settings with their names
 * @property {(element: number, diagonal: number, touches: boolean) => Record<string, number|boolean>} [suitable]
 *     settings to begin with: lengths that suit a mean edge and a body, and whether tools touch tissue
 * @property {(bench: Bench) => Mode} [make]
 * @property {(tool: import('../types.js').ToolDefinition, brush: import('../tools_view.js').Brush) => void} [draw]
 * @property {(state: {tool: import('../types.js').ToolDefinition, closed?: boolean}) => import('../types.js').ToolDefinition} [shown]
 *     what is drawn of a tool in its present state
 */

export class Mode {
    /** True if the wheel is the mode's even without a drag. */
    wheelsWhenIdle = false;

    /** @param {Bench} bench */
    constructor(bench) {
        this.bench = bench;
    }

    /** The drag begins. @param {number} _x @param {number} _y */
    begin(_x, _y) {}

    /** @param {number} _x @param {number} _y */
    move(_x, _y) {}

    /** Once a picture while the tool is in the hand. Returns true if it wants another. @param {number} _seconds */
    step(_seconds) {
        return false;
    }

    /** Deeper (positive) or higher, by notches of a wheel. @param {number} _notches @returns {boolean} used */
    deepen(_notches) {
        return false;
    }

    end() {
        this.bench.hand.drop();
    }

    /**
     * What would be taken here, to be shown before the drag.
     * @param {number} _x @param {number} _y
     * @returns {{tool: import('../types.js').ToolDefinition, pose: import('../types.js').Pose}|null}
     */
    preview(_x, _y) {
        return null;
    }
}
