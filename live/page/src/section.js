// A plane that takes away one side of the body. The hole is closed by a cap, drawn where the stencil
// counts more back faces than front faces (after the clipping example of three.js).
// SPDX-License-Identifier: LGPL-3.0-or-later
import {
    AlwaysStencilFunc,
    BackSide,
    DecrementWrapStencilOp,
    DoubleSide,
    FrontSide,
    IncrementWrapStencilOp,
    Mesh,
    MeshBasicMaterial,
    MeshLambertMaterial,
    NotEqualStencilFunc,
    Plane,
    PlaneGeometry,
    ReplaceStencilOp,
    Vector3,
} from 'three';

export class Section {
    plane = new Plane(new Vector3(0, 1, 0), 0);
    on = false;
    /** Direction that is looked along: the side before it is taken away. Unit vector. */
    direction = new Vector3(0, 1, 0);
    /** Where the plane is between the near (0) and the far end (1) of the body. */
    offset = 0.5;
    #tissue;
    #box;
    /** @type {Mesh[]} */
    #counters = [];

    /**
     * @param {import('three').Scene} scene
     * @param {import('./tissue.js').Tissue} tissue
     * @param {import('three').Box3} box round the body at rest
     * @param {boolean} low
     */
    constructor(scene, tissue, box, low) {
        this.#tissue = tissue;
        this.#box = box;
        for (const side of [BackSide, FrontSide]) {
            const operation = side === BackSide ? IncrementWrapStencilOp : DecrementWrapStencilOp;
            const counter = new Mesh(
                tissue.geometry,
                new MeshBasicMaterial({
                    side,
                    colorWrite: false,
                    depthWrite: false,
                    depthTest: false,
                    stencilWrite: true,
                    stencilFunc: AlwaysStencilFunc,
                    stencilFail: operation,
                    stencilZFail: operation,
                    stencilZPass: operation,
                    clippingPlanes: [this.plane],
                })
            );
            counter.renderOrder = 1;
            counter.frustumCulled = false;
            this.#counters.push(counter);
        }
        this.cap = new Mesh(new PlaneGeometry(1, 1), this.#capMaterial(low));
        this.cap.renderOrder = 1.1;
        this.cap.onAfterRender = (renderer) => renderer.clearStencil();
        scene.add(...this.#counters, this.cap);
        this.update();
    }

    /** @param {boolean} low */
    #capMaterial(low) {
        const material = new MeshLambertMaterial({
            color: 0xc98d82,
            side: DoubleSide,
            stencilWrite: true,
            stencilRef: 0,
            stencilFunc: NotEqualStencilFunc,
            stencilFail: ReplaceStencilOp,
            stencilZFail: ReplaceStencilOp,
            stencilZPass: ReplaceStencilOp,
        });
        const { grain } = this.#tissue.uniforms;
        material.onBeforeCompile = (shader) => {
            shader.uniforms.uGrain = grain;
            shader.vertexShader = shader.vertexShader
                .replace('#include <common>', '#include <common>\nvarying vec3 vAt;')
                .replace('#include <begin_vertex>', '#include <begin_vertex>\nvAt = (modelMatrix * vec4(transformed, 1.0)).xyz;');
            shader.fragmentShader = shader.fragmentShader
                .replace('#include <common>', '#include <common>\nuniform float uGrain;\nvarying vec3 vAt;')
                .replace(
                    '#include <color_fragment>',
                    `#include <color_fragment>
                    vec3 wave = sin(vAt * uGrain * 0.9 ${low ? '' : '+ 1.7 * sin(vAt.yzx * uGrain * 0.37)'});
                    diffuseColor.rgb *= 0.96 + 0.05 * wave.x * wave.y * wave.z;`
                );
        };
        return material;
    }

    /** Colours the cap like the cut faces, or in grey while a field is shown. @param {import('three').ColorRepresentation} colour */
    setColour(colour) {
        this.cap.material.color.set(colour).multiplyScalar(0.85);
    }

    /** The plane that clips, or null while the section is off. */
    get active() {
        return this.on ? this.plane : null;
    }

    /** Puts the plane where direction and offset say. */
    update() {
        const centre = this.#box.isEmpty() ? new Vector3() : this.#box.getCenter(new Vector3());
        const half = this.#box.isEmpty() ? new Vector3(1, 1, 1) : this.#box.getSize(new Vector3()).multiplyScalar(0.5);
        const n = this.direction;
        const reach = Math.abs(n.x) * half.x + Math.abs(n.y) * half.y + Math.abs(n.z) * half.z;
        const at = centre.clone().addScaledVector(n, (2 * this.offset - 1) * reach * 1.04);
        this.plane.setFromNormalAndCoplanarPoint(n, at);
        const size = 4 * half.length();
        // The cap looks at the side that was taken away.
        this.cap.position.copy(at);
        this.cap.scale.set(size, size, size);
        this.cap.lookAt(at.clone().sub(n));
        for (const counter of this.#counters) {
            counter.visible = this.on && this.#tissue.mesh.visible;
            counter.position.copy(this.#tissue.mesh.position);
        }
        this.cap.visible = this.on && this.#tissue.mesh.visible;
        const planes = this.on ? [this.plane] : null;
        for (const material of [this.#tissue.material, this.#tissue.lips.material]) {
            if (Boolean(material.clippingPlanes) === this.on) continue;
            material.clippingPlanes = planes;
            material.needsUpdate = true;
        }
    }
}
