// The WebSocket to the server. A lost connection is tried again every second, for ever.
// SPDX-License-Identifier: LGPL-3.0-or-later

const retryAfter = 1000;

export class Connection {
    #url;
    #listener;
    /** @type {WebSocket|null} */
    #socket = null;
    /** Number of orders that were sent. */
    sent = 0;

    /**
     * @param {string} url
     * @param {Object} listener
     * @param {() => void} listener.opened
     * @param {(message: any) => void} listener.told
     * @param {(message: ArrayBuffer) => void} listener.framed
     * @param {() => void} listener.lost
     */
    constructor(url, listener) {
        this.#url = url;
        this.#listener = listener;
        this.#open();
    }

    get isOpen() {
        return this.#socket?.readyState === WebSocket.OPEN;
    }

    /**
     * Sends an order; returns false if there is nobody to send it to.
     * @param {Record<string, unknown>} order
     */
    send(order) {
        if (!this.#socket || !this.isOpen) return false;
        this.#socket.send(JSON.stringify(order));
        ++this.sent;
        return true;
    }

    #open() {
        const socket = new WebSocket(this.#url);
        socket.binaryType = 'arraybuffer';
        socket.onopen = () => this.#listener.opened();
        socket.onmessage = ({ data }) => {
            if (typeof data === 'string') this.#listener.told(JSON.parse(data));
            else this.#listener.framed(data);
        };
        socket.onclose = () => {
            this.#socket = null;
            this.#listener.lost();
            setTimeout(() => this.#open(), retryAfter);
        };
        this.#socket = socket;
    }
}

/** The address of the server's WebSocket, with the token that this page was opened with. */
export function socketAddress() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const token = new URLSearchParams(location.search).get('token') ?? '';
    return `${scheme}://${location.host}/ws?token=${encodeURIComponent(token)}`;
}
