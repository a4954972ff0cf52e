#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""A label image of the kidney, as a segmentation of a scan gives it, as NRRD in millimetres.

The mesh of scenarios/kidney_hexahedra.toml, with Debian's python3-numpy:
  python3 kidney_labels.py kidney.stl > kidney.nrrd
  incise mesh kidney.nrrd ../kidney_hexahedra.vtu --hex --scale 0.001
Label 1 is the cortex, 2 the medulla. The pelvis, a cavity that opens at the hilum, has label 0.
"""

import sys

import numpy as np

VOXEL = 3.0  # mm
CORTEX = 7.0  # mm, its thickness
# Centre and half axes of the pelvis, mm. The hilum is at the side of +x.
PELVIS, PELVIS_HALF_AXES = np.array([14.0, 0.0, 0.0]), np.array([16.0, 6.0, 16.0])


def read_stl(path):
    """The triangles of a binary STL file: an array of n x 3 points."""
    row = np.dtype([("normal", "<3f4"), ("corners", "<(3,3)f4"), ("none", "<u2")])
    return np.fromfile(path, dtype=row, offset=84)["corners"].astype(float)


def crossings(triangles, x, y):
    """The heights z at which the line along z through (x, y) crosses the triangles, ascending."""
    a, b, c = (triangles[:, i, :2] - (x, y) for i in range(3))
    # Twice the areas of the parts of a triangle, seen from above: each belongs to one corner.
    areas = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    is_crossed = np.all(areas > 0, axis=0) | np.all(areas < 0, axis=0)
    weights = areas[:, is_crossed] / areas[:, is_crossed].sum(axis=0)
    return np.sort((weights * triangles[is_crossed, :, 2].T).sum(axis=0))


def main():
    triangles = read_stl(sys.argv[1])
    corners = np.unique(triangles.reshape(-1, 3), axis=0)
    lowest, highest = corners.min(axis=0), corners.max(axis=0)
    size = np.ceil((highest - lowest) / VOXEL).astype(int)
    # A line exactly through a corner or an edge would count twice, or not at all.
    first = 0.5 * (lowest + highest) - 0.5 * VOXEL * (size - 1) + (0.0017, 0.0013, 0.0)

    labels = np.zeros(size, dtype=int)
    for i, j in np.ndindex(*size[:2]):
        z = crossings(triangles, *(first[:2] + VOXEL * np.array([i, j])))
        for k in range(size[2]):
            centre = first + VOXEL * np.array([i, j, k])
            is_inside = np.count_nonzero(z < centre[2]) % 2 == 1
            is_hollow = np.sum(((centre - PELVIS) / PELVIS_HALF_AXES) ** 2) < 1
            if is_inside and not is_hollow:
                depth = np.sqrt(((corners - centre) ** 2).sum(axis=1).min())
                labels[i, j, k] = 1 if depth < CORTEX else 2

    print("NRRD0004\ntype: uint8\ndimension: 3\nsizes:", *size)
    print("encoding: ascii\nspace: left-posterior-superior")
    print("space directions:", *(f"({v[0]},{v[1]},{v[2]})" for v in VOXEL * np.eye(3)))
    print("space origin:", f"({first[0]:.6g},{first[1]:.6g},{first[2]:.6g})\n")
    for row in labels.transpose(2, 1, 0).reshape(-1, size[0]):  # x runs fastest
        print(*row)


if __name__ == "__main__":
    main()
