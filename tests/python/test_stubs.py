"""The stubs name what the module has, and users of them pass mypy."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import ast
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import incise

# What stubs of pybind11 cannot say: its metaclass, and that a class cannot be made by hand.
ALLOWED = r"""
incise\._incise\.(Constraint|CutResult|Elements|Load|Mesh|Physics|Pose|StepReport|Surface|Tool|ToolContacts|UndoPoint|View|World)
incise\._incise\.(Constraint|CutResult|Elements|Load|Physics|StepReport|Surface|Tool|ToolContacts|UndoPoint|View)\.__init__
"""
USE = """
import incise
import numpy as np

body = incise.World("x.toml", num_threads=2)
knife: incise.Tool = body.add_tool("knife", {"kind": "blade"}, incise.Pose([0, 0, 0]))
knife.pose = incise.Pose(np.zeros(3))
report = body.step(n=3)
force: float = float(report.tool_forces["knife"][0])
with body.view() as view:
    total = view.positions.sum()
body.restore(body.save())
point: incise.UndoPoint = body.undo_point()
body.undo(point)
picture = body.render(64, 48, (0, -1, 0.5))
depth: float = float(body.render(channels=("rgb", "depth"))["depth"].min())
normal: float = float(knife.contacts.normals[0, 2])
env = incise.envs.PathIncisionEnv(depth=0.004)
observation, info = env.reset(seed=1)
"""

WRONG = ("incise.Pose(3, 4, 5)", "incise.World('x').tim", "incise.env", "incise.envs.PathEnv")


def shape_of(function: ast.FunctionDef) -> tuple[list[str], list[str], int, list[bool]]:
    """Return the names of arguments, those of keywords, and which of them have a default."""
    given = function.args
    return ([a.arg for a in given.args if a.arg != "self"], [a.arg for a in given.kwonlyargs],
            len(given.defaults), [d is not None for d in given.kw_defaults])


class Signatures(unittest.TestCase):
    """stubtest cannot see the arguments of functions of pybind11: their texts begin with them."""

    def check(self, stub: ast.FunctionDef, text: str) -> None:
        written = ast.parse("def " + text.splitlines()[0] + ": ...").body[0]
        assert isinstance(written, ast.FunctionDef)
        self.assertEqual(shape_of(stub), shape_of(written), stub.name)

    def test_arguments_are_those_of_the_module(self) -> None:
        spec = importlib.util.find_spec("incise")
        assert spec and spec.origin
        stubs = ast.parse(pathlib.Path(spec.origin).with_name("_incise.pyi").read_text())
        num_checked = 0
        for node in stubs.body:
            if isinstance(node, ast.FunctionDef):
                self.check(node, getattr(incise, node.name).__doc__)
                num_checked += 1
            if not isinstance(node, ast.ClassDef):
                continue
            of_class = getattr(incise, node.name)
            for member in node.body:
                if not isinstance(member, ast.FunctionDef):
                    continue
                decorators = [ast.unparse(d) for d in member.decorator_list]
                there = getattr(of_class, member.name)
                if "property" in decorators:
                    self.assertIsInstance(there, property, member.name)
                elif f"{member.name}.setter" in decorators:
                    self.assertIsNotNone(there.fset, member.name)
                elif "Overloaded function" not in (there.__doc__ or "") and \
                        not member.name.startswith("__") or member.name == "__init__":
                    self.check(member, there.__doc__)
                    num_checked += 1
        self.assertGreater(num_checked, 25)


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Stubs(unittest.TestCase):
    def run_module(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        with tempfile.TemporaryDirectory() as folder:
            return subprocess.run([sys.executable, "-m", *arguments], cwd=folder, text=True,
                                  capture_output=True)

    def test_stubs_are_complete(self) -> None:
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as allowed:
            allowed.write(ALLOWED)
            allowed.flush()
            done = self.run_module("mypy.stubtest", "incise._incise", "--concise", "--allowlist",
                                   allowed.name, "--ignore-unused-allowlist")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def check(self, text: str) -> subprocess.CompletedProcess[str]:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "use.py"
            path.write_text(text)
            return self.run_module("mypy", "--strict", str(path))

    def test_users_pass_mypy(self) -> None:
        done = self.check(USE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_wrong_uses_do_not(self) -> None:
        done = self.check("import incise\n" + "\n".join(WRONG))
        for row, wrong in enumerate(WRONG, 2):
            self.assertIn(f"use.py:{row}: error", done.stdout, wrong)

    def test_the_package_is_marked_as_typed(self) -> None:
        spec = importlib.util.find_spec("incise")
        assert spec and spec.origin
        self.assertTrue(os.path.exists(pathlib.Path(spec.origin).with_name("py.typed")))


if __name__ == "__main__":
    unittest.main()
