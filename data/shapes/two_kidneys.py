#!/usr/bin/env python3
# Writes the two kidneys of scenarios/kidneys_on_table.toml, as Gmsh 2.2: one lies on a table, the
# other above one of its ends, a little tilted.
#   incise convert ../kidney.vtu kidney.msh
#   python3 two_kidneys.py < kidney.msh > two_kidneys.msh && incise convert two_kidneys.msh ../two_kidneys.vtu
# SPDX-License-Identifier: LGPL-3.0-or-later
import math
import sys

from bricks import write_gmsh

lines = iter(sys.stdin.read().split("\n"))
while next(lines) != "$Nodes":
    pass
points = [tuple(map(float, next(lines).split()[1:4])) for _ in range(int(next(lines)))]
while next(lines) != "$Elements":
    pass
cells = [list(map(int, next(lines).split())) for _ in range(int(next(lines)))]

TILT = 0.25  # rad, of the upper one


def lower(x, y, z):  # its long axis z along x, its thickness y upwards
    return (z, x, y + 0.0215)


def upper(x, y, z):  # its long axis along y, across the end of the other
    along, across, up = z, -x, y
    return (
        across + 0.035,
        along * math.cos(TILT) - up * math.sin(TILT) + 0.030,
        along * math.sin(TILT) + up * math.cos(TILT) + 0.065,
    )


both_points, tetrahedra = [], []
for copy, place in enumerate((lower, upper)):
    both_points += [place(*x) for x in points]
    for cell in cells:
        corners = [n + copy * len(points) for n in cell[3 + cell[2] :]]
        tetrahedra.append((cell[3] + 10 * copy, corners))
write_gmsh(both_points, tetrahedra)
