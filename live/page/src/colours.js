// Colours of tissues, of their cut faces, and of fields.
// SPDX-License-Identifier: LGPL-3.0-or-later

/**
 * Colours by a word in the region's name: the outside, and what a cut opens.
 * @type {[RegExp, string, string][]}
 */
const byName = [
    [/tumou?r|nodule|lesion|metasta/i, '#b99468', '#ecd3a4'],
    [/vessel|vein|artery|blood/i, '#7c2030', '#b23a46'],
    [/fat|adipose/i, '#d3ac55', '#f0d590'],
    [/epiderm|skin/i, '#c99479', '#c24f4a'],
    [/derm/i, '#c98a76', '#d66f68'],
    [/muscle|myo/i, '#8f3230', '#cf5f58'],
    [/bone/i, '#d8ccb0', '#e9d9b8'],
    [/cartilage/i, '#b9c3c4', '#e4ebe8'],
    [/brain|grey|gray|cortex/i, '#b98f86', '#e3bdb1'],
    [/white/i, '#cdb9a6', '#f0e3d2'],
    [/kidney|medulla/i, '#84382f', '#c9655c'],
    [/uter|cervi/i, '#b0605a', '#dd8a84'],
    [/liver|hepat/i, '#73362f', '#cf6f66'],
];

/** Where the name says nothing, by the place in the list. @type {[string, string][]} */
const byIndex = [
    ['#8a3a31', '#d4706a'],
    ['#b99468', '#ecd3a4'],
    ['#8d5a6b', '#d296a8'],
    ['#6f6a4f', '#b9b083'],
    ['#5f6f78', '#a3b7bf'],
    ['#a2644a', '#dfa184'],
];

/**
 * @param {string} name of the region
 * @param {number} index of the region
 * @returns {{outside: string, cut: string}}
 */
export function tissueColours(name, index) {
    for (const [word, outside, cut] of byName) if (word.test(name)) return { outside, cut };
    const [outside, cut] = byIndex[index % byIndex.length];
    return { outside, cut };
}

// Nine samples of viridis (van der Walt and Smith, 2015), sRGB.
const samples = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/**
 * The colour map at t, sRGB from 0 to 255.
 * @param {number} t from 0 to 1
 * @returns {number[]}
 */
export function mapColour(t) {
    const at = Math.min(Math.max(t, 0), 1) * (samples.length - 1);
    const low = Math.min(Math.floor(at), samples.length - 2);
    return samples[low].map((value, i) => value + (at - low) * (samples[low + 1][i] - value));
}

/** The colour map as bytes of 256 pixels, RGBA. */
export function mapPixels() {
    const pixels = new Uint8Array(4 * 256);
    for (let i = 0; i < 256; ++i) pixels.set([...mapColour(i / 255).map(Math.round), 255], 4 * i);
    return pixels;
}
