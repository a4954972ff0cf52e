"""Pictures of a World: see World.render()."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

import incise

from . import _renderer as renderer

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

CHANNELS = ("rgb", "depth", "segmentation")
VIEW_KEYS = ("position", "target", "field_of_view")
MOST_PIXELS = 8192

# Of regions, in their order.
TISSUE = np.array([[216.0, 160.0, 140.0], [236.0, 214.0, 150.0], [150.0, 175.0, 215.0],
                   [170.0, 205.0, 160.0], [205.0, 165.0, 205.0], [190.0, 190.0, 190.0]])
CUT = (200.0, 55.0, 50.0)
TOOL = (130.0, 140.0, 150.0)
EDGE = (40, 90, 60)


def _vector(name: str, value: Any) -> Floats:
    try:
        vector = np.asarray(value, float)
    except (TypeError, ValueError):
        vector = np.empty(0)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ValueError(f"{name} is {value!r}: it must be three numbers")
    return vector


def _camera(points: Floats, shape: tuple[int, int], view: Any) -> renderer.Camera:
    """Return the camera. Without a position, the whole of the points is in the picture."""
    low, high = points.min(axis=0), points.max(axis=0)
    target, field = 0.5 * (low + high), 0.7
    if isinstance(view, Mapping):
        for key in view:
            if key not in VIEW_KEYS:
                raise ValueError(f"view has no key {key!r}: its keys are {', '.join(VIEW_KEYS)}")
        if "position" not in view:
            raise ValueError("view has no position: give it, or a direction such as (-0.5, -1, "
                             "0.5)")
        target = _vector("view['target']", view.get("target", target))
        position = _vector("view['position']", view["position"])
        given = view.get("field_of_view", field)
        try:
            field = float(given)
        except (TypeError, ValueError):
            field = np.nan
        if not 0.01 <= field <= 3.0:
            raise ValueError(f"view['field_of_view'] is {given!r}: it must be from 0.01 to 3 rad")
        if not np.linalg.norm(position - target) > 0.0:
            raise ValueError("view['position'] is the target: the camera must be elsewhere")
        return renderer.Camera(position, target, shape, field)
    direction = _vector("view", view)
    if not np.linalg.norm(direction) > 0.0:
        raise ValueError("view is zero: it must be the direction from the body to the camera")
    radius = 0.5 * float(np.linalg.norm(high - low)) or 1.0
    # The narrower side of the picture holds a ball around the body.
    half = np.arctan(np.tan(0.5 * field) * min(1.0, shape[1] / shape[0]))
    distance = radius / np.sin(half)
    return renderer.Camera(target + distance * direction / np.linalg.norm(direction), target,
                           shape, field)


def _ball(center: Floats, radius: float, sides: int = 16) -> tuple[Floats, Integers]:
    angles = np.linspace(0.0, np.pi, sides // 2 + 1)
    around = 2 * np.pi * np.arange(sides) / sides
    points = np.stack([np.outer(np.sin(angles), np.cos(around)),
                       np.outer(np.sin(angles), np.sin(around)),
                       np.outer(np.cos(angles), np.ones(sides))], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(sides // 2), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    triangles = np.concatenate([np.stack([a, b, a + sides], -1).reshape(-1, 3),
                                np.stack([b, b + sides, a + sides], -1).reshape(-1, 3)])
    return center + radius * points, triangles


def _brick(size: Floats) -> tuple[Floats, Integers]:
    corners = 0.5 * size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])


def _solids(shape: Mapping[str, Any]) -> list[tuple[Floats, Integers]]:
    """Return what stands for a shape, in the frame of its tool. A half space has no picture."""
    if "sphere" in shape:
        return [_ball(np.zeros(3), shape["sphere"]["radius"])]
    if "capsule" in shape:
        capsule = shape["capsule"]
        start, end = np.array(capsule["from"], float), np.array(capsule["to"], float)
        radius = capsule["radius"]
        return [renderer.rod(start, end, radius, 16), _ball(start, radius), _ball(end, radius)]
    if "box" in shape:
        return [_brick(np.array(shape["box"]["size"], float))]
    if "mesh" in shape:
        return [(np.array(shape["mesh"]["points"], float),
                 np.array(shape["mesh"]["triangles"], np.int64))]
    return []


def _edges(definition: Mapping[str, Any]) -> list[Floats]:
    """Return the sharp edges of a tool as lines of points, in its frame."""
    if "edge" in definition:
        return [np.array(definition["edge"], float)]
    if definition.get("kind") == "scissors":
        length, half = definition["length"], 0.5 * definition["angle"]
        return [length * np.array([[0.0, 0.0, 0.0], [side * np.sin(half), 0.0, -np.cos(half)]])
                for side in (-1.0, 1.0)]
    return []


class _Scene:
    """Triangles with their colours and labels, and lines with theirs."""

    def __init__(self, world: incise.World) -> None:
        surface = world.surface
        self.body = world.positions
        names = np.unique(surface.regions)
        colors = TISSUE[np.searchsorted(names, surface.regions) % len(TISSUE)]
        colors[surface.is_cut] = CUT
        self.least_region = int(names[0])
        points, triangles = [self.body], [surface.triangles]
        paint, labels = [colors], [surface.regions]
        self.lines: list[renderer.Lines] = []
        line_labels = []
        num_points = len(self.body)
        for i, tool in enumerate(world.tools.values()):
            definition, pose = tool.definition, tool.current_pose
            if definition is None or pose is None:
                continue
            for own, faces in _solids(definition.get("shape", {})):
                points.append(pose.to_world(own))
                triangles.append(faces + num_points)
                paint.append(np.tile(TOOL, (len(faces), 1)))
                labels.append(np.full(len(faces), -2 - i))
                num_points += len(own)
            for edge in _edges(definition):
                ends = pose.to_world(edge)
                self.lines.append((np.stack([ends[:-1], ends[1:]], axis=1), 0.0, EDGE))
                line_labels.append(-2 - i)
        self.points, self.triangles = np.concatenate(points), np.concatenate(triangles)
        self.colors = np.concatenate(paint)
        self.labels = np.concatenate([[-1], *labels, line_labels]).astype(np.int64)


def render(world: incise.World, width: int, height: int, view: Any,
           channels: Union[str, Sequence[str]]) -> Any:
    """Return the channels of a picture: see World.render()."""
    for name, size in (("width", width), ("height", height)):
        if not 1 <= size <= MOST_PIXELS:
            raise ValueError(f"{name} is {size}: it must be from 1 to {MOST_PIXELS} pixels")
    wanted = (channels,) if isinstance(channels, str) else tuple(channels)
    for name in wanted:
        if name not in CHANNELS:
            raise ValueError(f"there is no channel {name!r}: there are {', '.join(CHANNELS)}")
    before = (world.time, world.topology_version)
    scene = _Scene(world)
    if (world.time, world.topology_version) != before:
        raise incise.Error("another thread has stepped the world while its picture was made")
    if "segmentation" in wanted and scene.least_region < 0:
        raise ValueError(f"the body has a region {scene.least_region}: a segmentation needs "
                         "regions from 0 on")
    camera = _camera(scene.body, (height, width), view)
    owner, near = renderer.trace(camera, scene.points, scene.triangles, scene.lines)
    made: dict[str, Any] = {}
    if "rgb" in wanted:
        made["rgb"] = renderer.shade(owner, scene.points, scene.triangles, scene.colors,
                                     scene.lines).reshape(height, width, 3)
    if "depth" in wanted:
        with np.errstate(divide="ignore"):
            made["depth"] = (1.0 / near).reshape(height, width)
    if "segmentation" in wanted:
        made["segmentation"] = scene.labels[owner].reshape(height, width)
    return made[channels] if isinstance(channels, str) else made
