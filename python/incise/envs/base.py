"""What the environments have in common: worlds that are made once, episodes, pictures, metrics."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math
import warnings
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

import incise

from .. import _renderer as renderer
from . import gym, options as checks

Floats = npt.NDArray[np.float64]
OBSERVATIONS = ("state", "rgb")
NO_FORCE = (0.0, 0.0, 0.0)
# Steps of the simulation that are shorter than this share of time_step would take seconds.
LEAST_STEP = 1e-3
# Stiff tissue and small elements have short steps at rest: then a fall to this share is the limit.
LEAST_SHARE = 0.1


class World:
    """A world that is ready for episodes, with the state that each of them begins from."""

    def __init__(self, world: incise.World, young: float,
                 extra: Optional[dict[str, Any]] = None) -> None:
        """extra: tools and loads that the task leads."""
        self.world = world
        self.young = young
        self.state = world.save()
        self.stable_step = world.stable_step
        self.extra = extra or {}


class CuttingEnv(gym.Env):
    """A soft body and a tool that an agent moves. The base of the environments.

    One call of step() is time_step times frame_skip of simulated time. Worlds are made at the first
    reset() that needs them and then restored: one for each level of stiffness.

    An episode ends as unstable, with the reward of that and info["is_unstable"], if the motion is
    lost, if a tool cannot do what it is led to, or if the tissue is strained so much that the
    steps of the simulation become a thousand times shorter than time_step. info["error"] says why;
    it is empty otherwise.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 100}

    # Set by the classes of the tasks.
    _default_young = 2e3
    _num_spare_worlds = 4

    def __init__(self, *, observation_type: str, image_shape: tuple[int, int],
                 render_mode: Optional[str], time_step: float, frame_skip: int,
                 max_episode_steps: int, young: Optional[float], stiffness_range: float,
                 num_stiffness_levels: int, randomize: bool, num_threads: int) -> None:
        if observation_type not in OBSERVATIONS:
            raise ValueError(f"observation_type is {observation_type!r}: it must be 'state' or "
                             "'rgb'")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}: it must be None, 'rgb_array' or "
                             "'ansi'")
        self.observation_type = observation_type
        self.image_shape = checks.picture_shape("image_shape", image_shape)
        self.render_mode = render_mode
        self.time_step = checks.number("time_step", time_step, above=0, unit="s")
        self.frame_skip = checks.whole("frame_skip", frame_skip, least=1)
        self.max_episode_steps = checks.whole("max_episode_steps", max_episode_steps, least=1)
        self.young = checks.number("young", self._default_young if young is None else young,
                                   above=0, unit="Pa")
        self.stiffness_range = checks.number("stiffness_range", stiffness_range, least=1)
        self.num_stiffness_levels = checks.whole("num_stiffness_levels", num_stiffness_levels,
                                                 least=1)
        self.randomize = bool(randomize)
        self.num_threads = checks.whole("num_threads", num_threads, least=1,
                                        most=checks.MAX_THREADS)
        self.metadata = {**type(self).metadata,
                         "render_fps": max(1, round(1 / (self.time_step * self.frame_skip)))}
        self._seconds = self.time_step * self.frame_skip
        self._worlds: dict[float, World] = {}
        self._ready: Optional[World] = None
        self._can_step = False
        self._start = 0.0
        self._num_steps = 0
        self._version = 0
        self._area = 0.0
        self._lost = 0.0
        self._mean_distance = 0.0
        self._max_distance = 0.0
        self._largest_force = 0.0
        self._force: tuple[float, float, float] = NO_FORCE
        self._is_unstable = False
        self._error = ""
        self._is_success = False

    # --- What the task says

    def _make_world(self, young: float) -> World:
        """Return a world with its tools, at rest, for a stiffness, Pa."""
        raise NotImplementedError

    def _begin(self, options: dict[str, Any], is_random: bool) -> None:
        """Draw what is random, and place the tool. The world is that of the start."""
        raise NotImplementedError

    def _move(self, action: Any) -> None:
        """Lead the tool for one simulated time step."""
        raise NotImplementedError

    def _judge(self) -> tuple[float, bool]:
        """Return the reward of this step, and whether the task is over."""
        raise NotImplementedError

    def _on_edit(self, report: incise.StepReport) -> None:
        """Measure the cut after a step that changed the mesh."""
        raise NotImplementedError

    def _state(self) -> npt.NDArray[np.float32]:
        """Return the observation as a vector."""
        raise NotImplementedError

    def _task_info(self) -> dict[str, Any]:
        """Return what info says beyond the common metrics."""
        raise NotImplementedError

    def _scene(self) -> tuple[Floats, npt.NDArray[np.int64], Floats, tuple[renderer.Lines, ...]]:
        """Return points, triangles, their colours, and lines: see renderer.draw()."""
        raise NotImplementedError

    def _camera(self, shape: tuple[int, int]) -> renderer.Camera:
        raise NotImplementedError

    _option_names: tuple[str, ...] = ("stiffness", "randomize")

    # --- Gymnasium's interface

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[dict[str, Any]] = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode. Return (observation, info).

        After a call that raises, step() and render() raise ResetNeeded.

        seed: begins the random numbers anew; None goes on with them.
        options: a dict. stiffness: Young's modulus, Pa.  randomize: False for the same start each
            time. More of them are in the texts of the classes.
        """
        self._can_step = False
        self._ready = None
        super().reset(seed=seed)
        drawn = self.np_random.bit_generator.state
        try:
            result = self._begin_episode(dict(options or {}))
        except BaseException:
            # Nothing of a refused episode is left, so that the next one is as without it.
            self._ready = None
            self.np_random.bit_generator.state = drawn
            raise
        self._can_step = True
        return result

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act. Return (observation, reward, terminated, truncated, info).

        Raises ResetNeeded before reset() and after the end of an episode. An action that is
        refused, with a ValueError, changes nothing.
        """
        if not self._can_step or self._ready is None:
            raise gym.ResetNeeded("call reset() before step(), and after the end of an episode")
        world = self._ready.world
        action = self._checked(action)
        self._num_steps += 1
        least_step = self._least_step(self._ready.stable_step)
        for i in range(self.frame_skip):
            at = (self._num_steps - 1) * self.frame_skip + i + 1
            try:
                self._move(action)
                report = world.run_until(self._start + at * self.time_step)
            except (incise.PhysicsError, incise.InputError) as error:
                self._error = str(error)
                break
            self._feel(report)
            if world.topology_version != self._version:
                self._version = world.topology_version
                self._on_edit(report)
            if world.stable_step < least_step:
                self._error = strained(world.stable_step)
                break
        self._is_unstable = bool(self._error)
        if self._is_unstable:
            reward, terminated = -1.0, True
        else:
            reward, terminated = self._judge()
        truncated = not terminated and self._num_steps >= self.max_episode_steps
        self._can_step = not (terminated or truncated)
        return self._observation(), float(reward), terminated, truncated, self._info()

    def render(self) -> Any:
        """Return what render_mode says: a picture as picture(), a line of text, or None."""
        if self.render_mode is None:
            return None
        if self._ready is None:
            raise gym.ResetNeeded("call reset() before render()")
        if self.render_mode == "rgb_array":
            return self.picture()
        metrics = self._info()
        return " ".join(f"{key}={value:.6g}" if isinstance(value, float) else f"{key}={value}"
                        for key, value in metrics.items())

    def close(self) -> None:
        """Give back the worlds. reset() makes new ones."""
        self._worlds.clear()
        self._ready = None
        self._can_step = False

    def picture(self, shape: Optional[tuple[int, int]] = None) -> npt.NDArray[np.uint8]:
        """Return a picture of the scene, uint8, shape (height, width, 3).

        shape: height and width, pixels; None: image_shape.
        """
        size = self.image_shape if shape is None else checks.picture_shape("shape", shape)
        points, triangles, colors, lines = self._scene()
        return renderer.draw(self._camera(size), points, triangles, colors,
                             lines)

    @property
    def world(self) -> incise.World:
        """The world of this episode, to look at. Raises ResetNeeded before reset()."""
        if self._ready is None:
            raise gym.ResetNeeded("call reset() first")
        return self._ready.world

    # --- Common parts

    def _begin_episode(self, given: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        """Draw what is random, and go to the start. Return (observation, info)."""
        unknown = sorted(set(given) - set(self._option_names), key=str)
        if unknown:
            raise ValueError(f"reset() knows no options {unknown}; it knows "
                             f"{list(self._option_names)}")
        is_random = bool(given.get("randomize", self.randomize))
        # A level is drawn in each case: options do not change the numbers that follow.
        level = int(self.np_random.integers(self.num_stiffness_levels))
        share = 0.0
        if is_random and self.num_stiffness_levels > 1:
            share = 2.0 * level / (self.num_stiffness_levels - 1) - 1.0
        young = checks.number(
            "stiffness", given.get("stiffness", self.young * self.stiffness_range ** share),
            above=0, unit="Pa")
        self._ready = self._world_of(young)
        world = self._ready.world
        world.restore(self._ready.state)
        self._start = world.time
        self._num_steps = 0
        self._version = world.topology_version
        self._area = self._lost = self._mean_distance = self._max_distance = 0.0
        self._largest_force, self._force = 0.0, NO_FORCE
        self._is_unstable = self._is_success = False
        self._error = ""
        self._begin(given, is_random)
        return self._observation(), self._info()

    def _least_step(self, at_start: float) -> float:
        """Return the stable step below which the simulation is given up, s.

        at_start: the stable step before the episode, s.
        """
        return min(LEAST_STEP * self.time_step, LEAST_SHARE * at_start)

    def _world_of(self, young: float) -> World:
        found = self._worlds.get(young)
        if found is None:
            # Options may ask for any stiffness: the oldest world goes.
            limit = self.num_stiffness_levels + self._num_spare_worlds
            if len(self._worlds) >= limit:
                self._worlds.pop(next(iter(self._worlds)))
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", incise.InciseWarning)
                found = self._make_world(young)
            self._worlds[young] = found
        return found

    def _checked(self, action: Any) -> Any:
        """Return an action as a list of numbers in [-1, 1]."""
        values = np.asarray(action, np.float64)
        if values.shape != self.action_space.shape:
            raise ValueError(f"an action has the shape {self.action_space.shape}, this one "
                             f"{values.shape}")
        numbers = values.tolist()
        for i, value in enumerate(numbers):
            if not -1.0 <= value <= 1.0:
                if math.isnan(value):
                    raise ValueError("an action is not a number")
                numbers[i] = 1.0 if value > 0 else -1.0
        return numbers

    _tool: Optional[str] = None

    def _feel(self, report: incise.StepReport) -> None:
        if self._tool is not None:
            x, y, z = report.tool_forces[self._tool].tolist()
            self._force = (x, y, z)
            self._largest_force = max(self._largest_force, math.sqrt(x * x + y * y + z * z))

    def _observation(self) -> Any:
        return self._state() if self.observation_type == "state" else self.picture()

    def _info(self) -> dict[str, Any]:
        return {
            "area_cut": self._area,
            "mean_distance": self._mean_distance,
            "max_distance": self._max_distance,
            "tissue_lost": self._lost,
            "largest_force": self._largest_force,
            "success": self._is_success,
            "is_unstable": self._is_unstable,
            "error": self._error,
            "stiffness": self._ready.young if self._ready else 0.0,
            "time": self._num_steps * self._seconds,
            **self._task_info(),
        }


def strained(stable_step: float) -> str:
    """Return the text of an error: tissue is so strained that this is its stable step, s."""
    return (f"the tissue is strained so much that the simulation needs steps of {stable_step:.2g} "
            "s: move tools more slowly, or apply smaller forces")


def image_space(shape: tuple[int, int]) -> Any:
    """Return the space of pictures: uint8, shape (height, width, 3)."""
    return gym.Box(0, 255, (*shape, 3), np.uint8)
