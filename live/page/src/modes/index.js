// The modes of the page, in the order of their buttons and keys. A new one is a file and a line here.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { burr, probe } from './ball.js';
import { grasper } from './grasper.js';
import { scalpel } from './scalpel.js';
import { scissors } from './scissors.js';
import { suture } from './suture.js';

/** @type {import('./mode.js').ModeFacts} */
const look = {
    name: 'look',
    kind: '',
    title: 'Look',
    tip: 'drag turns the view',
    hint: 'Drag turns the view, the wheel zooms.',
    icon: '<path d="M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12z"/><circle cx="12" cy="12" r="3"/>',
};

export const modes = [look, scalpel, probe, grasper, suture, burr, scissors];

/** The mode with this name. @param {string} name */
export const modeOf = (name) => modes.find((mode) => mode.name === name) ?? look;

/** The mode that takes tools of a kind, or undefined. @param {string} kind */
export const modeOfKind = (kind) => modes.find((mode) => mode.kind === kind);
