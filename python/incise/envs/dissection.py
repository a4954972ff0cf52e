"""Free a flap of tissue from a board by cutting the connective tissue below it with a cauter.

The task, its action space and its observation space are those of the tissue dissection of LapGym
(Scheikl et al., LapGym - An Open Source Framework for Reinforcement Learning in Robot-Assisted
Laparoscopic Surgery, Journal of Machine Learning Research 24, 2023). The simulation is another one.
docs/robot-learning.md says what differs.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

import incise

from .. import _renderer as renderer
from . import gym, options as checks
from .base import CuttingEnv, Floats, World, image_space, strained

MM = 0.001
TISSUE, CONNECTIVE = 1, 2
WIDTH, LENGTH = 0.06, 0.1            # of the tissue along x and y, m
NUM_ROWS, NUM_FREE_ROWS = 10, 2      # of 10 mm along y; those at the end that hang free
# The instrument turns about this point, m, and points down and away from the free end.
PIVOT = (-0.02, 0.11, 0.03)
PIVOT_TILT = math.radians(135.0)
TIP_LENGTH = 0.0144                  # from the origin of the instrument to the cutting wire, m
WIRE = (-0.0015, 0.0016)             # ends of the wire along the y axis of the instrument, m
STATE_LOW = (-90.0, -90.0, -90.0, 0.0)
STATE_HIGH = (90.0, 90.0, 90.0, 300.0)
START = (0.0, 0.0, 0.0, 2.0)         # pan, tilt, spin in degrees, depth in mm
NOISE = (30.0, 30.0, 30.0, 10.0)
WORKSPACE_LOW = (-48.0, 0.0, -10.0)  # mm
WORKSPACE_HIGH = (48.0, 110.0, 80.0)
FORCE_STEP, FORCE_LIMIT = 3e2, 1e5
FORCE_START = (0.0, -1e5, 1e5)       # the unit is nominal: see DissectionEnv, retraction_force
SPOT_WIDTH = 0.0026                  # m, of the border point in pictures
VIOLATIONS = ("workspace_violation", "state_limits_violation", "collision_with_board")
PARKED = incise.Pose([0.0, 0.0, 100.0])


def pose_of(state: tuple[float, ...]) -> tuple[list[float], list[float], list[list[float]]]:
    """Return position, m, quaternion (x, y, z, w) and rotation matrix of the instrument.

    state: pan, tilt and spin in degrees, depth in mm.
    """
    pan, tilt, spin = (math.radians(angle) for angle in state[:3])
    # Turned about x by the tilt, then about the new y by pan, then about the new z by spin. The
    # frame of the pivot is turned about x too, so its angle adds to the tilt.
    a = PIVOT_TILT + tilt
    ca, sa = math.cos(a), math.sin(a)
    cb, sb = math.cos(pan), math.sin(pan)
    cc, sc = math.cos(spin), math.sin(spin)
    rotation = [[cb * cc, -cb * sc, sb],
                [ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb],
                [sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb]]
    depth = state[3] * MM
    position = [PIVOT[i] + depth * rotation[i][2] for i in range(3)]
    ha, hb, hc = 0.5 * a, 0.5 * pan, 0.5 * spin
    ca, sa, cb, sb, cc, sc = (math.cos(ha), math.sin(ha), math.cos(hb), math.sin(hb),
                              math.cos(hc), math.sin(hc))
    quaternion = [sa * cb * cc + ca * sb * sc, ca * sb * cc - sa * cb * sc,
                  ca * cb * sc + sa * sb * cc, ca * cb * cc - sa * sb * sc]
    return position, quaternion, rotation


def farthest_points(points: Floats, num: int) -> npt.NDArray[np.int64]:
    """Return rows of points that are far from each other, beginning with row 0. Shape (num,)."""
    rows = np.zeros(num, np.int64)
    distance = np.full(len(points), np.inf)
    for i in range(1, num):
        away = points - points[rows[i - 1]]
        np.minimum(distance, np.einsum("ij,ij->i", away, away), out=distance)
        rows[i] = int(distance.argmax())
    return rows


class DissectionEnv(CuttingEnv):
    """Cut the connective tissue between a flap and a board with a cauter, and spare the flap.

    A flap of 60 mm by 100 mm lies 3 mm above a board. Its first rows are fixed there, the next
    rows_to_cut are joined to the board by connective tissue, and the last two hang free. A constant
    force draws the free end up and back. The cauter is an instrument through a fixed point. While
    it is active, it removes the elements round its wire.

    action, action_type "continuous": float32, shape (5,), each from -1 to 1:
        0 to 3  velocity of pan, tilt, spin and depth over maximum_state_velocity
        4       switches the cauter on above activation_deadzone, off below its negative
        5 to 7  only with control_retraction_force: change of the retraction force along x, y and z,
                300 a step at 1, in units of which the force at the start has 1e5
    action, action_type "discrete": 0 to 10: pan +, pan -, tilt +, tilt -, spin +, spin -, depth +,
        depth -, on, off, nothing; the velocities are discrete_action_magnitude.
    observation "state": float32, shape (75,), or (78,) with control_retraction_force; lengths in
        mm, angles in degrees:
        0 to 3    pan, tilt, spin, depth
        4         1 if the cauter is active, else 0
        5 to 11   pose of the instrument: x, y, z, quaternion x, y, z, w
        12 to 41  ten points of the tissue, x, y, z each
        42 to 71  ten points of the connective tissue
        72 to 74  the border point: the point of the connective tissue next to the free end that is
                  nearest to the tip
        75 to 77  only with control_retraction_force: that force
        Points that are no more come as in LapGym: what follows moves up, and zeros fill the end.
    observation "rgb": uint8, shape image_shape + (3,).
    reward: the sum of reward_amounts times the features, which info has under these names:
        cut_connective_tissue, cut_tissue  elements removed in this step
        distance_cauter_border_point, delta_distance_cauter_border_point  over the diagonal of the
            workspace
        workspace_violation, state_limits_violation, collision_with_board  1 if it was so at any
            time of the step, else 0
        successful_task  1 when no connective tissue is left, else 0
        unstable_deformation  1 if the motion is lost, which ends the episode
        The default amounts are 1, -1, 0, -5, -0.01, -0.01, -0.1, 10 and -10, in this order.
    end: terminated when all connective tissue is removed, truncated after max_episode_steps.
    metrics: area_cut is that of the connective tissue that is gone; distances are those of removed
        tissue elements from the connective layer; largest_force is that on the shaft.
    options of reset(): stiffness; randomize; state, (pan, tilt, spin, depth), degrees and mm.
    """

    _default_young = 2e3
    _option_names = ("stiffness", "randomize", "state")
    density = 1000.0
    default_amounts = {
        "unstable_deformation": -10.0,
        "distance_cauter_border_point": 0.0,
        "delta_distance_cauter_border_point": -5.0,
        "cut_connective_tissue": 1.0,
        "cut_tissue": -1.0,
        "workspace_violation": -0.01,
        "state_limits_violation": -0.01,
        "collision_with_board": -0.1,
        "successful_task": 10.0,
    }

    def __init__(self, *, cells: tuple[int, int, int] = (4, 10, 1), rows_to_cut: int = 2,
                 thickness: float = 0.004, connective_thickness: float = 0.003,
                 cutting_radius: float = 0.004, with_shaft: bool = True,
                 retraction_force: float = 0.04,
                 action_type: str = "continuous", control_retraction_force: bool = False,
                 maximum_state_velocity: tuple[float, ...] = (20.0, 20.0, 30.0, 20.0),
                 discrete_action_magnitude: tuple[float, ...] = (15.0, 15.0, 15.0, 10.0),
                 activation_deadzone: float = 0.1, num_tracking_points_tissue: int = 10,
                 num_tracking_points_connective_tissue: int = 10,
                 reward_amounts: Optional[dict[str, float]] = None,
                 observation_type: str = "state", image_shape: tuple[int, int] = (124, 124),
                 render_mode: Optional[str] = None, time_step: float = 0.01, frame_skip: int = 1,
                 settle_steps: int = 50, max_episode_steps: int = 3000,
                 young: Optional[float] = None, stiffness_range: float = 1.25,
                 num_stiffness_levels: int = 3, damping: float = 20.0, randomize: bool = True,
                 num_threads: int = 1) -> None:
        """cells: bricks of the flap along x, y and z, each of six tetrahedra; y a multiple of 10.

        rows_to_cut: 1 to 8.  thickness, connective_thickness: m.
        cutting_radius: elements with their centre this near to the wire are removed, m.
        with_shaft: the shaft pushes tissue, and feels its force.
        retraction_force: along -y and z, N each.
        maximum_state_velocity, discrete_action_magnitude: pan, tilt, spin in degrees/s, depth in
            mm/s.
        reward_amounts: changes of default_amounts.
        settle_steps: before the first episode, with the retraction force.
        young: Young's modulus, Pa; see PathIncisionEnv.  damping: 1/s.
        """
        super().__init__(
            observation_type=observation_type, image_shape=image_shape, render_mode=render_mode,
            time_step=time_step, frame_skip=frame_skip, max_episode_steps=max_episode_steps,
            young=young, stiffness_range=stiffness_range,
            num_stiffness_levels=num_stiffness_levels, randomize=randomize,
            num_threads=num_threads)
        self.cells = checks.wholes("cells", cells, "bricks along x, y, z")
        if self.cells[1] % NUM_ROWS:
            raise ValueError(f"cells is {cells!r}: those along y must be a multiple of {NUM_ROWS}")
        self.rows_to_cut = checks.whole("rows_to_cut", rows_to_cut, least=1,
                                        most=NUM_ROWS - NUM_FREE_ROWS)
        if action_type not in ("continuous", "discrete"):
            raise ValueError(f"action_type is {action_type!r}: it must be 'continuous' or "
                             "'discrete'")
        if action_type == "discrete" and control_retraction_force:
            raise ValueError("control_retraction_force is True: it needs action_type 'continuous'")
        self.thickness = checks.number("thickness", thickness, above=0, unit="m")
        self.gap = checks.number("connective_thickness", connective_thickness, above=0, unit="m")
        self.cutting_radius = checks.number("cutting_radius", cutting_radius, above=0, unit="m")
        self.with_shaft = bool(with_shaft)
        self.retraction_force = checks.number("retraction_force", retraction_force, unit="N")
        self.action_type = action_type
        self.control_retraction_force = bool(control_retraction_force)
        self.activation_deadzone = checks.number("activation_deadzone", activation_deadzone,
                                                 least=0)
        self.num_tissue_points = checks.whole("num_tracking_points_tissue",
                                              num_tracking_points_tissue, least=0)
        self.num_connective_points = checks.whole("num_tracking_points_connective_tissue",
                                                  num_tracking_points_connective_tissue, least=0)
        unknown = sorted(set(reward_amounts or {}) - set(self.default_amounts))
        if unknown:
            raise ValueError(f"reward_amounts has unknown names {unknown}; known are "
                             f"{sorted(self.default_amounts)}")
        self.reward_amounts = {
            name: checks.number(f"reward_amounts[{name!r}]", amount)
            for name, amount in {**self.default_amounts, **(reward_amounts or {})}.items()}
        self.settle_steps = checks.whole("settle_steps", settle_steps, least=0)
        self.damping = checks.number("damping", damping, least=0, unit="1/s")
        dt = self.time_step
        what = "pan, tilt, spin in degrees/s, depth in mm/s"
        self._velocity = [dt * v for v in checks.numbers("maximum_state_velocity",
                                                         maximum_state_velocity, what)]
        self._discrete = [dt * v for v in checks.numbers("discrete_action_magnitude",
                                                         discrete_action_magnitude, what)]
        self._tool = "shaft" if with_shaft else None
        num = 8 if control_retraction_force else 5
        self.action_space = (gym.Box(-1.0, 1.0, (num,), np.float32)
                             if action_type == "continuous" else gym.Discrete(11))
        self._num_values = (5 + 7 + 3 * (self.num_tissue_points + self.num_connective_points) + 3
                            + (3 if control_retraction_force else 0))
        self.observation_space = (
            gym.Box(-np.inf, np.inf, (self._num_values,), np.float32)
            if observation_type == "state" else image_space(self.image_shape))
        self._norm = 1.0 / math.dist(WORKSPACE_LOW, WORKSPACE_HIGH)
        self._state_now = list(START)
        self._position, self._quaternion, self._rotation = pose_of(tuple(START))
        self._is_active = False
        self._features = dict.fromkeys(self.default_amounts, 0.0)
        self._retraction = list(FORCE_START)
        self._border = (0.0, 0.0, 0.0)
        self._distance = 0.0
        # Elements of connective tissue and of tissue after an edit in this step.
        self._num_left: Optional[tuple[int, int]] = None
        # The VIOLATIONS since the last reward, 1 or 0 each.
        self._flags = [0.0, 0.0, 0.0]

    # --- The body

    def _mesh(self) -> incise.Mesh:
        nx, ny, nz = self.cells
        per_row = ny // NUM_ROWS
        first = (NUM_ROWS - NUM_FREE_ROWS - self.rows_to_cut) * per_row
        last = (NUM_ROWS - NUM_FREE_ROWS) * per_row
        # A box of two layers of which the lower one is kept below the rows to cut only.
        levels = np.concatenate([np.linspace(0.0, self.gap, nz + 1),
                                 self.gap + np.linspace(0.0, self.thickness, nz + 1)[1:]])
        box = incise.Mesh.box([WIDTH, LENGTH, 1.0], [nx, ny, 2 * nz], "tet",
                              [-0.5 * WIDTH, 0.0, 0.0])
        points, cells = box.points, np.asarray(box.cells)
        layer = np.rint(points[:, 2] * 2 * nz).astype(int)
        points[:, 2] = levels[layer]
        middle = points[cells].mean(axis=1)
        is_low = middle[:, 2] < self.gap
        row = middle[:, 1] * ny / LENGTH
        keep = ~is_low | ((row > first) & (row < last))
        cells, is_low = cells[keep], is_low[keep]
        used = np.unique(cells)
        new = np.full(len(points), -1)
        new[used] = np.arange(len(used))
        return incise.Mesh(points[used], new[cells], np.where(is_low, CONNECTIVE, TISSUE))

    def _make_world(self, young: float) -> World:
        mesh = self._mesh()
        wide, tiny = 1.0, 1e-6
        fixed_end = (NUM_ROWS - NUM_FREE_ROWS - self.rows_to_cut) * LENGTH / NUM_ROWS
        rest = mesh.points
        grasped = np.flatnonzero((np.abs(rest[:, 0]) <= max(0.006, 0.51 * WIDTH / self.cells[0]))
                                 & (rest[:, 1] > LENGTH - tiny))
        unit = self.retraction_force / len(grasped)
        material = {"law": "stable-neo-hookean", "density": self.density, "young": young,
                    "poisson": 0.3}
        # Contact serves the shaft; the flap is drawn away from the board.
        world = incise.World(
            mesh=mesh, materials=[material],
            constraints=[
                {"name": "board", "fix": "xyz",
                 "where": {"box": {"min": [-wide, -wide, -wide], "max": [wide, wide, tiny]}}},
                {"name": "fixed", "fix": "xyz",
                 "where": {"box": {"min": [-wide, -wide, -wide],
                                   "max": [wide, fixed_end - tiny, self.gap + tiny]}}}],
            loads=[{"name": f"retraction_{axis}", "where": {"nodes": grasped.tolist()},
                    "nodal_force": [unit if i == k else 0.0 for i in range(3)]}
                   for k, axis in enumerate("xyz")],
            dynamics={"damping": self.damping, "safety": 0.9},
            contact={"self": False} if self.with_shaft else {"enabled": False},
            num_threads=self.num_threads)
        low, high = WIRE
        extra: dict[str, Any] = {
            "cauter": world.add_tool("cauter", {"kind": "carver", "shape": {"capsule": {
                "from": [0.0, low, TIP_LENGTH], "to": [0.0, high, TIP_LENGTH],
                "radius": self.cutting_radius}}}),
            "loads": [world.loads[f"retraction_{axis}"] for axis in "xyz"]}
        for load, value in zip(extra["loads"], FORCE_START):
            load.factor = value / FORCE_LIMIT
        if self.with_shaft:
            extra["shaft"] = world.add_tool("shaft", {"kind": "probe", "shape": {"capsule": {
                "from": [0.0, 0.0, -0.15], "to": [0.0, 0.0, 0.004], "radius": 0.0015}}}, PARKED)
        extra["cauter"].pose = PARKED
        least_step = self._least_step(world.stable_step)
        for k in range(max(1, self.settle_steps)):
            world.run_until((k + 1) * self.time_step)
            if world.stable_step < least_step:
                raise ValueError(f"before the first episode, {strained(world.stable_step)}")
        return World(world, young, extra)

    # --- An episode

    def _begin(self, options: dict[str, Any], is_random: bool) -> None:
        assert self._ready is not None
        self._cauter = self._ready.extra["cauter"]
        # A start is drawn in each case: options do not change the numbers that follow.
        state = self._random_state()
        if not is_random:
            state = START
        if options.get("state") is not None:
            state = tuple(float(x) for x in options["state"])
            if len(state) != 4 or not self._is_allowed(state):
                raise ValueError(f"state {state} is not pan, tilt, spin and depth within the "
                                 "limits and the workspace")
        self._state_now = list(state)
        self._position, self._quaternion, self._rotation = pose_of(state)
        self._is_active = False
        if self.with_shaft:
            self._ready.extra["shaft"].place(incise.Pose(self._position, self._quaternion))
        self._retraction = list(FORCE_START)
        rest = self.world.rest_positions
        self._first = self.world.elements
        regions = self._first.regions
        self._volume = [float(self._first.volumes[regions == region].sum())
                        for region in (TISSUE, CONNECTIVE)]
        self._count = [0, 0]
        self._num_left = None
        self._full_area = WIDTH * LENGTH * self.rows_to_cut / NUM_ROWS
        self._total_connective = int((regions == CONNECTIVE).sum())
        self._total_tissue = int((regions == TISSUE).sum())
        self._flags = [0.0, 0.0, 0.0]
        self._look_at_mesh(rest, regions)
        self._positions = self.world.positions
        self._find_border()
        self._features = dict.fromkeys(self.default_amounts, 0.0)
        self._features["distance_cauter_border_point"] = self._distance

    def _random_state(self) -> tuple[float, ...]:
        while True:
            noise = self.np_random.uniform(-1.0, 1.0, 4).tolist()
            state = tuple(s + n * d for s, n, d in zip(START, NOISE, noise))
            if self._is_allowed(state):
                return state

    def _is_allowed(self, state: tuple[float, ...]) -> bool:
        position = pose_of(state)[0]
        return (all(low <= s <= high for low, s, high in zip(STATE_LOW, state, STATE_HIGH))
                and all(low <= p / MM <= high for low, p, high
                        in zip(WORKSPACE_LOW, position, WORKSPACE_HIGH)))

    def _checked(self, action: Any) -> Any:
        if self.action_type == "continuous":
            return super()._checked(action)
        if not self.action_space.contains(action):
            raise ValueError(f"a discrete action is a whole number from 0 to 10, not {action!r}")
        return int(action)

    def _move(self, action: Any) -> None:
        assert self._ready is not None
        was_active = self._is_active
        if self.action_type == "continuous":
            if abs(action[4]) > self.activation_deadzone:
                self._is_active = action[4] > 0
            change = [v * a for v, a in zip(self._velocity, action)]
            if self.control_retraction_force:
                for i, load in enumerate(self._ready.extra["loads"]):
                    force = self._retraction[i] + FORCE_STEP * action[5 + i]
                    self._retraction[i] = min(FORCE_LIMIT, max(-FORCE_LIMIT, force))
                    load.factor = self._retraction[i] / FORCE_LIMIT
        else:
            change = [0.0] * 4
            if action < 8:
                change[action // 2] = self._discrete[action // 2] * (1 - 2 * (action % 2))
            elif action < 10:
                self._is_active = action == 8
        now = self._state_now
        state = [s + c for s, c in zip(now, change)]
        for i in range(4):
            if not STATE_LOW[i] <= state[i] <= STATE_HIGH[i]:
                state[i] = now[i]
                self._flags[1] = 1.0
        before = self._position, self._quaternion
        pose = pose_of(tuple(state))
        if all(low <= p / MM <= high for low, p, high
               in zip(WORKSPACE_LOW, pose[0], WORKSPACE_HIGH)):
            self._state_now = state
            self._position, self._quaternion, self._rotation = pose
        else:
            self._flags[0] = 1.0
        if self._tip()[2] < 0.0:
            self._flags[2] = 1.0
        if self._is_active:
            if not was_active:
                self._cauter.place(incise.Pose(*before))
            self._cauter.pose = incise.Pose(self._position, self._quaternion)
        elif was_active:
            self._cauter.place(PARKED)
        if self.with_shaft:
            self._ready.extra["shaft"].pose = incise.Pose(self._position, self._quaternion)

    def _tip(self) -> tuple[float, float, float]:
        """Return the end of the wire, mm."""
        p, r = self._position, self._rotation
        x, y, z = (1000.0 * (p[i] + WIRE[0] * r[i][1] + TIP_LENGTH * r[i][2]) for i in range(3))
        return x, y, z

    def _look_at_mesh(self, rest: Floats, regions: npt.NDArray[np.int64]) -> None:
        """Choose the points to watch."""
        cells = np.asarray(self.world.cells)  # the cauter divides none: all are tetrahedra
        self._tissue_nodes = np.unique(cells[regions == TISSUE])
        self._connective_nodes = np.unique(cells[regions == CONNECTIVE])
        self._is_tissue_node = np.zeros(len(rest), bool)
        self._is_tissue_node[self._tissue_nodes] = True
        watched = []
        for nodes, num in ((self._tissue_nodes, self.num_tissue_points),
                           (self._connective_nodes, self.num_connective_points)):
            num = min(num, len(nodes))
            watched.append(nodes[farthest_points(rest[nodes], num)] if num else nodes[:0])
        self._watched = np.concatenate(watched)
        y = rest[self._connective_nodes, 1]
        self._border_nodes = (self._connective_nodes[y >= y.max() - 1e-9] if len(y)
                              else self._connective_nodes)

    def _find_border(self) -> None:
        if not len(self._border_nodes):
            self._distance = 0.0
            return
        tip = np.array(self._tip())
        points = 1000.0 * self._positions[self._border_nodes]
        away = points - tip
        squares = np.einsum("ij,ij->i", away, away)
        nearest = int(squares.argmin())
        x, y, z = points[nearest].tolist()
        self._border = (x, y, z)
        self._distance = math.sqrt(float(squares[nearest])) * self._norm

    def _on_edit(self, report: incise.StepReport) -> None:
        world = self.world
        rest = world.rest_positions
        elements = world.elements
        volumes, regions = elements.volumes, elements.regions
        left = float(volumes[regions == CONNECTIVE].sum())
        self._area = self._full_area * (1.0 - left / self._volume[1])
        gone = self._gone(elements.centres)
        if gone.any():
            away = self._first.centres[gone, 2] - self.gap
            weights = self._first.volumes[gone]
            self._mean_distance = float((away * weights).sum() / weights.sum())
            self._max_distance = float(away.max())
        tissue = regions == TISSUE
        lost = 1.0 - float(volumes[tissue].sum()) / self._volume[0]
        held = (rest[:, 2] <= 1e-9) | ((rest[:, 2] <= self.gap + 1e-9) & (
            rest[:, 1] < (NUM_ROWS - NUM_FREE_ROWS - self.rows_to_cut) * LENGTH / NUM_ROWS - 1e-6))
        is_off = ~np.isin(elements.components, world.components[held])
        self._lost = max(0.0, lost) + float(volumes[tissue & is_off].sum()) / self._volume[0]
        self._look_at_mesh(rest, regions)
        self._num_left = (int((regions == CONNECTIVE).sum()), int(tissue.sum()))

    def _gone(self, middle: Floats) -> npt.NDArray[np.bool_]:
        """Return which of the first elements are tissue that has been removed."""
        there = {tuple(p) for p in np.rint(middle * 1e7).astype(np.int64).tolist()}
        first = np.rint(self._first.centres * 1e7).astype(np.int64).tolist()
        gone: npt.NDArray[np.bool_] = np.array([tuple(p) not in there for p in first])
        gone &= self._first.regions == TISSUE
        return gone

    def _judge(self) -> tuple[float, bool]:
        self._positions = self.world.positions
        before = self._distance
        self._find_border()
        features = self._features
        edited, self._num_left = self._num_left, None
        features["cut_connective_tissue"] = features["cut_tissue"] = 0.0
        if edited is not None:
            connective, tissue = edited
            removed = self._total_connective - connective
            features["cut_connective_tissue"] = float(removed - self._count[1])
            lost = self._total_tissue - tissue
            features["cut_tissue"] = float(lost - self._count[0])
            self._count = [lost, removed]
        features["distance_cauter_border_point"] = self._distance
        features["delta_distance_cauter_border_point"] = (
            0.0 if edited is not None else self._distance - before)
        for key, flag in zip(VIOLATIONS, self._flags):
            features[key] = flag
        self._flags = [0.0, 0.0, 0.0]
        self._is_success = self._count[1] == self._total_connective
        features["successful_task"] = float(self._is_success)
        amounts = self.reward_amounts
        return sum([amounts[key] * value for key, value in features.items()]), self._is_success

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act for time_step * frame_skip: see the class."""
        observation, reward, terminated, truncated, info = super().step(action)
        if self._is_unstable:
            reward = self.reward_amounts["unstable_deformation"]
            info["unstable_deformation"] = 1.0
        return observation, reward, terminated, truncated, info

    def _state(self) -> npt.NDArray[np.float32]:
        values = np.zeros(self._num_values, np.float32)
        values[:4] = self._state_now
        values[4] = self._is_active
        position = self._position
        values[5:12] = [1000.0 * position[0], 1000.0 * position[1], 1000.0 * position[2],
                        *self._quaternion]
        points = 1000.0 * self._positions[self._watched]
        end = 12 + points.size
        values[12:end] = points.ravel()
        values[end:end + 3] = self._border
        if self.control_retraction_force:
            values[end + 3:end + 6] = self._retraction
        return values

    def _task_info(self) -> dict[str, Any]:
        total = max(1, self._total_connective)
        return {"ratio_cut_connective_tissue": self._count[1] / total,
                "ratio_cut_tissue": self._count[0] / max(1, self._total_tissue),
                **self._features}

    # --- Pictures

    def _scene(self) -> Any:
        world = self.world
        positions, triangles = world.positions, world.surface.triangles
        is_connective = ~self._is_tissue_node[triangles].all(axis=1)
        colors = np.where(is_connective[:, None], np.array([70.0, 110.0, 225.0]),
                          np.array([215.0, 70.0, 62.0]))
        board = np.array([[-0.045, -0.01, -0.0005], [0.045, -0.01, -0.0005],
                          [0.045, 0.11, -0.0005], [-0.045, 0.11, -0.0005]])
        origin, rotation = np.array(self._position), np.array(self._rotation)
        tip = origin + rotation[:, 2] * TIP_LENGTH
        shaft, shaft_triangles = renderer.rod(origin - 0.15 * rotation[:, 2], tip, 0.0015)
        wire, wire_triangles = renderer.rod(tip + WIRE[0] * 2 * rotation[:, 1],
                                            tip + WIRE[1] * 2 * rotation[:, 1], 0.0008)
        parts = [(positions, triangles, colors),
                 (board, np.array([[0, 1, 2], [0, 2, 3]]), (205.0, 190.0, 160.0)),
                 (shaft, shaft_triangles, (90.0, 160.0, 95.0)),
                 (wire, wire_triangles,
                  (255.0, 200.0, 40.0) if self._is_active else (60.0, 110.0, 60.0))]
        points, faces, paint, offset = [], [], [], 0
        for p, t, c in parts:
            points.append(p)
            faces.append(t + offset)
            paint.append(np.broadcast_to(np.asarray(c, float), (len(t), 3)))
            offset += len(p)
        spot = np.array(self._border) * MM
        lines: tuple[renderer.Lines, ...] = ()
        if len(self._border_nodes):
            lines = ((np.array([[spot, spot]]), SPOT_WIDTH, (250, 230, 20)),)
        return np.concatenate(points), np.concatenate(faces), np.concatenate(paint), lines

    def _camera(self, shape: tuple[int, int]) -> renderer.Camera:
        return renderer.Camera([0.085, 0.17, 0.075], [0.0, 0.06, 0.005], shape, 0.75)
