// The tool in the hand: what was told to the server about it.
// SPDX-License-Identifier: LGPL-3.0-or-later
import { Matrix4, Quaternion, Vector3 } from 'three';

/**
 * The pose whose local -z axis points into the body.
 * @param {Vector3} at
 * @param {Vector3} into unit vector
 * @returns {import('./types.js').Pose}
 */
export function poseOf(at, into) {
    const rotation = new Quaternion().setFromUnitVectors(new Vector3(0, 0, -1), into);
    return { at: at.toArray(), rotation: rotation.toArray() };
}

/** The matrix of a pose. @param {import('./types.js').Pose} pose @param {Matrix4} [target] */
export function matrixOf(pose, target = new Matrix4()) {
    return target.compose(
        new Vector3().fromArray(pose.at),
        new Quaternion().fromArray(pose.rotation),
        new Vector3(1, 1, 1)
    );
}

export class Hand {
    /** @type {import('./types.js').ToolDefinition|null} */
    tool = null;
    /** Where the tool is wanted. @type {import('./types.js').Pose|null} */
    pose = null;
    #send;
    #unsent = false;

    /** @param {(order: Record<string, unknown>) => void} send */
    constructor(send) {
        this.#send = send;
    }

    get isEmpty() {
        return this.tool === null;
    }

    /** @param {import('./types.js').ToolDefinition} tool @param {import('./types.js').Pose} pose */
    take(tool, pose) {
        this.tool = tool;
        this.pose = pose;
        this.#unsent = false;
        this.#send({ do: 'take', tool, pose });
    }

    close() {
        this.#send({ do: 'close' });
    }

    open() {
        this.#send({ do: 'open' });
    }

    /** @param {import('./types.js').Pose} pose */
    move(pose) {
        this.pose = pose;
        this.#unsent = true;
    }

    /** Sends the last pose, if it was not sent yet. To be called some thirty times a second or more. */
    flush() {
        if (!this.#unsent || this.isEmpty) return;
        this.#unsent = false;
        this.#send({ do: 'move', pose: this.pose });
    }

    drop() {
        if (this.isEmpty) return;
        this.flush();
        this.forget();
        this.#send({ do: 'drop' });
    }

    /** Empties the hand without a word, when the server has taken the tool away. */
    forget() {
        this.tool = null;
        this.pose = null;
        this.#unsent = false;
    }
}
