// Tools of a scenario for the mock: a table, a ring, a blade, a probe and a capsule that move round the body.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** A ring of triangles in the plane z = 0. @param {number} radius @param {number} thick @param {number} around */
function ring(radius, thick, around = 48, about = 12) {
    const points = [];
    const triangles = [];
    for (let i = 0; i < around; ++i)
        for (let j = 0; j < about; ++j) {
            const [u, v] = [(2 * Math.PI * i) / around, (2 * Math.PI * j) / about];
            const far = radius + thick * Math.cos(v);
            points.push([far * Math.cos(u), far * Math.sin(u), thick * Math.sin(v)]);
            const [right, up] = [((i + 1) % around) * about, (j + 1) % about];
            triangles.push([i * about + j, right + j, right + up], [i * about + j, right + up, i * about + up]);
        }
    return { points, triangles };
}

/** @param {number[]} min @param {number[]} max corners of the body's box */
export function scriptedTools(min, max) {
    const size = Math.hypot(...max.map((value, i) => value - min[i]));
    const sphere = { radius: 0.06 * size };
    const capsule = { from: [0, 0, -0.1 * size], to: [0, 0, 0.1 * size], radius: 0.02 * size };
    const plane = { point: [0, 0, min[2] - 0.01 * size], normal: [0, 0.15, 1] };
    const edge = [[0, -0.2 * size, 0], [0, 0.2 * size, 0]];
    return [
        { name: 'table', kind: 'probe', is_obstacle: true, tool: { kind: 'probe', shape: { plane } } },
        { name: 'ring', kind: 'probe', is_obstacle: true, tool: { kind: 'probe', shape: { mesh: ring(0.2 * size, 0.03 * size) } } },
        { name: 'knife', kind: 'blade', is_obstacle: false, tool: { kind: 'blade', edge } },
        { name: 'indenter', kind: 'probe', is_obstacle: false, tool: { kind: 'probe', shape: { sphere } } },
        { name: 'rod', kind: 'carver', is_obstacle: false, tool: { kind: 'carver', shape: { capsule } } },
    ];
}

/** @param {{name: string}[]} tools @param {number} time @param {number[]} min @param {number[]} max */
export function scriptedStates(tools, time, min, max) {
    const part = (/** @type {number[]} */ parts) => parts.map((value, i) => min[i] + value * (max[i] - min[i]));
    const rotation = [0, 0, 0, 1];
    const wave = 0.1 * Math.sin(time);
    /** @type {Record<string, {at: number[], force?: number[]}>} */
    const places = {
        table: { at: [0, 0, 0], force: [0, 0, -3] },
        ring: { at: part([1.15, 0.5, 0.5]) },
        knife: { at: part([0.3, 0.5, 1.1 + wave]) },
        indenter: { at: part([0.7, 0.4, 0.9 + wave]), force: [0, 0, 0.8] },
        rod: { at: part([-0.1, 0.5, 0.6]) },
    };
    return tools.map(({ name }) => {
        const { at, force = [0, 0, 0] } = places[name];
        return { present: name !== 'knife' || Math.sin(time) > -0.9, pose: { at, rotation }, force };
    });
}
