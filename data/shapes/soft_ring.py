#!/usr/bin/env python3
# Writes the ring of scenarios/ball_through_ring.toml, as Gmsh 2.2; region 2 is its rim:
#   python3 soft_ring.py > soft_ring.msh && incise convert soft_ring.msh ../soft_ring.vtu
# SPDX-License-Identifier: LGPL-3.0-or-later
import itertools
import math

from bricks import tetrahedra_of_brick, write_gmsh

INNER, OUTER, HEIGHT = 0.018, 0.040, 0.030  # m; the axis is z, the middle is the origin
CELLS_OUT, CELLS_ROUND, CELLS_UP = 6, 40, 8

points = []
for k, j, i in itertools.product(range(CELLS_UP + 1), range(CELLS_ROUND), range(CELLS_OUT + 1)):
    radius = INNER + (OUTER - INNER) * i / CELLS_OUT
    angle = 2 * math.pi * j / CELLS_ROUND
    # The mouth is round: the inner edges are cut back.
    up = 2.0 * k / CELLS_UP - 1.0
    back = 0.15 * HEIGHT * up**4
    radius += back * (1.0 - i / CELLS_OUT) ** 2
    points.append((radius * math.cos(angle), radius * math.sin(angle), 0.5 * HEIGHT * up))


def node(i, j, k):
    return 1 + i + (CELLS_OUT + 1) * (j % CELLS_ROUND + CELLS_ROUND * k)


tetrahedra = [
    (2 if i + 1 == CELLS_OUT else 1, corners)
    for k, j, i in itertools.product(range(CELLS_UP), range(CELLS_ROUND), range(CELLS_OUT))
    for corners in tetrahedra_of_brick(node, i, j, k)
]
write_gmsh(points, tetrahedra)
