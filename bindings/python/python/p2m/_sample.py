"""Random points on and around scenes, and calls for many scenes at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _p2m
from ._arrays import Progress, not_negative, thread_count, usual, whole
from ._index import Index, scene_of

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


class SurfaceSamples(NamedTuple):
    """Random points of a scene."""

    points: NDArray[Any]
    """The points, shape (n, 3)."""
    primitives: NDArray[np.int64]
    """The primitive of each point, shape (n,)."""


class SdfSamples(NamedTuple):
    """Random points and their distances, first the near ones and then the uniform ones."""

    points: NDArray[Any]
    """The points, shape (n, 3)."""
    distances: NDArray[Any]
    """The distance of each point, negative inside, shape (n,); nan where the side is not defined."""


def sample_surface(
    mesh: Any, count: int, *, seed: int = 0, dtype: DTypeLike = np.float64, threads: int | None = None
) -> SurfaceSamples:
    """Return random points of a surface, evenly distributed by area.

    The points are the same bits on every platform and for every number of threads, and a longer list begins with the
    shorter one. In a scene without triangles, points are distributed by the length of segments, and in a scene of only
    points they are chosen from these.

    Parameters
    ----------
    mesh : Index, Scene or object
        The scene, or an object that `Scene.of` makes a scene of, such as a path.
    count : int
        The number of points.
    seed : int, optional
        The seed of the random numbers.
    dtype : float64 or float32, optional
        The type of the points.
    threads : int, optional
        The number of threads, as for `Index`.

    Raises
    ------
    ValueError
        If the scene is empty, or for a wrong argument.

    Examples
    --------
    >>> import p2m
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]]
    >>> tent = p2m.Scene(corners, triangles=[[0, 1, 2], [0, 1, 3]])
    >>> found = p2m.sample_surface(tent, 3000)
    >>> found.points.shape, bool(1900 < (found.primitives == 1).sum() < 2100)
    ((3000, 3), True)
    """
    scene = scene_of(mesh)
    number = whole(count, "count", 0, 2**40)
    points, primitives = _p2m.sample_surface(scene._raw, number, [], _seed(seed), thread_count(threads))
    return SurfaceSamples(points.astype(_real(dtype), copy=False), primitives)


def sample_sdf(
    mesh: Any,
    *,
    near: int = 0,
    uniform: int = 0,
    sigma: float | Sequence[float] | None = None,
    box_scale: float = 1.1,
    seed: int = 0,
    dtype: DTypeLike = np.float64,
    sign: Literal["auto", "winding", "parity"] = "auto",
    threads: int | None = None,
    progress: Progress = None,
) -> SdfSamples:
    """Return random points with their signed distances, as networks are trained with.

    The points are the same bits on every platform and for every number of threads.

    Parameters
    ----------
    mesh : Index, Scene or object
        The mesh, or an object that `Scene.of` makes a scene of, such as a path. For other objects than an index,
        ``"auto"`` chooses one for the number of points.
    near : int, optional
        The number of points near the surface: points as of `sample_surface`, moved by noise.
    uniform : int, optional
        The number of points that are uniformly distributed in the box.
    sigma : float or sequence of floats, optional
        The standard deviation of the noise in each coordinate. With several values, point i has value i modulo their
        number. By default it is a hundredth of the diagonal of the box of the mesh.
    box_scale : float, optional
        The factor by which the box of the mesh is enlarged for uniform points.
    seed : int, optional
        The seed of the random numbers.
    dtype : float64 or float32, optional
        The type of points and distances. The distances are those of the rounded points.
    sign : {"auto", "winding", "parity"}, optional
        The rule that decides which points are inside, as for `Index.signed_distance`.
    threads, progress
        As for `Index.closest`.

    Raises
    ------
    ValueError
        If the scene is empty or has segments or points, or for a wrong argument.

    Examples
    --------
    >>> import numpy as np, p2m
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> found = p2m.sample_sdf(solid, near=3000, uniform=1000, sigma=[0.01, 0.1], dtype=np.float32)
    >>> found.points.shape, found.distances.dtype, bool((found.distances < 0).any())
    ((4000, 3), dtype('float32'), True)
    >>> np.savez("samples.npz", **found._asdict()) # doctest: +SKIP
    """
    counts = [whole(near, "near", 0, 2**40), whole(uniform, "uniform", 0, 2**40)]
    scale, kind, number = _finite(box_scale, "box_scale"), _real(dtype), _seed(seed)
    scene = scene_of(mesh)
    if len(scene) == 0:
        raise ValueError("the scene is empty, so it has no samples")
    count = thread_count(threads)
    low, high = scene.bounds
    if sigma is None:
        sigma = float(np.linalg.norm(high - low)) / 100.0
    sigmas = [_finite(one, "sigma") for one in np.atleast_1d(np.asarray(sigma, float))]
    if not sigmas:
        raise ValueError("sigma: there is none")
    around, _ = _p2m.sample_surface(scene._raw, counts[0], sigmas, number, count)
    middle, half = (low + high) / 2.0, (high - low) / 2.0 * scale
    inside = _p2m.sample_box((middle - half).tolist(), (middle + half).tolist(), counts[1], number, count)
    points = np.empty((sum(counts), 3), kind)
    points[: counts[0]], points[counts[0] :] = around, inside
    del around, inside
    index = mesh if isinstance(mesh, Index) else Index(scene, threads=threads, queries=len(points))
    distances = index.signed_distance(points, sign=sign, threads=threads, progress=progress)
    return SdfSamples(points, distances.astype(kind, copy=False))


def map(
    function: Callable[[_Item], _Result], items: Iterable[_Item], *, threads: int | None = None
) -> Iterator[_Result]:
    """Call a function for many items, such as small meshes, on all cores, and yield the results in their order.

    The function is called by Python threads, which run in parallel while they are in functions of p2m. Within it, the
    functions of p2m use one thread each unless they are given another number. Only a few items are computed in advance
    of the result that is taken, so the results need not fit into memory together.

    Parameters
    ----------
    function : callable
        It is called with one item.
    items : iterable
        Meshes, paths or anything else.
    threads : int, optional
        The number of threads, as for `Index`.

    Yields
    ------
    object
        The result of the function for each item. An exception of the function is raised here, and the remaining items
        are not started.

    Examples
    --------
    >>> import p2m
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> solids = [p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])] * 10
    >>> for found in p2m.map(lambda solid: p2m.sample_sdf(solid, near=100, uniform=100), solids):
    ...     assert found.distances.shape == (200,)
    """
    count = thread_count(threads)
    waiting: deque[Future[_Result]] = deque()
    rest = iter(items)
    with ThreadPoolExecutor(count, initializer=_use_one_thread) as pool:
        try:
            waiting.extend(pool.submit(function, item) for item in islice(rest, 2 * count))
            while waiting:
                result = waiting.popleft().result()
                waiting.extend(pool.submit(function, item) for item in islice(rest, 1))
                yield result
        finally:
            for future in waiting:
                future.cancel()


def _use_one_thread() -> None:
    usual.threads = 1


def _finite(value: float, name: str) -> float:
    """Return a finite number that is not negative."""
    number = not_negative(value, name)
    if number == float("inf"):
        raise ValueError(f"{name}: {number} is not finite")
    return number


def _seed(seed: int) -> int:
    return whole(seed, "seed", 0, 2**64 - 1)


def _real(dtype: DTypeLike) -> np.dtype[Any]:
    kind = np.dtype(dtype)
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype: {kind} is neither float64 nor float32")
    return kind
