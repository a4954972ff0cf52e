"""A small software renderer: triangles with a depth buffer, in numpy."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class Camera:
    """A pinhole camera."""

    def __init__(self, position: npt.ArrayLike, target: npt.ArrayLike,
                 shape: tuple[int, int], field_of_view: float = 0.7) -> None:
        """position, target: shape (3,), m. The picture has z upwards.

        shape: height and width, pixels.  field_of_view: vertical, rad.
        """
        self.position = np.asarray(position, float)
        self.shape = shape
        self.focal_length = 0.5 * shape[0] / np.tan(0.5 * field_of_view)
        forward = np.asarray(target, float) - self.position
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        self.axes = np.stack([right, np.cross(forward, right), forward])

    def project(self, points: Floats) -> Floats:
        """Return pixel column, pixel row and distance, shape (N, 3), of points (N, 3), m."""
        seen = (points - self.position) @ self.axes.T
        depth = np.maximum(seen[:, 2], 1e-6)
        height, width = self.shape
        return np.stack([0.5 * width + self.focal_length * seen[:, 0] / depth,
                         0.5 * height + self.focal_length * seen[:, 1] / depth, depth], axis=1)


LIGHT = np.array([0.3, -0.45, 0.84])
BACKGROUND = (222, 228, 233)


def draw(camera: Camera, points: Floats, triangles: Integers, colors: npt.NDArray[np.float64],
         marks: tuple[tuple[Floats, tuple[int, int, int]], ...] = ()) -> npt.NDArray[np.uint8]:
    """Return a picture, uint8, shape (height, width, 3).

    points: shape (N, 3), m.  triangles: rows of points, shape (T, 3); both sides are seen.
    colors: one a triangle, shape (T, 3), 0 to 255.
    marks: points (M, 3), each a pixel with a colour, hidden by triangles that are 2 % nearer.
    """
    height, width = camera.shape
    picture = np.empty((height * width, 3), np.uint8)
    picture[:] = BACKGROUND
    seen = camera.project(points)
    corners = seen[triangles]
    low = np.floor(corners[:, :, :2].min(axis=1) + 0.5).astype(np.int64)
    high = np.floor(corners[:, :, :2].max(axis=1) - 0.5).astype(np.int64) + 1
    np.clip(low, 0, [width, height], out=low)
    np.clip(high, 0, [width, height], out=high)
    size = np.maximum(high - low, 0)
    counts = size[:, 0] * size[:, 1]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    # Twice the area of the triangle in the picture; a triangle that is seen edge-on has no pixels.
    ab, ac = b - a, c - a
    area: Floats = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    counts[np.abs(area) < 1e-9] = 0
    used = np.flatnonzero(counts)
    depth = np.full(height * width, np.inf)
    if used.size:
        counts = counts[used]
        # Each pixel of the box round each triangle, one after the other.
        tri = np.repeat(used, counts)
        offset = np.arange(tri.size) - np.repeat(np.cumsum(counts) - counts, counts)
        columns = size[tri, 0]
        row = offset // columns
        x = low[tri, 0] + (offset - row * columns)
        y = low[tri, 1] + row
        # Barycentric coordinates are linear in the picture: value = u . (x, y, 1).
        inverse = 1.0 / area[used]
        weights = np.empty((len(triangles), 2, 3))
        a, b, c = a[used], b[used], c[used]
        weights[used, 0] = (np.stack([c[:, 1] - a[:, 1], a[:, 0] - c[:, 0],
                                      c[:, 0] * a[:, 1] - a[:, 0] * c[:, 1]], 1)
                            * inverse[:, None])
        weights[used, 1] = (np.stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0],
                                      a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]], 1)
                            * inverse[:, None])
        w = weights[tri]
        middle_x, middle_y = x + 0.5, y + 0.5
        v1 = w[:, 0, 0] * middle_x + w[:, 0, 1] * middle_y + w[:, 0, 2]
        v2 = w[:, 1, 0] * middle_x + w[:, 1, 1] * middle_y + w[:, 1, 2]
        inside = np.flatnonzero((v1 >= 0) & (v2 >= 0) & (v1 + v2 <= 1))
        tri, v1, v2 = tri[inside], v1[inside], v2[inside]
        pixel = y[inside] * width + x[inside]
        z = corners[:, :, 2]
        # 1/depth is linear in the picture.
        near = 1.0 / z
        value = near[tri, 0] + v1 * (near[tri, 1] - near[tri, 0]) + v2 * (near[tri, 2]
                                                                          - near[tri, 0])
        # Of equal indices the last one stays: the nearest comes last, and at equal depth the
        # triangle with the higher number, as the sort is stable.
        order = np.argsort(value, kind="stable")
        winner = np.full(height * width, -1, np.int64)
        winner[pixel[order]] = order
        hit = np.flatnonzero(winner >= 0)
        front = winner[hit]
        depth[hit] = 1.0 / value[front]
        normals = np.cross(points[triangles[:, 1]] - points[triangles[:, 0]],
                           points[triangles[:, 2]] - points[triangles[:, 0]])
        length = np.linalg.norm(normals, axis=1)
        facing = np.abs(normals @ LIGHT) / np.maximum(length, 1e-30)
        shaded = np.minimum(colors * (0.45 + 0.55 * facing)[:, None], 255).astype(np.uint8)
        picture[hit] = shaded[tri[front]]
    for mark_points, color in marks:
        if len(mark_points) == 0:
            continue
        spots = camera.project(mark_points)
        x, y = np.floor(spots[:, 0]).astype(np.int64), np.floor(spots[:, 1]).astype(np.int64)
        is_in = np.flatnonzero((x >= 0) & (x < width) & (y >= 0) & (y < height))
        pixel = y[is_in] * width + x[is_in]
        picture[pixel[spots[is_in, 2] <= 1.02 * depth[pixel]]] = color
    return picture.reshape(height, width, 3)


def rod(start: npt.ArrayLike, end: npt.ArrayLike, radius: float,
        sides: int = 8) -> tuple[Floats, Integers]:
    """Return points (2 sides + 2, 3) and triangles of a rod between two points, m."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    axis = (end - start) / max(float(np.linalg.norm(end - start)), 1e-12)
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = radius * (np.cos(angle)[:, None] * across
                     + np.sin(angle)[:, None] * np.cross(axis, across))
    points = np.concatenate([start + ring, end + ring, [start], [end]])
    i = np.arange(sides)
    j = (i + 1) % sides
    triangles = np.concatenate([np.stack([i, j, i + sides], 1),
                                np.stack([j, j + sides, i + sides], 1),
                                np.stack([i, j, np.full(sides, 2 * sides)], 1),
                                np.stack([i + sides, j + sides, np.full(sides, 2 * sides + 1)], 1)])
    return points, triangles
