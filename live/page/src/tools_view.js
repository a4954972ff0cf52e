// How tools look in the scene: what the server holds, what the hand wants, threads and forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
import {
    BoxGeometry,
    BufferAttribute,
    BufferGeometry,
    CapsuleGeometry,
    ConeGeometry,
    CylinderGeometry,
    DoubleSide,
    Group,
    Mesh,
    MeshBasicMaterial,
    MeshPhongMaterial,
    MeshStandardMaterial,
    Quaternion,
    Sphere,
    SphereGeometry,
    Vector3,
} from 'three';
import { matrixOf } from './hand.js';

const up = new Vector3(0, 1, 0);

/** Puts a cylinder or cone of height 1 between two points. @param {import('three').Object3D} part @param {Vector3} from @param {Vector3} to @param {number} width */
function span(part, from, to, width) {
    const along = to.clone().sub(from);
    const length = along.length();
    part.visible = length > 1e-12;
    part.position.copy(from).lerp(to, 0.5);
    if (part.visible) part.quaternion.setFromUnitVectors(up, along.divideScalar(length));
    part.scale.set(width, Math.max(length, 1e-12), width);
}

export class ToolsView {
    group = new Group();
    #low;
    /** @type {Map<string, {definition: string, group: Group, handle: Group|null}>} */
    #shown = new Map();
    #rod = new CylinderGeometry(1, 1, 1, 16);
    #ball = new SphereGeometry(1, 24, 16);
    #arrow = new Group();
    #threads = new Group();
    #size = 0.1;

    /** @param {boolean} low */
    constructor(low) {
        this.#low = low;
        const steel = { color: 0xb9c0c8 };
        this.steel = low
            ? new MeshPhongMaterial({ ...steel, shininess: 60, specular: 0x777777 })
            : new MeshStandardMaterial({ ...steel, metalness: 0.85, roughness: 0.3 });
        this.grip = low
            ? new MeshPhongMaterial({ color: 0x2b3a44 })
            : new MeshStandardMaterial({ color: 0x2b3a44, roughness: 0.6 });
        this.blade = this.steel.clone();
        this.blade.side = DoubleSide;
        this.ghost = new MeshBasicMaterial({ color: 0x9fd8ff, transparent: true, opacity: 0.28, depthWrite: false });
        this.zone = new MeshBasicMaterial({ color: 0x9fd8ff, transparent: true, opacity: 0.14, depthWrite: false });
        this.force = new MeshBasicMaterial({ color: 0xffc857 });
        this.thread = new MeshBasicMaterial({ color: 0xe9f1ff });
        this.pending = new MeshBasicMaterial({ color: 0x6ec1ff });
        this.#arrow.add(new Mesh(this.#rod, this.force), new Mesh(new ConeGeometry(1, 1, 16), this.force));
        this.#arrow.visible = false;
        this.group.add(this.#arrow, this.#threads);
    }

    /** @param {number} diagonal of the body, m */
    setSize(diagonal) {
        this.#size = diagonal;
    }

    /**
     * @param {Object} shown
     * @param {import('./types.js').ToolState[]} shown.tools of the server
     * @param {{tool: import('./types.js').ToolDefinition, pose: import('./types.js').Pose}|null} shown.wanted
     * @param {import('three').Camera} camera
     */
    update({ tools, wanted }, camera) {
        const seen = new Set();
        for (const tool of tools) {
            if (!tool.present || !tool.pose || tool.kind === 'suture') continue;
            seen.add(tool.name);
            this.#place(tool.name, tool.tool, tool.pose, camera, false);
        }
        if (wanted) {
            seen.add('?');
            this.#place('?', wanted.tool, wanted.pose, camera, true);
        }
        for (const [name, { group }] of this.#shown) {
            if (seen.has(name)) continue;
            this.group.remove(group);
            for (const part of group.userData.own ?? []) part.dispose();
            this.#shown.delete(name);
        }
        this.#showForce(tools.find((tool) => tool.mine && tool.present));
    }

    /** @param {string} name @param {import('./types.js').ToolDefinition} tool @param {import('./types.js').Pose} pose @param {import('three').Camera} camera @param {boolean} ghost */
    #place(name, tool, pose, camera, ghost) {
        const definition = JSON.stringify(tool);
        let found = this.#shown.get(name);
        if (found && found.definition !== definition) {
            this.group.remove(found.group);
            for (const part of found.group.userData.own ?? []) part.dispose();
            found = undefined;
        }
        if (!found) {
            const { group, handle } = this.#model(tool, ghost);
            group.matrixAutoUpdate = false;
            this.group.add(group);
            found = { definition, group, handle };
            this.#shown.set(name, found);
        }
        matrixOf(pose, found.group.matrix);
        found.group.matrixWorldNeedsUpdate = true;
        if (found.handle) this.#tilt(found.handle, pose, camera);
    }

    /**
     * A handle leans to the right of the view, as in a right hand, so that it hides little.
     * It is an ornament: what acts is the edge or the ball.
     * @param {Group} handle @param {import('./types.js').Pose} pose @param {import('three').Camera} camera
     */
    #tilt(handle, pose, camera) {
        const turn = new Quaternion().fromArray(pose.rotation);
        const axis = new Vector3(0, 0, 1).applyQuaternion(turn).multiplyScalar(0.55);
        axis.addScaledVector(new Vector3().setFromMatrixColumn(camera.matrixWorld, 0), 0.75);
        axis.addScaledVector(new Vector3().setFromMatrixColumn(camera.matrixWorld, 1), 0.45);
        axis.normalize().applyQuaternion(turn.invert());
        handle.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), axis);
    }

    /** @param {import('./types.js').ToolDefinition} tool @param {boolean} ghost */
    #model(tool, ghost) {
        const group = new Group();
        /** @type {Group|null} */
        let handle = null;
        const add = (/** @type {import('three').BufferGeometry} */ geometry, /** @type {import('three').Material} */ material, parent = group) => {
            const mesh = new Mesh(geometry, ghost ? this.ghost : material);
            mesh.castShadow = !ghost && !this.#low;
            // No bounds are worked out from sizes that another page may have sent.
            mesh.frustumCulled = false;
            geometry.boundingSphere ??= new Sphere(new Vector3(), Infinity);
            parent.add(mesh);
            if (geometry !== this.#rod && geometry !== this.#ball) (group.userData.own ??= []).push(geometry);
            return mesh;
        };
        const size = this.#size;
        const shaft = (/** @type {number} */ width) => {
            handle = new Group();
            group.add(handle);
            if (ghost) return;
            span(add(this.#rod, this.steel, handle), new Vector3(), new Vector3(0, 0, 0.2 * size), 0.35 * width);
            span(add(this.#rod, this.grip, handle), new Vector3(0, 0, 0.17 * size), new Vector3(0, 0, 0.5 * size), width);
        };
        if (tool.kind === 'blade' && tool.edge) {
            const long = tool.edge.some((point) => Math.hypot(...point) > 0.9 * size);
            add(this.#ribbon(tool.edge, long ? 0.008 * size : 0.03 * size), this.blade);
            if (!long) shaft(0.016 * size);
        }
        const { sphere, box, capsule } = tool.shape ?? {};
        if (sphere) {
            const solid = tool.kind === 'probe' || tool.kind === 'carver';
            add(this.#ball, solid ? this.steel : this.zone).scale.setScalar(sphere.radius);
            if (tool.kind === 'carver') this.#ridges(add, sphere.radius);
            if (tool.kind === 'grasper') this.#jaws(add, sphere.radius);
            shaft(0.012 * size);
        }
        if (box) add(new BoxGeometry(...box.size), tool.kind === 'grasper' ? this.zone : this.steel);
        if (capsule) {
            const from = new Vector3().fromArray(capsule.from);
            const to = new Vector3().fromArray(capsule.to);
            const mesh = add(new CapsuleGeometry(capsule.radius, from.distanceTo(to), 8, 20), this.steel);
            mesh.position.copy(from).lerp(to, 0.5);
            mesh.quaternion.setFromUnitVectors(up, to.sub(from).normalize());
        }
        return { group, handle };
    }

    /** A strip behind the edge of a blade. @param {number[][]} edge @param {number} width */
    #ribbon(edge, width) {
        /** @type {number[]} */
        const positions = [];
        /** @type {number[]} */
        const index = [];
        edge.forEach(([x, y, z], i) => {
            // The strip narrows to the tip, as the blade of a scalpel does.
            const part = i === edge.length - 1 ? 0.1 : 1;
            positions.push(x, y, z, x + width * part, y, z);
            if (i) index.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
        });
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
        geometry.setIndex(index);
        geometry.computeVertexNormals();
        return geometry;
    }

    /** @param {Function} add @param {number} radius */
    #ridges(add, radius) {
        for (let i = 0; i < 6; ++i) {
            const mesh = add(new BoxGeometry(0.08, 2.08, 0.5), this.grip);
            mesh.scale.setScalar(radius);
            mesh.rotation.set(Math.PI / 2, (i * Math.PI) / 6, 0);
        }
    }

    /** @param {Function} add @param {number} radius */
    #jaws(add, radius) {
        for (const side of [-1, 1]) {
            const mesh = add(new CapsuleGeometry(0.18, 1.4, 6, 12), this.steel);
            mesh.scale.set(radius, radius, radius * 0.6);
            mesh.position.set(side * 0.22 * radius, 0, 0.5 * radius);
            mesh.rotation.set(Math.PI / 2, 0, side * 0.18);
        }
    }

    /** @param {import('./types.js').ToolState|undefined} tool */
    #showForce(tool) {
        const force = new Vector3().fromArray(tool?.force ?? [0, 0, 0]);
        const size = force.length();
        this.#arrow.visible = Boolean(tool?.pose) && size > 1e-4;
        if (!tool?.pose || !this.#arrow.visible) return;
        // The arrow grows with the force but stays in the picture.
        const length = this.#size * 0.3 * (1 - Math.exp(-Math.sqrt(size) / 1.5)) + 0.03 * this.#size;
        const along = force.divideScalar(size);
        const from = new Vector3().fromArray(tool.pose.at);
        const neck = from.clone().addScaledVector(along, length * 0.75);
        const tip = from.clone().addScaledVector(along, length);
        const [rod, cone] = this.#arrow.children;
        span(rod, from, neck, 0.006 * this.#size);
        span(cone, neck, tip, 0.016 * this.#size);
    }

    /**
     * @param {Vector3[][]} tied where the points of each thread are
     * @param {Vector3[]} pending the points of the thread that is being laid
     */
    showThreads(tied, pending) {
        const parts = this.#threads;
        let used = 0;
        const part = (/** @type {import('three').BufferGeometry} */ geometry, /** @type {import('three').Material} */ material) => {
            let mesh = /** @type {Mesh|undefined} */ (parts.children[used++]);
            if (!mesh) parts.add((mesh = new Mesh()));
            mesh.geometry = geometry;
            mesh.material = material;
            mesh.visible = true;
            mesh.quaternion.identity();
            return mesh;
        };
        const thin = 0.0035 * this.#size;
        const dot = (/** @type {Vector3} */ at, /** @type {import('three').Material} */ material) => {
            const mesh = part(this.#ball, material);
            mesh.position.copy(at);
            mesh.scale.setScalar(2.2 * thin);
        };
        const line = (/** @type {Vector3[]} */ points, /** @type {import('three').Material} */ material) => {
            points.forEach((at, i) => {
                dot(at, material);
                if (i) span(part(this.#rod, material), points[i - 1], at, thin);
            });
        };
        for (const points of tied) line(points, this.thread);
        line(pending, this.pending);
        for (let i = used; i < parts.children.length; ++i) parts.children[i].visible = false;
    }
}
