#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Tells whether a block that slides on a plane flutters: the eigenvalue of its linear model that
grows fastest. An independent model of linear tetrahedra; needs numpy.

    friction_flutter.py NX NY NZ DEGREES SPEED   # cells of the block, slope, speed of sliding, m/s

The bottom keeps to the plane. A node there bears the normal force N, and friction mu N against its
velocity. Across the slide that is a damping mu N / SPEED. The frequency is found with the modulus
that the viscous block has at it. Sources: Martins, Guimaraes, Faria 1995; Nguyen 2003.
"""
import itertools
import sys
from math import cos, pi, radians, sin

import numpy as np

SIZE, YOUNG, POISSON, DENSITY = (0.04, 0.04, 0.02), 1e5, 0.3, 1000.0
FRICTION, ALPHA, TAU, GRAVITY = 0.4, 0.4, 0.003, 9.81


def block(cells):
    """Nodes, stiffness and lumped masses of a box, six tetrahedra a brick."""
    lam = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    shear = YOUNG / 2 / (1 + POISSON)
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lam
    grid = [n + 1 for n in cells]
    nodes = np.array(list(itertools.product(*map(range, grid)))) * np.array(SIZE) / cells
    stiffness, mass = np.zeros((3 * len(nodes),) * 2), np.zeros(len(nodes))
    for brick in itertools.product(*map(range, cells)):
        for axes in itertools.permutations(range(3)):
            corner, corners = list(brick), [np.ravel_multi_index(brick, grid)]
            for axis in axes:
                corner[axis] += 1
                corners.append(np.ravel_multi_index(corner, grid))
            affine = np.hstack([np.ones((4, 1)), nodes[corners]])
            volume, gradients = abs(np.linalg.det(affine)) / 6, np.linalg.inv(affine)[1:].T
            strain = np.hstack([[[a, 0, 0], [0, b, 0], [0, 0, c], [b, a, 0], [0, c, b], [c, 0, a]]
                                for a, b, c in gradients])
            at = np.array([3 * n + c for n in corners for c in range(3)])
            stiffness[np.ix_(at, at)] += volume * strain.T @ law @ strain
            mass[corners] += DENSITY * volume / 4
    return nodes, stiffness, mass


def growth(cells, degrees, speed):
    nodes, stiffness, mass = block(cells)
    base = np.flatnonzero(nodes[:, 2] == 0)
    rubbing = stiffness.copy()
    rubbing[3 * base] += FRICTION * stiffness[3 * base + 2]
    free = np.ones(3 * len(nodes), bool)
    free[3 * base + 2] = False
    # Steady sliding: its acceleration, and the normal forces.
    weight = np.outer(mass, [FRICTION * cos(radians(degrees)), 0, -cos(radians(degrees))]).ravel()
    weight *= GRAVITY
    held = free.copy()
    held[[0, 1, 3 * base[-1] + 1]] = False
    load = weight.copy()
    load[3 * base] += FRICTION * weight[3 * base + 2]
    u = np.zeros(3 * len(nodes))
    u[held] = np.linalg.solve((1 - ALPHA) * rubbing[np.ix_(held, held)], load[held])
    normal = ((1 - ALPHA) * stiffness @ u - weight)[3 * base + 2]
    damping = np.zeros(3 * len(nodes))
    damping[3 * base + 1] = FRICTION * normal / speed
    masses = np.repeat(mass, 3)[free]
    a, c = rubbing[np.ix_(free, free)] / masses[:, None], np.diag(damping[free] / masses)
    zero, one = np.zeros_like(a), np.eye(len(a))
    s = 15 + 2j * pi * 103
    for _ in range(12):
        modulus = 1 - ALPHA + ALPHA * s * TAU / (1 + s * TAU)
        values = np.linalg.eigvals(np.block([[zero, one], [-modulus * a, -c.astype(complex)]]))
        values = values[abs(values - s) < 2 * pi * 12]
        s = values[np.argmax(values.real)]
    return s.real, s.imag / 2 / pi


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    rate, frequency = growth([int(n) for n in sys.argv[1:4]], float(sys.argv[4]), float(sys.argv[5]))
    print(f"{frequency:.1f} Hz, growth {rate:+.1f} 1/s")
