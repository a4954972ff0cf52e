#!/usr/bin/env python3
# Writes the block of skin, fat and muscle of scenarios/skin_incision.toml, as Gmsh 2.2:
#   python3 skin_block.py > skin_block.msh && incise convert skin_block.msh ../skin_block.vtu
# SPDX-License-Identifier: LGPL-3.0-or-later
import itertools
import random

from bricks import tetrahedra_of_brick, write_gmsh

SIZE_X, SIZE_Y = 0.060, 0.050  # m, about the origin; the skin's surface lies at z = 0
CELLS_X, CELLS_Y = 24, 20
# From below: thickness (m), cells across it, region.
LAYERS = [(0.010, 3, 3), (0.008, 3, 2), (0.002, 1, 1)]  # muscle, fat, skin
JITTER = 0.2  # of a cell, of points inside a layer: the cut is to meet no ready-made planes

random.seed(1)
z = -sum(thickness for thickness, _, _ in LAYERS)
levels, regions, is_inside = [z], [], [False]
for thickness, cells, region in LAYERS:
    for k in range(cells):
        levels.append(z + thickness * (k + 1) / cells)
        regions.append(region)
        is_inside.append(k + 1 < cells)
    z += thickness

points = []
for k, j, i in itertools.product(range(len(levels)), range(CELLS_Y + 1), range(CELLS_X + 1)):
    x = SIZE_X * (i / CELLS_X - 0.5)
    y = SIZE_Y * (j / CELLS_Y - 0.5)
    if 0 < i < CELLS_X:
        x += random.uniform(-JITTER, JITTER) * SIZE_X / CELLS_X
    if 0 < j < CELLS_Y:
        y += random.uniform(-JITTER, JITTER) * SIZE_Y / CELLS_Y
    height = levels[k]
    if is_inside[k]:
        height += random.uniform(-JITTER, JITTER) * (levels[k + 1] - levels[k])
    points.append((x, y, height))


def node(i, j, k):
    return 1 + i + (CELLS_X + 1) * (j + (CELLS_Y + 1) * k)


tetrahedra = [
    (regions[k], corners)
    for k, j, i in itertools.product(range(len(regions)), range(CELLS_Y), range(CELLS_X))
    for corners in tetrahedra_of_brick(node, i, j, k)
]
write_gmsh(points, tetrahedra)
