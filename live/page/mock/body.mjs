// A body of tetrahedra for the mock server: it is cut, carved and dragged without any mechanics.
// The cut opens the faces between elements whose centroids lie on either side of the blade's sweep.
// SPDX-License-Identifier: LGPL-3.0-or-later

const faceCorners = [
    [1, 2, 3],
    [0, 3, 2],
    [0, 1, 3],
    [0, 2, 1],
];

/** @typedef {[number, number, number]} Vec3 */

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** True if the segment from p to q meets the triangle a, b, c. */
function meets(p, q, a, b, c) {
    const n = cross(sub(b, a), sub(c, a));
    const dp = dot(n, sub(p, a));
    const dq = dot(n, sub(q, a));
    if (dp * dq > 0 || dp === dq) return false;
    const t = dp / (dp - dq);
    const x = [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])];
    return [
        [a, b],
        [b, c],
        [c, a],
    ].every(([u, v]) => dot(cross(sub(v, u), sub(x, u)), n) >= 0);
}

export class Body {
    /** @param {{points: Float64Array, tets: Uint32Array, regions: Uint8Array}} mesh */
    constructor(mesh) {
        this.mesh = mesh;
        const { points, tets } = mesh;
        this.numTets = tets.length / 4;
        this.neighbour = new Int32Array(tets.length).fill(-1);
        const open = new Map();
        for (let tet = 0; tet < this.numTets; ++tet)
            for (let face = 0; face < 4; ++face) {
                const key = faceCorners[face]
                    .map((corner) => tets[4 * tet + corner])
                    .sort((a, b) => a - b)
                    .join();
                const other = open.get(key);
                if (other === undefined) open.set(key, 4 * tet + face);
                else {
                    this.neighbour[4 * tet + face] = other;
                    this.neighbour[other] = 4 * tet + face;
                }
            }
        this.centroids = new Float64Array(3 * this.numTets);
        for (let tet = 0; tet < this.numTets; ++tet)
            for (let corner = 0; corner < 4; ++corner)
                for (let axis = 0; axis < 3; ++axis)
                    this.centroids[3 * tet + axis] += points[3 * tets[4 * tet + corner] + axis] / 4;
        this.min = [Infinity, Infinity, Infinity];
        this.max = [-Infinity, -Infinity, -Infinity];
        points.forEach((value, i) => {
            this.min[i % 3] = Math.min(this.min[i % 3], value);
            this.max[i % 3] = Math.max(this.max[i % 3], value);
        });
        this.pull = new Float64Array(points.length);
        this.version = 0;
        this.clear();
    }

    clear() {
        this.opened = new Uint8Array(4 * this.numTets);
        this.removed = new Uint8Array(this.numTets);
        this.edits = 0;
        this.pull.fill(0);
        this.rebuild();
    }

    mark() {
        return { opened: this.opened.slice(), removed: this.removed.slice(), edits: this.edits };
    }

    goBack(mark) {
        this.opened = mark.opened.slice();
        this.removed = mark.removed.slice();
        this.edits = mark.edits;
        this.pull.fill(0);
        this.rebuild();
    }

    point(node) {
        return [0, 1, 2].map((axis) => this.mesh.points[3 * node + axis]);
    }

    /** Opens the faces that the edge from (a, b) to (c, d) sweeps across. */
    cut(a, b, c, d) {
        const low = [0, 1, 2].map((i) => Math.min(a[i], b[i], c[i], d[i]) - 0.006);
        const high = [0, 1, 2].map((i) => Math.max(a[i], b[i], c[i], d[i]) + 0.006);
        let count = 0;
        for (let tet = 0; tet < this.numTets; ++tet) {
            const p = [0, 1, 2].map((i) => this.centroids[3 * tet + i]);
            if (p.some((value, i) => value < low[i] || value > high[i])) continue;
            for (let face = 0; face < 4; ++face) {
                const other = this.neighbour[4 * tet + face];
                if (other < 0 || this.opened[other]) continue;
                const n = other >> 2;
                const q = [0, 1, 2].map((i) => this.centroids[3 * n + i]);
                if (!meets(p, q, a, b, c) && !meets(p, q, b, d, c)) continue;
                this.opened[other] = this.opened[4 * tet + face] = 1;
                ++count;
            }
        }
        if (count) {
            this.edits += count;
            this.rebuild();
        }
        return count;
    }

    carve(centre, radius) {
        let count = 0;
        for (let tet = 0; tet < this.numTets; ++tet) {
            if (this.removed[tet]) continue;
            const away = [0, 1, 2].map((i) => this.centroids[3 * tet + i] - centre[i]);
            if (dot(away, away) > radius * radius) continue;
            this.removed[tet] = 1;
            ++count;
        }
        if (count) {
            this.edits += count;
            this.rebuild();
        }
        return count;
    }

    /** Builds the copies of nodes, the surface and the components anew. */
    rebuild() {
        const { tets, points, regions } = this.mesh;
        const parent = new Int32Array(4 * this.numTets).map((_, i) => i);
        const pieces = new Int32Array(this.numTets).map((_, i) => i);
        const find = (/** @type {Int32Array} */ of, /** @type {number} */ i) => {
            while (of[i] !== i) i = of[i] = of[of[i]];
            return i;
        };
        for (let half = 0; half < 4 * this.numTets; ++half) {
            const other = this.neighbour[half];
            if (other < half || this.opened[half]) continue;
            const t = half >> 2;
            const n = other >> 2;
            if (this.removed[t] || this.removed[n]) continue;
            pieces[find(pieces, t)] = find(pieces, n);
            for (const corner of faceCorners[half & 3])
                for (let k = 0; k < 4; ++k)
                    if (tets[4 * n + k] === tets[4 * t + corner])
                        parent[find(parent, 4 * t + corner)] = find(parent, 4 * n + k);
        }
        this.piece = pieces.map((_, i) => find(pieces, i));
        this.components = new Set(
            [...this.piece].filter((_, tet) => !this.removed[tet])
        ).size;
        this.elements = this.numTets - this.removed.reduce((sum, value) => sum + value, 0);
        this.area = 0;
        const triangles = [];
        const rest = [];
        const tags = [];
        const owner = [];
        const pieceOf = [];
        const gap = [];
        const vertices = new Map();
        for (let half = 0; half < 4 * this.numTets; ++half) {
            const t = half >> 2;
            if (this.removed[t]) continue;
            const other = this.neighbour[half];
            const inside = other >= 0;
            if (inside && !this.opened[half] && !this.removed[other >> 2]) continue;
            const nodes = faceCorners[half & 3].map((corner) => tets[4 * t + corner]);
            const [a, b, c] = nodes.map((node) => this.point(node));
            const normal = cross(sub(b, a), sub(c, a));
            const size = Math.sqrt(dot(normal, normal));
            if (inside) this.area += size / 4;
            faceCorners[half & 3].forEach((corner) => {
                const copy = find(parent, 4 * t + corner);
                const key = `${copy},${inside ? 1 : 0},${regions[t]}`;
                let vertex = vertices.get(key);
                if (vertex === undefined) {
                    vertex = owner.length;
                    vertices.set(key, vertex);
                    const node = tets[4 * t + corner];
                    rest.push(points[3 * node], points[3 * node + 1], points[3 * node + 2]);
                    tags.push((inside ? 0x80000000 : 0) + (regions[t] - 1));
                    owner.push(node);
                    pieceOf.push(this.piece[t]);
                }
                if (inside && !this.removed[other >> 2]) {
                    const at = (gap[copy] ??= [0, 0, 0]);
                    for (let axis = 0; axis < 3; ++axis) at[axis] -= normal[axis] / size;
                }
                triangles.push(vertex);
            });
        }
        this.copies = [...vertices.keys()].map((key) => Number(key.split(',')[0]));
        this.gap = this.copies.map((copy) => {
            const at = gap[copy];
            if (!at) return [0, 0, 0];
            const size = Math.hypot(...at) || 1;
            return at.map((value) => (0.0016 * value) / Math.max(size, 1));
        });
        this.triangles = Uint32Array.from(triangles);
        this.rest = Float32Array.from(rest);
        this.tags = Uint32Array.from(tags);
        this.owner = owner;
        this.pieceOf = pieceOf;
        ++this.version;
    }

    /** The lowest element whose centroid is nearest to the point. */
    nearest(point) {
        let best = Infinity;
        let found = 0;
        for (let tet = 0; tet < this.numTets; ++tet) {
            if (this.removed[tet]) continue;
            const away = [0, 1, 2].map((i) => this.centroids[3 * tet + i] - point[i]);
            if (dot(away, away) < best) {
                best = dot(away, away);
                found = tet;
            }
        }
        return found;
    }

    /**
     * The positions of the surface's vertices, relative to the origin.
     * @param {number[]} origin
     * @param {((rest: number[], piece: number) => number[])|null} displacement
     * @param {number} time for a slow breath
     */
    positions(origin, displacement, time) {
        const result = new Float32Array(this.rest.length);
        const breath = 0.0001 * Math.sin(2 * time);
        for (let vertex = 0; vertex < this.owner.length; ++vertex) {
            const p = [0, 1, 2].map((axis) => this.rest[3 * vertex + axis]);
            const u = displacement ? displacement(p, this.pieceOf[vertex]) : [0, 0, 0];
            const open = this.gap[vertex];
            for (let axis = 0; axis < 3; ++axis)
                result[3 * vertex + axis] =
                    p[axis] - origin[axis] + u[axis] + open[axis] +
                    (axis === 2 ? breath * Math.cos(30 * p[0]) : 0);
        }
        return result;
    }
}
