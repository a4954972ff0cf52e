"""Episodes of the environments: what is refused, what fails, and what is drawn."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import math
import subprocess
import sys
import unittest
from typing import Any, Optional

import numpy as np

import incise
from incise import envs
from incise.envs.check import same
from test_envs import ALL


class Refusals(unittest.TestCase):
    def test_a_refused_action_leaves_no_trace(self) -> None:
        for kind in ALL:
            with self.subTest(kind=kind.__name__):
                env, other = kind(), kind()
                action = env.action_space.sample()
                for each in (env, other):
                    each.reset(seed=2)
                    each.step(action)
                for wrong in (action[:-1], np.full_like(action, math.nan)):
                    with self.assertRaises(ValueError):
                        env.step(wrong)
                for _ in range(3):
                    self.assertTrue(same(env.step(action), other.step(action)))

    def test_a_refused_reset_changes_no_later_random_numbers(self) -> None:
        for kind, option in ((envs.PathIncisionEnv, "line"), (envs.PathIncisionEnv, "depth"),
                             (envs.WedgeResectionEnv, "stiffness"), (envs.DissectionEnv, "state"),
                             (envs.DissectionEnv, "nothing")):
            with self.subTest(kind=kind.__name__, option=option):
                env, other = kind(), kind()
                env.reset(seed=5)
                other.reset(seed=5)
                with self.assertRaises((ValueError, TypeError)):
                    env.reset(options={option: "x"})
                self.assertTrue(same(env.reset(), other.reset()))

    def test_a_refused_reset_ends_the_episode(self) -> None:
        for kind, options in ((envs.PathIncisionEnv, {"start": [0.0, 0.0]}),
                              (envs.PathIncisionEnv, {"line": [[0.0, 0.0]]}),
                              (envs.PathIncisionEnv, {"depth": 1.0}),
                              (envs.PathIncisionEnv, {"depth": 0.0}),
                              (envs.WedgeResectionEnv, {"start": [0.0]}),
                              (envs.DissectionEnv, {"state": [0.0]}),
                              (envs.DissectionEnv, {"stiffness": -1.0}),
                              (envs.DissectionEnv, {"colour": 1})):
            for is_first in (True, False):
                with self.subTest(kind=kind.__name__, options=options, is_first=is_first):
                    env = kind(render_mode="ansi")
                    if not is_first:
                        env.reset(seed=0)
                    with self.assertRaises(ValueError):
                        env.reset(options=options)
                    with self.assertRaises(envs.ResetNeeded):
                        env.step(env.action_space.sample())
                    with self.assertRaises(envs.ResetNeeded):
                        env.render()
                    env.reset(seed=0)
                    env.step(env.action_space.sample())


class Options(unittest.TestCase):
    """Constructors refuse values at once, and say which, and what is allowed."""

    common = {"num_threads": (0, 257, 1.5), "young": (-5, 0, math.inf, "soft"),
              "image_shape": ((64, 64, 3), (0, 64), 96, (64.5, 64), "ab"),
              "time_step": (0, math.nan, None), "frame_skip": (0, 1.5), "damping": (-1.0,),
              "max_episode_steps": (0,), "stiffness_range": (0.5, math.inf),
              "num_stiffness_levels": (0,), "cells": ((0, 1, 1), (4, 4), 4, (2.5, 1, 1)),
              "observation_type": ("smell",), "render_mode": ("human",)}
    blade = {"size": ((0.1, 0.1), (0.1, 0.1, -0.1), 0.1), "toughness": (-5, 0), "max_speed": (0,),
             "max_turn": (-1,), "tolerance": (0,), "depth": (0, 1.0, "deep")}
    of_kind = {envs.PathIncisionEnv: blade,
               envs.WedgeResectionEnv: {**blade, "width": (0, 1.0), "curvature": (math.nan,)},
               envs.DissectionEnv: {
                   "rows_to_cut": (0, 9, 1.5), "thickness": (0,), "connective_thickness": (-1,),
                   "cutting_radius": (0,), "retraction_force": (math.nan,),
                   "action_type": ("hop",), "maximum_state_velocity": ((1, 2, 3), 1),
                   "discrete_action_magnitude": ((1, 2, 3, "x"),), "activation_deadzone": (-1,),
                   "num_tracking_points_tissue": (-1,), "settle_steps": (-1,),
                   "num_tracking_points_connective_tissue": (0.5,)}}

    def test_wrong_ones_are_named(self) -> None:
        for kind, own in self.of_kind.items():
            for name, values in {**self.common, **own}.items():
                for value in values:
                    with self.subTest(kind=kind.__name__, name=name, value=value):
                        with self.assertRaises(ValueError) as caught:
                            kind(**{name: value})
                        self.assertRegex(str(caught.exception), f"^{name} is .*: it must be")
                        self.assertIn(str(value), str(caught.exception))
        with self.assertRaisesRegex(ValueError, "multiple of 10"):
            envs.DissectionEnv(cells=(4, 7, 1))
        with self.assertRaisesRegex(ValueError, "cut_tissue.*is 'much'"):
            envs.DissectionEnv(reward_amounts={"cut_tissue": "much"})

    def test_numbers_of_numpy_are_accepted(self) -> None:
        env = envs.PathIncisionEnv(cells=np.array([4, 1, 2]), young=np.float32(1e3),
                                   image_shape=[20, 30], max_episode_steps=1e3)
        self.assertEqual((env.cells, env.image_shape, env.max_episode_steps),
                         ((4, 1, 2), (20, 30), 1000))
        env.reset(seed=0)
        self.assertEqual(env.picture().shape, (20, 30, 3))

    def test_shapes_of_pictures(self) -> None:
        env = envs.PathIncisionEnv()
        env.reset(seed=0)
        for shape in ((0, 5), (), 96, (5, 5, 3), "ab"):
            with self.subTest(shape=shape), self.assertRaisesRegex(
                    ValueError, "shape is .*: it must be 2 whole numbers"):
                env.picture(shape)
        self.assertEqual(env.picture((5, 7)).shape, (5, 7, 3))

    def test_stiffness_of_an_episode(self) -> None:
        with self.assertRaisesRegex(ValueError, "stiffness is 'soft': it must be a number"):
            envs.PathIncisionEnv().reset(options={"stiffness": "soft"})


class FailingWorld:
    """A world of which a step raises an error, or leaves a short stable step."""

    def __init__(self, world: incise.World, error: Optional[Exception] = None,
                 stable_step: Optional[float] = None) -> None:
        self._world, self._error, self._stable_step = world, error, stable_step

    def run_until(self, time: float) -> incise.StepReport:
        if self._error is not None:
            raise self._error
        return self._world.run_until(time)

    @property
    def stable_step(self) -> float:
        return self._world.stable_step if self._stable_step is None else self._stable_step

    def __getattr__(self, name: str) -> Any:
        return getattr(self._world, name)


class Failures(unittest.TestCase):
    def check_end(self, env: Any, text: str) -> None:
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        self.assertIn(observation, env.observation_space)
        self.assertLess(reward, 0.0)
        self.assertEqual((terminated, truncated), (True, False))
        self.assertTrue(info["is_unstable"])
        self.assertFalse(info["success"])
        self.assertIn(text, info["error"])
        with self.assertRaises(envs.ResetNeeded):
            env.step(env.action_space.sample())

    def test_errors_of_a_step_end_the_episode(self) -> None:
        for kind in ALL:
            for error in (incise.InputError("tool 'blade' meets a hexahedron"),
                          incise.PhysicsError("the motion is lost")):
                with self.subTest(kind=kind.__name__, error=error):
                    env = kind()
                    info = env.reset(seed=0)[1]
                    self.assertEqual((info["error"], info["is_unstable"]), ("", False))
                    ready, sound = env._ready, env._ready.world
                    ready.world = FailingWorld(sound, error=error)
                    self.check_end(env, str(error))
                    ready.world = sound
                    self.assertTrue(same(env.reset(seed=0), kind().reset(seed=0)))
                    env.step(env.action_space.sample())

    def test_short_steps_end_the_episode(self) -> None:
        for kind in ALL:
            with self.subTest(kind=kind.__name__):
                env = kind()
                env.reset(seed=0)
                env._ready.world = FailingWorld(env._ready.world, stable_step=2e-5)
                self.assertEqual(env.step(env.action_space.sample())[4]["error"], "")
                env._ready.world = FailingWorld(env._ready.world, stable_step=0.9e-5)
                self.check_end(env, "strained")

    def test_short_steps_at_rest_are_allowed(self) -> None:
        env = envs.PathIncisionEnv(cells=(2, 1, 2), young=1e8, time_step=0.05)
        env.reset(seed=0)
        self.assertLess(env.world.stable_step, 1e-3 * env.time_step)
        self.assertFalse(env.step(np.zeros(3, np.float32))[4]["is_unstable"])

    def test_other_errors_are_not_hidden(self) -> None:
        env = envs.PathIncisionEnv()
        env.reset(seed=0)
        env._ready.world = FailingWorld(env._ready.world, error=incise.Error("another thread"))
        with self.assertRaises(incise.Error):
            env.step(env.action_space.sample())

    def test_a_force_that_crushes_the_flap_is_refused(self) -> None:
        env = envs.DissectionEnv(retraction_force=3.0, cells=(2, 10, 1))
        with self.assertRaisesRegex(ValueError, "strained"):
            env.reset(seed=0)
        with self.assertRaises(envs.ResetNeeded):
            env.step(env.action_space.sample())


class Starts(unittest.TestCase):
    def test_far_ones_are_refused(self) -> None:
        for kind in (envs.PathIncisionEnv, envs.WedgeResectionEnv):
            env = kind()
            for options in ({"start": [9.0, 0.03, 0.004, 0.0]}, {"start": [0.04, -9.0, 0.004, 0.0]},
                            {"start": [0.04, 0.03, 9.0, 0.0]}, {"line": [[5.0, 0.0], [6.0, 0.0]]}):
                with self.subTest(kind=kind.__name__, options=options):
                    with self.assertRaisesRegex(ValueError, "beyond"):
                        env.reset(options=options)

    def test_all_others_are_in_the_space(self) -> None:
        for kind in (envs.PathIncisionEnv, envs.WedgeResectionEnv):
            env = kind()
            for corner in (env._low, env._high):
                observation, _ = env.reset(options={"start": [*corner, 1.0]})
                self.assertIn(observation, env.observation_space)
            observation, _ = env.reset(options={"line": [env._low[:2], env._high[:2]]})
            self.assertIn(observation, env.observation_space)
            self.assertTrue(all(low <= x <= high for low, x, high
                                in zip(env._low, env._tip, env._high)))
        thin = envs.PathIncisionEnv(size=(0.08, 0.06, 0.0005), depth=0.0003)
        self.assertIn(thin.reset(seed=0)[0], thin.observation_space)

    def test_options_change_no_later_random_numbers(self) -> None:
        given = {envs.PathIncisionEnv: {"line": [[0.01, 0.03], [0.07, 0.03]],
                                        "start": [0.0, 0.03, 0.012, 0.0]},
                 envs.WedgeResectionEnv: {"start": [0.04, -0.003, 0.0, 1.5]},
                 envs.DissectionEnv: {"state": [0.0, 0.0, 0.0, 5.0]}}
        for kind in ALL:
            env = kind()
            env.reset(seed=4)
            second = env.reset()
            for options in ({"randomize": False}, {"stiffness": 2e3}, given[kind]):
                with self.subTest(kind=kind.__name__, options=options):
                    env.reset(seed=4, options=options)
                    self.assertTrue(same(env.reset(), second))


class Violations(unittest.TestCase):
    def test_all_parts_of_a_step_count(self) -> None:
        env = envs.DissectionEnv(frame_skip=2)
        still = [0.0] * 5
        # Out at the first part, and in again at the second.
        for violation, parts in (("state_limits_violation", ([0.0, 0.0, 0.0, -1.0, 0.0], still)),
                                 ("workspace_violation", ([0.0, 0.0, 0.0, 1.0, 0.0], still))):
            with self.subTest(violation=violation):
                env.reset(seed=0, options={"state": (0.0, 0.0, 0.0, 0.1)})
                if violation == "workspace_violation":
                    while not env._flags[0]:
                        env._move(parts[0])
                for part in parts:
                    env._move(part)
                env._judge()
                self.assertEqual(env._features[violation], 1.0)
                env._move(still)
                env._judge()
                self.assertEqual(env._features[violation], 0.0)

    def test_a_touch_of_the_board_within_a_step_counts(self) -> None:
        env = envs.DissectionEnv(frame_skip=2)
        env.reset(seed=0, options={"state": (0.0, 0.0, 0.0, 2.0)})
        down, up = [0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, -1.0, 0.0]
        while env._tip()[2] >= 0.0:
            env._move(down)
        env._judge()
        env._move(up)
        env._judge()
        self.assertEqual(env._features["collision_with_board"], 0.0)
        env._move(down)
        env._move(up)
        env._judge()
        self.assertEqual(env._features["collision_with_board"], 1.0)


class Package(unittest.TestCase):
    def run_code(self, code: str) -> str:
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def test_the_environments_come_with_the_package(self) -> None:
        self.assertEqual(self.run_code(
            "import incise, sys\n"
            "assert 'envs' in dir(incise) and 'World' in dir(incise)\n"
            "assert 'incise.envs' not in sys.modules\n"
            "print(incise.envs.DissectionEnv.__name__, incise.envs is sys.modules['incise.envs'])"),
            "DissectionEnv True")
        self.assertEqual(self.run_code("from incise import envs; print(envs.__name__)"),
                         "incise.envs")

    def test_other_names_are_unknown(self) -> None:
        with self.assertRaisesRegex(AttributeError, "module 'incise' has no attribute 'env'"):
            incise.env  # type: ignore[attr-defined]


class Checker(unittest.TestCase):
    def refuses(self, kind: Any, text: str) -> None:
        with self.subTest(kind=kind.__name__), self.assertRaisesRegex(AssertionError, text):
            envs.check_env(kind, seeds=[0], num_steps=4)

    def test_says_what_it_needs(self) -> None:
        for make in (envs.PathIncisionEnv(), lambda: 3, lambda: envs.PathIncisionEnv()):
            with self.subTest(make=make), self.assertRaisesRegex(
                    ValueError, "make is .*: it must .*render_mode"):
                envs.check_env(make)
        with self.assertRaisesRegex(AssertionError, "returns 3, which is no Env"):
            envs.check_env(lambda render_mode=None: 3)

    def test_finds_steps_that_do_not_ask_for_a_reset(self) -> None:
        class Early(envs.PathIncisionEnv):
            def step(self, action: Any) -> Any:
                if self._ready is None:
                    raise AttributeError("no world")
                return super().step(action)

        class Late(envs.PathIncisionEnv):
            def reset(self, *, seed: Any = None, options: Any = None) -> Any:
                if options:
                    raise ValueError("no options")
                return super().reset(seed=seed)

        self.refuses(Early, "AttributeError")
        self.refuses(Late, "after a reset")

    def test_finds_traces_of_refused_actions(self) -> None:
        class Counting(envs.PathIncisionEnv):
            def step(self, action: Any) -> Any:
                self._num_steps += isinstance(action, str)
                return super().step(action)

        self.refuses(Counting, "refused")

    def test_finds_spaces_that_are_not_equal(self) -> None:
        class Odd(envs.Box):  # type: ignore[misc]
            __eq__ = object.__eq__
            __hash__ = object.__hash__

        class Unequal(envs.PathIncisionEnv):
            def __init__(self, **arguments: Any) -> None:
                super().__init__(**arguments)
                self.action_space = Odd(-1.0, 1.0, (3,), np.float32)

        self.refuses(Unequal, "not equal to its copy")


if __name__ == "__main__":
    unittest.main()
