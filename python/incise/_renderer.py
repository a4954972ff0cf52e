"""A small software renderer: triangles and lines with a depth buffer, in numpy."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products of vectors (..., 3), as np.cross, which is slow for few."""
    product: Floats = (a[..., [1, 2, 0]] * b[..., [2, 0, 1]]
                       - a[..., [2, 0, 1]] * b[..., [1, 2, 0]])
    return product


class Camera:
    """A pinhole camera."""

    def __init__(self, position: npt.ArrayLike, target: npt.ArrayLike,
                 shape: tuple[int, int], field_of_view: float = 0.7) -> None:
        """position, target: shape (3,), m. The picture has z upwards, or y in a view along z.

        shape: height and width, pixels.  field_of_view: vertical, rad.
        """
        self.position = np.asarray(position, float)
        self.shape = shape
        self.focal_length = 0.5 * shape[0] / np.tan(0.5 * field_of_view)
        forward = np.asarray(target, float) - self.position
        self.near = NEAR * float(np.linalg.norm(forward))
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        if np.linalg.norm(right) < 1e-6:
            right = np.cross(forward, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        self.axes = np.stack([right, np.cross(forward, right), forward])

    def project(self, points: Floats) -> Floats:
        """Return pixel column, pixel row and distance, shape (N, 3), of points (N, 3), m."""
        return self._on_picture((points - self.position) @ self.axes.T)

    def _on_picture(self, seen: Floats) -> Floats:
        """Return the same of points (..., 3) in the frame of the camera."""
        depth = np.maximum(seen[..., 2], self.near)
        height, width = self.shape
        return np.stack([0.5 * width + self.focal_length * seen[..., 0] / depth,
                         0.5 * height + self.focal_length * seen[..., 1] / depth, depth], axis=-1)

    def project_faces(self, points: Floats, faces: Integers) -> tuple[Floats, Integers]:
        """Return the parts of triangles in front of the camera, as project(), and their rows.

        faces: rows of points, shape (T, 3). The parts have the shape (S, 3, 3).
        """
        seen = (points - self.position) @ self.axes.T
        rows = np.arange(len(faces))
        is_far = (seen[:, 2] > self.near)[faces]
        if is_far.all():
            return self._on_picture(seen)[faces], rows
        whole = is_far.all(axis=1)
        parts, owners = [seen[faces[whole]]], [rows[whole]]
        for i in np.flatnonzero(is_far.any(axis=1) & ~whole):
            corners = seen[faces[i]]
            polygon: list[Floats] = []
            for a, b in zip(corners, np.roll(corners, -1, axis=0)):
                if a[2] > self.near:
                    polygon.append(a)
                if (a[2] > self.near) != (b[2] > self.near):
                    polygon.append(a + (self.near - a[2]) / (b[2] - a[2]) * (b - a))
            fan = [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
            parts.append(np.array(fan))
            owners.append(np.full(len(fan), i))
        return self._on_picture(np.concatenate(parts)), np.concatenate(owners)

    def in_front(self, segments: Floats) -> Floats:
        """Return the parts of segments (M, 2, 3), m, that are in front of the camera."""
        depth = (segments - self.position) @ self.axes[2]
        is_far = depth > self.near
        if is_far.all():
            return segments
        kept = segments[is_far.any(axis=1)].copy()
        depth, is_far = depth[is_far.any(axis=1)], is_far[is_far.any(axis=1)]
        for end in (0, 1):
            cut = np.flatnonzero(~is_far[:, end])
            part = (self.near - depth[cut, end]) / (depth[cut, 1 - end] - depth[cut, end])
            kept[cut, end] += part[:, None] * (kept[cut, 1 - end] - kept[cut, end])
        return kept


NEAR = 1e-3  # what is nearer to the camera is not seen, as a part of the distance of its target
LIGHT = np.array([0.3, -0.45, 0.84])
BACKGROUND = (222, 228, 233)
MIN_LINE_WIDTH = 2.0  # pixels
LINE_REACH = 1.01     # a line is hidden by what is nearer by more than this factor
CHUNK = 1 << 14       # pixels that are drawn at once: larger arrays are slower

# Until a large block is freed, the allocator of glibc gives each freed piece of memory back to the
# system, and small pictures take three times as long.
np.empty(1 << 20)

# Lines on a picture: segments, shape (M, 2, 3), m; their width, m; their colour.
Lines = tuple[Floats, float, tuple[int, int, int]]


def pixels(corners: Floats, shape: tuple[int, int]) -> Iterator[tuple[Integers, Integers, Floats]]:
    """Yield the pixels of triangles in pieces: rows of triangles, pixels, and 1 / distance.

    Pixels are numbered row by row. Each has the point of the triangle at its centre.

    corners: pixel column, pixel row and 1 / distance of each corner, shape (T, 3, 3).
    shape: height and width of the picture, pixels.
    """
    height, width = shape
    column, row, near = corners[:, :, 0], corners[:, :, 1], corners[:, :, 2]
    ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # Twice the area of the triangle in the picture; a triangle that is seen edge-on has no pixels.
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    top = np.ceil(np.clip(row.min(axis=1) - 0.5, 0, height)).astype(np.int64)
    bottom = np.floor(np.clip(row.max(axis=1) + 0.5, 0, height)).astype(np.int64)
    is_in = ((np.abs(area) > 1e-9) & (bottom > top)
             & (column.max(axis=1) > 0) & (column.min(axis=1) < width))
    used = np.flatnonzero(is_in)
    # A span is one row of pixels of one triangle.
    counts = bottom[used] - top[used]
    which = np.repeat(np.arange(len(used)), counts)
    span_row = np.arange(len(which)) + (top[used] - np.cumsum(counts) + counts)[which]
    y = span_row + 0.5
    # Inside is where turn * (x - at) >= 0 for each side; at is where the side crosses the row.
    first, last = np.zeros(len(y)), np.full(len(y), float(width))
    sign = np.sign(area[used])
    with np.errstate(divide="ignore", invalid="ignore"):
        for i, j in ((0, 1), (1, 2), (2, 0)):
            x0, y0 = column[used, i], row[used, i]
            rise = row[used, j] - y0
            slope = (column[used, j] - x0) / rise
            at = (x0 - slope * y0)[which] + slope[which] * y
            turn = (-sign * rise)[which]
            np.fmax(first, np.where(turn > 0, at, -np.inf), out=first)
            np.fmin(last, np.where(turn < 0, at, np.inf), out=last)
    # The small number leaves no gap between neighbours.
    start = np.ceil(first - 0.5 - 1e-9).astype(np.int64)
    counts = np.minimum(np.floor(last - 0.5 + 1e-9).astype(np.int64) + 1, width) - start
    kept = np.flatnonzero(counts > 0)
    counts, start, which, y = counts[kept], start[kept], which[kept], y[kept]
    # 1 / distance is linear in the picture.
    along = (ab[used, 2] * ac[used, 1] - ac[used, 2] * ab[used, 1]) / area[used]
    down = (ac[used, 2] * ab[used, 0] - ab[used, 2] * ac[used, 0]) / area[used]
    change = along[which]
    value = (near[used, 0][which] + change * (start + 0.5 - column[used, 0][which])
             + down[which] * (y - row[used, 0][which]))
    begin = span_row[kept] * width + start
    triangle = used[which]
    ends = np.cumsum(counts)
    i = 0
    while i < len(counts):
        before = ends[i] - counts[i]
        j = max(i + 1, int(np.searchsorted(ends, before + CHUNK, side="right")))
        span = np.repeat(np.arange(i, j), counts[i:j])
        step = np.arange(len(span)) - (ends[i:j] - counts[i:j] - before)[span - i]
        yield triangle[span], begin[span] + step, value[span] + change[span] * step
        i = j


def ribbons(camera: Camera, segments: Floats, width: float) -> Floats:
    """Return flat triangles, as those of pixels(), that stand for lines. Shape (6 M, 3, 3).

    segments: ends of each, shape (M, 2, 3), m.  width: m, drawn as MIN_LINE_WIDTH at least.
    """
    ends = camera.project(segments.reshape(-1, 3)).reshape(-1, 2, 3)
    near = 1.0 / ends[:, :, 2]
    half = np.maximum(0.5 * MIN_LINE_WIDTH, 0.5 * width * camera.focal_length * near)
    way = ends[:, 1, :2] - ends[:, 0, :2]
    length = np.linalg.norm(way, axis=1)
    is_dot = length < 1e-6
    way[is_dot] = 1.0, 0.0
    way /= np.where(is_dot, 1.0, length)[:, None]
    left = np.stack([-way[:, 1], way[:, 0]], axis=1)
    shape = np.empty((len(segments), 8, 3))
    for i in range(8):
        # A round end is half an octagon, so that lines join at any angle.
        angle = (i + 0.5) * np.pi / 4
        end = 1 if i in (0, 1, 6, 7) else 0
        offset = np.cos(angle) * way + np.sin(angle) * left
        shape[:, i, :2] = ends[:, end, :2] + half[:, end, None] / np.cos(np.pi / 8) * offset
        shape[:, i, 2] = near[:, end]
    return shape[:, [[0, i, i + 1] for i in range(1, 7)]].reshape(-1, 3, 3)


def trace(camera: Camera, points: Floats, triangles: Integers,
          lines: Sequence[Lines] = ()) -> tuple[npt.NDArray[np.int32], Floats]:
    """Return what is in front at each pixel, row by row: its number, and 1 / distance.

    Number 0 is nothing, 1 + t triangle t, and 1 + T + i the lines i.

    points: shape (N, 3), m.  triangles: rows of points, shape (T, 3); both sides are seen.
    lines: on surfaces, each over those before it. Triangles that are 1 % nearer hide them. A
        segment of no length is a dot.
    """
    height, width = camera.shape
    seen, rows = camera.project_faces(points, triangles)
    seen[:, :, 2] = 1.0 / seen[:, :, 2]
    front = np.zeros(height * width)
    owner = np.zeros(height * width, np.int32)
    for part, pixel, near in pixels(seen, camera.shape):
        triangle = rows[part]
        left = np.flatnonzero(near >= front[pixel])
        triangle, pixel, near = triangle[left] + 1, pixel[left], near[left]
        # Of equal pixels the last one is written. So those that are nearer come again.
        while left.size:
            front[pixel], owner[pixel] = near, triangle
            left = np.flatnonzero(near > front[pixel])
            triangle, pixel, near = triangle[left], pixel[left], near[left]
    of_lines = front.copy()
    for i, (segments, line_width, _) in enumerate(lines):
        shown = ribbons(camera, camera.in_front(segments), line_width)
        for _, pixel, near in pixels(shown, camera.shape):
            is_seen = LINE_REACH * near >= front[pixel]
            owner[pixel[is_seen]] = 1 + len(triangles) + i
            of_lines[pixel[is_seen]] = near[is_seen]
    return owner, of_lines


def shade(owner: npt.NDArray[np.int32], points: Floats, triangles: Integers, colors: Floats,
          lines: Sequence[Lines] = ()) -> npt.NDArray[np.uint8]:
    """Return the colours of what trace() has found, uint8, shape (len(owner), 3).

    colors: one a triangle, shape (T, 3), 0 to 255.
    """
    corners = points[triangles]
    normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ LIGHT) / np.maximum(length, 1e-30)
    paint = np.empty((1 + len(triangles) + len(lines), 3), np.uint8)
    paint[0] = BACKGROUND
    paint[1:1 + len(triangles)] = np.minimum(colors * (0.45 + 0.55 * facing)[:, None], 255)
    for i, (_, _, color) in enumerate(lines):
        paint[1 + len(triangles) + i] = color
    shaded: npt.NDArray[np.uint8] = paint[owner]
    return shaded


def draw(camera: Camera, points: Floats, triangles: Integers, colors: Floats,
         lines: Sequence[Lines] = ()) -> npt.NDArray[np.uint8]:
    """Return a picture, uint8, shape (height, width, 3): see trace() and shade()."""
    owner, _ = trace(camera, points, triangles, lines)
    return shade(owner, points, triangles, colors, lines).reshape(*camera.shape, 3)


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
