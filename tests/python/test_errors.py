"""Exceptions and their texts."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import copy
import os
import pathlib
import pickle
import subprocess
import tempfile
import unittest
from typing import Any, Callable

import numpy as np

import incise
import support

BOX = {"size": [1, 1, 1], "cells": [1, 1, 1]}


class Kinds(unittest.TestCase):
    def test_bases(self) -> None:
        self.assertTrue(issubclass(incise.InputError, incise.Error))
        self.assertTrue(issubclass(incise.InputError, ValueError))
        self.assertTrue(issubclass(incise.PhysicsError, incise.Error))
        self.assertTrue(issubclass(incise.OutputError, OSError))
        error = pickle.loads(pickle.dumps(incise.InputError("text")))
        self.assertEqual((type(error), str(error)), (incise.InputError, "text"))


class Copies(unittest.TestCase):
    def copies(self, thing: Any) -> list[Callable[[], Any]]:
        """Return all ways to copy a thing."""
        protocols = range(pickle.HIGHEST_PROTOCOL + 1)
        return [thing.__reduce__, lambda: copy.copy(thing), lambda: copy.deepcopy(thing),
                *(lambda p=p: thing.__reduce_ex__(p) for p in protocols),
                *(lambda p=p: pickle.dumps(thing, p) for p in protocols)]

    def test_of_what_is_no_value_are_refused(self) -> None:
        body = support.world(loads=[{"name": "push", "pressure": 1.0, "where": {
            "box": {"min": [0, 0, 0.04], "max": [0.12, 0.04, 0.04]}}}])
        knife = body.add_tool("knife", support.BLADE)
        mesh = incise.Mesh.box([1, 1, 1], [1, 1, 1])
        things = [body, mesh, knife, body.step(), body.elements, body.surface, body.physics,
                  body.view(), body.undo_point(), knife.contacts,
                  body.constraints["clamp"], body.loads["push"],
                  incise.cut(mesh, planes=[([0.4, 0, 0], [1, 0, 0])])]
        classes = {kind for kind in vars(incise).values()
                   if isinstance(kind, type) and kind.__name__ in dir(incise._incise)
                   and not issubclass(kind, Exception)}
        self.assertEqual({type(thing) for thing in things} | {incise.Pose}, classes)
        for thing in things:
            for way in self.copies(thing):
                with self.assertRaisesRegex(TypeError, "cannot be copied or pickled"):
                    way()

    def test_of_poses_are_equal(self) -> None:
        class Named(incise.Pose):
            pass
        pose = incise.Pose([1, 2, 3], [0.1, 0.2, 0.3, 0.4])
        for way in self.copies(pose)[1:3]:
            self.assertEqual(way(), pose)
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            self.assertEqual(pickle.loads(pickle.dumps(pose, protocol)), pose)
            make, arguments, state = pose.__reduce_ex__(protocol)[:3]
            self.assertIs(type(make(*arguments)), incise.Pose)
        self.assertIs(type(copy.copy(Named([1, 2, 3]))), Named)


class Texts(unittest.TestCase):
    def assert_refused(self, text: str, call: Callable[[], Any],
                       kind: type[Exception] = incise.InputError) -> None:
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(text, str(caught.exception))

    def test_all_problems_of_dicts_at_once(self) -> None:
        with self.assertRaises(incise.InputError) as caught:
            incise.World(mesh={"box": BOX},
                         materials=[{"density": -1, "young": 1e5, "poison": 0.3}],
                         constraints=[{"fix": "xyz", "where": {"box": {"min": [5, 5, 5],
                                                                       "max": [6, 6, 6]}}}])
        lines = str(caught.exception).splitlines()
        self.assertEqual(len(lines), 3, lines)
        self.assertIn("world: key 'material[0].density': -1 is not allowed: must be above 0",
                      lines)
        self.assertIn("key 'material[0].poison': is not known; did you mean 'poisson'?", lines[0])
        self.assertIn("selects no node", lines[2])

    def test_file_has_the_text_of_the_program(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "wrong.toml"
            path.write_text("[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\n"
                            "[[material]]\ndensity = 1\nyoung = 1\npoisson = 0.7\n"
                            "[dynamics]\nend_time = 0\n")
            with self.assertRaises(incise.InputError) as caught:
                incise.World(path)
            self.assertIn(f"{path}:6:11: key 'material[0].poisson': 0.7 is not allowed",
                          str(caught.exception))
            program = os.environ.get("INCISE_PROGRAM", "")
            if os.access(program, os.X_OK):
                told = subprocess.run([program, "run", path, "--out", path.with_suffix(".out")],
                                      capture_output=True, text=True).stderr
                # The program also warns of what is sound beside the errors.
                errors = [line for line in told.splitlines()
                          if not line.startswith("incise: warning: ")]
                self.assertEqual([f"incise: {line}" for line in str(caught.exception).splitlines()],
                                 errors)
            self.assert_refused("no.toml", lambda: incise.World(path.with_name("no.toml")))

    def test_arguments(self) -> None:
        body = support.world()
        refused = self.assert_refused
        refused("must be above 0", lambda: body.step(0))
        refused("must be above 0", lambda: body.step(float("nan")))
        refused("is above the stable step", lambda: body.step(1.0))
        refused("for 10 steps write step(n=10)", lambda: body.step(10))
        refused("write step(n=12345)", lambda: body.step(12345.0))
        refused("numpy.flatnonzero", lambda: body.grasp("h", body.positions[:, 0] > 0), TypeError)
        refused("a list of texts", lambda: support.world(overrides="dynamics.damping=3"), TypeError)
        refused("a list of texts", lambda: support.world(overrides={"damping": 3}), TypeError)
        refused("n must be at least 1", lambda: body.step(n=0))
        refused("n must be at least 1", lambda: body.step(n=-3))
        refused("its time is 0 s", lambda: body.run_until(-1))
        refused("more than 1e10 steps", lambda: body.run_until(1e30))
        refused("there is no node 1000000", lambda: body.grasp("hand", [1000000]))
        refused("there is no node -1", lambda: body.grasp("hand", [-1]))
        refused("has no node", lambda: body.grasp("hand", np.array([], dtype=int)))
        refused("the name 'a b'", lambda: body.grasp("a b", [0]))
        refused("whole numbers", lambda: body.grasp("hand", [0.5]), TypeError)
        refused("the number of threads is 0", lambda: setattr(body, "num_threads", 0))
        refused("must be finite", lambda: incise.Pose([float("inf"), 0, 0]))
        refused("three numbers", lambda: incise.Pose([0, 0]))
        refused("not zero", lambda: incise.Pose([0, 0, 0], [0, 0, 0, 0]))
        refused("must be numbers", lambda: incise.Pose("here"), TypeError)
        refused("did you mean 'gravity'?", lambda: support.world(gravit=[0, 0, 0]), TypeError)
        refused("Known are: scenario mesh", lambda: support.world(xyz=1), TypeError)
        refused("did you mean 'planes'?",
                lambda: incise.cut(incise.Mesh.box([1, 1, 1], [1, 1, 1]), plane=[]), TypeError)
        refused("or from sections", lambda: incise.World("a.toml", mesh={"box": BOX}))
        refused("add a section [mesh]", lambda: incise.World())
        refused("given twice", lambda: support.world(dynamics={"damping": 1}))
        refused("is of the type set", lambda: support.world(contact={"enabled": {1}}), TypeError)

    def test_tools(self) -> None:
        body = support.world()
        refused = self.assert_refused
        refused("tool 'k': key 'kind'", lambda: body.add_tool("k", {"kind": "knive"}))
        refused("key 'edge': must have at least 2 points",
                lambda: body.add_tool("k", {"kind": "blade", "edge": [[0, 0, 0]]}))
        refused("this one is led by hand",
                lambda: body.add_tool("k", {**support.BLADE, "path": []}))
        refused("is not allowed", lambda: body.add_tool("", support.BLADE))
        self.assertEqual(body.tools, {})
        knife = body.add_tool("knife", support.BLADE)
        refused("has no jaws", knife.close)
        refused("is no suture", knife.tie)
        refused("is no suture", lambda: knife.tighten(1.0))
        refused("is not there to be withdrawn", knife.withdraw)
        refused("must be an incise.Pose", lambda: setattr(knife, "pose", [0, 0, 0]), TypeError)

    def test_lost_motion_is_told(self) -> None:
        body = support.world(materials=[{"density": 1000, "young": 1e4, "poisson": 0.4,
                                         "law": "neo-hookean"}])
        hand = body.grasp("hand", np.flatnonzero(body.rest_positions[:, 0] > 0.119))
        with self.assertRaises(incise.PhysicsError) as caught:
            for x in (-0.5, -0.5, -1.0, -1.5, -2.0, -2.5):
                hand.pose = incise.Pose([x, 0, 0])
                body.step(n=20)
        self.assertRegex(str(caught.exception), r"^world: step \d+, t = .* s: element \d+, node")
        self.assertIn("move it more slowly", str(caught.exception))
        self.assertTrue(body.has_failed)

    def test_files_that_cannot_be_written(self) -> None:
        body = support.world()
        self.assert_refused("no_such_folder",
                            lambda: body.write_vtu("no_such_folder/frame.vtu"), incise.OutputError)
        self.assert_refused("", lambda: body.write_vtu(3), TypeError)
        self.assert_refused("must end in .vtu", lambda: body.write_vtu("frame.vtk"))

    def test_empty_names_of_files(self) -> None:
        body, mesh = support.world(), incise.Mesh.box([1, 1, 1], [1, 1, 1])
        material = [support.MATERIAL]
        solid = {"surface": {"file": ""}}
        for kind, call in (
                ("mesh file", lambda: incise.World(mesh="", materials=material)),
                ("mesh file", lambda: incise.World(mesh={"file": ""}, materials=material)),
                ("mesh file", lambda: incise.read_mesh("")),
                ("mesh file", lambda: mesh.write("")),
                ("scenario file", lambda: incise.World("")),
                ("file that ends in .vtu", lambda: body.write_vtu("")),
                ("surface file", lambda: incise.cut(mesh, surfaces=[""])),
                ("", lambda: body.add_tool("c", {"kind": "cut", "surface": ""})),
                ("", lambda: body.add_tool("p", {"kind": "probe", "shape": solid})),
                ("", lambda: support.world(obstacles=[{"name": "o", "shape": solid}]))):
            self.assert_refused("is empty: name a " + kind, call)

    def test_names_of_files_that_cannot_be(self) -> None:
        body, mesh = support.world(), incise.Mesh.box([1, 1, 1], [1, 1, 1])
        for name in ("x" * 5000, __file__ + "/a"):
            for call in (lambda: incise.World(mesh=name, materials=[support.MATERIAL]),
                         lambda: incise.World(name), lambda: incise.read_mesh(name),
                         lambda: mesh.write(name + ".vtu"),
                         lambda: body.write_vtu(name + ".vtu"),
                         lambda: incise.cut(mesh, surfaces=[name]),
                         lambda: body.add_tool("c", {"kind": "cut", "surface": name})):
                self.assert_refused("", call, incise.Error)

    def test_meshes(self) -> None:
        refused = self.assert_refused
        points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        refused("7", lambda: incise.Mesh(points, [[0, 1, 2, 7]]))
        refused("shape (N, 3)", lambda: incise.Mesh([1, 2], [[0, 1, 2, 3]]))
        refused("corners a cell", lambda: incise.Mesh(points, [[0, 1, 2]]))
        refused("whole numbers", lambda: incise.Mesh(points, [[0.5, 1, 2, 3]]), TypeError)
        refused("", lambda: incise.Mesh(points, [[0, 2, 1, 3]]))
        refused("one number for each", lambda: incise.Mesh(points, [[0, 1, 2, 3]], [1, 2]))
        refused("no_such.vtu", lambda: incise.read_mesh("no_such.vtu"))
        refused("no tool is given", lambda: incise.cut(incise.Mesh(points, [[0, 1, 2, 3]])))


if __name__ == "__main__":
    unittest.main()
