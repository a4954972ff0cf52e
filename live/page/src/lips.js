// The lines where the skin ends at a cut. A cut that nothing pulls open would not be seen without.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

const cutFace = 0x80000000;

/**
 * The edges of the skin that lie on an edge of the cut faces, as pairs of vertices.
 * Skin and cut faces have vertices of their own there; what they share are the rest positions.
 * Borders between regions have two sides of skin, and are no lips.
 * @param {import('./types.js').Topology} topology
 * @returns {number[]}
 */
export function lipEdges({ triangles, rest, tags }) {
    const numVertices = tags.length;
    /** Edges that only one triangle has. @type {Set<number>} */
    const borders = new Set();
    for (let i = 0; i < triangles.length; i += 3)
        for (let side = 0; side < 3; ++side) {
            const a = triangles[i + side];
            const b = triangles[i + ((side + 1) % 3)];
            const edge = Math.min(a, b) * numVertices + Math.max(a, b);
            if (!borders.delete(edge)) borders.add(edge);
        }
    const at = (/** @type {number} */ vertex) => rest.subarray(3 * vertex, 3 * vertex + 3).join();
    const ends = (/** @type {number} */ edge) => [Math.floor(edge / numVertices), edge % numVertices];
    const place = (/** @type {number} */ edge) => ends(edge).map(at).sort().join(';');
    const all = [...borders];
    const isCut = (/** @type {number} */ edge) => tags[edge % numVertices] >= cutFace;
    const ofCuts = new Set(all.filter(isCut).map(place));
    return all.filter((edge) => !isCut(edge) && ofCuts.has(place(edge))).flatMap(ends);
}

export class Lips {
    /** @type {number[]} */
    #edges = [];

    constructor() {
        this.material = new LineMaterial({ color: 0x3c0a0c, linewidth: 1.8 });
        // The lines lie on the surface: they are drawn a little before it.
        this.material.polygonOffset = true;
        this.material.polygonOffsetUnits = -300;
        this.lines = new LineSegments2(new LineSegmentsGeometry(), this.material);
        this.lines.frustumCulled = false;
        this.lines.renderOrder = 7;
        this.lines.visible = false;
    }

    /** @param {import('./types.js').Topology} topology */
    setTopology(topology) {
        this.#edges = lipEdges(topology);
        this.lines.geometry.dispose();
        this.lines.geometry = new LineSegmentsGeometry();
        if (this.#edges.length) this.lines.geometry.setPositions(new Float32Array(3 * this.#edges.length));
        this.lines.visible = this.#edges.length > 0;
    }

    /** @param {Float32Array} positions of the surface's vertices @param {import('three').Vector3} origin */
    setPositions(positions, origin) {
        if (!this.#edges.length) return;
        const { data } = /** @type {any} */ (this.lines.geometry.attributes.instanceStart);
        this.#edges.forEach((vertex, i) => {
            for (let axis = 0; axis < 3; ++axis) data.array[3 * i + axis] = positions[3 * vertex + axis];
        });
        data.needsUpdate = true;
        this.lines.position.copy(origin);
    }
}
