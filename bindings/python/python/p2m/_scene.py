"""Scenes, and their conversion from the objects of other packages."""

from __future__ import annotations

import inspect
import os
from collections.abc import Iterable
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._arrays import Shared, coordinates, indices, unmasked
from ._page import Page, scene_page


class Counts(NamedTuple):
    """The numbers of vertices and primitives of a scene."""

    vertices: int
    triangles: int
    segments: int
    points: int


class Object(NamedTuple):
    """Consecutive primitives under one name, with the ids from `start` to `stop` - 1."""

    name: str
    start: int
    stop: int


class Scene(Shared):
    """A set of triangles, segments and points over shared vertices, which never changes.

    Primitives are numbered from 0: first the triangles, then the segments, then the points. In a scene that was read
    from a file they are in the order of the file. Primitives may be degenerate, intersect each other and occur twice.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        The coordinates of the vertices, in any unit that is the same on all axes. They are copied as float64.
    triangles : array_like of integers, shape (m, 3), optional
        The vertices of each triangle.
    segments : array_like of integers, shape (m, 2), optional
        The vertices of each segment.
    points : array_like of integers, shape (m,), optional
        The vertex of each point.

    Raises
    ------
    ValueError
        If a shape is wrong, an index has no vertex, or a vertex that a primitive uses is not finite.
    TypeError
        If indices are not integers, or coordinates are no real numbers.

    Examples
    --------
    >>> import p2m
    >>> scene = p2m.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]], triangles=[[0, 1, 2]], segments=[[0, 3]])
    >>> len(scene), scene.counts.segments
    (2, 1)
    >>> scene.bounds.tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 2.0]]
    """

    __slots__ = ("__weakref__", "_raw")

    _raw: _p2m.Scene

    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike | None = None,
        segments: ArrayLike | None = None,
        points: ArrayLike | None = None,
    ) -> None:
        positions = unmasked(vertices, "vertices")
        if positions.size == 0:
            positions = positions.reshape(0, 3)
        if positions.ndim != 2:
            raise ValueError(f"vertices: the shape is {positions.shape} instead of (n, 3)")
        flat = coordinates(positions, "vertices").reshape(-1)
        count = len(positions)
        if triangles is None and segments is None and points is None:
            points = np.arange(count)
        corners = indices(triangles, "triangles", 3, count)
        ends = indices(segments, "segments", 2, count)
        self._raw = _p2m.Scene(flat, corners, ends, indices(points, "points", 1, count))

    @classmethod
    def _from_raw(cls, raw: _p2m.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._raw = raw
        return scene

    @staticmethod
    def of(obj: Any) -> Scene:
        """Make a scene from an object of another package, which is recognized by its attributes.

        Parameters
        ----------
        obj : object
            A mesh, point cloud or set of lines of trimesh, Open3D, PyVista or meshio, the path of a file that `read`
            reads, an array of points, a tuple ``(vertices, triangles)``, or a `Scene`, which is returned as it is.

        Raises
        ------
        TypeError
            If the object is not recognized.

        Examples
        --------
        >>> import p2m
        >>> len(p2m.Scene.of(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])))
        1
        """
        if isinstance(obj, Scene):
            return obj
        if isinstance(obj, (str, os.PathLike)):
            return read(obj)
        if isinstance(obj, tuple) and len(obj) == 2:
            return Scene(obj[0], triangles=obj[1])
        if isinstance(obj, np.ndarray):
            return Scene(obj)
        # The attributes alone do not distinguish all packages.
        makers = {
            "trimesh": Scene.from_trimesh,
            "open3d": Scene.from_open3d,
            "pyvista": Scene.from_pyvista,
            "meshio": Scene.from_meshio,
        }
        for base in type(obj).__mro__:
            package = base.__module__.partition(".")[0]
            if package in makers:
                return makers[package](obj)
        if hasattr(obj, "cells_dict") and hasattr(obj, "points"):
            return Scene.from_meshio(obj)
        if hasattr(obj, "n_points") and hasattr(obj, "GetNumberOfCells"):
            return Scene.from_pyvista(obj)
        if hasattr(obj, "geometry") or hasattr(obj, "vertices"):
            return Scene.from_trimesh(obj)
        raise TypeError(
            f"{type(obj).__name__} is no scene: give a path, an array of points, a pair (vertices, triangles), a "
            "p2m.Scene, or a mesh of trimesh, Open3D, PyVista or meshio"
        )

    @staticmethod
    def from_trimesh(mesh: Any) -> Scene:
        """Make a scene from a mesh, a point cloud, a path or a scene of trimesh.

        The faces of a mesh are triangles, the entities of a path are segments, and the vertices of a point cloud are
        points. The nodes of a scene of trimesh become objects with their names, with all of their transformations.
        """
        if hasattr(mesh, "geometry"):
            parts = []
            for node in mesh.graph.nodes_geometry:
                transform, name = mesh.graph[node]
                part = mesh.geometry[name].copy()
                part.apply_transform(transform)
                parts.append((str(node), Scene.from_trimesh(part)._raw))
            return Scene._from_raw(_p2m.Scene.joined(parts))
        vertices = np.asarray(mesh.vertices, np.float64)
        if hasattr(mesh, "faces"):
            return Scene(vertices, triangles=np.asarray(mesh.faces))
        if hasattr(mesh, "entities"):
            lines = [np.asarray(entity.discrete(vertices), np.float64) for entity in mesh.entities]
            return _polylines(lines)
        return Scene(vertices, points=np.arange(len(vertices)))

    @staticmethod
    def from_open3d(geometry: Any) -> Scene:
        """Make a scene from a mesh, a point cloud or a set of lines of Open3D, legacy or tensor.

        Coordinates in float32, the default of tensor meshes, are converted exactly.
        """
        if hasattr(geometry, "to_legacy"):
            lists = {}
            for name in ("vertex", "point", "triangle", "line"):
                key = "positions" if name in ("vertex", "point") else "indices"
                attributes = getattr(geometry, name, None)
                if attributes is not None and key in attributes:
                    lists[name] = attributes[key].cpu().numpy()
            vertices = lists.get("vertex", lists.get("point", np.empty((0, 3))))
            triangles, lines = lists.get("triangle"), lists.get("line")
        else:
            has_vertices = hasattr(geometry, "vertices")
            vertices = np.asarray(geometry.vertices if has_vertices else geometry.points)
            triangles = np.asarray(geometry.triangles) if hasattr(geometry, "triangles") else None
            lines = np.asarray(geometry.lines) if hasattr(geometry, "lines") else None
        if triangles is None and lines is None:
            return Scene(vertices, points=np.arange(len(vertices)))
        return Scene(vertices, triangles=triangles, segments=lines)

    @staticmethod
    def from_pyvista(mesh: Any) -> Scene:
        """Make a scene from the polygons, lines and vertex cells of a PyVista mesh.

        Polygons are triangulated and polylines divided into segments. A grid is replaced by its surface. The `sources`
        of triangles are the numbers of their polygons, or of the cells of the grid.
        """
        if not hasattr(mesh, "GetPolys"):
            # Versions in which the algorithm can be chosen warn if it is not.
            can_choose = "algorithm" in inspect.signature(mesh.extract_surface).parameters
            mesh = mesh.extract_surface(**({"algorithm": None} if can_choose else {}))
            cells = np.asarray(mesh.cell_data["vtkOriginalCellIds"])
        else:
            # Vertices and lines come before polygons.
            cells = np.arange(mesh.n_cells) - mesh.n_verts - mesh.n_lines
        polygons = mesh.copy(deep=False)
        polygons.clear_data()
        polygons.cell_data["p2m_cell"] = cells
        polygons = polygons.triangulate()
        triangles = np.asarray(polygons.faces).reshape(-1, 4)[:, 1:]
        of_polygons = slice(polygons.n_verts + polygons.n_lines, None)
        sources = np.asarray(polygons.cell_data["p2m_cell"])[of_polygons]
        vertices = np.asarray(mesh.points)
        lines = _runs(np.asarray(mesh.lines))
        segments = [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
        points = _runs(np.asarray(mesh.verts))
        return _joined(vertices, ([triangles], segments, points), sources)

    @staticmethod
    def from_meshio(mesh: Any) -> Scene:
        """Make a scene from the cells of a meshio mesh, of the types vertex, line, triangle and quad.

        Quads are divided into triangles along the diagonal of their first and third corner. Cells of other types are
        an error, because they have no surface of their own.
        """
        triangles, segments, points = [], [], []
        sources, polygons = [np.empty(0, np.int64)], 0
        for block in mesh.cells:
            cells = np.asarray(block.data)
            if block.type in ("triangle", "quad"):
                parts = 1 if block.type == "triangle" else 2
                corners = [0, 1, 2] if parts == 1 else [0, 1, 2, 0, 2, 3]
                triangles.append(cells[:, corners].reshape(-1, 3))
                sources.append(np.repeat(np.arange(polygons, polygons + len(cells)), parts))
                polygons += len(cells)
            elif block.type == "line":
                segments.append(cells)
            elif block.type == "vertex":
                points.append(cells.reshape(-1))
            else:
                raise ValueError(f"cells: there are cells of the type {block.type!r}, which are no triangles or lines")
        vertices = _in_space(np.asarray(mesh.points))
        return _joined(vertices, (triangles, segments, points), np.concatenate(sources))

    @property
    def counts(self) -> Counts:
        """The numbers of vertices, triangles, segments and points."""
        return Counts(*self._raw.counts())

    def __len__(self) -> int:
        counts = self.counts
        return counts.triangles + counts.segments + counts.points

    @property
    def bounds(self) -> NDArray[np.float64]:
        """The corners of the box around all primitives, shape (2, 3); nan for an empty scene."""
        bounds = self._raw.bounds()
        return np.full((2, 3), np.nan) if bounds is None else np.array(bounds)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """A copy of the vertices, shape (n, 3)."""
        return self._raw.vertices()

    @property
    def triangles(self) -> NDArray[np.int64]:
        """A copy of the vertices of the triangles, shape (m, 3)."""
        return self._raw.triangles()

    @property
    def segments(self) -> NDArray[np.int64]:
        """A copy of the vertices of the segments, shape (m, 2)."""
        return self._raw.segments()

    @property
    def points(self) -> NDArray[np.int64]:
        """A copy of the vertices of the points, shape (m,)."""
        return self._raw.points()

    @property
    def triangle_ids(self) -> NDArray[np.int64]:
        """The ids of the triangles as primitives, shape (m,)."""
        return self._raw.ids(3)

    @property
    def segment_ids(self) -> NDArray[np.int64]:
        """The ids of the segments as primitives, shape (m,)."""
        return self._raw.ids(2)

    @property
    def point_ids(self) -> NDArray[np.int64]:
        """The ids of the points as primitives, shape (m,)."""
        return self._raw.ids(1)

    @property
    def sources(self) -> NDArray[np.int64]:
        """The number of the statement of each primitive, among the statements of its kind in the file, shape (m,).

        A polygon is one statement and becomes several triangles.
        """
        return self._raw.sources()

    @property
    def objects(self) -> list[Object]:
        """The named parts of the file, in the order of their ids."""
        return [Object(*parts) for parts in self._raw.objects()]

    @property
    def unit(self) -> str | None:
        """The unit of the coordinates, such as ``'mm'``, ``'ft'`` or ``'degrees'``, if the file states it.

        Coordinates are not converted. Saved and pickled scenes do not keep the unit.
        """
        return self._raw.unit()

    @property
    def skipped(self) -> list[str]:
        """Descriptions of the records that the reader left out, such as ``'2 x usemtl'``."""
        return self._raw.skipped()

    def moved(self, vertices: ArrayLike) -> Scene:
        """Return a scene with the same primitives and names over other positions of all vertices.

        Parameters
        ----------
        vertices : array_like, shape (n, 3)
            The new coordinates.

        Raises
        ------
        ValueError
            If there is another number of vertices, or one that a primitive uses is not finite.
        """
        return Scene._from_raw(self._raw.moved(coordinates(vertices, "vertices").reshape(-1)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene to a file, which appears under its name when it is complete.

        Parameters
        ----------
        path : path-like
            Its extension selects the format: obj, ply, stl or off, xyz, csv or npy for points, or p2m, which keeps
            everything. STL rounds to float32, and only obj and p2m keep names.

        Raises
        ------
        ValueError
            For another extension, or a scene that the format cannot hold.
        OSError
            If the file cannot be written.
        """
        self._raw.write(os.fspath(path))

    def show(self, *, unit: str = "units", up: Literal["y", "z"] = "z") -> Page:
        """Return a page that shows the scene, which notebooks show.

        Scenes of at most 100,000 primitives answer queries where the pointer is.

        Parameters
        ----------
        unit : str, optional
            The name of the unit of lengths.
        up : {"y", "z"}, optional
            The axis that points up.

        Examples
        --------
        >>> import p2m
        >>> p2m.Scene([[0, 0, 0], [1, 0, 0]], segments=[[0, 1]]).show(unit="m").save("scene.html") # doctest: +SKIP
        """
        return scene_page(self, None, field=None, sign=None, unit=unit, up=up)

    def __repr__(self) -> str:
        counts = self.counts
        return f"<p2m.Scene of {counts.triangles} triangles, {counts.segments} segments, {counts.points} points>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _scene_from_bytes, (self._raw.to_bytes(),)


def _scene_from_bytes(data: bytes) -> Scene:
    return Scene._from_raw(_p2m.Scene.from_bytes(data))


def _joined(vertices: NDArray[Any], kinds: Iterable[list[NDArray[Any]]], sources: NDArray[Any]) -> Scene:
    """Return a scene of arrays of triangles, of segments and of points, with the polygon of each triangle."""
    scene = Scene(vertices, *(np.concatenate(arrays) if arrays else None for arrays in kinds))
    return Scene._from_raw(scene._raw.with_sources(np.ascontiguousarray(sources, np.uint32)))


def _in_space(points: NDArray[Any]) -> NDArray[Any]:
    """Return points with three coordinates. Points of the plane get z = 0."""
    if points.ndim == 2 and points.shape[1] == 2:
        return np.column_stack([points, np.zeros(len(points))])
    return points


def _polylines(lines: Iterable[NDArray[Any]]) -> Scene:
    """Return a scene of the segments between consecutive points of each line."""
    points = [_in_space(line) for line in lines]
    starts = np.cumsum([0] + [len(line) for line in points])
    segments = [np.arange(start, start + len(line) - 1) for start, line in zip(starts, points)]
    first = np.concatenate(segments) if segments else np.empty(0, np.int64)
    vertices = np.concatenate(points) if points else np.empty((0, 3))
    return Scene(vertices, segments=np.stack([first, first + 1], axis=1))


def _runs(padded: NDArray[Any]) -> list[NDArray[Any]]:
    """Return the runs of an array that consists of runs, each preceded by its length."""
    runs, at = [], 0
    while at < len(padded):
        stop = at + 1 + int(padded[at])
        runs.append(padded[at + 1 : stop])
        at = stop
    return runs


def read(path: str | os.PathLike[str]) -> Scene:
    """Read a scene from a file. Its extension selects the format.

    The formats are obj, ply, stl, off; xyz, txt, asc, pts, csv and npy of points; las, laz, e57 and pcd of scans; gltf,
    glb and 3mf; geojson, json and shp; and p2m for a saved index. A file with two coordinates for each point has z = 0.

    Parameters
    ----------
    path : path-like
        The file.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If its content is not a scene; the message has the line.

    Examples
    --------
    >>> import os, p2m, tempfile
    >>> folder = tempfile.mkdtemp()
    >>> path = os.path.join(folder, "court.obj")
    >>> _ = open(path, "w").write("o court\\nv 0 0 0\\nv 2 0 0\\nv 2 2 0\\nv 0 2 0\\nf 1 2 3 4\\n")
    >>> scene = p2m.read(path)
    >>> scene, scene.objects[0].name
    (<p2m.Scene of 2 triangles, 0 segments, 0 points>, 'court')
    """
    return Scene._from_raw(_p2m.Scene.read(os.fspath(path)))


class PointTable(NamedTuple):
    """The points of a file: an array of shape (n, 3), with their ids and the unit if the file has them."""

    points: NDArray[np.float64]
    ids: list[str] | None
    unit: str | None


def read_points(
    path: str | os.PathLike[str], columns: Iterable[str | int] = (), *, id: str | int | None = None
) -> PointTable:
    """Read the points of a file: the rows of a table or an array, or the vertices of a scene.

    Parameters
    ----------
    path : path-like
        The file, in any format of `read`.
    columns : iterable of str or int, optional
        The columns of x, y and z, or of x and y, in a text table: names, or numbers from 1. By default columns are
        found by names such as x, y and z, or else the first three are used.
    id : str or int, optional
        The column of a text table that has the ids of the points. By default it is a column named id.

    Returns
    -------
    PointTable
        The points, their ids and their unit. Points that are not finite are kept.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If its content is not a list of points; the message has the line.

    Examples
    --------
    >>> import os, p2m, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "stations.csv")
    >>> _ = open(path, "w").write("nr,easting,northing,height\\nP7,85000.5,446000.25,1.5\\n")
    >>> points, ids, unit = p2m.read_points(path, id="nr")
    >>> points.tolist(), ids
    ([[85000.5, 446000.25, 1.5]], ['P7'])
    """
    chosen = [str(column) for column in columns]
    return PointTable(*_p2m.read_points(os.fspath(path), chosen, None if id is None else str(id)))
