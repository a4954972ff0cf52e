// How tools look in the scene: those of the scenario and of hands, what the hand wants, threads and forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
import {
    BoxGeometry,
    BufferAttribute,
    BufferGeometry,
    CapsuleGeometry,
    ConeGeometry,
    CylinderGeometry,
    DoubleSide,
    FrontSide,
    Group,
    Matrix4,
    Mesh,
    MeshBasicMaterial,
    MeshLambertMaterial,
    MeshPhongMaterial,
    MeshStandardMaterial,
    PlaneGeometry,
    Quaternion,
    Sphere,
    SphereGeometry,
    Vector3,
} from 'three';
import { toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import { matrixOf } from './hand.js';
import { modeOfKind } from './modes/index.js';

const up = new Vector3(0, 1, 0);

/** Edge of the plate that stands for a half space, in diagonals of the body. */
const plate = 4;
/** Radians between two faces of a mesh whose edge is not rounded. */
const crease = 0.9;

/** Puts a cylinder or cone of height 1 between two points. @param {import('three').Object3D} part @param {Vector3} from @param {Vector3} to @param {number} width */
function span(part, from, to, width) {
    const along = to.clone().sub(from);
    const length = along.length();
    part.visible = length > 1e-12;
    part.position.copy(from).lerp(to, 0.5);
    if (part.visible) part.quaternion.setFromUnitVectors(up, along.divideScalar(length));
    part.scale.set(width, Math.max(length, 1e-12), width);
}

/**
 * What a mode draws a tool with, in the frame of the tool.
 * @typedef {Object} Brush
 * @property {(edge: number[][], width: number, side: number[]) => void} ribbon a sharp strip along a line of points, m,
 *     that extends to one side of it
 * @property {(width: number) => void} shaft the handle of a tool that a hand leads, m
 * @property {number} size diagonal of the body, m
 */

/** What is drawn of a tool in its present state. @param {{kind: string, tool: import('./types.js').ToolDefinition, closed?: boolean}} state */
const asShown = (state) => modeOfKind(state.kind)?.shown?.(state) ?? state.tool;

/** @typedef {'held'|'ghost'|'scripted'|'obstacle'} Part what a tool is in the scene */

export class ToolsView {
    group = new Group();
    #low;
    /** @type {Map<string, {tool: import('./types.js').ToolDefinition, definition: string, group: Group, handle: Group|null}>} */
    #shown = new Map();
    #rod = new CylinderGeometry(1, 1, 1, 16);
    #ball = new SphereGeometry(1, 24, 16);
    #cone = new ConeGeometry(1, 1, 16);
    #arrows = new Group();
    #threads = new Group();
    #size = 0.1;
    /** Middle of the body at rest. */
    #centre = new Vector3();

    /** @param {boolean} low */
    constructor(low) {
        this.#low = low;
        this.#addMaterials(low);
        this.ghost = new MeshBasicMaterial({ color: 0x9fd8ff, transparent: true, opacity: 0.28, depthWrite: false });
        this.zone = new MeshBasicMaterial({ color: 0x9fd8ff, transparent: true, opacity: 0.14, depthWrite: false });
        this.force = new MeshBasicMaterial({ color: 0xffc857 });
        this.thread = new MeshBasicMaterial({ color: 0xe9f1ff });
        this.pending = new MeshBasicMaterial({ color: 0x6ec1ff });
        this.group.add(this.#arrows, this.#threads);
    }

    /** Draws with less detail from now on. */
    drawLess() {
        this.#low = true;
        for (const material of [this.steel, this.grip, this.blade, this.matt, this.plate]) material?.dispose();
        this.#addMaterials(true);
        this.#removeAll();
    }

    /** @param {boolean} low */
    #addMaterials(low) {
        const steel = { color: 0xb9c0c8 };
        this.steel = low
            ? new MeshPhongMaterial({ ...steel, shininess: 60, specular: 0x777777 })
            : new MeshStandardMaterial({ ...steel, metalness: 0.85, roughness: 0.3 });
        this.grip = low
            ? new MeshPhongMaterial({ color: 0x2b3a44 })
            : new MeshStandardMaterial({ color: 0x2b3a44, roughness: 0.6 });
        this.blade = this.steel.clone();
        this.blade.side = DoubleSide;
        const matt = { color: 0x6d7f8c, side: DoubleSide };
        this.matt = low ? new MeshLambertMaterial(matt) : new MeshStandardMaterial({ ...matt, roughness: 0.95 });
        // A plate is seen through from below, and fades towards its edge.
        const faint = { color: 0x424d57, side: FrontSide, transparent: true, vertexColors: true, depthWrite: false };
        const farther = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 };
        this.plate = low
            ? new MeshLambertMaterial({ ...faint, ...farther })
            : new MeshStandardMaterial({ ...faint, ...farther, roughness: 0.95 });
    }

    /** @param {number} diagonal of the body, m @param {Vector3} centre of the body at rest */
    setBody(diagonal, centre) {
        this.#size = diagonal;
        this.#centre.copy(centre);
        this.#removeAll();
    }

    #removeAll() {
        for (const name of this.#shown.keys()) this.#remove(name);
    }

    /** Names of the tools of the scenario that are drawn, for tests. */
    get scripted() {
        return [...this.#shown.keys()].filter((name) => name.startsWith('=')).map((name) => name.slice(1));
    }

    /** @param {string} name */
    #remove(name) {
        const group = this.#shown.get(name)?.group;
        if (!group) return;
        this.group.remove(group);
        for (const part of group.userData.own ?? []) part.dispose();
        this.#shown.delete(name);
    }

    /**
     * @param {Object} shown
     * @param {import('./types.js').ToolState[]} shown.tools in hands
     * @param {import('./types.js').PlacedTool[]} shown.scripted tools of the scenario, and obstacles
     * @param {{tool: import('./types.js').ToolDefinition, pose: import('./types.js').Pose}|null} shown.wanted
     * @param {import('three').Camera} camera
     */
    update({ tools, scripted, wanted }, camera) {
        const seen = new Set();
        for (const one of scripted) {
            if (!one.present || !one.pose) continue;
            seen.add(`=${one.name}`);
            this.#place(`=${one.name}`, asShown(one), one.pose, camera, one.is_obstacle ? 'obstacle' : 'scripted');
        }
        for (const tool of tools) {
            if (!tool.present || !tool.pose || tool.kind === 'suture') continue;
            seen.add(tool.name);
            this.#place(tool.name, asShown(tool), tool.pose, camera, 'held');
        }
        if (wanted) {
            seen.add('?');
            this.#place('?', wanted.tool, wanted.pose, camera, 'ghost');
        }
        for (const name of this.#shown.keys()) if (!seen.has(name)) this.#remove(name);
        const own = tools.filter((tool) => tool.mine && tool.present);
        // A table has no place of its own that its force could start from.
        this.#showForces([...own, ...scripted.filter((one) => one.present && !one.is_obstacle)]);
    }

    /** @param {string} name @param {import('./types.js').ToolDefinition} tool @param {import('./types.js').Pose} pose @param {import('three').Camera} camera @param {Part} part */
    #place(name, tool, pose, camera, part) {
        let found = this.#shown.get(name);
        if (found?.tool !== tool) {
            // Each state brings the definitions of held tools anew; they rarely differ.
            const definition = JSON.stringify(tool);
            if (found?.definition === definition) found.tool = tool;
            else {
                this.#remove(name);
                const { group, handle } = this.#model(tool, part, pose);
                group.matrixAutoUpdate = false;
                this.group.add(group);
                found = { tool, definition, group, handle };
                this.#shown.set(name, found);
            }
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

    /**
     * @param {import('./types.js').ToolDefinition} tool
     * @param {Part} part
     * @param {import('./types.js').Pose} pose
     */
    #model(tool, part, pose) {
        const group = new Group();
        const ghost = part === 'ghost';
        const scripted = part === 'scripted' || part === 'obstacle';
        const solid = part === 'obstacle' ? this.matt : this.steel;
        /** @type {Group|null} */
        let handle = null;
        const add = (/** @type {import('three').BufferGeometry} */ geometry, /** @type {import('three').Material} */ material, parent = group) => {
            const mesh = new Mesh(geometry, ghost ? this.ghost : material);
            mesh.castShadow = !ghost && !this.#low;
            mesh.receiveShadow = part === 'obstacle' && !this.#low;
            // No bounds are worked out from sizes that another page may have sent.
            mesh.frustumCulled = false;
            geometry.boundingSphere ??= new Sphere(new Vector3(), Infinity);
            parent.add(mesh);
            if (geometry !== this.#rod && geometry !== this.#ball) (group.userData.own ??= []).push(geometry);
            return mesh;
        };
        const size = this.#size;
        const shaft = (/** @type {number} */ width) => {
            if (scripted) return;
            handle = new Group();
            group.add(handle);
            if (ghost) return;
            span(add(this.#rod, this.steel, handle), new Vector3(), new Vector3(0, 0, 0.2 * size), 0.35 * width);
            span(add(this.#rod, this.grip, handle), new Vector3(0, 0, 0.17 * size), new Vector3(0, 0, 0.5 * size), width);
        };
        if (tool.kind === 'blade' && tool.edge) {
            const long = tool.edge.some((point) => Math.hypot(...point) > 0.9 * size);
            add(this.#ribbon(tool.edge, long ? 0.008 * size : 0.03 * size, !scripted), this.blade);
            if (!long) shaft(0.016 * size);
        }
        const ribbon = (/** @type {number[][]} */ edge, /** @type {number} */ width, /** @type {number[]} */ side) =>
            void add(this.#ribbon(edge, width, !scripted, new Vector3().fromArray(side)), this.blade);
        modeOfKind(tool.kind)?.draw?.(tool, { ribbon, shaft, size });
        const { sphere, box, capsule, mesh, plane } = tool.shape ?? {};
        if (sphere) {
            add(this.#ball, tool.kind === 'grasper' ? this.zone : solid).scale.setScalar(sphere.radius);
            if (tool.kind === 'carver') this.#ridges(add, sphere.radius);
            if (tool.kind === 'grasper' && !scripted) this.#jaws(add, sphere.radius);
            shaft(0.012 * size);
        }
        if (box) add(new BoxGeometry(...box.size), tool.kind === 'grasper' ? this.zone : solid);
        if (capsule) {
            const from = new Vector3().fromArray(capsule.from);
            const to = new Vector3().fromArray(capsule.to);
            const rod = add(new CapsuleGeometry(capsule.radius, from.distanceTo(to), 8, 20), tool.kind === 'grasper' ? this.zone : solid);
            rod.position.copy(from).lerp(to, 0.5);
            rod.quaternion.setFromUnitVectors(up, to.sub(from).normalize());
        }
        if (mesh) add(this.#solid(mesh), part === 'obstacle' ? this.matt : this.blade);
        if (plane) this.#addPlate(add, plane, pose);
        return { group, handle };
    }

    /** A surface of triangles with flat faces and round ones. @param {{points: number[][], triangles: number[][]}} surface */
    #solid({ points, triangles }) {
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(points.flat()), 3));
        geometry.setIndex(triangles.flat());
        const creased = toCreasedNormals(geometry, crease);
        if (creased !== geometry) geometry.dispose();
        return creased;
    }

    /**
     * A half space as a square plate under the body, which fades towards its edge.
     * @param {Function} add
     * @param {{point: number[], normal: number[]}} plane in the tool's frame
     * @param {import('./types.js').Pose} pose
     */
    #addPlate(add, { point, normal }, pose) {
        const n = new Vector3().fromArray(normal).normalize();
        const at = this.#centre.clone().applyMatrix4(matrixOf(pose, new Matrix4()).invert());
        at.addScaledVector(n, n.dot(new Vector3().fromArray(point).sub(at)));
        const geometry = new PlaneGeometry(1, 1, 20, 20);
        const { position } = geometry.attributes;
        const colours = new Float32Array(4 * position.count).fill(1);
        for (let i = 0; i < position.count; ++i) {
            const out = 2 * Math.max(Math.abs(position.getX(i)), Math.abs(position.getY(i)));
            colours[4 * i + 3] = 0.9 * Math.min((1 - out) / 0.6, 1);
        }
        geometry.setAttribute('color', new BufferAttribute(colours, 4));
        const mesh = add(geometry, this.plate);
        mesh.castShadow = false;
        mesh.scale.setScalar(plate * this.#size);
        mesh.position.copy(at);
        mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), n);
    }

    /**
     * A strip behind the edge of a blade.
     * @param {number[][]} edge @param {number} width @param {boolean} pointed @param {Vector3|null} [towards] its side
     */
    #ribbon(edge, width, pointed, towards = null) {
        // The strip is to stand upright, where the edge does not.
        const along = new Vector3().fromArray(edge[edge.length - 1]).sub(new Vector3().fromArray(edge[0])).normalize();
        const side = towards ?? (Math.abs(along.z) < 0.8 ? new Vector3(0, 0, 1).addScaledVector(along, -along.z).normalize() : new Vector3(1, 0, 0));
        /** @type {number[]} */
        const positions = [];
        /** @type {number[]} */
        const index = [];
        edge.forEach(([x, y, z], i) => {
            // The strip narrows to the tip, as the blade of a scalpel does.
            const wide = pointed && i === edge.length - 1 ? 0.1 * width : width;
            positions.push(x, y, z, x + wide * side.x, y + wide * side.y, z + wide * side.z);
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

    /** @param {{pose?: import('./types.js').Pose|null, force?: number[]|null}[]} tools */
    #showForces(tools) {
        let used = 0;
        for (const { pose, force } of tools) {
            if (!pose || !force || Math.hypot(...force) <= 1e-4) continue;
            let arrow = this.#arrows.children[used++];
            if (!arrow) this.#arrows.add((arrow = new Group().add(new Mesh(this.#rod, this.force), new Mesh(this.#cone, this.force))));
            arrow.visible = true;
            this.#point(arrow, new Vector3().fromArray(pose.at), new Vector3().fromArray(force));
        }
        for (const arrow of this.#arrows.children.slice(used)) arrow.visible = false;
    }

    /** @param {import('three').Object3D} arrow @param {Vector3} from @param {Vector3} force */
    #point(arrow, from, force) {
        const size = force.length();
        // The arrow grows with the force but stays in the picture.
        const length = this.#size * 0.3 * (1 - Math.exp(-Math.sqrt(size) / 1.5)) + 0.03 * this.#size;
        const along = force.divideScalar(size);
        const neck = from.clone().addScaledVector(along, length * 0.75);
        const tip = from.clone().addScaledVector(along, length);
        const [rod, cone] = arrow.children;
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
