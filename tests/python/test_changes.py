"""What a program changes in a world that runs: materials, gravity, damping, constraints, loads."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import unittest
import warnings
from typing import Any

import numpy as np

import incise
import support

TOP = {"box": {"min": [-1, -1, 0.039], "max": [1, 1, 1]}}
TIP = {"box": {"min": [0.119, -1, -1], "max": [1, 1, 1]}}


class Changes(unittest.TestCase):
    def test_world_that_is_changed_at_once_is_one_that_begins_so(self) -> None:
        load = {"where": TOP, "pressure": 50.0}
        hold = {"where": TIP, "fix": "y"}
        first = support.world(damping=2.0, gravity=[0, 0, -9.81],
                              materials=[{**support.MATERIAL, "young": 3e4}],
                              constraints=[support.CLAMP, {"name": "hold", **hold}],
                              loads=[{"name": "press", **load}])
        body = support.world()
        body.set_material({**support.MATERIAL, "young": 3e4})
        body.set_gravity([0, 0, -9.81])
        body.set_damping(2.0)
        body.add_constraint("hold", hold)
        body.add_load("press", load)
        self.assertEqual((body.gravity.tolist(), body.damping), ([0, 0, -9.81], 2.0))
        for world in (first, body):
            world.run_until(0.02)
        np.testing.assert_array_equal(body.positions, first.positions)
        np.testing.assert_array_equal(body.constraints["hold"].force,
                                      first.constraints["hold"].force)
        self.assertGreater(np.abs(body.positions - body.rest_positions).max(), 1e-5)

    def test_parts_change_and_go(self) -> None:
        body = support.world()
        press = body.add_load("press", {"where": TOP, "pressure": 50.0})
        hold = body.add_constraint("hold", {"where": TIP, "fix": "xyz"})
        press.change({"where": TIP, "nodal_force": [0, 0, -1e-3]})
        press.factor = 0.0
        hold.change({"where": TIP, "move": [{"time": 0, "by": [0, 0, 0]},
                                            {"time": 0.1, "by": [0, 0, 0.01]}]})
        body.run_until(0.1)
        tip = body.rest_positions[:, 0] > 0.119
        np.testing.assert_allclose((body.positions - body.rest_positions)[tip],
                                   np.tile([0, 0, 0.01], (tip.sum(), 1)), atol=1e-12)
        hold.release()
        press.remove()
        self.assertEqual((list(body.constraints), list(body.loads)), (["clamp"], []))
        body.set_damping(20.0)
        body.run_until(1.5)
        self.assertLess(np.abs(body.positions - body.rest_positions).max(), 2e-4)
        for gone in (hold.release, press.remove, lambda: press.change({"where": TOP, "pressure": 1})):
            with self.assertRaises(incise.InputError):
                gone()

    def test_undo_without_a_point_takes_all_of_it_back(self) -> None:
        body = support.world()
        with self.assertRaisesRegex(incise.InputError, "call undo_point"):
            body.undo()
        body.run_until(0.01)
        body.undo_point()
        state = body.save()
        body.set_material({**support.MATERIAL, "young": 3e4})
        with self.assertRaisesRegex(incise.InputError, "other materials"):
            body.restore(state)
        body.set_gravity([0, 0, 3])
        body.add_load("press", {"where": TOP, "pressure": 50.0})
        support.cut_through(body)
        for _ in range(2):
            body.undo()
            self.assertEqual(body.save(), state)
            support.cut_through(body)

    def test_faults_name_the_part_and_change_nothing(self) -> None:
        body = support.world()
        state = body.save()
        wrong: list[tuple[Any, str]] = [
            (lambda: body.add_constraint("a b", {}), "constraint: the name 'a b' is not allowed"),
            (lambda: body.add_constraint("x", {"where": TOP, "fix": "q"}), "'fix': 'q'"),
            (lambda: body.add_constraint("x", {"where": TOP}), "constraint 'x': holds nothing"),
            (lambda: body.add_constraint("clamp", {"where": TOP, "fix": "x"}), "already"),
            (lambda: body.add_constraint("x", {"name": "x", "where": TOP, "fix": "x"}),
             "leave it out"),
            (lambda: body.add_load("x", {"where": TOP, "presure": 3}), "did you mean 'pressure'"),
            (lambda: body.add_load("x", {"where": {"nodes": [9999]}, "nodal_force": [1, 0, 0]}),
             "9999"),
            (lambda: body.set_material({**support.MATERIAL, "density": 999}), "keeps its mass"),
            (lambda: body.set_material({**support.MATERIAL, "regions": [7]}), "no region 7"),
            (lambda: body.set_material({"density": 1000, "method": "hybmss", "young": 1e4,
                                        "poisson": 0.3}), "needs hexahedra"),
            (lambda: body.set_gravity([0, 0]), "three numbers"),
            (lambda: body.set_damping(-1), "0 or more")]
        for call, text in wrong:
            with self.assertRaises(incise.InputError) as caught:
                call()
            self.assertIn(text, str(caught.exception))
        self.assertEqual(body.save(), state)

    def test_constraint_that_pulls_nodes_back_is_told_of(self) -> None:
        body = support.world(gravity=[0, 0, -9.81])
        body.run_until(0.1)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            body.add_constraint("tip", {"where": TIP, "fix": "xy"})
            body.add_constraint("tip_z", {"where": TIP, "fix": "z"})
        self.assertIn("moves nodes by up to", str(caught[-1].message))


class Handles(unittest.TestCase):
    def test_tool_of_before_a_restore_is_the_same_tool(self) -> None:
        body = support.world()
        knife = body.add_tool("knife", support.BLADE, incise.Pose([0.07, 0, 0.06]))
        knife.pose = incise.Pose([0.07, 0, 0.05])
        body.restore(body.save())
        self.assertEqual(knife.pose, incise.Pose([0.07, 0, 0.05]))
        self.assertEqual(knife.current_pose, incise.Pose([0.07, 0, 0.06]))
        body.tools["knife"].withdraw()
        knife.pose = incise.Pose([0.07, 0, 0.055])
        body.step(n=3)
        self.assertIsNone(knife.current_pose)
        knife.pose = incise.Pose([0.07, 0, 0.05])
        body.restore(body.save())
        knife.place(incise.Pose([0.03, 0, 0.06]))
        body.step()
        self.assertEqual(knife.current_pose, incise.Pose([0.03, 0, 0.06]))

    def test_tools_go_on_after_undo_and_restore(self) -> None:
        """Whatever is said of a tool from before, in any order, is of one tool."""
        for go_back in (lambda body: body.undo(), lambda body: body.restore(body.save())):
            for is_pose_first in (True, False):
                body = support.world()
                knife = body.add_tool("knife", support.BLADE, incise.Pose([0.07, 0, 0.06]))
                body.undo_point()
                go_back(body)
                if is_pose_first:
                    knife.pose = incise.Pose([0.07, 0, -0.02])
                knife.withdraw()
                if not is_pose_first:
                    knife.pose = incise.Pose([0.07, 0, -0.02])
                body.run_until(0.02)
                self.assertEqual(body.ledger()["components"], 2)
                self.assertFalse(knife.is_present)

    def test_call_that_ends_early_leaves_no_cut_behind(self) -> None:
        """The plane has cut in the first step; the call ends at a later one."""
        body = support.world()
        body.add_tool("plane", {"kind": "cut", "plane": {"point": [0.05, 0, 0],
                                                         "normal": [1, 0, 0.1]}})
        ball = body.add_tool("ball", {"kind": "probe", "shape": {"sphere": {"radius": 0.01}}},
                             incise.Pose([0.06, 0.02, 0.2]))
        body.step(n=2)
        self.assertEqual(body.ledger()["components"], 2)
        ball.pose = incise.Pose([0.06, 0.02, 1e6])
        with self.assertRaises(incise.InputError):
            body.step(n=2)
        ball.place(incise.Pose([0.06, 0.02, 0.2]))
        body.step(n=2)

    def test_refused_changes_leave_no_warning(self) -> None:
        body = support.world()
        before = body.warnings
        with self.assertRaises(incise.InputError):
            body.add_constraint("x", {"fix": "xyz", "where": {"box": {"min": [-1, -1, -1],
                                                                     "max": [1, 1, 1]}},
                                      "move": [{"time": 0, "by": [1, 0, 0]}]})
        self.assertEqual(body.warnings, before)


class Contacts(unittest.TestCase):
    def test_add_up_to_the_force_of_a_step(self) -> None:
        body = support.world()
        ball = body.add_tool("ball", {"kind": "probe", "shape": {"sphere": {"radius": 0.01}}},
                             incise.Pose([0.06, 0.02, 0.0501]))
        self.assertEqual(len(ball.contacts), 0)
        for i in range(60):
            ball.pose = incise.Pose([0.06, 0.02, 0.0501 - 2e-5 * i])
            report = body.step(dt=0.3 * body.stable_step)
        contacts = ball.contacts
        self.assertEqual(report.num_substeps, 1)
        n = len(contacts)
        self.assertGreater(n, 0)
        for array, shape in ((contacts.points, (n, 3)), (contacts.normals, (n, 3)),
                             (contacts.depths, (n,)), (contacts.regions, (n,))):
            self.assertEqual(array.shape, shape)
        np.testing.assert_allclose((contacts.normal_forces + contacts.friction_forces).sum(axis=0),
                                   ball.force, rtol=1e-9, atol=1e-12)
        self.assertTrue((contacts.normals[:, 2] > 0.5).all())
        self.assertEqual(set(contacts.regions.tolist()), {0})

    def test_definition_is_how_a_tool_looks(self) -> None:
        body = support.world()
        blade = body.add_tool("knife", {**support.BLADE, "snap": 0.1})
        self.assertEqual(blade.definition, {"kind": "blade", "edge": [[0, -0.1, 0], [0, 0.2, 0]]})
        cut = body.add_tool("cut", {"kind": "cut", "plane": {"point": [0.05, 0, 0],
                                                            "normal": [1, 0, 0]}})
        self.assertIsNone(cut.definition)


class Pictures(unittest.TestCase):
    def test_show_body_cut_and_tools(self) -> None:
        body = support.world()
        support.cut_through(body)
        hand = body.grasp("hand", np.flatnonzero(body.rest_positions[:, 0] > 0.1))
        pose = hand.pose
        assert pose is not None
        hand.pose = incise.Pose(pose.position + [0.05, 0, 0])
        body.run_until(0.1)
        body.add_tool("ball", {"kind": "probe", "shape": {"sphere": {"radius": 0.01}}},
                      incise.Pose([0.02, 0.02, 0.06]))
        for i, shape in enumerate(({"capsule": {"from": [0, 0, 0], "to": [0, 0.02, 0],
                                                "radius": 0.004}},
                                   {"box": {"size": [0.01, 0.02, 0.01]}})):
            body.add_tool(f"tool_{i}", {"kind": "carver", "shape": shape},
                          incise.Pose([0.05 + 0.1 * i, 0.02, 0.08]))
        body.add_tool("scissors", {"kind": "scissors", "length": 0.03, "angle": 0.5,
                                   "closing_time": 0.1}, incise.Pose([0.1, 0.02, 0.09]))
        made = body.render(160, 120, channels=("rgb", "depth", "segmentation"))
        self.assertEqual(list(made), ["rgb", "depth", "segmentation"])
        rgb, depth, labels = made.values()
        self.assertEqual((rgb.shape, rgb.dtype), ((120, 160, 3), np.uint8))
        self.assertEqual((depth.shape, labels.shape), ((120, 160), (120, 160)))
        # 0: tissue; -1: nothing; -2 is the knife, which was withdrawn.
        self.assertEqual(np.unique(labels).tolist(), [-6, -5, -4, -3, -1, 0])
        np.testing.assert_array_equal(np.isinf(depth), labels == -1)
        red = (rgb[..., 0] > 2.0 * rgb[..., 1]) & (labels == 0)
        self.assertGreater(red.sum(), 20)

    def test_depth_and_place_are_those_of_the_camera(self) -> None:
        """A block seen from 1 m above, through a camera of which all is known."""
        body = support.world()
        view = {"position": [0.06, 0.02, 1.04], "target": [0.06, 0.02, 0.0], "field_of_view": 0.1}
        depth = body.render(101, 101, view, "depth")
        seen = np.isfinite(depth)
        np.testing.assert_allclose(depth[seen], 1.0, atol=1e-3)
        wide = 101 / (2 * np.tan(0.05))  # pixels a metre at 1 m
        self.assertAlmostEqual(seen[50].sum(), min(101, 0.12 * wide), delta=2)
        self.assertAlmostEqual(seen[:, 50].sum(), 0.04 * wide, delta=2)

    def test_what_is_behind_the_camera_is_not_seen(self) -> None:
        body = support.world()
        away = {"position": [0.06, 0.02, 1.04], "target": [0.06, 0.02, 2.0]}
        self.assertEqual(set(body.render(31, 31, away, "segmentation").ravel().tolist()), {-1})
        # From inside, the wall at the end is 0.06 m away.
        inside = {"position": [0.06, 0.02, 0.02], "target": [0.12, 0.02, 0.02],
                  "field_of_view": 0.5}
        depth = body.render(31, 31, inside, "depth")
        self.assertTrue(np.isfinite(depth).all())
        self.assertAlmostEqual(depth[15, 15], 0.06, places=6)
        self.assertLess(depth.max(), 0.0601)
        # A wide view from inside has the sides too, which reach behind the camera.
        wide = body.render(41, 41, {**inside, "field_of_view": 2.5}, "depth")
        self.assertTrue(np.isfinite(wide).all())
        self.assertLess(wide.min(), 0.02)
        knife = body.add_tool("knife", {"kind": "blade", "edge": [[0.0, 0.02, 0.02],
                                                                  [0.11, 0.02, 0.02]]},
                              incise.Pose())
        knife.pose = incise.Pose([0, 0.3, 0])  # a target: it is still there
        labels = body.render(31, 31, {**inside, "position": [0.06, 0.02, 0.021]}, "segmentation")
        self.assertEqual(set(labels.ravel().tolist()), {-2, 0})

    def test_regions_below_zero_have_no_labels(self) -> None:
        block = incise.Mesh.box([1, 1, 1], [1, 1, 1])
        mesh = incise.Mesh(block.points, block.cells, regions=[-1] * 6)
        body = incise.World(mesh=mesh, materials=[support.MATERIAL])
        self.assertEqual(body.render(8, 8).shape, (8, 8, 3))
        with self.assertRaisesRegex(ValueError, "region -1"):
            body.render(8, 8, channels="segmentation")

    def test_whole_body_is_in_the_picture(self) -> None:
        body = support.world()
        for view in ([-0.5, -1, 0.5], [0, 0, 1], [0, 0, -1], (1, 0, 0), np.array([0, -3, 0])):
            for shape in ((80, 60), (60, 80), (40, 120)):
                labels = body.render(*shape, view, "segmentation")
                self.assertGreater((labels == 0).sum(), 30)
                rim = np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]])
                self.assertEqual(set(rim.tolist()), {-1})

    def test_what_cannot_be_is_refused(self) -> None:
        body = support.world()
        for arguments, text in (((0, 5), "width is 0"), ((5, 99999), "height is 99999"),
                                ((5, 5, [0, 0, 0]), "view is zero"), ((5, 5, "x"), "three numbers"),
                                ((5, 5, {"at": 3}), "no key 'at'"), ((5, 5, {}), "no position"),
                                ((5, 5, {"position": [0, 0, 1], "target": [0, 0, 1]}), "elsewhere"),
                                ((5, 5, {"position": [0, 0, 1], "field_of_view": 9}), "0.01 to 3"),
                                ((5, 5, [1, 0, 0], "rgbd"), "no channel 'rgbd'")):
            with self.assertRaisesRegex(ValueError, text):
                body.render(*arguments)


if __name__ == "__main__":
    unittest.main()
