#!/usr/bin/env python3
# Writes the closed surface of scenarios/kidney_biopsy.toml, as ASCII STL: a round rod against x with
# a rounded tip.
#   python3 biopsy_core.py > biopsy_core.stl
# SPDX-License-Identifier: LGPL-3.0-or-later
import math

RADIUS, LENGTH = 0.004, 0.040  # m
TIP = (-0.008, 0.0003, 0.0002)
AROUND, TIP_RINGS = 32, 6


def ring(x, radius):
    turns = [2 * math.pi * k / AROUND for k in range(AROUND)]
    return [point(x, radius * math.cos(t), radius * math.sin(t)) for t in turns]


def point(x, y, z):  # x from the tip on; a turn about z keeps the triangles facing outwards
    return (TIP[0] - x, TIP[1] - y, TIP[2] + z)


tip, far_end = point(0, 0, 0), point(LENGTH, 0, 0)
rings = []
for k in range(1, TIP_RINGS + 1):
    angle = 0.5 * math.pi * k / TIP_RINGS
    rings.append(ring(RADIUS * (1 - math.cos(angle)), RADIUS * math.sin(angle)))
rings.append(ring(LENGTH, RADIUS))

triangles = []
for k in range(AROUND):
    next_k = (k + 1) % AROUND
    triangles.append((tip, rings[0][next_k], rings[0][k]))
    triangles.append((far_end, rings[-1][k], rings[-1][next_k]))
    for a, b in zip(rings, rings[1:]):
        triangles.append((a[k], a[next_k], b[next_k]))
        triangles.append((a[k], b[next_k], b[k]))

print("solid biopsy_core")
for triangle in triangles:
    print("facet normal 0 0 0\nouter loop")
    for x, y, z in triangle:
        print(f"vertex {x:.9g} {y:.9g} {z:.9g}")
    print("endloop\nendfacet")
print("endsolid biopsy_core")
