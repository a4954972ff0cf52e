"""Episodes of the environments: what is refused, what fails, and what is drawn."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import math
import unittest
from typing import Any

import numpy as np

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


class Checker(unittest.TestCase):
    def refuses(self, kind: Any, text: str) -> None:
        with self.subTest(kind=kind.__name__), self.assertRaisesRegex(AssertionError, text):
            envs.check_env(kind, seeds=[0], num_steps=4)

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
