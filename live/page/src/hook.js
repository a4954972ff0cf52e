// What tests in a browser may ask the page, as window.incise.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';

/** @param {import('./app.js').App} app */
export function exposeForTests(app) {
    const { tissue, scene } = app;
    const onScreen = (/** @type {Vector3} */ point) => {
        const at = scene.onScreen(point);
        const hit = app.aim.pick(at.x, at.y);
        const away = point.distanceTo(scene.camera.position);
        return { ...at, visible: hit !== null && hit.distance > away - 0.002 * scene.diagonal };
    };
    const incise = {
        hello: () => app.hello,
        state: () => app.state,
        messages: () => app.messages.all,
        framesReceived: () => app.frames,
        /** Number of hellos, of which one comes after each reset. */
        greetings: () => app.greetings,
        ordersSent: () => app.connection.sent,
        picturesDrawn: () => scene.pictures,
        mode: () => app.modeName,
        pieces: () => app.state?.components ?? 0,
        numVertices: () => tissue.positions.length / 3,
        numTriangles: () => tissue.triangles.length / 3,
        /** Position of a vertex, m. @param {number} vertex */
        vertex: (vertex) => tissue.position(vertex).toArray(),
        /** @param {number} vertex */
        isCut: (vertex) => tissue.isCut(vertex),
        /** The vertex nearest to a point of the rest shape. @param {number} x @param {number} y @param {number} z */
        findVertex: (x, y, z) => tissue.nearestAtRest([x, y, z]),
        /** Where a vertex is on the page, and whether it is in sight. @param {number} vertex */
        vertexOnScreen: (vertex) => onScreen(tissue.position(vertex)),
        /** Where a point of the world is on the page. @param {number[]} point */
        screenPointOf: (point) => onScreen(new Vector3().fromArray(point)),
        /** What a point of the page shows of the body. @param {number} x @param {number} y */
        pick: (x, y) => app.aim.pick(x, y)?.point.toArray() ?? null,
        /** The corners of the box round the body at rest, on the page. */
        corners: () =>
            [0, 1, 2, 3, 4, 5, 6, 7].map((i) => {
                const { min, max } = scene.box;
                return scene.onScreen(new Vector3((i & 1 ? max : min).x, (i & 2 ? max : min).y, (i & 4 ? max : min).z));
            }),
        /** Names of the tools of the scenario that are drawn. */
        scriptedDrawn: () => app.toolsView.scripted,
        camera: () => scene.camera.matrixWorld.toArray(),
        /** Sends any text, as a hostile page would. @param {Record<string, unknown>} order */
        send: (order) => app.send(order),
    };
    Object.assign(window, { incise });
}
