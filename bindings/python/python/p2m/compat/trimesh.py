"""The proximity and ray queries of trimesh, in which inside is positive.

The functions take the meshes of trimesh, and any other object with ``vertices`` of shape (n, 3) and ``faces`` of shape
(m, 3). Only `enable` needs trimesh itself. The first query of a mesh builds its index, which is kept until the mesh
changes or is deleted. The indexes of the four most recently used other objects are found by their content.

>>> import numpy as np
>>> from types import SimpleNamespace
>>> import p2m.compat.trimesh as proximity
>>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
>>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
>>> mesh = SimpleNamespace(vertices=corners, faces=faces)
>>> points = np.array([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25]])
>>> closest, distance, triangle_id = proximity.closest_point(mesh, points)
>>> distance, triangle_id
(array([0.125, 2.   ]), array([2, 1]))
>>> proximity.signed_distance(mesh, points)
array([ 0.125, -2.   ])

All functions differ from those of trimesh 5.2.0 in these respects:

- Nothing is rounded to a tolerance. trimesh treats points within 1e-8 of the surface as lying on it, squared distances
  that differ by less than 1e-8 as equal, and hits up to 1e-6 behind the origin of a ray as hits.
- An empty list of points is an ordinary query, while trimesh raises `ValueError`.
- A coordinate that is not finite is a `ValueError` with its row, also in rays.
"""

from __future__ import annotations

import importlib
import threading
from typing import Any, Literal, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import coordinates
from .._index import Index
from .._scene import Scene
from ._shared import ContentCache, ObjectCache, Rays, all_hits, castable

__all__ = [
    "ProximityQuery",
    "RayMeshIntersector",
    "clear_cache",
    "closest_point",
    "disable",
    "enable",
    "signed_distance",
]


class _Indexes:
    """The indexes of a mesh in one state."""

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
        if faces.size == 0:
            raise ValueError("mesh: there are no faces")
        self.surface = Index(Scene(vertices, triangles=faces))
        self._vertices: Index | None = None
        self._lock = threading.Lock()

    def vertices(self) -> Index:
        with self._lock:
            if self._vertices is None:
                positions = self.surface.scene.vertices
                self._vertices = Index(Scene(positions, points=np.arange(len(positions))))
            return self._vertices


def _arrays(mesh: Any) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return np.ascontiguousarray(mesh.vertices, np.float64), np.ascontiguousarray(mesh.faces, np.int64)


# The hash of a trimesh mesh depends on its content, and trimesh recomputes it only after a change.
_of_meshes: ObjectCache[_Indexes] = ObjectCache(lambda mesh: _Indexes(*_arrays(mesh)), hash)
_of_others: ContentCache[_Indexes] = ContentCache(_Indexes)


def _indexes(mesh: Any) -> _Indexes:
    """Return the indexes of a mesh in its present state."""
    if any(base.__module__.partition(".")[0] == "trimesh" for base in type(mesh).__mro__):
        return _of_meshes.get(mesh)
    return _of_others.get(*_arrays(mesh))


def clear_cache() -> None:
    """Forget the indexes of all meshes, which frees their memory."""
    _of_meshes.clear()
    _of_others.clear()


def _points(values: ArrayLike) -> NDArray[Any]:
    """Return points of shape (n, 3)."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points must be (n,3)! The shape is {array.shape}")
    return coordinates(array, "points")


def closest_point(mesh: Any, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Return the closest points of a mesh to query points.

    This replaces ``trimesh.proximity.closest_point``.

    Parameters
    ----------
    mesh : trimesh.Trimesh
        The mesh.
    points : array_like, shape (n, 3)
        The query points.

    Returns
    -------
    closest : ndarray of float64, shape (n, 3)
        The closest points.
    distance : ndarray of float64, shape (n,)
        Their distances, which are not negative.
    triangle_id : ndarray of int64, shape (n,)
        The faces that contain the closest points.

    Raises
    ------
    ValueError
        For points of another shape or with a coordinate that is not finite, and for a mesh without faces.

    Notes
    -----
    Of several equally near faces the one with the lowest id is the answer. trimesh compares two candidates whose
    squared distances differ by less than 1e-8, and takes the one whose normal points more towards the query point, so
    its distance may be too large, by up to 1e-4 near the surface.
    """
    answer = _indexes(mesh).surface.closest(_points(points), fields=("point", "distance", "primitive"))
    return answer.point, answer.distance, answer.primitive


def signed_distance(mesh: Any, points: ArrayLike) -> NDArray[np.float64]:
    """Return the distances of points from a mesh, **positive inside** and negative outside.

    This replaces ``trimesh.proximity.signed_distance``.

    Parameters
    ----------
    mesh : trimesh.Trimesh
        The mesh.
    points : array_like, shape (n, 3)
        The query points.

    Returns
    -------
    ndarray of float64, shape (n,)
        The signed distances, 0 on the surface.

    Raises
    ------
    ValueError
        As for `closest_point`.

    Notes
    -----
    The rule of signs is that of `p2m.Index.signed_distance`: overlapping shells of the same orientation are united. If
    the closest point is inside of a face, trimesh compares with the normal of the face, and otherwise it casts rays.
    The distance is nan if rounding leaves it open whether the winding number of an open surface exceeds a half. In
    trimesh, points within 1e-8 of the surface have a positive distance on either side.
    """
    distance = _indexes(mesh).surface.signed_distance(_points(points))
    np.negative(distance, out=distance, where=distance != 0.0)
    return distance


class ProximityQuery:
    """The closest-point queries of a mesh, as in ``mesh.nearest``.

    This replaces ``trimesh.proximity.ProximityQuery``.

    Parameters
    ----------
    mesh : trimesh.Trimesh
        The mesh. The index follows its changes.

    Attributes
    ----------
    The object that `enable` replaced by this one, or None.
        What `enable` replaced by this object, or None.
    """

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh
        self.replaced: Any = None

    def on_surface(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
        """Return the closest points of the mesh, their distances and their faces, as `closest_point` does."""
        return closest_point(self._mesh, points)

    def vertex(self, points: ArrayLike) -> tuple[Any, Any]:
        """Return the nearest vertices of the mesh.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            The query points.

        Returns
        -------
        distance : ndarray of float64, shape (...)
            The distances of the nearest vertices; a number for one point.
        vertex_id : ndarray of int64, shape (...)
            Their indices in ``mesh.vertices``; a number for one point. Vertices without faces count, too. Of equally
            near vertices the first is the answer, and in trimesh any of them.
        """
        answer = _indexes(self._mesh).vertices().closest(points, fields=("distance", "primitive"))
        if answer.distance.ndim == 0:
            return answer.distance.item(), answer.primitive.item()
        return answer.distance, answer.primitive

    def signed_distance(self, points: ArrayLike) -> NDArray[np.float64]:
        """Return the distances of points from the mesh, positive inside, as the function `signed_distance` does."""
        return signed_distance(self._mesh, points)


class RayMeshIntersector:
    """The ray queries of a mesh, as in ``mesh.ray``.

    This replaces ``trimesh.ray.ray_triangle.RayMeshIntersector`` and that of ``ray_pyembree``.

    Parameters
    ----------
    mesh : trimesh.Trimesh
        The mesh. The index follows its changes.

    Attributes
    ----------
    replaced : object
        The object that `enable` replaced by this one, or None.

    Notes
    -----
    Hits are decided exactly: no ray passes between two faces, while Embree works in float32. They are ordered by rays
    and then along each ray; trimesh has several orders. A ray whose direction is zero hits nothing.
    """

    def __init__(self, mesh: Any) -> None:
        self.mesh = mesh
        self.replaced: Any = None

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: Literal[False] = False,
        multiple_hits: bool = True,
        max_hits: int | None = None,
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...
    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: Literal[True],
        multiple_hits: bool = True,
        max_hits: int | None = None,
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]: ...
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: bool = False,
        multiple_hits: bool = True,
        max_hits: int | None = None,
    ) -> Union[
        tuple[NDArray[np.int64], NDArray[np.int64]],
        tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
    ]:
        """Return the faces that rays hit.

        Parameters
        ----------
        ray_origins, ray_directions : array_like, shape (n, 3)
            The origins and directions of the rays. Directions have any length.
        Whether to return the points as well. Then several hits of a ray at one point, on an edge or a vertex, count as
        one hit of the face with the lowest id.
        multiple_hits : bool, optional
            Whether to return all hits of a ray instead of only the first one.
        max_hits : int, optional
            The largest number of hits of a ray, which are its first ones. By default there is no limit; trimesh has a
            limit of 100 with Embree, and ignores this argument without it.

        Returns
        -------
        index_tri : ndarray of int64, shape (h,)
            The faces.
        index_ray : ndarray of int64, shape (h,)
            The rays, ascending.
        locations : ndarray of float64, shape (h, 3)
            The points, only with `return_locations`.

        Raises
        ------
        ValueError
            If there are not as many origins as directions, or a coordinate is not finite.

        Notes
        -----
        The third argument is `return_locations`, as it is in trimesh without Embree. With Embree it is `multiple_hits`,
        so name them. Without hits, `locations` has the shape (0, 3), and in trimesh without Embree the shape (0,).
        """
        index, rays = self._cast(ray_origins, ray_directions)
        locations: NDArray[np.float64] | None
        if not multiple_hits:
            first = index.rays(*rays, fields=("primitive", "point"))
            ray = np.nonzero(first.primitive >= 0)[0]
            faces, locations = first.primitive[ray], first.point[ray]
        else:
            hits = all_hits(index, rays, ("primitive", "t", "point") if return_locations else ("primitive",))
            ray, faces, locations = hits.ray, hits.columns["primitive"], hits.columns.get("point")
            if locations is not None:
                # Parameters are rounded only once, so hits at one point have equal parameters, and come in ascending
                # order of ids.
                t = hits.columns["t"]
                is_new = np.ones(len(ray), np.bool_)
                is_new[1:] = (ray[1:] != ray[:-1]) | (t[1:] != t[:-1])
                ray, faces, locations = ray[is_new], faces[is_new], locations[is_new]
        if max_hits is not None and multiple_hits:
            place = np.arange(len(ray)) - np.searchsorted(ray, ray)
            few = place < max_hits
            ray, faces = ray[few], faces[few]
            locations = None if locations is None else locations[few]
        if return_locations:
            assert locations is not None
            return faces, ray, locations
        return faces, ray

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool = True, max_hits: int | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Return the points at which rays hit the mesh, each once.

        Parameters
        ----------
        ray_origins, ray_directions, multiple_hits, max_hits
            As for `intersects_id`.

        Returns
        -------
        locations : ndarray of float64, shape (h, 3)
            The points.
        index_ray : ndarray of int64, shape (h,)
            The rays, ascending.
        index_tri : ndarray of int64, shape (h,)
            The faces.
        """
        faces, ray, locations = self.intersects_id(
            ray_origins, ray_directions, return_locations=True, multiple_hits=multiple_hits, max_hits=max_hits
        )
        return locations, ray, faces

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.int64]:
        """Return the first face that each ray hits.

        Parameters
        ----------
        ray_origins, ray_directions
            As for `intersects_id`.

        Returns
        -------
        ndarray of int64, shape (n,)
            The faces, and -1 for rays that hit nothing. With Embree, trimesh returns int32.
        """
        index, rays = self._cast(ray_origins, ray_directions)
        return index.rays(*rays, fields="primitive").primitive

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.bool_]:
        """Return whether each ray hits the mesh.

        Parameters
        ----------
        ray_origins, ray_directions
            As for `intersects_id`.

        Returns
        -------
        ndarray of bool, shape (n,)
        """
        index, rays = self._cast(ray_origins, ray_directions)
        return index.rays(*rays, "any")

    def _cast(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> tuple[Index, Rays]:
        """Return the index of the mesh, and rays of shape (n, 3) at which it can cast."""
        rays, index = _rays(ray_origins, ray_directions), _indexes(self.mesh).surface
        return index, castable(index, rays)

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Return whether each point is inside of the mesh.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            The query points.

        Returns
        -------
        ndarray of bool, shape (n,)
            Whether `signed_distance` is positive: points on the surface and points whose side is not defined are not
            inside. In trimesh, points on the surface may be inside.
        """
        return _indexes(self.mesh).surface.contains(_points(points))


def _rays(ray_origins: ArrayLike, ray_directions: ArrayLike) -> Rays:
    """Return origins and directions of shape (n, 3)."""
    origins = coordinates(ray_origins, "ray_origins", only_float64=True)
    directions = coordinates(ray_directions, "ray_directions", only_float64=True)
    if origins.ndim != 2 or origins.shape != directions.shape:
        shapes = f"{origins.shape} and {directions.shape}"
        raise ValueError(f"ray_origins, ray_directions: the shapes are {shapes} instead of (n, 3) for both")
    return origins, directions


_RAY_METHODS = ("contains_points", "intersects_any", "intersects_first", "intersects_id", "intersects_location")

_patched: list[tuple[Any, str, Any]] = []
"""The attributes that `enable` replaced: the owner, the name, and the original value."""


def enable(mesh: Any = None) -> None:
    """Make trimesh answer with p2m, until `disable` is called.

    Parameters
    ----------
    mesh : trimesh.Trimesh, optional
        The mesh whose ``nearest`` and ``ray`` are replaced. Without it, those of all present and future meshes are
        replaced, and so are ``trimesh.proximity.closest_point`` and ``trimesh.proximity.signed_distance``. Methods that
        use them follow, such as ``mesh.contains``.

    Raises
    ------
    ImportError
        Without a mesh, if trimesh is not installed.
    """
    if mesh is not None:
        for name, query in (("nearest", ProximityQuery(mesh)), ("ray", RayMeshIntersector(mesh))):
            before = getattr(mesh, name)
            if not isinstance(before, (ProximityQuery, RayMeshIntersector)):
                query.replaced = before
                setattr(mesh, name, query)
        return
    if _patched:
        return
    proximity = importlib.import_module("trimesh.proximity")
    ray = importlib.import_module("trimesh.ray")

    own_ray = {name: getattr(RayMeshIntersector, name) for name in _RAY_METHODS}
    own_nearest = {name: getattr(ProximityQuery, name) for name in ("on_surface", "signed_distance", "vertex")}
    replacements: list[tuple[Any, dict[str, Any]]] = [
        (proximity, {"closest_point": closest_point, "signed_distance": signed_distance}),
        (proximity.ProximityQuery, own_nearest),
        (ray.ray_triangle.RayMeshIntersector, own_ray),
    ]
    if ray.has_embree:
        replacements.append((ray.ray_pyembree.RayMeshIntersector, own_ray))
    for owner, functions in replacements:
        for name, function in functions.items():
            _patched.append((owner, name, getattr(owner, name)))
            setattr(owner, name, function)


def disable(mesh: Any = None) -> None:
    """Undo `enable`.

    Parameters
    ----------
    mesh : trimesh.Trimesh, optional
        The mesh that was given to `enable`. Without it, the change for all meshes is undone.
    """
    if mesh is not None:
        for name in ("nearest", "ray"):
            before = getattr(getattr(mesh, name), "replaced", None)
            if before is not None:
                setattr(mesh, name, before)
        return
    while _patched:
        owner, name, function = _patched.pop()
        setattr(owner, name, function)
