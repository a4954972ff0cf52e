"""Cut a wedge out of the edge of a body."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import line, options as checks
from .base import Floats
from .incision import LineEnv


class WedgeResectionEnv(LineEnv):
    """Remove a wedge from the front edge of a slab by two cuts that meet inside.

    The slab is held at its back, y = size[1]. The edge of the blade is upright and longer than the
    slab is high, so each cut goes right through. The line leads from the front at y = 0 to the apex
    of the wedge and back to the front.

    action: float32, shape (2,), each from -1 to 1:
        0  speed forwards: 0 at -1, max_speed at 1
        1  rate of turning to the left over max_turn
    observation "state": float32, shape (21,):
        0, 1      position of the blade from the middle of the slab, over half its size
        2, 3      force of the tissue on the blade, forwards and to the left, N
        4         share of the line that is done
        5         1 if the blade is in the slab, else 0
        6, 7      share of the wedge that is cut off, and of the rest that is cut off
        8         area_cut over the area of the target
        9, 10     cosine and sine of the heading, the angle of the blade from the x axis
        11 to 20  (forwards, left) of five points of the line from the blade on, 10 mm: the next one
                  to reach and every second one after it
        All values are cut off at -10 and 10.
    observation "rgb": uint8, shape image_shape + (3,).
    reward: 5 for the whole line, in equal parts, each less by its lateral error; 0.2 a mm of
        approach to the next point; -0.02 a step; -0.1 a step in the slab off the line; at the end
        10 times (share of the wedge that is cut off - 5 times the share of the rest).
    end: terminated when half of the wedge or a tenth of the rest is cut off; truncated after
        max_episode_steps.
    success: at least 90 % of the wedge is cut off, and at most 5 % of the rest.
    metrics: coverage, the share of the target surface, which is upright below the line, that has a
        cut within 1 mm; mean_distance and max_distance are infinite while there is no cut.
    options of reset(): line, points (N, 2), m, from front to front; start, x, y
        and z of the blade, m, and the heading, rad. Lines and starts that are farther from the slab
        than the blade can go are refused.
    """

    _num_actions = 2
    _num_values = 21
    _num_levels = 3

    def __init__(self, *, size: tuple[float, float, float] = (0.08, 0.06, 0.01),
                 cells: tuple[int, int, int] = (8, 6, 1), width: float = 0.035,
                 depth: float = 0.03, curvature: float = 0.15,
                 observation_type: str = "state", image_shape: tuple[int, int] = (96, 96),
                 render_mode: Optional[str] = None, time_step: float = 0.01, frame_skip: int = 1,
                 max_episode_steps: int = 250, max_speed: float = 0.1, max_turn: float = 10.0,
                 tolerance: float = 0.003, young: Optional[float] = None,
                 stiffness_range: float = 1.25, num_stiffness_levels: int = 3,
                 toughness: float = 30.0, damping: float = 20.0, randomize: bool = True,
                 num_threads: int = 1) -> None:
        """size: of the slab, m.  cells: bricks along x, y and z, each of six tetrahedra.

        width, depth: of the wedge at the front and from there to its apex, m.
        curvature: largest rise of each side over its chord; 0: plane cuts.
        The others are those of PathIncisionEnv.
        """
        super().__init__(
            size=size, cells=cells, max_speed=max_speed, max_turn=max_turn, tolerance=tolerance,
            toughness=toughness, damping=damping, observation_type=observation_type,
            image_shape=image_shape,
            render_mode=render_mode, time_step=time_step, frame_skip=frame_skip,
            max_episode_steps=max_episode_steps, young=young, stiffness_range=stiffness_range,
            num_stiffness_levels=num_stiffness_levels, randomize=randomize,
            num_threads=num_threads)
        self.width = checks.number("width", width, above=0, unit="m")
        self.depth = checks.number("depth", depth, above=0, unit="m")
        self.curvature = checks.number("curvature", curvature)
        for name, value, whole in (("width", self.width, self.size[0]),
                                   ("depth", self.depth, self.size[1])):
            if not value < 0.8 * whole:
                raise ValueError(f"{name} is {value}: it must be below 0.8 of the slab there, "
                                 f"{0.8 * whole:g} m")
        self._removed = 0.0
        self._target_area = 1.0
        # The blade stays in front of the part that is held, and its edge goes right through.
        self._high[1] = 0.95 * self.size[1]
        self._low[2], self._high[2] = -self.size[2], 0.5 * self.size[2]

    def _constraints(self) -> list[dict[str, Any]]:
        x, y, z = self.size
        return [{"name": "back", "fix": "xyz",
                 "where": {"box": {"min": [-x, (1 - 1e-6) * y, -z], "max": [2 * x, 2 * y, 2 * z]}}}]

    def _edge(self) -> list[list[float]]:
        z = self.size[2]
        return [[0.0, 0.0, -0.5 * z], [0.0, 0.0, 2.0 * z]]

    def _random_line(self, random: np.random.Generator, is_random: bool) -> Floats:
        drawn = random.uniform(-1.0, 1.0, 4)
        shift, lean, bend, grow = drawn.tolist() if is_random else (0.0, 0.0, 1.0, 0.0)
        x = self.size[0] * (0.5 + 0.08 * shift)
        width, depth = self.width * (1 + 0.1 * grow), self.depth * (1 + 0.1 * grow)
        apex = np.array([x + 0.15 * width * lean, depth])
        s = np.linspace(0.0, 1.0, 41)[:, None]
        sides = []
        for sign in (-1.0, 1.0):
            front = np.array([x + sign * 0.5 * width, 0.0])
            chord = apex - front
            across = np.array([chord[1], -chord[0]]) * sign
            side = front + s * chord + 4 * s * (1 - s) * self.curvature * bend * across
            # The line begins and ends 2 mm outside, so that the cuts reach the front.
            out = front - 0.002 * chord / np.linalg.norm(chord)
            sides.append(np.concatenate([[out], side]))
        return line.resampled(np.concatenate([sides[0], sides[1][-2::-1]]), self._num_samples)

    def _random_start(self, random: np.random.Generator, is_random: bool) -> list[float]:
        dx, dy, angle = (random.uniform(-1.0, 1.0, 3) * is_random).tolist()
        first = self._points[0]
        return [first[0] + 0.003 * dx, first[1] - 0.003 * (dy + 1.5), 0.0, 0.5 * angle]

    def _begin(self, options: dict[str, Any], is_random: bool) -> None:
        self._removed = 0.0
        super()._begin(options, is_random)
        self._target_area = self.size[2] * float(
            np.linalg.norm(np.diff(self._line, axis=0), axis=1).sum())

    def _judge(self) -> tuple[float, bool]:
        x, y = self._tip[0], self._tip[1]
        self._is_in_tissue = 0 < x < self.size[0] and 0 < y < self.size[1]
        passed, nearer = self._follow(True)
        reward = -0.02 + 200.0 * nearer
        if passed:
            reward += 5.0 * passed / self._num_points * max(
                0.0, 1.0 - 0.5 * self._off_line() / self.tolerance)
        elif self._is_in_tissue and self._off_line() > self.tolerance:
            reward -= 0.1
        is_done = self._removed >= 0.5 or self._lost >= 0.1
        if is_done:
            reward += 10.0 * (self._removed - 5.0 * self._lost)
            self._is_success = self._removed >= 0.9 and self._lost <= 0.05
        return reward, is_done

    def _held(self, rest: Floats) -> npt.NDArray[np.bool_]:
        return rest[:, 1] >= (1 - 1e-6) * self.size[1]

    def _weigh(self, middle: Floats, volume: Floats, is_off: npt.NDArray[np.bool_]) -> None:
        is_wedge = line.is_inside(middle[:, :2], self._line)
        wedge, rest = volume[is_wedge].sum(), volume[~is_wedge].sum()
        self._removed = float(volume[is_wedge & is_off].sum() / max(wedge, 1e-30))
        self._lost = float(volume[~is_wedge & is_off].sum() / max(rest, 1e-30))

    def _state(self) -> npt.NDArray[np.float32]:
        x, y = self._tip[0], self._tip[1]
        along, left, _ = self._felt()
        values = [2 * x / self.size[0] - 1, 2 * y / self.size[1] - 1, along, left,
                  self._num_done / self._num_points, float(self._is_in_tissue),
                  self._removed, self._lost, min(10.0, self._area / self._target_area),
                  self._cos, self._sin]
        return np.array(values + self._ahead(), np.float32)

    def _task_info(self) -> dict[str, Any]:
        return {**super()._task_info(), "wedge_removed": self._removed}

    def _scene(self) -> Any:
        # The upright edge is longer than the slab is high; the picture shows all of it.
        tip, self._tip = self._tip, [self._tip[0], self._tip[1], -0.5 * self.size[2]]
        try:
            return super()._scene()
        finally:
            self._tip = tip
