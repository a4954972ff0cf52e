"""Checks of the options of environments. Each raises ValueError with what is wrong and allowed."""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import math
from typing import Any, Optional

MAX_THREADS = 256


def _as_number(value: Any) -> Optional[float]:
    """Return a value as a number; None if it is none, or not finite."""
    if isinstance(value, (bool, str, bytes)):
        return None
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None


def _fits(number: Optional[float], least: float, above: float, most: float, whole: bool) -> bool:
    return (number is not None and least <= number <= most and number > above
            and not (whole and number != math.floor(number)))


def _bounds(least: float, above: float, most: float) -> str:
    """Return the end of a sentence about the numbers that are allowed."""
    parts = []
    if above > -math.inf:
        parts.append(f"above {above:g}")
    if least > -math.inf:
        parts.append(f"of at least {least:g}")
    if most < math.inf:
        parts.append(f"at most {most:g}")
    return (" " if parts else "") + " and ".join(parts)


def number(name: str, value: Any, *, least: float = -math.inf, above: float = -math.inf,
           most: float = math.inf, unit: str = "") -> float:
    """Return an option as a float that is finite, at least least, above above, at most most."""
    found = _as_number(value)
    if found is None or not _fits(found, least, above, most, False):
        raise ValueError(f"{name} is {value!r}: it must be a number"
                         f"{_bounds(least, above, most)}{', ' + unit if unit else ''}")
    return found


def whole(name: str, value: Any, *, least: int, most: float = math.inf) -> int:
    """Return an option as an int from least to most."""
    found = _as_number(value)
    if found is None or not _fits(found, least, -math.inf, most, True):
        raise ValueError(f"{name} is {value!r}: it must be a whole number"
                         f"{_bounds(least, -math.inf, most)}")
    return int(found)


def _row(value: Any, count: int) -> Optional[list[Any]]:
    """Return a value as a list if it is a row of count values, else None."""
    try:
        row = None if isinstance(value, (str, bytes, dict, set)) else list(value)
    except TypeError:
        return None
    return row if row is not None and len(row) == count else None


def numbers(name: str, value: Any, what: str, *, above: float = -math.inf) -> tuple[float, ...]:
    """Return an option as floats above above, one for each part of what.

    what: names of the values with their units, with commas between them.
    """
    count = what.count(",") + 1
    row = _row(value, count)
    found = [_as_number(item) for item in row] if row is not None else []
    if not found or not all(_fits(item, -math.inf, above, math.inf, False) for item in found):
        raise ValueError(f"{name} is {value!r}: it must be {count} numbers"
                         f"{_bounds(-math.inf, above, math.inf)}: {what}")
    return tuple(item for item in found if item is not None)


def wholes(name: str, value: Any, what: str) -> tuple[int, ...]:
    """Return an option as ints of at least 1, one for each part of what, with commas between."""
    count = what.count(",") + 1
    row = _row(value, count)
    found = [_as_number(item) for item in row] if row is not None else []
    if not found or not all(_fits(item, 1, -math.inf, math.inf, True) for item in found):
        raise ValueError(f"{name} is {value!r}: it must be {count} whole numbers of at least 1: "
                         f"{what}")
    return tuple(int(item) for item in found if item is not None)


def picture_shape(name: str, value: Any) -> tuple[int, int]:
    """Return the height and the width of a picture, pixels."""
    height, width = wholes(name, value, "height, width in pixels")
    return height, width
