// Numbers as people read them.
// SPDX-License-Identifier: LGPL-3.0-or-later

const prefixes = [
    [1e9, 'G'],
    [1e6, 'M'],
    [1e3, 'k'],
    [1, ''],
    [1e-3, 'm'],
    [1e-6, 'µ'],
    [1e-9, 'n'],
];

/**
 * Three digits with the prefix of a unit: 1234.5 and "Pa" give "1.23 kPa".
 * @param {number} value
 * @param {string} unit SI; without a unit there is no prefix
 */
export function withUnit(value, unit) {
    if (!Number.isFinite(value)) return '–';
    if (value === 0) return unit ? `0 ${unit}` : '0';
    if (!/^(m|Pa|N|J|kg|m\/s|J\/m\^?3|J\/m³)$/.test(unit)) return `${digits(value)} ${unit}`.trim();
    const size = Math.abs(value) * (unit === 'kg' ? 1000 : 1);
    const [factor, prefix] = /** @type {[number, string]} */ (
        prefixes.find(([least]) => size >= Number(least) * 0.9995) ?? prefixes[prefixes.length - 1]
    );
    const scaled = (value * (unit === 'kg' ? 1000 : 1)) / factor;
    return `${digits(scaled)} ${prefix}${unit === 'kg' ? 'g' : unit}`;
}

/** Three digits. @param {number} value */
export function digits(value) {
    const size = Math.abs(value);
    if (size === 0) return '0';
    if (size >= 1e5 || size < 1e-3) return value.toExponential(1);
    return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
}

/** A whole number in groups of three digits. @param {number} value */
export function whole(value) {
    return Math.round(value).toLocaleString('en').replace(/,/g, '\u202f');
}

/** An area in the unit that suits it. @param {number} value m^2 */
export function area(value) {
    const inSquareCm = value * 1e4;
    return inSquareCm >= 1 || inSquareCm === 0
        ? `${digits(inSquareCm)} cm²`
        : `${digits(value * 1e6)} mm²`;
}

/** A round number with its unit, without zeros at its end. @param {number} value @param {string} unit */
export function round(value, unit) {
    return withUnit(value, unit).replace(/\.0+(?= )|(\.\d*[1-9])0+(?= )/, '$1');
}

/** A length in millimetres or what suits it. @param {number} value m */
export function length(value) {
    return withUnit(value, 'm');
}
