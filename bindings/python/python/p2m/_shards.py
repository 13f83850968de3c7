"""Indexes in shards, for scenes that are larger than memory."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._arrays import (
    FIELDS,
    INSIDE,
    Progress,
    check_choice,
    coordinates,
    flat,
    largest_distance,
    one_output,
    outputs,
    own_threads,
    running,
    thread_count,
    whole,
)
from ._index import PointQueries
from ._records import ClosestPoints
from ._scene import Object, Scene

_FLOAT64 = np.dtype(np.float64)
_BOOL = np.dtype(np.bool_)
_UNLIMITED = 2**64 - 1

MANIFEST_FILE = "manifest.json"
"""The name of the file that describes the shards of a folder."""

SHARD_FIELDS = {name: kind for name, kind in FIELDS.items() if name != "object"} | {"key": (_FLOAT64, (2,))}
"""The types and the last axes of the columns of answers of one shard."""


class ShardInfo(NamedTuple):
    """The description of a shard."""

    file: str
    """The name of its file in the folder."""
    file_bytes: int
    """The length of its file."""
    primitives: int
    """The number of its primitives."""
    bounds: NDArray[np.float64]
    """The corners of the box around its primitives, shape (2, 3)."""


class Shards(PointQueries):
    """An index in shards in a folder written by `write_shards`. A shard is loaded when a query needs it.

    Answers are the same bits as those of one `Index` over the whole scene, except for the last bits of lower bounds.
    They depend neither on the division of the scene nor on the memory for shards. A query that needs a shard whose file
    is missing, damaged or another one raises an error with the name of the file.

    Parameters
    ----------
    path : path-like
        The folder, or the file ``manifest.json`` in it. No shard is loaded yet.
    max_bytes : int, optional
        The memory that shards may take. A shard counts as the length of its file and 40 bytes for each primitive. If a
        shard does not fit, the least recently used ones are dropped. Memory may exceed the limit, because one shard is
        always loaded, and a dropped shard stays until the threads that use it have finished. By default there is no
        limit.
    map : bool, optional
        Whether files are mapped into memory, as for `load`. The files must not be changed or truncated while the index
        is in use: the behaviour is then undefined. `write_shards` replaces files and does not change them.
    threads : int, optional
        The number of threads for queries, as for `Index`.

    Raises
    ------
    OSError
        If the manifest cannot be read.
    ValueError
        If it is damaged, or not a manifest of shards.

    Notes
    -----
    A batch is answered in parts: of 2**20 answers, of 2**18 rays, or for `within` of 2**16 points. A part loads each
    shard at most twice, so large batches need little memory and few reads of files. Only `closest` with `epsilon` or
    `max_visits` asks each point by itself, which is slow where the shards that it needs do not fit into `max_bytes`.

    Objects are pickled as the folder and the checksum of its manifest. A process that unpickles one several times opens
    the folder once (`p2m.clear_opened`).

    Examples
    --------
    >>> import os, tempfile
    >>> import numpy as np, p2m
    >>> folder = os.path.join(tempfile.mkdtemp(), "site")
    >>> points = np.random.default_rng(1).uniform(size=(1000, 3))
    >>> scene = p2m.Scene(points, points=np.arange(1000))
    >>> shards = p2m.write_shards(scene, folder, max_bytes=20_000)
    >>> len(shards), len(shards.shards) > 4
    (1000, True)
    >>> shards.closest(points[[0, 17, 999]]).primitive
    array([  0,  17, 999])
    """

    __slots__ = ("__weakref__", "_is_mapped", "_manifest_checksum", "_max_bytes", "_path", "_raw", "_threads")

    _raw: _p2m.Shards

    def __init__(
        self,
        path: str | os.PathLike[str],
        max_bytes: int | None = None,
        map: bool = False,
        *,
        threads: int | None = None,
    ) -> None:
        folder = shard_folder(path)
        self._set(_p2m.Shards(folder, max_bytes_of(max_bytes), map), folder, max_bytes, map, threads)

    def _set(
        self, raw: _p2m.Shards, path: str, max_bytes: int | None, is_mapped: bool, threads: int | None
    ) -> Shards:
        self._raw, self._path, self._manifest_checksum = raw, path, raw.checksum()
        self._max_bytes, self._is_mapped = max_bytes, bool(is_mapped)
        self._threads = own_threads(threads)
        return self

    @property
    def path(self) -> str:
        """The folder of the shards."""
        return self._path

    @property
    def backend(self) -> str:
        """The name of the backend of all shards."""
        return self._raw.backend()

    @property
    def max_bytes(self) -> int | None:
        """The memory that shards may take, or None without a limit."""
        return self._max_bytes

    @property
    def bounds(self) -> NDArray[np.float64]:
        """The corners of the box around all primitives, shape (2, 3); nan for an empty scene."""
        bounds = self._raw.bounds()
        return np.full((2, 3), np.nan) if bounds is None else np.array(bounds)

    def _box(self) -> NDArray[np.float64]:
        return self.bounds

    @property
    def shards(self) -> list[ShardInfo]:
        """The descriptions of all shards."""
        return [
            ShardInfo(file, size, primitives, np.array(bounds)) for file, size, primitives, bounds in self._raw.shards()
        ]

    @property
    def objects(self) -> list[Object]:
        """The named parts of the whole scene, in the order of their ids."""
        return [Object(*parts) for parts in self._raw.objects()]

    @property
    def loads(self) -> int:
        """The number of times that a shard has been loaded so far."""
        return self._raw.loads()

    def __len__(self) -> int:
        return sum(self._raw.counts())

    def __repr__(self) -> str:
        return f"<p2m.Shards {self.backend!r} of {len(self)} primitives in {len(self._raw.shards())} shards>"

    def _objects(self) -> list[tuple[str, int, int]]:
        return self._raw.objects()

    def contains(
        self,
        points: ArrayLike,
        *,
        out: NDArray[np.bool_] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Return whether points are inside of the surface that the triangles form.

        The rule is that of `Index.signed_distance` with ``sign="auto"`` for the whole scene. The ray runs along a
        coordinate axis, in the one of six directions in which it passes the fewest boxes of shards. A point on the
        surface may be reported as inside or outside, in contrast to `Index.contains`.

        Parameters
        ----------
        points, threads, progress
            As for `closest`.
        out : ndarray of bool, shape (...), optional
            The array that receives the answers.

        Returns
        -------
        ndarray of bool, shape (...)

        Raises
        ------
        ValueError
            If the scene has segments or points or is open, or the backend casts no rays.
        """
        queries = coordinates(points, "points")
        array = one_output(out, "contains", _BOOL, queries.shape[:-1])
        with self._running(threads, progress) as run:
            self._raw.contains(queries.reshape(-1), {"contains": array.reshape(-1)}, run)
        return array

    def signed_distance(
        self,
        points: ArrayLike,
        *,
        sign: Literal["auto"] = "auto",
        inside: Literal["negative", "positive"] = "negative",
        max_distance: float | None = None,
        out: NDArray[np.float64] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.float64]:
        """Return the distances of points with a sign that tells inside from outside.

        Parameters
        ----------
        points, threads, progress
            As for `closest`. Progress is that of the distances, and then of the sides.
        sign : {"auto"}, optional
            Only ``"auto"``: the surface determines the rule, as for `contains`. Other values are errors.
        inside, max_distance, out
            As for `Index.signed_distance`.

        Returns
        -------
        ndarray of float64, shape (...)
            The signed distances: 0 on the surface, and nan beyond `max_distance`.

        Raises
        ------
        ValueError
            If the scene has segments or points or is open, or the backend casts no rays.

        Examples
        --------
        >>> import os, p2m, tempfile
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> shards = p2m.write_shards(solid, os.path.join(tempfile.mkdtemp(), "solid"))
        >>> shards.signed_distance([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25], [0.0, 0.0, 0.0]])
        array([-0.125,  2.   ,  0.   ])
        """
        queries = coordinates(points, "points")
        array = one_output(out, "signed_distance", _FLOAT64, queries.shape[:-1])
        if sign != "auto":
            raise ValueError(f"sign: {sign!r} is not for shards, which have only 'auto'")
        check_choice(inside, "inside", INSIDE)
        largest = largest_distance(max_distance)
        # Without queries this only checks that the scene has an inside.
        self.contains(np.empty((0, 3)))
        rows, flat = queries.reshape(-1, 3), array.reshape(-1)
        self.distance(rows, max_distance=max_distance, out=flat, threads=threads, progress=progress)
        decided = (flat > 0.0) & (flat < np.inf)
        is_inside = np.zeros(len(flat), np.bool_)
        is_inside[decided] = self.contains(rows[decided], threads=threads, progress=progress)
        if largest < np.inf:
            flat[np.isinf(flat)] = np.nan
        np.negative(flat, out=flat, where=is_inside)
        return array if inside == "negative" else np.negative(array, out=array)

    def nearest_shards(
        self, points: ArrayLike, *, max_distance: float | None = None, threads: int | None = None
    ) -> NDArray[np.int64]:
        """Return the number in `shards` of the shard whose box is nearest to each point. No shard is loaded.

        The time is proportional to the number of points times the number of shards.

        Parameters
        ----------
        points, threads
            As for `closest`.
        max_distance : float, optional
            The largest distance of a box, inclusive.

        Returns
        -------
        ndarray of int64, shape (...)
            The numbers; -1 where no box is within `max_distance`, and for an empty scene.

        Raises
        ------
        ValueError
            If a coordinate is not finite, or for a wrong shape or option.

        Examples
        --------
        >>> import os, p2m, tempfile
        >>> scene = p2m.Scene([[0, 0, 0], [9, 0, 0]], points=[0, 1])
        >>> shards = p2m.write_shards(scene, os.path.join(tempfile.mkdtemp(), "two"), max_bytes=1)
        >>> shards.nearest_shards([[1, 0, 0], [8, 0, 0], [4, 0, 0]], max_distance=3.0)
        array([ 0,  1, -1])
        """
        queries = coordinates(points, "points")
        numbers = np.empty(queries.shape[:-1], np.int64)
        largest = largest_distance(max_distance)
        self._raw.nearest_shards(queries.reshape(-1), {"shard": numbers.reshape(-1)}, largest, self._count(threads))
        return numbers

    def shards_within(
        self, points: ArrayLike, distances: ArrayLike, *, threads: int | None = None
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return for each point the shards that may have a primitive within its distance. No shard is loaded.

        A shard slightly beyond the distance is returned too, because distances of `closest` are rounded.

        Parameters
        ----------
        points, threads
            As for `closest`.
        distances : array_like, shape (...)
            The distance of each point, which may be infinite.

        Returns
        -------
        rows : ndarray of int64, shape (m,)
            The rows of the flattened points, in ascending order, each as often as it has shards.
        numbers : ndarray of int64, shape (m,)
            The numbers of their shards in `shards`, in ascending order for each point.

        Raises
        ------
        ValueError
            If a coordinate is not finite, or for a wrong shape.

        Examples
        --------
        >>> import os, p2m, tempfile
        >>> scene = p2m.Scene([[0, 0, 0], [9, 0, 0]], points=[0, 1])
        >>> shards = p2m.write_shards(scene, os.path.join(tempfile.mkdtemp(), "two"), max_bytes=1)
        >>> shards.shards_within([[1, 0, 0], [8, 0, 0]], [8.0, 1.0])
        (array([0, 0, 1]), array([0, 1, 1]))
        """
        queries = coordinates(points, "points")
        limits = np.ascontiguousarray(distances, np.float64)
        if limits.shape != queries.shape[:-1]:
            raise ValueError(f"distances: the shape is {limits.shape} instead of {queries.shape[:-1]}")
        rows, numbers = self._raw.shards_within(queries.reshape(-1), limits.reshape(-1), self._count(threads))
        return rows, numbers

    def closest_in_shard(
        self,
        points: ArrayLike,
        shard: int,
        *,
        max_distance: float | None = None,
        fields: str | Sequence[str] = ("distance", "primitive", "key"),
        threads: int | None = None,
        progress: Progress = None,
    ) -> ClosestPoints:
        """Return the closest points of one shard, with ids of the whole scene.

        Several processes can share a query by this method: ask the shard of `nearest_shards` for each point, and then
        the other shards of `shards_within` for the distance that was found. The answer with the least key, and of equal
        keys with the lowest primitive, is the answer of `closest`.

        Parameters
        ----------
        points, max_distance, threads, progress
            As for `closest`.
        shard : int
            The number of the shard in `shards`, which is loaded unless there are no points.
        fields : str or sequence of str, optional
            The arrays of the answer: those of `closest` apart from ``object``, and ``key`` of shape (..., 2). The key
            of a primitive is its squared distance with an extended exponent, stored as two numbers: a tier and a
            square. Compare tiers first, and squares only if the tiers are equal. A smaller key never has a larger
            distance, so answers in the order of keys and then primitives are in the order of distances too.

        Returns
        -------
        ClosestPoints

        Raises
        ------
        ValueError
            If a coordinate is not finite, for a wrong shape or option, or if the file of the shard is damaged.
        IndexError
            If there is no such shard.
        OSError
            If the file of the shard cannot be read.

        Examples
        --------
        >>> import os, p2m, tempfile
        >>> scene = p2m.Scene([[0, 0, 0], [9, 0, 0]], points=[0, 1])
        >>> shards = p2m.write_shards(scene, os.path.join(tempfile.mkdtemp(), "two"), max_bytes=1)
        >>> shards.closest_in_shard([[1, 0, 0], [8, 0, 0]], 1).distance
        array([8., 1.])
        """
        queries = coordinates(points, "points")
        count = len(self._raw.shards())
        if not 0 <= shard < count:
            raise IndexError(f"shard: {shard} is not from 0 to {count - 1}")
        arrays = outputs(fields, queries.shape[:-1], None, SHARD_FIELDS, ())
        largest = largest_distance(max_distance)
        with self._running(threads, progress) as run:
            self._raw.closest_in_shard(queries.reshape(-1), shard, flat(arrays), largest, run)
        return ClosestPoints(arrays)


def max_bytes_of(max_bytes: int | None) -> int:
    """Return the limit of memory in the form that the library takes."""
    if max_bytes is None:
        return _UNLIMITED
    return whole(max_bytes, "max_bytes", 0, _UNLIMITED)


def is_shard_folder(path: str) -> bool:
    """Return whether a path is a folder with a manifest, or a manifest."""
    return os.path.basename(path) == MANIFEST_FILE or os.path.exists(os.path.join(path, MANIFEST_FILE))


def shard_folder(path: str | os.PathLike[str]) -> str:
    """Return the absolute path of a folder of shards, given that folder or its manifest."""
    absolute = os.path.abspath(os.fspath(path))
    return os.path.dirname(absolute) if os.path.basename(absolute) == MANIFEST_FILE else absolute


def manifest_checksum(folder: str) -> str | None:
    """Return the checksum that the manifest of a folder states, or None if the file is not a manifest."""
    with open(os.path.join(folder, MANIFEST_FILE), encoding="utf-8") as file:
        try:
            document = json.load(file)
        except ValueError:
            return None
    checksum = document.get("checksum") if isinstance(document, dict) else None
    return checksum if isinstance(checksum, str) else None


def write_shards(
    scenes: Any,
    folder: str | os.PathLike[str],
    max_bytes: int = 1 << 30,
    *,
    backend: str = "auto",
    replace: bool = False,
    threads: int | None = None,
    progress: Progress = None,
) -> Shards:
    """Write a scene as shards. Each shard is a saved index of a part of the scene.

    Only one scene and one shard are in memory at the same time, so the whole scene may be larger than memory. It is
    collected in a temporary file in the folder, which takes 88 bytes for each primitive, and twice that at times.

    Parameters
    ----------
    scenes : Scene, object or iterable of them
        The scene, or parts of it one after the other, such as ``map(p2m.read, files)``. Ids count the primitives of all
        parts in their order. A part is a scene, or an object that `Scene.of` makes one of, except for tuples.
    folder : path-like
        The folder, which is created if it is not there.
    max_bytes : int, optional
        The largest length of the file of a shard. Only a shard of one primitive may be longer. While a shard is built,
        its index takes several times as much memory.
    backend : str, optional
        The backend of the shards, as for `Index`. ``"brute"`` has no saved form.
    replace : bool, optional
        Whether shards in the folder are replaced. Processes that have mapped them keep the old ones.
    threads : int, optional
        The number of threads that build a shard, as for `Index`.
    progress : callable, True or "tqdm", optional
        It is called as ``progress(done, total)`` with the number of primitives in finished shards, or a bar of tqdm is
        shown.

    Returns
    -------
    Shards

    Raises
    ------
    FileExistsError
        If the folder has shards and `replace` is false.
    OSError
        If a file cannot be written.
    ValueError
        For a wrong option.
    After the shard that is being built, and after removing all files that were written. After the last shard, the
    shards are complete and stay.

    Examples
    --------
    >>> import os, p2m, tempfile
    >>> tiles = (p2m.Scene([[x, 0, 0], [x + 1, 0, 0], [x, 1, 0]], triangles=[[0, 1, 2]]) for x in range(3))
    >>> p2m.write_shards(tiles, os.path.join(tempfile.mkdtemp(), "tiles"))
    <p2m.Shards 'aabb' of 3 primitives in 1 shards>
    """
    target = os.path.abspath(os.fspath(folder))
    if max_bytes < 1:
        raise ValueError(f"max_bytes: {max_bytes} is not at least 1")
    count = thread_count(threads)
    writer = _p2m.ShardWriter(target, max_bytes_of(max_bytes), backend, replace)
    try:
        for part in _parts(scenes):
            writer.add(Scene.of(part)._raw)
        with running(count, progress, "writing", "primitives") as run:
            writer.finish(run)
    finally:
        writer.close()
    return Shards(target, threads=threads)


def _parts(scenes: Any) -> Iterable[Any]:
    """Return the parts of a scene, which may be a single part."""
    if isinstance(scenes, Scene) or not isinstance(scenes, Iterable):
        return (scenes,)
    return scenes
