"""A blade that is to cut along a line: the base of two environments."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

import incise

from .. import _renderer as renderer
from . import gym, line, options as checks
from .base import CuttingEnv, Floats, World, image_space
from .target import Target

TIP_TO_HANDLE = 0.03  # m, length of the blade in pictures
NUM_AHEAD = 5         # points of the line in an observation
FAR = 0.002           # m from the block at rest: the blade cuts nothing there
ACCURACY = 0.001      # m: how far a good cut may be from its target
MARK_WIDTH = 0.001    # m, of the line in pictures
WOUND_WIDTH = 0.002   # m, of the edges of a cut in pictures


def rims(triangles: npt.NDArray[np.int64], is_cut: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Return the edges at which cut faces meet the rest of a surface: rows of nodes, shape (M, 2).

    triangles: shape (T, 3).  is_cut: which of them are cut faces, shape (T,).
    """
    edges = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    keys = edges[..., 0] * (1 + int(triangles.max(initial=0))) + edges[..., 1]
    _, rows = np.unique(keys[is_cut], return_index=True)
    cut = edges[is_cut].reshape(-1, 2)[rows]
    met: npt.NDArray[np.int64] = cut[np.isin(keys[is_cut].ravel()[rows], keys[~is_cut])]
    return met


class LineEnv(CuttingEnv):
    """A block, a line on its top, and a blade whose edge is upright.

    The blade moves where it points, as a scalpel does: forwards, and by turning about its edge.
    """

    density = 1000.0
    _tool = "blade"
    _option_names: tuple[str, ...] = ("stiffness", "randomize", "line", "start")
    _num_samples = 41  # points of a line
    _num_levels = 6    # points of the target surface below each point of the line
    _num_actions = 2
    _num_values = 0

    def __init__(self, *, size: tuple[float, float, float], cells: tuple[int, int, int],
                 max_speed: float, max_turn: float, tolerance: float, toughness: float,
                 damping: float, **common: Any) -> None:
        super().__init__(**common)
        self.size = checks.numbers("size", size, "along x, y, z in m", above=0)
        self.cells = checks.wholes("cells", cells, "bricks along x, y, z")
        self.max_speed = checks.number("max_speed", max_speed, above=0, unit="m/s")
        self.max_turn = checks.number("max_turn", max_turn, least=0, unit="rad/s")
        self.tolerance = checks.number("tolerance", tolerance, above=0, unit="m")
        self.toughness = checks.number("toughness", toughness, above=0, unit="J/m2")
        self.damping = checks.number("damping", damping, least=0, unit="1/s")
        self._stride = self.max_speed * self.time_step
        self._turn = self.max_turn * self.time_step
        self._heading = 0.0
        self._cos, self._sin = 1.0, 0.0
        self._blade: Any = None
        self._tip = [0.0, 0.0, 0.0]
        self._line: Floats = np.zeros((2, 2))
        self._target = Target(self._line, self.size, self.size[2], 1, ACCURACY)
        self._points: list[list[float]] = []
        self._num_points = 0
        self._num_done = 0
        self._next = 0
        x, y, z = self.size
        # Where the tip may be, x, y and z, m.
        self._low = [-0.1 * x, -0.2 * y, 0.1 * z]
        self._high = [1.1 * x, 1.1 * y, z + 0.01]
        self._gap = 0.0
        self._is_in_tissue = False
        self.action_space = gym.Box(-1.0, 1.0, (self._num_actions,), np.float32)
        self.observation_space = (
            gym.Box(-10.0, 10.0, (self._num_values,), np.float32)
            if self.observation_type == "state" else image_space(self.image_shape))

    # --- The body

    def _constraints(self) -> list[dict[str, Any]]:
        raise NotImplementedError

    def _edge(self) -> list[list[float]]:
        raise NotImplementedError

    def _make_world(self, young: float) -> World:
        world = incise.World(
            mesh={"box": {"size": list(self.size), "cells": list(self.cells)}},
            materials=[{"law": "stable-neo-hookean", "density": self.density, "young": young,
                        "poisson": 0.4}],
            constraints=self._constraints(),
            dynamics={"damping": self.damping, "safety": 0.9},
            num_threads=self.num_threads)
        blade = world.add_tool(
            "blade", {"kind": "blade", "edge": self._edge(), "snap": 0.1,
                      "toughness": self.toughness})
        # The blade appears far away; each episode places it.
        blade.pose = incise.Pose([0.0, 0.0, 10.0 * max(self.size)])
        world.run_until(self.time_step)
        return World(world, young, {"blade": blade})

    # --- An episode

    def _random_line(self, random: np.random.Generator, is_random: bool) -> Floats:
        raise NotImplementedError

    def _random_start(self, random: np.random.Generator, is_random: bool) -> list[float]:
        """Return x, y and z of the tip, m, and the angle of the blade to the line there, rad."""
        raise NotImplementedError

    def _begin(self, options: dict[str, Any], is_random: bool) -> None:
        assert self._ready is not None
        self._line = self._random_line(self.np_random, is_random)
        if options.get("line") is not None:
            self._line = line.resampled(options["line"], self._num_samples)
            self._require_reach(self._line, "line")
        points = self._line.tolist()
        self._num_points = len(points)
        # The last point again, for what looks ahead of it.
        self._points = points + [points[-1]] * (2 * NUM_AHEAD)
        *tip, angle = self._random_start(self.np_random, is_random)
        self._tip = self._kept(*tip)
        (x0, y0), (x1, y1) = points[0], points[1]
        self._heading = math.atan2(y1 - y0, x1 - x0) + angle
        if options.get("start") is not None:
            start = np.asarray(options["start"], float)
            if start.shape != (4,) or not np.isfinite(start).all():
                raise ValueError("start is x, y and z of the tip, m, and the heading, rad")
            self._require_reach(start[None, :3], "start")
            *self._tip, self._heading = start.tolist()
        self._cos, self._sin = math.cos(self._heading), math.sin(self._heading)
        self._blade = self._ready.extra["blade"]
        self._blade.place(incise.Pose(self._tip))
        self._next = self._num_done = 0
        self._is_in_tissue = False
        self._target = Target(self._line, self.size, self._target_depth(), self._num_levels,
                              ACCURACY)
        self._mean_distance = self._max_distance = math.inf
        self._gap = self._distance_to_next()

    def _require_reach(self, points: Floats, name: str) -> None:
        """Raise ValueError if the tip cannot go to points, (x, y) or (x, y, z) each, m."""
        num = points.shape[1]
        low, high = self._low[:num], self._high[:num]
        if not ((points >= low) & (points <= high)).all():
            raise ValueError(f"{name} is beyond where the blade can go: from {low} to {high} m")

    def _kept(self, x: float, y: float, z: float) -> list[float]:
        """Return the nearest place to which the tip can go, m."""
        (x0, y0, z0), (x1, y1, z1) = self._low, self._high
        return [x0 if x < x0 else x1 if x > x1 else x, y0 if y < y0 else y1 if y > y1 else y,
                z0 if z < z0 else z1 if z > z1 else z]

    def _distance_to_next(self) -> float:
        """Return the distance to the next point of the line, m."""
        x, y = self._points[self._next]
        return math.hypot(self._tip[0] - x, self._tip[1] - y)

    def _move(self, action: list[float]) -> None:
        size = self.size
        x, y, z = self._tip
        self._heading += self._turn * action[1]
        self._cos, self._sin = math.cos(self._heading), math.sin(self._heading)
        stride = 0.5 * self._stride * (action[0] + 1.0)
        if len(action) > 2:
            z += self._stride * action[2]
        self._tip = x, y, z = self._kept(x + stride * self._cos, y + stride * self._sin, z)
        pose = incise.Pose(self._tip)
        # Far from the tissue the blade sweeps nothing, which spares the world to keep its way.
        if (x < -FAR or y < -FAR or x > size[0] + FAR or y > size[1] + FAR
                or z > size[2] + FAR) and not self._blade.is_in_tissue:
            self._blade.place(pose)
        else:
            self._blade.pose = pose

    def _follow(self, is_deep_enough: bool) -> tuple[int, float]:
        """Do the points of the line that the tip has reached, in their order.

        Up to four points in a row may be left out; they stay undone. Return how many were done, and
        how much nearer the tip has come to the next one, m.
        """
        passed = 0
        x, y = self._tip[0], self._tip[1]
        if is_deep_enough:
            limit = self.tolerance ** 2
            k = self._next
            while k < min(self._next + 5, self._num_points):
                px, py = self._points[k]
                if (px - x) ** 2 + (py - y) ** 2 <= limit:
                    self._next = k + 1
                    passed += 1
                k += 1
            self._num_done += passed
        before, self._gap = self._gap, self._distance_to_next()
        return passed, 0.0 if passed else before - self._gap

    def _off_line(self) -> float:
        """Return the distance of the tip from the points of the line near the next one, m."""
        x, y = self._tip[0], self._tip[1]
        near = self._points[max(0, self._next - 6):self._next + 4]
        return math.sqrt(min([(px - x) ** 2 + (py - y) ** 2 for px, py in near]))

    def _ahead(self) -> list[float]:
        """Return the next points of the line in the frame of the blade: (forwards, left) of each.

        In units of 10 mm, cut off at -10 and 10.
        """
        x, y, _ = self._tip
        c, s = 100.0 * self._cos, 100.0 * self._sin
        values: list[float] = []
        for px, py in self._points[self._next:self._next + 2 * NUM_AHEAD:2]:
            dx, dy = px - x, py - y
            along, left = c * dx + s * dy, c * dy - s * dx
            values.append(along if -10.0 < along < 10.0 else math.copysign(10.0, along))
            values.append(left if -10.0 < left < 10.0 else math.copysign(10.0, left))
        return values

    def _felt(self) -> tuple[float, float, float]:
        """Return the force on the blade forwards, to the left and up, N, at most 10 each way."""
        x, y, z = self._force
        c, s = self._cos, self._sin
        along, left = c * x + s * y, c * y - s * x
        if abs(along) > 10.0 or abs(left) > 10.0 or abs(z) > 10.0:
            along, left, z = (min(10.0, max(-10.0, f)) for f in (along, left, z))
        return along, left, z

    def _target_depth(self) -> float:
        """Return the depth of the target surface below the top, m."""
        return self.size[2]

    def _on_edit(self, report: incise.StepReport) -> None:
        edits = report.edits
        area = sum([edit["cut_area"] for edit in edits])
        if area == 0.0:
            return  # elements were divided, and no faces opened
        self._area += area
        world = self.world
        surface = world.surface
        rest = world.rest_positions
        self._target.measure(rest[surface.triangles[surface.is_cut]])
        self._mean_distance = self._target.mean_distance
        self._max_distance = self._target.max_distance
        if edits[-1]["after"]["components"] > 1:
            self._on_parts(rest)

    def _on_parts(self, rest: Floats) -> None:
        """Measure what has come off the held part."""
        elements = self.world.elements
        held = self.world.components[self._held(rest)]
        self._weigh(elements.centres, elements.volumes, ~np.isin(elements.components, held))

    def _held(self, rest: Floats) -> npt.NDArray[np.bool_]:
        raise NotImplementedError

    def _weigh(self, middle: Floats, volume: Floats, is_off: npt.NDArray[np.bool_]) -> None:
        """Measure what has come off, from the middle of each element, its volume, and if it has."""
        self._lost = float(volume[is_off].sum() / volume.sum())

    def _task_info(self) -> dict[str, Any]:
        return {"coverage": self._target.coverage,
                "progress": self._num_done / self._num_points}

    # --- Pictures

    skin, cut_color = (226.0, 178.0, 150.0), (178.0, 40.0, 44.0)

    def _scene(self) -> Any:
        world = self.world
        positions = world.positions
        surface = world.surface
        colors = np.where(surface.is_cut[:, None], np.array(self.cut_color), np.array(self.skin))
        top = np.array(self._tip) + [0.0, 0.0, TIP_TO_HANDLE]
        points, triangles = renderer.rod(np.array(self._tip), top, 0.0012)
        marked = np.column_stack([self._line, np.full(len(self._line), self.size[2])])
        # The lips of a closed wound hide its faces. So their edges are drawn.
        lips = positions[rims(surface.triangles, surface.is_cut)]
        lines = ((np.stack([marked[:-1], marked[1:]], axis=1), MARK_WIDTH, (30, 60, 160)),
                 (lips, WOUND_WIDTH, (190, 20, 24)))
        return (np.concatenate([positions, points]),
                np.concatenate([surface.triangles, triangles + len(positions)]),
                np.concatenate([colors, np.full((len(triangles), 3), 120.0)]), lines)

    def _camera(self, shape: tuple[int, int]) -> renderer.Camera:
        x, y, z = self.size
        reach = 1.15 * max(x, y)
        return renderer.Camera([0.5 * x, 0.5 * y - 0.95 * reach, z + 1.15 * reach],
                               [0.5 * x, 0.5 * y, 0.5 * z], shape)
