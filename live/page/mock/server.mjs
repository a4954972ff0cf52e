// The mock's server: it speaks the protocol of `incise live` for one body.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { createServer } from 'node:http';
import { appendFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, extname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { randomBytes } from 'node:crypto';
import { WebSocketServer } from 'ws';
import { Body } from './body.mjs';
import { scriptedTools, scriptedStates } from './scripted.mjs';
import { readTetrahedra } from './vtu.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, '..', 'dist');
const types = {
    '.html': 'text/html; charset=utf-8',
    '.js': 'text/javascript; charset=utf-8',
    '.css': 'text/css; charset=utf-8',
    '.svg': 'image/svg+xml',
};
const fields = [
    { name: 'none' },
    { name: 'displacement', unit: 'm' },
    { name: 'von_mises', unit: 'Pa' },
];

const rotate = (q, v) => {
    const [x, y, z, w] = q;
    const t = [
        2 * (y * v[2] - z * v[1]),
        2 * (z * v[0] - x * v[2]),
        2 * (x * v[1] - y * v[0]),
    ];
    return [
        v[0] + w * t[0] + y * t[2] - z * t[1],
        v[1] + w * t[1] + z * t[0] - x * t[2],
        v[2] + w * t[2] + x * t[1] - y * t[0],
    ];
};
const inWorld = (pose, p) => rotate(pose.rotation, p).map((value, i) => value + pose.at[i]);
const isVector = (v, n) =>
    Array.isArray(v) && v.length === n && v.every((x) => Number.isFinite(x) && Math.abs(x) < 1e3);
const isPose = (pose) => pose && isVector(pose.at, 3) && isVector(pose.rotation, 4);

class Session {
    /** @param {boolean} scripted with tools of a scenario, and obstacles */
    constructor(scenario, record, scripted) {
        const text = readFileSync(scenario, 'utf8');
        const file = /^file\s*=\s*"([^"]*)"/m.exec(text)?.[1] ?? '';
        this.title = /^title\s*=\s*"([^"]*)"/m.exec(text)?.[1] ?? scenario;
        this.body = new Body(readTetrahedra(resolve(dirname(scenario), file)));
        this.record = record;
        this.scripted = scripted ? scriptedTools(this.body.min, this.body.max) : [];
        if (record) writeFileSync(record, '');
        this.names = {};
        this.clients = [];
        this.operator = null;
        this.restart();
        this.topologySent = new WeakMap();
    }

    restart() {
        this.ticks = 0;
        this.paused = false;
        this.speed = 1;
        this.field = 'none';
        this.tools = [];
        this.hand = null;
        this.marks = [];
        this.grips = [];
        this.body.clear();
    }

    hello(client) {
        const { body } = this;
        return {
            type: 'hello',
            title: this.title,
            tick: 1 / 60,
            role: client === this.operator ? 'operator' : 'watcher',
            size: [body.min, body.max],
            element_size: 0.0052,
            regions: [
                { id: 1, name: 'liver' },
                { id: 2, name: 'nodule' },
            ],
            fields,
            scripted_tools: this.scripted,
            has_contact: true,
            kinds: ['blade', 'probe', 'grasper', 'suture', 'carver'],
            recording: this.record ?? '',
        };
    }

    state(client) {
        const { body } = this;
        return {
            type: 'state',
            tick: this.ticks,
            time: this.ticks / 60,
            paused: this.paused,
            speed: this.speed,
            factor: this.paused ? 0 : 0.98 * Math.min(this.speed, 1),
            step: 0.0007,
            nodes: 4310,
            elements: body.elements,
            components: body.components,
            edits: body.edits,
            cut_area: body.area,
            mass: 1.06 * 0.9,
            field: this.field,
            can_undo: this.marks.length > 0,
            scripted: scriptedStates(this.scripted, this.ticks / 60, body.min, body.max),
            tools: this.tools.map((tool) => ({
                ...tool.shown,
                mine: tool === this.hand && client === this.operator,
            })),
        };
    }

    order(client, text) {
        const fail = (message) =>
            client.send(JSON.stringify({ type: 'message', level: 'error', text: message }));
        let order;
        try {
            order = JSON.parse(text);
        } catch {
            return fail('The order is not JSON.');
        }
        if (typeof order !== 'object' || order === null) return fail('An order is an object.');
        if (order.do !== 'take_over' && client !== this.operator)
            return fail('Another page holds the tools.');
        const problem = this.obey(order, client);
        if (problem) return fail(problem);
        if (this.record) appendFileSync(this.record, `${JSON.stringify(order)}\n`);
    }

    obey(order, client) {
        switch (order.do) {
            case 'take': {
                const { tool, pose } = order;
                if (!isPose(pose)) return "'pose' has no three finite numbers in 'at'.";
                if (!['blade', 'probe', 'grasper', 'carver'].includes(tool?.kind))
                    return `There is no tool of the kind '${tool?.kind}'.`;
                if (tool.kind === 'blade' && !(tool.edge?.length >= 2))
                    return "The edge of a blade has two points or more.";
                if (this.hand) this.drop();
                const n = (this.names[tool.kind] = (this.names[tool.kind] ?? 0) + 1);
                this.marks.push(this.body.mark());
                this.hand = {
                    wanted: pose,
                    grip: null,
                    shown: {
                        name: `${tool.kind}_${n}`, kind: tool.kind, pose, present: true, held: 0,
                        closed: false, force: [0, 0, 0], torque: [0, 0, 0], tool,
                    },
                };
                this.tools.push(this.hand);
                return '';
            }
            case 'move':
                if (!isPose(order.pose)) return "'pose' is no pose of finite numbers.";
                if (!this.hand) return 'There is no tool in the hand.';
                this.hand.wanted = order.pose;
                return '';
            case 'drop':
                this.dropSoon = true;
                return '';
            case 'close':
                if (!this.hand) return 'There is no tool in the hand.';
                this.closeSoon = true;
                return '';
            case 'open':
                if (this.hand) this.release();
                return '';
            case 'sew':
                if (!(Array.isArray(order.points) && order.points.length >= 2 &&
                    order.points.every((p) => isVector(p, 3)))) return 'A suture has two points or more.';
                this.marks.push(this.body.mark());
                this.names.suture = (this.names.suture ?? 0) + 1;
                this.tools.push({
                    shown: {
                        name: `suture_${this.names.suture}`, kind: 'suture', present: true, held: order.points.length,
                        closed: true, force: [0.4, 0, 0], torque: [0, 0, 0],
                        pose: { at: [0, 0, 0], rotation: [0, 0, 0, 1] },
                        tool: { kind: 'suture', points: order.points, length: 0.03 },
                    },
                });
                return '';
            case 'tighten': {
                const found = this.tools.find((tool) => tool.shown.name === order.name);
                if (!found) return `There is no suture '${order.name}'.`;
                found.shown.tool = { ...found.shown.tool, length: order.length ?? found.shown.tool.length * order.factor };
                return '';
            }
            case 'untie':
                this.tools = this.tools.filter((tool) => tool.shown.name !== order.name);
                return '';
            case 'pause':
                if (typeof order.on !== 'boolean') return "'on' is true or false.";
                this.paused = order.on;
                return '';
            case 'step':
                if (this.paused) this.tick();
                return '';
            case 'speed':
                if (!(order.factor > 0 && order.factor <= 10)) return "'factor' is a number above 0.";
                this.speed = order.factor;
                return '';
            case 'undo': {
                const mark = this.marks.pop();
                if (!mark) return 'There is nothing to undo.';
                this.drop();
                this.tools = [];
                this.body.goBack(mark);
                return '';
            }
            case 'reset':
                this.restart();
                this.helloAll();
                return '';
            case 'show':
                if (!fields.some((field) => field.name === order.field)) return `There is no field '${order.field}'.`;
                this.field = order.field;
                return '';
            case 'take_over':
                this.operator = client;
                this.helloAll();
                return '';
            default:
                return `There is no order '${String(order.do).slice(0, 40)}'.`;
        }
    }

    release() {
        if (this.hand?.grip) this.grips.push({ ...this.hand.grip, fade: 1 });
        if (this.hand) {
            this.hand.grip = null;
            this.hand.shown.force = [0, 0, 0];
            this.hand.shown.closed = false;
            this.hand.shown.held = 0;
        }
    }

    drop() {
        this.release();
        if (this.hand) this.tools = this.tools.filter((tool) => tool !== this.hand);
        this.hand = null;
    }

    tick() {
        ++this.ticks;
        const { hand, body } = this;
        if (hand) {
            const before = hand.shown.pose;
            const now = hand.wanted;
            const { tool } = hand.shown;
            if (tool.kind === 'blade') {
                const [a, b] = tool.edge.map((p) => inWorld(before, p));
                const [c, d] = tool.edge.map((p) => inWorld(now, p));
                const count = body.cut(a, b, c, d);
                hand.shown.force = count ? [0.1, 0.2, 0.6] : [0, 0, 0];
            }
            if (tool.kind === 'carver') body.carve(now.at, tool.shape.sphere.radius);
            if (tool.kind === 'grasper' && this.closeSoon) {
                hand.grip = { from: now.at, piece: body.piece[body.nearest(now.at)], move: [0, 0, 0] };
                hand.shown.closed = true;
                hand.shown.held = 12;
            }
            this.closeSoon = false;
            if (hand.grip) {
                hand.grip.move = now.at.map((value, i) => value - hand.grip.from[i]);
                hand.shown.force = hand.grip.move.map((value) => -60 * value);
            }
            if (tool.kind === 'probe') hand.shown.force = [0, 0, 0.3];
            hand.shown.pose = now;
            if (this.dropSoon) this.drop();
        }
        this.dropSoon = false;
        for (const grip of this.grips) grip.fade *= 0.85;
        this.grips = this.grips.filter((grip) => grip.fade > 0.01);
    }

    displacement() {
        const acting = [...this.grips];
        const probe = this.hand?.shown.kind === 'probe' ? this.hand.shown : null;
        if (this.hand?.grip) acting.push({ ...this.hand.grip, fade: 1 });
        if (!acting.length && !probe) return null;
        const reach = 0.035;
        return (p, piece) => {
            const u = [0, 0, 0];
            for (const grip of acting) {
                if (piece !== grip.piece) continue;
                const d2 = p.reduce((sum, value, i) => sum + (value - grip.from[i]) ** 2, 0);
                const weight = grip.fade * Math.exp(-d2 / (reach * reach));
                for (let i = 0; i < 3; ++i) u[i] += weight * grip.move[i];
            }
            if (probe) {
                const into = rotate(probe.pose.rotation, [0, 0, -1]);
                const away = p.map((value, i) => value - probe.pose.at[i]);
                const radius = probe.tool.shape.sphere.radius;
                const along = away.reduce((sum, value, i) => sum + value * into[i], 0);
                const aside = Math.sqrt(Math.max(0, away.reduce((sum, v) => sum + v * v, 0) - along * along));
                const want = Math.sqrt(Math.max(0, radius * radius - Math.min(aside, radius) ** 2));
                const push = Math.max(0, want - along) * Math.exp(-((Math.max(0, aside - radius) / 0.01) ** 2));
                if (along > -radius && along < 2 * radius)
                    for (let i = 0; i < 3; ++i) u[i] += Math.min(push, 2 * radius) * into[i];
            }
            return u;
        };
    }

    frame(client) {
        const { body } = this;
        const origin = body.min.map((value, i) => (value + body.max[i]) / 2);
        const withTopology = this.topologySent.get(client) !== body.version;
        const withField = this.field !== 'none';
        const positions = body.positions(origin, this.displacement(), this.ticks / 60);
        const V = body.owner.length;
        const T = body.triangles.length / 3;
        const head = Buffer.alloc(40);
        [0x31434e49, (withTopology ? 1 : 0) | (withField ? 2 : 0), body.version, this.ticks, V, withTopology ? T : 0]
            .forEach((value, i) => head.writeUInt32LE(value, 4 * i));
        origin.forEach((value, i) => head.writeFloatLE(value, 24 + 4 * i));
        const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
        const parts = [head];
        if (withTopology) parts.push(bytes(body.triangles), bytes(body.rest), bytes(body.tags));
        parts.push(bytes(positions));
        if (withField) {
            const values = new Float32Array(V);
            for (let v = 0; v < V; ++v) {
                const u = [0, 1, 2].map((i) => positions[3 * v + i] + Math.fround(origin[i]) - body.rest[3 * v + i]);
                const size = Math.hypot(...u);
                values[v] = this.field === 'displacement' ? size
                    : 400 + 300 * Math.sin(40 * body.rest[3 * v]) * Math.cos(50 * body.rest[3 * v + 1]) + 4e5 * size;
            }
            parts.push(bytes(values));
        }
        this.topologySent.set(client, body.version);
        return Buffer.concat(parts);
    }

    helloAll() {
        for (const client of this.clients) {
            this.topologySent.delete(client);
            client.send(JSON.stringify(this.hello(client)));
        }
    }

    tellAll() {
        for (const client of this.clients) {
            if (client.bufferedAmount > 1e6) continue;
            client.send(this.frame(client));
            client.send(JSON.stringify(this.state(client)));
        }
    }
}

/** @param {string[]} args */
function live(args) {
    const option = (name) => (args.includes(name) ? args[args.indexOf(name) + 1] : undefined);
    const token = option('--token') ?? randomBytes(9).toString('hex');
    let session = null;
    const waiting = new Set();
    const server = createServer((request, response) => {
        const path = new URL(request.url, 'http://x').pathname;
        const name = path === '/' ? 'index.html' : path.slice(1);
        if (name === 'recording.jsonl' || name === 'frame.vtu') {
            response.writeHead(200, { 'content-disposition': `attachment; filename="${name}"` });
            return response.end('mock');
        }
        if (!['index.html', 'app.js', 'style.css', 'favicon.svg'].includes(name)) {
            response.writeHead(404);
            return response.end();
        }
        response.writeHead(200, {
            'content-type': types[extname(name)],
            'content-security-policy': "default-src 'self'",
            'x-content-type-options': 'nosniff',
        });
        response.end(readFileSync(join(dist, name)));
    });
    const sockets = new WebSocketServer({ noServer: true, maxPayload: 65536 });
    server.on('upgrade', (request, socket, head) => {
        const url = new URL(request.url, 'http://x');
        if (url.pathname !== '/ws' || url.searchParams.get('token') !== token) return socket.destroy();
        sockets.handleUpgrade(request, socket, head, (client) => {
            client.on('error', () => {});
            if (session) join_(client);
            else {
                waiting.add(client);
                client.send(JSON.stringify({ type: 'progress', text: 'reading the mesh' }));
            }
            client.on('message', (data) => session?.order(client, data.toString()));
            client.on('close', () => {
                waiting.delete(client);
                if (!session) return;
                session.clients = session.clients.filter((other) => other !== client);
                if (session.operator === client) {
                    session.drop();
                    session.operator = session.clients[0] ?? null;
                    if (session.operator) session.helloAll();
                }
            });
        });
    });
    const join_ = (client) => {
        session.clients.push(client);
        session.operator ??= client;
        client.send(JSON.stringify(session.hello(client)));
        if (session.paused) session.tellAll();
    };
    server.listen(Number(option('--port') ?? 0), '127.0.0.1', () => {
        const { port } = /** @type {import('node:net').AddressInfo} */ (server.address());
        console.error(`Open http://127.0.0.1:${port}/?token=${token}`);
        setTimeout(() => {
            session = new Session(args[0], option('--record'), args.includes('--scripted'));
            waiting.forEach(join_);
            setInterval(() => {
                if (!session.paused) session.tick();
                session.tellAll();
            }, Number(option('--interval') ?? 1000 / 40));
        }, Number(option('--delay') ?? 600));
    });
    process.on('SIGINT', () => process.exit(0));
}

/** @param {string[]} args */
export function main(args) {
    const [verb, ...rest] = args;
    if (verb === 'live') return live(rest);
    if (verb === 'run') {
        readFileSync(rest[rest.indexOf('--replay') + 1], 'utf8');
        mkdirSync(rest[rest.indexOf('--out') + 1], { recursive: true });
        return;
    }
    console.error('usage: incise live SCENARIO | incise run SCENARIO --replay FILE --out DIR');
    process.exit(1);
}
