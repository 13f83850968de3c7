"""`p2m.compat.open3d` has the shapes, types and signs of Open3D, which is not needed for these tests."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES

import p2m
from p2m.compat.open3d import INVALID_ID, Array, RaycastingScene

POINTS = np.array([[0.25, 0.5, 0.5], [0.5, 0.75, 3.0], [-3.0, -4.0, 0.5], [12.0, 0.5, 0.5]], np.float32)
RAYS = np.array(
    [[0.25, 0.5, -2, 0, 0, 2], [10.5, 0.25, 3, 0, 0, -1], [5, 5, 5, 1, 0, 0], [0.25, 0.25, 0.5, 1, 0, 0], [0] * 6],
    np.float32,
)


def cubes(**options: object) -> RaycastingScene:
    """Return a scene of a cube from 0 to 1 and one that begins at (10, 0, 0)."""
    scene = RaycastingScene(**options)  # type: ignore[arg-type]
    assert scene.add_triangles(CUBE_VERTICES.astype(np.float32), CUBE_TRIANGLES.astype(np.uint32)) == 0
    moved = p2m.Scene(CUBE_VERTICES + [10, 0, 0], triangles=CUBE_TRIANGLES)
    assert scene.add_triangles(mesh=moved) == 1
    return scene


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_closest_points_keep_leading_axes(dtype: type) -> None:
    scene = cubes(dtype=dtype)
    for shape in [(4,), (2, 2), (2, 1, 2)]:
        answer = scene.compute_closest_points(POINTS.reshape((*shape, 3)))
        assert set(answer) == {"points", "geometry_ids", "primitive_ids", "primitive_uvs", "primitive_normals"}
        shapes = {name: array.shape for name, array in answer.items()}
        assert shapes["points"] == shapes["primitive_normals"] == (*shape, 3)
        assert shapes["primitive_uvs"] == (*shape, 2)
        assert shapes["geometry_ids"] == shapes["primitive_ids"] == shape
        assert answer["geometry_ids"].dtype == answer["primitive_ids"].dtype == np.uint32
        assert answer["points"].dtype == answer["primitive_uvs"].dtype == answer["primitive_normals"].dtype == dtype
    flat = {name: array.reshape((4, *array.shape[3:])).numpy() for name, array in answer.items()}
    np.testing.assert_array_equal(flat["points"], [[0, 0.5, 0.5], [0.5, 0.75, 1], [0, 0, 0.5], [11, 0.5, 0.5]])
    assert flat["geometry_ids"].tolist() == [0, 0, 0, 1]
    np.testing.assert_array_equal(flat["primitive_normals"][[0, 1, 3]], [[-1, 0, 0], [0, 0, 1], [1, 0, 0]])
    corners = CUBE_VERTICES[CUBE_TRIANGLES[flat["primitive_ids"]]]
    corners[flat["geometry_ids"] == 1] += [10, 0, 0]
    u, v = flat["primitive_uvs"].T
    rebuilt = np.einsum("in,nij->nj", np.stack([1 - u - v, u, v]), corners)
    np.testing.assert_allclose(rebuilt, flat["points"], atol=1e-6)


def test_inside_is_negative_and_occupied() -> None:
    scene = cubes()
    for array, expected in [
        (scene.compute_distance(POINTS), [0.25, 2, 5, 1]),
        (scene.compute_signed_distance(POINTS, nsamples=3), [-0.25, 2, 5, 1]),
        (scene.compute_occupancy(POINTS), [1, 0, 0, 0]),
    ]:
        assert array.dtype == np.float32 and array.tolist() == expected
        assert isinstance(array, Array) and type(array.numpy()) is np.ndarray
    for samples in [0, 2]:
        with pytest.raises(ValueError, match="not odd"):
            scene.compute_occupancy(POINTS, nsamples=samples)
    # An answer in float64 equals the answer of the index.
    points = np.random.default_rng(1).normal(size=(50, 3))
    index = p2m.Index(p2m.Scene(CUBE_VERTICES, triangles=CUBE_TRIANGLES))
    exact = RaycastingScene(dtype=np.float64)
    exact.add_triangles(CUBE_VERTICES, CUBE_TRIANGLES)
    np.testing.assert_array_equal(exact.compute_distance(points), index.distance(points))


def test_rays() -> None:
    scene = cubes()
    hits = scene.cast_rays(RAYS)
    assert hits["t_hit"].tolist() == [1, 2, np.inf, 0.75, np.inf]
    assert hits["geometry_ids"].tolist() == [0, 1, INVALID_ID, 0, INVALID_ID]
    assert (hits["primitive_ids"][[2, 4]] == RaycastingScene.INVALID_ID).all() and INVALID_ID == 2**32 - 1
    np.testing.assert_array_equal(hits["primitive_normals"], [[0, 0, -1], [0, 0, 1], [0, 0, 0], [1, 0, 0], [0, 0, 0]])
    assert hits["primitive_uvs"].shape == (5, 2) and (hits["primitive_uvs"][2] == 0).all()
    assert (hits["t_hit"].dtype, hits["primitive_ids"].dtype) == (np.float32, np.uint32)
    counts = scene.count_intersections(RAYS)
    assert counts.dtype == np.int32 and counts.tolist() == [2, 2, 0, 3, 0]
    occluded = scene.test_occlusions(RAYS, tnear=1.5, tfar=1.5)
    assert occluded.dtype == np.bool_ and occluded.tolist() == [True, False, False, False, False]
    assert not scene.test_occlusions(RAYS, 2.0, 1.0).any()
    every = scene.list_intersections(RAYS.reshape(5, 1, 6))
    assert every["ray_splits"].tolist() == [0, 2, 4, 4, 7, 7]
    assert every["ray_ids"].tolist() == [0, 0, 1, 1, 3, 3, 3]
    assert every["t_hit"].tolist() == [1, 1.5, 2, 3, 0.75, 9.75, 10.75]
    assert every["geometry_ids"].tolist() == [0, 0, 1, 1, 0, 1, 1]
    assert {name: array.dtype.name for name, array in every.items()} == {
        "ray_splits": "uint32", "ray_ids": "uint32", "t_hit": "float32", "geometry_ids": "uint32",
        "primitive_ids": "uint32", "primitive_uvs": "float32",
    }  # fmt: skip
    assert scene.cast_rays(RAYS.reshape(1, 5, 6))["primitive_uvs"].shape == (1, 5, 2)
    none = scene.list_intersections(RAYS[:0])
    assert none["ray_splits"].tolist() == [0] and none["primitive_uvs"].shape == (0, 2)


def test_an_empty_scene_has_no_answers() -> None:
    scene = RaycastingScene()
    assert np.isinf(scene.compute_distance(POINTS)).all() and np.isinf(scene.compute_signed_distance(POINTS)).all()
    assert not scene.compute_occupancy(POINTS).any() and not scene.count_intersections(RAYS).any()
    answer = scene.compute_closest_points(POINTS)
    assert (answer["primitive_ids"] == INVALID_ID).all() and np.isnan(answer["points"]).all()
    assert (answer["primitive_normals"] == 0).all()


def test_adding_triangles_rebuilds() -> None:
    scene = cubes()
    assert scene.compute_distance(POINTS[3:]).tolist() == [1]
    far = scene.add_triangles([[12, 0, 0], [12, 4, 0], [12, 0, 4]], [[0, 1, 2]])
    assert far == 2 and scene.compute_closest_points(POINTS[3:])["geometry_ids"].tolist() == [2]
    wrong = [
        (np.zeros((3, 2)), [[0, 1, 2]], ValueError),
        (np.zeros((3, 3)), [[0, 1, 3]], ValueError),
        (np.zeros((3, 3)), [[0, 1]], ValueError),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], TypeError),
        (np.full((3, 3), np.nan), [[0, 1, 2]], ValueError),
    ]
    for vertices, triangles, error in wrong:
        with pytest.raises(error):
            scene.add_triangles(vertices, triangles)
    with pytest.raises(TypeError, match="or a mesh"):
        scene.add_triangles()
    with pytest.raises(ValueError, match="segments or points"):
        scene.add_triangles(p2m.Scene([[0, 0, 0]], points=[0]))
    with pytest.raises(ValueError, match="row 0"):
        scene.compute_distance([[np.nan, 0, 0]])
    with pytest.raises(ValueError, match=r"\{\.\., 6\}"):
        scene.cast_rays(POINTS)
    with pytest.raises(ValueError, match="neither"):
        RaycastingScene(dtype=np.int32)
    assert scene.compute_distance(POINTS[3:]).tolist() == [0]


def answer_of(scene: RaycastingScene) -> list[float]:
    """Return distances. It is a function of the module, so that other processes can call it."""
    values: list[float] = scene.compute_signed_distance(POINTS).tolist()
    return values


def test_scenes_are_copied_and_pickled() -> None:
    scene = cubes()
    for is_built in [False, True]:
        for other in [copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))]:
            assert answer_of(other) == [-0.25, 2, 5, 1]
            other.add_triangles([[12, 0, 0], [12, 4, 0], [12, 0, 4]], [[0, 1, 2]])
            assert other.compute_distance(POINTS)[3] == 0 and scene.compute_distance(POINTS)[3] == 1, is_built
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert pool.submit(answer_of, scene).result() == answer_of(scene)


def test_triangles_without_area_have_no_normal() -> None:
    scene = RaycastingScene()
    scene.add_triangles([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    assert scene.compute_closest_points([[1, 1, 0]])["primitive_normals"].tolist() == [[0, 0, 0]]
    tiny = RaycastingScene(dtype=np.float64)
    tiny.add_triangles(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) * 1e-200, [[0, 1, 2]])
    assert tiny.compute_closest_points([[1, 1, 0]])["primitive_normals"].tolist() == [[0, 0, 1]]
