"""Hausdorff distances between certified bounds."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._arrays import Progress, not_negative, one_transform, running, thread_count, whole
from ._index import index_of, scene_of
from ._scene import Scene


class HausdorffDistance(NamedTuple):
    """A Hausdorff distance between bounds. Arrays of two have the first scene first."""

    lower_bound: float
    """A certified lower bound, which a point of one scene attains."""
    upper_bound: float
    """A certified upper bound. It exceeds the lower bound by at most the tolerance, unless the limit of queries was
    reached or rounding prevents it."""
    points: NDArray[np.float64]
    """The point that attains the lower bound, and its closest point in the other scene: shape (2, 3)."""
    primitives: NDArray[np.int64]
    """The primitives that contain the points: shape (2,)."""
    from_scene: int
    """The scene that contains the point farthest from the other scene: 0 or 1."""
    queries: int
    """The number of queries that were asked."""
    reached: bool
    """Whether the bounds differ by at most the tolerance. If not, the limit of queries ended the search, or rounding
    allows no smaller difference."""


def hausdorff(
    a: Any,
    b: Any,
    tolerance: float | None = None,
    *,
    one_sided: bool = False,
    transform: ArrayLike | None = None,
    max_queries: int = 2**24,
    threads: int | None = None,
    progress: Progress = None,
) -> HausdorffDistance:
    """Return the Hausdorff distance of two scenes: the largest distance of a point of either scene from the other one.

    All points of triangles, segments and points count, not only vertices.

    Parameters
    ----------
    a, b : Index, Scene or object
        The scenes. An index of any backend is used, and for other objects, of which `Scene.of` makes a scene, a tree of
        boxes is built.
    tolerance : float, optional
        The largest difference of the bounds, in the unit of the scenes. By default it is the diagonal of the box of
        both scenes divided by 10,000. With infinity only vertices are asked.
    one_sided : bool, optional
        Whether only points of `a` are measured, by their distance from `b`.
    transform : array_like, shape (4, 4), optional
        The rotation and the translation that move `b`, as for `Index.closest_pair`. A tree of the moved scene is built.
    max_queries : int, optional
        The largest number of queries besides those of vertices. Each takes 80 bytes. When it is reached, the bounds so
        far are returned.
    threads : int, optional
        The number of threads, as for `Index`.
    progress : callable, True or "tqdm", optional
        It is called with the number of queries so far and the largest possible number. Most searches end long before
        it.

    Returns
    -------
    HausdorffDistance
        The bounds and the points that attain them, the same for every backend and number of threads.

    Raises
    ------
    ValueError
        If a scene is empty, or for a wrong argument.
    KeyboardInterrupt
        At once.

    Examples
    --------
    >>> import p2m
    >>> beam = p2m.Scene([[0, 0, 0], [8, 0, 0]], segments=[[0, 1]])
    >>> posts = p2m.Scene([[0, 0, 0], [8, 0, 0]], points=[0, 1])
    >>> found = p2m.hausdorff(beam, posts, 0.001)
    >>> found.lower_bound <= 4.0 <= found.upper_bound <= found.lower_bound + 0.001
    True
    >>> found.points[0].tolist(), found.from_scene
    ([4.0, 0.0, 0.0], 0)
    """
    count = thread_count(threads)
    matrix = one_transform(transform, "transform")
    if matrix is not None:
        b = Scene._from_raw(scene_of(b)._raw.transformed(matrix.reshape(-1)))
    max_queries = whole(max_queries, "max_queries", 0, 2**64 - 1)
    scenes = [scene_of(a), scene_of(b)]
    if tolerance is None:
        if len(scenes[0]) == 0 or len(scenes[1]) == 0:
            raise ValueError("a scene is empty, so there is no Hausdorff distance")
        low = np.minimum(scenes[0].bounds[0], scenes[1].bounds[0])
        high = np.maximum(scenes[0].bounds[1], scenes[1].bounds[1])
        tolerance = float(np.linalg.norm(high - low)) / 1e4
    margin = not_negative(tolerance, "tolerance")
    # A one-sided distance needs no index of the first scene.
    first = None if one_sided else index_of(a, count, scenes[0])._raw
    second = index_of(b, count, scenes[1])._raw
    with running(count, progress, "comparing", "queries") as run:
        found = _p2m.hausdorff(scenes[0]._raw, first, second, margin, max_queries, run)
    if found is None:
        raise ValueError("a scene is empty, so there is no Hausdorff distance")
    return HausdorffDistance(*found)
