// Ties the parts of the page together.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Vector3 } from 'three';
import { Aim } from './aim.js';
import { tissueColours } from './colours.js';
import { Connection, socketAddress } from './connection.js';
import { Cursor } from './cursor.js';
import { button, element, write } from './dom.js';
import { FieldRange } from './field.js';
import { decodeFrame } from './frame.js';
import { Hand } from './hand.js';
import { HandCheck } from './hand_check.js';
import { Keyboard } from './keyboard.js';
import { Legend } from './legend.js';
import { Messages } from './messages.js';
import { modes } from './modes/index.js';
import { Suture } from './modes/suture.js';
import { Overlay } from './overlay.js';
import { Pointer } from './pointer.js';
import { showReadings } from './readings.js';
import { Scene } from './scene.js';
import { Section } from './section.js';
import { SectionPanel } from './section_panel.js';
import { suitable } from './settings.js';
import { Tissue } from './tissue.js';
import { Toolbar } from './toolbar.js';
import { ToolPanel } from './tool_panel.js';
import { ToolsView } from './tools_view.js';

const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
/** Milliseconds after which a tool in the hand moves on, though no picture was drawn. */
const moveWithin = 30;

export class App {
    /** @type {import('./types.js').Hello|null} */
    hello = null;
    /** @type {import('./types.js').State|null} */
    state = null;
    /** Numbers of frames and of greetings that came. */
    frames = 0;
    greetings = 0;
    modeName = 'look';
    settings = suitable(0.005, 0.1);
    messages = new Messages(element('messages'));
    #legend = new Legend();
    #overlay = new Overlay();
    #range = new FieldRange();
    #cursor = new Cursor();
    #lost = false;
    /** The page asks whether to reset. Any other key or press is a no. */
    #asksReset = false;
    #check = new HandCheck();
    /** When the tool in the hand was moved last. */
    #movedHand = 0;
    /** The body that the camera was placed for. */
    #framed = '';
    /** The newest frame that is not drawn yet. @type {import('./types.js').Frame|null} */
    #frame = null;
    /** Values of the field in the frame that is drawn. @type {Float32Array|null} */
    #values = null;
    #stateIsNew = false;

    /** @param {boolean} low for slow machines */
    constructor(low) {
        this.scene = new Scene(element('stage'), low);
        this.tissue = new Tissue(low);
        this.scene.three.add(this.tissue.mesh, this.tissue.lips.lines);
        this.section = new Section(this.scene.three, this.tissue, this.scene.box, low);
        this.toolsView = new ToolsView(low);
        this.scene.three.add(this.toolsView.group);
        this.aim = new Aim(this.scene, this.tissue, this.section);
        this.hand = new Hand((order) => this.send(order));
        const bench = {
            aim: this.aim,
            hand: this.hand,
            settings: this.settings,
            diagonal: () => this.scene.diagonal,
            state: () => this.state,
            send: (/** @type {Record<string, unknown>} */ order) => void this.send(order),
            changed: () => this.#changed(),
        };
        /** @type {Map<string, import('./modes/mode.js').Mode|null>} */
        this.modes = new Map(modes.map(({ name, make }) => [name, make?.(bench) ?? null]));
        this.suture = /** @type {Suture} */ (this.modes.get('suture'));
        this.toolbar = new Toolbar((mode, byMouse) => {
            this.setMode(mode);
            // After a click of the mouse the keys belong to the picture.
            if (byMouse) this.scene.canvas.focus({ preventScroll: true });
        });
        this.toolPanel = new ToolPanel(this.settings, this.suture);
        this.sectionPanel = new SectionPanel(
            this.section,
            () => this.scene.viewDirection,
            () => this.#changed()
        );
        this.pointer = new Pointer(this.scene, {
            mode: () => this.mode,
            allowed: () => this.isOperator,
            inUse: () => !this.hand.isEmpty,
        });
        this.keyboard = new Keyboard(this.#commands(), () => this.scene.invalidate());
        this.#bindButtons();
        this.setMode('look');
        this.scene.beforeEach(() => this.#beforePicture());
        this.scene.afterEach(() => this.#overlay.update(this.scene));
        setInterval(() => this.#showStage(), 1000);
        this.scene.onSlow = () => this.#drawLess();
        setInterval(() => this.#betweenPictures(), moveWithin);
        this.connection = new Connection(socketAddress(), {
            opened: () => this.#opened(),
            told: (message) => this.#told(message),
            framed: (message) => this.#framedBy(message),
            lost: () => this.#connectionLost(),
        });
    }

    /** The tools of the scenario where they are. @returns {import('./types.js').PlacedTool[]} */
    get scripted() {
        const states = this.state?.scripted ?? [];
        return (this.hello?.scripted_tools ?? []).map((tool, i) => ({ ...tool, ...(states[i] ?? { present: false }) }));
    }

    get mode() {
        return this.modes.get(this.modeName) ?? null;
    }

    get isOperator() {
        return this.hello?.role === 'operator' && this.connection.isOpen;
    }

    /** @param {Record<string, unknown>} order */
    send(order) {
        const isSent = this.connection.send(order);
        if (isSent) this.#check.sent(order.do, performance.now());
        return isSent;
    }

    // ---- what the server says

    #opened() {
        if (this.#lost) this.messages.show('info', 'The connection is back.');
        this.#lost = false;
        this.#check.connected();
        this.#showStatus();
    }

    #connectionLost() {
        if (!this.#lost) this.messages.show('error', 'The connection to the program is lost. This page tries again every second.');
        this.#lost = true;
        this.#letGo();
        this.hello = null;
        this.#showStatus();
    }

    /** Forgets what was in the hand, and what was asked, without an order. */
    #letGo() {
        this.hand.forget();
        this.pointer.stop();
        this.suture.forget();
        this.#cursor.hide();
        this.#showReset(false);
    }

    /** What the program does until the body is there, and since when. */
    #stage = { text: 'Waiting for the body', since: performance.now() };

    #showStage() {
        if (this.hello || this.#lost) return;
        const seconds = Math.floor((performance.now() - this.#stage.since) / 1000);
        write('loading-text', seconds < 2 ? this.#stage.text : `${this.#stage.text} … ${seconds} s`);
    }

    /** @param {any} message */
    #told(message) {
        if (message.type === 'progress') {
            this.#stage = { text: message.text, since: performance.now() };
            this.#showStage();
            element('loading').hidden = false;
        } else if (message.type === 'hello') this.#greeted(message);
        else if (message.type === 'state') {
            this.state = message;
            this.#stateIsNew = true;
            this.#compareHands(message);
            this.scene.invalidate();
        } else if (message.type === 'message') {
            if (message.level === 'error') this.#check.refused(performance.now());
            this.messages.show(message.level, message.text);
        }
    }

    /** @param {import('./types.js').State} state */
    #compareHands(state) {
        const own = state.tools.find((tool) => tool.mine)?.name ?? '';
        const verdict = this.#check.look(own, !this.hand.isEmpty, performance.now());
        if (verdict === 'gone') this.#letGo();
        if (verdict === 'left') this.send({ do: 'drop' });
    }

    /** @param {import('./types.js').Hello} hello */
    #greeted(hello) {
        // Another page may have come or gone; the tool in the hand of an operator stays there.
        if (hello.role !== 'operator') this.#letGo();
        this.hello = hello;
        ++this.greetings;
        this.scene.box.min.fromArray(hello.size[0]);
        this.scene.box.max.fromArray(hello.size[1]);
        // The box is that of the body as it is; a later hello, of another role, leaves the camera alone.
        const body = `${hello.title} ${hello.element_size}`;
        if (this.#framed !== body) {
            this.#framed = body;
            this.scene.frame(hello.size);
            Object.assign(this.settings, suitable(hello.element_size, this.scene.diagonal, hello.has_contact));
        }
        this.tissue.setBody(hello);
        this.toolsView.setBody(this.scene.diagonal, this.scene.box.getCenter(new Vector3()));
        this.toolPanel.setBody(hello.element_size, this.scene.diagonal, hello.has_contact);
        write('title', hello.title || 'Incise');
        document.title = hello.title ? `${hello.title} – Incise` : 'Incise';
        this.#showFields();
        const token = location.search;
        element('get-record').hidden = !hello.recording;
        element('get-record').setAttribute('href', `/recording.jsonl${token}`);
        element('get-frame').setAttribute('href', `/frame.vtu${token}`);
        this.toolbar.offer(hello);
        this.#changed();
        this.#showStatus();
    }

    /** @param {ArrayBuffer} message */
    #framedBy(message) {
        const frame = decodeFrame(message);
        ++this.frames;
        // A frame that only moves the surface must not displace one that brings its triangles.
        if (this.#frame?.topology && !frame.topology) this.tissue.setFrame(this.#frame);
        this.#frame = frame;
        this.scene.invalidate();
    }

    // ---- before each picture

    /** @returns {boolean} wants another picture */
    #beforePicture() {
        if (this.#takeFrame() || this.#stateIsNew) this.#colourField();
        const again = this.#moveHand();
        if (this.#stateIsNew && this.state) {
            showReadings(this.state, this.scripted, this.isOperator);
            this.#showStatus();
            if (this.modeName === 'suture') this.toolPanel.showThread();
        }
        this.#stateIsNew = false;
        this.section.update();
        this.#showTools();
        return again;
    }

    /** Moves the tool to where pointer and keys want it. Returns true if it is not there yet. */
    #moveHand() {
        const now = performance.now();
        const seconds = Math.min((now - this.#movedHand) / 1000, 0.1);
        this.#movedHand = now;
        let again = this.keyboard.move(seconds);
        this.pointer.deliver();
        if (this.mode && !this.hand.isEmpty && this.mode.step(seconds)) again = true;
        if (!this.#check.doubts) this.hand.flush();
        return again;
    }

    /** Pictures may take long, for instance without a graphics card. The hand does not wait for them. */
    #betweenPictures() {
        if (this.hand.isEmpty && !this.keyboard.isMoving) return;
        if (performance.now() - this.#movedHand >= moveWithin - 5) this.#moveHand();
    }

    #drawLess() {
        this.tissue.drawLess();
        this.toolsView.drawLess();
        this.messages.show('info', 'Pictures took more than 0.1 s each: they have less detail now. A graphics card draws them smoothly.');
    }

    #takeFrame() {
        const frame = this.#frame;
        this.#frame = null;
        if (!frame || !this.tissue.setFrame(frame)) return false;
        element('loading').hidden = true;
        this.#values = frame.values;
        return true;
    }

    /** Values come with frames, the name of their field with states: either may be the first. */
    #colourField() {
        const name = this.state?.field ?? 'none';
        const coloured = this.#values !== null && name !== 'none';
        if (this.#values && coloured) {
            this.#range.follow(name, this.#values, performance.now());
            this.tissue.uniforms.low.value = this.#range.low;
            this.tissue.uniforms.high.value = this.#range.high;
            const unit = this.hello?.fields.find((field) => field.name === name)?.unit ?? '';
            this.#legend.show(name, unit, this.#range);
        } else this.#legend.hide();
        if (this.tissue.uniforms.coloured.value === Number(coloured)) return;
        this.tissue.uniforms.coloured.value = Number(coloured);
        this.#colourCap();
    }

    #colourCap() {
        const first = this.hello?.regions[0]?.name ?? '';
        const plain = this.tissue.uniforms.coloured.value > 0.5;
        this.section.setColour(plain ? 0x6f7780 : tissueColours(first, 0).cut);
    }

    #showTools() {
        const at = this.#cursor.at ?? this.pointer.at;
        let wanted = null;
        if (this.hand.tool && this.hand.pose) wanted = this.#lagging(this.hand.tool, this.hand.pose);
        else if (this.isOperator && at && this.mode) wanted = this.mode.preview(at.x, at.y);
        this.toolsView.update({ tools: this.state?.tools ?? [], scripted: this.scripted, wanted }, this.scene.camera);
        const tied = (this.state?.tools ?? []).filter((tool) => tool.kind === 'suture' && tool.present);
        this.toolsView.showThreads(
            tied.map((tool) => (tool.tool?.points ?? []).map((point) => this.tissue.positionOfRest(point))),
            this.suture.points.map((point) => this.tissue.positionOfRest(point))
        );
        this.#cursor.holds = !this.hand.isEmpty;
        this.#cursor.show();
    }

    /**
     * The tool where the hand wants it, if the simulation has not followed yet.
     * @param {import('./types.js').ToolDefinition} tool @param {import('./types.js').Pose} pose
     */
    #lagging(tool, pose) {
        const followed = this.state?.tools.find((one) => one.mine && one.present)?.pose;
        const away = followed ? Math.hypot(...pose.at.map((value, i) => value - followed.at[i])) : Infinity;
        return away > 0.015 * this.scene.diagonal ? { tool, pose } : null;
    }

    // ---- what the user does

    /** Something that is drawn or listed has changed. */
    #changed() {
        this.toolPanel.show();
        this.#colourCap();
        this.scene.invalidate();
    }

    /** @param {string} name */
    setMode(name) {
        this.pointer.stop();
        if (!this.hand.isEmpty) this.mode?.end();
        this.modeName = name;
        this.#cursor.hide();
        this.toolbar.choose(name);
        this.toolPanel.setMode(name);
        this.pointer.arrange();
        this.scene.invalidate();
    }

    #bindButtons() {
        const commands = this.#commands();
        button('pause').onclick = commands.pause;
        button('step').onclick = commands.step;
        button('undo').onclick = commands.undo;
        button('reset').onclick = commands.reset;
        button('slower').onclick = () => commands.speed(false);
        button('faster').onclick = () => commands.speed(true);
        button('help-button').onclick = commands.help;
        element('get-record').addEventListener('click', () => this.#tellSaved());
        button('take-over').onclick = () => this.send({ do: 'take_over' });
        button('more').onclick = () => {
            const open = element('settings').classList.toggle('open');
            button('more').setAttribute('aria-expanded', String(open));
        };
        const field = /** @type {HTMLSelectElement} */ (element('field'));
        field.onchange = () => this.send({ do: 'show', field: field.value });
        addEventListener('blur', () => this.pointer.stop());
        for (const input of ['keydown', 'pointerdown']) addEventListener(input, (event) => this.#doubtReset(event), true);
    }

    #tellSaved() {
        const name = this.hello?.recording ?? '';
        const until = this.state ? ` up to ${this.state.time.toFixed(2)} s` : '';
        this.messages.show('info', `The recording${until} is saved to your downloads as ${name}. It runs again with: incise run SCENARIO.toml --replay ${name}`);
    }

    #showFields() {
        const list = /** @type {HTMLSelectElement} */ (element('field'));
        list.replaceChildren(
            ...(this.hello?.fields ?? []).map(({ name }) => {
                const option = document.createElement('option');
                option.value = name;
                option.textContent = name === 'none' ? 'tissue' : name.replace(/_/g, ' ');
                return option;
            })
        );
    }

    /** @returns {import('./keyboard.js').Commands} */
    #commands() {
        const send = (/** @type {Record<string, unknown>} */ order) => void this.send(order);
        return {
            mode: (index) => {
                const mode = this.toolbar.offered(index);
                if (!mode) return;
                this.setMode(mode);
                this.scene.canvas.focus({ preventScroll: true });
            },
            pause: () => send({ do: 'pause', on: !this.state?.paused }),
            step: () => send({ do: 'step' }),
            undo: () => {
                if (!this.state?.can_undo) return;
                this.#letGo();
                send({ do: 'undo' });
            },
            reset: () => this.#askReset(),
            speed: (up) => {
                const now = this.state?.speed ?? 1;
                const next = up ? speeds.find((one) => one > now * 1.01) : speeds.findLast((one) => one < now * 0.99);
                if (next) send({ do: 'speed', factor: next });
            },
            section: () => this.sectionPanel.toggle(),
            field: () => {
                const names = (this.hello?.fields ?? []).map((field) => field.name);
                const next = names[(names.indexOf(this.state?.field ?? 'none') + 1) % names.length];
                if (next) send({ do: 'show', field: next });
            },
            fit: () => this.scene.fit(this.tissue.box()),
            help: () => /** @type {HTMLDialogElement} */ (element('help')).showModal(),
            enter: () => this.#enter(),
            back: () => this.modeName === 'suture' && this.suture.back(),
            escape: () => {
                this.pointer.stop();
                if (!this.hand.isEmpty) this.mode?.end();
                this.suture.forget();
                this.#cursor.hide();
                this.#changed();
            },
            deepen: (notches) => void this.mode?.deepen(notches),
            moveCursor: (x, y) => this.#moveCursor(x, y),
        };
    }

    /** Takes the tool at the cursor, or drops it; ties a thread whose points are laid by the mouse. */
    #enter() {
        const { mode } = this;
        if (!mode || !this.isOperator) return false;
        if (mode === this.suture && (!this.#cursor.at || this.#closesThread())) return this.suture.tie();
        if (!this.hand.isEmpty) {
            mode.end();
            return true;
        }
        const at = this.#cursor.at;
        if (!at) {
            this.#moveCursor(0, 0);
            return true;
        }
        mode.begin(at.x, at.y);
        return true;
    }

    /** With the keyboard, Enter twice at the same point ties the thread. */
    #closesThread() {
        const at = this.#cursor.at;
        const last = this.suture.points.at(-1);
        const hit = at && this.aim.pick(at.x, at.y);
        const rest = hit && this.tissue.restOfHit(hit);
        if (!rest || !last || this.suture.points.length < 2) return false;
        return Math.hypot(...rest.map((value, i) => value - last[i])) < 0.004 * this.scene.diagonal;
    }

    /** @param {number} x @param {number} y pixels */
    #moveCursor(x, y) {
        if (!this.mode) return false;
        const middle = this.scene.onScreen(this.scene.controls.target);
        this.#cursor.move(x, y, this.pointer.at ?? middle, this.scene.canvas.getBoundingClientRect());
        const { at } = this.#cursor;
        if (at && !this.hand.isEmpty) this.mode.move(at.x, at.y);
        this.scene.invalidate();
        return true;
    }

    #askReset() {
        if (!this.isOperator) return;
        if (!this.#asksReset) return this.#showReset(true);
        this.#letGo();
        this.send({ do: 'reset' });
    }

    /** @param {Event} event a key or a press of the pointer */
    #doubtReset(event) {
        const onButton = event.target instanceof Element && event.target.closest('#reset') !== null;
        const again = event instanceof KeyboardEvent && event.key.toLowerCase() === 'r';
        if (this.#asksReset && !onButton && !again) this.#showReset(false);
    }

    /** @param {boolean} asks */
    #showReset(asks) {
        this.#asksReset = asks;
        element('reset-ask').hidden = !asks;
        button('reset').classList.toggle('asks', asks);
        button('reset').setAttribute('aria-label', asks ? 'Press again to reset' : 'Reset');
    }

    #showStatus() {
        const watching = this.hello?.role === 'watcher';
        const [status, text] = this.#lost
            ? ['lost', 'Connection lost']
            : !this.hello
              ? ['loading', 'Loading']
              : watching
                ? ['watching', 'Watching']
                : this.state?.paused
                  ? ['paused', 'Paused']
                  : ['running', 'Running'];
        element('status').dataset.status = status;
        write('status', text);
        const notice = element('notice');
        notice.hidden = !(this.#lost || watching);
        notice.classList.toggle('lost', this.#lost);
        button('take-over').hidden = this.#lost;
        if (this.#lost) write('loading-text', 'The program does not answer. Trying again …');
        else this.#showStage();
        write('notice-text', this.#lost ? 'Connection lost. Trying again …' : watching ? 'Another page holds the tools' : '');
        this.toolbar.enable(this.isOperator);
        const field = /** @type {HTMLSelectElement} */ (element('field'));
        field.disabled = !this.isOperator;
        if (this.state && document.activeElement !== field) field.value = this.state.field;
        if (watching && this.modeName !== 'look') this.setMode('look');
    }
}
