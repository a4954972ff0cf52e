// The renderer, the camera and the lights. A picture is drawn only when something changed.
// SPDX-License-Identifier: LGPL-3.0-or-later
import {
    Box3,
    Color,
    DirectionalLight,
    HemisphereLight,
    MOUSE,
    NeutralToneMapping,
    NoToneMapping,
    PCFShadowMap,
    PerspectiveCamera,
    PMREMGenerator,
    Raycaster,
    Scene as ThreeScene,
    TOUCH,
    Vector2,
    Vector3,
    WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const background = 0x15181c;

/** Light from above, where z points. @param {number} sky @param {number} ground @param {number} intensity */
function skyLight(sky, ground, intensity) {
    const light = new HemisphereLight(sky, ground, intensity);
    light.position.set(0, 0, 1);
    return light;
}

export class Scene {
    three = new ThreeScene();
    camera = new PerspectiveCamera(32, 1, 0.001, 10);
    /** Number of pictures that were drawn. */
    pictures = 0;
    /** The box round the body at rest. */
    box = new Box3();
    #low;
    #wanted = false;
    #last = 0;
    /** @type {((seconds: number) => boolean)[]} */
    #steps = [];
    /** @type {(() => void)[]} */
    #watchers = [];
    #raycaster = new Raycaster();

    /**
     * @param {HTMLElement} stage
     * @param {boolean} low
     */
    constructor(stage, low) {
        this.#low = low;
        this.stage = stage;
        this.renderer = new WebGLRenderer({ antialias: !low, stencil: true, powerPreference: 'high-performance' });
        this.renderer.setPixelRatio(low ? 0.6 : Math.min(devicePixelRatio, 2));
        this.renderer.toneMapping = low ? NoToneMapping : NeutralToneMapping;
        this.renderer.toneMappingExposure = 0.95;
        this.renderer.localClippingEnabled = true;
        this.canvas = this.renderer.domElement;
        this.canvas.tabIndex = 0;
        this.canvas.setAttribute('role', 'application');
        this.canvas.setAttribute('aria-label', 'The body. Arrow keys move the tool, Enter takes and drops it.');
        stage.append(this.canvas);
        this.three.background = new Color(background);
        this.camera.up.set(0, 0, 1);
        this.#addLights();
        this.controls = this.#addControls();
        new ResizeObserver(() => this.#resize()).observe(stage);
        this.#resize();
    }

    #addLights() {
        this.key = new DirectionalLight(0xfff4e6, this.#low ? 2.1 : 2.3);
        this.rim = new DirectionalLight(0xbfd4ff, 0.7);
        this.three.add(this.key, this.key.target);
        if (!this.#low) this.three.add(this.rim, this.rim.target);
        else {
            this.three.add(skyLight(0xdfe6f0, 0x75625c, 1.7));
            return;
        }
        this.three.add(skyLight(0xdfe6f0, 0x8a7268, 0.4));
        const generator = new PMREMGenerator(this.renderer);
        const room = new RoomEnvironment();
        this.three.environment = generator.fromScene(room, 0.04).texture;
        this.three.environmentIntensity = 0.4;
        this.three.environmentRotation.x = Math.PI / 2;
        room.dispose();
        generator.dispose();
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = PCFShadowMap;
        this.key.castShadow = true;
        this.key.shadow.mapSize.set(2048, 2048);
        this.key.shadow.radius = 3;
        this.key.shadow.intensity = 0.8;
    }

    #addControls() {
        const controls = new OrbitControls(this.camera, this.canvas);
        controls.enableDamping = true;
        controls.dampingFactor = 0.18;
        controls.rotateSpeed = 0.8;
        controls.zoomToCursor = true;
        controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE };
        controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
        controls.addEventListener('change', () => this.invalidate());
        return controls;
    }

    /** Looks at the body from the front, a little from above. @param {number[][]} size */
    frame(size) {
        this.box.min.fromArray(size[0]);
        this.box.max.fromArray(size[1]);
        const centre = this.box.getCenter(new Vector3());
        const radius = Math.max(this.diagonal / 2, 1e-9);
        const narrow = Math.min(1, this.camera.aspect * (this.#insets() ? 0.78 : 1));
        const distance = (radius * 0.8) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
        this.camera.near = distance / 100;
        this.camera.far = distance * 20;
        this.camera.position
            .set(0.32, -1, 0.62)
            .normalize()
            .multiplyScalar(distance)
            .add(centre);
        this.controls.target.copy(centre);
        this.controls.minDistance = radius * 0.08;
        this.controls.maxDistance = distance * 6;
        const shadow = this.key?.shadow;
        if (shadow?.camera) {
            const { camera } = shadow;
            camera.left = camera.bottom = -1.4 * radius;
            camera.right = camera.top = 1.4 * radius;
            camera.near = radius;
            camera.far = 9 * radius;
            camera.updateProjectionMatrix();
            shadow.normalBias = radius * 0.012;
            shadow.bias = -0.0008;
        }
        this.controls.update();
        this.#resize();
    }

    get diagonal() {
        return this.box.getSize(new Vector3()).length();
    }

    /** Width that the panels take on the sides, in pixels; zero on narrow pages. */
    #insets() {
        return this.stage.clientWidth >= 720 ? 180 : 0;
    }

    #resize() {
        const width = Math.max(this.stage.clientWidth, 1);
        const height = Math.max(this.stage.clientHeight, 1);
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        // The body stands in the middle of what the panels leave.
        if (this.#insets()) this.camera.setViewOffset(width, height, this.#insets() / 2, 0, width, height);
        else this.camera.clearViewOffset();
        this.camera.updateProjectionMatrix();
        this.draw();
    }

    /** Asks for a picture at the next opportunity. */
    invalidate() {
        if (this.#wanted) return;
        this.#wanted = true;
        requestAnimationFrame((now) => this.#onAnimationFrame(now));
    }

    /** @param {number} now milliseconds */
    #onAnimationFrame(now) {
        this.#wanted = false;
        const seconds = Math.min((now - this.#last) / 1000, 0.1);
        this.#last = now;
        if (this.controls.update()) this.invalidate();
        for (const step of this.#steps) if (step(seconds)) this.invalidate();
        this.draw();
    }

    /** Calls a function before each picture; the function returns true if it wants another one. @param {(seconds: number) => boolean} step */
    beforeEach(step) {
        this.#steps.push(step);
    }

    /** Calls a function after each picture. @param {() => void} watcher */
    afterEach(watcher) {
        this.#watchers.push(watcher);
    }

    draw() {
        this.camera.updateMatrixWorld();
        this.#placeLights();
        this.renderer.render(this.three, this.camera);
        ++this.pictures;
        for (const watcher of this.#watchers) watcher();
    }

    /** The lights come from over the viewer's left shoulder, and from behind the body. */
    #placeLights() {
        if (!this.key || !this.rim) return;
        const centre = this.box.isEmpty() ? new Vector3() : this.box.getCenter(new Vector3());
        const reach = 2.5 * Math.max(this.diagonal, 1e-3);
        const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
        const up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
        const back = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 2);
        this.key.target.position.copy(centre);
        this.rim.target.position.copy(centre);
        const towards = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ z) =>
            new Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(back, z).normalize();
        this.key.position.copy(centre).addScaledVector(towards(-0.5, 0.75, 1), reach);
        this.rim.position.copy(centre).addScaledVector(towards(0.8, 0.35, -0.6), reach);
    }

    /** The ray through a point of the page. @param {number} x @param {number} y */
    ray(x, y) {
        const box = this.canvas.getBoundingClientRect();
        const at = new Vector2(
            (2 * (x - box.left)) / box.width - 1,
            1 - (2 * (y - box.top)) / box.height
        );
        this.#raycaster.setFromCamera(at, this.camera);
        return this.#raycaster.ray.clone();
    }

    /** Direction in which the camera looks. */
    get viewDirection() {
        return this.camera.getWorldDirection(new Vector3());
    }

    /** Where a point of the world appears on the page. @param {Vector3} point */
    onScreen(point) {
        const at = point.clone().project(this.camera);
        const box = this.canvas.getBoundingClientRect();
        return {
            x: box.left + ((at.x + 1) / 2) * box.width,
            y: box.top + ((1 - at.y) / 2) * box.height,
        };
    }

    /** Metres in a pixel of the page at the point round which the camera turns. */
    get metresPerPixel() {
        const distance = this.camera.position.distanceTo(this.controls.target);
        const height = 2 * distance * Math.tan((this.camera.fov * Math.PI) / 360);
        return height / Math.max(this.stage.clientHeight, 1);
    }
}
