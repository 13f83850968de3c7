"""The scene of triangles of Open3D, ``open3d.t.geometry.RaycastingScene``, in which inside is negative.

Open3D is not needed. Its tensors and meshes are accepted as arguments.

>>> import numpy as np
>>> import p2m.compat.open3d as o3d
>>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
>>> scene = o3d.RaycastingScene()
>>> triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32)
>>> scene.add_triangles(np.array(corners, np.float32), triangles)
0
>>> scene.compute_signed_distance(np.array([[0.125, 0.25, 0.25], [0.5, -2.0, 0.25]], np.float32)).numpy()
array([-0.125,  2.   ], dtype=float32)
"""

from __future__ import annotations

import importlib
import operator
import threading
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .._arrays import indices
from .._index import Index
from .._scene import Scene
from ._shared import Rays, all_hits, castable

__all__ = ["INVALID_ID", "Array", "RaycastingScene"]

INVALID_ID = 4294967295
"""The id that stands for no geometry or triangle."""

_FIELDS = ("primitive", "barycentric")
"""The fields of answers that `RaycastingScene._triangles` uses."""


class Array(np.ndarray):
    """A NumPy array with the methods by which programs turn Open3D tensors into arrays.

    Examples
    --------
    >>> import numpy as np
    >>> from p2m.compat.open3d import Array
    >>> np.zeros(2).view(Array).cpu().numpy()
    array([0., 0.])
    """

    def numpy(self) -> NDArray[Any]:
        """Return the array as a plain NumPy array, without a copy."""
        return self.view(np.ndarray)

    def cpu(self) -> Array:
        """Return the array itself."""
        return self


class _Geometry(NamedTuple):
    vertices: NDArray[np.float64]
    triangles: NDArray[np.uint32]


class _Built(NamedTuple):
    tree: Index
    first: NDArray[np.int64]
    """The id of the first triangle of each geometry, and the number of all triangles."""


class RaycastingScene:
    """Meshes of triangles that answer queries for closest points, signs and rays.

    This replaces ``open3d.t.geometry.RaycastingScene``.

    Parameters
    ----------
    nthreads : int, optional
        The number of threads for the build and for queries; 0 for the number of processors.
    device : object, optional
        It is ignored: the processor computes everything.
    dtype : {numpy.float32, numpy.float64}, optional
        The type of results that are coordinates, distances or weights.

    Attributes
    ----------
    INVALID_ID : int
        4294967295, the id that stands for no geometry or triangle.

    Notes
    -----
    The results are `Array`, NumPy arrays that have the method ``numpy()``. If the arguments are tensors of Open3D, the
    results are tensors too. Points and rays have any number of leading axes, which the results keep. They may have
    none, where Open3D raises an error. The other differences from Open3D 0.20 are:

    - Everything is computed in float64, and rounded once at the end to `dtype`. Open3D has only float32. Inputs may be
      arrays and sequences of any real type, and meshes with float64 keep it.
    - Signs do not depend on rays in random directions, so `nsamples` has no effect. Their rule is that of
      `p2m.Index.signed_distance`: overlapping shells of the same orientation are united, and a surface with holes has
      winding numbers, while Open3D counts the hits of a ray. A point whose side is not defined has the distance nan and
      the occupancy 0.
    - Hits are decided exactly. A ray through an edge or a vertex hits each of its triangles, and the first of equal
      hits is that with the lowest id.
    - In an empty scene distances are infinite and closest points nan, while Open3D answers with the origin.
    - A coordinate that is not finite is a `ValueError` with its row.
    - Scenes can be copied and pickled, so the processes of multiprocessing can have them.

    Examples
    --------
    >>> import numpy as np
    >>> from p2m.compat.open3d import RaycastingScene
    >>> scene = RaycastingScene(dtype=np.float64)
    >>> scene.add_triangles([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    0
    >>> scene.compute_distance([[[1.0, 1.0, 2.0], [9.0, 0.0, 0.0]]]).numpy()
    array([[2., 5.]])
    """

    INVALID_ID = INVALID_ID

    def __init__(self, nthreads: int = 0, device: object = None, *, dtype: DTypeLike = np.float32) -> None:
        self._dtype: np.dtype[Any] = np.dtype(dtype)
        if self._dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise ValueError(f"dtype: {self._dtype} is neither float32 nor float64")
        self._threads = _threads(nthreads)
        self._geometries: list[_Geometry] = []
        self._built: _Built | None = None
        self._lock = threading.Lock()

    def add_triangles(self, vertex_positions: Any = None, triangle_indices: Any = None, *, mesh: Any = None) -> int:
        """Add a mesh of triangles. The next query rebuilds the index.

        Parameters
        ----------
        vertex_positions : array_like, shape (n, 3), or a mesh
            The vertices, or a mesh as the only argument.
        triangle_indices : array_like of integers, shape (m, 3)
            The vertices of the triangles.
        mesh : object
            A mesh of Open3D, or another object from which `p2m.Scene.of` makes a scene of triangles.

        Returns
        -------
        int
            The id of the geometry, counted from 0.

        Raises
        ------
        ValueError
            For wrong shapes, indices without vertex, coordinates that are not finite, and meshes with segments or
            points.
        TypeError
            If the types are wrong, or there is neither a mesh nor vertices and triangles.
        """
        if triangle_indices is None and mesh is None:
            mesh, vertex_positions = vertex_positions, None
        if mesh is not None:
            if vertex_positions is not None or triangle_indices is not None:
                raise TypeError("add_triangles takes vertices and triangles, or a mesh")
            scene = Scene.of(mesh)
            counts = scene.counts
            if counts.segments or counts.points:
                raise ValueError("mesh: there are segments or points, and only triangles can be added")
            vertices, triangles = scene.vertices, scene.triangles.astype(np.uint32)
        elif vertex_positions is None or triangle_indices is None:
            raise TypeError("add_triangles takes vertices and triangles, or a mesh")
        else:
            vertices = np.array(_array(vertex_positions), np.float64)
            if vertices.ndim != 2 or vertices.shape[1] != 3:
                raise ValueError(f"vertex_positions: the shape is {vertices.shape} instead of (n, 3)")
            corners = _array(triangle_indices)
            triangles = indices(corners, "triangle_indices", 3, len(vertices)).reshape(-1, 3).copy()
            wrong = ~np.isfinite(vertices[triangles]).all(axis=(1, 2))
            if wrong.any():
                raise ValueError(f"vertex_positions: triangle {int(wrong.argmax())} has a vertex that is not finite")
        with self._lock:
            self._geometries.append(_Geometry(vertices, triangles))
            self._built = None
            return len(self._geometries) - 1

    def _index(self) -> _Built:
        with self._lock:
            if self._built is None:
                sizes = [len(vertices) for vertices, _ in self._geometries]
                starts = np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])
                pairs = zip(self._geometries, starts)
                corners = [triangles.astype(np.int64) + start for (_, triangles), start in pairs]
                vertices = np.concatenate([np.empty((0, 3)), *(vertices for vertices, _ in self._geometries)])
                triangles = np.concatenate([np.empty((0, 3), np.int64), *corners])
                first = np.concatenate([[0], np.cumsum([len(part) for part in corners], dtype=np.int64)])
                tree = Index(Scene(vertices, triangles=triangles), threads=self._threads)
                self._built = _Built(tree, first)
            return self._built

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Any]:
        """Return the closest points of the scene.

        Parameters
        ----------
        query_points : array_like, shape (..., 3)
            The query points.
        nthreads : int, optional
            The number of threads; 0 for that of the scene.

        Returns
        -------
        dict
            ``points`` (..., 3), the closest points; ``geometry_ids`` (...) and ``primitive_ids`` (...) as uint32, the
            geometries and the numbers of their triangles; ``primitive_uvs`` (..., 2), the weights of the second and
            third vertex; ``primitive_normals`` (..., 3), the normals of length 1 of the triangles, (0, 0, 0) for a
            triangle without area.
        """
        built = self._index()
        points = _rows(query_points, 3, "query_points")
        answer = built.tree.closest(points, fields=("point", *_FIELDS), threads=_threads(nthreads))
        columns = {"points": answer.point, **self._triangles(built, answer, has_normals=True)}
        return self._results(columns, query_points)

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Any:
        """Return the distances of points from the scene.

        Parameters
        ----------
        query_points, nthreads
            As for `compute_closest_points`.

        Returns
        -------
        Array or Tensor, shape (...)
            The distances, which are not negative.
        """
        points = _rows(query_points, 3, "query_points")
        distance = self._index().tree.distance(points, threads=_threads(nthreads))
        return self._result(distance, query_points)

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Return the distances of points from the scene, **negative inside** and positive outside.

        Parameters
        ----------
        query_points, nthreads
            As for `compute_closest_points`.
        nsamples : int, optional
            An odd number, which has no effect. Open3D casts this number of rays to tell inside from outside.

        Returns
        -------
        Array or Tensor, shape (...)
            The signed distances, 0 on the surface.

        Raises
        ------
        ValueError
            If `nsamples` is not odd and positive.
        """
        points = self._sampled(query_points, nsamples)
        distance = self._index().tree.signed_distance(points, threads=_threads(nthreads))
        return self._result(distance, query_points)

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Return whether points are inside of the scene.

        Parameters
        ----------
        query_points, nthreads, nsamples
            As for `compute_signed_distance`.

        Returns
        -------
        Array or Tensor, shape (...)
            1 where the signed distance is negative, and 0 elsewhere, also on the surface. It has the type of distances,
            as in Open3D.
        """
        points = self._sampled(query_points, nsamples)
        inside = self._index().tree.contains(points, threads=_threads(nthreads))
        return _result(inside.astype(self._dtype), query_points)

    def _sampled(self, query_points: Any, nsamples: int) -> NDArray[Any]:
        if nsamples < 1 or nsamples % 2 == 0:
            raise ValueError(f"nsamples: {nsamples} is not odd and positive")
        return _rows(query_points, 3, "query_points")

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Return the first hits of rays.

        Parameters
        ----------
        rays : array_like, shape (..., 6)
            The rays, each with its origin and its direction: ``[ox, oy, oz, dx, dy, dz]``. Directions have any length,
            and a ray whose direction is zero hits nothing.
        nthreads : int, optional
            The number of threads; 0 for that of the scene.

        Returns
        -------
        dict
            ``t_hit`` (...), the distances in lengths of the direction, infinite if nothing is hit; ``geometry_ids``
            (...) and ``primitive_ids`` (...) as uint32, `INVALID_ID` if nothing is hit; ``primitive_uvs`` (..., 2), the
            weights of the second and third vertex; ``primitive_normals`` (..., 3), the normals of length 1 of the
            triangles. Weights and normals are 0 if nothing is hit.
        """
        built = self._index()
        split, shape = _split(rays)
        hits = built.tree.rays(*castable(built.tree, split), fields=("t", *_FIELDS), threads=_threads(nthreads))
        columns = {"t_hit": hits.t, **self._triangles(built, hits, has_normals=True)}
        return self._results({name: array.reshape(shape + array.shape[1:]) for name, array in columns.items()}, rays)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """Return the number of triangles that each ray hits.

        Parameters
        ----------
        rays, nthreads
            As for `cast_rays`.

        Returns
        -------
        Array or Tensor of int32, shape (...)
            The numbers. A ray through an edge hits two triangles there.
        """
        split, shape = _split(rays)
        tree = self._index().tree
        counts = tree.rays(*castable(tree, split), "count", threads=_threads(nthreads))
        return _result(counts.astype(np.int32).reshape(shape), rays)

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"), nthreads: int = 0) -> Any:
        """Return whether rays hit anything.

        Parameters
        ----------
        rays, nthreads
            As for `cast_rays`.
        tnear, tfar : float, optional
            The range of distances, inclusive, in lengths of the direction.

        Returns
        -------
        Array or Tensor of bool, shape (...)
        """
        split, shape = _split(rays)
        hit = np.zeros(len(split[0]), np.bool_)
        if tnear <= tfar:
            tree, threads = self._index().tree, _threads(nthreads)
            hit = tree.rays(*castable(tree, split), "any", t_min=tnear, t_max=tfar, threads=threads)
        return _result(hit.reshape(shape), rays)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Return all hits of rays.

        Parameters
        ----------
        rays, nthreads
            As for `cast_rays`.

        Returns
        -------
        dict
            ``ray_splits`` {n + 1}, as uint32: the hits of ray i, in the order of the flattened rays, are at
            ``ray_splits[i]:ray_splits[i + 1]`` of the other arrays, ordered by ``t_hit``. ``ray_ids`` {h} as uint32,
            ``t_hit`` {h}, ``geometry_ids`` {h} and ``primitive_ids`` {h} as uint32, and ``primitive_uvs`` {h, 2}
            describe h hits as in `cast_rays`.
        """
        built = self._index()
        split, _ = _split(rays)
        ray, hits, splits = all_hits(built.tree, split, ("t", *_FIELDS), _threads(nthreads))
        columns = {"ray_splits": splits.astype(np.uint32), "ray_ids": ray.astype(np.uint32), "t_hit": hits["t"]}
        return self._results({**columns, **self._triangles(built, hits)}, rays)

    def _result(self, array: NDArray[Any], given: Any) -> Any:
        """Return an answer with real numbers, converted to the type of the scene."""
        return _result(array.astype(self._dtype, copy=False) if array.dtype == np.float64 else array, given)

    def _results(self, columns: dict[str, NDArray[Any]], given: Any) -> dict[str, Any]:
        return {name: self._result(array, given) for name, array in columns.items()}

    def _triangles(self, built: _Built, found: Any, has_normals: bool = False) -> dict[str, NDArray[Any]]:
        """Return the fields of answers that describe triangles. Some answers may be missing."""
        primitive = found["primitive"]
        # The weights of the second and third vertices, 0 without a triangle.
        weights = np.where((primitive < 0)[..., None], 0.0, found["barycentric"][..., 1:])
        columns = {**self._ids(built, primitive), "primitive_uvs": weights}
        return {**columns, "primitive_normals": self._normals(built, primitive)} if has_normals else columns

    def _ids(self, built: _Built, primitive: NDArray[np.int64]) -> dict[str, NDArray[np.uint32]]:
        """Return the geometries of triangles, and the numbers of the triangles in them."""
        geometry = np.searchsorted(built.first, primitive, side="right") - 1
        number = primitive - built.first[geometry]
        missing = primitive < 0
        geometry[missing] = number[missing] = INVALID_ID
        return {"geometry_ids": geometry.astype(np.uint32), "primitive_ids": number.astype(np.uint32)}

    def _normals(self, built: _Built, primitive: NDArray[np.int64]) -> NDArray[Any]:
        """Return the normals of triangles, (0, 0, 0) for a missing triangle and for one without area."""
        flat = primitive.reshape(-1)
        normals = np.zeros((len(flat), 3), self._dtype)
        number = np.searchsorted(built.first, flat, side="right") - 1
        for place, (vertices, triangles) in enumerate(self._geometries):
            rows = np.nonzero((number == place) & (flat >= 0))[0]
            if len(rows):
                corners = vertices[triangles[flat[rows] - built.first[place]]]
                normals[rows] = unit_normals(corners)
        return normals.reshape((*primitive.shape, 3))

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_lock"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._lock = threading.Lock()

    def __copy__(self) -> RaycastingScene:
        copied = RaycastingScene.__new__(RaycastingScene)
        with self._lock:
            copied.__setstate__({**self.__getstate__(), "_geometries": list(self._geometries)})
        return copied

    def __deepcopy__(self, memo: object) -> RaycastingScene:
        # Arrays and indexes never change, so copies share them.
        return self.__copy__()

    def __repr__(self) -> str:
        triangles = sum(len(triangles) for _, triangles in self._geometries)
        return f"<p2m.compat.open3d.RaycastingScene of {triangles} triangles in {len(self._geometries)} meshes>"


def unit_normals(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the normals of triangles, shape (n, 3) for corners of shape (n, 3, 3); (0, 0, 0) without an area."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # With edges of length about 1, products neither overflow nor underflow.
    size = np.maximum(np.abs(a).max(axis=1, initial=0.0), np.abs(b).max(axis=1, initial=0.0))[:, None]
    size[size == 0.0] = 1.0
    normals = np.cross(a / size, b / size)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    length[length == 0.0] = 1.0
    unit: NDArray[np.float64] = normals / length
    return unit


def _threads(nthreads: int) -> int | None:
    """Return a number of threads, None for the default."""
    count = operator.index(nthreads)
    if count < 0:
        raise ValueError(f"nthreads: {count} is negative")
    return None if count == 0 else count


def _is_tensor(values: Any) -> bool:
    return type(values).__module__.partition(".")[0] == "open3d"


def _array(values: Any) -> NDArray[Any]:
    """Return an argument as an array. It may be a tensor of Open3D."""
    return np.asarray(values.cpu().numpy() if _is_tensor(values) else values)


def _rows(values: Any, width: int, name: str) -> NDArray[Any]:
    """Return an argument as an array whose last axis has the given length."""
    array = _array(values)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name}: the shape is {array.shape} instead of {{.., {width}}}")
    return array


def _split(rays: Any) -> tuple[Rays, tuple[int, ...]]:
    """Return the origins and directions of rays, and their leading axes."""
    array = _rows(rays, 6, "rays")
    if array.dtype.kind not in "iuf":
        raise TypeError(f"rays: the type is {array.dtype}, but coordinates are real numbers")
    flat = array.reshape(-1, 6)
    return (flat[:, :3].astype(np.float64), flat[:, 3:].astype(np.float64)), array.shape[:-1]


def _result(array: NDArray[Any], given: Any) -> Any:
    """Return an answer, as a tensor of Open3D if the argument was one."""
    if _is_tensor(given):
        return importlib.import_module("open3d").core.Tensor(array)
    return array.view(Array)
