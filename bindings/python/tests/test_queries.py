"""Every query against brute force, and brute force against NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import ALL_FIELDS, BACKENDS, EXACT_FIELDS, assert_same, mixed_scene
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import p2m


@pytest.fixture(scope="module", params=[name for name in BACKENDS if name != "brute"])
def index(request: pytest.FixtureRequest, scene: p2m.Scene) -> p2m.Index:
    return p2m.Index(scene, request.param)


def test_points_agree_with_numpy(queries: np.ndarray) -> None:
    vertices = np.random.default_rng(3).normal(size=(50, 3))
    index = p2m.Index(p2m.Scene(vertices, points=np.arange(50)), "brute")
    answer = index.closest(queries, fields=("distance", "primitive", "point"))
    exact = np.linalg.norm(queries[:, None] - vertices[None], axis=2)
    np.testing.assert_array_equal(answer.primitive, exact.argmin(axis=1))
    np.testing.assert_allclose(answer.distance, exact.min(axis=1), rtol=1e-14)
    np.testing.assert_array_equal(answer.point, vertices[answer.primitive])


def test_closest_is_that_of_brute_force(index: p2m.Index, brute: p2m.Index, queries: np.ndarray) -> None:
    for options in [{}, {"max_distance": 0.3}]:
        expected = brute.closest(queries, fields=ALL_FIELDS, **options)
        answer = index.closest(queries, fields=ALL_FIELDS, **options)
        assert_same(answer, expected, EXACT_FIELDS)
        found = expected.primitive >= 0
        assert (answer.lower_bound[found] <= answer.distance[found]).all()
        assert (found.all() or "max_distance" in options) and found.any()


def test_fields_alone_are_those_of_all_together(index: p2m.Index, queries: np.ndarray) -> None:
    whole = index.closest(queries, fields=ALL_FIELDS, max_distance=0.4)
    for name in EXACT_FIELDS:
        alone = index.closest(queries, fields=name, max_distance=0.4)
        assert alone.fields == (name,)
        assert_same(alone, whole, (name,))
    np.testing.assert_array_equal(index.distance(queries), index.closest(queries).distance)


def test_missing_answers_are_marked(index: p2m.Index) -> None:
    answer = index.closest([[1e3, 0, 0]], max_distance=1.0, fields=(*ALL_FIELDS, "object"))
    assert answer.primitive[0] == -1 and answer.object[0] == -1
    assert answer.distance[0] == np.inf and 0.999999 < answer.lower_bound[0] < 1.0
    assert np.isnan(answer.point).all() and np.isnan(answer.barycentric).all() and answer.feature[0] == 255


def test_features_and_weights_describe_the_point(brute: p2m.Index, queries: np.ndarray) -> None:
    answer = brute.closest(queries, fields=ALL_FIELDS)
    scene = brute.scene
    counts = scene.counts
    vertices = scene.vertices
    for i in range(0, len(queries), 7):
        id, weights, feature = int(answer.primitive[i]), answer.barycentric[i], int(answer.feature[i])
        if id < counts.triangles:
            corners = scene.triangles[id]
        elif id < counts.triangles + counts.segments:
            corners = scene.segments[id - counts.triangles]
        else:
            corners = scene.points[[id - counts.triangles - counts.segments]]
        point = weights[: len(corners)] @ vertices[corners]
        np.testing.assert_allclose(point, answer.point[i], atol=1e-12)
        positive = {k for k in range(len(corners)) if weights[k] > 0}
        expected = {0: {0}, 1: {1}, 2: {2}, 3: {0, 1}, 4: {1, 2}, 5: {0, 2}, 6: {0, 1, 2}}[feature]
        assert positive <= expected


def test_certified_answers_bound_the_others(index: p2m.Index, brute: p2m.Index, queries: np.ndarray) -> None:
    certified = index.closest(queries, certified=True, fields=ALL_FIELDS)
    assert_same(certified, brute.closest(queries, certified=True, fields=ALL_FIELDS))
    np.testing.assert_allclose(index.distance(queries), certified.distance, rtol=1e-14, atol=1e-14)


def test_approximate_answers_keep_their_bounds(index: p2m.Index, queries: np.ndarray) -> None:
    exact = index.distance(queries)
    rough = index.closest(queries, epsilon=0.5, fields=("distance", "lower_bound"))
    assert (rough.distance <= 1.5 * exact * (1 + 1e-14)).all()
    few = index.closest(queries, max_visits=1, fields=("distance", "lower_bound"))
    assert (few.distance >= exact).all() and (few.lower_bound <= exact).all()


def test_the_k_nearest_are_those_of_brute_force(index: p2m.Index, brute: p2m.Index, queries: np.ndarray) -> None:
    for k, options in [(1, {}), (5, {}), (7, {"max_distance": 0.5})]:
        answer = index.k_nearest(queries, k, fields=ALL_FIELDS, **options)
        assert answer.distance.shape == (len(queries), k) and answer.point.shape == (len(queries), k, 3)
        assert_same(answer, brute.k_nearest(queries, k, fields=ALL_FIELDS, **options), EXACT_FIELDS)
        if not options:
            nearest = index.closest(queries)
            np.testing.assert_array_equal(answer.primitive[:, 0], nearest.primitive)
    everything = index.k_nearest(queries[:3], len(index) + 2)
    assert (everything.primitive[:, -2:] == -1).all() and np.isinf(everything.distance[:, -2:]).all()
    assert (np.sort(everything.primitive[:, :-2], axis=1) == np.arange(len(index))).all()


def test_all_within_are_those_of_brute_force(index: p2m.Index, brute: p2m.Index, queries: np.ndarray) -> None:
    answer = index.within(queries, 0.5, fields=ALL_FIELDS)
    assert_same(answer, brute.within(queries, 0.5, fields=ALL_FIELDS), ("splits", *EXACT_FIELDS))
    assert len(answer.splits) == len(queries) + 1 and answer.splits[-1] == len(answer.primitive)
    counts = np.diff(answer.splits)
    np.testing.assert_array_equal(index.is_any_within(queries, 0.5), counts > 0)
    assert (counts == 0).any() and (counts > 1).any()
    some = index.k_nearest(queries, 1, max_distance=0.5).primitive[:, 0]
    np.testing.assert_array_equal(answer.primitive[answer.splits[:-1][counts > 0]], some[counts > 0])


def test_answers_do_not_depend_on_threads(queries: np.ndarray, ball: p2m.Scene) -> None:
    many = np.random.default_rng(5).normal(size=(40_000, 3))
    index = p2m.Index(ball, "octree")
    one, three = ({"threads": threads} for threads in (1, 3))
    assert_same(index.closest(many, fields=ALL_FIELDS, **one), index.closest(many, fields=ALL_FIELDS, **three))
    assert_same(index.k_nearest(many, 3, **one), index.k_nearest(many, 3, **three))
    assert_same(index.within(many, 0.1, **one), index.within(many, 0.1, **three))
    first, second = index.signed_distance(many, **one), index.signed_distance(many, **three)
    assert first.tobytes() == second.tobytes()
    certified = [index.closest(many[:20_000], certified=True, **threads) for threads in (one, three)]
    assert_same(*certified)


@settings(max_examples=60, deadline=None)
@given(
    vertices=arrays.arrays(
        np.float64, st.tuples(st.integers(3, 12), st.just(3)), elements=st.integers(-3, 3).map(float)
    ),
    data=st.data(),
)
def test_small_scenes_with_ties_agree(vertices: np.ndarray, data: st.DataObject) -> None:
    ids = st.integers(0, len(vertices) - 1)
    triangles = data.draw(st.lists(st.tuples(ids, ids, ids), max_size=6))
    segments = data.draw(st.lists(st.tuples(ids, ids), max_size=4))
    points = data.draw(st.lists(ids, max_size=4))
    scene = p2m.Scene(vertices, triangles, segments, points)
    queries = data.draw(arrays.arrays(np.float64, (8, 3), elements=st.integers(-8, 8).map(lambda i: i / 2)))
    expected = p2m.Index(scene, "brute").closest(queries, fields=EXACT_FIELDS)
    for backend in BACKENDS:
        assert_same(p2m.Index(scene, backend).closest(queries, fields=EXACT_FIELDS), expected)


@settings(max_examples=60, deadline=None)
@given(
    points=arrays.arrays(
        np.float64, (5, 3), elements=st.floats(allow_nan=False, allow_infinity=False, width=64)
    )
)
def test_every_finite_query_has_the_answer_of_brute_force(points: np.ndarray) -> None:
    scene = mixed_scene(9, 40, 30)
    expected = p2m.Index(scene, "brute").closest(points)
    for backend in BACKENDS:
        assert_same(p2m.Index(scene, backend).closest(points), expected)


@pytest.mark.parametrize("backend", BACKENDS)
def test_an_empty_scene_has_no_answers(backend: str) -> None:
    index = p2m.Index(p2m.Scene(np.empty((0, 3))), backend)
    assert len(index) == 0
    answer = index.closest(np.zeros((4, 3)), fields=ALL_FIELDS)
    assert (answer.primitive == -1).all() and np.isinf(answer.distance).all()
    assert (index.k_nearest(np.zeros((4, 3)), 2).primitive == -1).all()
    assert index.within(np.zeros((4, 3)), 9.0).splits.tolist() == [0] * 5
    assert not index.is_any_within(np.zeros((4, 3)), 9.0).any()
    assert np.isinf(index.signed_distance(np.zeros((4, 3)))).all()
    assert np.isnan(index.scene.bounds).all()


def test_no_queries_are_a_batch(index: p2m.Index) -> None:
    none = np.empty((0, 3))
    assert index.closest(none).distance.shape == (0,)
    assert index.k_nearest(none, 3).distance.shape == (0, 3)
    assert index.within(none, 1.0).splits.tolist() == [0]
    assert index.is_any_within(np.empty((2, 0, 3)), 1.0).shape == (2, 0)
