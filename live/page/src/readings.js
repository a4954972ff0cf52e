// The numbers that are always shown.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { button, element, write } from './dom.js';
import { area, whole, withUnit } from './format.js';

/** Share of the wanted speed below which the speed is shown as a warning. */
const enough = 0.95;

/**
 * The force on the tool in the hand; without one, the greatest on a tool of the scenario, or on an obstacle.
 * @param {import('./types.js').State} state @param {import('./types.js').PlacedTool[]} scripted
 */
function showForce(state, scripted) {
    const size = (/** @type {{force?: number[]|null}} */ { force }) => (force ? Math.hypot(...force) : 0);
    const own = state.tools.find((one) => one.mine && one.present);
    const felt = scripted.filter((one) => one.present && size(one) > 0);
    felt.sort((a, b) => Number(a.is_obstacle) - Number(b.is_obstacle) || size(b) - size(a));
    write('force-name', own || !felt.length ? 'Force' : felt[0].name);
    const shown = own ?? felt[0];
    write('force', shown?.force ? withUnit(size(shown), 'N') : '–');
    element('force-row').title = felt.map((one) => `${one.name}: ${withUnit(size(one), 'N')}`).join('\n');
}

/**
 * @param {import('./types.js').State} state
 * @param {import('./types.js').PlacedTool[]} scripted tools of the scenario
 * @param {boolean} operator
 */
export function showReadings(state, scripted, operator) {
    write('time', `${state.time.toFixed(2)} s`);
    const factor = state.paused ? 'paused' : `${state.factor.toFixed(2)} × real time`;
    write('factor', factor);
    element('factor').classList.toggle('slow', !state.paused && state.factor < enough * Math.min(1, state.speed));
    element('factor').title = `steps of ${withUnit(state.step * 1000, '')} ms; wanted speed ${state.speed}`;
    showForce(state, scripted);
    write('opened', area(state.cut_area));
    write('pieces', whole(state.components));
    element('pieces').classList.toggle('many', state.components > 1);
    write('elements', whole(state.elements));
    write('edits', whole(state.edits));

    write('speed', `${Number(state.speed.toPrecision(2))}×`);
    const pause = button('pause');
    pause.setAttribute('aria-pressed', String(state.paused));
    pause.disabled = !operator;
    button('step').disabled = !operator || !state.paused;
    button('undo').disabled = !operator || !state.can_undo;
    for (const id of ['reset', 'slower', 'faster']) button(id).disabled = !operator;
}
