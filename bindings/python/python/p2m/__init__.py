"""Closest points, signed distances and rays in scenes of triangles, segments and points.

All numbers are float64, answers are the same bits on every machine, and ties go to the lowest id.

>>> import numpy as np, p2m
>>> scene = p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]])
>>> index = p2m.Index(scene)
>>> answer = index.closest(np.array([[1.0, 1.0, 2.0], [9.0, 0.0, 0.0]]), fields=("distance", "primitive", "point"))
>>> answer.distance
array([2., 5.])
>>> answer.point.tolist()
[[1.0, 1.0, 0.0], [4.0, 0.0, 0.0]]

`read` reads scenes from files, and `Scene.of` takes meshes of trimesh, Open3D, PyVista and meshio. `Index` has the
queries. `hausdorff` returns the Hausdorff distance of two scenes, and `deviation` compares a scan with a mesh, onto
which `align` moves it. `load` loads saved indexes, and `advise` recommends a backend for a scene. `Ask` and the module
`p2m.dask` ask a saved index from any number of processes. `write_shards` and `Shards` are for scenes that are larger
than memory.
"""

from __future__ import annotations

from ._align import Alignment, align
from ._ask import Ask
from ._cuda import CudaIndex
from ._deviation import Deviation, deviation
from ._hausdorff import HausdorffDistance, hausdorff
from ._index import Estimate, Index, OffsetSurface, advise, load
from ._index_cache import clear_opened
from ._p2m import __version__, backends
from ._page import Page
from ._records import (
    AllHits,
    BallContacts,
    ClosestPairs,
    ClosestPoints,
    ClosestToShapes,
    FirstHits,
    NearPrimitives,
    Record,
)
from ._sample import SdfSamples, SurfaceSamples, map, sample_sdf, sample_surface
from ._scene import Counts, Object, PointTable, Scene, read, read_points
from ._shards import ShardInfo, Shards, write_shards

__all__ = [
    "Alignment",
    "AllHits",
    "Ask",
    "BallContacts",
    "ClosestPairs",
    "ClosestPoints",
    "ClosestToShapes",
    "Counts",
    "CudaIndex",
    "Deviation",
    "Estimate",
    "FirstHits",
    "HausdorffDistance",
    "Index",
    "NearPrimitives",
    "Object",
    "OffsetSurface",
    "Page",
    "PointTable",
    "Record",
    "Scene",
    "SdfSamples",
    "ShardInfo",
    "Shards",
    "SurfaceSamples",
    "__version__",
    "advise",
    "align",
    "backends",
    "clear_opened",
    "deviation",
    "hausdorff",
    "load",
    "map",
    "read",
    "read_points",
    "sample_sdf",
    "sample_surface",
    "write_shards",
]
