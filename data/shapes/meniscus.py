#!/usr/bin/env python3
# Writes a label image of the meniscus of scenarios/meniscus.toml, as NRRD in millimetres:
#   python3 meniscus.py > meniscus.nrrd && incise mesh meniscus.nrrd ../meniscus.vtu --hex --scale 0.001
# A C about the axis z, open towards -x. Its section is a wedge: high at the outer rim, thin at the inner one.
# Label 1 is the meniscus.
# SPDX-License-Identifier: LGPL-3.0-or-later
import itertools
import math

VOXEL = 1.0  # mm
INNER, OUTER = 9.5, 20.0  # mm, radii
LOW, HIGH = 1.5, 7.5  # mm, heights at the inner and the outer rim
OPENING = 0.7  # rad, from -x to each horn

size = [2 * math.ceil(OUTER / VOXEL), 2 * math.ceil(OUTER / VOXEL), math.ceil(HIGH / VOXEL)]
print("NRRD0004\ntype: uint8\ndimension: 3\nsizes:", *size)
print("encoding: ascii\nspace: left-posterior-superior")
print("space directions:", f"({VOXEL},0,0) (0,{VOXEL},0) (0,0,{VOXEL})")
print("space origin:", f"({0.5 * VOXEL * (1 - size[0])},{0.5 * VOXEL * (1 - size[1])},{0.5 * VOXEL})")
print()
for k, j in itertools.product(range(size[2]), range(size[1])):
    row = []
    for i in range(size[0]):
        x, y = ((n + 0.5 - 0.5 * m) * VOXEL for n, m in zip((i, j), size))
        radius, height = math.hypot(x, y), (k + 0.5) * VOXEL
        top = LOW + (HIGH - LOW) * (radius - INNER) / (OUTER - INNER)
        is_open = abs(math.atan2(y, -x)) < OPENING
        row.append(int(INNER < radius < OUTER and height < top and not is_open))
    print(*row)
