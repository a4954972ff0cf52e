// Decodes the binary messages: positions of the surface, and its triangles when they changed.
// SPDX-License-Identifier: LGPL-3.0-or-later

const magic = 0x31434e49;
const headerBytes = 40;
const topologyFollows = 1;
const valuesFollow = 2;

/**
 * The arrays of the result are views into the message.
 * Typed arrays have the byte order of the machine; all that run a browser today are little endian.
 * @param {ArrayBuffer} message
 * @returns {import('./types.js').Frame}
 * @throws {Error} if the message is not whole
 */
export function decodeFrame(message) {
    if (message.byteLength < headerBytes) throw new Error('a frame has no whole header');
    const head = new DataView(message);
    if (head.getUint32(0, true) !== magic) throw new Error('a frame has a wrong first word');
    const flags = head.getUint32(4, true);
    const version = head.getUint32(8, true);
    const numVertices = head.getUint32(16, true);
    const numTriangles = head.getUint32(20, true);

    let at = headerBytes;
    const take = (/** @type {typeof Float32Array|typeof Uint32Array} */ Kind, /** @type {number} */ count) => {
        if (at + 4 * count > message.byteLength) throw new Error('a frame ends too soon');
        const view = new Kind(message, at, count);
        at += 4 * count;
        return /** @type {any} */ (view);
    };

    const topology =
        flags & topologyFollows
            ? {
                  version,
                  triangles: take(Uint32Array, 3 * numTriangles),
                  rest: take(Float32Array, 3 * numVertices),
                  tags: take(Uint32Array, numVertices),
              }
            : null;
    return {
        version,
        tick: head.getUint32(12, true),
        origin: [24, 28, 32].map((offset) => head.getFloat32(offset, true)),
        topology,
        positions: take(Float32Array, 3 * numVertices),
        values: flags & valuesFollow ? take(Float32Array, numVertices) : null,
    };
}
