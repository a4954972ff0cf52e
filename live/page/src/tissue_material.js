// The look of tissue: colours by region, a mottled outside, wet speckled cut faces, or a field.
// The patterns are functions of the rest positions, so that they move with the tissue.
// SPDX-License-Identifier: LGPL-3.0-or-later
import {
    DataTexture,
    DoubleSide,
    LinearFilter,
    MeshPhongMaterial,
    MeshPhysicalMaterial,
    SRGBColorSpace,
} from 'three';
import { mapPixels } from './colours.js';

const noise = /* glsl */ `
    float hash(vec3 p) {
        p = fract(p * vec3(0.1031, 0.1030, 0.0973));
        p += dot(p, p.yxz + 33.33);
        return fract((p.x + p.y) * p.z);
    }
    float noise(vec3 p) {
        vec3 i = floor(p);
        vec3 f = fract(p);
        f = f * f * (3.0 - 2.0 * f);
        vec2 e = vec2(0.0, 1.0);
        return mix(
            mix(mix(hash(i), hash(i + e.yxx), f.x), mix(hash(i + e.xyx), hash(i + e.yyx), f.x), f.y),
            mix(mix(hash(i + e.xxy), hash(i + e.yxy), f.x), mix(hash(i + e.xyy), hash(i + e.yyy), f.x), f.y),
            f.z);
    }
`;

/** Pale septa between darker lobules on cut faces, a fine grain outside. */
const pattern = /* glsl */ `
    if (vCut > 0.5) {
        float coarse = noise(at * 0.55);
        float fine = noise(at * 1.5 + 7.0);
        float septum = 1.0 - smoothstep(0.0, 0.16, abs(coarse - 0.5));
        diffuseColor.rgb *= 0.80 + 0.34 * fine;
        diffuseColor.rgb = mix(diffuseColor.rgb, diffuseColor.rgb * vec3(1.28, 1.22, 1.2), 0.6 * septum);
        relief = 0.25 * fine + 0.35 * septum;
        wet = 0.5;
    } else {
        float fine = noise(at * 0.9);
        diffuseColor.rgb *= 0.94 + 0.12 * fine;
        relief = 0.16 * fine + 0.35 * noise(at * 0.2);
    }
`;

/** The same in three sines, for machines without a graphics card. */
const plainPattern = /* glsl */ `
    if (vCut > 0.5) {
        vec3 wave = sin(at * vec3(2.1, 2.5, 2.3));
        diffuseColor.rgb *= 0.97 + 0.2 * wave.x * wave.y * wave.z;
    }
`;

/**
 * @typedef {Object} TissueUniforms
 * @property {{value: number}} grain waves of the finest pattern in a metre
 * @property {{value: number}} coloured 1 while a field is shown
 * @property {{value: number}} low of the field's range
 * @property {{value: number}} high of the field's range
 * @property {{value: DataTexture}} map
 */

/** @returns {TissueUniforms} */
export function tissueUniforms() {
    const map = new DataTexture(mapPixels(), 256, 1);
    map.colorSpace = SRGBColorSpace;
    map.magFilter = map.minFilter = LinearFilter;
    map.needsUpdate = true;
    return {
        grain: { value: 400 },
        coloured: { value: 0 },
        low: { value: 0 },
        high: { value: 1 },
        map: { value: map },
    };
}

/**
 * @param {boolean} low for slow machines: no clear coat, no relief
 * @param {TissueUniforms} uniforms
 */
export function tissueMaterial(low, uniforms) {
    const material = low
        ? new MeshPhongMaterial({ vertexColors: true, side: DoubleSide, shininess: 24, specular: 0x1c1716 })
        : new MeshPhysicalMaterial({
              vertexColors: true,
              side: DoubleSide,
              roughness: 0.52,
              clearcoat: 0.32,
              clearcoatRoughness: 0.28,
              specularIntensity: 0.5,
          });
    material.clipShadows = true;
    material.onBeforeCompile = (shader) => {
        shader.uniforms.uGrain = uniforms.grain;
        shader.uniforms.uColoured = uniforms.coloured;
        shader.uniforms.uLow = uniforms.low;
        shader.uniforms.uHigh = uniforms.high;
        shader.uniforms.uMap = uniforms.map;
        shader.vertexShader = shader.vertexShader
            .replace(
                '#include <common>',
                `#include <common>
                attribute vec3 rest;
                attribute float cut;
                attribute float value;
                varying vec3 vRest;
                varying float vCut;
                varying float vValue;`
            )
            .replace(
                '#include <begin_vertex>',
                `#include <begin_vertex>
                vRest = rest;
                vCut = cut;
                vValue = value;`
            );
        shader.fragmentShader = shader.fragmentShader
            .replace(
                '#include <common>',
                `#include <common>
                uniform float uGrain, uColoured, uLow, uHigh;
                uniform sampler2D uMap;
                varying vec3 vRest;
                varying float vCut;
                varying float vValue;
                float relief = 0.0;
                float wet = 0.0;
                ${low ? '' : noise}`
            )
            .replace(
                '#include <color_fragment>',
                `#include <color_fragment>
                {
                    vec3 at = vRest * uGrain;
                    ${low ? plainPattern : pattern}
                    if (uColoured > 0.5) {
                        float level = dot(diffuseColor.rgb, vec3(0.3, 0.6, 0.1));
                        float t = clamp((vValue - uLow) / max(uHigh - uLow, 1e-30), 0.0, 1.0);
                        vec3 shown = texture2D(uMap, vec2(t * 0.996 + 0.002, 0.5)).rgb;
                        float stripe = vCut > 0.5 ? 0.72 + 0.4 * smoothstep(0.3, 0.7, fract(dot(at, vec3(0.35)))) : 1.0;
                        diffuseColor.rgb = shown * stripe * (0.95 + 0.1 * level);
                    }
                }`
            );
        // Colours of a field are read off: they shine a little, so that shades change them less.
        shader.fragmentShader = shader.fragmentShader.replace(
            '#include <emissivemap_fragment>',
            `#include <emissivemap_fragment>
            totalEmissiveRadiance += 0.35 * uColoured * diffuseColor.rgb;
            diffuseColor.rgb *= 1.0 - 0.3 * uColoured;`
        );
        if (low) return;
        shader.fragmentShader = shader.fragmentShader
            .replace(
                '#include <normal_fragment_maps>',
                `#include <normal_fragment_maps>
                {
                    // Relief (Mikkelsen 2010): the gradient of a height from screen derivatives.
                    float height = relief * 0.55 / uGrain;
                    vec3 along = dFdx(-vViewPosition);
                    vec3 aside = dFdy(-vViewPosition);
                    vec3 r1 = cross(aside, normal);
                    vec3 r2 = cross(normal, along);
                    float det = dot(along, r1);
                    vec3 slope = sign(det) * (dFdx(height) * r1 + dFdy(height) * r2);
                    normal = normalize(abs(det) * normal - slope);
                }`
            )
            .replace(
                '#include <roughnessmap_fragment>',
                `#include <roughnessmap_fragment>
                roughnessFactor = clamp(roughnessFactor - 0.16 * wet + 0.1 * (relief - 0.4) + 0.2 * uColoured, 0.15, 1.0);`
            );
    };
    return material;
}
