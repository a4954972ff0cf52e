"""Deformation and cutting of soft tissue.

A World is a soft body with its constraints, loads and tools. It is made from a scenario file or
from dicts with the same keys, stepped, and looked at as arrays of numpy:

>>> import incise
>>> world = incise.World(
...     mesh={"box": {"size": [0.1, 0.02, 0.02], "cells": [5, 1, 1]}},
...     materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> report = world.step()
>>> world.positions.shape
(24, 3)

All values are in SI units. docs/python.md of the sources is the guide.

incise.envs has environments for robot learning. It is imported when it is first used.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
from typing import TYPE_CHECKING

from ._incise import (
    Constraint,
    CutResult,
    Elements,
    Error,
    InputError,
    Load,
    Mesh,
    OutputError,
    Physics,
    PhysicsError,
    Pose,
    StepReport,
    Surface,
    Tool,
    ToolContacts,
    UndoPoint,
    View,
    World,
    __version__,
    cut,
    read_mesh,
)


if TYPE_CHECKING:
    from . import envs as envs
else:
    def __getattr__(name):
        if name == "envs":
            import importlib
            return importlib.import_module(".envs", __name__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__():
        return sorted({*globals(), "envs"})


class InciseWarning(UserWarning):
    """What is unusual about a mesh, a scenario or a tool. The message says what to look at."""


__all__ = [
    "Constraint",
    "CutResult",
    "Elements",
    "Error",
    "InciseWarning",
    "InputError",
    "Load",
    "Mesh",
    "OutputError",
    "Physics",
    "PhysicsError",
    "Pose",
    "StepReport",
    "Surface",
    "Tool",
    "ToolContacts",
    "UndoPoint",
    "View",
    "World",
    "__version__",
    "cut",
    "read_mesh",
]
