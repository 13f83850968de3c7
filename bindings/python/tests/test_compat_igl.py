"""`p2m.compat.igl` has the shapes, types and signs of libigl, which is not needed for these tests."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES, sphere

from p2m.compat import igl

POINTS = np.array([[0.25, 0.5, 0.5], [0.5, 0.75, 3.0], [-3.0, -4.0, 0.5], [1.0, 1.0, 1.0]])
CLOSEST = [[0, 0.5, 0.5], [0.5, 0.75, 1], [0, 0, 0.5], [1, 1, 1]]


def test_squared_distances_of_triangles_edges_and_points() -> None:
    D, I, C = igl.point_mesh_squared_distance(POINTS, CUBE_VERTICES, CUBE_TRIANGLES)
    assert (D.dtype, I.dtype, C.dtype) == (np.float64, np.int64, np.float64)
    assert D.tolist() == [0.0625, 4, 25, 0] and C.tolist() == CLOSEST
    D, I, C = igl.point_mesh_squared_distance([[0, 0, 3.0]], [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1], [1, 2]])
    assert (D.tolist(), I.tolist(), C.tolist()) == ([9], [0], [[0, 0, 0]])
    D, I, C = igl.point_mesh_squared_distance([[5, 0, 0]], [[0, 0, 0], [4, 0, 0]], np.array([[0], [1]], np.uint8))
    assert (D.tolist(), I.tolist(), C.tolist()) == ([1], [1], [[4, 0, 0]])
    # Elements may occur twice.
    assert igl.point_mesh_squared_distance([[5, 0, 0]], [[0, 0, 0], [4, 0, 0]], [[0], [1], [1]])[1].tolist() == [1]
    # Degenerate triangles are edges, and points of the plane have two coordinates.
    D, I, C = igl.point_mesh_squared_distance([[0.5, 2.0]], [[0.0, 0.0], [1.0, 0.0]], [[0, 1, 1]])
    assert (D.tolist(), I.tolist(), C.tolist()) == ([4], [0], [[0.5, 0]])
    D, I, C = igl.point_mesh_squared_distance(POINTS, CUBE_VERTICES, np.empty((0, 3), np.int64))
    assert np.isinf(D).all() and (I == -1).all() and np.isnan(C).all()
    assert igl.point_mesh_squared_distance(POINTS[:0], CUBE_VERTICES, CUBE_TRIANGLES)[2].shape == (0, 3)


@pytest.mark.parametrize("rule", list(igl.SignedDistanceType))
def test_inside_is_negative(rule: igl.SignedDistanceType) -> None:
    for sign_type in [rule, int(rule), SimpleNamespace(value=int(rule))]:
        S, I, C, N = igl.signed_distance(POINTS, CUBE_VERTICES, CUBE_TRIANGLES, sign_type)
        assert (S.dtype, I.dtype, C.dtype, N.dtype) == (np.float64, np.int64, np.float64, np.float64)
        inside = 0.25 if rule == igl.SIGNED_DISTANCE_TYPE_UNSIGNED else -0.25
        assert S.tolist() == [inside, 2, 5, 0] and C.tolist() == CLOSEST
        if rule == igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL:
            half, third = np.sqrt(0.5), np.sqrt(1 / 3)
            expected = [[-1, 0, 0], [0, 0, 1], [-half, -half, 0], [third, third, third]]
            np.testing.assert_allclose(N, expected, atol=1e-15)
        else:
            assert N.shape == (0, 0)


def test_bounds_leave_points_without_an_answer() -> None:
    lengths = np.array([0.25, 2.0, 5.0, 0.0])
    rule = igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    for low, high in [(-1, 1), (-3, 1), (-np.inf, 1), (0, 3), (1, 3), (-0.01, 10), (-10, 0.01), (-2, 2), (2, 2.0)]:
        largest = max(abs(low), abs(high))
        smallest = max(largest - (high - low), 0.0) if np.isfinite(low) else 0.0
        is_in = (lengths < largest) & (lengths >= smallest)
        S, I, C, N = igl.signed_distance(POINTS, CUBE_VERTICES, CUBE_TRIANGLES, rule, low, high)
        np.testing.assert_array_equal(np.isnan(S), ~is_in)
        np.testing.assert_array_equal(I == len(CUBE_TRIANGLES) + 1, ~is_in)
        np.testing.assert_array_equal(np.isnan(C).all(axis=1), ~is_in)
        np.testing.assert_array_equal(np.isnan(N).all(axis=1), ~is_in)
        np.testing.assert_array_equal(np.abs(S[is_in]), lengths[is_in])


def test_surfaces_with_holes() -> None:
    vertices, triangles = sphere()
    points = np.array([[0.0, 0.0, 0.1], [0.0, 0.0, -3.0]])
    opened = triangles[48:]
    for rule, scale in [(0, 1), (1, 1), (2, 1), (4, 1)]:
        S = igl.signed_distance(points, vertices, opened, rule)[0]
        assert S[0] < -0.85 * scale and S[1] == 2.0
    # With pseudonormals, the sides of a sheet decide the sign.
    sheet = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]])
    S, _, _, N = igl.signed_distance([[1, 1, 1], [1, 1, -1], [-3, 0, 4]], sheet, [[0, 1, 2]], 0)
    assert S.tolist() == [1, -1, 5] and N[:2].tolist() == [[0, 0, 1]] * 2


def test_indexes_are_found_by_content() -> None:
    igl.clear_cache()
    vertices = CUBE_VERTICES.copy()
    igl.point_mesh_squared_distance(POINTS, vertices, CUBE_TRIANGLES)
    kept = list(igl._cache._entries)
    igl.signed_distance(POINTS, vertices.tolist(), CUBE_TRIANGLES.astype(np.int32))
    assert [entry[1] for entry in igl._cache._entries] == [entry[1] for entry in kept]
    vertices += 1.0
    assert igl.point_mesh_squared_distance(POINTS, vertices, CUBE_TRIANGLES)[0][3] == 0.0
    D = igl.point_mesh_squared_distance([[0.5, 0.5, 0.5]], vertices, CUBE_TRIANGLES)[0]
    np.testing.assert_allclose(D, 0.75, rtol=1e-15)
    for shift in range(6):
        igl.point_mesh_squared_distance(POINTS, vertices + shift, CUBE_TRIANGLES)
    assert len(igl._cache._entries) == 4
    igl.clear_cache()
    assert not igl._cache._entries


def test_tree() -> None:
    tree = igl.AABB()
    with pytest.raises(ValueError, match="init"):
        tree.squared_distance(CUBE_VERTICES, CUBE_TRIANGLES, POINTS)
    tree.init(CUBE_VERTICES, CUBE_TRIANGLES)
    D, I, C = tree.squared_distance(CUBE_VERTICES, CUBE_TRIANGLES, POINTS)
    assert D.tolist() == [0.0625, 4, 25, 0] and C.tolist() == CLOSEST
    origins = np.array([[0.25, 0.5, -2.0], [9.0, 9.0, 9.0], [0.0, 0.0, 0.0]])
    directions = np.array([[0, 0, 2.0], [1, 0, 0], [0, 0, 0]])
    hits = tree.intersect_ray(CUBE_VERTICES, CUBE_TRIANGLES, origins, directions)
    assert [len(of_ray) for of_ray in hits] == [2, 0, 0] and [hit[1] for hit in hits[0]] == [1.0, 1.5]
    I, T, UV = tree.intersect_ray_first(CUBE_VERTICES, CUBE_TRIANGLES, origins, directions)
    assert I.tolist() == [hits[0][0][0], -1, -1] and T[0] == 1.0 and np.isnan(T[1:]).all()
    assert UV.shape == (3, 2) and UV[0].tolist() == list(hits[0][0][2:])
    assert tree.intersect_ray_first(CUBE_VERTICES, CUBE_TRIANGLES, origins, directions, 0.5)[0].tolist() == [-1] * 3


def test_wrong_arguments() -> None:
    for arguments, error in [
        ((POINTS[0], CUBE_VERTICES, CUBE_TRIANGLES), ValueError),
        ((POINTS[:, :2], CUBE_VERTICES, CUBE_TRIANGLES), ValueError),
        ((POINTS, CUBE_VERTICES, CUBE_TRIANGLES[0]), ValueError),
        ((POINTS, CUBE_VERTICES, CUBE_TRIANGLES + 6), ValueError),
        ((POINTS, CUBE_VERTICES, CUBE_TRIANGLES + 0.5), TypeError),
        ((POINTS + np.nan, CUBE_VERTICES, CUBE_TRIANGLES), ValueError),
        ((POINTS.astype(str), CUBE_VERTICES, CUBE_TRIANGLES), TypeError),
    ]:
        with pytest.raises(error):
            igl.point_mesh_squared_distance(*arguments)
    with pytest.raises(ValueError, match="triangles"):
        igl.signed_distance(POINTS, CUBE_VERTICES, CUBE_TRIANGLES[:, :2])
    with pytest.raises(ValueError, match="SignedDistanceType"):
        igl.signed_distance(POINTS, CUBE_VERTICES, CUBE_TRIANGLES, 7)


def test_rules_agree_where_a_surface_is_wound_twice() -> None:
    vertices = np.concatenate([CUBE_VERTICES, CUBE_VERTICES * 0.5 + [0.75, 0.25, 0.25]])
    triangles = np.concatenate([CUBE_TRIANGLES, CUBE_TRIANGLES + 8])
    rng = np.random.default_rng(8)
    points = np.concatenate([rng.random((500, 3)) * [1.6, 1.2, 1.2] - 0.1, [[0.875, 0.5, 0.5], [-1.0, 0.5, 0.5]]])
    first = ((points > 0) & (points < 1)).all(axis=1)
    second = ((points > [0.75, 0.25, 0.25]) & (points < [1.25, 0.75, 0.75])).all(axis=1)
    for flip in [1, -1]:
        faces = triangles[:, ::flip]
        by_winding = igl.signed_distance(points, vertices, faces)[0] < 0
        by_normals = igl.signed_distance(points, vertices, faces, igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL)[0] < 0
        np.testing.assert_array_equal(by_winding, first | second)
        np.testing.assert_array_equal(by_normals, first | second)
    # A cube that is inside out, inside of another one.
    faces = np.concatenate([CUBE_TRIANGLES, CUBE_TRIANGLES[:, ::-1] + 8])
    by_winding = igl.signed_distance(points, vertices, faces)[0] < 0
    np.testing.assert_array_equal(by_winding, first ^ second)
