"""The surface that a blade is to cut, and how well a cut matches it."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .._renderer import cross
from . import line

Floats = npt.NDArray[np.float64]


def are_near(points: Floats, triangles: Floats, reach: float) -> npt.NDArray[np.bool_]:
    """Return which points (N, 3) are within reach, m, of some of the triangles (T, 3, 3)."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    normals = cross(sides[:, 0], sides[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    inwards = cross(normals[:, None], sides)
    offset = points[:, None, None] - triangles
    share = np.einsum("ntec,tec->nte", offset, sides)
    share /= np.maximum(np.einsum("tec,tec->te", sides, sides), 1e-30)
    rest = offset - np.minimum(np.maximum(share, 0.0), 1.0)[..., None] * sides
    is_near = (np.einsum("ntec,ntec->nte", rest, rest) <= reach ** 2).any(axis=2)
    # Above the triangle, the distance is that from its plane.
    is_above = (np.einsum("ntec,tec->nte", offset, inwards) >= 0.0).all(axis=2)
    height = np.einsum("ntc,tc->nt", offset[:, :, 0], normals)
    is_near |= is_above & (np.abs(height) <= reach)
    near: npt.NDArray[np.bool_] = is_near.any(axis=1)
    return near


class Target:
    """An upright surface below a line, and the faces of a cut that has been made so far.

    mean_distance, max_distance: of the cut faces from the surface, m; the mean is over their area.
        Infinite while there is no cut.
    excess_depth: how far the cut goes below the surface at most, m.
    coverage: share of the surface that has a cut within reach. It never falls.
    """

    def __init__(self, path: Floats, size: tuple[float, ...], depth: float, num_levels: int,
                 reach: float) -> None:
        """path: points of the line, evenly, shape (M, 2), m.

        size: of the block, m. What the line has outside of it is no part of the surface.
        depth: of the surface, from the top of the block down, m.
        num_levels: points that stand for the surface below each point of the line.
        reach: how far a cut may be from what it covers, m.
        """
        self._path = path
        self._bottom = size[2] - depth
        self._reach = reach
        tiny = 1e-9
        on_block = path[((path >= -tiny) & (path <= np.array(size[:2]) + tiny)).all(axis=1)]
        levels = self._bottom + depth * (np.arange(num_levels) + 0.5) / num_levels
        self._points = np.column_stack([np.repeat(on_block, num_levels, axis=0),
                                        np.tile(levels, len(on_block))])
        self._num_points = max(1, len(self._points))
        # Known faces: their keys in increasing order, and how far each is from the surface.
        self._keys = np.zeros(0, np.int64)
        self._away = np.zeros(0)
        self.mean_distance = self.max_distance = math.inf
        self.excess_depth = 0.0
        self.coverage = 0.0

    def measure(self, faces: Floats) -> None:
        """Measure all cut faces: triangles at rest, shape (T, 3, 3), m."""
        if not len(faces):
            return
        middle = faces.mean(axis=1)
        # A face is known by its centre, as an edit may give other rows to its nodes.
        places = np.rint(middle * 1e9).astype(np.int64)
        keys = places @ np.array([1, 1_000_003, 998_244_353])
        order = np.argsort(keys, kind="stable")
        faces, middle, keys = faces[order], middle[order], keys[order]
        row = np.searchsorted(self._keys, keys)
        is_new = np.ones(len(keys), bool)
        is_in = row < len(self._keys)
        is_new[is_in] = self._keys[row[is_in]] != keys[is_in]
        away = np.empty(len(keys))
        away[~is_new] = self._away[row[~is_new]]
        away[is_new] = np.hypot(line.distances(middle[is_new, :2], self._path),
                                np.maximum(self._bottom - middle[is_new, 2], 0.0))
        self._keys, self._away = keys, away
        sides = faces[:, 1:] - faces[:, :1]
        area = np.linalg.norm(cross(sides[:, 0], sides[:, 1]), axis=1)
        self.mean_distance = float(away @ area / max(float(area.sum()), 1e-30))
        self.max_distance = float(away.max())
        self.excess_depth = max(0.0, self._bottom - float(faces[:, :, 2].min()))
        # Most faces are there twice, one on each side of the cut.
        is_new[1:] &= keys[1:] != keys[:-1]
        self._cover(faces[is_new])

    def _cover(self, faces: Floats) -> None:
        """Take away the points of the surface that have one of these new faces within reach."""
        if not len(faces):
            return
        low = faces.min(axis=(0, 1)) - self._reach
        high = faces.max(axis=(0, 1)) + self._reach
        tried = np.flatnonzero(((self._points >= low) & (self._points <= high)).all(axis=1))
        if tried.size:
            near = are_near(self._points[tried], faces, self._reach)
            self._points = np.delete(self._points, tried[near], axis=0)
            self.coverage = 1.0 - len(self._points) / self._num_points
