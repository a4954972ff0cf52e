// Smooth normals of a surface. Each triangle counts by its angle at the vertex, so that the way in
// which a flat part is divided into triangles does not show. Beside a cut there are slivers, whose own
// normals say little: a vertex that has only small triangles takes over the normals of its neighbours.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** A neighbour whose triangles are larger by this factor begins to count, and counts fully beyond the second. */
const larger = [2, 6];

/**
 * Adds to the sums at vertices of small triangles those at neighbours of large ones.
 * @param {Uint32Array} triangles
 * @param {Float32Array} areas of the triangles round each vertex
 * @param {Float32Array} normals sums of unit normals
 */
function followNeighbours(triangles, areas, normals) {
    const before = normals.slice();
    const follow = (/** @type {number} */ vertex, /** @type {number} */ neighbour) => {
        const ratio = areas[neighbour] / areas[vertex];
        if (!(ratio > larger[0])) return;
        const weight = Math.min((ratio - larger[0]) / (larger[1] - larger[0]), 1) * Math.min(ratio, 1e6);
        for (let axis = 0; axis < 3; ++axis) normals[3 * vertex + axis] += weight * before[3 * neighbour + axis];
    };
    for (let i = 0; i < triangles.length; i += 3) {
        const a = triangles[i];
        const b = triangles[i + 1];
        const c = triangles[i + 2];
        follow(a, b);
        follow(b, a);
        follow(b, c);
        follow(c, b);
        follow(c, a);
        follow(a, c);
    }
}

/**
 * @param {Float32Array} positions
 * @param {Uint32Array} triangles
 * @param {Float32Array} normals overwritten; zero where a vertex has no proper triangle
 */
export function computeNormals(positions, triangles, normals) {
    normals.fill(0);
    const areas = new Float32Array(normals.length / 3);
    for (let i = 0; i < triangles.length; i += 3) {
        const a = 3 * triangles[i];
        const b = 3 * triangles[i + 1];
        const c = 3 * triangles[i + 2];
        const ux = positions[b] - positions[a];
        const uy = positions[b + 1] - positions[a + 1];
        const uz = positions[b + 2] - positions[a + 2];
        const vx = positions[c] - positions[b];
        const vy = positions[c + 1] - positions[b + 1];
        const vz = positions[c + 2] - positions[b + 2];
        const wx = positions[a] - positions[c];
        const wy = positions[a + 1] - positions[c + 1];
        const wz = positions[a + 2] - positions[c + 2];
        let nx = uy * vz - uz * vy;
        let ny = uz * vx - ux * vz;
        let nz = ux * vy - uy * vx;
        const area = Math.sqrt(nx * nx + ny * ny + nz * nz);
        if (!(area > 0)) continue;
        areas[triangles[i]] += area;
        areas[triangles[i + 1]] += area;
        areas[triangles[i + 2]] += area;
        nx /= area;
        ny /= area;
        nz /= area;
        const atA = Math.atan2(area, -(ux * wx + uy * wy + uz * wz));
        const atB = Math.atan2(area, -(vx * ux + vy * uy + vz * uz));
        const atC = Math.PI - atA - atB;
        normals[a] += atA * nx;
        normals[a + 1] += atA * ny;
        normals[a + 2] += atA * nz;
        normals[b] += atB * nx;
        normals[b + 1] += atB * ny;
        normals[b + 2] += atB * nz;
        normals[c] += atC * nx;
        normals[c + 1] += atC * ny;
        normals[c + 2] += atC * nz;
    }
    followNeighbours(triangles, areas, normals);
    for (let i = 0; i < normals.length; i += 3) {
        const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]);
        if (!(length > 0)) continue;
        normals[i] /= length;
        normals[i + 1] /= length;
        normals[i + 2] /= length;
    }
}
