# Bricks as tetrahedra and other cells, and meshes as Gmsh 2.2, for the scripts beside it.
# SPDX-License-Identifier: LGPL-3.0-or-later
import itertools


def tetrahedra_of_brick(node, i, j, k):
    """Returns the corners of six tetrahedra round the diagonal of a brick.

    There is one for each order of steps from its corner (i, j, k) to (i + 1, j + 1, k + 1).
    node(i, j, k) is the number of a point, from 1.
    """
    tetrahedra = []
    for order in itertools.permutations(range(3)):
        at, corners = [i, j, k], [node(i, j, k)]
        for axis in order:
            at[axis] += 1
            corners.append(node(*at))
        if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):  # odd ones run the other way round
            corners[0], corners[1] = corners[1], corners[0]
        tetrahedra.append(corners)
    return tetrahedra


GMSH_TYPES = {4: 4, 8: 5, 6: 6, 5: 7}  # tetrahedron, hexahedron, wedge, pyramid by number of corners


def write_gmsh(points, cells):
    """Prints a mesh. A cell is its region and its points, numbered from 1, in the order of Gmsh."""
    print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes")
    print(len(points))
    for n, x in enumerate(points):
        print(n + 1, *(f"{c:.9g}" for c in x))
    print("$EndNodes\n$Elements")
    print(len(cells))
    for e, (region, corners) in enumerate(cells):
        print(e + 1, GMSH_TYPES[len(corners)], 2, region, region, *corners)
    print("$EndElements")
