"""Signs, rays, fields, refits, files, and the conversion of the objects of other packages."""

from __future__ import annotations

import os
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ALL_FIELDS, BACKENDS, EXACT_FIELDS, assert_same, mixed_scene, sphere

import p2m

SCENES = Path(__file__).resolve().parents[3] / "scenes"
HIT_FIELDS = ("t", "primitive", "point", "barycentric", "side")


def test_signs_tell_inside_from_outside(ball: p2m.Scene) -> None:
    rng = np.random.default_rng(4)
    points = rng.normal(size=(3000, 3))
    radius = np.linalg.norm(points, axis=1)
    clear = np.abs(radius - 1) > 0.02
    expected = None
    for backend in BACKENDS:
        index = p2m.Index(ball, backend)
        for sign in ["auto", "parity", "winding"]:
            signed = index.signed_distance(points, sign=sign)
            np.testing.assert_array_equal(np.abs(signed), index.distance(points))
            assert ((signed < 0) == (radius < 1))[clear].all()
            expected = signed if expected is None else expected
            assert signed.tobytes() == expected.tobytes()
        np.testing.assert_array_equal(index.signed_distance(points, inside="positive"), -expected)
    assert p2m.Index(ball).signed_distance(ball.vertices[:5]).tolist() == [0.0] * 5


def test_open_surfaces_have_winding_numbers_alone(ball: p2m.Scene) -> None:
    index = p2m.Index(p2m.Scene(ball.vertices, ball.triangles[5:]))
    assert float(index.signed_distance([0, 0, 0])) < 0
    with pytest.raises(ValueError, match="open at edge"):
        index.signed_distance([0, 0, 0], sign="parity")


@pytest.mark.parametrize("backend", ["aabb", "kdop"])
def test_rays_are_those_of_brute_force(backend: str, scene: p2m.Scene, brute: p2m.Index) -> None:
    rng = np.random.default_rng(5)
    origins = rng.normal(size=(500, 3)) * 2
    directions = scene.vertices[rng.integers(0, 300, 500)] - origins
    index = p2m.Index(scene, backend)
    for options in [{}, {"t_min": -np.inf}, {"t_min": 0.25, "t_max": 1.0, "radius": 0.01}]:
        for mode in ["first", "all"]:
            answer = index.rays(origins, directions, mode, fields=HIT_FIELDS, **options)
            assert_same(answer, brute.rays(origins, directions, mode, fields=HIT_FIELDS, **options))
        for mode in ["count", "any", "crossings"]:
            answer = index.rays(origins, directions, mode, **options)
            assert answer.tobytes() == brute.rays(origins, directions, mode, **options).tobytes()
    every = index.rays(origins, directions, "all", fields=HIT_FIELDS)
    counts = np.diff(every.splits)
    np.testing.assert_array_equal(counts, index.rays(origins, directions, "count"))
    np.testing.assert_array_equal(counts > 0, index.rays(origins, directions, "any"))
    first = index.rays(origins, directions, fields=HIT_FIELDS)
    hit = counts > 0
    assert hit.any() and not hit.all()
    np.testing.assert_array_equal(first.t[hit], every.t[every.splits[:-1][hit]])
    np.testing.assert_array_equal(first.primitive[hit], every.primitive[every.splits[:-1][hit]])
    assert (first.primitive[~hit] == -1).all() and np.isinf(first.t[~hit]).all() and np.isnan(first.point[~hit]).all()
    np.testing.assert_allclose(first.point[hit], (origins + first.t[:, None] * directions)[hit], atol=1e-9)


def test_rays_broadcast_and_cross_a_closed_surface(ball: p2m.Scene) -> None:
    index = p2m.Index(ball)
    inside = np.random.default_rng(6).uniform(-0.5, 0.5, (4, 50, 3))
    crossings = index.rays(inside, [0.0, 0.0, 1.0], "crossings")
    assert crossings.shape == (4, 50) and (crossings % 2 == 1).all()
    hits = index.rays([0, 0, 0], inside, fields=("t", "side"))
    assert hits.t.shape == (4, 50) and (hits.side == -1).all()
    with pytest.raises(ValueError, match="'octree' casts no rays"):
        p2m.Index(ball, "octree").rays([0, 0, 0], [0, 0, 1])


@pytest.mark.parametrize("backend", ["brute", "aabb", "octree"])
@pytest.mark.parametrize("counts", [(3, 4, 5), (24, 20, 22)])
def test_fields_are_the_distances_of_their_points(backend: str, counts: tuple[int, int, int], ball: p2m.Scene) -> None:
    index = p2m.Index(ball, backend)
    origin, spacing = np.array([-1.25, -1.5, -1.125]), 0.125
    points = origin + spacing * np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1)
    field = index.field(origin, spacing, counts)
    assert field.dtype == np.float32 and field.shape == counts and field.flags.f_contiguous
    np.testing.assert_array_equal(field, index.distance(points).astype(np.float32))
    signed = index.field(origin, spacing, counts, signed=True)
    np.testing.assert_array_equal(signed, index.signed_distance(points).astype(np.float32))
    banded = index.field(origin, spacing, counts, signed=True, band=0.25)
    np.testing.assert_array_equal(banded, np.clip(signed, -0.25, 0.25))
    for out in [np.empty(counts), np.empty((*counts, 2), np.float32)[..., 1]]:
        assert index.field(origin, spacing, counts, out=out) is out
        np.testing.assert_array_equal(out, field)
    for error, out in [(ValueError, np.empty((2, 2, 2))), (TypeError, np.empty(counts, int)), (TypeError, [0])]:
        with pytest.raises(error, match="out: "):
            index.field(origin, spacing, counts, out=out)


@pytest.mark.parametrize("backend", ["brute", "aabb", "kdop"])
def test_refits_are_builds(backend: str, queries: np.ndarray) -> None:
    scene = mixed_scene(7)
    index = p2m.Index(scene, backend, threads=2)
    before = index.closest(queries, fields=EXACT_FIELDS)
    moved = scene.vertices * [1.0, 2.0, -1.0] + np.sin(scene.vertices[:, ::-1])
    refitted = index.refit(moved.astype(np.float64))
    assert_same(refitted.closest(queries, fields=EXACT_FIELDS),
                p2m.Index(scene.moved(moved), backend).closest(queries, fields=EXACT_FIELDS))
    assert_same(index.closest(queries, fields=EXACT_FIELDS), before)
    np.testing.assert_array_equal(refitted.scene.vertices, moved)
    with pytest.raises(ValueError, match="not finite"):
        index.refit(moved * np.nan)
    if backend != "brute":
        assert refitted.info["surface_area"] > index.info["surface_area"] > 0


def test_cells_have_no_refit(scene: p2m.Scene) -> None:
    for backend in ["octree", "p2m"]:
        with pytest.raises(ValueError, match="has no refit: build a new index"):
            p2m.Index(scene, backend).refit(scene.vertices)


@pytest.mark.parametrize("options", [{"backend": name} for name in BACKENDS if name != "brute"] + [
    {"backend": "kdop", "directions": faces} for faces in [6, 18, 26, "scene"]] + [
    {"backend": "octree", "resolution": 0.9}])
@pytest.mark.parametrize("is_mapped", [False, True])
def test_saved_indexes_answer_as_before(
    options: dict[str, Any], is_mapped: bool, scene: p2m.Scene, queries: np.ndarray, tmp_path: Path
) -> None:
    index = p2m.Index(scene, **options)
    path = tmp_path / "index.p2m"
    index.save(path)
    assert os.listdir(tmp_path) == ["index.p2m"]
    loaded = p2m.load(path, map=is_mapped)
    assert loaded.backend == options["backend"] and loaded.info["path"] == path
    assert_same(loaded.closest(queries, fields=ALL_FIELDS), index.closest(queries, fields=ALL_FIELDS))
    assert loaded.info["directions"] == index.info["directions"]
    np.testing.assert_array_equal(loaded.scene.triangles, scene.triangles)
    again = tmp_path / "again.p2m"
    loaded.save(again)
    assert_same(p2m.load(again).closest(queries, fields=ALL_FIELDS), index.closest(queries, fields=ALL_FIELDS))
    assert p2m.read(path).counts == scene.counts


def test_files_that_cannot_be_used_are_errors(scene: p2m.Scene, tmp_path: Path) -> None:
    index = p2m.Index(scene)
    good, bad = tmp_path / "good.p2m", tmp_path / "bad.p2m"
    index.save(good)
    with pytest.raises(FileNotFoundError):
        p2m.load(tmp_path / "absent.p2m")
    with pytest.raises(FileNotFoundError):
        p2m.read(tmp_path / "absent.obj")
    with pytest.raises(OSError):
        index.save(tmp_path / "absent" / "x.p2m")
    with pytest.raises(IsADirectoryError):
        p2m.load(tmp_path)
    data = bytearray(good.read_bytes())
    for content, message in [
        (b"hello", "not a saved index|bytes instead"),
        (bytes(data[:-1]), "bytes instead of"),
        (bytes(data[:-9]) + b"\xff" + bytes(data[-8:]), "damaged"),
    ]:
        bad.write_bytes(content)
        with pytest.raises(ValueError, match=message):
            p2m.load(bad)
    with pytest.raises(ValueError, match="no saved form"):
        p2m.Index(scene, "brute").save(bad)
    wrong = tmp_path / "wrong.obj"
    wrong.write_text("v 0 0 0\np 2\n")
    with pytest.raises(ValueError, match="wrong.obj:2: vertex index 2"):
        p2m.read(wrong)
    with pytest.raises(ValueError, match="extension"):
        p2m.read(tmp_path / "scene.docx")


def test_objects_of_files_are_in_answers(tmp_path: Path) -> None:
    path = tmp_path / "two.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 9 9 8\nv 9 9 9\nl 1 4\n"
        "o floor\nf 1 2 3\nusemtl red\no pole\nl 3 4\no\nl 5 6\n"
    )
    scene = p2m.read(path)
    assert [tuple(o) for o in scene.objects] == [("floor", 1, 2), ("pole", 2, 3)]
    assert scene.skipped == ["1 x usemtl"] and scene.sources.tolist() == [0, 0, 1, 2]
    assert scene.triangle_ids.tolist() == [1] and scene.segment_ids.tolist() == [0, 2, 3]
    index = p2m.Index(scene)
    points = [[0.2, 0.2, -1], [0.1, 1, 0.1], [4, 3.9, 4], [9, 9, 8.5]]
    answer = index.closest(points, fields=("object", "primitive"), max_distance=1.0)
    assert answer.object.tolist() == [0, 1, -1, -1] and answer.primitive.tolist() == [1, 2, 0, 3]
    assert index.closest(points, fields="object").object.tolist() == [0, 1, -1, -1]
    assert sorted(index.k_nearest(points[:1], 3, fields="object").object[0].tolist()) == [-1, 0, 1]
    assert index.within(points, 1.0, fields="object").object[0] == 0


def test_advice_and_information(ball: p2m.Scene) -> None:
    advice = p2m.advise(ball, 10_000_000)
    assert advice == p2m.advise(ball, 10_000_000, threads=1)
    assert advice[0].backend == p2m.Index(ball, queries=10_000_000).backend == "octree"
    assert {estimate.backend for estimate in advice} == set(BACKENDS)
    assert advice[0].total_seconds <= advice[1].total_seconds and advice[0].reason
    assert p2m.advise(ball, 3, points=np.zeros((3, 3)), region="near")[0].backend == "brute"
    # A limit of memory excludes what is larger than the tree.
    limited = p2m.advise(ball, 10_000_000, max_bytes=0)
    assert limited[0].backend == "aabb" and "memory" in limited[-1].reason
    with pytest.raises(ValueError, match="region"):
        p2m.advise(ball, region="far")
    assert p2m.Index(ball).backend == "aabb"
    fine = p2m.Scene(*sphere(40, 60))
    assert [p2m.Index(fine, queries=count).backend for count in (1, 10_000, 10_000_000)] == ["aabb", "aabb", "octree"]
    with pytest.raises(ValueError, match="queries: -1 is not from 0"):
        p2m.Index(fine, queries=-1)
    octree = p2m.Index(fine, queries=10_000_000)
    smaller = p2m.Index(fine, queries=10_000_000, max_bytes=octree.info["memory_bytes"] - 1)
    assert smaller.info["memory_bytes"] < octree.info["memory_bytes"]
    with pytest.raises(ValueError, match="max_bytes: needs"):
        p2m.Index(fine, max_bytes=1000)
    with pytest.raises(ValueError, match="resolution: name the backend that has it, not 'auto'"):
        p2m.Index(fine, queries=10_000_000, resolution=1.0)
    for backend in BACKENDS:
        info = p2m.Index(ball, backend).info
        assert info["backend"] == backend and info["primitives"] == len(ball)
        assert info["casts_rays"] or backend not in ("brute", "aabb", "kdop")
        assert not info["casts_rays"] or backend not in ("octree", "p2m")
        assert (info["memory_bytes"] > 0) == info["is_saveable"]
        assert info["cells"] is not None or backend not in ("octree", "p2m")
        assert info["cells"] is None or backend not in ("brute", "aabb", "kdop")


def test_objects_of_other_packages_are_scenes() -> None:
    """The packages need not be installed: objects with their attributes stand for theirs."""
    vertices, triangles = sphere(6, 8)
    expected = p2m.Scene(vertices, triangles)

    def same(scene: p2m.Scene) -> None:
        np.testing.assert_array_equal(scene.vertices, expected.vertices)
        np.testing.assert_array_equal(scene.triangles, expected.triangles)

    same(p2m.Scene.of((vertices, triangles)))
    mesh = types.SimpleNamespace(vertices=vertices, faces=triangles)
    same(p2m.Scene.of(mesh))
    moved: list[object] = []
    part = types.SimpleNamespace(vertices=vertices, faces=triangles, apply_transform=moved.append)
    part.copy = lambda: part

    class Graph(dict[str, tuple[object, str]]):
        nodes_geometry = ("ball",)

    placed = p2m.Scene.of(types.SimpleNamespace(geometry={"shape": part}, graph=Graph(ball=("a matrix", "shape"))))
    same(placed)
    assert moved == ["a matrix"] and [named.name for named in placed.objects] == ["ball"]
    same(p2m.Index(mesh).scene)
    cloud = p2m.Scene.of(types.SimpleNamespace(vertices=vertices))
    assert cloud.counts.points == len(vertices) and len(cloud) == len(vertices)
    path = types.SimpleNamespace(
        vertices=vertices, entities=[types.SimpleNamespace(discrete=lambda v: v[:4]),
                                     types.SimpleNamespace(discrete=lambda v: v[5:7, :2])])
    assert p2m.Scene.of(path).counts.segments == 4

    block = types.SimpleNamespace
    cells = [block(type="triangle", data=triangles), block(type="quad", data=np.array([[0, 1, 2, 3]])),
             block(type="line", data=np.array([[0, 1]])), block(type="vertex", data=np.array([[4]]))]
    meshio = p2m.Scene.of(types.SimpleNamespace(points=vertices, cells_dict={}, cells=cells))
    assert meshio.counts == (len(vertices), len(triangles) + 2, 1, 1)
    with pytest.raises(ValueError, match="tetra"):
        p2m.Scene.from_meshio(types.SimpleNamespace(points=vertices, cells=[block(type="tetra", data=[])]))

    padded = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    poly = types.SimpleNamespace(points=vertices.astype(np.float32), faces=padded, lines=[3, 0, 1, 2, 2, 3, 4],
                                 verts=[1, 5], n_points=0, GetNumberOfCells=None, GetPolys=None, n_verts=1, n_lines=2,
                                 n_cells=len(triangles) + 3, cell_data={}, clear_data=lambda: None)
    poly.triangulate = lambda: poly
    poly.copy = lambda deep: poly
    assert p2m.Scene.of(poly).counts == (len(vertices), len(triangles), 3, 1)

    class TriangleMesh:
        __module__ = "open3d.geometry"

        def __init__(self) -> None:
            self.vertices, self.triangles = vertices, triangles

    same(p2m.Scene.of(TriangleMesh()))


@pytest.mark.parametrize("package", ["trimesh", "open3d", "pyvista", "meshio"])
def test_real_objects_of_other_packages_are_scenes(package: str) -> None:
    module = pytest.importorskip(package)
    vertices, triangles = sphere(6, 8)
    if package == "trimesh":
        mesh = module.Trimesh(vertices, triangles, process=False)
    elif package == "open3d":
        positions, corners = module.utility.Vector3dVector(vertices), module.utility.Vector3iVector(triangles)
        mesh = module.geometry.TriangleMesh(positions, corners)
    elif package == "pyvista":
        mesh = module.PolyData.from_regular_faces(vertices, triangles)
    else:
        mesh = module.Mesh(vertices, [("triangle", triangles)])
    scene = p2m.Scene.of(mesh)
    np.testing.assert_array_equal(scene.vertices, vertices)
    np.testing.assert_array_equal(scene.triangles, triangles)


def test_offset_surfaces_have_their_distance() -> None:
    scene = p2m.read(SCENES / "knot_and_cables.obj")
    found = p2m.Index(scene).offset_surface(0.3, resolution=40)
    distances = p2m.Index(scene).distance(found.scene.vertices)
    assert np.abs(distances - 0.3).max() == found.vertex_error < 1e-7
    edges = np.sort(found.scene.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    tube = p2m.Index(p2m.Scene(scene.vertices, triangles=scene.triangles))
    inside = tube.offset_surface(-0.05, resolution=64, signed=True).scene.vertices
    assert np.abs(tube.signed_distance(inside) + 0.05).max() < 1e-7
    with pytest.raises(ValueError):
        tube.offset_surface(0.1, resolution=7)
