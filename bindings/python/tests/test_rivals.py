"""Comparison with trimesh, Open3D, libigl and point-cloud-utils, as far as they are installed.

`cargo xtask python --rivals` installs them and runs these tests, which need the variable P2M_RIVALS. Answers are equal
within the precision of the other package. Exact arithmetic (exact.py) decides larger differences, and the table at the
end of the test run counts them: in all decided ones, p2m is right. P2M_DECIDED is the number of differences of each
kind that are decided, 25 by default, chosen at random.
"""

from __future__ import annotations

import gc
import inspect
import os
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES, DIFFERENCES, models, sphere
from exact import Mesh, error

import p2m
from p2m.compat import igl as our_igl
from p2m.compat import open3d as our_open3d
from p2m.compat import trimesh as our_trimesh

DECIDED = int(os.environ.get("P2M_DECIDED", "25"))
ROUNDING = 2.0**-53
SINGLE_ROUNDING = 2.0**-24

MODELS = ["cube", "sphere", "bunny.obj", "camel.off", "dragon_100k.obj", "gear_skewed_57k.ply", "gear_diff_ring.stl"]


if not os.environ.get("P2M_RIVALS"):
    pytest.skip("`cargo xtask python --rivals` compares with other packages", allow_module_level=True)


def package(name: str) -> ModuleType:
    """Return another package, or skip the test."""
    try:
        if name == "trimesh":
            __import__("rtree")
        return __import__(name)
    except ImportError as reason:
        pytest.skip(f"{name} cannot be imported: {reason}")


@lru_cache(maxsize=2)
def load(name: str) -> tuple[p2m.Scene, Mesh]:
    if name == "cube":
        scene = p2m.Scene(CUBE_VERTICES, triangles=CUBE_TRIANGLES)
    elif name == "sphere":
        scene = p2m.Scene(*sphere())
    else:
        folder = models()
        if folder is None or not (folder / name).exists():
            pytest.skip(f"the model {name} is absent")
        scene = p2m.read(Path(folder) / name)
        vertices, number = np.unique(scene.vertices, axis=0, return_inverse=True)
        scene = p2m.Scene(vertices, triangles=number.reshape(-1)[scene.triangles])
    return scene, Mesh(scene.vertices, scene.triangles)


@pytest.fixture(params=MODELS)
def model(request: pytest.FixtureRequest) -> Iterator[tuple[str, p2m.Scene, Mesh]]:
    yield (request.param, *load(request.param))


def points_of(scene: p2m.Scene, mesh: Mesh, count: int) -> np.ndarray:
    """Return points in the box, near the surface, above vertices and edges, and on the surface."""
    rng = np.random.default_rng(5)
    low, high = scene.bounds
    box = low + (rng.random((count, 3)) * 1.2 - 0.1) * (high - low)
    corners = mesh.corners[rng.integers(0, len(mesh.corners), count)]
    weights = rng.dirichlet([1, 1, 1], count)
    on = np.einsum("nij,ni->nj", corners, weights)
    near = on + rng.normal(size=on.shape) * np.linalg.norm(high - low) / 200
    above = np.concatenate([corners[:, 0], corners[:, :2].mean(axis=1)])
    above = above + (above - (low + high) / 2) * 0.125
    return np.concatenate([box, near, above[:: max(1, len(above) // count)], on[: count // 4]])


def chosen(rows: np.ndarray) -> np.ndarray:
    """Return the rows to decide."""
    rows = np.nonzero(rows)[0] if rows.dtype == np.bool_ else rows
    return rows if len(rows) <= DECIDED else np.random.default_rng(6).choice(rows, DECIDED, replace=False)


def note(what: str, rival: str, model: str, differences: int, queries: int, decided: int, reason: str) -> None:
    """Add a line to the table at the end."""
    if differences:
        DIFFERENCES.append((rival, what, model, f"{differences} of {queries}", decided, reason))


def decide_distances(
    rival: str, name: str, mesh: Mesh, points: np.ndarray, ours: tuple[Any, Any], theirs: tuple[Any, Any],
    tolerance: float, reason: str,
) -> None:  # fmt: skip
    """Check that distances differ by at most a tolerance, or else that ours is the right one."""
    size = np.abs(points).max(axis=1) + mesh.size
    differs = ~(np.abs(ours[0] - theirs[0]) <= tolerance * size)
    for row in (rows := chosen(differs)):
        squared, _ = mesh.nearest(points[row])
        bound = tolerance / 2 * size[row]
        own = error(ours[0][row], squared)
        assert own <= bound, (name, points[row], own)
        assert not error(theirs[0][row], squared) <= own, (name, points[row])
    note("distances", rival, name, int(differs.sum()), len(points), len(rows), reason)


def decide_triangles(
    rival: str, name: str, mesh: Mesh, points: np.ndarray, ours: np.ndarray, theirs: np.ndarray, rounding: float
) -> None:
    """Check that our triangles are the nearest ones, and the first of equally near ones."""
    differs = np.asarray(ours) != np.asarray(theirs)
    ties = nearer = equal = 0
    for row in (rows := chosen(differs)):
        own, other = (mesh.distance_to(points[row], int(ids[row])) for ids in (ours, theirs))
        if own == other:
            assert ours[row] < theirs[row], (name, points[row])
            ties += 1
        elif own < other:
            nearer += 1
        else:
            # Both triangles are the nearest one up to the error of computed distances.
            bound = 8 * rounding * (np.abs(points[row]).max() + mesh.size)
            assert error(float(own) ** 0.5, other) <= bound, (name, points[row])
            equal += 1
    reason = f"{ties} equally near, p2m has the lower id; {nearer} nearer in p2m; {equal} equal within rounding"
    note("triangles", rival, name, int(differs.sum()), len(points), len(rows), reason)


def decide_signs(
    rival: str, name: str, mesh: Mesh, points: np.ndarray, ours: np.ndarray, theirs: np.ndarray, reason: str,
) -> None:  # fmt: skip
    """Compare our insides with exact crossings, where others differ and in a sample everywhere."""
    differs = np.asarray(ours) != np.asarray(theirs)
    if not mesh.is_closed:
        note("signs", rival, name, int(differs.sum()), len(points), 0, "the surface is not closed: not decided")
        return
    decided = 0
    for row in [*chosen(differs), *chosen(np.arange(len(points)))]:
        winding = mesh.winding_number(points[row])
        if winding is not None:
            assert bool(ours[row]) == (winding != 0), (name, points[row])
            decided += bool(differs[row])
    note("signs", rival, name, int(differs.sum()), len(points), decided, reason)


# Signatures, shapes and types.


def documented_parameters(function: Any) -> list[str]:
    """Return the parameters in the documentation of a compiled function, a list for each signature."""
    name = function.__name__
    found = []
    for line in function.__doc__.splitlines():
        match = re.match(rf"\s*(?:\d+\. )?{name}\((.*)\) -> ", line)
        if match:
            text = re.sub(r"\[[^\[\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", match[1]))
            text = re.sub(r"\([^()]*\)", "", text)
            names = [part.split(":")[0].split("=")[0].strip() for part in text.split(",")]
            found.append(" ".join(part for part in names if part not in ("self", "*args", "**kwargs")))
    return found


def own_parameters(function: Callable[..., Any]) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name != "self"]


def test_parameters_of_trimesh() -> None:
    trimesh = package("trimesh")
    theirs_nearest, theirs_ray = trimesh.proximity.ProximityQuery, trimesh.ray.ray_triangle.RayMeshIntersector
    pairs = [
        (getattr(trimesh.proximity, name), getattr(our_trimesh, name)) for name in ("closest_point", "signed_distance")
    ]
    pairs += [
        (getattr(theirs_nearest, n), getattr(our_trimesh.ProximityQuery, n)) for n in ("vertex", "signed_distance")
    ]
    rays = ("__init__", "intersects_id", "intersects_location", "intersects_first", "intersects_any", "contains_points")
    pairs += [(getattr(theirs_ray, name), getattr(our_trimesh.RayMeshIntersector, name)) for name in rays]
    for theirs, ours in pairs:
        parameters = [p for p in inspect.signature(theirs).parameters.values() if p.name != "self"]
        names = [p.name for p in parameters if p.kind is not p.VAR_KEYWORD]
        assert own_parameters(ours)[: len(names)] == names, theirs
        defaults = [(p.name, p.default) for p in parameters if p.default is not p.empty]
        own = inspect.signature(ours).parameters
        assert [(name, own[name].default) for name, _ in defaults] == defaults, theirs


def test_parameters_of_open3d() -> None:
    theirs = package("open3d").t.geometry.RaycastingScene
    for name in [
        "compute_closest_points", "compute_distance", "compute_signed_distance", "compute_occupancy", "cast_rays",
        "count_intersections", "test_occlusions", "list_intersections",
    ]:  # fmt: skip
        ours = getattr(our_open3d.RaycastingScene, name)
        assert documented_parameters(getattr(theirs, name)) == [" ".join(own_parameters(ours))], name
    own = own_parameters(our_open3d.RaycastingScene.add_triangles)
    signatures = documented_parameters(theirs.add_triangles)
    assert signatures == [" ".join(own[:2]), own[2]]
    assert our_open3d.INVALID_ID == theirs.INVALID_ID == our_open3d.RaycastingScene.INVALID_ID


def test_parameters_of_libigl() -> None:
    igl = package("igl")
    for name in ["point_mesh_squared_distance", "signed_distance"]:
        ours = " ".join(own_parameters(getattr(our_igl, name)))
        assert documented_parameters(getattr(igl, name)) == [ours]
    for name in ["init", "squared_distance", "intersect_ray", "intersect_ray_first"]:
        assert documented_parameters(getattr(igl.AABB, name)) == [" ".join(own_parameters(getattr(our_igl.AABB, name)))]
    for name, member in igl.SignedDistanceType.__members__.items():
        assert our_igl.SignedDistanceType[name] == member.value == getattr(our_igl, name)


def assert_alike(ours: Any, theirs: Any, what: str) -> None:
    """Check that types and shapes are equal."""
    assert type(ours) is type(theirs) or isinstance(ours, np.ndarray), what
    if isinstance(theirs, tuple):
        assert len(ours) == len(theirs), what
        for number, (a, b) in enumerate(zip(ours, theirs, strict=True)):
            assert_alike(a, b, f"{what}[{number}]")
    elif isinstance(theirs, dict):
        assert set(ours) == set(theirs), what
        for name in theirs:
            assert_alike(ours[name], theirs[name], f"{what}[{name!r}]")
    else:
        a, b = (x.numpy() if hasattr(x, "numpy") else np.asarray(x) for x in (ours, theirs))
        assert (a.dtype, a.shape) == (b.dtype, b.shape), what


INSIDE = np.array([[0.25, 0.5, 0.5], [0.5, 0.75, 3.0], [-3.0, -4.0, 0.5], [1.0, 1.0, 1.0]])
ORIGINS = np.array([[0.25, 0.375, -2.0], [9.0, 9.0, 3.0], [0.5, 0.25, 0.5]])
UP = np.array([[0.0, 0.0, 2.0]] * 3)


def test_shapes_and_types_of_trimesh() -> None:
    trimesh = package("trimesh")
    mesh = trimesh.Trimesh(CUBE_VERTICES, CUBE_TRIANGLES, process=False)
    pairs = [(our_trimesh.ProximityQuery(mesh), trimesh.proximity.ProximityQuery(mesh))]
    for ours, theirs in pairs:
        for name in ["on_surface", "signed_distance", "vertex"]:
            assert_alike(getattr(ours, name)(INSIDE), getattr(theirs, name)(INSIDE), name)
        assert_alike(ours.vertex(INSIDE[0]), theirs.vertex(INSIDE[0]), "vertex of one point")
        assert_alike(ours.vertex(INSIDE[None]), theirs.vertex(INSIDE[None]), "vertex of a grid")
    ours, theirs = our_trimesh.RayMeshIntersector(mesh), trimesh.ray.ray_triangle.RayMeshIntersector(mesh)
    for name in ["intersects_id", "intersects_location", "intersects_first", "intersects_any"]:
        assert_alike(getattr(ours, name)(ORIGINS, UP), getattr(theirs, name)(ORIGINS, UP), name)
    for options in [{"return_locations": True}, {"multiple_hits": False}]:
        assert_alike(ours.intersects_id(ORIGINS, UP, **options), theirs.intersects_id(ORIGINS, UP, **options), "id")
    assert_alike(ours.contains_points(INSIDE), theirs.contains_points(INSIDE), "contains_points")


def test_shapes_and_types_of_open3d() -> None:
    open3d = package("open3d")
    arrays = CUBE_VERTICES.astype(np.float32), CUBE_TRIANGLES.astype(np.uint32)
    ours, theirs = our_open3d.RaycastingScene(), open3d.t.geometry.RaycastingScene()
    tensors = [open3d.core.Tensor(array) for array in arrays]
    assert ours.add_triangles(*arrays) == theirs.add_triangles(*arrays) == 0
    assert ours.add_triangles(*tensors) == theirs.add_triangles(*tensors) == 1
    mesh = open3d.t.geometry.TriangleMesh(*tensors)
    assert ours.add_triangles(mesh) == theirs.add_triangles(mesh=mesh) == 2
    assert ours.add_triangles(mesh=mesh) == theirs.add_triangles(mesh) == 3
    points = INSIDE.astype(np.float32)
    rays = np.concatenate([ORIGINS, UP], axis=1).astype(np.float32)
    for shape in [(-1,), (1, -1), (-1, 1, 1)]:
        for name, values in [
            ("compute_closest_points", points), ("compute_distance", points), ("compute_signed_distance", points),
            ("compute_occupancy", points), ("cast_rays", rays), ("count_intersections", rays),
            ("test_occlusions", rays), ("list_intersections", rays[:2]),
        ]:  # fmt: skip
            given = values.reshape((*shape, values.shape[1]))
            expected = getattr(theirs, name)(given)
            assert_alike(getattr(ours, name)(given), expected, name)
            found = getattr(ours, name)(open3d.core.Tensor(given))
            for tensor in found.values() if isinstance(found, dict) else [found]:
                assert isinstance(tensor, open3d.core.Tensor), name
            assert_alike(found, expected, name)


def test_shapes_and_types_of_libigl() -> None:
    igl = package("igl")
    for width in [3, 2, 1]:
        # libigl crashes if points occur twice.
        elements = np.ascontiguousarray(CUBE_TRIANGLES[:, :width]) if width > 1 else np.arange(8)[:, None]
        ours, theirs = (
            module.point_mesh_squared_distance(INSIDE, CUBE_VERTICES, elements) for module in (our_igl, igl)
        )
        assert_alike(ours, theirs, f"{width} columns")
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-14)
    plane = INSIDE[:, :2].copy(), CUBE_VERTICES[:, :2].copy(), np.ascontiguousarray(CUBE_TRIANGLES[:, :2])
    assert_alike(our_igl.point_mesh_squared_distance(*plane), igl.point_mesh_squared_distance(*plane), "plane")
    for rule in igl.SignedDistanceType.__members__.values():
        ours, theirs = (
            module.signed_distance(INSIDE, CUBE_VERTICES, CUBE_TRIANGLES, rule) for module in (our_igl, igl)
        )
        assert_alike(ours, theirs, str(rule))
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-3)
        np.testing.assert_allclose(ours[3], theirs[3], atol=1e-14)
    for bounds in [(-1, 1), (-3, 1), (-np.inf, 1), (0, 3), (1, 3), (-0.01, 10), (-10, 0.01), (-2, 2)]:
        ours, theirs = (
            module.signed_distance(
                INSIDE, CUBE_VERTICES, CUBE_TRIANGLES, igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL, *bounds
            )
            for module in (our_igl, igl)
        )
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-14)
        np.testing.assert_array_equal(ours[1] == len(CUBE_TRIANGLES) + 1, theirs[1] == len(CUBE_TRIANGLES) + 1)
    trees = our_igl.AABB(), igl.AABB()
    for tree in trees:
        tree.init(CUBE_VERTICES, CUBE_TRIANGLES)
    ours, theirs = (tree.squared_distance(CUBE_VERTICES, CUBE_TRIANGLES, INSIDE) for tree in trees)
    assert_alike(ours, theirs, "squared_distance")
    ours, theirs = (tree.intersect_ray_first(CUBE_VERTICES, CUBE_TRIANGLES, ORIGINS, UP) for tree in trees)
    assert_alike(ours, theirs, "intersect_ray_first")
    np.testing.assert_allclose(ours[1], theirs[1], atol=1e-6)
    ours, theirs = (tree.intersect_ray(CUBE_VERTICES, CUBE_TRIANGLES, ORIGINS, UP) for tree in trees)
    assert [[hit[0] for hit in hits] for hits in ours] == [[hit[0] for hit in hits] for hits in theirs]


# Answers on models.


def test_trimesh_on_models(model: tuple[str, p2m.Scene, Mesh]) -> None:
    trimesh = package("trimesh")
    name, scene, mesh = model
    points = points_of(scene, mesh, 300)
    other = trimesh.Trimesh(scene.vertices, scene.triangles, process=False)
    ours, theirs = our_trimesh.closest_point(other, points), trimesh.proximity.closest_point(other, points)
    reason = "trimesh takes the second of two candidates whose squared distances differ by up to 1e-8"
    decide_distances("trimesh", name, mesh, points, ours[1:], theirs[1:], 16 * ROUNDING, reason)
    decide_triangles("trimesh", name, mesh, points, ours[2], theirs[2], ROUNDING)
    signed, expected = our_trimesh.signed_distance(other, points), trimesh.proximity.signed_distance(other, points)
    np.testing.assert_array_equal(np.abs(signed), ours[1])
    clear = ours[1] > 2e-8
    reason = "normals of one triangle, and rays through edges"
    decide_signs("trimesh", name, mesh, points[clear], signed[clear] > 0, expected[clear] > 0, reason)
    distance, vertex = our_trimesh.ProximityQuery(other).vertex(points)
    rival_distance, rival_vertex = trimesh.proximity.ProximityQuery(other).vertex(points)
    np.testing.assert_allclose(distance, rival_distance, atol=16 * ROUNDING * mesh.size)
    assert (np.sum((scene.vertices[vertex] - points) ** 2, axis=1) <= rival_distance**2 * (1 + 1e-14)).all()
    moved = vertex != rival_vertex
    assert (vertex[moved] < rival_vertex[moved]).all()


def aimed(scene: p2m.Scene, mesh: Mesh, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return random rays, and rays through vertices, edges and faces."""
    rng = np.random.default_rng(7)
    low, high = scene.bounds
    origins = (low + high) / 2 + rng.normal(size=(4 * count, 3)) * (high - low) * 1.5
    corners = mesh.corners[rng.integers(0, len(mesh.corners), count)]
    inside = low + rng.random((count, 3)) * (high - low)
    targets = np.concatenate([inside, corners[:, 0], corners[:, :2].mean(axis=1), corners.mean(axis=1)])
    return origins, targets - origins


def test_rays_of_trimesh_on_models(model: tuple[str, p2m.Scene, Mesh]) -> None:
    trimesh = package("trimesh")
    name, scene, mesh = model
    origins, directions = aimed(scene, mesh, 60)
    other = trimesh.Trimesh(scene.vertices, scene.triangles, process=False)
    ours = our_trimesh.RayMeshIntersector(other)
    theirs = trimesh.ray.ray_triangle.RayMeshIntersector(other)
    counts, rival_counts = (
        np.bincount(rays.intersects_location(origins, directions)[1], minlength=len(origins)) for rays in (ours, theirs)
    )
    differs = counts != rival_counts
    for row in [*(rows := chosen(differs)), *chosen(~differs)[:3]]:
        assert counts[row] == len(mesh.hits(origins[row], directions[row])), (name, origins[row], directions[row])
    reason = "barycentric coordinates rounded at edges, or places merged within 1e-8 that are two or split that are one"
    note("places that rays hit", "trimesh", name, int(differs.sum()), len(origins), len(rows), reason)
    first, rival_first = ours.intersects_first(origins, directions), theirs.intersects_first(origins, directions)
    differs = first != rival_first
    for row in (rows := chosen(differs)):
        exact = mesh.hits(origins[row], directions[row])
        assert first[row] == (min(next(iter(exact.values()))) if exact else -1), (name, origins[row], directions[row])
    note(
        "first faces",
        "trimesh",
        name,
        int(differs.sum()),
        len(origins),
        len(rows),
        "p2m has the lowest id at the first hit",
    )


def test_open3d_on_models(model: tuple[str, p2m.Scene, Mesh]) -> None:
    open3d = package("open3d")
    name, scene, _ = model
    vertices = scene.vertices.astype(np.float32)
    mesh = Mesh(vertices, scene.triangles)
    points = points_of(scene, mesh, 1500).astype(np.float32)
    ours, theirs = our_open3d.RaycastingScene(dtype=np.float64), open3d.t.geometry.RaycastingScene()
    for each in (ours, theirs):
        each.add_triangles(vertices, scene.triangles.astype(np.uint32))
    distance = ours.compute_distance(points).numpy()
    rival = theirs.compute_distance(points).numpy().astype(np.float64)
    ids = ours.compute_closest_points(points)["primitive_ids"].numpy().astype(np.int64)
    rival_ids = theirs.compute_closest_points(points)["primitive_ids"].numpy().astype(np.int64)
    wide = points.astype(np.float64)
    reason = "float32 and cancellation in slivers"
    decide_distances("Open3D", name, mesh, wide, (distance, ids), (rival, rival_ids), 16 * SINGLE_ROUNDING, reason)
    decide_triangles("Open3D", name, mesh, wide, ids, rival_ids, ROUNDING)
    clear = distance > 0
    inside, rival_inside = (scene.compute_occupancy(points).numpy() > 0 for scene in (ours, theirs))
    reason = "hits of a ray in float32 at edges, counted twice or missed"
    decide_signs("Open3D", name, mesh, wide[clear], inside[clear], rival_inside[clear], reason)
    origins, directions = (array.astype(np.float32) for array in aimed(scene, mesh, 400))
    rays = np.concatenate([origins, directions], axis=1)
    counts, rival_counts = (scene.count_intersections(rays).numpy() for scene in (ours, theirs))
    differs = counts != rival_counts
    for row in [*(rows := chosen(differs)), *chosen(~differs)[:3]]:
        exact = mesh.hits(origins[row].astype(np.float64), directions[row].astype(np.float64))
        assert counts[row] == sum(len(ids) for ids in exact.values()), (name, rays[row])
    note("numbers of hits", "Open3D", name, int(differs.sum()), len(rays), len(rows), "float32 at edges and vertices")
    hits, rival_hits = (scene.cast_rays(rays)["t_hit"].numpy().astype(np.float64) for scene in (ours, theirs))
    with np.errstate(invalid="ignore"):
        differs = ~((np.abs(hits - rival_hits) <= 64 * SINGLE_ROUNDING) | (hits == rival_hits))
    for row in (rows := chosen(differs)):
        exact = mesh.hits(origins[row].astype(np.float64), directions[row].astype(np.float64))
        assert hits[row] == (float(next(iter(exact))) if exact else np.inf), (name, rays[row])
    note(
        "first hits",
        "Open3D",
        name,
        int(differs.sum()),
        len(rays),
        len(rows),
        "t_hit is beyond 64 u of float32, or missed",
    )


def test_libigl_on_models(model: tuple[str, p2m.Scene, Mesh]) -> None:
    igl = package("igl")
    name, scene, mesh = model
    vertices, triangles = scene.vertices, scene.triangles
    points = points_of(scene, mesh, 1500)
    ours, theirs = (module.point_mesh_squared_distance(points, vertices, triangles) for module in (our_igl, igl))
    roots = [(np.sqrt(answer[0]), answer[1]) for answer in (ours, theirs)]
    decide_distances("libigl", name, mesh, points, *roots, 16 * ROUNDING, "cancellation in slivers")
    decide_triangles("libigl", name, mesh, points, ours[1], theirs[1], ROUNDING)
    few = points[::4]
    distance = p2m.Index(scene).distance(few)
    for rule in ["PSEUDONORMAL", "FAST_WINDING_NUMBER", "WINDING_NUMBER"]:
        if rule == "WINDING_NUMBER":
            # libigl sums up all triangles for each point.
            few, distance = few[::10], distance[::10]
        number = getattr(igl, f"SIGNED_DISTANCE_TYPE_{rule}")
        signed, rival = (module.signed_distance(few, vertices, triangles, number)[0] for module in (our_igl, igl))
        clear = distance > 64 * ROUNDING * mesh.size
        np.testing.assert_allclose(np.abs(signed[clear]), distance[clear], atol=16 * ROUNDING * mesh.size)
        what = f"libigl, {rule.lower()}"
        decide_signs(what, name, mesh, few[clear], signed[clear] < 0, rival[clear] < 0,
                     "pseudonormals of a surface that intersects itself", rule != "PSEUDONORMAL")  # fmt: skip
        ids = np.zeros(len(few), np.int64)
        pair = (np.abs(signed[clear]), ids), (np.abs(rival[clear]), ids)
        decide_distances(what, name, mesh, few[clear], *pair, 1e-12, "distances times abs(1 - 2 w)")


def test_point_cloud_utils_on_models(model: tuple[str, p2m.Scene, Mesh]) -> None:
    pcu = package("point_cloud_utils")
    name, scene, mesh = model
    points = points_of(scene, mesh, 1500)
    index = p2m.Index(scene)
    answer = index.closest(points)
    distance, ids, _ = pcu.closest_points_on_mesh(points, scene.vertices, scene.triangles)
    both = (answer.distance, answer.primitive), (distance, ids)
    decide_distances("point-cloud-utils", name, mesh, points, *both, 16 * ROUNDING, "cancellation in slivers")
    decide_triangles("point-cloud-utils", name, mesh, points, answer.primitive, ids, ROUNDING)
    signed = index.signed_distance(points)
    rival, _, _ = pcu.signed_distance_to_mesh(points, scene.vertices, scene.triangles)
    clear = answer.distance > 64 * ROUNDING * mesh.size
    decide_signs(
        "point-cloud-utils",
        name,
        mesh,
        points[clear],
        signed[clear] < 0,
        rival[clear] < 0,
        "fast winding numbers",
    )
    pair = (np.abs(signed[clear]), ids[clear]), (np.abs(rival[clear]), ids[clear])
    decide_distances(
        "point-cloud-utils, signed", name, mesh, points[clear], *pair, 1e-12, "distances times abs(1 - 2 w)"
    )


def test_trimesh_answers_with_p2m() -> None:
    trimesh = package("trimesh")
    mesh = trimesh.Trimesh(*sphere(), process=False)
    before = mesh.nearest.signed_distance(INSIDE)
    original = trimesh.proximity.ProximityQuery.signed_distance
    our_trimesh.enable()
    try:
        our_trimesh.enable()
        fresh = trimesh.Trimesh(*sphere(), process=False)
        for each in (mesh, fresh):
            np.testing.assert_array_equal(
                each.nearest.signed_distance(INSIDE), our_trimesh.signed_distance(mesh, INSIDE)
            )
        assert mesh.ray.contains_points([[0, 0, 0]]).all() and mesh.contains([[0, 0, 0]]).all()
        np.testing.assert_allclose(mesh.nearest.signed_distance(INSIDE), before, atol=1e-12)
    finally:
        our_trimesh.disable()
    assert trimesh.proximity.ProximityQuery.signed_distance is original
    assert len(our_trimesh._of_meshes) >= 1
    # The index follows the mesh and is forgotten with it.
    query = our_trimesh.ProximityQuery(mesh)
    mesh.apply_scale(2.0)
    np.testing.assert_allclose(query.signed_distance([[0, 0, 0]]), 2 * our_trimesh.signed_distance(fresh, [[0, 0, 0]]))
    identity = id(mesh)
    assert identity in our_trimesh._of_meshes._made
    del mesh, query, each
    gc.collect()
    assert identity not in our_trimesh._of_meshes._made
    our_trimesh.enable(fresh)
    assert fresh.contains([[0, 0, 0]]).all() and isinstance(fresh.nearest, our_trimesh.ProximityQuery)
    our_trimesh.disable(fresh)
    assert isinstance(fresh.nearest, trimesh.proximity.ProximityQuery)
