"""Records of arrays: the answers to batches of queries."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Record:
    """Named arrays, of which only the requested ones exist.

    The arrays of a record are attributes and items (``record["distance"]``). A record can be unpacked as a tuple, in
    the order of the arrays.

    Examples
    --------
    >>> import p2m
    >>> index = p2m.Index(p2m.Scene([[0.0, 0.0, 0.0]], points=[0]))
    >>> answer = index.closest([[3.0, 4.0, 0.0]], fields=("distance", "primitive"))
    >>> distance, primitive = answer
    >>> distance.tolist(), primitive.tolist()
    ([5.0], [0])
    >>> answer.point
    Traceback (most recent call last):
        ...
    AttributeError: the answer has no 'point': it has distance, primitive
    """

    def __init__(self, arrays: dict[str, NDArray[Any]]) -> None:
        self.__dict__.update(arrays)

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the arrays, in their order."""
        return tuple(self.__dict__)

    def asdict(self) -> dict[str, NDArray[Any]]:
        """Return the arrays by their names."""
        return dict(self.__dict__)

    def __getattr__(self, name: str) -> NDArray[Any]:
        raise AttributeError(f"the answer has no {name!r}: it has {', '.join(self.__dict__)}")

    def __getitem__(self, name: str) -> NDArray[Any]:
        array: NDArray[Any] = self.__dict__[name]
        return array

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return iter(self.__dict__.values())

    def __len__(self) -> int:
        return len(self.__dict__)

    def __repr__(self) -> str:
        arrays = ", ".join(f"{name}: {array.dtype}{list(array.shape)}" for name, array in self.__dict__.items())
        return f"{type(self).__name__}({arrays})"


class ClosestPoints(Record):
    """The answers to queries for the closest point or for the k nearest primitives.

    Attributes
    ----------
    distance : ndarray of float64, shape (...)
        The distances, in the unit of the scene; infinite where there is no answer.
    primitive : ndarray of int64, shape (...)
        The ids of the primitives; -1 where there is no answer.
    point : ndarray of float64, shape (..., 3)
        The closest points; nan where there is no answer.
    feature : ndarray of uint8, shape (...)
        The part of the primitive that contains the closest point: its vertex 0, 1, 2, its edge 3, 4, 5 (from vertex 0
        to 1, from 1 to 2, from 2 to 0), or its inside 6; 255 where there is no answer.
    barycentric : ndarray of float64, shape (..., 3)
        The weights of the vertices of the primitive; nan where there is no answer.
    lower_bound : ndarray of float64, shape (...)
        Certified lower bounds on the true distances. Where there is no answer they are about `max_distance`, or less if
        ``max_visits`` ended the search; infinite for an empty scene.
    object : ndarray of int64, shape (...)
        The numbers of the objects in ``scene.objects``; -1 for a primitive without object and where there is no answer.
    normal : ndarray of float64, shape (..., 3)
        Unit normals at the closest points, only from `Index.closest`: on a face its normal, on an edge the sum of the
        normals of its triangles, at a vertex the sum of the normals of its triangles, weighted by their angles there.
        They are nan where there is no answer, on segments and points, and where triangles have no area or their normals
        cancel.
    """

    distance: NDArray[np.float64]
    primitive: NDArray[np.int64]
    point: NDArray[np.float64]
    feature: NDArray[np.uint8]
    barycentric: NDArray[np.float64]
    lower_bound: NDArray[np.float64]
    object: NDArray[np.int64]
    normal: NDArray[np.float64]


class NearPrimitives(ClosestPoints):
    """All primitives within a distance of some queries.

    The primitives of query i, in the order of the flattened queries, are at ``splits[i]:splits[i + 1]`` of the other
    arrays, nearest first.

    Attributes
    ----------
    splits : ndarray of int64, shape (n + 1,)
        The index at which the primitives of each query begin, and the number of all primitives.
    """

    splits: NDArray[np.int64]


class FirstHits(Record):
    """The first hits of rays.

    Attributes
    ----------
    t : ndarray of float64, shape (...)
        The parameters of the hits, in lengths of the direction; infinite if nothing is hit.
    primitive : ndarray of int64, shape (...)
        The ids of the primitives; -1 where nothing is hit.
    point : ndarray of float64, shape (..., 3)
        The points that are hit; nan where nothing is hit.
    barycentric : ndarray of float64, shape (..., 3)
        The weights of the vertices of the primitive; nan where nothing is hit.
    side : ndarray of int8, shape (...)
        1 if the ray comes from the side to which the normal of the triangle points, -1 if it comes from the other side,
        0 if the ray runs along the primitive, and where nothing is hit.
    """

    t: NDArray[np.float64]
    primitive: NDArray[np.int64]
    point: NDArray[np.float64]
    barycentric: NDArray[np.float64]
    side: NDArray[np.int8]


class AllHits(FirstHits):
    """All hits of rays.

    The hits of ray i, in the order of the flattened rays, are at ``splits[i]:splits[i + 1]`` of the other arrays,
    ordered by their parameters.

    Attributes
    ----------
    splits : ndarray of int64, shape (n + 1,)
        The index at which the hits of each ray begin, and the number of all hits.
    """

    splits: NDArray[np.int64]


class _Pairs(Record):
    """Near pairs of primitives. Arrays with two places have the scene of the index first."""

    distance: NDArray[np.float64]
    points: NDArray[np.float64]
    features: NDArray[np.uint8]
    barycentric: NDArray[np.float64]
    lower_bound: NDArray[np.float64]
    is_intersecting: NDArray[np.bool_]


class ClosestPairs(_Pairs):
    """The nearest points of two scenes. Arrays with two places have the scene of the index first, then the other one.

    Attributes
    ----------
    distance : ndarray of float64, shape (...)
        The distances, 0 if the scenes intersect; infinite where there is no answer.
    primitives : ndarray of int64, shape (..., 2)
        The ids of both primitives; -1 where there is no answer. Of several equally near pairs it is the one with the
        lowest id in the scene of the index, then in the other one.
    points : ndarray of float64, shape (..., 2, 3)
        The nearest points, that of the other scene after its motion; nan where there is no answer.
    features : ndarray of uint8, shape (..., 2)
        The parts of the primitives that contain the points, as in `ClosestPoints`; 255 where there is no answer.
    barycentric : ndarray of float64, shape (..., 2, 3)
        The weights of the vertices of both primitives; nan where there is no answer.
    lower_bound : ndarray of float64, shape (...)
        Certified lower bounds on the true distances; infinite where there is no answer. They depend on the backend.
    is_intersecting : ndarray of bool, shape (...)
        Whether the primitives intersect, which is decided without rounding.
    """

    primitives: NDArray[np.int64]


class ClosestToShapes(_Pairs):
    """The nearest points of a scene and of shapes. Arrays with two places have the scene first, then the shape.

    The other arrays are those of `ClosestPairs`. With a radius, the distance is the distance of the shape less the
    radius, rounded. The second point is moved towards the first one by the radius, or equals the first one if they
    intersect. ``is_intersecting`` tells whether the computed distance of the shape is at most the radius.

    Attributes
    ----------
    primitive : ndarray of int64, shape (n,)
        The ids of the primitives of the scene; -1 where there is no answer.
    """

    primitive: NDArray[np.int64]


class BallContacts(Record):
    """The first contacts of moving balls.

    Attributes
    ----------
    parameter : ndarray of float64, shape (...)
        The parameters of the contacts, from 0 at the start to 1 at the end, rounded down; infinite without contact. A
        ball certainly touches nothing before its parameter. A ball that touches at the start has the parameter 0.
    primitive : ndarray of int64, shape (...)
        The ids of the primitives that are touched; -1 without contact.
    point : ndarray of float64, shape (..., 3)
        The points of the scene that are nearest to the centre at the upper parameter; nan without contact.
    feature : ndarray of uint8, shape (...)
        The parts of the primitives that contain the points, as in `ClosestPoints`; 255 without contact.
    upper_parameter : ndarray of float64, shape (...)
        Parameters at which the scene is certainly within ``distance_bound`` of the centre, which exceed ``parameter``
        by about 2**-48; infinite without contact.
    distance_bound : ndarray of float64, shape (...)
        Certified upper bounds on the distance of the scene from the centre at the upper parameter; infinite without
        contact. They exceed the radius by at most the tolerance and some roundings, unless the ball starts nearer.
    """

    parameter: NDArray[np.float64]
    primitive: NDArray[np.int64]
    point: NDArray[np.float64]
    feature: NDArray[np.uint8]
    upper_parameter: NDArray[np.float64]
    distance_bound: NDArray[np.float64]
