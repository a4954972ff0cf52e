"""Builds the module incise of Python with CMake: see pyproject.toml and docs/python.md."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Builds the extension in a folder of its own, or takes it from INCISE_BUILD_DIR."""

    def build_extension(self, ext: Extension) -> None:
        build = pathlib.Path(os.environ.get("INCISE_BUILD_DIR") or self.build_temp).resolve()
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(
                ["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                 "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=16",
                 "-DINCISE_PYTHON=ON", "-DINCISE_APP=OFF", "-DINCISE_RENDERING=OFF",
                 "-DINCISE_TETMESH=OFF", "-DBUILD_TESTING=OFF",
                 f"-DPython3_EXECUTABLE={sys.executable}",
                 *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "incise_python", "--parallel",
                        os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))],
                       check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(build / "python" / "incise" / target.name, target)


VERSION = re.search(r"project\(incise VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
assert VERSION
setup(
    version=VERSION.group(1),
    package_dir={"": "python"},
    packages=find_packages("python"),
    package_data={"": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("incise._incise", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
