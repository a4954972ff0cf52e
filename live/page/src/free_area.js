// The part of the page that no panel covers.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** @typedef {{left: number, top: number, right: number, bottom: number}} Area pixels of the page */

/** Panels that are always there. Those that come and go may lie over the picture. */
const panels = ['top', 'tools', 'readings', 'settings', 'transport', 'corner'];

/** The rectangles of the panels. @returns {Area[]} */
function covered() {
    return panels
        .map((id) => /** @type {HTMLElement} */ (document.getElementById(id)))
        .filter((panel) => !panel.classList.contains('open'))
        .map((panel) => panel.getBoundingClientRect())
        .filter(({ width, height }) => width > 0 && height > 0);
}

/**
 * The largest rectangle of the page that leaves all panels free.
 * @param {number} width @param {number} height of the page
 * @returns {Area}
 */
export function freeArea(width, height, panels = covered()) {
    const edges = (/** @type {number} */ end, /** @type {'left'|'top'|'right'|'bottom'} */ side) => [
        end,
        ...panels.map((panel) => panel[side]),
    ];
    let best = { left: 0, top: 0, right: width, bottom: height };
    let most = 0;
    for (const left of edges(0, 'right'))
        for (const right of edges(width, 'left'))
            for (const top of edges(0, 'bottom'))
                for (const bottom of edges(height, 'top')) {
                    const size = Math.max(right - left, 0) * Math.max(bottom - top, 0);
                    if (size <= most) continue;
                    const isFree = panels.every(
                        (panel) => panel.right <= left || panel.left >= right || panel.bottom <= top || panel.top >= bottom
                    );
                    if (!isFree) continue;
                    most = size;
                    best = { left, top, right, bottom };
                }
    return best;
}
