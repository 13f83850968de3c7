"""What the replacements of several packages need: caches of indexes, and rays of which some have no direction."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Sequence
from typing import Any, Generic, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .._index import Index

_T = TypeVar("_T")

MESHES_PER_CONTENT_CACHE = 4
"""The number of meshes of which a cache keeps what was made of them."""


class ContentCache(Generic[_T]):
    """What was made of arrays, found again by their content.

    The cache has copies of the arrays and compares all of their bytes, which takes about a millisecond for a mesh of
    100,000 triangles and is never mistaken. It forgets the mesh that was not used for the longest time.
    """

    def __init__(self, make: Callable[..., _T]) -> None:
        self._make = make
        self._entries: list[tuple[list[NDArray[Any]], _T]] = []
        self._lock = threading.Lock()

    def get(self, *arrays: NDArray[Any]) -> _T:
        """Return what belongs to contiguous arrays, and make it if there is nothing."""
        value: _T
        with self._lock:
            for entry in reversed(self._entries):
                if all(_is_same(a, b) for a, b in zip(entry[0], arrays, strict=True)):
                    self._entries = [other for other in self._entries if other is not entry]
                    self._entries.append(entry)
                    value = entry[1]
                    return value
        # Others may use the cache meanwhile. Two threads may make the same, of which the later one is found first.
        copies = [array.copy() for array in arrays]
        value = self._make(*copies)
        with self._lock:
            self._entries.append((copies, value))
            del self._entries[:-MESHES_PER_CONTENT_CACHE]
        return value

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._entries.clear()


def _is_same(kept: NDArray[Any], array: NDArray[Any]) -> bool:
    """Return whether contiguous arrays of numbers with 8 bytes are the same bits."""
    if kept.shape != array.shape or kept.dtype != array.dtype:
        return False
    a, b = kept.reshape(-1).view(np.int64), array.reshape(-1).view(np.int64)
    # The first numbers of other meshes differ, so these are found out without a look at all of them.
    return bool(np.array_equal(a[:64], b[:64]) and np.array_equal(a, b))


class _Made(NamedTuple):
    mesh: weakref.ref[Any]
    content: object
    value: Any


class ObjectCache(Generic[_T]):
    """What was made of objects that change, kept until they change or cease to exist."""

    def __init__(self, make: Callable[[Any], _T], content: Callable[[Any], object]) -> None:
        self._make = make
        self._content = content
        self._made: dict[int, _Made] = {}
        self._lock = threading.RLock()

    def get(self, mesh: Any) -> _T:
        """Return what belongs to an object in its present state, and make it if there is nothing."""
        key, content = id(mesh), self._content(mesh)
        with self._lock:
            made = self._made.get(key)
        if made is None or made.mesh() is not mesh or made.content != content:
            made = _Made(weakref.ref(mesh, lambda old: self._forget(key, old)), content, self._make(mesh))
            with self._lock:
                self._made[key] = made
        value: _T = made.value
        return value

    def _forget(self, key: int, old: weakref.ref[Any]) -> None:
        with self._lock:
            made = self._made.get(key)
            if made is not None and made.mesh is old:
                del self._made[key]

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._made.clear()

    def __len__(self) -> int:
        return len(self._made)


class Hits(NamedTuple):
    """All hits of rays, ray by ray, nearest first."""

    ray: NDArray[np.int64]
    columns: dict[str, NDArray[Any]]
    splits: NDArray[np.int64]


def _rays_with_direction(directions: NDArray[np.float64]) -> NDArray[np.bool_] | None:
    """Return which rays have a direction, or None if all have one. A ray without direction hits nothing."""
    zero = (directions == 0.0).all(axis=-1)
    return ~zero if zero.any() else None


def first_hits(
    index: Index,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    fields: Sequence[str],
    threads: int | None,
) -> dict[str, NDArray[Any]]:
    """Return the first hits of rays with one leading axis; the primitive is -1 where there is none."""
    some = _rays_with_direction(directions)
    if some is None:
        return index.rays(origins, directions, fields=fields, threads=threads).asdict()
    found = index.rays(origins[some], directions[some], fields=fields, threads=threads).asdict()
    columns = {}
    for name, array in found.items():
        missing = {"primitive": -1, "t": np.inf, "side": 0}.get(name, np.nan)
        columns[name] = np.full((len(origins), *array.shape[1:]), missing, array.dtype)
        columns[name][some] = array
    return columns


def all_hits(
    index: Index,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    fields: Sequence[str],
    threads: int | None,
) -> Hits:
    """Return all hits of rays with one leading axis."""
    some = _rays_with_direction(directions)
    if some is not None:
        origins, directions = origins[some], directions[some]
    found = index.rays(origins, directions, "all", fields=fields, threads=threads).asdict()
    counts = np.diff(found.pop("splits"))
    if some is not None:
        every = np.zeros(len(some), np.int64)
        every[some] = counts
        counts = every
    splits = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=splits[1:])
    return Hits(np.repeat(np.arange(len(counts)), counts), found, splits)


def ray_values(
    index: Index,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    mode: Literal["any", "count"],
    threads: int | None,
    *,
    t_min: float = 0.0,
    t_max: float = float("inf"),
) -> NDArray[Any]:
    """Return whether rays with one leading axis hit anything, or the number of their hits."""
    some = _rays_with_direction(directions)
    if some is None:
        return index.rays(origins, directions, mode, t_min=t_min, t_max=t_max, threads=threads)
    values: NDArray[Any] = np.zeros(len(origins), np.bool_ if mode == "any" else np.int64)
    values[some] = index.rays(origins[some], directions[some], mode, t_min=t_min, t_max=t_max, threads=threads)
    return values
