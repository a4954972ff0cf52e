// From the mouse, pen or finger to the mode: which button does what, and what a drag does.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { MOUSE, TOUCH } from 'three';

export class Pointer {
    /** Where the pointer is over the canvas, in pixels of the page; null if it is elsewhere. @type {{x: number, y: number}|null} */
    at = null;
    /** True while a drag uses the tool. */
    dragging = false;
    #id = -1;
    /** The pointer has moved since the mode heard of it. */
    #moved = false;
    #desk;

    /**
     * @param {import('./scene.js').Scene} scene
     * @param {Object} desk
     * @param {() => import('./modes/mode.js').Mode|null} desk.mode null in the look mode
     * @param {() => boolean} desk.allowed false while another page holds the tools
     * @param {() => boolean} desk.inUse true while a tool is in the hand
     */
    constructor(scene, desk) {
        this.#desk = desk;
        const { canvas } = scene;
        this.scene = scene;
        // Before OrbitControls, which listens on the canvas too, without capture.
        const first = { capture: true };
        canvas.addEventListener('pointerdown', (event) => this.#down(event), first);
        canvas.addEventListener('pointermove', (event) => this.#move(event), first);
        // Browsers hold movements back until the next picture, which may take a second; not these.
        canvas.addEventListener('pointerrawupdate', (event) => this.#moveRaw(/** @type {PointerEvent} */ (event)), first);
        canvas.addEventListener('pointerup', (event) => this.#up(event), first);
        canvas.addEventListener('pointercancel', (event) => this.#up(event), first);
        canvas.addEventListener('pointerleave', () => {
            if (!this.dragging) this.at = null;
            scene.invalidate();
        });
        canvas.addEventListener('wheel', (event) => this.#wheel(event), { capture: true, passive: false });
        this.arrange();
    }

    /** Gives the left button and a single finger to the camera or to the tool. */
    arrange() {
        const { controls, canvas } = this.scene;
        const look = this.#desk.mode() === null;
        controls.mouseButtons.LEFT = look ? MOUSE.ROTATE : null;
        controls.mouseButtons.MIDDLE = MOUSE.PAN;
        controls.mouseButtons.RIGHT = MOUSE.ROTATE;
        controls.touches.ONE = look ? TOUCH.ROTATE : null;
        controls.touches.TWO = look ? TOUCH.DOLLY_PAN : TOUCH.DOLLY_ROTATE;
        canvas.classList.toggle('uses-tool', !look);
    }

    /** @param {PointerEvent} event */
    #down(event) {
        this.scene.canvas.focus({ preventScroll: true });
        const mode = this.#desk.mode();
        if (!mode || event.button !== 0 || !event.isPrimary) {
            // A second finger turns the camera; the tool lets go.
            if (this.dragging && event.pointerType === 'touch') this.stop();
            return;
        }
        event.stopImmediatePropagation();
        event.preventDefault();
        if (!this.#desk.allowed()) return;
        this.scene.canvas.setPointerCapture(event.pointerId);
        this.#id = event.pointerId;
        this.dragging = true;
        this.#moved = false;
        this.at = { x: event.clientX, y: event.clientY };
        mode.begin(event.clientX, event.clientY);
        this.scene.invalidate();
    }

    /** @param {PointerEvent} event */
    #move(event) {
        if (event.buttons && !this.dragging) {
            this.at = null;
            return;
        }
        if (this.dragging && event.pointerId !== this.#id) return;
        this.at = { x: event.clientX, y: event.clientY };
        if (this.dragging) {
            event.stopImmediatePropagation();
            this.#moved = true;
        }
        if (this.#desk.mode()) this.scene.invalidate();
    }

    /** @param {PointerEvent} event */
    #moveRaw(event) {
        if (!this.dragging || event.pointerId !== this.#id) return;
        this.at = { x: event.clientX, y: event.clientY };
        this.#moved = true;
    }

    /** Tells the mode where the pointer is, if it has moved in a drag. */
    deliver() {
        if (!this.dragging || !this.#moved || !this.at) return;
        this.#moved = false;
        this.#desk.mode()?.move(this.at.x, this.at.y);
    }

    /** @param {PointerEvent} event */
    #up(event) {
        if (!this.dragging || event.pointerId !== this.#id) return;
        event.stopImmediatePropagation();
        if (event.type === 'pointerup') {
            this.at = { x: event.clientX, y: event.clientY };
            this.#moved = true;
        }
        this.stop();
    }

    /** Ends the drag where the pointer was last. */
    stop() {
        if (!this.dragging) return;
        this.deliver();
        this.dragging = this.#moved = false;
        this.#desk.mode()?.end();
        this.scene.invalidate();
    }

    /** @param {WheelEvent} event */
    #wheel(event) {
        const mode = this.#desk.mode();
        if (!mode || event.ctrlKey || !(this.dragging || this.#desk.inUse() || mode.wheelsWhenIdle)) return;
        // A wheel that is turned away from the user goes down into the body.
        if (mode.deepen(event.deltaY < 0 ? 1 : -1)) {
            event.preventDefault();
            event.stopImmediatePropagation();
            this.scene.invalidate();
        }
    }
}
