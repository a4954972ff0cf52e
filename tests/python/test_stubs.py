"""The stubs name what the module has, and users of them pass mypy."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

# What stubs of pybind11 cannot say: its metaclass, and that a class cannot be made by hand.
ALLOWED = r"""
incise\.\w+
incise\._incise\.\w+
incise(\._incise)?\.\w+\.__init__
incise\.envs.*
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
"""


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

    def test_users_pass_mypy(self) -> None:
        for text, is_sound in ((USE, True), ("import incise\nincise.Pose(3, 4, 5)\n", False),
                               ("import incise\nincise.World('x').tim\n", False)):
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "use.py"
                path.write_text(text)
                done = self.run_module("mypy", "--strict", str(path))
            self.assertEqual(done.returncode == 0, is_sound, done.stdout + done.stderr)

    def test_the_package_is_marked_as_typed(self) -> None:
        spec = importlib.util.find_spec("incise")
        assert spec and spec.origin
        self.assertTrue(os.path.exists(pathlib.Path(spec.origin).with_name("py.typed")))


if __name__ == "__main__":
    unittest.main()
