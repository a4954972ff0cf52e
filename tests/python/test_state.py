"""Saving and going back."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import random
import unittest

import numpy as np

import incise
import support


def led_world() -> incise.World:
    body = support.world(gravity=[0, 0, -9.81])
    body.add_tool("knife", support.BLADE, incise.Pose([0.07, 0, 0.06]))
    return body


def go_on(body: incise.World) -> None:
    """Cut and grasp in several calls."""
    knife = body.tools["knife"]
    for z in (0.03, 0.015, -0.02):
        knife.pose = incise.Pose([0.07, 0, z])
        body.run_until(body.time + 0.004)
    knife.withdraw()
    body.run_until(body.time + 0.004)


class State(unittest.TestCase):
    def test_the_same_bits_go_on(self) -> None:
        body = led_world()
        body.tools["knife"].pose = incise.Pose([0.07, 0, 0.035])
        body.run_until(0.003)
        body.tools["knife"].pose = incise.Pose([0.07, 0, 0.02])  # still to come
        state = body.save()
        self.assertIsInstance(state, bytes)
        go_on(body)
        ends = [(body.positions, body.velocities, body.edits(), body.time)]
        other = support.world(gravity=[0, 0, -9.81])
        for world in (body, other):
            world.restore(state)
            self.assertEqual(world.tools["knife"].pose, incise.Pose([0.07, 0, 0.02]))
            self.assertEqual(world.save(), state)
            go_on(world)
            ends.append((world.positions, world.velocities, world.edits(), world.time))
        self.assertTrue(ends[0][2])
        for end in ends[1:]:
            np.testing.assert_array_equal(end[0], ends[0][0])
            np.testing.assert_array_equal(end[1], ends[0][1])
            self.assertEqual(end[2:], ends[0][2:])

    def test_scenario_tools_go_on(self) -> None:
        body = incise.World(support.SCENARIOS / "beam.toml")
        body.run_until(0.05)
        state = body.save()
        body.run_until(0.1)
        end = body.positions
        body.restore(state)
        body.run_until(0.1)
        np.testing.assert_array_equal(body.positions, end)

    def test_version_never_names_two_meshes(self) -> None:
        body = support.world()
        state = body.save()
        versions = {body.topology_version}
        for x in (0.05, 0.07, 0.09):
            support.cut_through(body, x)
            triangles = body.surface.triangles
            self.assertEqual(triangles.max(), body.num_nodes - 1)
            self.assertNotIn(body.topology_version, versions)
            versions.add(body.topology_version)
            body.restore(state)
            self.assertNotIn(body.topology_version, versions)
            versions.add(body.topology_version)
            self.assertLess(body.surface.triangles.max(), body.num_nodes)
            self.assertEqual(body.cells.shape, (144, 4))

    def test_tools_and_grasps_of_later_are_gone(self) -> None:
        body = support.world()
        state = body.save()
        knife = body.add_tool("knife", support.BLADE)
        hand = body.grasp("hand", np.flatnonzero(body.rest_positions[:, 0] > 0.1))
        body.restore(state)
        self.assertEqual(list(body.tools), [])
        self.assertEqual(list(body.constraints), ["clamp"])
        with self.assertRaisesRegex(incise.InputError, "no longer in its world"):
            knife.pose = incise.Pose()
        with self.assertRaisesRegex(incise.InputError, "no longer in its world"):
            hand.release()

    def test_undo_goes_back_to_the_bits_of_before(self) -> None:
        body = led_world()
        body.tools["knife"].pose = incise.Pose([0.07, 0, 0.035])
        body.run_until(0.003)
        point, state, edits = body.undo_point(), body.save(), body.edits()
        self.assertEqual(repr(point), f"<incise.UndoPoint at t = {body.time} s>")
        versions = {body.topology_version}
        ends = []
        for _ in range(3):
            go_on(body)
            self.assertGreater(len(body.edits()), len(edits))
            body.grasp("hand", np.flatnonzero(body.rest_positions[:, 0] > 0.1))
            ends.append((body.save(), body.edits()))
            self.assertNotIn(body.topology_version, versions)
            versions.add(body.topology_version)
            body.undo(point)
            self.assertNotIn(body.topology_version, versions)
            versions.add(body.topology_version)
            self.assertEqual(body.save(), state)
            self.assertEqual(body.edits(), edits)
            self.assertEqual(list(body.constraints), ["clamp"])
        self.assertEqual(ends[1:], ends[:1] * 2)

    def test_undo_refuses_other_points_and_changes_nothing(self) -> None:
        body, other = support.world(), support.world()
        start = body.undo_point()
        support.cut_through(body, 0.05)
        later, state = body.undo_point(), body.save()
        with self.assertRaisesRegex(incise.InputError, "another world"):
            other.undo(start)
        with self.assertRaises(TypeError):
            body.undo(3)
        self.assertEqual(body.save(), state)
        with body.view(), self.assertRaises(BufferError):
            body.undo(start)
        body.undo(start)
        with self.assertRaisesRegex(incise.InputError, "taken back"):
            body.undo(later)
        body.restore(state)
        with self.assertRaisesRegex(incise.InputError, "restored"):
            body.undo(start)

    def test_a_tool_leads_no_other_tool(self) -> None:
        body = support.world()
        empty = body.save()
        knife = body.add_tool("knife", support.BLADE)
        with_knife = body.save()
        other = support.world()
        probe = other.add_tool("probe", support.BLADE)
        other.restore(with_knife)
        with self.assertRaisesRegex(incise.InputError, "no longer in its world"):
            probe.pose = incise.Pose()
        other.tools["knife"].pose = incise.Pose()
        body.restore(empty)
        again = body.add_tool("knife", support.BLADE)
        with self.assertRaisesRegex(incise.InputError, "no longer in its world"):
            knife.pose = incise.Pose()
        again.pose = incise.Pose()
        # What was done anew gives the same bytes.
        body.restore(empty)
        body.add_tool("knife", support.BLADE)
        self.assertEqual(body.save(), with_knife)

    def test_a_failed_world_goes_back(self) -> None:
        body = support.world(materials=[{"density": 1000, "young": 1e4, "poisson": 0.4,
                                         "law": "neo-hookean"}])
        state = body.save()
        hand = body.grasp("hand", np.flatnonzero(body.rest_positions[:, 0] > 0.119))
        with self.assertRaises(incise.PhysicsError):
            for x in (-0.5, -0.5, -1.0, -1.5, -2.0, -2.5):
                hand.pose = incise.Pose([x, 0, 0])
                body.step(n=20)
        self.assertTrue(body.has_failed)
        with self.assertRaisesRegex(incise.InputError, "the world has failed"):
            body.step()
        self.assertEqual(body.positions.shape, (body.num_nodes, 3))
        body.restore(state)
        self.assertFalse(body.has_failed)
        body.step()

    def test_other_bytes_are_refused_and_change_nothing(self) -> None:
        body = led_world()
        body.run_until(0.002)
        state = body.save()
        source = random.Random(1)
        for _ in range(200):
            damaged = bytearray(state)
            kind = source.randrange(3)
            if kind == 0:
                damaged[source.randrange(len(damaged))] ^= 1 << source.randrange(8)
            elif kind == 1:
                del damaged[source.randrange(len(damaged)):]
            else:
                damaged += b"x"
            with self.assertRaises(incise.InputError):
                body.restore(bytes(damaged))
        self.assertEqual(body.save(), state)
        with self.assertRaisesRegex(incise.InputError, "save.. has not made them"):
            body.restore(b"\x0c" + bytes(100))
        with self.assertRaisesRegex(incise.InputError, "has 0 tools, and this one 1"):
            incise.World(support.SCENARIOS / "beam.toml").restore(state)
        with self.assertRaises(incise.InputError):
            support.world(materials=[{**support.MATERIAL, "young": 2e4}]).restore(state)


if __name__ == "__main__":
    unittest.main()
