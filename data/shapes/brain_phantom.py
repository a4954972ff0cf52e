#!/usr/bin/env python3
# Writes a closed surface of the phantom of scenarios/brain_tumour.toml, as OFF in millimetres:
#   python3 brain_phantom.py brain > brain.off && python3 brain_phantom.py tumour > tumour.off
#   incise mesh brain.off tumour.off ../brain_phantom.vtu --size 0.0065 --size-surface 0.0036 --scale 0.001
# Region 1 of the mesh is the brain, 2 the tumour.
# SPDX-License-Identifier: LGPL-3.0-or-later
import math
import sys

# Centre and half axes, mm: a part of a brain as large as a fist, and a tumour below its top.
ELLIPSOIDS = {
    "brain": ((0, 0, 0), (38, 30, 25)),
    "tumour": ((6, -2, 11), (8, 7, 6.5)),
}
RINGS, STEPS = 24, 48  # from pole to pole, and round the axis

centre, half_axes = ELLIPSOIDS[sys.argv[1]]
points = [(0, 0, -1)]
for i in range(1, RINGS):
    angle = math.pi * i / RINGS
    for j in range(STEPS):
        turn = 2 * math.pi * j / STEPS
        across = math.sin(angle)
        points.append((across * math.cos(turn), across * math.sin(turn), -math.cos(angle)))
points.append((0, 0, 1))


def node(i, j):
    """Returns the number of a point: ring i from the lower pole, step j round the axis."""
    if i == 0:
        return 0
    return len(points) - 1 if i == RINGS else 1 + (i - 1) * STEPS + j % STEPS


triangles = []
for i in range(RINGS):
    for j in range(STEPS):
        if i > 0:
            triangles.append((node(i, j), node(i, j + 1), node(i + 1, j)))
        if i < RINGS - 1:
            triangles.append((node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)))

print("OFF")
print(len(points), len(triangles), 0)
for point in points:
    print(*(f"{c + h * x:.5g}" for c, h, x in zip(centre, half_axes, point)))
for triangle in triangles:
    print(3, *triangle)
