"""Indexes and their queries."""

from __future__ import annotations

import operator
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._arrays import (
    CLOSEST_FIELDS,
    FIELDS,
    HIT_FIELDS,
    Out,
    INSIDE,
    Progress,
    Queries,
    check_choice,
    checked_limits,
    coordinates,
    flat,
    grid_of,
    largest_distance,
    not_negative,
    one_output,
    outputs,
    own_threads,
    real,
    running,
    thread_count,
    together,
    whole,
)
from ._cuda import CudaIndex
from ._page import Page, scene_page
from ._pairs import PairQueries
from ._records import AllHits, ClosestPoints, FirstHits, NearPrimitives
from ._scene import Scene

_FLOAT64 = np.dtype(np.float64)
_BOOL = np.dtype(np.bool_)

if TYPE_CHECKING:
    _Sign = Literal["auto", "winding", "parity"]
    _RayMode = Literal["first", "all", "count", "any", "crossings"]


class PointQueries(Queries):
    """The point and ray queries that indexes and sharded indexes share."""

    __slots__ = ()

    def _objects(self) -> list[tuple[str, int, int]]:
        """Return the objects: the name, the first id, and the id after the last one."""
        raise NotImplementedError

    def closest(
        self,
        points: ArrayLike,
        *,
        max_distance: float | None = None,
        epsilon: float = 0.0,
        max_visits: int | None = None,
        certified: bool = False,
        fields: str | Sequence[str] | None = None,
        out: Out = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> ClosestPoints:
        """Return the closest points of the scene to query points.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            The query points, with any leading axes: (3,) for one point, (n, 3), or (x, y, z, 3) for a grid. Contiguous
            arrays of float64 and float32 are not copied. Do not modify the array during the call.
        max_distance : float, optional
            The largest distance of an answer, inclusive. Where nothing is as near, the primitive is -1 and the distance
            infinite. Without it every query of a scene that is not empty has an answer.
        epsilon : float, optional
            The largest relative error of distances: with 0.01 they may be too large by one per cent.
        max_visits : int, optional
            The number of visits of nodes and packets after which a query stops and returns the best answer so far. A
            query without any answer yet continues until it has one. ``lower_bound`` remains valid.
        certified : bool, optional
            Whether to find the nearest primitive in exact arithmetic and round its distance once.
        fields : str or sequence of str, optional
            The arrays of the answer, by default those of `out` or else ``("distance", "primitive")``: any of
            ``distance``, ``primitive``, ``point``, ``feature``, ``barycentric``, ``lower_bound``, ``object`` and
            ``normal``, which `ClosestPoints` describes. Other arrays are not computed.
        out : dict of ndarray, ndarray or ClosestPoints, optional
            Contiguous arrays of the right type and shape, by field, that receive the answers; one array for one field.
            After an exception their content is undefined.
        threads : int, optional
            The number of threads; by default that of the index. Small batches run on the calling thread.
        progress : callable, True or "tqdm", optional
            A function, called as ``progress(done, total)`` about 25 times per second, or ``True`` for a bar of tqdm.

        Returns
        -------
        ClosestPoints
            A record with the arrays of `fields`, each with the leading axes of `points`.

        Raises
        ------
        ValueError
            If a coordinate is not finite (the message has the row of the flattened points), or for a wrong shape or
            option.
        TypeError
            For a wrong type of an argument or of an array in `out`.
        KeyboardInterrupt
            Within a tenth of a second.

        Examples
        --------
        >>> import numpy as np, p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [10, 0, 0]], points=[0, 1]))
        >>> answer = index.closest([[1, 0, 0], [7, 0, 0]], max_distance=2.0)
        >>> answer.primitive
        array([ 0, -1])
        >>> answer.distance
        array([ 1., inf])
        >>> distances = np.empty((5, 4))
        >>> index.closest(np.zeros((5, 4, 3)), out={"distance": distances})
        ClosestPoints(distance: float64[5, 4])
        """
        queries = coordinates(points, "points")
        shape = queries.shape[:-1]
        arrays = outputs(fields, shape, out, CLOSEST_FIELDS, ("distance", "primitive"))
        largest, error = checked_limits(max_distance, epsilon, max_visits, certified)
        rows = queries.reshape(-1)
        columns, derived = self._columns(arrays, len(rows) // 3)
        limits = largest, error, max_visits, certified
        if progress is None:
            # A context manager would take a tenth of the time of a call with one point.
            _p2m.closest(self._raw, rows, columns, *limits, (self._count(threads), None))
        else:
            with self._running(threads, progress) as run:
                _p2m.closest(self._raw, rows, columns, *limits, run)
        bounds = columns.get("lower_bound")
        if bounds is not None and largest < float("inf"):
            # If nothing is within the distance, the true distance is at least as large, up to the error of a distance
            # (8 u M). The box of an empty scene is nan.
            size = np.abs(rows.reshape(-1, 3)).max(axis=1, initial=0.0) + np.abs(self._box()).max()
            below = np.maximum(largest * (1.0 - 2.0**-49) - size * 2.0**-48, 0.0)
            is_open = (bounds == float("inf")) & ~np.isnan(below)
            bounds[is_open] = below[is_open]
        if derived:
            self._derive(derived, columns)
        return ClosestPoints(arrays)

    def _columns(
        self, arrays: dict[str, NDArray[Any]], count: int
    ) -> tuple[dict[str, NDArray[Any]], dict[str, NDArray[Any]]]:
        """Return the flat arrays that a search fills, and the arrays that `_derive` fills afterwards."""
        columns = flat(arrays)
        derived: dict[str, NDArray[Any]] = {name: columns.pop(name) for name in ("object", "normal") if name in columns}
        if "normal" in derived and not isinstance(self._raw, _p2m.Index):
            raise ValueError("fields: 'normal' is not for shards")
        if derived:
            columns.setdefault("primitive", np.empty(count, np.int64))
        if "normal" in derived:
            columns.setdefault("feature", np.empty(count, np.uint8))
        return columns, derived

    def _derive(self, derived: dict[str, NDArray[Any]], columns: dict[str, NDArray[Any]]) -> None:
        """Fill the columns that are derived from primitives and features."""
        if "object" in derived:
            self._fill_objects(columns["primitive"], derived["object"])
        if "normal" in derived:
            self._raw.normals(columns["primitive"], columns["feature"], derived)

    def _box(self) -> NDArray[np.float64]:
        """Return the corners of the box around all primitives; nan for an empty scene."""
        raise NotImplementedError

    def _fill_objects(self, primitive: NDArray[np.int64], objects: NDArray[np.int64]) -> None:
        """Write the numbers of the objects that primitives belong to."""
        named = self._objects()
        starts = np.array([start for _, start, _ in named], np.int64)
        stops = np.array([stop for _, _, stop in named] + [0], np.int64)
        number = np.searchsorted(starts, primitive, side="right") - 1
        objects[:] = np.where((number >= 0) & (primitive < stops[number]), number, -1)

    def distance(
        self,
        points: ArrayLike,
        *,
        max_distance: float | None = None,
        out: NDArray[np.float64] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.float64]:
        """Return the distances of query points from the scene.

        Parameters
        ----------
        points, max_distance, threads, progress
            As for `closest`.
        out : ndarray of float64, shape (...), optional
            The array that receives the distances.

        Returns
        -------
        ndarray of float64, shape (...)
            The distances, infinite beyond `max_distance` and for an empty scene.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
        >>> float(index.distance([0, 3, 4]))
        5.0
        """
        answer = self.closest(
            points, max_distance=max_distance, fields=("distance",), out=out, threads=threads, progress=progress
        )
        return answer.distance

    def k_nearest(
        self,
        points: ArrayLike,
        k: int,
        *,
        max_distance: float | None = None,
        fields: str | Sequence[str] | None = None,
        out: Out = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> ClosestPoints:
        """Return the k nearest primitives of each query point, nearest first.

        Parameters
        ----------
        points, max_distance, fields, out, threads, progress
            As for `closest`. ``lower_bound`` refers to the primitive and not to the scene.
        k : int
            The number of primitives, at least 1.

        Returns
        -------
        ClosestPoints
            A record with arrays of shape (..., k) or (..., k, 3). Where there are fewer primitives, the rest has the
            primitive -1 and an infinite distance.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [5, 0, 0], [2, 0, 0]], points=[0, 1, 2]))
        >>> index.k_nearest([[1.5, 0, 0]], 2).primitive
        array([[2, 0]])
        """
        queries = coordinates(points, "points")
        k = whole(k, "k", 1, 2**31 - 1)
        arrays = outputs(fields, (*queries.shape[:-1], k), out, FIELDS, ("distance", "primitive"))
        largest = largest_distance(max_distance)
        columns, derived = self._columns(arrays, queries.size // 3 * k)
        with self._running(threads, progress) as run:
            _p2m.k_nearest(self._raw, queries.reshape(-1), k, columns, largest, run)
        self._derive(derived, columns)
        return ClosestPoints(arrays)

    def within(
        self,
        points: ArrayLike,
        radius: float,
        *,
        fields: str | Sequence[str] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NearPrimitives:
        """Return all primitives within a distance of each query point, nearest first.

        Parameters
        ----------
        points, fields, threads, progress
            As for `closest`.
        radius : float
            The distance, inclusive.

        Returns
        -------
        NearPrimitives
            A record with ``splits`` and the arrays of `fields`: those of query i, in the order of the flattened
            queries, are at ``splits[i]:splits[i + 1]``.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [5, 0, 0], [2, 0, 0]], points=[0, 1, 2]))
        >>> near = index.within([[1.5, 0, 0], [9, 9, 9], [5, 0, 0]], 3.0)
        >>> near.splits, near.primitive
        (array([0, 2, 2, 4]), array([2, 0, 1, 2]))
        """
        queries = coordinates(points, "points")
        number = not_negative(radius, "radius")
        outputs(fields, (0,), None, FIELDS, ("distance", "primitive"))
        rows = queries.reshape(-1)
        splits = np.zeros(len(rows) // 3 + 1, np.int64)
        with self._running(threads, progress) as run:
            found = _p2m.within(self._raw, rows, number, splits[1:], run)
        np.cumsum(splits, out=splits)
        arrays = outputs(fields, (len(found),), None, FIELDS, ("distance", "primitive"))
        columns, derived = self._columns(arrays, len(found))
        found.fill(columns)
        self._derive(derived, columns)
        return NearPrimitives({"splits": splits, **arrays})

    def is_any_within(
        self,
        points: ArrayLike,
        radius: float,
        *,
        out: NDArray[np.bool_] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Return whether any primitive is within a distance of each query point.

        Parameters
        ----------
        points, threads, progress
            As for `closest`.
        radius : float
            The distance, inclusive.
        out : ndarray of bool, shape (...), optional
            The array that receives the answers.

        Returns
        -------
        ndarray of bool, shape (...)

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
        >>> index.is_any_within([[1, 0, 0], [2, 0, 0]], 1.0)
        array([ True, False])
        """
        queries = coordinates(points, "points")
        number = not_negative(radius, "radius")
        array = one_output(out, "is_within", _BOOL, queries.shape[:-1])
        with self._running(threads, progress) as run:
            _p2m.is_any_within(self._raw, queries.reshape(-1), number, {"is_within": array.reshape(-1)}, run)
        return array

    @overload
    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        mode: Literal["first"] = "first",
        *,
        t_min: float = 0.0,
        t_max: float = ...,
        radius: float = 0.0,
        fields: str | Sequence[str] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> FirstHits: ...
    @overload
    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        mode: Literal["all"],
        *,
        t_min: float = 0.0,
        t_max: float = ...,
        radius: float = 0.0,
        fields: str | Sequence[str] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> AllHits: ...
    @overload
    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        mode: Literal["count", "crossings"],
        *,
        t_min: float = 0.0,
        t_max: float = ...,
        radius: float = 0.0,
        fields: None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.int64]: ...
    @overload
    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        mode: Literal["any"],
        *,
        t_min: float = 0.0,
        t_max: float = ...,
        radius: float = 0.0,
        fields: None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]: ...
    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        mode: _RayMode = "first",
        *,
        t_min: float = 0.0,
        t_max: float = float("inf"),
        radius: float = 0.0,
        fields: str | Sequence[str] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> Union[FirstHits, AllHits, NDArray[np.int64], NDArray[np.bool_]]:
        """Cast rays at the scene. Hits are exact: no ray passes between two triangles with a common edge.

        Parameters
        ----------
        origins, directions : array_like, shape (..., 3)
            The origins and directions of the rays, which are broadcast against each other. Directions have any length
            but zero.
        mode : {"first", "all", "count", "any", "crossings"}, optional
            What to return: the first hit, all hits, their number, whether there is one, or how often the ray crosses
            the surface, which is odd for a ray that begins inside of a closed one, at edges and vertices as well.
        t_min, t_max : float, optional
            The range of parameters, inclusive, in lengths of the direction. Minus infinity to infinity is a line.
        radius : float, optional
            The distance within which segments and points are hit. It does not affect triangles.
        fields : str or sequence of str, optional
            The arrays of hits, by default ``("t", "primitive")``: any of ``t``, ``primitive``, ``point``,
            ``barycentric`` and ``side``, which `FirstHits` describes.
        threads, progress
            As for `closest`.

        Returns
        -------
        FirstHits, AllHits, ndarray of int64 or ndarray of bool
            For ``"first"`` a record of arrays with the leading axes of the rays, and for ``"all"`` a record with
            ``splits``. For ``"count"`` and ``"crossings"`` an array of int64, and for ``"any"`` one of bool.

        Raises
        ------
        ValueError
            If a coordinate is not finite, a direction is zero, or the backend casts no rays: use ``"aabb"``,
            ``"kdop"`` or ``"brute"``.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
        >>> origins = [[1, 1, 3], [1, 1, -3], [9, 9, 3]]
        >>> hits = index.rays(origins, [0, 0, -2], fields=("t", "primitive", "side"))
        >>> hits.t, hits.primitive, hits.side
        (array([1.5, inf, inf]), array([ 0, -1, -1]), array([1, 0, 0], dtype=int8))
        >>> index.rays(origins, [0, 0, -2], "count", t_min=-9)
        array([1, 1, 0])
        """
        leading, start, step = together(origins, "origins", directions, "directions")
        number = len(start) // 3
        size = not_negative(radius, "radius")
        if not t_min <= t_max:
            raise ValueError(f"t_min, t_max: no parameter lies between {t_min} and {t_max}")
        if fields is not None and mode not in ("first", "all"):
            raise ValueError(f"fields: the mode {mode!r} has none")
        with self._running(threads, progress, "rays", "casting") as run:
            if mode == "first":
                arrays = outputs(fields, leading, None, HIT_FIELDS, ("t", "primitive"))
                _p2m.rays(self._raw, start, step, mode, flat(arrays), t_min, t_max, size, run)
                return FirstHits(arrays)
            if mode == "all":
                outputs(fields, (0,), None, HIT_FIELDS, ("t", "primitive"))
                splits = np.zeros(number + 1, np.int64)
                counts = {"value": splits[1:]}
                hits = _p2m.rays(self._raw, start, step, mode, counts, t_min, t_max, size, run)
                np.cumsum(splits, out=splits)
                assert hits is not None
                arrays = outputs(fields, (len(hits),), None, HIT_FIELDS, ("t", "primitive"))
                hits.fill(flat(arrays))
                return AllHits({"splits": splits, **arrays})
            values: NDArray[Any] = np.empty(number, np.bool_ if mode == "any" else np.int64)
            _p2m.rays(self._raw, start, step, mode, {"value": values}, t_min, t_max, size, run)
            return values.reshape(leading)


class Index(PointQueries, PairQueries):
    """An index over a scene, which answers queries and never changes.

    Queries from several Python threads run in parallel, because builds and batches release the GIL. Answers do not
    depend on the backend, the number of threads, the order of queries or the processor: distances and primitives are
    the same bits, and of equally near primitives the one with the lowest id is the answer.

    Parameters
    ----------
    scene : Scene or object
        The scene, or an object that `Scene.of` makes one of.
    backend : str
        ``"aabb"``, a tree of boxes; ``"kdop"``, a tree of polytopes, for scenes that are not axis-aligned; ``"octree"``
        and ``"p2m"``, cells with lists, which take longer to build and answer many queries faster; ``"brute"``, no
        structure. ``"auto"`` is the tree of boxes, or with `queries` another one of these indexes where that pays.
        `p2m.backends` returns all names.
    threads : int, optional
        The number of threads for the build and, unless they have their own, for queries. By default it is the
        environment variable ``RAYON_NUM_THREADS``, or else the number of processors that this process may use.
    progress : callable, True or "tqdm", optional
        It is called as ``progress(done, total)`` about 25 times per second during a long build, or it is a progress bar
        of tqdm. Trees report only their end.
    queries : int, optional
        The number of queries that are expected, for the choice of ``"auto"``. The choice counts the work of a few
        queries in the box of the scene, so it depends on the scene and this number. An octree casts no rays, and has
        neither pairs nor `refit`. Where very many queries pay for it, its cells are finer than the default ones.
    max_bytes : int, optional
        The memory that the index may take besides the scene, for the choice of ``"auto"`` with `queries`. A tree of
        boxes, of about 65 bytes per primitive, is the smallest index, and is built even if it takes more.
    directions : {6, 14, 18, 26, "scene"}, optional
        The number of faces of the polytopes of ``"kdop"``, by default 14; ``"scene"`` for 14 along axes of the scene.
    resolution : float, optional
        The fineness of the cells of ``"octree"``, by default 0.3. With 9 a large batch takes up to a third less
        time; the index takes four times the memory and the build four to five times as long
        (docs/measurements/octree.md).

    Raises
    ------
    ValueError
        For an unknown backend or a wrong option.
    KeyboardInterrupt
        At once. The build ends in the background: cells stop within about one per cent of their build, and a tree runs
        to its end.

    Notes
    -----
    An index over an empty scene is valid. Its queries have no answer, like queries that find nothing within
    `max_distance`.

    ``copy.copy`` and ``copy.deepcopy`` return the same object. An index that was loaded from a file is pickled as the
    path and the checksum of the file, any other as its bytes together with the scene. A process that unpickles an index
    of a file several times opens the file once, and keeps the four indexes that it used last (`p2m.clear_opened`).

    Examples
    --------
    >>> import numpy as np, p2m
    >>> scene = p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]])
    >>> index = p2m.Index(scene)
    >>> index.distance([[1.0, 1.0, 2.0], [1.0, 1.0, -3.0]])
    array([2., 3.])
    >>> index.closest([4.0, 4.0, 0.0], fields="point").point
    array([2., 2., 0.])
    """

    __slots__ = ("__weakref__", "_raw", "_threads")

    _raw: _p2m.Index
    _threads: int | None

    def __init__(
        self,
        scene: Any,
        backend: str = "auto",
        *,
        threads: int | None = None,
        progress: Progress = None,
        queries: int | None = None,
        max_bytes: int | None = None,
        directions: int | Literal["scene"] | None = None,
        resolution: float | None = None,
    ) -> None:
        made = Scene.of(scene)
        self._threads = own_threads(threads)
        if queries is not None:
            queries = whole(queries, "queries", 0, 2**63 - 1)
        if max_bytes is not None:
            max_bytes = whole(max_bytes, "max_bytes", 0, 2**63 - 1)
        if resolution is not None and not 0.0 < resolution < float("inf"):
            raise ValueError(f"resolution: {resolution} is not positive and finite")
        named = None if directions is None else str(directions)
        with self._running(threads, progress, "%", "building") as run:
            self._raw = _p2m.Index.build(made._raw, backend, run, named, resolution, queries, max_bytes)

    @classmethod
    def _from_raw(cls, raw: _p2m.Index, threads: int | None) -> Index:
        index = cls.__new__(cls)
        index._raw = raw
        index._threads = threads
        return index

    def _box(self) -> NDArray[np.float64]:
        return self.scene.bounds

    @property
    def scene(self) -> Scene:
        """The scene that the index was built over."""
        return Scene._from_raw(self._raw.scene())

    @property
    def backend(self) -> str:
        """The name of the backend."""
        return self._raw.backend()

    @property
    def info(self) -> dict[str, Any]:
        """Facts about the index, by name.

        ``backend`` and ``summary`` describe the backend. ``primitives`` is the number of primitives. ``memory_bytes``
        is the memory of the index besides the scene, and ``parts`` divides it by parts. ``casts_rays``,
        ``answers_pairs`` and ``is_saveable`` tell what the index can do. ``surface_area`` is the area of all boxes of a
        tree: build anew when it has grown by a third in refits. ``cells`` describes cells, ``directions`` is the number
        of faces of k-DOPs, and ``path`` is the file from which the index was loaded. A fact that does not apply to a
        backend is None.
        """
        return self._raw.info()

    def __len__(self) -> int:
        return len(self.scene)

    def __repr__(self) -> str:
        return f"<p2m.Index {self.backend!r} of {len(self)} primitives>"

    def _objects(self) -> list[tuple[str, int, int]]:
        return self._raw.scene().objects()

    def signed_distance(
        self,
        points: ArrayLike,
        *,
        sign: _Sign = "auto",
        inside: Literal["negative", "positive"] = "negative",
        max_distance: float | None = None,
        out: NDArray[np.float64] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.float64]:
        """Return the distances of query points with a sign that tells inside from outside.

        Parameters
        ----------
        points, threads, progress
            As for `closest`.
        sign : {"auto", "winding", "parity"}, optional
            The rule that decides which points are inside; `sign_rule` returns it. ``"winding"``: where the generalised
            winding number exceeds a half in magnitude. The surface may have holes, and its triangles may overlap and
            intersect each other. For a closed surface with consistent orientations the number is an exact count of
            crossings. ``"parity"``: where a ray crosses the surface an odd number of times, whatever the orientations;
            an open surface is an error. ``"auto"``: winding, or parity if the surface is closed but not consistently
            oriented.
        inside : {"negative", "positive"}, optional
            The sign inside. trimesh has positive numbers there; Open3D, libigl and point-cloud-utils negative ones.
        max_distance : float, optional
            The largest distance that is needed, inclusive, which makes the search shorter.
        out : ndarray of float64, shape (...), optional
            The array that receives the distances.

        Returns
        -------
        ndarray of float64, shape (...)
            The signed distances: 0 on the surface, nan beyond `max_distance`, and where rounding leaves it undecided
            whether the winding number of an open surface exceeds a half.

        Raises
        ------
        ValueError
            If the scene has segments or points, which have no sides; with ``sign="parity"`` also if it is open.

        Notes
        -----
        The first call finds the boundary of the surface. A call with about half as many points as the scene has
        triangles also precomputes data that makes signs cheap. This takes a few times as long as building the tree.

        Examples
        --------
        >>> import p2m
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> index = p2m.Index(solid)
        >>> index.signed_distance([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25], [0.0, 0.0, 0.0]])
        array([-0.125,  2.   ,  0.   ])
        """
        queries = coordinates(points, "points")
        array = one_output(out, "signed_distance", _FLOAT64, queries.shape[:-1])
        check_choice(inside, "inside", INSIDE)
        largest, columns = largest_distance(max_distance), {"signed_distance": array.reshape(-1)}
        with self._running(threads, progress) as run:
            self._raw.signed_distance(queries.reshape(-1), columns, sign, inside == "negative", largest, run)
        return array

    def contains(
        self,
        points: ArrayLike,
        *,
        sign: _Sign = "auto",
        out: NDArray[np.bool_] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Return whether points are inside, without their distances.

        Parameters
        ----------
        points, threads, progress
            As for `closest`.
        sign : {"auto", "winding", "parity"}, optional
            The rule that decides which points are inside, as for `signed_distance`.
        out : ndarray of bool, shape (...), optional
            The array that receives the answers.

        Returns
        -------
        ndarray of bool, shape (...)
            True where `signed_distance` is negative: points on the surface are not inside.

        Raises
        ------
        ValueError
            As for `signed_distance`.

        Notes
        -----
        Points that are nearer to each other than to the surface share one query, so testing many points takes far less
        time than their signed distances. For an open surface this holds only far from its boundary.

        Examples
        --------
        >>> import p2m
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> p2m.Index(solid).contains([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25], [0.0, 0.0, 0.0]])
        array([ True, False, False])
        """
        queries = coordinates(points, "points")
        array = one_output(out, "contains", _BOOL, queries.shape[:-1])
        with self._running(threads, progress) as run:
            self._raw.contains(queries.reshape(-1), {"contains": array.reshape(-1)}, sign, run)
        return array

    def sign_rule(self, sign: _Sign = "auto") -> str:
        """Return the name of the rule that decides which points are inside: ``"winding"`` or ``"parity"``.

        Parameters
        ----------
        sign : {"auto", "winding", "parity"}, optional
            As for `signed_distance`.

        Raises
        ------
        ValueError
            As for `signed_distance`.
        """
        rule: str = self._raw.sign_rule(sign, self._count(None))[0]
        return rule

    def field(
        self,
        origin: ArrayLike,
        spacing: float,
        shape: Sequence[int],
        *,
        signed: bool = False,
        sign: _Sign = "auto",
        band: float | None = None,
        first: Sequence[int] = (0, 0, 0),
        out: NDArray[Any] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[Any]:
        """Return distances at the points of a regular grid.

        Parameters
        ----------
        origin : array_like, shape (3,)
            The point of the grid with the indices (0, 0, 0).
        spacing : float
            The distance of neighbouring points.
        shape : sequence of three int
            The number of points along each axis.
        signed : bool, optional
            Whether distances are negative inside.
        sign : {"auto", "winding", "parity"}, optional
            The rule of signs, as for `signed_distance`.
        band : float, optional
            The largest distance that is computed. Beyond it the field has this value, with the right sign.
        first : sequence of three int, optional
            The indices at which the field begins, for a field that is computed by parts. A part has the same bits as
            the whole field.
        out : ndarray of float32 or float64, shape (x, y, z), optional
            The array that receives the field, with any strides; it may be mapped from a file.
        threads, progress
            As for `closest`.

        Returns
        -------
        ndarray of float32, shape (x, y, z), or out
            ``field[i, j, k]`` belongs to the point ``origin + spacing * (first + (i, j, k))``. A new array is in
            Fortran order, with x running fastest.

        Raises
        ------
        ValueError
            For a grid without points or outside of the range of numbers, and as `signed_distance` does.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
        >>> index.field((0, 0, 0), 3.0, (2, 1, 2))[:, 0, :].tolist()
        [[0.0, 3.0], [3.0, 4.242640495300293]]
        >>> index.field((0, 0, 0), 3.0, (1, 1, 2), first=(1, 0, 0))[0, 0].tolist()
        [3.0, 4.242640495300293]
        """
        corner, counts = grid_of(origin, shape)
        starts = tuple(operator.index(start) for start in first)
        if len(starts) != 3 or not 0 <= min(starts) <= max(starts) <= 2**40:
            raise ValueError(f"first: {starts} are not three indices from 0 to 2**40")
        if out is not None:
            if not isinstance(out, np.ndarray):
                raise TypeError(f"out: {type(out).__name__} is no array of NumPy")
            if out.shape != counts:
                raise ValueError(f"out: the shape is {out.shape} instead of {counts}")
            if out.dtype not in (np.dtype(np.float32), _FLOAT64):
                raise TypeError(f"out: the type is {out.dtype} instead of float32 or float64")
            if not out.flags.writeable:
                raise ValueError("out: the array is read-only")
        rule, width, step = sign if signed else None, largest_distance(band, "band"), real(spacing, "spacing")
        with self._running(threads, progress, what="filling the grid") as run:
            values = self._raw.field(corner, step, starts, counts, rule, width, run)
        grid = values.reshape(counts[::-1]).transpose()
        if out is None:
            return grid
        out[...] = grid
        return out

    def offset_surface(
        self,
        distance: float,
        *,
        resolution: int = 64,
        signed: bool = False,
        sign: _Sign = "auto",
        threads: int | None = None,
        progress: Progress = None,
    ) -> OffsetSurface:
        """Return the closed surface of all points at a distance from the scene.

        Parameters
        ----------
        distance : float
            The distance. With `signed`, a negative one is that of a surface inside.
        resolution : int, optional
            The number of points along the longest side of the grid from which the surface is made, at least 8. Details
            smaller than the spacing of the grid may be lost.
        signed : bool, optional
            Whether distances are negative inside. Without signs, the surface around a closed scene has an inner shell.
        sign : {"auto", "winding", "parity"}, optional
            The rule of signs, as for `signed_distance`.
        threads, progress
            As for `closest`.

        Returns
        -------
        OffsetSurface
            The surface, in which each edge has two triangles, and its errors.

        Raises
        ------
        ValueError
            For a scene without extent or a resolution below 8, and as `signed_distance` does.

        Examples
        --------
        >>> import p2m
        >>> rod = p2m.Index(p2m.Scene([[0, 0, 0], [2, 0, 0]], segments=[[0, 1]]))
        >>> capsule = rod.offset_surface(0.5)
        >>> capsule.vertex_error < 1e-6, capsule.scene.bounds[1].round(3).tolist()
        (True, [2.5, 0.5, 0.5])
        """
        distance = real(distance, "distance")
        grid = _p2m.grid_of_offset(self.scene._raw, distance, whole(resolution, "resolution", 8, 2**20))
        options: Any = {"signed": signed, "sign": sign, "threads": threads, "progress": progress}
        values = self.field(*grid, **options).ravel(order="F")
        rule = sign if signed else None
        raw, of_vertices, of_triangles = self._raw.offset_surface(*grid, values, distance, rule, self._count(threads))
        return OffsetSurface(Scene._from_raw(raw), of_vertices, of_triangles)

    def show(
        self, *, field: int | None = None, sign: _Sign | None = None, unit: str = "units", up: Literal["y", "z"] = "z"
    ) -> Page:
        """Return a page that shows the scene, with a slice through its distance field if `field` is given.

        Parameters
        ----------
        field : int, optional
            The number of grid points along the longest side of the field, which reaches a tenth of the scene beyond it
            on each side.
        sign : {"auto", "winding", "parity"}, optional
            The rule of signs, as for `signed_distance`, if the field should be negative inside.
        unit, up
            As for `Scene.show`.

        Raises
        ------
        ValueError
            As `field` does.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [1, 0, 0]], segments=[[0, 1]]))
        >>> index.show(field=32)._repr_html_()[:7]
        '<iframe'
        """
        return scene_page(self.scene, self, field=field, sign=sign, unit=unit, up=up)

    def refit(self, vertices: ArrayLike, *, threads: int | None = None) -> Index:
        """Return an index over the same primitives at other positions, in a fraction of the time of a build.

        This index does not change. The new one returns the answers of an index that is built from scratch. Its tree
        keeps its shape, so queries become slower the farther neighbours have moved apart (``info["surface_area"]``).

        Parameters
        ----------
        vertices : array_like, shape (n, 3)
            The new coordinates of all vertices.
        threads : int, optional
            The number of threads; by default that of the index.

        Raises
        ------
        ValueError
            For another number of vertices, coordinates that are not finite, and for the backends ``"octree"`` and
            ``"p2m"``, whose cells have to be built anew.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
        >>> raised = index.refit(index.scene.vertices + [0, 0, 2])
        >>> float(raised.distance([1, 1, 0])), float(index.distance([1, 1, 0]))
        (2.0, 0.0)
        """
        moved = self.scene.moved(vertices)
        return Index._from_raw(self._raw.refitted(moved._raw, self._count(threads)), self._threads)

    def to(
        self,
        device: Literal["cuda"],
        *,
        ordinal: int = 0,
        reach: float = 10.5,
        memory: int | None = None,
        reorder: bool = True,
        checked: int = 0,
    ) -> CudaIndex:
        """Copy the scene to an NVIDIA card, and make interception lists there.

        Parameters
        ----------
        device : "cuda"
            The kind of device.
        ordinal : int, optional
            The number of the card.
        reach : float, optional
            The size of the region with lists, in boxes of the scene around its centre. Queries farther away are slower.
        memory : int, optional
            The largest number of bytes of the lists; by default about 280 for each primitive, and more in scenes of
            more than 100,000.
        reorder : bool, optional
            Whether the card sorts the queries. Sorting is wasted if neighbouring queries are near each other already.
        checked : int, optional
            The number of answers to each batch of NumPy that the processor checks.

        Raises
        ------
        RuntimeError
            If there is no driver or no such card, or if p2m was built without the feature ``cuda``.
        MemoryError
            If the memory of the card does not suffice.
        ValueError
            For an empty scene, and for scenes whose size is not within 2**-320 and 2**300.
        """
        if device != "cuda":
            raise ValueError(f"device: {device!r} is not 'cuda'")
        options = {"ordinal": ordinal, "reach": reach, "memory": memory, "reorder": reorder, "checked": checked}
        return CudaIndex(self, threads=self._threads, **options)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Save the index and its scene to a file, which appears under its name when it is complete.

        Parameters
        ----------
        path : path-like
            The file; the extension is usually ``.p2m``.

        Raises
        ------
        OSError
            If the file cannot be written.
        ValueError
            For the backend ``"brute"``, which has no structure.

        Examples
        --------
        >>> import os, p2m, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "point.p2m")
        >>> p2m.Index(p2m.Scene([[0, 0, 0]], points=[0])).save(path)
        >>> p2m.load(path)
        <p2m.Index 'aabb' of 1 primitives>
        """
        self._raw.save(os.fspath(path))


def load(path: str | os.PathLike[str], map: bool = False, *, threads: int | None = None) -> Index:
    """Load an index that `Index.save` or the program ``p2m build`` wrote.

    Parameters
    ----------
    path : path-like
        The file.
    map : bool, optional
        Whether the file is mapped into memory instead of being copied. Processes that map it share the memory. The file
        must not be changed or truncated while the index is in use: the behaviour is then undefined. `Index.save`
        replaces a file and does not change it.
    threads : int, optional
        The number of threads for queries, as for `Index`.

    Returns
    -------
    Index
        The index, which is pickled as the path and the checksum of its file.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged or not a saved index.
    """
    absolute = os.path.abspath(os.fspath(path))
    return Index._from_raw(_p2m.load(absolute, map, thread_count(threads)), own_threads(threads))


def scene_of(obj: Any) -> Scene:
    """Return the scene of an index, or the scene that `Scene.of` makes of another object."""
    return obj.scene if isinstance(obj, Index) else Scene.of(obj)


def index_of(obj: Any, threads: int | None, scene: Scene | None = None) -> Index:
    """Return an index unchanged, or build a tree of boxes over another object or its scene."""
    return obj if isinstance(obj, Index) else Index(obj if scene is None else scene, threads=threads)


class OffsetSurface(NamedTuple):
    """A surface at a distance from a scene."""

    scene: Scene
    """The triangles, which face away from the scene."""
    vertex_error: float
    """The largest difference between the distance of a vertex and the requested distance."""
    triangle_error: float
    """The largest such difference at the centroids of triangles."""


class Estimate(NamedTuple):
    """The expected costs of a backend, on one thread."""

    backend: str
    """The name of the backend."""
    build_seconds: float
    """The time of the build."""
    query_seconds: float
    """The time of one query."""
    memory_bytes: float
    """The memory of the index besides the scene."""
    total_seconds: float
    """The time of the build and of all queries."""
    is_about_equal: bool
    """Whether it takes about as long as the recommended backend, within the error of the estimates."""
    break_even_queries: float | None
    """The number of queries at which this backend and the recommended one take the same time, if there is one."""
    reason: str
    """The reason for the rank of the backend, as a phrase."""


def advise(
    scene: Any,
    queries: int = 1_000_000,
    *,
    region: Literal["near", "box"] = "box",
    points: ArrayLike | None = None,
    max_bytes: int | None = None,
    threads: int | None = None,
) -> list[Estimate]:
    """Return the expected costs of all backends for a scene and a number of queries, the recommended one first.

    A tree of boxes is built, the work of some queries in it is counted, and the costs follow from these counts. No time
    is measured, so the answer is the same in every run. `Index` with the same number of queries has the same backend,
    unless an exhaustive search is the best.

    Parameters
    ----------
    scene : Scene or object
        The scene, or an object that `Scene.of` makes one of.
    queries : int, optional
        The number of queries.
    region : {"box", "near"}, optional
        Where queries are: anywhere in the box of the scene, or about a hundredth of its diagonal from the surface.
    points : array_like, shape (..., 3), optional
        Typical queries, instead of a region.
    max_bytes : int, optional
        The memory that the index may take besides the scene. The tree of boxes may exceed it.
    threads : int, optional
        The number of threads for the build of the tree.

    Examples
    --------
    >>> import p2m
    >>> scene = p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]])
    >>> p2m.advise(scene, 1)[0].backend
    'brute'
    """
    queries = whole(queries, "queries", 0, 2**63 - 1)
    like = None if points is None else coordinates(points, "points").reshape(-1)
    raw = Scene.of(scene)._raw
    rows = _p2m.advise(raw, queries, region, like, max_bytes, thread_count(threads))
    return [Estimate(name, *costs, is_about_equal, even, reason) for name, costs, is_about_equal, even, reason in rows]
