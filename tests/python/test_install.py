"""Installs by pip and by cmake, into temporary folders and without network."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import support

USE = """
import incise, pathlib
assert pathlib.Path(incise.__file__).is_relative_to({folder!r}), incise.__file__
body = incise.World(mesh={{"box": {{"size": [1, 1, 1], "cells": [1, 1, 1]}}}},
                    materials=[{{"density": 1000, "young": 1e5, "poisson": 0.4}}])
body.step()
print(body.num_cells)
"""


class Install(unittest.TestCase):
    def use(self, folder: pathlib.Path) -> None:
        """Import the module from a folder, and make a step."""
        self.assertTrue((folder / "incise" / "py.typed").exists())
        self.assertTrue((folder / "incise" / "_incise.pyi").exists())
        done = subprocess.run([sys.executable, "-c", USE.format(folder=str(folder))], text=True,
                              capture_output=True, env={**os.environ, "PYTHONPATH": str(folder)},
                              cwd=folder)
        self.assertEqual((done.returncode, done.stdout), (0, "6\n"), done.stderr)

    def test_pip(self) -> None:
        """The build folder of the tests is used, as the libraries take minutes to build."""
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder) / "source", pathlib.Path(folder) / "env"
            source.mkdir()  # a copy, as setuptools writes beside the sources
            for name in ("setup.py", "pyproject.toml", "CMakeLists.txt"):
                shutil.copy(support.SOURCES / name, source)
            shutil.copytree(support.SOURCES / "python", source / "python")
            # As docs/python.md says.
            subprocess.run([sys.executable, "-m", "venv", "--system-site-packages",
                            "--without-pip", target], check=True)
            subprocess.run([target / "bin" / "python", "-m", "pip", "install",
                            "--no-build-isolation", "--no-index", "--quiet", source],
                           check=True, cwd=folder)
            (package,) = target.glob("lib/python3*/site-packages")
            self.use(package)

    def test_cmake(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["cmake", "--install", os.environ["INCISE_BUILD_DIR"], "--component",
                            "python", "--prefix", folder], check=True, capture_output=True)
            (package,) = pathlib.Path(folder).glob("lib/python3*/*-packages")
            self.use(package)


if __name__ == "__main__":
    unittest.main()
