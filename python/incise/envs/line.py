"""Curves in a plane that a blade is to follow, and how far a cut is from them."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def resampled(points: npt.ArrayLike, num: int) -> Floats:
    """Return num points evenly along a line of points (N, 2), m."""
    line = np.asarray(points, float)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
        raise ValueError("a line is an array of at least two points (x, y)")
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    if not np.all(steps > 0):
        raise ValueError("neighbours on a line must differ")
    along = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.linspace(0.0, along[-1], num)
    return np.stack([np.interp(at, along, line[:, 0]), np.interp(at, along, line[:, 1])], axis=1)


def distances(points: Floats, line: Floats) -> Floats:
    """Return the distance of points (N, 2) from a line of points (M, 2). Shape (N,), m."""
    start, way = line[:-1], np.diff(line, axis=0)
    offset = points[:, None] - start
    share = np.einsum("nmi,mi->nm", offset, way) / np.einsum("mi,mi->m", way, way)
    share = np.minimum(np.maximum(share, 0.0), 1.0)  # np.clip is slower for few
    rest = offset - share[..., None] * way
    nearest: Floats = np.sqrt(np.einsum("nmi,nmi->nm", rest, rest).min(axis=1))
    return nearest


def is_inside(points: Floats, corners: Floats) -> npt.NDArray[np.bool_]:
    """Return whether points (N, 2) lie in the polygon with these corners (M, 2). Shape (N,)."""
    x, y = points[:, 0][:, None], points[:, 1][:, None]
    x0, y0 = corners[:, 0], corners[:, 1]
    x1, y1 = np.roll(x0, -1), np.roll(y0, -1)
    height = np.where(y1 == y0, 1.0, y1 - y0)
    crosses = ((y0 > y) != (y1 > y)) & (x < (x1 - x0) * (y - y0) / height + x0)
    odd: npt.NDArray[np.bool_] = crosses.sum(axis=1) % 2 == 1
    return odd
