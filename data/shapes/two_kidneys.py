#!/usr/bin/env python3
# Writes the two kidneys of scenarios/kidneys_on_table.toml, as Gmsh 2.2: one lies on a table, the
# other above one of its ends, a little tilted.
#   incise convert ../kidney.vtu kidney.msh
#   python3 two_kidneys.py < kidney.msh > two_kidneys.msh && incise convert two_kidneys.msh ../two_kidneys.vtu
# SPDX-License-Identifier: LGPL-3.0-or-later
import math
import sys

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


print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes")
print(2 * len(points))
for copy, place in enumerate((lower, upper)):
    for n, x in enumerate(points):
        print(n + 1 + copy * len(points), *(f"{c:.9g}" for c in place(*x)))
print("$EndNodes\n$Elements")
print(2 * len(cells))
for copy in range(2):
    for e, cell in enumerate(cells):
        corners = [n + copy * len(points) for n in cell[3 + cell[2] :]]
        region = cell[3] + 10 * copy
        print(e + 1 + copy * len(cells), 4, 2, region, region, *corners)
print("$EndElements")
