"""Alignment of scans with scenes."""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _p2m
from ._arrays import coordinates, real, thread_count, unmasked
from ._index import index_of, scene_of
from ._scene import Scene


class Alignment(NamedTuple):
    """The pose in which a scan lies on a scene. Lengths are in the unit of the scene."""

    matrix: NDArray[np.float64]
    """The matrix that moves the scan, for column vectors (x, y, z, 1): shape (4, 4)."""
    points: NDArray[np.float64]
    """The moved points, which are accurate even far from the origin: shape (n, 3)."""
    rms: float
    """The root mean square of the distances of all points but outliers."""
    coverage: float
    """The part of the points that are not outliers."""
    scale: float
    """The factor by which the matrix scales, which is 1 unless scaling was requested."""
    converged: bool
    """Whether the last step was small enough."""
    rounds: list[tuple[int, float, float]]
    """The number of points, the rms and the length of the step of each round after the search."""
    ambiguity: str | None
    """The reason why another pose would fit about as well, if one would."""
    other: NDArray[np.float64] | None
    """The matrix of another pose that fits about as well, if one was found."""


def scan_points(scan: Any) -> tuple[NDArray[Any], Scene | None]:
    """Return the points of a scan, and its scene unless it is an array."""
    if isinstance(scan, (np.ndarray, list)):
        array = unmasked(scan, "scan")
        points = array if array.dtype == np.float32 else array.astype(np.float64, copy=False)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"scan: the shape is {points.shape} instead of (n, 3)")
        return points, None
    scene = scene_of(scan)
    return scene.vertices, scene


def align(
    scan: Any,
    part: Any,
    *,
    overlap: float = 1.0,
    scale: bool = False,
    search: bool = True,
    point_to_point: bool = False,
    threads: int | None = None,
) -> Alignment:
    """Return the rotation and translation that bring the points of a scan onto a part.

    It uses the iterative closest point method with distances to planes, robust weights, and a search over rotations for
    the start. The result is the same for every backend and number of threads, bit for bit.

    Parameters
    ----------
    scan : array_like of shape (n, 3), Scene or object
        The points, or an object that `Scene.of` makes a scene of, such as a path, whose vertices are the points. Points
        that are not finite are left out.
    part : Index, Scene or object
        The scene that the scan is brought onto. An index of any backend is used, and for other objects a tree of boxes
        is built.
    overlap : float, optional
        The part of the points that lie on the scene, above 0 and at most 1. By default outliers of up to a third have
        no weight.
    scale : bool, optional
        Whether the scan is scaled as well.
    search : bool, optional
        Whether to search for a start, so that any rotation and distance can be found. Without it, the scan starts as it
        is.
    point_to_point : bool, optional
        Whether to use distances to points instead of planes, which suits scenes of points.
    threads : int, optional
        The number of threads, as for `Index`.

    Returns
    -------
    Alignment
        The matrix, the moved points and the quality of the fit. A warning says if another pose would fit about as well.

    Raises
    ------
    ValueError
        If the part is empty, if fewer than six points are finite, or for a wrong argument.
    KeyboardInterrupt
        At once.

    Examples
    --------
    >>> import numpy as np, p2m
    >>> corners = np.array([[0, 0, 0], [5, 0, 0], [0, 3, 0], [0, 0, 2.0]])
    >>> part = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> weights = np.random.default_rng(1).dirichlet([1, 1, 1], 1000)
    >>> points = np.concatenate([weights @ corners[face] for face in part.triangles])
    >>> found = p2m.align(points @ [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]] + [7, 8, 9], part)
    >>> bool(found.rms < 1e-9), bool(np.abs(found.points - points).max() < 1e-6)
    (True, True)
    """
    points, _ = scan_points(scan)
    count = thread_count(threads)
    index = index_of(part, threads)
    flat = coordinates(points, "scan").reshape(-1)
    found = Alignment(
        *_p2m.align(flat, index._raw, point_to_point, scale, real(overlap, "overlap"), search, count)
    )
    if found.ambiguity is not None:
        warnings.warn(found.ambiguity, stacklevel=2)
    return found
