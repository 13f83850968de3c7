"""Compares answers with exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from conftest import CUBE_TRIANGLES, CUBE_VERTICES, sphere
from exact import Mesh, error, squared_distance, vector

import p2m

ROUNDING = 2.0**-53


def test_exact_arithmetic_has_the_closed_forms() -> None:
    triangle = [vector(corner) for corner in ([0, 0, 0], [4, 0, 0], [0, 4, 0])]
    for point, expected in [((1, 1, 3), 9), ((-3, -4, 0), 25), ((2, -1, 1), 2), ((4, 4, 1), 9), ((1, 2, 0), 0)]:
        assert squared_distance(vector(point), triangle) == expected
    assert squared_distance(vector((1, 1, 0)), [triangle[0], triangle[1], triangle[1]]) == 1
    cube = Mesh(CUBE_VERTICES, CUBE_TRIANGLES)
    assert cube.is_closed and cube.nearest(np.array([0.5, 0.5, 2.0])) == (1, [10, 11])
    points = np.array([[0.5, 0.5, 0.5], [0.0, 0.0, -1.0], [0.5, 1.0, 0.5], [1.0, 1.0, -2.0]])
    inside = [cube.is_inside(point) for point in points]
    assert inside == [True, False, None, False]
    assert list(cube.hits(np.array([0.5, 0.5, -1.0]), np.array([0.0, 0.0, 2.0]))) == [Fraction(1, 2), 1]


def test_closest_triangles_signs_and_hits() -> None:
    rng = np.random.default_rng(3)
    vertices, triangles = sphere(8, 12)
    mesh, index = Mesh(vertices, triangles), p2m.Index(p2m.Scene(vertices, triangles=triangles))
    random = rng.normal(size=(60, 3)) * rng.choice([0.5, 1.0, 4.0], (60, 1))
    points = np.concatenate([random, vertices[::9] * 1.25, vertices[::9] * 0.75, np.zeros((1, 3))])
    certified = index.closest(points, certified=True)
    plain, signed = index.closest(points), index.signed_distance(points)
    for row, point in enumerate(points):
        squared, nearest = mesh.nearest(point)
        # Certified distances are rounded correctly, and others are within the documented bound.
        assert certified.primitive[row] == nearest[0]
        assert error(certified.distance[row], squared) <= 0.5001 * np.spacing(certified.distance[row])
        assert error(plain.distance[row], squared) <= 8 * ROUNDING * (np.abs(point).max() + mesh.size)
        assert (signed[row] < 0) == mesh.is_inside(point)
    targets = np.concatenate([vertices, vertices[triangles].mean(axis=1), vertices[triangles[:, :2]].mean(axis=1)])
    origins = rng.normal(size=targets.shape) * 3
    hits = index.rays(origins, targets - origins, "all")
    for row in range(0, len(targets), 7):
        expected = [
            (float(t), i) for t, ids in mesh.hits(origins[row], targets[row] - origins[row]).items() for i in ids
        ]
        found = slice(hits.splits[row], hits.splits[row + 1])
        assert sorted(expected) == list(zip(hits.t[found].tolist(), hits.primitive[found].tolist()))
