"""Cut along a line on a block of skin, to a given depth."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import line, options as checks
from .base import Floats
from .incision import ACCURACY, LineEnv

LEAST_DEPTH = 0.75     # share of the depth at which a point of the line is done
LEAST_COVERAGE = 0.8   # of the target surface by a good cut


class PathIncisionEnv(LineEnv):
    """Follow a marked curve on a block of skin with a blade, at a prescribed depth.

    The block lies on a bed that holds its lower side. The edge of the blade is upright; its lower
    end is the tip. All that the edge sweeps inside the tissue is cut.

    action: float32, shape (3,), each from -1 to 1:
        0  speed forwards: 0 at -1, max_speed at 1
        1  rate of turning to the left over max_turn
        2  velocity upwards over max_speed
    observation "state": float32, shape (22,):
        0 to 2    position of the tip from the middle of the top, over half the size of the block
        3         depth of the tip below the top, over the depth that is asked for
        4         depth that is asked for, over the height of the block
        5 to 7    force of the tissue on the blade, forwards, to the left and up, N
        8         share of the line that is done
        9         1 if the tip is in the tissue, else 0
        10, 11    cosine and sine of the heading, the angle of the blade from the x axis
        12 to 21  (forwards, left) of five points of the line from the tip on, 10 mm: the next one
                  to reach and every second one after it
        All values are cut off at -10 and 10.
    observation "rgb": uint8, shape image_shape + (3,).
    reward: 20 for the whole line, in equal parts for its points, each less by the shares
        (distance of the tip from the line) / tolerance and (error of the depth) / depth, the latter
        at most a half; 0.2 for each mm nearer to the next point at the depth that is asked for;
        -0.02 a step; -0.03 a step in which the tip is in the tissue off the line or too deep by
        half; at the end 5 times coverage, and 5 more for success. A point of the line is done if
        the tip passes it at three quarters of the depth that is asked for, or deeper.
    end: terminated when the tip has passed the last point of the line, truncated after
        max_episode_steps.
    success: at the end, at least 80 % of the target surface has a cut within 1 mm, the mean
        distance of the cut faces from the target is at most 1 mm, and no cut is more than 1 mm too
        deep.
    metrics: coverage, the share of the target surface that has a cut within 1 mm; excess_depth, how
        far the cut goes below the target at most, m; mean_distance and max_distance are infinite
        while there is no cut. The target surface is upright, below the line, to the depth that is
        asked for. A cut ends at faces of elements: choose layers of elements (cells along z) that
        are thin against the depth, or these figures are coarse.
    options of reset(): line, points (N, 2) on the top, m; start, x, y and z of the
        tip, m, and the heading, rad; depth, m. Lines and starts that are farther from the block
        than the tip can go are refused.
    """

    _num_actions = 3
    _num_values = 22
    _option_names = ("stiffness", "randomize", "line", "start", "depth")

    def __init__(self, *, size: tuple[float, float, float] = (0.08, 0.06, 0.01),
                 cells: tuple[int, int, int] = (12, 1, 4), depth: float = 0.006,
                 observation_type: str = "state", image_shape: tuple[int, int] = (96, 96),
                 render_mode: Optional[str] = None, time_step: float = 0.01, frame_skip: int = 1,
                 max_episode_steps: int = 200, max_speed: float = 0.1, max_turn: float = 10.0,
                 tolerance: float = 0.003, young: Optional[float] = None,
                 stiffness_range: float = 1.25, num_stiffness_levels: int = 3,
                 toughness: float = 30.0, damping: float = 20.0, randomize: bool = True,
                 num_threads: int = 1) -> None:
        """size: of the block, m.  cells: bricks along x, y and z, each of six tetrahedra. The cut
            needs them thin along z and short along x; one of them along y is enough.
        depth: of the cut, m.  max_speed: of the tip forwards, up and down, m/s.
        max_turn: rad/s.
        tolerance: how near the tip must come to a point of the line to have done it, m.
        young: Young's modulus, Pa; episodes have young * stiffness_range**e with e from -1 to 1 in
            num_stiffness_levels levels.  toughness: J/m2.  damping: 1/s.
        """
        super().__init__(
            size=size, cells=cells, max_speed=max_speed, max_turn=max_turn, tolerance=tolerance,
            toughness=toughness, damping=damping, observation_type=observation_type,
            image_shape=image_shape,
            render_mode=render_mode, time_step=time_step, frame_skip=frame_skip,
            max_episode_steps=max_episode_steps, young=young, stiffness_range=stiffness_range,
            num_stiffness_levels=num_stiffness_levels, randomize=randomize,
            num_threads=num_threads)
        self.depth = checks.number("depth", depth, above=0, unit="m")
        if not self.depth < self.size[2]:
            raise ValueError(f"depth is {depth}: it must be above 0 and below the height of the "
                             f"block, {self.size[2]} m")
        self._depth = self.depth

    def _constraints(self) -> list[dict[str, Any]]:
        x, y, z = self.size
        return [{"name": "bed", "fix": "xyz",
                 "where": {"box": {"min": [-x, -y, -z], "max": [2 * x, 2 * y, 1e-6 * z]}}}]

    def _edge(self) -> list[list[float]]:
        return [[0.0, 0.0, 0.0], [0.0, 0.0, 3.0 * self.size[2]]]

    def _random_line(self, random: np.random.Generator, is_random: bool) -> Floats:
        drawn = random.uniform(-1.0, 1.0, 3)
        bend, shift, slope = drawn.tolist() if is_random else (0.7, 0.0, 0.0)
        x, y = self.size[0], self.size[1]
        s = np.linspace(0.0, 1.0, 81)
        across = y * (0.5 + 0.12 * shift + 0.12 * slope * (s - 0.5)
                      + 0.15 * bend * np.sin(2 * np.pi * s))
        return line.resampled(np.column_stack([x * (0.15 + 0.7 * s), across]), self._num_samples)

    def _random_start(self, random: np.random.Generator, is_random: bool) -> list[float]:
        dx, dy, dz, angle = (random.uniform(-1.0, 1.0, 4) * is_random).tolist()
        first = self._points[0]
        return [first[0] + 0.003 * (dx - 2.0), first[1] + 0.003 * dy,
                self.size[2] + 0.001 * (dz + 2.0), 0.5 * angle]

    def _begin(self, options: dict[str, Any], is_random: bool) -> None:
        given = options.get("depth")
        self._depth = self.depth if given is None else float(given)
        if not 0 < self._depth < self.size[2]:
            raise ValueError("depth must be above 0 and below the height of the block")
        super()._begin(options, is_random)

    def _distance_to_next(self) -> float:
        """Return the distance to the next point of the line at the target depth, m."""
        flat = super()._distance_to_next()
        return math.hypot(flat, self._tip[2] - self.size[2] + self._depth)

    def _judge(self) -> tuple[float, bool]:
        x, y, z = self._tip
        size = self.size
        depth = size[2] - z
        self._is_in_tissue = depth > 0 and 0 < x < size[0] and 0 < y < size[1]
        error = abs(depth - self._depth) / self._depth
        passed, nearer = self._follow(depth > LEAST_DEPTH * self._depth)
        reward = -0.02 + 200.0 * nearer
        if self._is_in_tissue:
            off = self._off_line()
            if passed:
                reward += 20.0 * passed / self._num_points * max(
                    0.0, 1.0 - off / self.tolerance - min(error, 0.5))
            elif off > self.tolerance:
                reward -= 0.03
            if error > 0.5 and depth > self._depth:
                reward -= 0.03
        is_done = self._next == self._num_points
        if is_done:
            target = self._target
            self._is_success = (target.coverage >= LEAST_COVERAGE
                                and target.excess_depth <= ACCURACY
                                and target.mean_distance <= ACCURACY)
            reward += 5.0 * target.coverage + 5.0 * self._is_success
        return reward, is_done

    def _target_depth(self) -> float:
        return self._depth

    def _held(self, rest: Floats) -> npt.NDArray[np.bool_]:
        return rest[:, 2] <= 1e-6 * self.size[2]

    def _state(self) -> npt.NDArray[np.float32]:
        x, y, z = self._tip
        size = self.size
        along, left, up = self._felt()
        depth = (size[2] - z) / self._depth
        values = [2 * x / size[0] - 1, 2 * y / size[1] - 1, 2 * (z - size[2]) / size[2],
                  depth, self._depth / size[2], along, left, up,
                  self._num_done / self._num_points, float(self._is_in_tissue),
                  self._cos, self._sin]
        if not -10.0 < values[2] < 10.0:
            values[2] = math.copysign(10.0, values[2])
        if not -10.0 < depth < 10.0:
            values[3] = math.copysign(10.0, depth)
        return np.array(values + self._ahead(), np.float32)

    def _task_info(self) -> dict[str, Any]:
        return {**super()._task_info(), "excess_depth": self._target.excess_depth,
                "depth": self.size[2] - self._tip[2]}
