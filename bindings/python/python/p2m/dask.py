"""Queries of a saved index for Dask arrays, answered block by block by any number of processes.

Functions return lazy arrays. Each block of points is one call of the index, which releases the GIL, and the answers are
the same bits as those of `p2m.Index`. Each process opens the file of the index once.

>>> import os, tempfile
>>> import dask.array as da
>>> import p2m, p2m.dask
>>> path = os.path.join(tempfile.mkdtemp(), "triangle.p2m")
>>> p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]])).save(path)
>>> points = da.ones((1000, 3), chunks=(300, 3))
>>> answer = p2m.dask.closest(points, path)
>>> answer.distance
dask.array<p2m-closest-distance, shape=(1000,), dtype=float64, chunksize=(300,), chunktype=numpy.ndarray>
>>> float(answer.distance.sum().compute())
1000.0

The module needs Dask: ``pip install "dask[array]"``.

Parameters that all functions share
-----------------------------------
points : dask.array.Array or array_like, shape (..., 3)
    The points, with any chunks. Anything but a Dask array goes through ``dask.array.from_array``: NumPy and Zarr
    arrays, and files that ``numpy.load(path, mmap_mode="r")`` maps. The last axis becomes one chunk. Chunks may have
    unknown sizes, as those of data frames have.
index : path-like, p2m.Index or p2m.Shards
    The file of a saved index, or an index that was loaded from one, of which the path is used. The folder of shards
    that `p2m.write_shards` wrote, or a `p2m.Shards`, whose limit of memory then holds in each process. The path has to
    exist on all machines of a cluster. If the file is there when a function of this module is called, or the index was
    loaded from it, each process checks that its file has the same checksum. Any other index is sent to each process as
    its bytes together with the scene, which takes the memory of several copies: save large ones.
threads : int, optional
    The number of threads for a block, by default 1 because Dask computes several blocks at the same time. With one
    process that has one thread of Dask, use the number of processors.
map : bool, optional
    Whether processes map the file of the index, so that all processes of a machine share its memory. By default each
    process has a copy. Do not change the file while it is mapped: the behaviour is then undefined.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import math
import operator
import re
import uuid
import weakref
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

try:
    import dask
    import dask.array as da
    from dask.base import tokenize
    from dask.highlevelgraph import HighLevelGraph
except ImportError:
    raise ImportError('p2m.dask needs Dask: pip install "dask[array]"')

from ._arrays import (
    FIELDS,
    HIT_FIELDS,
    INSIDE,
    SIGNS,
    check_choice,
    checked_limits,
    grid_of,
    largest_distance,
    not_negative,
    outputs,
    real,
    thread_count,
)
from ._index import Index
from ._index_cache import IndexFile, index_source, opened
from ._records import ClosestPoints, FirstHits, Record
from ._shards import is_shard_folder
from ._shuffle import Columns, Query, Sent, ask, join, send_to_nearest, send_to_others

__all__ = ["LazyRecord", "closest", "distance", "field", "rays", "signed_distance"]

_Known = Mapping[str, tuple[np.dtype[Any], tuple[int, ...]]]


class LazyRecord(Record):
    """Named lazy arrays. If they are computed together, each block is searched once.

    A record has its arrays as attributes, by name and in order, as `p2m.Record` has. `compute` and
    ``dask.compute(*record)`` search once for all arrays. Two computations, one for each array, search twice, unless
    `persist` comes before them.

    Examples
    --------
    >>> import numpy as np, p2m, p2m.dask
    >>> index = p2m.Index(p2m.Scene([[0.0, 0.0, 0.0]], points=[0]))
    >>> answer = p2m.dask.closest(np.array([[3.0, 4.0, 0.0]]), index)
    >>> answer.fields
    ('distance', 'primitive')
    >>> answer.compute()
    ClosestPoints(distance: float64[1], primitive: int64[1])
    """

    _computed: type[Record] = Record

    def compute(self, **options: Any) -> Any:
        """Return the record with NumPy arrays. The options are those of ``dask.compute``."""
        return self._computed(dict(zip(self.fields, dask.compute(*self, **options))))

    def persist(self, **options: Any) -> Any:
        """Return the record with arrays in the memory of the workers. The options are those of ``dask.persist``."""
        return type(self)(dict(zip(self.fields, dask.persist(*self, **options))))


class LazyClosestPoints(LazyRecord):
    """The lazy arrays of `p2m.ClosestPoints`."""

    _computed = ClosestPoints


class LazyFirstHits(LazyRecord):
    """The lazy arrays of `p2m.FirstHits`."""

    _computed = FirstHits


def closest(
    points: Any,
    index: Any,
    *,
    fields: str | Sequence[str] = ("distance", "primitive"),
    max_distance: float | None = None,
    epsilon: float = 0.0,
    max_visits: int | None = None,
    certified: bool = False,
    shuffle: bool = False,
    threads: int = 1,
    map: bool = False,
) -> LazyClosestPoints:
    """Return the closest points of the scene to query points, as `p2m.Index.closest` does.

    Parameters
    ----------
    points, index, threads, map
        As the module documents them.
    fields, max_distance, epsilon, max_visits, certified
        As for `p2m.Index.closest`.
    Whether points go to the shards that they need. Otherwise each block asks the whole folder. Shuffling needs a folder
    of shards that this process can read, and returns the same bits. It supports neither `epsilon`, `max_visits` nor
    `certified`. The notes describe when it pays.

    Returns
    -------
    LazyClosestPoints
        A record of lazy arrays with the leading axes and chunks of `points`.

    Raises
    ------
    ValueError
        For a wrong shape or option, and during the computation as `p2m.Index.closest` does. The message has the row of
        all points, or the row and the block where chunks have different or unknown sizes.
    TypeError
        For a wrong type of an argument.
    OSError
        During the computation, if the file cannot be read.

    Notes
    -----
    With `shuffle` each point goes to the shard with the nearest box, and then to the other shards whose boxes are
    within the distance that was found. A task asks one shard for the points of all blocks. So all workers together load
    each shard at most twice if each has one thread, while without shuffling each worker loads each shard that its
    blocks need. Shuffling pays if the points of a block are spread over a scene that does not fit into the memory of a
    worker.

    A point in float64 moves 24 bytes to its shard, and its answer 32 bytes back besides fields other than distance and
    primitive; points near the border of shards move several times. The graph has 4 n s + 3 n + 2 s tasks for n blocks
    and s shards, so keep n s below 100,000 by large blocks. All points are in the memory of the workers at the same
    time, and those of one shard in the memory of one worker. With few shards, or blocks that need few of them, the
    default is better.

    Examples
    --------
    >>> import dask.array as da, p2m, p2m.dask
    >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [10, 0, 0]], points=[0, 1]))
    >>> points = da.from_array([[1, 0, 0], [7, 0, 0]], chunks=(1, 3))
    >>> answer = p2m.dask.closest(points, index, fields=("distance", "point"), max_distance=5.0)
    >>> distance, point = dask.compute(*answer)
    >>> distance.tolist(), point.tolist()
    ([1.0, 3.0], [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    """
    names = (fields,) if isinstance(fields, str) else tuple(fields)
    outputs(names, (0,), None, FIELDS, names)
    checked_limits(max_distance, epsilon, max_visits, certified)
    source = index_source(index, map)
    if shuffle:
        if epsilon != 0.0 or max_visits is not None or certified:
            raise ValueError("shuffle: it has neither epsilon, max_visits nor certified")
        if not (isinstance(source, IndexFile) and is_shard_folder(source.path)):
            raise ValueError("shuffle: the index is no folder of shards that this process can read")
        query = Query(source, names, max_distance, thread_count(threads))
        return LazyClosestPoints(_shuffled(_points(points, "points"), query))
    options = {
        "fields": names,
        "max_distance": max_distance,
        "epsilon": epsilon,
        "max_visits": max_visits,
        "certified": certified,
        "threads": thread_count(threads),
    }
    arrays = {"points": _points(points, "points")}
    return LazyClosestPoints(_columns("closest", arrays, source, options, FIELDS, names))


def distance(
    points: Any,
    index: Any,
    *,
    max_distance: float | None = None,
    shuffle: bool = False,
    threads: int = 1,
    map: bool = False,
) -> da.Array:
    """Return the distances of query points from the scene, as `p2m.Index.distance` does.

    Parameters
    ----------
    points, index, threads, map
        As the module documents them.
    max_distance : float, optional
        The largest distance of an answer, inclusive; infinite distances are beyond it.
    shuffle : bool, optional
        Whether points go to the shards that they need, as for `closest`.

    Returns
    -------
    dask.array.Array of float64, shape (...)

    Examples
    --------
    >>> import numpy as np, p2m, p2m.dask
    >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
    >>> p2m.dask.distance(np.array([[0, 3, 4], [0, 0, 1]]), index).compute()
    array([5., 1.])
    """
    limits: dict[str, Any] = {"max_distance": max_distance, "shuffle": shuffle}
    return closest(points, index, fields="distance", threads=threads, map=map, **limits)["distance"]


def signed_distance(
    points: Any,
    index: Any,
    *,
    sign: Literal["auto", "winding", "parity"] = "auto",
    inside: Literal["negative", "positive"] = "negative",
    max_distance: float | None = None,
    threads: int = 1,
    map: bool = False,
) -> da.Array:
    """Return signed distances from a surface, as `p2m.Index.signed_distance` does.

    Parameters
    ----------
    points, index, threads, map
        As the module documents them.
    sign, inside, max_distance
        As for `p2m.Index.signed_distance`.

    Returns
    -------
    dask.array.Array of float64, shape (...)

    Notes
    -----
    Each process prepares the signs at its first block. Shards have only the rule ``"auto"``, so other rules are an
    error of the computation.

    Examples
    --------
    >>> import numpy as np, p2m, p2m.dask
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> solid = p2m.Index(p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> p2m.dask.signed_distance(np.array([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25]]), solid).compute()
    array([-0.125,  2.   ])
    """
    check_choice(sign, "sign", SIGNS)
    check_choice(inside, "inside", INSIDE)
    largest_distance(max_distance)
    options = {"sign": sign, "inside": inside, "max_distance": max_distance, "threads": thread_count(threads)}
    arrays = {"points": _points(points, "points")}
    return _column("signed_distance", arrays, index_source(index, map), options, np.dtype(np.float64))


def rays(
    origins: Any,
    directions: Any,
    index: Any,
    mode: Literal["first", "any", "count", "crossings"] = "first",
    *,
    t_min: float = 0.0,
    t_max: float = float("inf"),
    radius: float = 0.0,
    fields: str | Sequence[str] | None = None,
    threads: int = 1,
    map: bool = False,
) -> Any:
    """Cast rays at the scene, as `p2m.Index.rays` does.

    Parameters
    ----------
    origins, directions : dask.array.Array or array_like, shape (..., 3)
        The origins and directions of the rays, which are broadcast against each other.
    index, threads, map
        As the module documents them.
    mode : {"first", "any", "count", "crossings"}, optional
        What to return, as for `p2m.Index.rays`. The mode ``"all"`` is missing, because the shapes of its arrays are not
        known in advance.
    t_min, t_max, radius, fields
        As for `p2m.Index.rays`.

    Returns
    -------
    LazyFirstHits or dask.array.Array, shape (...)
        For ``"first"`` a record of lazy arrays, for ``"any"`` an array of bool, otherwise one of int64.

    Examples
    --------
    >>> import dask.array as da, p2m, p2m.dask
    >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
    >>> origins = da.from_array([[1, 1, 3], [9, 9, 3]], chunks=(1, 3))
    >>> p2m.dask.rays(origins, [0, 0, -2], index).t.compute()
    array([1.5, inf])
    >>> p2m.dask.rays(origins, [0, 0, -2], index, "any").compute()
    array([ True, False])
    """
    types = {"any": np.dtype(np.bool_), "count": np.dtype(np.int64), "crossings": np.dtype(np.int64)}
    if mode != "first" and mode not in types:
        raise ValueError(f"mode: {mode!r} is none of first, {', '.join(types)}")
    if not t_min <= t_max:
        raise ValueError(f"t_min, t_max: no parameter lies between {t_min} and {t_max}")
    options = {
        "mode": mode,
        "t_min": t_min,
        "t_max": t_max,
        "radius": not_negative(radius, "radius"),
        "threads": thread_count(threads),
    }
    arrays = {"origins": _points(origins, "origins"), "directions": _points(directions, "directions")}
    source = index_source(index, map)
    if mode != "first":
        if fields is not None:
            raise ValueError(f"fields: the mode {mode!r} has none")
        return _column("rays", arrays, source, options, types[mode])
    names = ("t", "primitive") if fields is None else (fields,) if isinstance(fields, str) else tuple(fields)
    outputs(names, (0,), None, HIT_FIELDS, names)
    return LazyFirstHits(_columns("rays", arrays, source, {**options, "fields": names}, HIT_FIELDS, names))


def field(
    index: Any,
    origin: ArrayLike,
    spacing: float,
    shape: Sequence[int],
    *,
    chunks: Any = "auto",
    signed: bool = False,
    sign: Literal["auto", "winding", "parity"] = "auto",
    band: float | None = None,
    threads: int = 1,
    map: bool = False,
) -> da.Array:
    """Return distances at the points of a regular grid, as `p2m.Index.field` does.

    Parameters
    ----------
    index, threads, map
        As the module documents them. Shards have no fields.
    origin, spacing, shape, signed, sign, band
        As for `p2m.Index.field`.
    chunks : int, tuple or str, optional
        The chunks of the array, as for ``dask.array.from_array``.

    Returns
    -------
    dask.array.Array of float32, shape (x, y, z)
        The values are the same bits as those of `p2m.Index.field`, apart from wrong signs of surfaces that intersect
        themselves.

    Raises
    ------
    ValueError
        For a grid without points, and during the computation as `p2m.Index.field` does.

    Notes
    -----
    A block that has more points than the scene has primitives sorts the primitives first. This takes a small part of
    the time if the block has several times as many points.

    Examples
    --------
    >>> import p2m, p2m.dask
    >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
    >>> grid = p2m.dask.field(index, (0, 0, 0), 3.0, (2, 1, 2), chunks=(1, 1, 2))
    >>> grid.compute()[:, 0, :].tolist()
    [[0.0, 3.0], [3.0, 4.242640495300293]]
    """
    corner, counts = grid_of(origin, shape)
    dtype = np.dtype(np.float32)
    normal = da.core.normalize_chunks(chunks, counts, dtype=dtype)
    options = {
        "origin": corner,
        "spacing": real(spacing, "spacing"),
        "signed": bool(signed),
        "sign": sign,
        "band": None if band is None else not_negative(band, "band"),
        "threads": thread_count(threads),
    }
    source = index_source(index, map)
    if isinstance(source, IndexFile) and is_shard_folder(source.path):
        raise ValueError("index: shards have no fields: ask for the distances of points")
    token = tokenize(_key(source), options, normal)
    return da.map_blocks(
        _grid_block,
        chunks=normal,
        dtype=dtype,
        meta=np.empty((0, 0, 0), dtype),
        name=f"p2m-field-{token}",
        source=_in_graph(source),
        options=options,
    )


_KEYS: weakref.WeakKeyDictionary[Index, str] = weakref.WeakKeyDictionary()
"""The keys of indexes that were not loaded from a file."""


def _key(source: IndexFile | Index) -> Any:
    """Return a key that is the same for the same index, and different for different ones as far as this can be
    known."""
    if isinstance(source, IndexFile):
        return source.path, source.checksum, source.is_mapped, source.max_bytes
    return _KEYS.setdefault(source, uuid.uuid4().hex)


def _in_graph(source: IndexFile | Index) -> Any:
    """Return the representation of an index in the graph, where the bytes of an index occur once and not in every
    task."""
    return source if isinstance(source, IndexFile) else dask.delayed(source, name=f"p2m-index-{_key(source)}")


def _points(values: Any, name: str) -> da.Array:
    """Return a Dask array whose last axis is one chunk of x, y and z."""
    if not isinstance(values, da.Array):
        if not (hasattr(values, "shape") and hasattr(values, "dtype")):
            values = np.asarray(values)
        axes = len(values.shape)
        values = da.from_array(values, chunks=("auto",) * (axes - 1) + (-1,) if axes else -1)
    if values.dtype.kind not in "iuf":
        raise TypeError(f"{name}: the type is {values.dtype}, but coordinates are real numbers")
    if values.ndim == 0 or values.shape[-1] != 3:
        raise ValueError(f"{name}: the shape is {values.shape}, but the last axis has x, y and z")
    return values if len(values.chunks[-1]) == 1 else values.rechunk({values.ndim - 1: -1})


def _column(
    query: str, arrays: Mapping[str, da.Array], source: IndexFile | Index, options: dict[str, Any], dtype: np.dtype[Any]
) -> da.Array:
    """Return the lazy array of a query with a single result."""
    return _columns(query, arrays, source, options, {"value": (dtype, ())}, ("value",))["value"]


def _columns(
    query: str,
    arrays: Mapping[str, da.Array],
    source: IndexFile | Index,
    options: dict[str, Any],
    known: _Known,
    names: Sequence[str],
) -> dict[str, da.Array]:
    """Return the lazy arrays of a query.

    A layer of the graph has a task for each block. The task returns a dictionary with the arrays of all fields.
    """
    token = tokenize(query, [array.name for array in arrays.values()], _key(source), options)
    blocks = _aligned(list(arrays.values()))
    answers = da.map_blocks(
        _answer_block,
        *blocks,
        chunks=_chunks(blocks),
        dtype=object,
        # The chunks of this array are dictionaries. It has the axes of the points, and is never visible to users.
        meta=np.empty((0,) * max(array.ndim for array in blocks), object),
        name=f"p2m-{query}-{token}",
        query=query,
        source=_in_graph(source),
        options=options,
        grid=_BlockGrid.of(blocks),
    )
    return _fields_of(answers, f"p2m-{query}", token, known, names)


def _shuffled(points: da.Array, query: Query) -> dict[str, da.Array]:
    """Return the lazy arrays of a closest-point query that is shuffled to shards."""
    shard_count = len(query.open().shards)
    token = tokenize("shuffle", points.name, _key(query.source), query.fields, query.max_distance, query.threads)
    blocks = list(np.ndindex(points.numblocks))

    def key(task: str, *place: int) -> tuple[Any, ...]:
        return (f"p2m-{task}-{token}", *place)

    send = functools.partial(_send_block, query=query, grid=_BlockGrid.of([points]))
    graph: dict[tuple[Any, ...], tuple[Any, ...]] = {}
    for phase, shard in itertools.product(range(2), range(shard_count)):
        pieces = [key("piece", phase, shard, b) for b in range(len(blocks))]
        graph[key("ask", phase, shard)] = (functools.partial(ask, shard=shard, query=query), pieces)
        for b, piece in enumerate(pieces):
            graph[piece] = (Sent.piece, key("send", phase, b), shard)
            graph[key("answer", phase, b, shard)] = (operator.getitem, key("ask", phase, shard), b)
    for b, block in enumerate(blocks):
        nearest, others = ([key("answer", phase, b, shard) for shard in range(shard_count)] for phase in range(2))
        first, second = key("send", 0, b), key("send", 1, b)
        graph[first] = (functools.partial(send, block_id=block), (points.name, *block))
        graph[second] = (functools.partial(send_to_others, query=query), first, nearest)
        graph[key("shuffle", *block)] = (functools.partial(join, query=query), first, nearest, second, others)
    name = key("shuffle")[0]
    answers = da.Array(
        HighLevelGraph.from_collections(name, graph, dependencies=[points]),
        name,
        points.chunks,
        meta=np.empty((0,) * points.ndim, object),
    )
    return _fields_of(answers, "p2m-shuffle", token, FIELDS, query.fields)


def _fields_of(answers: da.Array, prefix: str, token: str, known: _Known, names: Sequence[str]) -> dict[str, da.Array]:
    """Return the lazy arrays of fields. A layer of the graph for each takes its array out of the dictionaries."""
    axes = tuple(range(answers.ndim))
    columns = {}
    for name in names:
        dtype, tail = known[name]
        ends = tuple(range(len(axes), len(axes) + len(tail)))
        columns[name] = da.blockwise(
            _column_block,
            axes[:-1] + ends,
            answers,
            axes,
            new_axes=dict(zip(ends, tail)),
            # The last axis of the dictionaries is one chunk, which arrives as a list with one item.
            concatenate=None,
            dtype=dtype,
            meta=np.empty((0,) * (len(axes) - 1 + len(tail)), dtype),
            name=f"{prefix}-{name}-{token}",
            column=name,
        )
    return columns


def _is_known(array: da.Array) -> bool:
    """Return whether the sizes of all chunks are known."""
    return not any(math.isnan(size) for size in array.shape)


def _aligned(arrays: list[da.Array]) -> list[da.Array]:
    """Return arrays rechunked to the same chunks along the axes that are broadcast against each other."""
    if len(arrays) == 1 or not all(_is_known(array) for array in arrays):
        return arrays
    np.broadcast_shapes(*(array.shape for array in arrays))
    pairs = itertools.chain.from_iterable((array, tuple(range(array.ndim))[::-1]) for array in arrays)
    return list(da.core.unify_chunks(*pairs)[1])


def _chunks(arrays: Sequence[da.Array]) -> tuple[tuple[int, ...], ...]:
    """Return the chunks of arrays after broadcasting, which Dask computes only for one array."""
    chunks: list[tuple[int, ...]] = []
    for axis in range(-max(array.ndim for array in arrays), 0):
        sizes = [array.chunks[axis] for array in arrays if array.ndim >= -axis]
        chunks.append(max(sizes, key=lambda size: (size != (1,), len(size))))
    return tuple(chunks)


class _BlockGrid(NamedTuple):
    """The position of each block of points among all points, if all chunks of an axis but the last have one size."""

    shape: tuple[int, ...]
    """The leading axes of all points."""
    steps: tuple[int, ...]
    """The sizes of the chunks along these axes."""

    @classmethod
    def of(cls, arrays: Sequence[da.Array]) -> _BlockGrid | None:
        """Return the grid of the blocks of arrays after broadcasting."""
        if not all(_is_known(array) for array in arrays):
            return None
        leading = _chunks(arrays)[:-1]
        for sizes in leading:
            if any(size != sizes[0] for size in sizes[:-1]) or sizes[-1] > sizes[0]:
                return None
        return cls(tuple(sum(sizes) for sizes in leading), tuple(sizes[0] for sizes in leading))

    def row(self, row: int, block_shape: tuple[int, ...], block: tuple[int, ...]) -> int:
        """Return the row among all flattened points, given the row in a block."""
        inner = np.unravel_index(row, block_shape)
        outer = [int(i) + step * number for i, step, number in zip(inner, self.steps, block)]
        return int(np.ravel_multi_index(outer, self.shape)) if outer else row


_ROW = re.compile(r"(\w+): row (\d+) (.*)", re.DOTALL)


@contextlib.contextmanager
def _rows_of_all(
    blocks: Sequence[NDArray[Any]], grid: _BlockGrid | None, block_id: tuple[int, ...]
) -> Iterator[None]:
    """Replace the row of a block in the message of an error by the row among all points."""
    try:
        yield
    except ValueError as error:
        found = _ROW.fullmatch(str(error))
        if found is None:
            raise
        name, row, rest = found.groups()
        shape = np.broadcast_shapes(*(block.shape for block in blocks))[:-1]
        if grid is None:
            raise ValueError(f"{name}: row {row} of the block {block_id[:-1]} {rest}") from error
        raise ValueError(f"{name}: row {grid.row(int(row), shape, block_id[:-1])} {rest}") from error


def _send_block(block: NDArray[Any], *, query: Query, grid: _BlockGrid | None, block_id: tuple[int, ...]) -> Sent:
    """Send each point of a block to the shard with the nearest box."""
    with _rows_of_all([block], grid, block_id):
        return send_to_nearest(block, query)


def _answer_block(
    *blocks: NDArray[Any],
    query: str,
    source: IndexFile | Index,
    options: dict[str, Any],
    grid: _BlockGrid | None,
    block_id: tuple[int, ...],
) -> Columns:
    """Return the arrays of all fields for a block of points or rays."""
    answer = getattr(opened(source, options["threads"]), query)
    with _rows_of_all(blocks, grid, block_id):
        arrays = answer(*blocks, **options)
    return arrays.asdict() if isinstance(arrays, Record) else {"value": arrays}


def _column_block(answers: list[Columns], *, column: str) -> NDArray[Any]:
    """Return the array of one field of a block."""
    return answers[0][column]


def _grid_block(
    *, source: IndexFile | Index, options: dict[str, Any], block_info: dict[Any, Any] | None = None
) -> NDArray[np.float32]:
    """Return a block of a field."""
    assert block_info is not None
    ranges = block_info[None]["array-location"]
    first, shape = [start for start, _ in ranges], [stop - start for start, stop in ranges]
    index = opened(source, options["threads"])
    assert isinstance(index, Index)
    return index.field(shape=shape, first=first, **options)
