"""`p2m.compat.trimesh` has the shapes, types and signs of trimesh, which is not needed for these tests."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES, sphere

from p2m.compat import trimesh


def cube() -> Any:
    """Return a cube from 0 to 1."""
    return SimpleNamespace(vertices=CUBE_VERTICES.copy(), faces=CUBE_TRIANGLES.copy())


POINTS = np.array([[0.25, 0.5, 0.5], [0.5, 0.75, 3.0], [-3.0, -4.0, 0.5], [1.0, 1.0, 1.0]])


def test_closest_points_are_those_of_the_closed_form() -> None:
    mesh = cube()
    for points in [POINTS, POINTS.tolist(), POINTS.astype(np.float32), np.asfortranarray(POINTS)]:
        closest, distance, triangle_id = trimesh.closest_point(mesh, points)
        assert (closest.dtype, distance.dtype, triangle_id.dtype) == (np.float64, np.float64, np.int64)
        np.testing.assert_array_equal(closest, [[0, 0.5, 0.5], [0.5, 0.75, 1], [0, 0, 0.5], [1, 1, 1]])
        np.testing.assert_array_equal(distance, [0.25, 2, 5, 0])
    query = trimesh.ProximityQuery(mesh)
    for ours, expected in zip(query.on_surface(POINTS), (closest, distance, triangle_id)):
        np.testing.assert_array_equal(ours, expected)
    empty = trimesh.closest_point(mesh, np.empty((0, 3)))
    assert [array.shape for array in empty] == [(0, 3), (0,), (0,)]


def test_inside_is_positive() -> None:
    mesh = cube()
    expected = [0.25, -2.0, -5.0, 0.0]
    np.testing.assert_array_equal(trimesh.signed_distance(mesh, POINTS), expected)
    np.testing.assert_array_equal(trimesh.ProximityQuery(mesh).signed_distance(POINTS), expected)
    assert trimesh.RayMeshIntersector(mesh).contains_points(POINTS).tolist() == [True, False, False, False]


def test_nearest_vertices_keep_leading_axes() -> None:
    query = trimesh.ProximityQuery(cube())
    distance, vertex = query.vertex(POINTS)
    assert distance.dtype == np.float64 and vertex.dtype == np.int64
    np.testing.assert_array_equal(CUBE_VERTICES[vertex[1:]], [[0, 1, 1], [0, 0, 0], [1, 1, 1]])
    assert distance[3] == 0.0
    one = query.vertex(POINTS[2])
    assert one[0] == distance[2] and np.ndim(one[0]) == 0 and int(one[1]) == vertex[2]
    assert query.vertex(POINTS.reshape(2, 2, 3))[1].tolist() == vertex.reshape(2, 2).tolist()


ORIGINS = np.array([[0.25, 0.5, -2.0], [0.5, 0.5, 3.0], [9.0, 9.0, 0.0], [0.5, 0.5, -1.0], [0.0, 0.0, 0.0]])
DIRECTIONS = np.array([[0.0, 0.0, 2.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])


def test_rays_hit_each_place_once() -> None:
    rays = trimesh.RayMeshIntersector(cube())
    locations, index_ray, index_tri = rays.intersects_location(ORIGINS, DIRECTIONS)
    assert (locations.dtype, index_ray.dtype, index_tri.dtype) == (np.float64, np.int64, np.int64)
    # The second and the fourth ray go through the diagonals of two sides, which belong to two faces each.
    assert index_ray.tolist() == [0, 0, 1, 1, 3, 3]
    assert locations[:, 2].tolist() == [0, 1, 1, 0, 0, 1]
    index_tri, index_ray = rays.intersects_id(ORIGINS, DIRECTIONS)
    assert index_ray.tolist() == [0, 0, 1, 1, 1, 1, 3, 3, 3, 3] and len(index_tri) == 10
    index_tri, index_ray, locations = rays.intersects_id(ORIGINS, DIRECTIONS, return_locations=True, max_hits=1)
    assert index_ray.tolist() == [0, 1, 3] and locations[:, 2].tolist() == [0, 1, 0]
    first = rays.intersects_id(ORIGINS, DIRECTIONS, multiple_hits=False, return_locations=True)
    for ours, expected in zip(first, (index_tri, index_ray, locations)):
        np.testing.assert_array_equal(ours, expected)
    faces = rays.intersects_first(ORIGINS, DIRECTIONS)
    assert faces.dtype == np.int64 and faces.tolist() == [index_tri[0], index_tri[1], -1, index_tri[2], -1]
    hit = rays.intersects_any(ORIGINS, DIRECTIONS)
    assert hit.dtype == np.bool_ and hit.tolist() == [True, True, False, True, False]
    none = rays.intersects_location(ORIGINS[:0], DIRECTIONS[:0])
    assert [array.shape for array in none] == [(0, 3), (0,), (0,)]


def test_indexes_follow_changes() -> None:
    mesh = cube()
    assert trimesh.signed_distance(mesh, [[0.5, 0.5, 0.75]]).tolist() == [0.25]
    mesh.vertices[:, 2] += 1.0
    assert trimesh.signed_distance(mesh, [[0.5, 0.5, 0.75]]).tolist() == [-0.25]
    trimesh.clear_cache()
    assert trimesh.signed_distance(mesh, [[0.5, 0.5, 0.75]]).tolist() == [-0.25]


def test_holes_and_wrong_arguments() -> None:
    vertices, faces = sphere()
    mesh = SimpleNamespace(vertices=vertices, faces=faces[9:])
    assert trimesh.signed_distance(mesh, [[0, 0, 0.0], [0, 0, -2.0]]).tolist()[0] > 0.9
    with pytest.raises(ValueError, match="no faces"):
        trimesh.closest_point(SimpleNamespace(vertices=vertices, faces=np.empty((0, 3), int)), POINTS)
    for points in [POINTS[0], POINTS[:, :2], np.zeros((2, 2, 3))]:
        with pytest.raises(ValueError, match=r"\(n,3\)"):
            trimesh.closest_point(mesh, points)
    with pytest.raises(ValueError, match="row 1"):
        trimesh.signed_distance(mesh, [[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="shapes"):
        trimesh.RayMeshIntersector(mesh).intersects_any(ORIGINS, DIRECTIONS[:2])


def test_queries_of_one_mesh_can_be_replaced() -> None:
    mesh = cube()
    mesh.nearest, mesh.ray = object(), object()
    before = mesh.nearest, mesh.ray
    for _ in range(2):
        trimesh.enable(mesh)
    assert mesh.nearest.signed_distance(POINTS).tolist() == [0.25, -2.0, -5.0, 0.0]
    assert mesh.ray.contains_points(POINTS)[0]
    for _ in range(2):
        trimesh.disable(mesh)
    assert (mesh.nearest, mesh.ray) == before


def test_overlapping_shells_are_united() -> None:
    """The nearest part of a point in two cubes is inside of the other one."""
    vertices = np.concatenate([CUBE_VERTICES, CUBE_VERTICES * 0.5 + [0.75, 0.25, 0.25]])
    mesh = SimpleNamespace(vertices=vertices, faces=np.concatenate([CUBE_TRIANGLES, CUBE_TRIANGLES + 8]))
    points = [[0.875, 0.5, 0.5], [0.625, 0.5, 0.5], [1.125, 0.5, 0.5], [0.70, 0.5, 0.5]]
    distance = trimesh.signed_distance(mesh, points)
    np.testing.assert_allclose(distance, [0.125, 0.125, 0.125, 0.05], rtol=1e-12)
    assert trimesh.RayMeshIntersector(mesh).contains_points(points).tolist() == [True] * 4
