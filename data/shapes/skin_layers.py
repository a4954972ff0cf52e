#!/usr/bin/env python3
# Writes the block of skin, fat and muscle of scenarios/skin_layers.toml, as Gmsh 2.2:
#   python3 skin_layers.py > skin_layers.msh && incise convert skin_layers.msh ../skin_layers.vtu
# The block has cells of all four kinds, which join through their faces:
#   skin    wedges that lie: a brick is divided along a slanted plane, so its lower side stays whole
#   fat     hexahedra
#   muscle  above, pyramids on the hexahedra, with tetrahedra round them; below, tetrahedra
# SPDX-License-Identifier: LGPL-3.0-or-later
import itertools

from bricks import tetrahedra_of_brick, write_gmsh

SIZE_X, SIZE_Y = 0.060, 0.048  # m, about the origin; the skin's surface lies at z = 0
CELLS_X, CELLS_Y = 24, 20
SKIN, FAT, MUSCLE = 1, 2, 3
# From below: thickness (m), what a brick becomes, region.
LAYERS = [
    (0.0045, "tetrahedra", MUSCLE),
    (0.0035, "pyramid", MUSCLE),
    (0.0030, "hexahedron", FAT),
    (0.0030, "hexahedron", FAT),
    (0.0020, "wedges", SKIN),
]

levels = [-sum(thickness for thickness, _, _ in LAYERS)]
for thickness, _, _ in LAYERS:
    levels.append(levels[-1] + thickness)
points = [
    (SIZE_X * (i / CELLS_X - 0.5), SIZE_Y * (j / CELLS_Y - 0.5), z)
    for z, j, i in itertools.product(levels, range(CELLS_Y + 1), range(CELLS_X + 1))
]


def node(i, j, k):
    return 1 + i + (CELLS_X + 1) * (j + (CELLS_Y + 1) * k)


def hexahedron(i, j, k):
    square = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [node(i + a, j + b, k + c) for c in (0, 1) for a, b in square]


def wedges(i, j, k):
    """Returns two wedges along y. Their triangles are in the sides across y, where neighbours match."""
    return [
        [node(i + a, j + b, k + c) for b in (0, 1) for a, c in triangle]
        for triangle in (((0, 0), (1, 1), (1, 0)), ((0, 0), (0, 1), (1, 1)))
    ]


def pyramid_with_tetrahedra(i, j, k):
    """Returns a pyramid below the upper side of a brick, and two tetrahedra at each other side.

    They meet at the centre. The sides are divided as those of tetrahedra_of_brick.
    """
    corners = hexahedron(i, j, k)
    points.append(tuple(sum(points[n - 1][d] for n in corners) / 8 for d in range(3)))
    centre = len(points)
    sides = [[corners[n] for n in side] for side in SIDES]
    found = [[*reversed(corners[4:]), centre]]
    for tetrahedron in tetrahedra_of_brick(node, i, j, k):
        for n in range(4):
            triangle = tetrahedron[:n] + tetrahedron[n + 1 :]
            if any(set(triangle) <= set(side) for side in sides):
                found.append([*tetrahedron[:n], centre, *tetrahedron[n + 1 :]])
    return found


# The sides of a hexahedron but for its upper one.
SIDES = ((0, 1, 2, 3), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
CELLS_OF_BRICK = {
    "hexahedron": lambda *brick: [hexahedron(*brick)],
    "wedges": wedges,
    "pyramid": pyramid_with_tetrahedra,
    "tetrahedra": lambda *brick: tetrahedra_of_brick(node, *brick),
}
cells = [
    (region, corners)
    for k, (_, kind, region) in enumerate(LAYERS)
    for j, i in itertools.product(range(CELLS_Y), range(CELLS_X))
    for corners in CELLS_OF_BRICK[kind](i, j, k)
]
write_gmsh(points, cells)
