"""Small worlds for the tests."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import pathlib
from typing import Any

import incise

SOURCES = pathlib.Path(os.environ.get("INCISE_SOURCE_DIR", "../.."))
SCENARIOS = SOURCES / "data" / "scenarios"

MATERIAL: dict[str, Any] = {"density": 1000, "young": 1e4, "poisson": 0.4,
                            "law": "stable-neo-hookean"}
HEX_MATERIAL: dict[str, Any] = {"density": 1000, "young": 1e4, "poisson": 0.3,
                                "method": "hybmss"}
CLAMP: dict[str, Any] = {"name": "clamp", "fix": "xyz",
                         "where": {"box": {"min": [-1, -1, -1], "max": [0.001, 1, 1]}}}
BLADE: dict[str, Any] = {"kind": "blade", "edge": [[0, -0.1, 0], [0, 0.2, 0]]}


def box(cells: tuple[int, int, int] = (6, 2, 2), element: str = "tet") -> dict[str, Any]:
    """Return the section of a block of 0.12 m x 0.04 m x 0.04 m."""
    return {"box": {"size": [0.12, 0.04, 0.04], "cells": list(cells), "element": element}}


def world(**sections: Any) -> incise.World:
    """Return a block that is clamped at x = 0, without gravity."""
    sections = {"mesh": box(), "materials": [MATERIAL], "constraints": [CLAMP], "damping": 5.0,
                **sections}
    return incise.World(**sections)


def hex_world(**sections: Any) -> incise.World:
    """Return the block of hexahedra."""
    return world(mesh=box(element="hex"), materials=[HEX_MATERIAL], **sections)


def cut_through(body: incise.World, x: float = 0.07, seconds: float = 0.02) -> incise.StepReport:
    """Part a world at x with a blade from above."""
    knife = body.add_tool(f"knife_{len(body.tools)}", BLADE, incise.Pose([x, 0, 0.06]))
    knife.pose = incise.Pose([x, 0, -0.02])
    knife.withdraw()
    return body.run_until(body.time + seconds)
