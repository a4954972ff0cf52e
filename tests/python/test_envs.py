"""The environments: Gymnasium's contract, the same bits, tasks that can be done, metrics."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import functools
import hashlib
import importlib.util
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from typing import Any

import numpy as np

import incise
from incise import envs
from incise import _renderer as renderer
from incise.envs import dissection, line
from incise.envs.check import roll, same

SOURCES = pathlib.Path(os.environ.get("INCISE_SOURCE_DIR",
                                      pathlib.Path(__file__).resolve().parents[2]))
ALL = (envs.DissectionEnv, envs.PathIncisionEnv, envs.WedgeResectionEnv)
METRICS = ("area_cut", "mean_distance", "max_distance", "tissue_lost", "largest_force", "success")


def fingerprint(said: list[Any]) -> str:
    """Return a text that tells all bits of what an environment has said."""
    digest = hashlib.sha256()
    for result in said:
        for part in result:
            digest.update(part.tobytes() if isinstance(part, np.ndarray) else
                          repr(part).encode())
    return digest.hexdigest()


def follow(env: Any, observation: Any) -> np.ndarray:
    """Return the action that leads a blade along the line of an environment."""
    first = 12 if isinstance(env, envs.PathIncisionEnv) else 11
    angle = math.atan2(observation[first + 1], observation[first])
    action = np.zeros(env.action_space.shape, np.float32)
    action[0] = 1 if abs(angle) < 0.4 else -1
    action[1] = np.clip(6 * angle, -1, 1)
    if len(action) == 3:
        action[2] = np.clip(6 * (observation[3] - 1), -1, 1)
    return action


def play(env: Any, seed: int, policy: Any = follow, **options: Any) -> tuple[float, dict]:
    """Return return and last info of an episode."""
    observation, info = env.reset(seed=seed, options=options)
    total, is_over = 0.0, False
    while not is_over:
        observation, reward, terminated, truncated, info = env.step(policy(env, observation))
        total += reward
        is_over = terminated or truncated
    return total, info


class Contract(unittest.TestCase):
    def test_all_keep_it(self) -> None:
        for kind in ALL:
            with self.subTest(kind=kind.__name__):
                envs.check_env(kind, seeds=range(20), num_steps=40)

    def test_pictures_keep_it(self) -> None:
        for kind in ALL:
            with self.subTest(kind=kind.__name__):
                envs.check_env(functools.partial(kind, observation_type="rgb",
                                                 image_shape=(64, 80)), seeds=[1], num_steps=10)

    def test_options_of_constructors_keep_it(self) -> None:
        for make in (functools.partial(envs.DissectionEnv, action_type="discrete"),
                     functools.partial(envs.DissectionEnv, control_retraction_force=True,
                                       with_shaft=False, frame_skip=2),
                     functools.partial(envs.PathIncisionEnv, cells=(4, 2, 2), frame_skip=2),
                     functools.partial(envs.WedgeResectionEnv, curvature=0.0, young=1e3)):
            with self.subTest(make=make):
                envs.check_env(make, seeds=[0, 1], num_steps=20)

    def test_the_checker_finds_faults(self) -> None:
        class Loose(envs.PathIncisionEnv):
            def step(self, action: Any) -> Any:
                observation, reward, terminated, truncated, info = super().step(action)
                return observation, np.float32(reward), terminated, truncated, info

        class Other(envs.PathIncisionEnv):
            def reset(self, *, seed: Any = None, options: Any = None) -> Any:
                return super().reset(seed=None, options=options)

        for kind in (Loose, Other):
            with self.subTest(kind=kind.__name__), self.assertRaises(AssertionError):
                envs.check_env(kind, seeds=[0], num_steps=5)

    def test_step_after_the_end_raises(self) -> None:
        env = envs.PathIncisionEnv(max_episode_steps=2)
        env.reset(seed=0)
        action = np.zeros(3, np.float32)
        self.assertEqual(env.step(action)[2:4], (False, False))
        self.assertEqual(env.step(action)[2:4], (False, True))
        with self.assertRaises(envs.ResetNeeded):
            env.step(action)

    def test_wrong_values_are_refused(self) -> None:
        env = envs.PathIncisionEnv()
        for options in ({"colour": 1}, {"stiffness": -1}, {"line": [[0, 0]]}, {"depth": 1.0},
                        {"start": [0, 0]}):
            with self.subTest(options=options), self.assertRaises(ValueError):
                env.reset(options=options)
        env.reset(seed=0)
        for action in ([0.0], [0.0, 0.0, math.nan]):
            with self.subTest(action=action), self.assertRaises(ValueError):
                env.step(action)
        for kind, arguments in ((envs.PathIncisionEnv, {"depth": 1.0}),
                                (envs.PathIncisionEnv, {"observation_type": "smell"}),
                                (envs.WedgeResectionEnv, {"width": 1.0}),
                                (envs.DissectionEnv, {"cells": (4, 7, 1)}),
                                (envs.DissectionEnv, {"reward_amounts": {"luck": 1.0}})):
            with self.subTest(arguments=arguments), self.assertRaises(ValueError):
                kind(**arguments)

    def test_with_a_module_named_gymnasium(self) -> None:
        # A stand-in with gymnasium's names; the real one is tested where it is installed.
        code = """
import sys, types
stub = types.ModuleType("gymnasium")
class Env:
    metadata, render_mode, spec, _np_random = {}, None, None, None
    def reset(self, *, seed=None, options=None):
        if seed is not None:
            import numpy as np
            self._np_random = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))
    @property
    def np_random(self): return self._np_random
    @property
    def unwrapped(self): return self
    def __enter__(self): return self
    def __exit__(self, *a): self.close()
class Space: pass
stub.Env, stub.registry = Env, {}
stub.register = lambda id, entry_point: stub.registry.setdefault(id, entry_point)
stub.error = types.SimpleNamespace(ResetNeeded=type("ResetNeeded", (Exception,), {}))
import importlib.util, pathlib
stub.spaces = types.SimpleNamespace(Space=Space, Box=lambda *a, **k: Space(),
                                    Discrete=lambda *a: Space(), Dict=Space)
sys.modules["gymnasium"] = stub
from incise import envs
assert envs.HAS_GYMNASIUM and issubclass(envs.PathIncisionEnv, Env)
assert sorted(stub.registry) == sorted(envs.IDS), stub.registry
Space.shape = (3,)
env = envs.PathIncisionEnv()
first = env.reset(seed=5)[0]
print(first.tobytes().hex())
"""
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        if not envs.HAS_GYMNASIUM:
            self.assertEqual(run.stdout.strip(),
                             envs.PathIncisionEnv().reset(seed=5)[0].tobytes().hex())

    @unittest.skipUnless(envs.HAS_GYMNASIUM, "gymnasium is not installed")
    def test_gymnasiums_own_checker(self) -> None:
        import gymnasium
        from gymnasium.utils.env_checker import check_env
        for name in envs.IDS:
            with self.subTest(name=name):
                check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped)


class Spaces(unittest.TestCase):
    def test_boxes(self) -> None:
        box = envs.Box(-1.0, 1.0, (3,), np.float32)
        self.assertEqual((box.shape, box.dtype), ((3,), np.dtype(np.float32)))
        self.assertIn(np.zeros(3, np.float32), box)
        self.assertNotIn(np.full(3, 1.5, np.float32), box)
        self.assertNotIn(np.zeros(4, np.float32), box)
        self.assertNotIn(np.zeros(3), box)
        self.assertEqual(box, envs.Box(-1.0, 1.0, (3,), np.float32))
        self.assertNotEqual(box, envs.Box(-1.0, 2.0, (3,), np.float32))
        pixels = envs.Box(0, 255, (50, 50, 3), np.uint8)
        sample = pixels.sample()
        self.assertIn(sample, pixels)
        self.assertEqual((int(sample.min()), int(sample.max())), (0, 255))
        self.assertIn(envs.Box(-np.inf, np.inf, (4,), np.float32).sample(),
                      envs.Box(-np.inf, np.inf, (4,), np.float32))

    def test_numbers_and_dicts(self) -> None:
        numbers = envs.Discrete(3)
        self.assertEqual({int(numbers.sample()) for _ in range(50)}, {0, 1, 2})
        self.assertNotIn(3, numbers)
        self.assertNotIn(1.0, numbers)
        both = envs.Dict(number=numbers, box=envs.Box(0.0, 1.0, (2,)))
        both.seed(4)
        first = both.sample()
        both.seed(4)
        self.assertTrue(same(first, both.sample()))
        self.assertIn(first, both)
        self.assertNotIn({"number": 1}, both)


class SameBits(unittest.TestCase):
    def test_in_a_fresh_process(self) -> None:
        code = ("import sys; sys.path.insert(0, sys.argv[1])\n"
                "import test_envs\n"
                "for kind in test_envs.ALL:\n"
                "    print(test_envs.fingerprint(test_envs.roll(kind(), 7, 60)))\n")
        run = subprocess.run([sys.executable, "-c", code, str(pathlib.Path(__file__).parent)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout.split(), [fingerprint(roll(kind(), 7, 60)) for kind in ALL])

    def test_after_other_episodes_with_cuts(self) -> None:
        for kind in (envs.PathIncisionEnv, envs.WedgeResectionEnv):
            with self.subTest(kind=kind.__name__):
                env = kind()
                first = play(env, 3)
                for seed in (1, 2):
                    play(env, seed)
                again = play(env, 3)
                self.assertTrue(same(first, again))
                self.assertTrue(same(first, play(kind(), 3)))

    def test_for_any_number_of_threads(self) -> None:
        self.assertTrue(same(play(envs.PathIncisionEnv(), 2),
                             play(envs.PathIncisionEnv(num_threads=2), 2)))


class Tasks(unittest.TestCase):
    def test_a_blade_that_follows_the_line_succeeds(self) -> None:
        for kind in (envs.PathIncisionEnv, envs.WedgeResectionEnv):
            env = kind()
            for seed in range(4):
                with self.subTest(kind=kind.__name__, seed=seed):
                    total, info = play(env, seed)
                    self.assertTrue(info["success"], info)
                    self.assertGreater(total, 10.0)
                    self.assertLess(info["mean_distance"], 1e-3)
                    self.assertLess(info["tissue_lost"], 0.05)
                    self.assertGreater(info["area_cut"], 1e-4)
                    self.assertGreater(info["largest_force"], 0.01)

    def test_a_parallel_cut_is_as_far_from_the_line(self) -> None:
        # The agent is led along another line than the one that is judged.
        env = envs.PathIncisionEnv(cells=(16, 12, 3))
        straight = [[0.012, 0.03], [0.068, 0.03]]
        env.reset(seed=0, options={"line": straight, "start": [0.008, 0.034, 0.004, 0.0],
                                   "randomize": False})
        for _ in range(60):
            info = env.step(np.array([1.0, 0.0, 0.0], np.float32))[4]
        self.assertAlmostEqual(info["mean_distance"], 0.004, delta=5e-4)
        self.assertFalse(info["success"])

    def test_area_of_a_straight_cut(self) -> None:
        env = envs.WedgeResectionEnv()
        env.reset(seed=0, options={"randomize": False,
                                   "start": [0.041, -0.003, 0.0, 0.5 * math.pi]})
        for _ in range(40):
            info = env.step(np.array([1.0, 0.0], np.float32))[4]
        # To half an element of the uncut mesh behind the blade, which is at y = 37 mm.
        self.assertAlmostEqual(info["area_cut"], 0.01 * 0.035, delta=0.01 * 0.012)
        self.assertEqual(info["tissue_lost"], 0.0)

    def test_a_lost_corner_is_counted(self) -> None:
        env = envs.WedgeResectionEnv(curvature=0.0)
        env.reset(seed=0, options={"randomize": False, "start": [0.005, -0.004, 0.0, 2.0]})
        for _ in range(40):
            _, _, terminated, _, info = env.step(np.array([1.0, 0.0], np.float32))
            if terminated:
                break
        self.assertGreater(info["tissue_lost"], 0.0)
        self.assertEqual(info["wedge_removed"], 0.0)

    def test_dissection_with_a_scripted_cauter(self) -> None:
        env = envs.DissectionEnv(maximum_state_velocity=(80.0, 80.0, 120.0, 80.0))
        _, info = play(env, 1, aim)
        self.assertTrue(info["success"], info)
        self.assertAlmostEqual(info["area_cut"], 0.06 * 0.02)
        self.assertLess(info["tissue_lost"], 0.2)
        self.assertEqual(info["ratio_cut_connective_tissue"], 1.0)

    def test_discrete_actions_move_as_they_say(self) -> None:
        env = envs.DissectionEnv(action_type="discrete")
        before = env.reset(seed=0)[0][:5]
        for action, row, change in ((0, 0, 0.15), (1, 0, -0.15), (2, 1, 0.15), (5, 2, -0.15),
                                    (6, 3, 0.1), (8, 4, 1.0), (10, 0, 0.0), (9, 4, -1.0)):
            after = env.step(action)[0][:5]
            expected = before.copy()
            expected[row] += change
            np.testing.assert_allclose(after, expected, atol=1e-5)
            before = after

    def test_a_passive_cauter_cuts_nothing(self) -> None:
        env = envs.DissectionEnv()
        _, info = play(env, 1, lambda e, o: aim(e, o) * np.array([1, 1, 1, 1, 0], np.float32)
                       if e._num_steps < 400 else np.zeros(5, np.float32))
        self.assertEqual((info["area_cut"], info["tissue_lost"]), (0.0, 0.0))

    def test_stiffness_is_drawn_and_can_be_given(self) -> None:
        env = envs.PathIncisionEnv()
        drawn = {env.reset(seed=seed)[1]["stiffness"] for seed in range(20)}
        self.assertEqual(len(drawn), 3)
        self.assertEqual(env.reset(options={"stiffness": 3e3})[1]["stiffness"], 3e3)


def aim(env: Any, _: Any) -> np.ndarray:
    """Return the action that leads the cauter to the connective tissue, row by row."""
    world = env.world
    cells = world.cells[world.regions == dissection.CONNECTIVE]
    middle = 1e3 * world.positions[cells].mean(axis=1)
    goal = middle[np.lexsort((middle[:, 0], -np.round(middle[:, 1] / 5)))[0]]

    def tip(state: Any) -> np.ndarray:
        position, _, rotation = dissection.pose_of(tuple(state))
        return 1e3 * (np.array(position) + dissection.TIP_LENGTH * np.array(rotation)[:, 2])

    state = np.array(env._state_now)
    here = tip(state)
    slopes = np.stack([tip(state + step) - here for step in 1e-3 * np.eye(4)[[0, 1, 3]]], 1) / 1e-3
    way = np.linalg.lstsq(slopes, goal - here, rcond=1e-3)[0] / np.array(env._velocity)[[0, 1, 3]]
    way /= max(1.0, np.abs(way).max())
    is_near = np.linalg.norm(goal - here) < 14
    return np.array([way[0], way[1], 0.0, way[2], 1.0 if is_near else -1.0], np.float32)


class Parts(unittest.TestCase):
    def test_poses_of_the_instrument_are_rigid(self) -> None:
        random = np.random.default_rng(0)
        for _ in range(50):
            state = random.uniform([-90, -90, -90, 0], [90, 90, 90, 300])
            position, quaternion, rotation = dissection.pose_of(tuple(state))
            matrix = np.array(rotation)
            np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
            pose = incise.Pose(position, quaternion)
            np.testing.assert_allclose(pose.to_world(np.eye(3)) - position, matrix.T, atol=1e-12)

    def test_distances_and_polygons(self) -> None:
        points = np.array([[0.5, 1.0], [-3.0, 4.0], [2.0, 0.5]])
        bend = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])
        np.testing.assert_allclose(line.distances(points, bend), [0.5, math.sqrt(20.0), 1.0])
        square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        inside = line.is_inside(np.array([[0.5, 0.5], [1.5, 0.5], [0.1, 0.9]]), square)
        self.assertEqual(inside.tolist(), [True, False, True])

    def test_the_nearer_triangle_hides_the_other(self) -> None:
        camera = renderer.Camera([0.0, -5.0, 0.0], [0.0, 0.0, 0.0], (32, 32))
        big = np.array([[-9.0, 0, -9], [9, 0, -9], [0, 0, 12]])
        points = np.concatenate([big + [0, 1, 0], big])
        for order in ([0, 1], [1, 0]):
            triangles = np.array([[0, 1, 2], [3, 4, 5]])[order]
            colors = np.array([[200.0, 0, 0], [0, 200.0, 0]])[order]
            picture = renderer.draw(camera, points, triangles, colors)
            self.assertEqual(int(picture[16, 16, 0]), 0)
            self.assertGreater(int(picture[16, 16, 1]), 0)

    def test_triangles_cover_their_pixels_once(self) -> None:
        random = np.random.default_rng(1)
        for shape in ((20, 30), (200, 170)):
            # A square of many triangles, some of it outside the picture.
            side = np.linspace(-0.1, 1.3, 9)
            grid = np.stack(np.meshgrid(side * shape[1], side * shape[0]), axis=-1)
            grid[1:-1, 1:-1] += random.uniform(-0.05, 0.05, (7, 7, 2)) * shape[::-1]
            points = np.dstack([grid, 1.0 + 0.01 * grid[..., 0] + 0.02 * grid[..., 1]])
            a, b, c, d = (p.reshape(-1, 3) for p in (points[:-1, :-1], points[:-1, 1:],
                                                     points[1:, 1:], points[1:, :-1]))
            corners = np.concatenate([np.stack([a, b, c], 1), np.stack([a, d, c], 1)])
            parts = list(renderer.pixels(corners, shape))
            pixel = np.concatenate([part[1] for part in parts])
            self.assertEqual(sorted(pixel.tolist()), list(range(shape[0] * shape[1])))
            row, column = np.divmod(pixel, shape[1])
            np.testing.assert_allclose(np.concatenate([part[2] for part in parts]),
                                       1.0 + 0.01 * (column + 0.5) + 0.02 * (row + 0.5))

    def test_lines_have_their_width_and_are_hidden(self) -> None:
        wall = np.array([[-9.0, 0, -9], [9, 0, -9], [0, 0, 12]])
        for y, is_seen in ((-0.5, True), (0.01, True), (0.5, False)):
            for size in (32, 300):
                camera = renderer.Camera([0.0, -5.0, 0.0], [0.0, 0.0, 0.0], (size, size))
                segment = np.array([[[-1.0, y, 0.0], [1.0, y, 0.0]]])
                picture = renderer.draw(camera, wall, np.array([[0, 1, 2]]), np.full((1, 3), 200.0),
                                        [(segment, 0.1, (9, 0, 0))])
                width = np.count_nonzero((picture == (9, 0, 0)).all(axis=2), axis=0)
                expected = max(2.0, 0.1 * camera.focal_length / (5 + y)) if is_seen else 0
                self.assertAlmostEqual(width[size // 2], expected, delta=1.01 if is_seen else 0)

    def test_pictures_show_the_cut(self) -> None:
        env = envs.PathIncisionEnv(render_mode="rgb_array")
        env.reset(seed=0)
        before = env.render()
        play(env, 0)
        after = env.render()
        self.assertEqual(before.shape, (96, 96, 3))
        self.assertGreater(np.count_nonzero(before != after), 50)

    def test_a_cut_looks_alike_at_all_sizes(self) -> None:
        # The blade is moved away, so that it hides nothing.
        for kind, span in ((envs.PathIncisionEnv, (0.08, 0.85)),
                           (envs.WedgeResectionEnv, (0.15, 0.35))):
            env = kind()
            play(env, 0)
            env._tip = [-0.03, 0.0, 0.0]
            marked = line.resampled(env._line, 200)[int(200 * span[0]):int(200 * span[1])]
            shares = []
            for shape in ((64, 64), (96, 96), (480, 480), (480, 640), (800, 1000)):
                with self.subTest(kind=kind.__name__, shape=shape):
                    picture = env.picture(shape).astype(int)
                    is_red = (picture[..., 0] > 140) & (picture[..., 1:] < 60).all(axis=2)
                    at = env._camera(shape).project(
                        np.column_stack([marked, np.full(len(marked), env.size[2])]))
                    column, row = at[:, 0].astype(int), at[:, 1].astype(int)
                    self.assertGreater(np.mean(is_red[row, column]), 0.9)
                    # The share of the picture, were it as wide as it is high.
                    shares.append(np.count_nonzero(is_red) / shape[0] ** 2)
            self.assertLess(max(shares), 2.0 * min(shares), shares)


class Guide(unittest.TestCase):
    def test_its_examples_run(self) -> None:
        text = (SOURCES / "docs" / "robot-learning.md").read_text(encoding="utf-8")
        examples = [example for example in re.findall(r"```python\n(.*?)```", text, re.S)
                    if "gymnasium" not in example]
        self.assertGreaterEqual(len(examples), 3)
        said: list[str] = []
        names: dict[str, Any] = {"print": lambda *values: said.append(" ".join(map(str, values)))}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for example in examples:
                    exec(example, names)  # noqa: S102 - the page of this repository
                self.assertEqual(pathlib.Path("cut.ppm").stat().st_size, 15 + 480 * 640 * 3)
            finally:
                os.chdir(before)
        # The page says what the first one prints.
        self.assertRegex(said[0], "^return [0-9.]+, success True$")
        self.assertIn(f"It prints `{said[0]}`", text)


class Learning(unittest.TestCase):
    def test_the_return_rises(self) -> None:
        path = SOURCES / "examples" / "train_cut.py"
        spec = importlib.util.spec_from_file_location("train_cut", path)
        assert spec and spec.loader
        example = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(example)
        lines: list[str] = []
        history = example.train(generations=6, report=lines.append)["history"]
        self.assertGreater(history[-1, 1], history[0, 1] + 5.0, "\n".join(lines))
        self.assertGreater(history[-1, 3], history[0, 3] + 5.0, "\n".join(lines))


if __name__ == "__main__":
    unittest.main()
