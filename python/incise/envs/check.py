"""A checker of Gymnasium's contract that needs no gymnasium."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import copy
import inspect
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import gym


def same(a: Any, b: Any) -> bool:
    """Return whether two observations or infos have the same types and the same bits."""
    if type(a) is not type(b):
        return False
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, np.ndarray):
        return bool(a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes())
    return bool(a == b or (isinstance(a, float) and math.isnan(a) and math.isnan(b)))


def _require(holds: bool, what: str) -> None:
    if not holds:
        raise AssertionError(what)


def _check_space(space: Any, name: str) -> None:
    _require(isinstance(space, gym.Space), f"{name} is no space")
    for seed in range(3):
        space.seed(seed)
        first = space.sample()
        space.seed(seed)
        _require(same(first, space.sample()), f"{name}: the same seed gives another sample")
        _require(space.contains(first), f"{name} does not contain its sample {first!r}")
    _require(not space.contains("no value"), f"{name} contains a text")
    _require(space == copy.deepcopy(space), f"{name} is not equal to its copy")
    _require(space != gym.Discrete(12345), f"{name} is equal to another space")


def _check_observation(env: Any, observation: Any, where: str) -> None:
    space = env.observation_space
    _require(isinstance(observation, np.ndarray), f"{where}: the observation is no array")
    _require(observation.dtype == space.dtype, f"{where}: its dtype is {observation.dtype}")
    _require(space.contains(observation), f"{where}: it is not in the observation space: "
             f"{observation!r}")
    _require(bool(np.isfinite(observation).all()), f"{where}: it is not finite")


def _check_info(info: Any, keys: Any, where: str) -> None:
    _require(isinstance(info, dict), f"{where}: info is no dict")
    _require(keys is None or list(info) == keys, f"{where}: info has other keys: {sorted(info)}")
    for key, value in info.items():
        _require(isinstance(value, (bool, int, float, str, np.ndarray)),
                 f"{where}: info[{key!r}] is a {type(value).__name__}")


def roll(env: Any, seed: int, num_steps: int) -> list[Any]:
    """Return all that an environment says in steps of random actions from a seed, with resets."""
    env.action_space.seed(seed)
    said: list[Any] = [env.reset(seed=seed)]
    for _ in range(num_steps):
        result = env.step(env.action_space.sample())
        said.append(result)
        if result[2] or result[3]:
            said.append(env.reset())
    return said


def _check_needs_reset(env: Any, when: str) -> None:
    try:
        env.step(env.action_space.sample())
    except gym.ResetNeeded:
        return
    except Exception as error:
        raise AssertionError(f"step() {when} raises {type(error).__name__}, and not "
                             "ResetNeeded") from error
    raise AssertionError(f"step() {when} raises nothing")


def _is_refused(call: Callable[[], Any]) -> bool:
    try:
        call()
    except Exception:
        return True
    return False


def _check_refusals(env: Any, other: Any, seed: int) -> None:
    """Check that what an environment refuses leaves no trace."""
    for each in (env, other):
        each.action_space.seed(seed)
        each.reset(seed=seed)
    if _is_refused(lambda: env.step("no action")):
        for _ in range(2):
            action = env.action_space.sample()
            _require(same(env.step(action), other.step(action)),
                     "after an action that was refused, a step gives other values")
    # An environment may take any options. If it refuses them, there is no episode.
    if _is_refused(lambda: env.reset(options={"no such option": None})):
        _check_needs_reset(env, "after a reset() that was refused")


def check_env(make: Callable[..., Any], *, seeds: Sequence[int] = range(3),
              num_steps: int = 30) -> None:
    """Check that an environment keeps Gymnasium's contract. Raises AssertionError if not.

    make: a class of environments, or a function that takes render_mode and returns one.
    seeds: of the episodes that are run twice, in one environment and in another.
    """
    if not callable(make):
        raise ValueError(f"make is {make!r}: it must be a class of environments, or a function "
                         "that takes render_mode and returns one: give the class, not an object")
    try:
        inspect.signature(make).bind(render_mode=None)
    except TypeError as error:
        raise ValueError(f"make is {make!r}: it must take render_mode, as in "
                         "lambda render_mode=None: PathIncisionEnv(render_mode=render_mode)"
                         ) from error
    env = make()
    _require(isinstance(env, gym.Env), f"make() returns {env!r}, which is no Env")
    _require(env.unwrapped is env, "unwrapped is not the environment")
    _require(env.spec is None or hasattr(env.spec, "id"), "spec is no specification")
    _check_space(env.action_space, "action_space")
    _check_space(env.observation_space, "observation_space")
    modes = env.metadata.get("render_modes")
    _require(isinstance(modes, list) and all(isinstance(m, str) for m in modes),
             "metadata['render_modes'] is no list of texts")
    _require(env.metadata.get("render_fps", 0) > 0, "metadata['render_fps'] is missing")
    parameters = inspect.signature(env.reset).parameters
    for name in ("seed", "options"):
        _require(name in parameters and parameters[name].kind is inspect.Parameter.KEYWORD_ONLY
                 and parameters[name].default is None, f"reset() lacks the keyword {name}=None")
    _check_needs_reset(env, "before reset()")

    result = env.reset(seed=seeds[0], options={})
    _require(isinstance(result, tuple) and len(result) == 2, "reset() returns no pair")
    first_state = env.np_random.bit_generator.state
    env.reset(seed=seeds[0])
    _require(env.np_random.bit_generator.state == first_state,
             "the same seed leaves the generator in another state")
    keys = list(result[1])
    _check_observation(env, result[0], "reset()")
    _check_info(result[1], keys, "reset()")
    kept, before = result[0], result[0].copy()
    for seed in seeds:
        env.action_space.seed(seed)
        observation, info = env.reset(seed=seed)
        _check_observation(env, observation, f"reset(seed={seed})")
        for _ in range(num_steps):
            result = env.step(env.action_space.sample())
            _require(isinstance(result, tuple) and len(result) == 5, "step() returns no five")
            observation, reward, terminated, truncated, info = result
            where = f"seed {seed}"
            _check_observation(env, observation, where)
            _require(type(reward) is float and math.isfinite(reward),
                     f"{where}: the reward is {reward!r}")
            _require(type(terminated) is bool and type(truncated) is bool,
                     f"{where}: terminated and truncated are no bools")
            _check_info(info, keys, where)
            if terminated or truncated:
                break
    _require(same(kept, before), "a step changed an observation that was returned before")
    other = make()
    for seed in seeds:
        _require(same(roll(env, seed, num_steps), roll(other, seed, num_steps)),
                 f"seed {seed} gives other values in another environment")
    _require(not same(roll(env, seeds[0], 3), roll(env, seeds[0] + 1, 3)),
             "two seeds give the same episode")
    _check_refusals(env, other, seeds[0])
    other.close()
    env.close()
    env.close()

    for mode in modes:
        with make(render_mode=mode) as shown:
            shown.reset(seed=0)
            shown.step(shown.action_space.sample())
            picture = shown.render()
            if mode == "rgb_array":
                _require(isinstance(picture, np.ndarray) and picture.dtype == np.uint8
                         and picture.ndim == 3 and picture.shape[2] == 3,
                         "render() returns no picture")
            elif mode == "ansi":
                _require(isinstance(picture, str), "render() returns no text")
    try:
        make(render_mode="no mode")
    except Exception:
        pass
    else:
        raise AssertionError("an unknown render mode is accepted")
