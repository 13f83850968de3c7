"""Shapes, strides and types of arguments, arrays for answers, and errors."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import ALL_FIELDS, assert_same, mixed_scene, sphere
from hypothesis import given, settings
from hypothesis import strategies as st

import p2m

INDEX = p2m.Index(mixed_scene())
SIGNED = p2m.Index(p2m.Scene(*sphere(6, 8)))


@pytest.mark.parametrize("shape", [(), (1,), (7,), (2, 3), (4, 1, 5), (0,), (3, 0)])
def test_leading_axes_are_kept(shape: tuple[int, ...]) -> None:
    points = np.random.default_rng(1).normal(size=(*shape, 3))
    flat = points.reshape(-1, 3)
    answer = INDEX.closest(points, fields=ALL_FIELDS)
    expected = INDEX.closest(flat, fields=ALL_FIELDS)
    for name in ALL_FIELDS:
        assert answer[name].shape[: len(shape)] == shape
        np.testing.assert_array_equal(answer[name].reshape(expected[name].shape), expected[name])
    assert INDEX.distance(points).shape == shape
    assert SIGNED.signed_distance(points).shape == shape
    assert INDEX.k_nearest(points, 2, fields="point").point.shape == (*shape, 2, 3)
    assert INDEX.is_any_within(points, 1.0).shape == shape
    assert INDEX.rays(points, [0, 0, 1]).t.shape == shape
    assert len(INDEX.within(points, 0.1).splits) == len(flat) + 1


def strided(points: np.ndarray) -> list[np.ndarray]:
    """Return arrays with the same values and other strides."""
    wide = np.zeros((2 * len(points), 7))
    wide[::2, 1:6:2] = points
    record = np.zeros(len(points), np.dtype({"names": ["p"], "formats": ["3f8"], "offsets": [1], "itemsize": 30}))
    record["p"] = points
    read_only = points.copy()
    read_only.flags.writeable = False
    return [wide[::2, 1:6:2], np.asfortranarray(points), points[::-1].copy()[::-1], record["p"], read_only,
            points.astype(">f8"), points.astype(np.longdouble)]


def test_strides_and_types_do_not_matter() -> None:
    points = np.random.default_rng(2).normal(size=(50, 3)).astype(np.float32).astype(np.float64)
    expected = INDEX.closest(points, fields=ALL_FIELDS)
    for other in [*strided(points), points.astype(np.float32), points.tolist()]:
        assert_same(INDEX.closest(other, fields=ALL_FIELDS), expected)
    integers = np.arange(30).reshape(10, 3)
    for dtype in ["i1", "u2", "i4", "u8", ">i4"]:
        assert_same(INDEX.closest(integers.astype(dtype)), INDEX.closest(integers.astype(float)))


def test_scenes_take_all_types_of_arrays() -> None:
    vertices, triangles = sphere(6, 8)
    single = vertices.astype(np.float32)
    expected = p2m.Scene(single.astype(np.float64), triangles)
    for positions in [single, *strided(single.astype(np.float64))]:
        for dtype in ["i1", "u1", "i2", "u4", "i8", "u8", ">i2"]:
            scene = p2m.Scene(positions, np.asfortranarray(triangles.astype(dtype)))
            np.testing.assert_array_equal(scene.vertices, expected.vertices)
            np.testing.assert_array_equal(scene.triangles, expected.triangles)
    assert expected.triangles.dtype == np.int64 and len(expected) == len(triangles)


def test_scenes_number_triangles_segments_points() -> None:
    scene = p2m.Scene(np.eye(3), triangles=[[0, 1, 2]], segments=[[0, 1], [1, 2]], points=[2])
    assert scene.counts == (3, 1, 2, 1)
    assert [scene.triangle_ids.tolist(), scene.segment_ids.tolist(), scene.point_ids.tolist()] == [[0], [1, 2], [3]]
    assert scene.segments.tolist() == [[0, 1], [1, 2]] and scene.points.tolist() == [2]
    assert "1 triangles, 2 segments, 1 points" in repr(scene)


def test_arrays_for_answers_are_used() -> None:
    points = np.random.default_rng(3).normal(size=(4, 5, 3))
    expected = INDEX.closest(points, fields=ALL_FIELDS)
    out = {name: np.zeros_like(expected[name]) for name in ALL_FIELDS}
    answer = INDEX.closest(points, out=out)
    assert all(answer[name] is out[name] for name in ALL_FIELDS)
    assert_same(answer, expected)
    assert_same(INDEX.closest(points * 0, out=answer), INDEX.closest(points * 0, fields=ALL_FIELDS))
    distance = np.empty((4, 5))
    assert INDEX.distance(points, out=distance) is distance
    assert INDEX.closest(points, fields="distance", out=distance).distance is distance
    np.testing.assert_array_equal(distance, expected.distance)
    near = np.empty((4, 5), bool)
    assert INDEX.is_any_within(points, 0.3, out=near) is near
    signed = np.empty((4, 5))
    assert SIGNED.signed_distance(points, out=signed) is signed
    k = {"primitive": np.empty((4, 5, 2), np.int64)}
    assert INDEX.k_nearest(points, 2, out=k).primitive is k["primitive"]
    # A part of a larger array is an array as well.
    table = np.zeros((10, 5))
    INDEX.distance(points, out=table[3:7])
    np.testing.assert_array_equal(table[3:7], expected.distance)
    assert not table[:3].any() and not table[7:].any()


def test_arrays_for_answers_are_checked() -> None:
    points = np.zeros((4, 3))
    read_only = np.empty(4)
    read_only.flags.writeable = False
    for error, message, out in [
        (TypeError, "float32 instead of float64", {"distance": np.empty(4, np.float32)}),
        (TypeError, "int32 instead of int64", {"primitive": np.empty(4, np.int32)}),
        (ValueError, r"shape \(5,\) instead of \(4,\)", {"distance": np.empty(5)}),
        (ValueError, r"shape \(4, 1\)", {"distance": np.empty((4, 1))}),
        (ValueError, "not contiguous", {"distance": np.empty(8)[::2]}),
        (ValueError, "not contiguous", {"point": np.empty((3, 4)).T}),
        (ValueError, "read-only", {"distance": read_only}),
        (TypeError, "no array of NumPy but list", {"distance": [0.0] * 4}),
        (ValueError, "'colour' is none of", {"colour": np.empty(4)}),
        (TypeError, "neither an array nor a dictionary", 7),
        (ValueError, "one array was given for the fields", np.empty(4)),
    ]:
        with pytest.raises(error, match=message):
            INDEX.closest(points, out=out)
    with pytest.raises(ValueError, match="no array for the field 'point'"):
        INDEX.closest(points, fields=("distance", "point"), out={"distance": np.empty(4)})
    with pytest.raises(ValueError, match="but the fields are distance"):
        INDEX.closest(points, fields="distance", out={"distance": np.empty(4), "primitive": np.empty(4, np.int64)})


def test_arrays_may_not_overlap() -> None:
    memory = np.zeros(30)
    points, overlapping = memory[:12].reshape(4, 3), memory[10:14]
    with pytest.raises(ValueError, match="parts of its memory"):
        INDEX.distance(points, out=overlapping)
    both = {"distance": memory[12:16], "lower_bound": memory[14:18]}
    with pytest.raises(ValueError, match="parts of its memory"):
        INDEX.closest(points, out=both)
    INDEX.closest(points, out={"distance": memory[12:16], "lower_bound": memory[16:20]})


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_queries_that_are_not_finite_are_named(value: float, dtype: type) -> None:
    for row in [0, 1023, 1024, 4321]:
        points = np.zeros((5000, 3), dtype)
        points[row, row % 3] = value
        for ask in [
            INDEX.closest,
            INDEX.distance,
            SIGNED.signed_distance,
            lambda p: INDEX.closest(p, certified=True),
            lambda p: INDEX.k_nearest(p, 2),
            lambda p: INDEX.within(p, 0.1),
            lambda p: INDEX.is_any_within(p, 1.0),
            lambda p: INDEX.rays(p, [1, 0, 0]),
        ]:
            with pytest.raises(ValueError, match=rf"row {row} "):
                ask(points)


def test_wrong_arguments_are_named() -> None:
    points = np.zeros((2, 3))
    for error, message, call in [
        (ValueError, r"points: the shape is \(2, 2\)", lambda: INDEX.closest(np.zeros((2, 2)))),
        (ValueError, r"points: the shape is \(\)", lambda: INDEX.closest(3.0)),
        (TypeError, "points: the type is complex128", lambda: INDEX.closest(points * 1j)),
        (TypeError, "points: the type is <U1", lambda: INDEX.closest([["a", "b", "c"]])),
        (TypeError, "points: the type is object", lambda: INDEX.closest([[None, 1, 2]])),
        (ValueError, "max_distance: -1.0", lambda: INDEX.closest(points, max_distance=-1)),
        (ValueError, "max_distance: nan", lambda: INDEX.closest(points, max_distance=np.nan)),
        (ValueError, "epsilon: -0.5", lambda: INDEX.closest(points, epsilon=-0.5)),
        (ValueError, "max_visits: -1", lambda: INDEX.closest(points, max_visits=-1)),
        (ValueError, "certified", lambda: INDEX.closest(points, certified=True, epsilon=0.1)),
        (ValueError, "fields: 'colour'", lambda: INDEX.closest(points, fields=("colour",))),
        (ValueError, "fields: none", lambda: INDEX.closest(points, fields=())),
        (ValueError, "threads: 0", lambda: INDEX.closest(points, threads=0)),
        (TypeError, "threads: 1.5 is no whole number", lambda: INDEX.closest(points, threads=1.5)),
        (ValueError, "k: 0", lambda: INDEX.k_nearest(points, 0)),
        (ValueError, "radius: -1.0", lambda: INDEX.within(points, -1)),
        (ValueError, "radius: nan", lambda: INDEX.is_any_within(points, np.nan)),
        (ValueError, "sign: \"other\"", lambda: SIGNED.signed_distance(points, sign="other")),
        (ValueError, "inside: 'red'", lambda: SIGNED.signed_distance(points, inside="red")),
        (ValueError, "no triangles", lambda: INDEX.signed_distance(points)),
        (ValueError, "mode: 'some'", lambda: INDEX.rays(points, [0, 0, 1], "some")),
        (ValueError, "directions: row 1 is zero", lambda: INDEX.rays(points, [[0, 0, 1], [0, 0, 0]])),
        (ValueError, "t_min, t_max", lambda: INDEX.rays(points, [0, 0, 1], t_min=2, t_max=1)),
        (ValueError, "mode 'count' has none", lambda: INDEX.rays(points, [0, 0, 1], "count", fields="t")),
        (ValueError, "backend: 'tree' is none of 'auto', 'brute'", lambda: p2m.Index(INDEX.scene, "tree")),
        (ValueError, "directions: the backend 'aabb'", lambda: p2m.Index(INDEX.scene, directions=6)),
        (ValueError, "directions: 7", lambda: p2m.Index(INDEX.scene, "kdop", directions=7)),
        (ValueError, "resolution: -1", lambda: p2m.Index(INDEX.scene, "octree", resolution=-1)),
        (TypeError, "int is no scene", lambda: p2m.Index(7)),
        (TypeError, "progress: 7", lambda: INDEX.closest(points, progress=7)),
        (ValueError, r"vertices: the shape is \(3,\)", lambda: p2m.Scene([1, 2, 3])),
        (ValueError, r"triangles: the shape is \(1, 2\)", lambda: p2m.Scene(np.eye(3), [[0, 1]])),
        (ValueError, "row 1 is .0, 1, 3., but there are 3", lambda: p2m.Scene(np.eye(3), [[0, 1, 2], [0, 1, 3]])),
        (ValueError, "segments: row 0 is .-1, 1.", lambda: p2m.Scene(np.eye(3), segments=[[-1, 1]])),
        (ValueError, "points: row 0", lambda: p2m.Scene(np.eye(3), points=[2**40])),
        (TypeError, "triangles: the type is float64", lambda: p2m.Scene(np.eye(3), [[0.0, 1.0, 2.0]])),
        (ValueError, "primitive 0 has a coordinate", lambda: p2m.Scene([[np.nan, 0, 0]], points=[0])),
        (ValueError, "shape: ", lambda: INDEX.field((0, 0, 0), 1.0, (2, 2))),
        (ValueError, "spacing of -1", lambda: INDEX.field((0, 0, 0), -1.0, (2, 2, 2))),
        (ValueError, "origin", lambda: INDEX.field((0, 0), -1.0, (2, 2, 2))),
        (ValueError, "2 positions|positions", lambda: INDEX.refit(np.zeros((2, 3)))),
    ]:
        with pytest.raises(error, match=message):
            call()


def test_records_are_like_named_tuples() -> None:
    answer = INDEX.closest(np.zeros((2, 3)))
    distance, primitive = answer
    assert answer.fields == ("distance", "primitive") and len(answer) == 2
    assert answer["distance"] is distance is answer.distance and answer.asdict()["primitive"] is primitive
    with pytest.raises(AttributeError, match="it has distance, primitive"):
        _ = answer.point


@settings(max_examples=40, deadline=None)
@given(shape=st.lists(st.integers(0, 4), max_size=3), seed=st.integers(0, 100), order=st.permutations(range(3)))
def test_any_view_has_the_answers_of_its_copy(shape: list[int], seed: int, order: list[int]) -> None:
    base = np.random.default_rng(seed).normal(size=(*shape, 2, 3))[..., order][..., 1, :]
    assert_same(INDEX.closest(base), INDEX.closest(base.copy()))


def test_what_is_no_array_of_points_is_refused_or_understood(tmp_path: Path) -> None:
    corners = np.eye(3)
    index = p2m.Index(p2m.Scene(corners, [[0, 1, 2]]))
    masked = np.ma.masked_array(corners, mask=[[True] * 3, [False] * 3, [False] * 3])
    for ask in [lambda: index.distance(masked), lambda: p2m.Scene(masked), lambda: p2m.deviation(masked, index)]:
        with pytest.raises(TypeError, match="a masked array hides numbers"):
            ask()
    for wrong in [1.5, "2", None]:
        with pytest.raises(TypeError, match="k: .* is no whole number"):
            index.k_nearest(corners, wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="k: 1099511627776 is not from 1 to"):
        index.k_nearest(corners, 2**40)
    for text in ["1", b"1"]:
        with pytest.raises(TypeError, match="max_distance: .* is text and no number"):
            index.distance(corners, max_distance=text)  # type: ignore[arg-type]
    assert index.distance([]).shape == (0,) and index.k_nearest([], 2).distance.shape == (0, 2)
    # An array of points and a path are scenes.
    assert len(p2m.Scene(corners)) == 3 and p2m.Scene(corners).counts.points == 3
    assert len(p2m.Scene(corners, triangles=[])) == 0
    assert p2m.Index(corners).distance([1.0, 0.0, 0.5]) == 0.5
    path = tmp_path / "cloud.xyz"
    path.write_text("x y z\n0 0 0\nnan 0 0\n4 0 0\n")
    assert p2m.Index(path).distance([4, 3, 0]) == 3.0 and len(p2m.read(path)) == 2
    found = p2m.deviation(str(path), str(path), sign=None)
    assert found.values[[0, 2]].tolist() == [0.0, 0.0] and np.isnan(found.values[1])
    with pytest.raises(TypeError, match="list is no scene: give a path, an array of points"):
        p2m.Scene.of([[0, 0, 0]])


def test_meshes_of_other_packages_keep_the_numbers_of_their_cells_and_names() -> None:
    pyvista = pytest.importorskip("pyvista")
    tetrahedron = pyvista.UnstructuredGrid({10: np.array([[0, 1, 2, 3]])}, np.eye(4, 3))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene = p2m.Scene.of(tetrahedron)
    assert scene.counts.triangles == 4 and scene.sources.tolist() == [0] * 4
    faces = pyvista.PolyData(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1.0]]), [4, 0, 1, 2, 3, 3, 0, 1, 4]
    )
    assert p2m.Scene.of(faces).sources.tolist() == [0, 0, 1]


def test_quads_of_meshio_are_counted_as_cells() -> None:
    meshio = pytest.importorskip("meshio")
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.0]])
    mesh = meshio.Mesh(corners, [("triangle", [[1, 4, 2]]), ("quad", [[0, 1, 2, 3]])])
    assert p2m.Scene.of(mesh).sources.tolist() == [0, 1, 1]


def test_scenes_of_trimesh_keep_clouds_paths_and_names() -> None:
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene()
    turned = trimesh.transformations.translation_matrix([5, 0, 0])
    scene.add_geometry(trimesh.creation.box(), node_name="box", geom_name="box", transform=turned)
    scene.add_geometry(trimesh.PointCloud([[0, 0, 9.0]]), node_name="cloud", geom_name="cloud")
    scene.add_geometry(trimesh.load_path([[[0, 0, 0], [1, 0, 0]]]), node_name="path", geom_name="path")
    made = p2m.Scene.of(scene)
    assert (made.counts.triangles, made.counts.segments, made.counts.points) == (12, 1, 1)
    assert sorted(part.name for part in made.objects) == ["box", "cloud", "path"]
    index = p2m.Index(made)
    answer = index.closest([[6.5, 0, 0], [0, 0, 8]], fields=("distance", "object"))
    assert answer.distance.tolist() == [1.0, 1.0]
    assert [made.objects[number].name for number in answer.object] == ["box", "cloud"]
