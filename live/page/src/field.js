// The range of a field's colours: from the 2nd to the 98th percentile, smoothed over time.
// SPDX-License-Identifier: LGPL-3.0-or-later

const lowShare = 0.02;
const highShare = 0.98;
/** Values that are looked at; percentiles of more would look the same. */
const sampleSize = 2000;
/** Seconds in which the range follows. */
const ease = 0.5;

export class FieldRange {
    low = 0;
    high = 1;
    #name = '';
    #last = 0;

    /** @param {string} name of the field @param {Float32Array} values @param {number} now milliseconds */
    follow(name, values, now) {
        const stride = Math.max(1, Math.floor(values.length / sampleSize));
        const sample = new Float32Array(Math.ceil(values.length / stride));
        for (let i = 0; i < sample.length; ++i) sample[i] = values[i * stride];
        const sorted = sample.filter(Number.isFinite).sort();
        if (!sorted.length) return;
        const at = (/** @type {number} */ share) => sorted[Math.round(share * (sorted.length - 1))];
        const part = name === this.#name ? 1 - Math.exp(-(now - this.#last) / 1000 / ease) : 1;
        this.#name = name;
        this.#last = now;
        this.low += part * (at(lowShare) - this.low);
        this.high += part * (at(highShare) - this.high);
    }

    /** Takes the next values as they are. */
    forget() {
        this.#name = '';
    }
}
