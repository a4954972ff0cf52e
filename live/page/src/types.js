// The shapes of what the server sends, as the checker of types sees them.
// SPDX-License-Identifier: LGPL-3.0-or-later

/** @typedef {[number, number, number]} Triple */
/** @typedef {{at: number[], rotation: number[]}} Pose position (m) and unit quaternion x, y, z, w */

/**
 * The definition of a tool, with the keys that scenarios use.
 * @typedef {Object} ToolDefinition
 * @property {string} kind
 * @property {number[][]} [edge] of a blade, in the tool's frame, m
 * @property {any} [shape] sphere, capsule or box as in scenarios; or mesh {points, triangles}, or plane {point, normal}
 * @property {number} [toughness] of a blade, J/m^2
 * @property {number} [friction]
 * @property {number[][]} [points] of a suture, rest coordinates, m
 * @property {number} [length] of a suture, or of the blades of scissors, m
 * @property {number} [angle] between the blades of scissors, rad
 * @property {number} [closing_time] of scissors, s
 */

/**
 * @typedef {Object} Hello
 * @property {string} title
 * @property {number} tick seconds
 * @property {'operator'|'watcher'} role
 * @property {[number[], number[]]} size corners of the box round the body, m
 * @property {number} element_size mean edge, m
 * @property {{id: number, name: string}[]} regions
 * @property {{name: string, unit?: string}[]} fields
 * @property {boolean} has_contact
 * @property {string[]} kinds
 * @property {string} recording
 * @property {ScriptedTool[]} [scripted_tools] absent with older programs
 */

/**
 * A tool of the scenario, or an obstacle.
 * @typedef {Object} ScriptedTool
 * @property {string} name
 * @property {string} kind
 * @property {boolean} is_obstacle
 * @property {ToolDefinition} tool
 */

/**
 * Where a tool of the scenario is.
 * @typedef {Object} ScriptedState
 * @property {boolean} present
 * @property {Pose|null} [pose]
 * @property {boolean} [closed] of a tool that closes
 * @property {number[]|null} [force] N
 */

/** @typedef {ScriptedTool & ScriptedState} PlacedTool */

/**
 * @typedef {Object} ToolState
 * @property {string} name
 * @property {string} kind
 * @property {Pose} [pose]
 * @property {boolean} present
 * @property {number} held number of points that it holds
 * @property {boolean} closed
 * @property {number[]} [force] N
 * @property {number[]} [torque] N m
 * @property {boolean} mine
 * @property {ToolDefinition} tool
 */

/**
 * @typedef {Object} State
 * @property {number} tick
 * @property {number} time
 * @property {boolean} paused
 * @property {number} speed wanted factor of real time
 * @property {number} factor measured factor of real time
 * @property {number} step seconds
 * @property {number} nodes
 * @property {number} elements
 * @property {number} components
 * @property {number} edits
 * @property {number} cut_area m^2
 * @property {number} mass kg
 * @property {string} field
 * @property {boolean} can_undo
 * @property {ToolState[]} tools
 * @property {ScriptedState[]} [scripted] in the order of the hello; absent with older programs
 */

/**
 * The surface between two edits.
 * @typedef {Object} Topology
 * @property {number} version
 * @property {Uint32Array} triangles
 * @property {Float32Array} rest m
 * @property {Uint32Array} tags bit 31: vertex of cut faces; low bits: index into the regions
 */

/**
 * @typedef {Object} Frame
 * @property {number} version of the topology that it belongs to
 * @property {number} tick
 * @property {number[]} origin of the positions, m
 * @property {Topology|null} topology
 * @property {Float32Array} positions relative to the origin, m
 * @property {Float32Array|null} values of the field that is shown
 */

export {};
