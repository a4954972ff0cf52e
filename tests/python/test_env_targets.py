"""What a blade of an environment has cut, against what it was to cut."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import functools
import math
import unittest
import unittest.mock
from typing import Any

import numpy as np

from incise import envs
from incise.envs import path_incision
from incise.envs.target import Target, are_near
from test_envs import follow, play


def follow_at(share: float, env: Any, observation: Any) -> np.ndarray:
    """Return the action that leads a blade along the line at a share of the depth."""
    action = follow(env, observation)
    action[2] = np.clip(6 * (observation[3] - share), -1, 1)
    return action


class Success(unittest.TestCase):
    def play_at(self, share: float, seed: int) -> dict[str, Any]:
        return play(envs.PathIncisionEnv(), seed, functools.partial(follow_at, share))[1]

    def test_needs_the_depth(self) -> None:
        for share in (0.0, 0.5, 0.7, 0.8):
            for seed in range(3):
                with self.subTest(share=share, seed=seed):
                    info = self.play_at(share, seed)
                    self.assertFalse(info["success"], info)
                    self.assertLess(info["coverage"], 0.8)

    def test_needs_a_cut_where_the_line_is_done(self) -> None:
        for share in (0.5, 0.7):
            for seed in range(3):
                with self.subTest(share=share, seed=seed), \
                        unittest.mock.patch.object(path_incision, "LEAST_DEPTH", 0.4):
                    info = self.play_at(share, seed)
                    self.assertGreater(info["progress"], 0.9)
                    self.assertLess(info["coverage"], 0.8)
                    self.assertFalse(info["success"], info)

    def test_forbids_to_cut_too_deep(self) -> None:
        for share in (1.35, 1.5):
            for seed in range(3):
                with self.subTest(share=share, seed=seed):
                    info = self.play_at(share, seed)
                    self.assertFalse(info["success"], info)
                    self.assertGreater(info["coverage"], 0.8)
                    self.assertGreater(info["excess_depth"], 1e-3)

    def test_allows_small_errors_of_depth(self) -> None:
        for share in (0.9, 1.0, 1.1):
            for seed in range(3):
                with self.subTest(share=share, seed=seed):
                    info = self.play_at(share, seed)
                    self.assertTrue(info["success"], info)
                    self.assertGreater(info["coverage"], 0.85)
                    self.assertLess(info["excess_depth"], 1e-3)

    def test_depends_on_the_depth_that_is_asked_for(self) -> None:
        # A cut of 4.5 mm is right for 4.5 mm, too deep for 2.5 mm and too shallow for 8 mm.
        env = envs.PathIncisionEnv()
        for depth, is_right in ((0.0045, True), (0.0025, False), (0.008, False)):
            with self.subTest(depth=depth):
                policy = functools.partial(follow_at, 0.0045 / depth)
                self.assertEqual(play(env, 1, policy, depth=depth)[1]["success"], is_right)

    def test_no_cut_is_far_from_the_target(self) -> None:
        for kind in (envs.PathIncisionEnv, envs.WedgeResectionEnv):
            with self.subTest(kind=kind.__name__):
                env = kind()
                info = env.reset(seed=0)[1]
                for _ in range(3):
                    self.assertEqual((info["area_cut"], info["coverage"]), (0.0, 0.0))
                    self.assertEqual((info["mean_distance"], info["max_distance"]),
                                     (math.inf, math.inf))
                    still = -np.ones(env.action_space.shape, np.float32)
                    info = env.step(still)[4]
                self.assertFalse(info["success"])
                play(env, 0)
                self.assertEqual(env.reset(seed=0)[1]["coverage"], 0.0)

    def test_the_two_sides_of_a_wedge_are_covered(self) -> None:
        for seed in range(4):
            info = play(envs.WedgeResectionEnv(), seed)[1]
            self.assertGreater(info["coverage"], 0.75)
        # One side only: half of the line, less the elements that are cut in part behind the blade.
        env = envs.WedgeResectionEnv()
        observation, info = env.reset(seed=0)
        while env._num_done < 20:
            info = env.step(follow(env, observation))[4]
            observation = env._state()
        self.assertGreater(info["coverage"], 0.3)
        self.assertLess(info["coverage"], 0.55)


class Surfaces(unittest.TestCase):
    def test_points_near_triangles(self) -> None:
        random = np.random.default_rng(3)
        triangles = random.uniform(-1.0, 1.0, (5, 3, 3))
        points = random.uniform(-1.5, 1.5, (400, 3))
        # Points of the triangles so close together that the nearest one is near enough.
        u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 150), np.linspace(0, 1, 150)))
        u, v = u[u + v <= 1], v[u + v <= 1]
        a, b, c = triangles[:, 0, None], triangles[:, 1, None], triangles[:, 2, None]
        fine = (a + u[:, None] * (b - a) + v[:, None] * (c - a)).reshape(-1, 3)
        distance = np.array([np.linalg.norm(fine - p, axis=1).min() for p in points])
        for reach in (0.1, 0.3, 0.7):
            near = are_near(points, triangles, reach)
            clear = np.abs(distance - reach) > 0.02
            self.assertGreater(int(clear.sum()), 300)
            np.testing.assert_array_equal(near[clear], (distance <= reach)[clear])

    def test_faces_that_come_in_parts(self) -> None:
        path = np.column_stack([np.linspace(0.01, 0.07, 41), np.full(41, 0.03)])
        corners = [[0.01, 0.031, 0.002], [0.04, 0.031, 0.002], [0.04, 0.031, 0.01],
                   [0.01, 0.031, 0.01]]
        halves = np.array([[corners[i] for i in rows] for rows in ((0, 1, 2), (0, 2, 3))])
        target = Target(path, (0.08, 0.06, 0.01), 0.006, 6, 0.0015)
        self.assertEqual((target.mean_distance, target.coverage), (math.inf, 0.0))
        target.measure(halves[:0])
        self.assertEqual((target.mean_distance, target.coverage), (math.inf, 0.0))
        target.measure(halves[1:])
        target.measure(halves)
        at_once = Target(path, (0.08, 0.06, 0.01), 0.006, 6, 0.0015)
        at_once.measure(halves[::-1])
        for name in ("mean_distance", "max_distance", "excess_depth", "coverage"):
            self.assertEqual(getattr(target, name), getattr(at_once, name), name)
        self.assertAlmostEqual(target.excess_depth, 0.002)
        self.assertAlmostEqual(target.coverage, 0.5, delta=0.03)
        self.assertGreater(target.mean_distance, 0.001)
        self.assertLess(target.max_distance, 0.0015)

    def test_a_line_beyond_the_block_is_no_target_there(self) -> None:
        path = np.column_stack([np.full(21, 0.04), np.linspace(-0.01, 0.01, 21)])
        target = Target(path, (0.08, 0.06, 0.01), 0.01, 3, 0.0005)
        corners = [[0.04, 0.0, 0.0], [0.04, 0.01, 0.0], [0.04, 0.01, 0.01], [0.04, 0.0, 0.01]]
        target.measure(np.array([[corners[i] for i in rows] for rows in ((0, 1, 2), (0, 2, 3))]))
        self.assertEqual(target.coverage, 1.0)


if __name__ == "__main__":
    unittest.main()
