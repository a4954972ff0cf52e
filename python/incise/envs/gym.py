"""Gymnasium's interface, with gymnasium where it is installed and without it otherwise.

Env, Box, Discrete, Dict and ResetNeeded are those of gymnasium if it can be imported. Else they are
small classes of the same names and behaviour. Random numbers are the same in both cases.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt


def make_generator(seed: Optional[int] = None) -> tuple[np.random.Generator, int]:
    """Return a generator, and the seed that it has, as gymnasium.utils.seeding.np_random."""
    if seed is not None and (isinstance(seed, bool) or not isinstance(seed, (int, np.integer))
                             or seed < 0):
        raise ValueError(f"a seed must be a whole number of at least 0, or None; it is {seed!r}")
    sequence = np.random.SeedSequence(None if seed is None else int(seed))
    return np.random.Generator(np.random.PCG64(sequence)), sequence.entropy  # type: ignore


class Space:
    """A set of values, from which random ones can be drawn."""

    def __init__(self, shape: Optional[tuple[int, ...]] = None, dtype: Any = None,
                 seed: Optional[int] = None) -> None:
        self._shape = shape
        self.dtype = None if dtype is None else np.dtype(dtype)
        self._generator: Optional[np.random.Generator] = None
        if seed is not None:
            self.seed(seed)

    @property
    def shape(self) -> Optional[tuple[int, ...]]:
        """The shape of the values; None if they are no arrays."""
        return self._shape

    @property
    def np_random(self) -> np.random.Generator:
        """The generator of sample()."""
        if self._generator is None:
            self.seed()
        assert self._generator is not None
        return self._generator

    def seed(self, seed: Optional[int] = None) -> Any:
        """Begin a sequence of random values. Return the seed."""
        self._generator, used = make_generator(seed)
        return used

    def sample(self) -> Any:
        """Return a random value."""
        raise NotImplementedError

    def contains(self, x: Any) -> bool:
        """Return whether x is a value of the space."""
        raise NotImplementedError

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)


class Box(Space):
    """Arrays with bounds."""

    def __init__(self, low: npt.ArrayLike, high: npt.ArrayLike,
                 shape: Optional[tuple[int, ...]] = None, dtype: Any = np.float32,
                 seed: Optional[int] = None) -> None:
        """low, high: numbers, or arrays of the shape; infinite where there is no bound."""
        if shape is None:
            shape = np.broadcast_shapes(np.shape(low), np.shape(high))
        super().__init__(tuple(int(n) for n in shape), dtype, seed)
        self.low = np.broadcast_to(np.asarray(low, self.dtype), shape).copy()
        self.high = np.broadcast_to(np.asarray(high, self.dtype), shape).copy()
        if np.any(self.low > self.high):
            raise ValueError("a lower bound is above the upper one")
        self.bounded_below = np.isfinite(self.low.astype(float))
        self.bounded_above = np.isfinite(self.high.astype(float))

    def is_bounded(self, manner: str = "both") -> bool:
        """Return whether all values have bounds: manner is 'both', 'below' or 'above'."""
        below, above = bool(self.bounded_below.all()), bool(self.bounded_above.all())
        return {"both": below and above, "below": below, "above": above}[manner]

    def sample(self) -> npt.NDArray[Any]:
        """Return a random array: uniform between bounds, exponential beyond one, else normal."""
        random = self.np_random
        assert self.dtype is not None
        value = np.empty(self._shape or ())
        below, above = self.bounded_below, self.bounded_above
        free, lower, upper, both = ~below & ~above, below & ~above, ~below & above, below & above
        whole = self.dtype.kind in "iu"
        high = self.high.astype(float) + (1 if whole else 0)
        value[free] = random.normal(size=free[free].shape)
        value[lower] = random.exponential(size=lower[lower].shape) + self.low[lower]
        value[upper] = high[upper] - random.exponential(size=upper[upper].shape)
        value[both] = random.uniform(low=self.low[both], high=high[both], size=both[both].shape)
        return (np.floor(value) if whole else value).astype(self.dtype)

    def contains(self, x: Any) -> bool:
        """Return whether x is an array of this shape, of a type that fits, within the bounds."""
        if not isinstance(x, np.ndarray):
            try:
                x = np.asarray(x, dtype=self.dtype)
            except (ValueError, TypeError):
                return False
        return bool(np.can_cast(x.dtype, self.dtype) and x.shape == self._shape
                    and np.all(x >= self.low) and np.all(x <= self.high))

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, Box) and self._shape == other._shape
                and self.dtype == other.dtype and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high))

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self._shape}, {self.dtype})"


class Discrete(Space):
    """The whole numbers from start on, n of them."""

    def __init__(self, n: int, seed: Optional[int] = None, start: int = 0) -> None:
        if n <= 0:
            raise ValueError("n must be above 0")
        super().__init__((), np.int64, seed)
        self.n, self.start = np.int64(n), np.int64(start)

    def sample(self) -> np.int64:
        """Return a random number of the space."""
        return np.int64(self.start + self.np_random.integers(self.n))

    def contains(self, x: Any) -> bool:
        """Return whether x is one of the numbers."""
        if isinstance(x, (int, np.integer)) and not isinstance(x, bool):
            value = int(x)
        elif isinstance(x, np.ndarray) and x.dtype.kind in "iu" and x.shape == ():
            value = int(x)
        else:
            return False
        return bool(self.start <= value < self.start + self.n)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Discrete) and (self.n, self.start) == (other.n, other.start)

    def __repr__(self) -> str:
        start = f", start={self.start}" if self.start else ""
        return f"Discrete({self.n}{start})"


class Dict(Space):
    """Dicts of values of other spaces."""

    def __init__(self, spaces: Optional[Mapping[str, Space]] = None,
                 seed: Union[int, None] = None, **kwargs: Space) -> None:
        self.spaces: dict[str, Space] = {**dict(spaces or {}), **kwargs}
        super().__init__(None, None, seed)

    def seed(self, seed: Optional[int] = None) -> Any:
        """Begin a sequence in each of the spaces. Return their seeds."""
        super().seed(seed)
        return {key: space.seed(int(self.np_random.integers(2**31)))
                for key, space in self.spaces.items()}

    def sample(self) -> dict[str, Any]:
        """Return a dict of random values."""
        return {key: space.sample() for key, space in self.spaces.items()}

    def contains(self, x: Any) -> bool:
        """Return whether x is a dict with the same keys and a value of each space."""
        return (isinstance(x, Mapping) and x.keys() == self.spaces.keys()
                and all(space.contains(x[key]) for key, space in self.spaces.items()))

    def __getitem__(self, key: str) -> Space:
        return self.spaces[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self.spaces)

    def __len__(self) -> int:
        return len(self.spaces)

    def keys(self) -> Any:
        """Return the names of the spaces."""
        return self.spaces.keys()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Dict) and self.spaces == other.spaces

    def __repr__(self) -> str:
        return f"Dict({self.spaces!r})"


class ResetNeeded(RuntimeError):
    """step() or render() was called before reset(), or step() after the end of an episode."""


class Env:
    """The interface of an environment: see the page of Gymnasium on its class Env."""

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: Optional[str] = None
    spec: Any = None
    action_space: Any
    observation_space: Any
    _np_random: Optional[np.random.Generator] = None
    _np_random_seed: Optional[int] = None

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act. Return (observation, reward, terminated, truncated, info)."""
        raise NotImplementedError

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[dict[str, Any]] = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode. Return (observation, info)."""
        if seed is not None:
            self._np_random, self._np_random_seed = make_generator(seed)
        return None, {}

    def render(self) -> Any:
        """Return a picture of the present state, as the render mode says."""
        raise NotImplementedError

    def close(self) -> None:
        """Give back what the environment holds."""

    @property
    def unwrapped(self) -> Env:
        """The environment itself."""
        return self

    @property
    def np_random(self) -> np.random.Generator:
        """The generator of the environment. reset(seed=...) begins it anew."""
        if self._np_random is None:
            self._np_random, self._np_random_seed = make_generator()
        return self._np_random

    @np_random.setter
    def np_random(self, value: np.random.Generator) -> None:
        self._np_random, self._np_random_seed = value, -1

    @property
    def np_random_seed(self) -> int:
        """The seed of np_random; -1 if the generator was set from outside."""
        if self._np_random_seed is None:
            self._np_random, self._np_random_seed = make_generator()
        return self._np_random_seed

    def get_wrapper_attr(self, name: str) -> Any:
        """Return an attribute of the environment."""
        return getattr(self, name)

    def __enter__(self) -> Env:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()

    def __str__(self) -> str:
        return f"<{type(self).__name__} instance>" if self.spec is None else \
            f"<{type(self).__name__}<{self.spec.id}>>"


HAS_GYMNASIUM = False
try:
    _gymnasium: Any = importlib.import_module("gymnasium")
except ImportError:
    pass
else:
    HAS_GYMNASIUM = True
    Env = _gymnasium.Env  # type: ignore
    Space, Box = _gymnasium.spaces.Space, _gymnasium.spaces.Box  # type: ignore
    Discrete, Dict = _gymnasium.spaces.Discrete, _gymnasium.spaces.Dict  # type: ignore
    ResetNeeded = _gymnasium.error.ResetNeeded  # type: ignore


def register(ids: Mapping[str, str]) -> None:
    """Register environments, ids to entry points, with gymnasium if it is installed."""
    if HAS_GYMNASIUM:
        for name, entry_point in ids.items():
            if name not in _gymnasium.registry:
                _gymnasium.register(id=name, entry_point=entry_point)
