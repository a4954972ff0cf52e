"""Tools that a program leads, grasps and sutures."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import unittest

import numpy as np

import incise
import support

JAWS = {"kind": "grasper", "shape": {"sphere": {"radius": 0.015}}}
PROBE = {"kind": "probe", "shape": {"sphere": {"radius": 0.01}}}


class Poses(unittest.TestCase):
    def test_rotation_is_made_of_length_one(self) -> None:
        pose = incise.Pose([1, 2, 3], [0, 0, 0, 2])
        np.testing.assert_array_equal(pose.rotation, [0, 0, 0, 1])
        np.testing.assert_array_equal(pose.position, [1, 2, 3])
        self.assertEqual(pose, incise.Pose(np.array([1.0, 2.0, 3.0])))
        self.assertNotEqual(pose, incise.Pose())
        self.assertNotEqual(pose, 3)

    def test_turned_turns_about_the_axis(self) -> None:
        pose = incise.Pose.turned([0, 0, 1], [0, 0, 5], np.pi / 2)
        np.testing.assert_allclose(pose.to_world([[1, 0, 0]]), [[0, 1, 1]], atol=1e-15)


class Tools(unittest.TestCase):
    def test_blade_parts_the_block(self) -> None:
        body = support.world()
        support.cut_through(body)
        self.assertEqual(body.ledger()["components"], 2)
        self.assertFalse(body.tools["knife_0"].is_present)

    def test_refused_step_moves_no_tool(self) -> None:
        body = incise.World(
            mesh={"box": {"size": [0.1, 0.1, 0.1], "cells": [2, 2, 2]}},
            materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}],
            tools=[{"kind": "blade", "edge": [[0, -1, 0], [0, 1, 0]],
                    "path": [{"time": 0.2, "at": [0.03, 0, 0.2]},
                             {"time": 0.8, "at": [0.03, 0, -0.1]}]}])
        before = body.save()
        with self.assertRaises(incise.InputError):
            body.step(dt=10.0)
        self.assertEqual(body.save(), before)
        self.assertEqual(body.step().edits, [])

    def test_force_is_the_mean_of_the_call(self) -> None:
        """Many calls of one step feel the impulse of one call of many steps."""
        one, many = support.world(), support.world()
        dt = 0.5 * one.stable_step
        n = 200
        top = one.positions[:, 2].max()
        start, end = incise.Pose([0.05, 0.01, top + 0.0101]), incise.Pose([0.05, 0.01, top + 0.007])
        balls = [body.add_tool("ball", PROBE, start) for body in (one, many)]
        balls[0].pose = end
        report = one.step(dt, n=n)
        impulse = np.zeros(3)
        for i in range(n):
            part = (i + 1) / n
            balls[1].pose = incise.Pose((1 - part) * start.position + part * end.position)
            impulse += dt * many.step(dt).tool_forces["ball"]
        self.assertGreater(balls[0].force[2], 0.0)
        np.testing.assert_array_equal(balls[0].force, report.tool_forces["ball"])
        np.testing.assert_allclose(balls[0].force, impulse / (n * dt), rtol=1e-6, atol=1e-9)
        self.assertEqual(one.ledger()["force_ball_z"], balls[0].force[2])

    def test_tool_goes_evenly_during_a_call(self) -> None:
        """One call of many steps cuts as many calls of one step each."""
        one, many = support.world(), support.world()
        dt = 0.5 * one.stable_step / 4
        for body in (one, many):
            body.add_tool("knife", support.BLADE, incise.Pose([0.07, 0, 0.05]))
        one.tools["knife"].pose = incise.Pose([0.07, 0, 0.01])
        one.step(dt, n=64)
        for i in range(64):
            many.tools["knife"].pose = incise.Pose([0.07, 0, 0.05 - 0.04 * (i + 1) / 64])
            many.step(dt)
        self.assertTrue(one.edits())
        self.assertEqual(len(one.edits()), len(many.edits()))
        np.testing.assert_allclose(one.positions, many.positions, atol=1e-12)

    def test_pose_reads_back(self) -> None:
        body = support.world()
        knife = body.add_tool("knife", support.BLADE)
        self.assertIsNone(knife.pose)
        self.assertFalse(knife.is_present)
        knife.pose = incise.Pose([0, 0, 1])
        self.assertEqual(knife.pose, incise.Pose([0, 0, 1]))
        body.step()
        self.assertTrue(knife.is_present)
        knife.pose = incise.Pose([0, 0, 2])
        body.run_until(body.time + 10 * body.stable_step)
        np.testing.assert_array_equal(knife.pose.position, [0, 0, 2])
        knife.place(incise.Pose([0, 0, 3]))
        np.testing.assert_array_equal(body.tools["knife"].pose.position, [0, 0, 3])

    def test_probe_feels_what_it_pushes(self) -> None:
        body = support.world()
        probe = body.add_tool("probe", PROBE, incise.Pose([0.1, 0.02, 0.055]))
        probe.pose = incise.Pose([0.1, 0.02, 0.043])
        report = body.run_until(0.05)
        self.assertGreater(probe.force[2], 0.0)
        self.assertGreater(report.tool_forces["probe"][2], 0.0)
        self.assertEqual(report.tool_torques["probe"].shape, (3,))
        self.assertGreater(report.contacts, 0)
        self.assertGreater(body.contact_forces[:, 2].min(), -10)
        self.assertLess(body.contact_forces[:, 2].sum(), 0.0)
        # The mean of the call is that of its steps, by their lengths.
        total, start = np.zeros(3), body.time
        for _ in range(20):
            step = body.step()
            total += step.tool_forces["probe"] * (step.end - step.start)
            np.testing.assert_allclose(step.tool_forces["probe"], probe.force, rtol=1e-12)
        self.assertGreater((total / (body.time - start))[2], 0.0)

    def test_grasper_holds_and_carries(self) -> None:
        body = support.world()
        jaws = body.add_tool("jaws", JAWS, incise.Pose([0.12, 0.02, 0.04]))
        self.assertEqual(jaws.held, 0)
        self.assertGreater(jaws.close(), 0)
        self.assertGreater(jaws.held, 0)
        jaws.pose = incise.Pose([0.12, 0.02, 0.05])
        body.run_until(0.1)
        self.assertLess(jaws.force[2], 0.0)
        self.assertGreater(body.positions[:, 2].max(), 0.045)
        jaws.open()
        self.assertEqual(jaws.held, 0)

    def test_scissors_part_the_block(self) -> None:
        body = support.world()
        low, high = body.positions.min(axis=0), body.positions.max(axis=0)
        size = high - low
        # They point along y, and open along z.
        turn = incise.Pose.turned([0, 0, 0], [1, -1, 1], 2 * np.pi / 3).rotation
        at = [low[0] + 0.53 * size[0], low[1] - size[1], low[2] + 0.5 * size[2]]
        scissors = body.add_tool("scissors", {"kind": "scissors", "length": 4.2 * size[1],
                                              "angle": 2.0, "closing_time": 0.01},
                                 incise.Pose(at, turn))
        self.assertEqual(scissors.kind, "scissors")
        self.assertEqual(body.run_until(0.005).edits, [])
        self.assertEqual(scissors.close(), 0)
        self.assertGreater(len(body.run_until(0.02).edits), 0)
        self.assertEqual(body.ledger()["components"], 2)
        self.assertFalse(scissors.is_in_tissue)
        scissors.open()
        self.assertEqual(body.run_until(0.04).edits, [])

    def test_suture_draws_points_together(self) -> None:
        body = support.world()
        thread = body.add_tool("thread", {"kind": "suture", "stiffness": 50.0,
                                          "points": [[0.06, 0.02, 0.04], [0.1, 0.02, 0.04]]})
        self.assertFalse(thread.is_tied)
        self.assertEqual(thread.tie(), 2)
        self.assertAlmostEqual(thread.length, 0.04)
        thread.tighten(0.038)
        body.run_until(0.02)
        self.assertAlmostEqual(thread.length, 0.038)
        self.assertGreater(np.linalg.norm(thread.force), 0.0)
        thread.untie()
        self.assertFalse(thread.is_tied)

    def test_cut_divides_in_the_next_call(self) -> None:
        body = support.world()
        plane = {"point": [0.05, 0, 0], "normal": [1, 0, 0.2]}
        cut = body.add_tool("plane", {"kind": "cut", "plane": plane})
        report = body.step(n=3)
        self.assertEqual(len(report.edits), 1)
        self.assertFalse(cut.is_present)
        self.assertEqual(body.ledger()["components"], 2)
        with self.assertRaisesRegex(incise.InputError, "has no pose"):
            cut.pose = incise.Pose()

    def test_kinds_and_names(self) -> None:
        body = incise.World(support.SCENARIOS / "beam.toml")
        blade = body.tools["blade_1"]
        self.assertEqual((blade.kind, blade.is_scripted), ("blade", True))
        with self.assertRaisesRegex(incise.InputError, "is led by the scenario"):
            blade.pose = incise.Pose()
        probe = body.add_tool("probe", PROBE)
        self.assertEqual((probe.kind, probe.is_scripted, probe.name), ("probe", False, "probe"))
        self.assertEqual(list(body.tools), ["blade_1", "probe"])
        with self.assertRaisesRegex(incise.InputError, "has a tool of this name already"):
            body.add_tool("probe", PROBE)

    def test_tool_keeps_its_world(self) -> None:
        probe = support.world().add_tool("probe", PROBE)
        self.assertFalse(probe.is_present)


class Grasps(unittest.TestCase):
    def test_grasp_carries_nodes_and_is_felt(self) -> None:
        body = support.world()
        end = np.flatnonzero(body.rest_positions[:, 0] > 0.119)
        hand = body.grasp("hand", end)
        self.assertTrue(hand.is_grasp)
        self.assertFalse(body.constraints["clamp"].is_grasp)
        pose = hand.pose
        hand.pose = incise.Pose(pose.position + [0.01, 0, 0])
        body.run_until(0.05)
        np.testing.assert_allclose(body.positions[end, 0], 0.13, atol=1e-12)
        self.assertGreater(hand.force[0], 0.0)
        self.assertLess(body.constraints["clamp"].force[0], 0.0)
        self.assertEqual(hand.torque.shape, (3,))
        hand.release()
        with self.assertRaisesRegex(incise.InputError, "no longer in its world"):
            hand.force
        body.run_until(0.1)
        self.assertLess(body.positions[end, 0].mean(), 0.13)


if __name__ == "__main__":
    unittest.main()
