"""The functions of libigl for distances from meshes, in which inside is negative.

libigl is not needed. Its functions build a tree in every call. The functions here keep the indexes of the four most
recently used meshes, and find them by the content of the arrays, of which they have copies: a call compares all bytes,
which takes about a millisecond for a mesh of 100,000 triangles. For many calls with few points use `AABB`, which
compares nothing. `clear_cache` frees the memory.

>>> import numpy as np
>>> import p2m.compat.igl as igl
>>> V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
>>> F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
>>> S, I, C, N = igl.signed_distance(np.array([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25]]), V, F)
>>> S, I
(array([-0.125,  2.   ]), array([2, 1]))

Arrays may have any real and integer types, while libigl demands float64 and int64.
"""

from __future__ import annotations

import enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._hausdorff import hausdorff as _hausdorff
from .._index import Index
from .._scene import Scene
from ._shared import ContentCache, Rays, all_hits, castable

__all__ = [
    "AABB",
    "SIGNED_DISTANCE_TYPE_DEFAULT",
    "SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER",
    "SIGNED_DISTANCE_TYPE_PSEUDONORMAL",
    "SIGNED_DISTANCE_TYPE_UNSIGNED",
    "SIGNED_DISTANCE_TYPE_WINDING_NUMBER",
    "SignedDistanceType",
    "clear_cache",
    "hausdorff",
    "point_mesh_squared_distance",
    "signed_distance",
]


class SignedDistanceType(enum.IntEnum):
    """The rules by which `signed_distance` tells inside from outside, with the numbers of libigl."""

    SIGNED_DISTANCE_TYPE_PSEUDONORMAL = 0
    SIGNED_DISTANCE_TYPE_WINDING_NUMBER = 1
    SIGNED_DISTANCE_TYPE_DEFAULT = 2
    SIGNED_DISTANCE_TYPE_UNSIGNED = 3
    SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER = 4


SIGNED_DISTANCE_TYPE_PSEUDONORMAL = SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
SIGNED_DISTANCE_TYPE_WINDING_NUMBER = SignedDistanceType.SIGNED_DISTANCE_TYPE_WINDING_NUMBER
SIGNED_DISTANCE_TYPE_DEFAULT = SignedDistanceType.SIGNED_DISTANCE_TYPE_DEFAULT
SIGNED_DISTANCE_TYPE_UNSIGNED = SignedDistanceType.SIGNED_DISTANCE_TYPE_UNSIGNED
SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER = SignedDistanceType.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER


class _Mesh:
    """An index over elements of one kind, and data that is derived from them."""

    def __init__(self, vertices: NDArray[np.float64], elements: NDArray[np.int64]) -> None:
        self.vertices, self.elements = vertices, elements
        width = elements.shape[1]
        scene = Scene(
            vertices,
            triangles=elements if width == 3 else None,
            segments=elements if width == 2 else None,
            points=elements[:, 0] if width == 1 else None,
        )
        self.index = Index(scene)


_cache: ContentCache[_Mesh] = ContentCache(_Mesh)


def clear_cache() -> None:
    """Forget the indexes of all meshes."""
    _cache.clear()


def point_mesh_squared_distance(
    P: ArrayLike, V: ArrayLike, Ele: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Return the squared distances of points from triangles, edges or points.

    This replaces ``igl.point_mesh_squared_distance``.

    Parameters
    ----------
    P : array_like, shape (n, 3) or (n, 2)
        The query points, in space or in the plane.
    V : array_like, shape (v, 3) or (v, 2)
        The vertices.
    Ele : array_like of integers, shape (m, 3), (m, 2) or (m, 1)
        The vertices of the triangles, edges or points. They may be degenerate, such as the triangle [1, 2, 2], which
        is an edge.

    Returns
    -------
    sqrD : ndarray of float64, shape (n,)
        The squared distances.
    I : ndarray of int64, shape (n,)
        The nearest elements; of several equally near ones the first. libigl returns any of them.
    C : ndarray of float64, shape (n, 3) or (n, 2)
        The closest points.

    Raises
    ------
    ValueError
        For wrong shapes, indices without vertex, and coordinates that are not finite.

    Notes
    -----
    Without elements the distances are infinite, I is -1 and C is nan. There libigl 2.6.3 crashes, as it does if points
    occur twice.
    """
    points, mesh = _points_and_mesh(P, V, Ele)
    return _squared_distance(mesh, points, np.asarray(P).shape[1])


def _squared_distance(
    mesh: _Mesh, points: NDArray[np.float64], width: int
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    answer = mesh.index.closest(points, fields=("distance", "primitive", "point"))
    return np.square(answer.distance), answer.primitive, answer.point[:, :width]


def signed_distance(
    P: ArrayLike,
    V: ArrayLike,
    F: ArrayLike,
    sign_type: Any = SIGNED_DISTANCE_TYPE_DEFAULT,
    lower_bound: float = float("-inf"),
    upper_bound: float = float("inf"),
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the distances of points from a mesh, **negative inside** and positive outside.

    This replaces ``igl.signed_distance``.

    Parameters
    ----------
    P : array_like, shape (n, 3)
        The query points.
    V : array_like, shape (v, 3)
        The vertices.
    F : array_like of integers, shape (m, 3)
        The vertices of the triangles.
    sign_type : SignedDistanceType or int, optional
        The rule of signs, also as an object of libigl. By winding numbers, which is the default as well, a point is
        inside if its winding number exceeds a half in magnitude. By pseudonormals the sign is the same for a
        closed, consistently oriented surface. For any other surface, a point is inside if it is behind the closest
        point, seen along the normal there. Unsigned distances are positive.
    The range of distances that are needed. As in libigl, let b be the larger of their magnitudes. Points at a distance
    of b or more have no answer, nor have points nearer than ``b - (upper_bound - lower_bound)``.

    Returns
    -------
    S : ndarray of float64, shape (n,)
        The signed distances; nan without an answer because of the bounds.
    I : ndarray of int64, shape (n,)
        The nearest triangles; ``len(F) + 1`` without an answer, as in libigl.
    C : ndarray of float64, shape (n, 3)
        The closest points; nan without an answer, where libigl leaves memory as it is.
    N : ndarray of float64, shape (n, 3) or (0, 0)
        The normals of length 1 at the closest points, only with pseudonormals: of the triangle, of both triangles of an
        edge, or of all triangles of a vertex by their angles. They are nan without an answer.

    Raises
    ------
    ValueError
        For wrong shapes, indices without vertex, coordinates that are not finite, and unknown rules.

    Notes
    -----
    The magnitude of S is the distance. In libigl it is the distance times ``abs(1 - 2 w)`` with winding numbers w,
    which is wrong where w is not 0 or 1: for surfaces with holes, for several layers, for a surface that is inside out,
    and in the fifth digit for all surfaces with fast winding numbers. Here S is nan if rounding leaves it open whether
    w exceeds a half.
    """
    rule = SignedDistanceType(int(getattr(sign_type, "value", sign_type)))
    points, mesh = _points_and_mesh(P, V, F)
    if mesh.elements.shape[1] != 3 or np.asarray(P).shape[1] != 3:
        raise ValueError("signed_distance: points have three coordinates, and elements are triangles")
    is_normal = rule is SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    fields = ("distance", "primitive", "point", *(("normal",) if is_normal else ()))
    largest = max(abs(lower_bound), abs(upper_bound))
    smallest = max(largest - (upper_bound - lower_bound), 0.0) if largest < np.inf else 0.0
    answer = mesh.index.closest(points, max_distance=largest, fields=fields)
    S, I, C = answer.distance, answer.primitive, answer.point
    is_in = (S < largest) & (S >= smallest) if largest < np.inf else np.ones(len(S), np.bool_)
    S[~is_in], I[~is_in], C[~is_in] = np.nan, len(mesh.elements) + 1, np.nan
    N = np.empty((0, 0))
    is_answered = is_in & (I >= 0)
    if is_normal:
        N = np.full((len(S), 3), np.nan)
        N[is_answered] = np.nan_to_num(answer.normal[is_answered])
        if mesh.index._raw.sign_rule("auto", 1)[1] is None:
            S[is_in] = mesh.index.signed_distance(points[is_in])
        else:
            behind = np.einsum("ij,ij->i", points - C, np.nan_to_num(N)) < 0.0
            S[behind & is_answered] *= -1.0
    elif rule is not SIGNED_DISTANCE_TYPE_UNSIGNED:
        S[is_in] = mesh.index.signed_distance(points[is_in], sign="winding")
    return S, I, C, N


def hausdorff(
    VA: ArrayLike, FA: ArrayLike, VB: ArrayLike, FB: ArrayLike, tolerance: float | None = None
) -> float:
    """Return the Hausdorff distance of two meshes: the largest distance of a point of either mesh from the other one.

    This replaces ``igl.hausdorff``, which only asks vertices: it returns the largest distance of a vertex from the
    other mesh, and misses farther points inside of edges and triangles. Here all points count, within a tolerance.
    ``tolerance=float("inf")`` asks only vertices, as libigl does.

    Parameters
    ----------
    VA, VB : array_like, shape (v, 3) or (v, 2)
        The vertices of each mesh.
    FA, FB : array_like of integers, shape (m, 3), (m, 2) or (m, 1)
        The vertices of the triangles, edges or points of each mesh. Vertices of none do not count.
    tolerance : float, optional
        The result is certainly not above the distance, and below it by no more than this, by default the diagonal of
        the box of both meshes divided by 10,000. libigl has no such argument.

    Returns
    -------
    d : float
        The distance. `p2m.hausdorff` also returns the points and an upper bound.

    Raises
    ------
    ValueError
        For a mesh without elements, wrong shapes, indices without vertex, and coordinates that are not finite.
    """
    meshes = [_cache.get(*_mesh_arrays(V, F)) for V, F in ((VA, FA), (VB, FB))]
    return _hausdorff(meshes[0].index, meshes[1].index, tolerance).lower_bound


class AABB:
    """An index over a mesh for many calls, as ``igl.AABB`` has it.

    The methods take V and Ele as in libigl, but ignore them: they always use the mesh that was given to `init`.

    Examples
    --------
    >>> import numpy as np
    >>> import p2m.compat.igl as igl
    >>> V, Ele = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], float), np.array([[0, 1, 2]])
    >>> tree = igl.AABB()
    >>> tree.init(V, Ele)
    >>> sqrD, I, C = tree.squared_distance(V, Ele, np.array([[1.0, 1.0, 2.0]]))
    >>> sqrD, I
    (array([4.]), array([0]))
    """

    def __init__(self) -> None:
        self._mesh: _Mesh | None = None

    def init(self, V: ArrayLike, Ele: ArrayLike) -> None:
        """Build the index over the elements, which are copied.

        Parameters
        ----------
        V, Ele
            As for `point_mesh_squared_distance`.
        """
        vertices, elements = _mesh_arrays(V, Ele)
        self._mesh = _Mesh(vertices.copy(), elements.copy())

    def _checked(self) -> _Mesh:
        if self._mesh is None:
            raise ValueError("AABB: init was not called")
        return self._mesh

    def squared_distance(
        self, V: ArrayLike, Ele: ArrayLike, P: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
        """Return squared distances, elements and closest points, as `point_mesh_squared_distance` does.

        Parameters
        ----------
        V, Ele
            The mesh of `init`.
        P : array_like, shape (n, 3) or (n, 2)
            The query points.
        """
        points = _in_space(P, "P")
        return _squared_distance(self._checked(), points, np.asarray(P).shape[1])

    def intersect_ray(
        self, V: ArrayLike, Ele: ArrayLike, orig: ArrayLike, dir: ArrayLike
    ) -> list[list[tuple[int, float, float, float]]]:
        """Return all hits of rays.

        Parameters
        ----------
        V, Ele
            The mesh of `init`.
        orig, dir : array_like, shape (n, 3)
            The origins and directions of the rays. A ray whose direction is zero hits nothing.

        Returns
        -------
        list of list of tuple
            For each ray its hits ``(id, t, u, v)``, nearest first: the element, the distance in lengths of the
            direction, and the weights of the second and third vertex. In libigl they have the precision of float32.
        """
        hits = all_hits(self._checked().index, _rays(orig, dir), ("t", "primitive", "barycentric"))
        t, ids, weights = (hits.columns[name].tolist() for name in ("t", "primitive", "barycentric"))
        rows = [(i, s, w[1], w[2]) for i, s, w in zip(ids, t, weights)]
        return [rows[start:stop] for start, stop in zip(hits.splits[:-1], hits.splits[1:])]

    def intersect_ray_first(
        self, V: ArrayLike, Ele: ArrayLike, orig: ArrayLike, dir: ArrayLike, min_t: float = float("inf")
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Return the first hits of rays.

        Parameters
        ----------
        V, Ele, orig, dir
            As for `intersect_ray`.
        The largest distance of a hit, in lengths of the direction.
            The distance at which rays end, in lengths of the direction.

        Returns
        -------
        I : ndarray of int64, shape (n,)
            The elements, and -1 where nothing is hit.
        T : ndarray of float64, shape (n,)
            The distances in lengths of the direction; nan where nothing is hit.
        UV : ndarray of float64, shape (n, 2)
            The weights of the second and third vertex; nan where nothing is hit, where libigl leaves memory as it is.
        """
        index = self._checked().index
        found = index.rays(*castable(index, _rays(orig, dir)), fields=("t", "primitive", "barycentric"))
        I, T, UV = found.primitive, found.t, found.barycentric[:, 1:]
        missed = (I < 0) | (T > min_t)
        I[missed], T[missed], UV[missed] = -1, np.nan, np.nan
        return I, T, np.ascontiguousarray(UV)


def _in_space(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Return points of the plane or of space as contiguous points of space."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"{name}: the shape is {array.shape} instead of (n, 3) or (n, 2)")
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: the type is {array.dtype}, but coordinates are real numbers")
    if array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    return np.ascontiguousarray(array, np.float64)


def _rays(orig: ArrayLike, dir: ArrayLike) -> Rays:
    return _in_space(orig, "orig"), _in_space(dir, "dir")


def _mesh_arrays(V: ArrayLike, Ele: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return vertices and elements as contiguous arrays."""
    elements = np.asarray(Ele)
    if elements.ndim != 2 or elements.shape[1] not in (1, 2, 3):
        raise ValueError(f"Ele: the shape is {elements.shape} instead of (m, 3), (m, 2) or (m, 1)")
    if elements.dtype.kind not in "iu" and elements.size:
        raise TypeError(f"Ele: the type is {elements.dtype}, but indices are integers")
    return _in_space(V, "V"), np.ascontiguousarray(elements, np.int64)


def _points_and_mesh(P: ArrayLike, V: ArrayLike, Ele: ArrayLike) -> tuple[NDArray[np.float64], _Mesh]:
    points, (vertices, elements) = _in_space(P, "P"), _mesh_arrays(V, Ele)
    if np.asarray(P).shape[1] != np.asarray(V).shape[1]:
        raise ValueError(f"P, V: the points have {np.asarray(P).shape[1]} coordinates, the vertices others")
    return points, _cache.get(vertices, elements)
