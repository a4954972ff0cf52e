// Reads the tetrahedra of an unstructured grid of VTK whose arrays are zlib blocks in base64.
// It is no general reader: it takes what the meshes in data/ hold, for the mock server.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { readFileSync } from 'node:fs';
import { inflateSync } from 'node:zlib';

/** @param {string} text base64 of the header and of the blocks, each padded by itself */
function unpack(text) {
    const clean = text.trim();
    const first = Buffer.from(clean.slice(0, 12), 'base64');
    const blocks = Number(first.readBigUInt64LE(0));
    const header_bytes = 8 * (3 + blocks);
    const header_text = 4 * Math.ceil(header_bytes / 3);
    const header = Buffer.from(clean.slice(0, header_text), 'base64');
    const data = Buffer.from(clean.slice(header_text), 'base64');
    const parts = [];
    for (let block = 0, at = 0; block < blocks; ++block) {
        const size = Number(header.readBigUInt64LE(24 + 8 * block));
        parts.push(inflateSync(data.subarray(at, at + size)));
        at += size;
    }
    return Buffer.concat(parts);
}

/**
 * @param {string} file
 * @returns {{points: Float64Array, tets: Uint32Array, regions: Uint8Array}}
 */
export function readTetrahedra(file) {
    const xml = readFileSync(file, 'utf8');
    /** @type {Record<string, {type: string, bytes: Buffer}>} */
    const arrays = {};
    for (const match of xml.matchAll(/<DataArray([^>]*)>([^<]*)</g)) {
        const attribute = (/** @type {string} */ key) =>
            new RegExp(`${key}="([^"]*)"`).exec(match[1])?.[1] ?? '';
        arrays[attribute('Name')] = { type: attribute('type'), bytes: unpack(match[2]) };
    }
    const numbers = (/** @type {string} */ name) => {
        const { type, bytes } = arrays[name];
        const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
        if (type === 'Float64') return new Float64Array(buffer);
        if (type === 'Int64') return Float64Array.from(new BigInt64Array(buffer), Number);
        if (type === 'Int32') return new Int32Array(buffer);
        return new Uint8Array(buffer);
    };
    const points = Float64Array.from(numbers('Points'));
    const tets = Uint32Array.from(numbers('connectivity'));
    const regions = arrays.region
        ? Uint8Array.from(numbers('region'))
        : new Uint8Array(tets.length / 4).fill(1);
    return { points, tets, regions };
}
