// The page: what the server says goes to the scene and the panels, what the user does goes back.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { App } from './app.js';
import { exposeForTests } from './hook.js';

exposeForTests(new App(location.hash === '#low'));
