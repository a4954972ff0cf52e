// Pictures of a page as pixels: a reader of the PNG files that browsers write, and comparisons.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { inflateSync } from 'node:zlib';

/**
 * @typedef {Object} Picture
 * @property {number} width
 * @property {number} height
 * @property {number} channels
 * @property {Uint8Array} pixels
 */

/** Reads a PNG of 8 bits, RGB or RGBA, without interlacing. @param {Buffer} file @returns {Picture} */
export function readPng(file) {
    const parts = [];
    let width = 0;
    let height = 0;
    let channels = 0;
    for (let at = 8; at < file.length; ) {
        const size = file.readUInt32BE(at);
        const kind = file.toString('latin1', at + 4, at + 8);
        const data = file.subarray(at + 8, at + 8 + size);
        if (kind === 'IHDR') {
            width = data.readUInt32BE(0);
            height = data.readUInt32BE(4);
            channels = data[9] === 6 ? 4 : 3;
            if (data[8] !== 8 || ![2, 6].includes(data[9]) || data[12] !== 0) throw new Error('a PNG of an unknown kind');
        } else if (kind === 'IDAT') parts.push(data);
        at += 12 + size;
    }
    const raw = inflateSync(Buffer.concat(parts));
    const row = width * channels;
    const pixels = new Uint8Array(row * height);
    for (let y = 0; y < height; ++y) {
        const filter = raw[y * (row + 1)];
        for (let x = 0; x < row; ++x) {
            const left = x >= channels ? pixels[y * row + x - channels] : 0;
            const above = y ? pixels[(y - 1) * row + x] : 0;
            const corner = y && x >= channels ? pixels[(y - 1) * row + x - channels] : 0;
            let guess = 0;
            if (filter === 1) guess = left;
            else if (filter === 2) guess = above;
            else if (filter === 3) guess = (left + above) >> 1;
            else if (filter === 4) {
                const sum = left + above - corner;
                const [a, b, c] = [Math.abs(sum - left), Math.abs(sum - above), Math.abs(sum - corner)];
                guess = a <= b && a <= c ? left : b <= c ? above : corner;
            }
            pixels[y * row + x] = raw[y * (row + 1) + 1 + x] + guess;
        }
    }
    return { width, height, channels, pixels };
}

/** Colour of a pixel. @param {Picture} picture @param {number} x @param {number} y */
export function colourAt({ width, channels, pixels }, x, y) {
    const at = (Math.round(y) * width + Math.round(x)) * channels;
    return [...pixels.subarray(at, at + 3)];
}

/** Greatest difference of two colours in a channel. @param {number[]} a @param {number[]} b */
export const difference = (a, b) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));

/**
 * Number of pixels in a box that differ by more than `least` of 255 in some channel.
 * @param {Picture} a @param {Picture} b
 * @param {{left: number, top: number, right: number, bottom: number}} [box]
 */
export function countChanged(a, b, box = { left: 0, top: 0, right: a.width, bottom: a.height }, least = 24) {
    let count = 0;
    for (let y = Math.max(0, Math.floor(box.top)); y < Math.min(a.height, box.bottom); ++y)
        for (let x = Math.max(0, Math.floor(box.left)); x < Math.min(a.width, box.right); ++x)
            if (difference(colourAt(a, x, y), colourAt(b, x, y)) > least) ++count;
    return count;
}
