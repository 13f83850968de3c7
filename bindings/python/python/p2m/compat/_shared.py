"""The parts that several compatibility modules share: caches of indexes, and rays without direction."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .._index import Index

_T = TypeVar("_T")

MESHES_PER_CONTENT_CACHE = 4
"""The number of meshes in a cache."""


class ContentCache(Generic[_T]):
    """A cache of values that were made from arrays, with the content of the arrays as the key.

    The cache has copies of the arrays and compares all of their bytes. This takes about a millisecond for a mesh of
    100,000 triangles, and it cannot confuse two meshes. The least recently used mesh is dropped.
    """

    def __init__(self, make: Callable[..., _T]) -> None:
        self._make = make
        self._entries: list[tuple[list[NDArray[Any]], _T]] = []
        self._lock = threading.Lock()

    def get(self, *arrays: NDArray[Any]) -> _T:
        """Return the value for contiguous arrays, and make it if it is missing."""
        value: _T
        with self._lock:
            for entry in reversed(self._entries):
                if all(_is_same(a, b) for a, b in zip(entry[0], arrays, strict=True)):
                    self._entries = [other for other in self._entries if other is not entry]
                    self._entries.append(entry)
                    value = entry[1]
                    return value
        # The cache is not locked meanwhile. Two threads may make the same value; the later one is then used.
        copies = [array.copy() for array in arrays]
        value = self._make(*copies)
        with self._lock:
            self._entries.append((copies, value))
            del self._entries[:-MESHES_PER_CONTENT_CACHE]
        return value

    def clear(self) -> None:
        """Forget all values."""
        with self._lock:
            self._entries.clear()


def _is_same(kept: NDArray[Any], array: NDArray[Any]) -> bool:
    """Return whether contiguous arrays of numbers with 8 bytes are the same bits."""
    if kept.shape != array.shape or kept.dtype != array.dtype:
        return False
    a, b = kept.reshape(-1).view(np.int64), array.reshape(-1).view(np.int64)
    # Meshes usually differ in their first numbers, so these are compared first.
    return bool(np.array_equal(a[:64], b[:64]) and np.array_equal(a, b))


class _Made(NamedTuple):
    mesh: weakref.ref[Any]
    content: object
    value: Any


class ObjectCache(Generic[_T]):
    """A cache of values that were made from mutable objects, kept until the object changes or is deleted."""

    def __init__(self, make: Callable[[Any], _T], content: Callable[[Any], object]) -> None:
        self._make = make
        self._content = content
        self._made: dict[int, _Made] = {}
        self._lock = threading.RLock()

    def get(self, mesh: Any) -> _T:
        """Return the value for the present state of an object, and make it if it is missing."""
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
        """Forget all values."""
        with self._lock:
            self._made.clear()

    def __len__(self) -> int:
        return len(self._made)


Rays = tuple[NDArray[np.float64], NDArray[np.float64]]
"""The origins and directions of rays, each of shape (n, 3)."""


def castable(index: Index, rays: Rays) -> Rays:
    """Return rays in which those without direction, which must hit nothing, start beyond the scene and lead away."""
    origins, directions = rays
    is_zero = (directions == 0.0).all(axis=-1)
    if is_zero.any():
        origins, directions = origins.copy(), directions.copy()
        origins[is_zero] = np.nextafter(np.nan_to_num(index.scene.bounds[1]), np.inf)
        directions[is_zero] = 1.0
    return origins, directions


class Hits(NamedTuple):
    """All hits of rays, ray by ray, nearest first."""

    ray: NDArray[np.int64]
    columns: dict[str, NDArray[Any]]
    splits: NDArray[np.int64]


def all_hits(index: Index, rays: Rays, fields: Sequence[str], threads: int | None = None) -> Hits:
    """Return all hits of rays."""
    columns = index.rays(*castable(index, rays), "all", fields=fields, threads=threads).asdict()
    splits = columns.pop("splits")
    return Hits(np.repeat(np.arange(len(splits) - 1), np.diff(splits)), columns, splits)
