#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""The surface of the kidney as an STL file in millimetres, as segmentation programs write it.

Usage, with Debian's python3-meshio:  kidney_surface.py ../kidney.vtu kidney.stl
"""

import sys

import meshio
import numpy as np

FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))  # of a tetrahedron, outward


def boundary(tetrahedra):
    """The faces that belong to one tetrahedron only."""
    faces = np.vstack([tetrahedra[:, face] for face in FACES])
    _, where, counts = np.unique(
        np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return faces[counts[where.ravel()] == 1]


def main():
    source, target = sys.argv[1:]
    mesh = meshio.read(source)
    corners = (1000 * mesh.points[boundary(mesh.cells_dict["tetra"])]).astype("<f4")
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    rows = np.zeros(
        len(corners), dtype=[("normal", "<3f4"), ("corners", "<(3,3)f4"), ("none", "<u2")]
    )
    rows["normal"], rows["corners"] = normals, corners
    with open(target, "wb") as file:
        file.write(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())


if __name__ == "__main__":
    main()
