// Where a tool goes for a point of the page: on the surface, or beside it.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Plane, Vector3 } from 'three';
import { nearestToRay, pickSurface } from './pick.js';

export class Aim {
    /** The surface as it was, while it is frozen. @type {Parameters<typeof pickSurface>[1]|null} */
    #frozen = null;

    /**
     * @param {import('./scene.js').Scene} scene
     * @param {import('./tissue.js').Tissue} tissue
     * @param {import('./section.js').Section} section
     */
    constructor(scene, tissue, section) {
        this.scene = scene;
        this.tissue = tissue;
        this.section = section;
    }

    /** What is seen at a point of the page. @param {number} x @param {number} y */
    pick(x, y) {
        if (!this.tissue.mesh.visible) return null;
        return pickSurface(this.scene.ray(x, y), this.#frozen ?? this.tissue, this.section.active);
    }

    /** Aims at the surface as it is now, until thaw() is called. */
    freeze() {
        const { positions, normals, triangles, origin } = this.tissue;
        this.#frozen = { positions: positions.slice(), normals: normals.slice(), triangles, origin: origin.clone() };
    }

    /** Aims at the surface as it moves. */
    thaw() {
        this.#frozen = null;
    }

    /**
     * The point of the page in the plane across the view through an anchor.
     * @param {number} x @param {number} y @param {Vector3} anchor
     */
    across(x, y, anchor) {
        const plane = new Plane().setFromNormalAndCoplanarPoint(this.scene.viewDirection, anchor);
        const ray = this.scene.ray(x, y);
        return ray.intersectPlane(plane, new Vector3()) ?? anchor.clone();
    }

    /**
     * A point beside the body, as far away as the part of the body that appears nearest.
     * A tool that starts there meets the body at its outline, without a jump.
     * @param {number} x @param {number} y
     */
    beside(x, y) {
        const nearest = this.tissue.mesh.visible ? nearestToRay(this.scene.ray(x, y), this.tissue) : null;
        return this.across(x, y, nearest ?? this.scene.controls.target);
    }

    /** Direction from the eye to a point of the page. @param {number} x @param {number} y */
    view(x, y) {
        return this.scene.ray(x, y).direction;
    }

    /**
     * Into the body: half against the normal, half along the view.
     * @param {import('./pick.js').Hit} hit @param {number} x @param {number} y
     */
    into(hit, x, y) {
        return this.view(x, y).sub(hit.normal).normalize();
    }
}
