// The body's surface in the scene: its buffers, colours and normals.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Box3, BufferAttribute, BufferGeometry, Color, Mesh, Sphere, Vector3 } from 'three';
import { tissueColours } from './colours.js';
import { Lips } from './lips.js';
import { computeNormals } from './normals.js';
import { tissueMaterial, tissueUniforms } from './tissue_material.js';

const cutFace = 0x80000000;

/**
 * A slow pattern of lighter and darker patches, from 0 to 1.
 * @param {Float32Array} rest @param {number} vertex @param {number} wave radians in a metre
 */
function mottling(rest, vertex, wave) {
    const [x, y, z] = [rest[3 * vertex] * wave, rest[3 * vertex + 1] * wave, rest[3 * vertex + 2] * wave];
    const warp = Math.sin(1.3 * y + 0.7 * z) + Math.sin(0.9 * x - 1.1 * z);
    return 0.5 + 0.25 * (Math.sin(x + 1.7 * warp) + Math.sin(1.2 * y + z - warp));
}

export class Tissue {
    geometry = new BufferGeometry();
    lips = new Lips();
    uniforms = tissueUniforms();
    /** @type {import('./types.js').Topology|null} */
    topology = null;
    positions = new Float32Array(0);
    normals = new Float32Array(0);
    /** @type {Uint32Array} */
    triangles = new Uint32Array(0);
    origin = new Vector3();
    /** @type {{id: number, name: string}[]} */
    #regions = [];
    /** @type {BufferAttribute|null} */
    #values = null;

    /** @param {boolean} low */
    constructor(low) {
        this.material = tissueMaterial(low, this.uniforms);
        this.mesh = new Mesh(this.geometry, this.material);
        this.mesh.renderOrder = 6;
        this.mesh.castShadow = this.mesh.receiveShadow = !low;
        this.mesh.visible = false;
        // Frames move the surface; a sphere that holds always saves one pass over it each frame.
        this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
        this.mesh.frustumCulled = false;
    }

    /** @param {import('./types.js').Hello} hello */
    setBody(hello) {
        this.#regions = hello.regions;
        this.uniforms.grain.value = 2.2 / hello.element_size;
    }

    /** Draws with less detail from now on. */
    drawLess() {
        this.material.dispose();
        this.mesh.material = this.material = tissueMaterial(true, this.uniforms);
        this.mesh.castShadow = this.mesh.receiveShadow = false;
    }

    /** The box round the body as it is; round its rest shape, if parts of it have gone far away. */
    box() {
        const box = new Box3();
        const rest = new Box3();
        if (!this.topology) return box;
        box.setFromArray(this.positions).translate(this.origin);
        rest.setFromArray(this.topology.rest);
        const size = (/** @type {Box3} */ one) => one.getSize(new Vector3()).length();
        return size(box) < 3 * size(rest) ? box : rest;
    }

    /** Forgets the body, for instance when the connection was lost. */
    clear() {
        this.topology = null;
        this.mesh.visible = this.lips.lines.visible = false;
    }

    /**
     * @param {import('./types.js').Frame} frame
     * @returns {boolean} false if the frame belongs to a topology that this page has not got
     */
    setFrame(frame) {
        if (frame.topology) this.#setTopology(frame.topology, frame.positions.length / 3);
        if (!this.topology || this.topology.version !== frame.version) return false;
        if (frame.positions.length !== this.positions.length) return false;
        this.positions.set(frame.positions);
        computeNormals(this.positions, this.triangles, this.normals);
        this.origin.fromArray(frame.origin);
        this.mesh.position.copy(this.origin);
        this.lips.setPositions(this.positions, this.origin);
        this.geometry.attributes.position.needsUpdate = true;
        this.geometry.attributes.normal.needsUpdate = true;
        if (frame.values && this.#values) {
            this.#values.array.set(frame.values);
            this.#values.needsUpdate = true;
        }
        this.mesh.visible = true;
        return true;
    }

    /** @param {import('./types.js').Topology} topology @param {number} numVertices */
    #setTopology(topology, numVertices) {
        this.topology = topology;
        this.triangles = topology.triangles;
        this.positions = new Float32Array(3 * numVertices);
        this.normals = new Float32Array(3 * numVertices);
        const colours = new Float32Array(3 * numVertices);
        const cut = new Float32Array(numVertices);
        const palette = this.#regions.map(({ name }, index) => {
            const { outside, cut: inner } = tissueColours(name, index);
            return [new Color(outside), new Color(inner)];
        });
        const shade = new Color();
        const wave = this.uniforms.grain.value * 0.1;
        const plain = [new Color('#8a3a31'), new Color('#d4706a')];
        for (let vertex = 0; vertex < numVertices; ++vertex) {
            const tag = topology.tags[vertex];
            cut[vertex] = tag >= cutFace ? 1 : 0;
            const pair = palette[tag & ~cutFace] ?? plain;
            const mottle = cut[vertex] ? 1 : 0.86 + 0.28 * mottling(topology.rest, vertex, wave);
            shade.copy(pair[cut[vertex]]).multiplyScalar(mottle).toArray(colours, 3 * vertex);
        }
        this.lips.setTopology(topology);
        // The old buffers on the card go; a replaced attribute alone would leave them there.
        this.geometry.dispose();
        this.#values = new BufferAttribute(new Float32Array(numVertices), 1);
        this.geometry.setIndex(new BufferAttribute(this.triangles, 1));
        this.geometry.setAttribute('position', new BufferAttribute(this.positions, 3));
        this.geometry.setAttribute('normal', new BufferAttribute(this.normals, 3));
        this.geometry.setAttribute('color', new BufferAttribute(colours, 3));
        this.geometry.setAttribute('rest', new BufferAttribute(topology.rest, 3));
        this.geometry.setAttribute('cut', new BufferAttribute(cut, 1));
        this.geometry.setAttribute('value', this.#values);
    }

    /** True if the vertex belongs to a face that a cut opened. @param {number} vertex */
    isCut(vertex) {
        return (this.topology?.tags[vertex] ?? 0) >= cutFace;
    }

    /** The vertex whose rest position is nearest. @param {number[]} point */
    nearestAtRest(point) {
        const rest = this.topology?.rest;
        if (!rest) return -1;
        let best = Infinity;
        let found = -1;
        for (let i = 0; i < rest.length; i += 3) {
            const distance =
                (rest[i] - point[0]) ** 2 + (rest[i + 1] - point[1]) ** 2 + (rest[i + 2] - point[2]) ** 2;
            if (distance >= best) continue;
            best = distance;
            found = i / 3;
        }
        return found;
    }

    /** Where a vertex is now, in the world. @param {number} vertex */
    position(vertex, target = new Vector3()) {
        return target.fromArray(this.positions, 3 * vertex).add(this.origin);
    }

    /** Where the surface point with these rest coordinates is now. @param {number[]} rest */
    positionOfRest(rest) {
        const vertex = this.nearestAtRest(rest);
        if (vertex < 0 || !this.topology) return new Vector3().fromArray(rest);
        const offset = new Vector3().fromArray(this.topology.rest, 3 * vertex).negate();
        return this.position(vertex).add(offset.add(new Vector3().fromArray(rest)));
    }

    /** Rest coordinates of a picked point. @param {import('./pick.js').Hit} hit */
    restOfHit(hit) {
        const rest = new Vector3();
        if (!hit.vertices || !this.topology) return null;
        hit.vertices.forEach((vertex, i) =>
            rest.addScaledVector(
                new Vector3().fromArray(/** @type {any} */ (this.topology).rest, 3 * vertex),
                hit.weights[i]
            )
        );
        return rest.toArray();
    }
}
