"""Pairs of scenes, shapes near scenes, moving balls and Hausdorff distances."""

from __future__ import annotations

import itertools
import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES, assert_same, mixed_scene, sphere
from exact import Vector, error, squared_distance_of_hulls, vector
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_rotation

import p2m
import p2m.compat.igl as igl

PAIR_BACKENDS = [name for name in p2m.backends() if p2m.Index(p2m.Scene([[0, 0, 0]]), name).info["answers_pairs"]]
BITS = ("distance", "points", "features", "barycentric", "is_intersecting")
"""The fields that are the same bits in every backend."""
SHAPE_FIELDS = ("distance", "primitive", *BITS[1:], "lower_bound")
PAIR_FIELDS = ("distance", "primitives", *BITS[1:], "lower_bound")
CONTACT_FIELDS = ("parameter", "primitive", "point", "feature", "upper_parameter", "distance_bound")


def hulls(scene: p2m.Scene) -> list[list[Vector]]:
    """Return the exact vertices of all primitives."""
    vertices = [vector(vertex) for vertex in scene.vertices]
    rows = [*scene.triangles.tolist(), *scene.segments.tolist(), *([i] for i in scene.points.tolist())]
    return [[vertices[i] for i in row] for row in rows]


def squares(a: p2m.Scene, b: Sequence[Sequence[Vector]]) -> dict[tuple[int, int], Fraction]:
    """Return the exact squared distances of all pairs."""
    pairs = itertools.product(enumerate(hulls(a)), enumerate(b))
    return {(i, j): squared_distance_of_hulls(p, q) for (i, p), (j, q) in pairs}


def motions(rng: np.random.Generator, count: int, reach: float) -> np.ndarray:
    """Return random rotations and translations."""
    matrices = np.tile(np.eye(4), (count, 1, 1))
    for matrix in matrices:
        matrix[:3, :3] = random_rotation(rng)
        matrix[:3, 3] = rng.normal(size=3) * reach
    return matrices


def moved(scene: p2m.Scene, matrix: np.ndarray) -> p2m.Scene:
    return p2m.Scene(scene.vertices @ matrix[:3, :3].T + matrix[:3, 3], scene.triangles, scene.segments, scene.points)


COORDINATE = st.integers(-3, 3)
VERTICES = st.lists(st.tuples(COORDINATE, COORDINATE, COORDINATE), min_size=4, max_size=6)


@st.composite
def small_scenes(draw: st.DrawFn) -> p2m.Scene:
    """Return scenes of few primitives on a lattice, which often touch, coincide or degenerate."""
    vertices = np.array(draw(VERTICES), float)
    index = st.integers(0, len(vertices) - 1)
    rows = [draw(st.lists(st.tuples(*[index] * width), max_size=2)) for width in (3, 2)]
    points = draw(st.lists(index, min_size=1, max_size=2))
    return p2m.Scene(vertices, rows[0] or None, rows[1] or None, points)


@given(small_scenes(), small_scenes(), st.tuples(COORDINATE, COORDINATE, COORDINATE))
@settings(max_examples=60, deadline=None)
def test_pairs_are_those_of_exact_arithmetic(a: p2m.Scene, b: p2m.Scene, step: tuple[int, int, int]) -> None:
    transform = np.eye(4)
    transform[:3, 3] = step
    exact = squares(a, hulls(moved(b, transform)))
    least = min(exact.values())
    nearest = min(ids for ids, square in exact.items() if square == least)
    within = sorted(ids for ids, square in exact.items() if square <= Fraction(23, 10) ** 2)
    for backend in PAIR_BACKENDS:
        first, second = p2m.Index(a, backend), p2m.Index(b, backend)
        pair = first.closest_pair(second, transform)
        assert error(float(pair.distance), least) < 1e-14
        assert bool(pair.is_intersecting) == (least == 0) == bool(first.do_intersect(second, transform))
        assert abs(np.linalg.norm(pair.points[1] - pair.points[0]) - pair.distance) < 1e-14
        assert pair.lower_bound <= pair.distance
        certified = first.closest_pair(second, transform, certified=True)
        assert tuple(certified.primitives.tolist()) == nearest
        assert error(float(certified.distance), least) <= np.spacing(float(certified.distance)) / 2
        found = first.pairs_within(second, 2.3, transform)
        assert sorted(map(tuple, found.primitives.tolist())) == within
        assert (np.diff(found.distance) >= 0).all()
        for ids, distance in zip(found.primitives.tolist(), found.distance):
            assert error(distance, exact[ids[0], ids[1]]) < 1e-14


@given(small_scenes(), st.integers(1, 3), st.data())
@settings(max_examples=60, deadline=None)
def test_shapes_are_those_of_exact_arithmetic(scene: p2m.Scene, width: int, data: st.DataObject) -> None:
    corner = st.tuples(COORDINATE, COORDINATE, COORDINATE)
    shapes = np.array(data.draw(st.lists(st.tuples(*[corner] * width), min_size=1, max_size=3)), float)
    exact = squares(scene, [[vector(vertex) for vertex in shape] for shape in shapes])
    for backend in PAIR_BACKENDS:
        index = p2m.Index(scene, backend)
        near = index.closest_to(shapes, fields=SHAPE_FIELDS)
        certified = index.closest_to(shapes, certified=True)
        for k in range(len(shapes)):
            least = min(exact[i, k] for i in range(len(scene)))
            assert error(near.distance[k], least) < 1e-14
            assert near.is_intersecting[k] == (least == 0)
            assert certified.primitive[k] == min(i for i in range(len(scene)) if exact[i, k] == least)
            assert error(certified.distance[k], least) <= np.spacing(certified.distance[k]) / 2
            assert bool(index.is_any_near(shapes, 1.5)[k]) == (least <= Fraction(9, 4))
        thick = index.closest_to(shapes, radius=0.5, fields=SHAPE_FIELDS)
        np.testing.assert_array_equal(thick.distance, np.maximum(near.distance - 0.5, 0.0))
        np.testing.assert_array_equal(thick.is_intersecting, near.distance <= 0.5)
        np.testing.assert_array_equal(index.is_any_near(shapes, 1.0, radius=0.5), near.distance <= 1.5)


def shapes_of(rng: np.random.Generator, width: int, count: int = 300) -> np.ndarray:
    at = rng.normal(size=(count, 1, 3)) * 2
    shapes = at + rng.normal(size=(count, width, 3)) * 0.2
    return shapes[:, 0] if width == 1 else shapes


@pytest.mark.parametrize("backend", ["aabb", "kdop"])
@pytest.mark.parametrize("width", [1, 2, 3])
def test_shapes_are_those_of_brute_force(backend: str, width: int, scene: p2m.Scene, brute: p2m.Index) -> None:
    index = p2m.Index(scene, backend)
    shapes = shapes_of(np.random.default_rng(3), width)
    for options in [{}, {"radius": 0.2}, {"max_distance": 0.1, "radius": 0.05}, {"certified": True}]:
        expected = brute.closest_to(shapes, fields=SHAPE_FIELDS, **options)
        for threads in (1, 2):
            answer = index.closest_to(shapes, fields=SHAPE_FIELDS, threads=threads, **options)
            assert_same(answer, expected, (*BITS, "primitive"))
            assert (answer.lower_bound <= answer.distance).all()
        found = expected.primitive >= 0
        assert found.any() and found.all() == ("max_distance" not in options)
        assert np.isinf(expected.distance[~found]).all() and np.isnan(expected.points[~found]).all()
        assert (expected.features[~found] == 255).all() and not expected.is_intersecting[~found].any()
    near = index.is_any_near(shapes, 0.1, radius=0.05)
    assert near.tobytes() == brute.is_any_near(shapes, 0.1, radius=0.05).tobytes()
    assert near.any() and not near.all()


def test_points_as_shapes_are_query_points(brute: p2m.Index, queries: np.ndarray) -> None:
    answer = brute.closest_to(queries)
    closest = brute.closest(queries)
    np.testing.assert_array_equal(answer.distance, closest.distance)
    np.testing.assert_array_equal(answer.primitive, closest.primitive)
    assert_same(brute.closest_to(queries[:, None, :]), answer)


@pytest.mark.parametrize("backend", ["aabb", "kdop"])
def test_pairs_are_those_of_brute_force(backend: str) -> None:
    a, b = mixed_scene(1, 60, 40), mixed_scene(2, 60, 40)
    rng = np.random.default_rng(4)
    transforms = np.concatenate([motions(rng, 4, 9.0), motions(rng, 4, 0.5)])
    index, other = p2m.Index(a, backend), p2m.Index(b, backend)
    slow, others = p2m.Index(a, "brute"), p2m.Index(b, "brute")
    for options in [{}, {"max_distance": 5.0}, {"certified": True}]:
        expected = slow.closest_pairs(others, transforms, fields=PAIR_FIELDS, **options)
        answer = index.closest_pairs(other, transforms, fields=PAIR_FIELDS, **options)
        assert_same(answer, expected, (*BITS, "primitives"))
        assert_same(index.closest_pairs(others, transforms, **options), expected, ("distance", "primitives"))
        for k, transform in enumerate(transforms):
            single = index.closest_pair(other, transform, **options)
            assert all(single[name].tobytes() == answer[name][k].tobytes() for name in PAIR_FIELDS)
    assert (expected.is_intersecting[4:]).any() and not expected.is_intersecting[:4].all()
    np.testing.assert_array_equal(index.do_intersect(other, transforms), expected.is_intersecting)
    lots = index.pairs_within(other, 1.0, transforms[4], fields=PAIR_FIELDS)
    assert len(lots.distance) > 10
    assert_same(lots, slow.pairs_within(others, 1.0, transforms[4], fields=PAIR_FIELDS), (*BITS, "primitives"))
    # NumPy moves the scenes to the same places, up to rounding.
    for k, transform in enumerate(transforms):
        pair = index.closest_pair(p2m.Index(moved(b, transform), backend))
        assert abs(pair.distance - expected.distance[k]) < 1e-12


def test_motions_have_any_leading_axes() -> None:
    index = p2m.Index(mixed_scene(1, 60, 40))
    transforms = motions(np.random.default_rng(5), 6, 9.0).reshape(2, 3, 4, 4)
    flat = index.closest_pairs(index, transforms.reshape(6, 4, 4), fields=PAIR_FIELDS)
    answer = index.closest_pairs(index, transforms, fields=PAIR_FIELDS)
    for name in PAIR_FIELDS:
        assert answer[name].shape[:2] == (2, 3)
        np.testing.assert_array_equal(answer[name].reshape(flat[name].shape), flat[name])
    assert index.do_intersect(index, transforms).shape == (2, 3)
    assert index.do_intersect(index).shape == () and bool(index.do_intersect(index))
    assert index.closest_pairs(index, transforms[:, :0]).distance.shape == (2, 0)
    assert index.closest_pairs(index, np.eye(4)).distance.shape == ()
    out = {"distance": np.empty((2, 3)), "points": np.empty((2, 3, 2, 3))}
    assert index.closest_pairs(index, transforms, out=out).points is out["points"]
    np.testing.assert_array_equal(out["distance"], answer.distance)
    # Strides and other types make no difference.
    wide = np.zeros((2, 3, 4, 8))
    wide[..., ::2] = transforms
    assert_same(index.closest_pairs(index, wide[..., ::2], fields=PAIR_FIELDS), answer)
    assert_same(index.closest_pairs(index, np.eye(4, dtype=np.int8)), index.closest_pair(index), ("distance",))


def test_shapes_may_have_any_strides_and_types() -> None:
    index = p2m.Index(mixed_scene())
    shapes = shapes_of(np.random.default_rng(6), 2).astype(np.float32)
    expected = index.closest_to(shapes.astype(np.float64), fields=SHAPE_FIELDS)
    for other in [shapes, shapes.tolist(), np.asfortranarray(shapes), shapes[::-1].copy()[::-1], shapes.astype(">f8")]:
        assert_same(index.closest_to(other, fields=SHAPE_FIELDS), expected)
    assert_same(index.closest_to((shapes * 9).astype(np.int16)), index.closest_to(np.trunc(shapes * 9)))
    distance, near = np.empty(len(shapes)), np.empty(len(shapes), bool)
    assert index.closest_to(shapes, fields="distance", out=distance).distance is distance
    assert index.is_any_near(shapes, 0.1, out=near) is near
    assert index.closest_to(np.empty((0, 3, 3))).distance.shape == (0,)
    assert index.is_any_near(np.empty((0, 2, 3)), 1.0).shape == (0,)


def test_empty_scenes_have_no_pairs() -> None:
    empty, index = p2m.Index(p2m.Scene([])), p2m.Index(mixed_scene())
    for first, second in [(empty, index), (index, empty), (empty, empty)]:
        pair = first.closest_pair(second)
        assert pair.distance == np.inf and pair.primitives.tolist() == [-1, -1] and not pair.is_intersecting
        assert not first.do_intersect(second) and len(first.pairs_within(second, np.inf).distance) == 0
        with pytest.raises(ValueError, match="a scene is empty"):
            p2m.hausdorff(first, second)
        with pytest.raises(ValueError, match="a scene is empty"):
            p2m.hausdorff(first, second, 0.1, one_sided=True)
    assert empty.closest_to([[0, 0, 0]]).primitive.tolist() == [-1]
    assert not empty.is_any_near([[0, 0, 0]], np.inf).any()
    assert np.isinf(empty.first_contact([0, 0, 0], [1, 0, 0], 1.0).parameter)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m * 2, "last row"),
        (lambda m: m[:3], r"the shape is \(3, 4\)"),
        (lambda m: np.diag([2.0, 2.0, 2.0, 1.0]), "scales or shears"),
        (lambda m: np.diag([1.0, 1.0, -1.0, 1.0]), "reflects"),
        (lambda m: np.diag([0.0, 0.0, 0.0, 1.0]), "scales or shears"),
        (lambda m: m + [[0, 1e-4, 0, 0], [0] * 4, [0] * 4, [0] * 4], "scales or shears"),
        (lambda m: m + [[0, 0, 0, np.inf], [0] * 4, [0] * 4, [0] * 4], "not finite"),
        (lambda m: m + [[np.nan, 0, 0, 0], [0] * 4, [0] * 4, [0] * 4], "not finite"),
    ],
)
def test_wrong_transforms_are_errors(change: Any, message: str) -> None:
    index = p2m.Index(mixed_scene(1, 60, 40))
    wrong = change(np.eye(4))
    calls = [index.closest_pair, index.do_intersect, lambda other, matrix: index.pairs_within(other, 1.0, matrix),
             lambda other, matrix: p2m.hausdorff(index, other, transform=matrix)]
    for call in calls:
        with pytest.raises(ValueError, match=f"transform: .*{message}"):
            call(index, wrong)
    if wrong.shape == (4, 4):
        with pytest.raises(ValueError, match=f"transforms: matrix 2 .*{message}"):
            index.closest_pairs(index, [np.eye(4), np.eye(4), wrong, np.eye(4)])
    # Rotations may be as inaccurate as those of the program.
    assert index.closest_pair(index, np.eye(4) + np.diag([4e-7, 0, 0, 0])).is_intersecting


def test_wrong_arguments_of_pairs_are_errors() -> None:
    index = p2m.Index(mixed_scene(1, 60, 40))
    segment = [[[0, 0, 0], [1, 1, 1]]]
    bad = np.zeros((4, 2, 3))
    bad[2, 1, 0] = np.nan
    calls: list[tuple[type[Exception], str, Any]] = [
        (ValueError, r"shapes: the shape is \(3,\)", lambda: index.closest_to([0, 0, 0])),
        (ValueError, r"shapes: the shape is \(1, 4, 3\)", lambda: index.closest_to(np.zeros((1, 4, 3)))),
        (ValueError, "the last axis has x, y and z", lambda: index.is_any_near(np.zeros((1, 2)), 1.0)),
        (ValueError, r"shapes: the shape is \(1, 0, 3\)", lambda: index.is_any_near(np.zeros((1, 0, 3)), 1.0)),
        (TypeError, "real numbers", lambda: index.closest_to(np.zeros((1, 3), complex))),
        (ValueError, "shapes: row 2 has a coordinate", lambda: index.closest_to(bad)),
        (ValueError, "shapes: row 2 has a coordinate", lambda: index.is_any_near(bad, 1.0)),
        (ValueError, "radius: -1.0 is negative", lambda: index.closest_to(segment, radius=-1)),
        (ValueError, "radius: nan is negative", lambda: index.is_any_near(segment, 1.0, radius=np.nan)),
        (ValueError, "max_distance: -1.0", lambda: index.closest_to(segment, max_distance=-1)),
        (ValueError, "max_distance: nan", lambda: index.is_any_near(segment, np.nan)),
        (ValueError, "max_distance: nan", lambda: index.closest_pair(index, max_distance=np.nan)),
        (ValueError, "distance: -1.0", lambda: index.pairs_within(index, -1.0)),
        (ValueError, "radius have no certified", lambda: index.closest_to(segment, radius=1, certified=True)),
        (ValueError, "'primitives' is none of", lambda: index.closest_to(segment, fields="primitives")),
        (ValueError, "'primitive' is none of", lambda: index.closest_pairs(index, np.eye(4), fields="primitive")),
        (TypeError, "float32 instead", lambda: index.closest_to(segment, out={"distance": np.empty(1, "f4")})),
        (TypeError, "other: Scene is no p2m.Index", lambda: index.closest_pair(index.scene)),
        (TypeError, "other: NoneType", lambda: index.do_intersect(None)),
        (TypeError, "matrices have real numbers", lambda: index.closest_pair(index, np.eye(4, dtype=complex))),
        (ValueError, r"transform: the shape is \(1, 4, 4\)", lambda: index.closest_pair(index, [np.eye(4)])),
        (ValueError, r"transform: the shape is \(1, 4, 4\)", lambda: index.pairs_within(index, 1, [np.eye(4)])),
        (ValueError, r"the shape is \(1, 4, 4\)", lambda: p2m.hausdorff(index, index, transform=[np.eye(4)])),
        (ValueError, "starts: row 1 has", lambda: index.first_contact([[0] * 3, [np.inf] * 3], [1, 1, 1], 1.0)),
        (ValueError, "ends: row 0 has", lambda: index.first_contact([0, 0, 0], [1, np.nan, 1], 1.0)),
        (ValueError, "radius: -1.0", lambda: index.first_contact([0, 0, 0], [1, 1, 1], -1.0)),
        (ValueError, "are not finite", lambda: index.first_contact([0, 0, 0], [1, 1, 1], np.inf)),
        (ValueError, "tolerance: nan", lambda: index.first_contact([0, 0, 0], [1, 1, 1], 1.0, tolerance=np.nan)),
        (ValueError, "broadcast", lambda: index.first_contact(np.zeros((2, 3)), np.zeros((3, 3)), 1.0)),
        (ValueError, "tolerance: -1.0", lambda: p2m.hausdorff(index, index, -1.0)),
        (ValueError, "max_queries: -1", lambda: p2m.hausdorff(index, index, max_queries=-1)),
        (TypeError, "int", lambda: p2m.hausdorff(index, 7)),
        (ValueError, "threads: 0", lambda: index.closest_pair(index, threads=0)),
    ]
    for exception, message, call in calls:
        with pytest.raises(exception, match=message):
            call()


@pytest.mark.parametrize("backend", ["octree", "p2m"])
def test_cells_answer_no_queries_for_pairs(backend: str, ball: p2m.Scene) -> None:
    cells, index = p2m.Index(ball, backend), p2m.Index(ball)
    assert index.info["answers_pairs"] and not cells.info["answers_pairs"]
    for call in [
        lambda: cells.closest_to([[0, 0, 0]]),
        lambda: cells.is_any_near([[0, 0, 0]], 1.0),
        lambda: cells.closest_pair(index),
        lambda: index.closest_pair(cells),
        lambda: index.closest_pairs(cells, [np.eye(4)]),
        lambda: index.do_intersect(cells),
        lambda: cells.pairs_within(index, 1.0),
        lambda: cells.first_contact([0, 0, 0], [1, 1, 1], 1.0),
    ]:
        with pytest.raises(ValueError, match=f"the backend '{backend}' answers no queries for pairs: use 'aabb'"):
            call()
    assert p2m.hausdorff(cells, cells, 0.1).lower_bound == 0.0


def test_balls_touch_a_sphere_where_they_should() -> None:
    rng = np.random.default_rng(7)
    starts = rng.normal(size=(400, 3)) * 5
    centre = np.array([0.5, 0.25, -1.0])
    ends = starts + (centre + rng.normal(size=(400, 3)) - starts) * rng.uniform(0.5, 2.0, (400, 1))
    radius = 0.75
    for backend in PAIR_BACKENDS:
        # A ball that moves around a point.
        index = p2m.Index(p2m.Scene([centre], points=[0]), backend)
        contact = index.first_contact(starts, ends, radius, fields=CONTACT_FIELDS)
        u, w = ends - starts, starts - centre
        a, b, c = (u * u).sum(1), (u * w).sum(1), (w * w).sum(1) - radius**2
        root = b * b - a * c
        with np.errstate(invalid="ignore"):
            t = np.where(c <= 0, 0.0, (-b - np.sqrt(root)) / a)
        touches = (c <= 0) | ((root >= 0) & (t >= 0) & (t <= 1))
        np.testing.assert_array_equal(contact.primitive, np.where(touches, 0, -1))
        np.testing.assert_allclose(contact.parameter[touches], t[touches], atol=1e-10)
        assert np.isinf(contact.parameter[~touches]).all() and np.isnan(contact.point[~touches]).all()
        assert (contact.feature == np.where(touches, 0, 255)).all() and 10 < touches.sum() < 390
        np.testing.assert_array_equal(contact.point[touches], np.tile(centre, (touches.sum(), 1)))


@pytest.mark.parametrize("backend", PAIR_BACKENDS)
def test_contacts_are_first(backend: str, scene: p2m.Scene) -> None:
    rng = np.random.default_rng(8)
    starts, ends = rng.normal(size=(60, 3)) * 9, rng.normal(size=(60, 3))
    index = p2m.Index(scene, backend)
    for radius, tolerance in [(0.3, 0.0), (0.3, 0.05), (0.0, 1e-6)]:
        contact = index.first_contact(starts, ends, radius, tolerance=tolerance, fields=CONTACT_FIELDS)
        hit = contact.primitive >= 0
        assert hit.sum() > 10 or radius == 0.0
        t, upper = contact.parameter[hit], contact.upper_parameter[hit]
        assert (t <= upper).all() and (upper <= t + 1e-12).all()
        path = (ends - starts)[hit]
        assert (index.distance(starts[hit] + upper[:, None] * path) <= contact.distance_bound[hit] + 1e-12).all()
        far = t > 0.0
        assert (contact.distance_bound[hit][far] <= radius + tolerance + 1e-11).all()
        for share in np.linspace(0.0, 1.0, 50):
            before = np.where(hit, contact.parameter, 1.0) * share
            distance = index.distance(starts + before[:, None] * (ends - starts))
            assert (distance >= radius - 1e-12)[contact.parameter > 0].all()
    brute = p2m.Index(scene, "brute").first_contact(starts, ends, 0.3)
    np.testing.assert_allclose(index.first_contact(starts, ends, 0.3).parameter, brute.parameter, atol=1e-9)
    two = index.first_contact(starts[:, None], ends[None, :2], 0.3, out={"parameter": np.empty((60, 2))}, threads=2)
    np.testing.assert_array_equal(two.parameter[:, 1], index.first_contact(starts, ends[1], 0.3).parameter)


def test_hausdorff_distances_of_points_are_those_of_numpy() -> None:
    rng = np.random.default_rng(9)
    a, b = rng.normal(size=(200, 3)), rng.normal(size=(300, 3)) + 0.5
    scenes = [p2m.Scene(points, points=np.arange(len(points))) for points in (a, b)]
    distances = np.linalg.norm(a[:, None] - b[None], axis=2)
    sides = distances.min(axis=1).max(), distances.min(axis=0).max()
    for first, second in [scenes, [p2m.Index(scene, "octree") for scene in scenes]]:
        for one_sided in (False, True):
            found = p2m.hausdorff(first, second, 0.0, one_sided=one_sided)
            exact = sides[0] if one_sided else max(sides)
            assert abs(found.lower_bound - exact) < 1e-14 and found.lower_bound <= found.upper_bound < exact + 1e-14
            assert found.from_scene == (0 if one_sided else int(sides[1] > sides[0]))
            assert abs(np.linalg.norm(found.points[1] - found.points[0]) - exact) < 1e-14
            i, j = found.primitives
            assert (found.points == [a[i], b[j]]).all()
    # The scene moves together with the other one.
    matrix = motions(rng, 1, 3.0)[0]
    found = p2m.hausdorff(moved(scenes[0], matrix), p2m.Index(scenes[1], "kdop"), 0.0, transform=matrix)
    assert abs(found.lower_bound - max(sides)) < 1e-13


def test_hausdorff_distances_are_between_their_bounds() -> None:
    vertices, triangles = sphere(12, 24)
    ball = p2m.Scene(vertices, triangles)
    for tolerance in (0.1, 1e-3, 1e-5):
        # A convex surface and its translated copy.
        found = p2m.hausdorff(ball, (vertices + [0.3, 0.0, 0.4], triangles), tolerance)
        assert found.lower_bound <= 0.5 + 1e-14 and 0.5 - 1e-14 <= found.upper_bound
        assert found.upper_bound - found.lower_bound <= tolerance
    # The middle of a side of the cube is farther from two opposite corners than vertices of the cube are from both.
    cube = p2m.Scene(CUBE_VERTICES, CUBE_TRIANGLES)
    corners = p2m.Scene(CUBE_VERTICES, points=range(8))
    found = p2m.hausdorff(cube, corners, 1e-6)
    assert abs(found.lower_bound - np.sqrt(0.5)) < 1e-6 and found.from_scene == 0
    few = p2m.hausdorff(cube, corners, 0.0, max_queries=3)
    assert few.lower_bound <= np.sqrt(0.5) < few.upper_bound and few.queries < 40
    assert found.reached and not few.reached
    calls: list[tuple[int, int]] = []
    p2m.hausdorff(cube, corners, 1e-6, progress=lambda done, total: calls.append((done, total)))
    assert calls and calls[-1][0] == calls[-1][1]


def test_hausdorff_of_libigl_is_a_lower_bound() -> None:
    # The mid point of the first triangle's longest edge is farther from the wedge than all vertices.
    roof = np.array([[0, 0, 0], [4, 0, 0], [2, 0, 2], [2, 3, 0]], float)
    flat, bent = np.array([[0, 1, 3]]), np.array([[0, 2, 3], [2, 1, 3]])
    distance = igl.hausdorff(roof, flat, roof, bent)
    found = p2m.hausdorff((roof, flat), (roof, bent), 1e-9)
    assert isinstance(distance, float)
    assert found.lower_bound - 1e-3 < distance <= found.upper_bound
    assert igl.hausdorff(roof, flat, roof, bent, tolerance=np.inf) <= distance
    assert igl.hausdorff(roof, bent, roof, bent) == 0.0
    # The corners of a triangle, as degenerate ones, are far from the points inside, though no vertex is.
    corners = np.array([[0, 0, 0], [1, 1, 1], [3, 3, 3]])
    assert abs(igl.hausdorff(roof, flat, roof, corners, tolerance=1e-6) - 13 / 6) < 1e-6
    assert 13 / 6 - 1e-3 < igl.hausdorff(roof, flat, roof, corners) <= 13 / 6 + 1e-14
    assert igl.hausdorff(roof, flat, roof, corners, tolerance=np.inf) == 0.0
    with pytest.raises(ValueError, match="a scene is empty"):
        igl.hausdorff(roof, flat, roof, np.empty((0, 3), int))


def test_signed_distances_may_be_limited(ball: p2m.Scene, queries: np.ndarray) -> None:
    for backend in ["aabb", "octree"]:
        index = p2m.Index(ball, backend)
        for options in [{"sign": "parity"}, {"sign": "winding", "inside": "positive"}]:
            whole = index.signed_distance(queries, **options)
            limited = index.signed_distance(queries, max_distance=0.4, **options)
            near = np.abs(whole) <= 0.4
            np.testing.assert_array_equal(limited[near], whole[near])
            assert np.isnan(limited[~near]).all() and near.any() and not near.all()
    with pytest.raises(ValueError, match="max_distance: -1"):
        index.signed_distance(queries, max_distance=-1)


def test_progress_of_pairs_is_reported() -> None:
    index = p2m.Index(mixed_scene())
    for count, call in [
        (50, lambda progress: index.closest_to(np.zeros((50, 2, 3)), progress=progress)),
        (50, lambda progress: index.is_any_near(np.zeros((50, 2, 3)), 1.0, progress=progress)),
        (50, lambda progress: index.first_contact(np.zeros((50, 3)), [1, 1, 1], 0.1, progress=progress)),
        (9, lambda progress: index.closest_pairs(index, np.tile(np.eye(4), (9, 1, 1)), progress=progress)),
        (9, lambda progress: index.do_intersect(index, np.tile(np.eye(4), (9, 1, 1)), progress=progress)),
    ]:
        calls: list[tuple[int, int]] = []
        call(lambda done, total, calls=calls: calls.append((done, total)))
        assert calls[-1] == (count, count)


@pytest.fixture(scope="module")
def program() -> str:
    """Return the program `p2m` of the environment variable P2M_PROGRAM, or of the path."""
    program = os.environ.get("P2M_PROGRAM") or shutil.which("p2m")
    if program is None or not os.access(program, os.X_OK):
        pytest.skip("there is no program p2m: name it by the variable P2M_PROGRAM")
    return program


def run(program: str, *arguments: object) -> dict[str, Any]:
    ended = subprocess.run([program, *map(str, arguments), "--json"], check=True, capture_output=True, text=True)
    report: dict[str, Any] = json.loads(ended.stdout)
    return report


FEATURES = ["vertex0", "vertex1", "vertex2", "edge0", "edge1", "edge2", "face"]


def test_pairs_are_those_of_the_program(program: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(10)
    scenes = [mixed_scene(1, 60, 40), mixed_scene(2, 60, 40)]
    paths = [tmp_path / "a.obj", tmp_path / "b.obj"]
    for scene, path in zip(scenes, paths):
        write_obj(scene, path)
        np.testing.assert_array_equal(p2m.read(path).vertices, scene.vertices)
    index, other = (p2m.Index(p2m.read(path)) for path in paths)
    for matrix in [None, *motions(rng, 3, 9.0), *motions(rng, 3, 4.0)]:
        options = [] if matrix is None else ["--transform", " ".join(map(repr, matrix.reshape(-1).tolist()))]
        report = run(program, "distance", *paths, *options)
        pair = index.closest_pair(other, matrix)
        assert float(pair.distance) == report["distance"] and float(pair.lower_bound) == report["lower_bound"]
        assert bool(pair.is_intersecting) == report["intersect"] == bool(index.do_intersect(other, matrix))
        for k, side in enumerate(report["scenes"]):
            nearest = side["nearest"]
            assert pair.points[k].tolist() == nearest["point"] and pair.primitives[k] == nearest["primitive"]
            assert FEATURES[pair.features[k]] == nearest["feature"]
        for one_sided in (False, True):
            side_options = ["--one-sided"] if one_sided else []
            report = run(program, "hausdorff", *paths, *options, *side_options)
            found = p2m.hausdorff(index, other, one_sided=one_sided, transform=matrix)
            assert [found.lower_bound, found.upper_bound] == [report["lower_bound"], report["upper_bound"]]
            assert (found.from_scene, found.queries) == (report["from"], report["queries"])
            for k, side in enumerate(report["scenes"]):
                assert found.points[k].tolist() == side["farthest"]["point"]
                assert found.primitives[k] == side["farthest"]["primitive"]


def write_obj(scene: p2m.Scene, path: Path) -> None:
    """Write a scene with all digits of its coordinates."""
    lines = ["v " + " ".join(map(repr, vertex)) for vertex in scene.vertices.tolist()]
    rows = [*scene.triangles.tolist(), *scene.segments.tolist(), *([i] for i in scene.points.tolist())]
    lines += [f"{'pLf'[len(row) - 1].lower()} " + " ".join(str(i + 1) for i in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")


def test_solids_have_no_distance_inside() -> None:
    vertices, triangles = sphere(8, 12)
    tank = p2m.Index(p2m.Scene(vertices, triangles))
    inner, outer = (p2m.Index(p2m.Scene(vertices * 0.3 + x, triangles)) for x in ([0.1, 0, 0], [3.0, 0, 0]))
    for first, second in ((tank, inner), (inner, tank)):
        assert first.closest_pair(second).distance > 0.4
        found = first.closest_pair(second, solid=True)
        assert (float(found.distance), bool(found.is_intersecting)) == (0.0, True)
        assert np.array_equal(found.points[0], found.points[1])
    assert tank.closest_pair(outer, solid=True).distance == tank.closest_pair(outer).distance > 1.0
    motions = np.tile(np.eye(4), (2, 1, 1))
    motions[1, 0, 3] = -3.0
    distances = tank.closest_pairs(outer, motions, solid=True).distance.tolist()
    assert distances == [float(tank.closest_pair(outer).distance), 0.0]
    points = np.array([[0.0, 0.0, 0.2], [0.0, 0.0, 3.0]])
    distances = tank.closest_to(points, solid=True).distance.tolist()
    assert distances == [0.0, float(tank.closest_to(points[1:]).distance[0])]
    cable = p2m.Index(p2m.Scene([[0, 0, 0], [0.1, 0, 0]], segments=[[0, 1]]))
    assert cable.closest_pair(tank, solid=True).distance == 0.0
    hole = p2m.Index(p2m.Scene(tank.scene.vertices, tank.scene.triangles[1:]))
    with pytest.warns(UserWarning, match="open"):
        assert hole.closest_to(points[:1], solid=True).distance.tolist() == [0.0]
    with pytest.raises(ValueError, match="certified"):
        tank.closest_pair(inner, solid=True, certified=True)
