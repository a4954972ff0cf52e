#!/usr/bin/env python3
"""Reads files that Incise wrote with meshio, a reader that shares no code with it.

Usage: read_with_meshio.py PATH ...   A folder stands for its first and its last .vtu file.
Each file must have points and cells, numbers that are finite and indices in range; a frame (a file
of a folder `frames`) must have the rest positions of its points.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
import pathlib
import sys

import meshio
import numpy


def files_of(path):
    if not path.is_dir():
        return [path]
    files = sorted(path.glob("*.vtu"))
    if not files:
        raise ValueError("has no .vtu file")
    return files if len(files) == 1 else [files[0], files[-1]]


def require(condition, text):
    if not condition:
        raise ValueError(text)


def require_finite(name, values):
    values = numpy.asarray(values)
    if values.dtype.kind == "f":
        require(numpy.isfinite(values).all(), f"{name} has values that are not finite")


def read(path):
    """What is in the file, in words; ValueError says what is wrong with it."""
    mesh = meshio.read(path)
    num_points = len(mesh.points)
    num_cells = sum(len(block.data) for block in mesh.cells)
    require(num_points > 0, "has no points")
    require(num_cells > 0, "has no cells")
    require(mesh.points.shape == (num_points, 3), f"has points of shape {mesh.points.shape}")
    require_finite("points", mesh.points)
    for block in mesh.cells:
        in_range = block.data.size == 0 or (block.data.min() >= 0 and block.data.max() < num_points)
        require(in_range, f"has {block.type} cells with points out of range")
    for name, values in mesh.point_data.items():
        require(len(values) == num_points, f"{name} has {len(values)} values a point")
        require_finite(name, values)
    for name, blocks in mesh.cell_data.items():
        for block, values in zip(mesh.cells, blocks):
            require(len(values) == len(block.data), f"{name} has {len(values)} values for cells")
            require_finite(name, values)
    if path.parent.name == "frames":
        require("rest_position" in mesh.point_data, "is a frame, but has no rest_position")
        shape = mesh.point_data["rest_position"].shape
        require(shape == (num_points, 3), f"has a rest_position of shape {shape}")
    return (f"{num_points} points, {num_cells} cells, "
            f"arrays {', '.join([*mesh.point_data, *mesh.cell_data]) or 'none'}")


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    failures = 0
    for argument in map(pathlib.Path, arguments):
        try:
            for file in files_of(argument):
                print(f"{file}: {read(file)}")
        except (Exception, SystemExit) as error:  # meshio raises many kinds, and exits on some
            print(f"{argument}: {type(error).__name__}: {error}", file=sys.stderr)
            failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
