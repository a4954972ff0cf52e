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
import { freeArea } from './free_area.js';

const background = 0x15181c;
/** Pixels between the body and the panels. */
const margin = 14;
/** A picture that takes more milliseconds is slow; so many, and so many milliseconds of them, are too much. */
const slow = 100;
const tooSlow = { pictures: 5, time: 2500 };

/** Light from above, where z points. @param {number} sky @param {number} ground @param {number} intensity */
function skyLight(sky, ground, intensity) {
    const light = new HemisphereLight(sky, ground, intensity);
    light.position.set(0, 0, 1);
    return light;
}

export class Scene {
    three = new ThreeScene();
    sky = { full: skyLight(0xdfe6f0, 0x8a7268, 0.4), low: skyLight(0xdfe6f0, 0x75625c, 1.7) };
    camera = new PerspectiveCamera(32, 1, 0.001, 10);
    /** Number of pictures that were drawn. */
    pictures = 0;
    /** The box round the body at rest. */
    box = new Box3();
    #low;
    #wanted = false;
    /** When the next picture was asked for. */
    #asked = 0;
    #slow = { pictures: 0, time: 0 };
    /** Called once if pictures take long for a while; they have less detail then. */
    onSlow = () => {};
    /** The camera is where fit() put it. @type {Box3|null} */
    #fitted = null;
    /** @type {(() => boolean)[]} */
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
        this.#setQuality();
        this.controls = this.#addControls();
        new ResizeObserver(() => this.#resize()).observe(stage);
        this.#resize();
    }

    #addLights() {
        this.key = new DirectionalLight(0xfff4e6);
        this.rim = new DirectionalLight(0xbfd4ff, 0.7);
        this.three.add(this.key, this.key.target, this.rim, this.rim.target);
        this.three.add(this.sky.full, this.sky.low);
        if (this.#low) return;
        const generator = new PMREMGenerator(this.renderer);
        const room = new RoomEnvironment();
        this.three.environment = generator.fromScene(room, 0.04).texture;
        this.three.environmentIntensity = 0.4;
        this.three.environmentRotation.x = Math.PI / 2;
        room.dispose();
        generator.dispose();
        this.renderer.shadowMap.type = PCFShadowMap;
        this.key.shadow.mapSize.set(2048, 2048);
        this.key.shadow.radius = 3;
        this.key.shadow.intensity = 0.8;
    }

    #setQuality() {
        const low = this.#low;
        this.renderer.setPixelRatio(low ? 0.6 : Math.min(devicePixelRatio, 2));
        this.renderer.toneMapping = low ? NoToneMapping : NeutralToneMapping;
        this.renderer.shadowMap.enabled = !low;
        if (low) this.three.environment = null;
        if (!this.key || !this.rim) return;
        this.key.intensity = low ? 2.1 : 2.3;
        this.key.castShadow = this.rim.visible = !low;
        this.sky.full.visible = !low;
        this.sky.low.visible = low;
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
        controls.addEventListener('start', () => (this.#fitted = null));
        return controls;
    }

    /** Looks at the body from the front, a little from above. @param {number[][]} size */
    frame(size) {
        this.box.min.fromArray(size[0]);
        this.box.max.fromArray(size[1]);
        const centre = this.box.getCenter(new Vector3());
        const radius = Math.max(this.diagonal / 2, 1e-9);
        this.camera.near = radius / 30;
        this.camera.far = radius * 60;
        this.controls.minDistance = radius * 0.08;
        this.controls.maxDistance = radius * 20;
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
        this.camera.position.set(0.32, -1, 0.62).add(centre);
        this.camera.lookAt(centre);
        this.#fitted = this.box.clone();
        this.#resize();
    }

    /**
     * Moves the camera, without turning it, so that a box fills what the panels leave free.
     * In the axes of the camera the sides of the free area are planes through the eye: they bound
     * where the eye may be for each corner of the box.
     * @param {Box3} box
     */
    fit(box) {
        if (box.isEmpty()) return;
        const { camera } = this;
        const area = this.#freeArea();
        camera.updateMatrixWorld();
        const turn = camera.quaternion;
        const back = turn.clone().invert();
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) =>
            new Vector3(
                (i & 1 ? box.max : box.min).x,
                (i & 2 ? box.max : box.min).y,
                (i & 4 ? box.max : box.min).z
            ).applyQuaternion(back)
        );
        // Slopes of the sides of the area, whose middle the camera looks at.
        const perPixel = (2 * Math.tan((camera.fov * Math.PI) / 360)) / Math.max(this.stage.clientHeight, 1);
        const across = perPixel * Math.max((area.right - area.left) / 2 - margin, 20);
        const upright = perPixel * Math.max((area.bottom - area.top) / 2 - margin, 20);
        const bounds = (/** @type {'x'|'y'} */ axis, /** @type {number} */ slope) => [
            Math.max(...corners.map((corner) => corner[axis] + slope * corner.z)),
            Math.min(...corners.map((corner) => corner[axis] - slope * corner.z)),
        ];
        const [right, left] = bounds('x', across);
        const [top, bottom] = bounds('y', upright);
        const near = Math.max(...corners.map((corner) => corner.z)) + 2 * camera.near;
        const z = Math.max((right - left) / (2 * across), (top - bottom) / (2 * upright), near);
        const middle = box.getCenter(new Vector3()).applyQuaternion(back).z;
        const eye = new Vector3((right + left) / 2, (top + bottom) / 2, z);
        this.controls.maxDistance = Math.max(this.controls.maxDistance, 3 * (z - middle));
        camera.far = Math.max(camera.far, 20 * (z - middle));
        camera.position.copy(eye).applyQuaternion(turn);
        this.controls.target.copy(eye.setZ(middle)).applyQuaternion(turn);
        this.#fitted = box.clone();
        this.#placePicture(area);
        this.controls.update();
        this.invalidate();
    }

    get diagonal() {
        return this.box.getSize(new Vector3()).length();
    }

    #freeArea() {
        return freeArea(this.stage.clientWidth, this.stage.clientHeight);
    }

    /** Puts the point that the camera looks at into the middle of an area. @param {import('./free_area.js').Area} area */
    #placePicture({ left, top, right, bottom }) {
        const width = Math.max(this.stage.clientWidth, 1);
        const height = Math.max(this.stage.clientHeight, 1);
        this.camera.aspect = width / height;
        const [x, y] = [(width - left - right) / 2, (height - top - bottom) / 2];
        this.camera.setViewOffset(width, height, x, y, width, height);
        this.camera.updateProjectionMatrix();
    }

    #resize() {
        const width = Math.max(this.stage.clientWidth, 1);
        const height = Math.max(this.stage.clientHeight, 1);
        this.renderer.setSize(width, height, false);
        // The body stands in the middle of what the panels leave, until the user turns or moves the view.
        if (this.#fitted) this.fit(this.#fitted);
        else this.#placePicture(this.#freeArea());
        this.draw();
    }

    /** Asks for a picture at the next opportunity. */
    invalidate() {
        if (this.#wanted) return;
        this.#wanted = true;
        this.#asked = performance.now();
        requestAnimationFrame(() => this.#onAnimationFrame());
    }

    #onAnimationFrame() {
        this.#wanted = false;
        const asked = this.#asked;
        if (this.controls.update()) this.invalidate();
        for (const step of this.#steps) if (step()) this.invalidate();
        this.draw();
        // A picture without a graphics card is copied after this function: that time counts too.
        if (!this.#low) setTimeout(() => this.#watchPace(performance.now() - asked));
    }

    /** @param {number} taken milliseconds of the last picture, from the wish for it */
    #watchPace(taken) {
        // The first pictures wait for shaders, and those of a page that was hidden came when it was shown.
        if (this.#low || this.box.isEmpty() || document.hidden) return;
        const pace = this.#slow;
        if (taken > slow) {
            ++pace.pictures;
            pace.time += Math.min(taken, 1000);
        } else {
            pace.pictures = Math.max(pace.pictures - 2, 0);
            pace.time = Math.max(pace.time - 2 * slow, 0);
        }
        if (pace.pictures < tooSlow.pictures || pace.time < tooSlow.time) return;
        this.#low = true;
        this.#setQuality();
        this.#resize();
        this.onSlow();
    }

    /** Calls a function before each picture; the function returns true if it wants another one. @param {() => boolean} step */
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
