"""Lazy Dask arrays have the same bits as the eager answers, for any chunks and processes."""

from __future__ import annotations

import collections
import contextlib
import os
import pickle
import signal
import subprocess
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import assert_same, mixed_scene, models, sphere
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import p2m

dask = pytest.importorskip("dask")
da = pytest.importorskip("dask.array")
import p2m.dask

FIELDS = ("distance", "primitive", "point", "feature", "barycentric", "lower_bound", "object")
HIT_FIELDS = ("t", "primitive", "point", "barycentric", "side")
POINTS = np.random.default_rng(5).normal(size=(1000, 3))


@pytest.fixture(autouse=True)
def one_process() -> Iterator[None]:
    with dask.config.set(scheduler="threads"):
        yield


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("dask") / "mixed.p2m"
    p2m.Index(mixed_scene()).save(file)
    return file


@pytest.fixture(scope="module")
def index(path: Path) -> p2m.Index:
    return p2m.load(path)


@pytest.fixture(scope="module")
def ball_index() -> p2m.Index:
    return p2m.Index(p2m.Scene(*sphere(8, 12)))


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Record the number of points of each search."""
    seen: list[int] = []
    closest = p2m.Index.closest

    def counted(self: p2m.Index, points: Any, **options: Any) -> Any:
        seen.append(len(points))
        return closest(self, points, **options)

    monkeypatch.setattr(p2m.Index, "closest", counted)
    return seen


@st.composite
def chunked(draw: st.DrawFn) -> tuple[p2m.Index, Any, np.ndarray]:
    """Return an index, an array of points in any chunks, and the same points as a NumPy array."""
    seed = draw(st.integers(0, 1000))
    scene = mixed_scene(seed, 40, draw(st.integers(8, 60)))
    shape = draw(st.one_of(
        st.tuples(st.integers(0, 40)), st.tuples(st.integers(1, 9), st.integers(1, 9)), st.just(()),
        st.tuples(st.integers(1, 4), st.integers(1, 5), st.integers(1, 4)),
    ))
    dtype = draw(st.sampled_from([np.float64, np.float32, np.int64]))
    points = (np.random.default_rng(seed).normal(size=(*shape, 3)) * 2).astype(dtype)
    chunks = []
    for size in (*shape, 3):
        cuts = sorted(draw(st.sets(st.integers(1, size - 1), max_size=4))) if size > 1 else []
        chunks.append(tuple(int(n) for n in np.diff([0, *cuts, size])))
    return p2m.Index(scene), da.from_array(points, chunks=tuple(chunks)), points


LIMITS = ({}, {"max_distance": 0.5}, {"certified": True}, {"epsilon": 0.1}, {"max_visits": 3})


@given(chunked(), st.sampled_from(LIMITS))
@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
def test_all_fields_are_the_same_bits_for_all_chunks(case: tuple[p2m.Index, Any, np.ndarray], options: Any) -> None:
    index, array, points = case
    answer = p2m.dask.closest(array, index, fields=FIELDS, **options)
    expected = index.closest(points, fields=FIELDS, threads=1, **options)
    found = answer.compute()
    assert isinstance(found, p2m.ClosestPoints) and found.fields == FIELDS
    assert_same(found, expected)
    for name in FIELDS:
        assert answer[name].dtype == expected[name].dtype and answer[name].shape == expected[name].shape
    assert answer.distance.chunks == array.chunks[:-1]


@given(chunked(), chunked(), st.sampled_from(["first", "any", "count", "crossings"]))
@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
def test_rays_are_the_same_bits_for_all_chunks(
    case: tuple[p2m.Index, Any, np.ndarray], other: tuple[p2m.Index, Any, np.ndarray], mode: Any
) -> None:
    index, origins, starts = case
    _, directions, steps = other
    steps = np.where(np.abs(steps).sum(axis=-1, keepdims=True) == 0, 1, steps)
    directions = da.from_array(steps, chunks=directions.chunks)
    for lazy, eager in [(directions, steps), ([0.0, 1.0, -2.0], [0.0, 1.0, -2.0])]:
        try:
            shape = np.broadcast_shapes(starts.shape, np.shape(eager))
        except ValueError:
            with pytest.raises(ValueError, match="broadcast"):
                p2m.dask.rays(origins, lazy, index, mode)
            continue
        fields = HIT_FIELDS if mode == "first" else None
        answer = p2m.dask.rays(origins, lazy, index, mode, t_min=-0.5, t_max=9.0, radius=0.1, fields=fields)
        expected = index.rays(starts, eager, mode, t_min=-0.5, t_max=9.0, radius=0.1, fields=fields)
        if mode == "first":
            assert answer.t.shape == shape[:-1]
            assert_same(answer.compute(), expected)
        else:
            assert answer.dtype == expected.dtype
            np.testing.assert_array_equal(answer.compute(), expected)


@pytest.mark.parametrize("options", [{}, {"sign": "winding", "inside": "positive"}, {"max_distance": 0.5}])
def test_signed_distances_are_the_same_bits(ball_index: p2m.Index, options: Any) -> None:
    found = p2m.dask.signed_distance(da.from_array(POINTS, chunks=(170, 2)), ball_index, **options).compute()
    assert found.tobytes() == ball_index.signed_distance(POINTS, **options).tobytes()


@given(
    st.tuples(*[st.integers(1, 14)] * 3), st.tuples(*[st.integers(1, 14)] * 3), st.floats(-2, 0), st.floats(0.05, 0.4),
    st.sampled_from([{}, {"signed": True}, {"signed": True, "sign": "winding"}, {"signed": True, "band": 0.25}]),
)
@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
def test_fields_are_the_same_bits_for_all_chunks(
    ball_index: p2m.Index, shape: Any, chunks: Any, origin: float, spacing: float, options: Any
) -> None:
    corner = (origin, -1.1, origin / 3)
    array = p2m.dask.field(ball_index, corner, spacing, shape, chunks=chunks, **options)
    whole = ball_index.field(corner, spacing, shape, **options)
    assert array.dtype == whole.dtype and array.shape == whole.shape
    assert array.compute().tobytes() == whole.tobytes()


def test_all_fields_are_searched_once(path: Path, index: p2m.Index, calls: list[int], tmp_path: Path) -> None:
    answer = p2m.dask.closest(da.from_array(POINTS, chunks=(300, 3)), path, fields=("distance", "primitive", "point"))
    blocks = [100, 300, 300, 300]
    dask.compute(answer.distance, answer.primitive)
    assert sorted(calls) == blocks
    calls.clear()
    answer.compute(scheduler="sync")
    assert sorted(calls) == blocks
    calls.clear()
    (answer.distance.sum() + answer.point.sum()).compute()
    assert sorted(calls) == blocks
    calls.clear()
    targets = [np.empty(1000), np.empty(1000, np.int64)]
    da.store([answer.distance, answer.primitive], targets)
    assert sorted(calls) == blocks
    assert_same(dict(zip(["distance", "primitive"], targets)), index.closest(POINTS), ("distance", "primitive"))
    calls.clear()
    kept = answer.persist()
    assert isinstance(kept, p2m.dask.LazyClosestPoints)
    kept.distance.compute(), kept.primitive.compute()
    assert sorted(calls) == blocks


def test_indexes_with_and_without_a_file_answer(path: Path, index: p2m.Index, ball_index: p2m.Index) -> None:
    points = da.from_array(POINTS, chunks=(300, 3))
    names = set()
    for source in [path, str(path), index]:
        lazy = p2m.dask.distance(points, source)
        names.add(lazy.name)
        assert len(pickle.dumps(lazy.dask)) < 40_000
        np.testing.assert_array_equal(lazy.compute(), index.distance(POINTS))
    mapped = p2m.dask.distance(points, path, map=True)
    np.testing.assert_array_equal(mapped.compute(), index.distance(POINTS))
    # The same query has the same name, by which schedulers recognise results that they have already computed.
    assert len(names) == 1 and mapped.name not in names
    lazy = p2m.dask.distance(points, ball_index)
    assert lazy.name == p2m.dask.distance(points, ball_index).name != p2m.dask.distance(points, mixed_ball()).name
    np.testing.assert_array_equal(lazy.compute(), ball_index.distance(POINTS))
    with pytest.raises(ValueError, match="not loaded from a file"):
        p2m.dask.distance(points, ball_index, map=True)


@given(chunked(), st.integers(3000, 30_000), st.sampled_from([None, 0, 40_000]))
@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
def test_folders_of_shards_have_the_same_bits(
    tmp_path_factory: pytest.TempPathFactory, case: tuple[p2m.Index, Any, np.ndarray], size: int, limit: int | None
) -> None:
    index, array, points = case
    folder = tmp_path_factory.mktemp("shards") / "site"
    p2m.write_shards(index.scene, folder, size)
    fields = tuple(name for name in FIELDS if name != "lower_bound")
    expected = index.closest(points, fields=fields)
    for source in [folder, folder / "manifest.json", p2m.Shards(folder, limit)]:
        assert_same(p2m.dask.closest(array, source, fields=fields).compute(), expected)
    lazy = p2m.dask.rays(array, [1.0, 2.0, -1.0], p2m.Shards(folder, limit, map=True), "crossings")
    assert np.array_equal(lazy.compute(), index.rays(points, [1.0, 2.0, -1.0], "crossings"))
    rows = points.reshape(-1, 3)
    answers = p2m.Ask(p2m.Shards(folder, limit), fields=fields)(rows)
    assert_same(answers, index.closest(rows, fields=fields), fields)
    p2m.clear_opened()


NO_SHRINKING = [phase for phase in Phase if phase != Phase.shrink]
"""The phases for examples that take a second, which are not shrunk."""

EXACT = tuple(name for name in FIELDS if name != "lower_bound")


@st.composite
def scattered(draw: st.DrawFn) -> tuple[p2m.Index, int, Any, np.ndarray]:
    """Return an index, a size of shards, points in any chunks of which many are as near to several shards, and the
    same."""
    index, array, points = draw(chunked())
    # At vertices many primitives are equally near, and halves of whole numbers are half way between boxes.
    rows = np.concatenate([points.reshape(-1, 3), index.scene.vertices, np.rint(2 * index.scene.vertices) / 2])
    rows = rows[np.random.default_rng(len(rows)).permutation(len(rows))].astype(points.dtype)
    cuts = sorted(draw(st.sets(st.integers(1, len(rows) - 1), max_size=4)))
    lengths = tuple(int(n) for n in np.diff([0, *cuts, len(rows)]))
    lazy, eager = draw(st.sampled_from([(array, points), (da.from_array(rows, chunks=(lengths, 2)), rows)]))
    return index, draw(st.integers(3000, 30_000)), lazy, eager


@given(scattered(), st.sampled_from([None, 0, 40_000]), st.sampled_from([None, 0.0, 0.3]))
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
def test_points_that_go_to_shards_have_the_same_bits(
    tmp_path_factory: pytest.TempPathFactory, case: Any, limit: int | None, max_distance: float | None
) -> None:
    index, size, array, points = case
    folder = tmp_path_factory.mktemp("shuffle") / "site"
    p2m.write_shards(index.scene, folder, size)
    lazy = p2m.dask.closest(
        array, p2m.Shards(folder, limit), fields=FIELDS, max_distance=max_distance, shuffle=True, threads=2
    )
    found = lazy.compute(scheduler="sync")
    assert found.fields == FIELDS and lazy.distance.chunks == array.chunks[:-1]
    assert_same(found, index.closest(points, fields=EXACT, max_distance=max_distance), EXACT)
    is_found = found.primitive >= 0
    assert np.all(found.lower_bound[is_found] <= found.distance[is_found])
    assert np.all(np.isinf(found.lower_bound[~is_found]))
    p2m.clear_opened()


@pytest.mark.parametrize("scale", [1.0, 2.0**-400, 2.0**400, 2.0**-560])
@pytest.mark.parametrize("step", [1, -1])
def test_keys_decide_between_shards_at_equal_distances(tmp_path: Path, scale: float, step: int) -> None:
    """The squares are 1 and 1 + 2**-52, whose roots are the same number."""
    vertices = scale * np.array([[1.0, 2.0**-26, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0**-26]])[::step]
    index = p2m.Index(p2m.Scene(vertices, points=np.arange(3)))
    shards = p2m.write_shards(index.scene, tmp_path / "points", 1)
    found = p2m.dask.closest(np.zeros((1, 3)), shards, shuffle=True).compute()
    assert len(shards.shards) == 3 and found.primitive[0] == 1
    assert_same(found, index.closest(np.zeros((1, 3))))


def test_points_that_go_to_shards_without_answers(tmp_path: Path) -> None:
    p2m.write_shards([], tmp_path / "empty")
    nothing = p2m.Index(p2m.Scene([])).closest(POINTS, fields=FIELDS)
    assert_same(p2m.dask.closest(POINTS, tmp_path / "empty", fields=FIELDS, shuffle=True).compute(), nothing)
    shards = p2m.write_shards(mixed_scene(), tmp_path / "site", 8000)
    far = POINTS + 1000.0
    found = p2m.dask.closest(far, shards, fields=FIELDS, max_distance=1.0, shuffle=True).compute()
    assert_same(found, nothing)
    bad = POINTS.copy()
    bad[777, 1] = np.nan
    with pytest.raises(ValueError, match="points: row 777 has a coordinate that is not finite"):
        p2m.dask.distance(da.from_array(bad, chunks=(300, 3)), shards, shuffle=True).compute()
    some = da.from_array(POINTS, chunks=(300, 3))
    some = some[some[:, 0] > 0.5]
    expected = p2m.Index(mixed_scene()).distance(POINTS[POINTS[:, 0] > 0.5])
    np.testing.assert_array_equal(p2m.dask.distance(some, shards, shuffle=True).compute(), expected)


@pytest.fixture(scope="module")
def workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the client of two Dask workers in this process, whose tasks see the replacements of tests."""
    distributed = pytest.importorskip("distributed")
    folder = str(tmp_path_factory.mktemp("workers"))
    with distributed.Client(
        processes=False, n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=folder
    ) as client:
        yield client


class Failures:
    """Let the first attempts of tasks raise, before or after they have asked the shards."""

    def __init__(self, seed: int, largest: int) -> None:
        self.seed, self.largest = seed, largest
        self.attempts: collections.Counter[Any] = collections.Counter()

    def may_fail(self, place: str) -> None:
        key = str(distributed_key())
        random = zlib.crc32(f"{self.seed} {key.split('-')[1]} {key.split(',')[1:]}".encode())
        is_here = ("before", "after")[random // 7 % 2] == place
        if is_here and self.attempts[key] < random % (self.largest + 1):
            self.attempts[key] += 1
            raise RuntimeError(f"attempt {self.attempts[key]} of {key}")

    def install(self, patch: pytest.MonkeyPatch) -> None:
        opened = p2m._shuffle.Query.open

        def open_or_fail(query: Any) -> Any:
            self.may_fail("before")
            return opened(query)

        def or_fail(ask: Any) -> Any:
            def asked(*arguments: Any, **options: Any) -> Any:
                answer = ask(*arguments, **options)
                self.may_fail("after")
                return answer

            return asked

        patch.setattr(p2m._shuffle.Query, "open", open_or_fail)
        for name in ["nearest_shards", "shards_within", "closest_in_shard"]:
            patch.setattr(p2m.Shards, name, or_fail(getattr(p2m.Shards, name)))


def distributed_key() -> Any:
    """Return the key of the task that this thread runs."""
    return pytest.importorskip("distributed").get_worker().get_current_task()


@given(scattered(), st.integers(0, 2**30))
@settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck), phases=NO_SHRINKING)
def test_tasks_that_fail_are_repeated_and_answers_are_the_same_bits(
    tmp_path_factory: pytest.TempPathFactory, workers: Any, case: Any, seed: int
) -> None:
    index, size, array, points = case
    shards = p2m.write_shards(index.scene, tmp_path_factory.mktemp("failures") / "site", size)
    lazy = p2m.dask.closest(array, shards, fields=EXACT, shuffle=True)
    expected = index.closest(points, fields=EXACT)
    with pytest.MonkeyPatch.context() as patch:
        failures = Failures(seed, 3)
        failures.install(patch)
        found = workers.gather(workers.compute(list(lazy), retries=3))
        assert_same(dict(zip(EXACT, found)), expected, EXACT)
        assert array.npartitions * len(shards.shards) < 4 or failures.attempts
    p2m.clear_opened()


def test_a_process_opens_shards_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = mixed_scene()
    shards = p2m.write_shards(scene, tmp_path / "site", 8000)
    p2m.clear_opened()
    lazy = p2m.dask.distance(da.from_array(POINTS, chunks=(50, 3)), tmp_path / "site")
    assert np.array_equal(lazy.compute(), shards.distance(POINTS))
    assert p2m._index_cache.open_shards(tmp_path / "site").loads <= len(shards.shards)
    (tmp_path / "site" / shards.shards[2].file).unlink()
    p2m.clear_opened()
    with pytest.raises(FileNotFoundError, match=shards.shards[2].file):
        lazy.compute()
    p2m.write_shards(mixed_scene(2), tmp_path / "site", replace=True)
    with pytest.raises(ValueError, match=r"manifest\.json is not the manifest that the shards came from"):
        lazy.compute()
    with pytest.raises(ValueError, match="shards have no fields"):
        p2m.dask.field(tmp_path / "site", (0, 0, 0), 1.0, (2, 2, 2))


def mixed_ball() -> p2m.Index:
    return p2m.Index(p2m.Scene(*sphere(8, 12)))


def test_chunks_of_unknown_sizes(path: Path, index: p2m.Index) -> None:
    points = da.from_array(POINTS, chunks=(300, 3))
    some, expected = points[points[:, 0] > 0.5], POINTS[POINTS[:, 0] > 0.5]
    answer = p2m.dask.closest(some, path, fields=FIELDS)
    assert np.isnan(answer.distance.shape[0])
    assert_same(answer.compute(), index.closest(expected, fields=FIELDS))
    hits = p2m.dask.rays(some, some, path).compute()
    assert_same(hits, index.rays(expected, expected))
    frame = pytest.importorskip("dask.dataframe")
    pandas = pytest.importorskip("pandas")
    rows = frame.from_pandas(pandas.DataFrame(POINTS, columns=["x", "y", "z"]), npartitions=3)
    found = p2m.dask.distance(rows[rows.x > 0.5].to_dask_array(), path).compute()
    np.testing.assert_array_equal(found, index.distance(expected))


def test_points_and_answers_in_files(path: Path, index: p2m.Index, tmp_path: Path) -> None:
    expected = index.closest(POINTS)
    np.save(tmp_path / "points.npy", POINTS)
    mapped = np.load(tmp_path / "points.npy", mmap_mode="r")
    found = p2m.dask.closest(da.from_array(mapped, chunks=(300, 3)), path)
    da.to_npy_stack(str(tmp_path / "distance"), found.distance)
    np.testing.assert_array_equal(da.from_npy_stack(str(tmp_path / "distance")).compute(), expected.distance)
    np.testing.assert_array_equal(p2m.dask.distance(mapped, path).compute(), expected.distance)
    zarr = pytest.importorskip("zarr")
    da.from_array(POINTS, chunks=(300, 2)).to_zarr(str(tmp_path / "points.zarr"))
    lazy = p2m.dask.closest(da.from_zarr(str(tmp_path / "points.zarr")), path)
    lazy.distance.to_zarr(str(tmp_path / "distance.zarr"))
    np.testing.assert_array_equal(zarr.open_array(str(tmp_path / "distance.zarr"))[:], expected.distance)
    opened = zarr.open_array(str(tmp_path / "points.zarr"))
    np.testing.assert_array_equal(p2m.dask.closest(opened, path).primitive.compute(), expected.primitive)


def test_messages_have_the_row_of_all_points(path: Path) -> None:
    bad = POINTS.copy()
    bad[777, 1] = np.nan
    for points, chunks, message in [
        (bad, (300, 3), "points: row 777 has a coordinate that is not finite"),
        (bad, ((300, 400, 300), 3), r"points: row 77 of the block \(2,\) has a coordinate that is not finite"),
        (bad.reshape(20, 50, 3), (6, 7, 3), "points: row 777 has a coordinate"),
        (bad.reshape(5, 20, 10, 3), (2, 3, 4, 3), "points: row 777 has a coordinate"),
    ]:
        with pytest.raises(ValueError, match=message):
            p2m.dask.distance(da.from_array(points, chunks=chunks), path).compute()
    steps = np.ones((1000, 3))
    steps[512] = 0.0
    with pytest.raises(ValueError, match="directions?.* 512 "):
        p2m.dask.rays(POINTS, da.from_array(steps, chunks=(100, 3)), path).compute()


def test_wrong_arguments_are_errors_at_once(path: Path, index: p2m.Index) -> None:
    points = da.from_array(POINTS, chunks=(300, 3))
    for call, error, message in [
        (lambda: p2m.dask.distance(points[:, :2], path), ValueError, r"points: the shape is \(1000, 2\)"),
        (lambda: p2m.dask.distance(points.astype(str), path), TypeError, "points: the type is"),
        (lambda: p2m.dask.distance(points, 3), TypeError, "index: int is neither a path nor"),
        (lambda: p2m.dask.distance(points, path, threads=0), ValueError, "threads: 0"),
        (lambda: p2m.dask.distance(points, path, max_distance=-1.0), ValueError, "max_distance: -1"),
        (lambda: p2m.dask.closest(points, path, fields=("distance", "colour")), ValueError, "'colour' is none of"),
        (lambda: p2m.dask.closest(points, path, fields=()), ValueError, "fields: none"),
        (lambda: p2m.dask.closest(points, path, certified=True, epsilon=0.1), ValueError, "certified: "),
        (lambda: p2m.dask.distance(points, path, shuffle=True), ValueError, "shuffle: the index is no folder"),
        (lambda: p2m.dask.distance(points, mixed_ball(), shuffle=True), ValueError, "shuffle: the index is no folder"),
        (lambda: p2m.dask.closest(points, path, shuffle=True, certified=True), ValueError, "shuffle: it has neither"),
        (lambda: p2m.dask.closest(points, path, shuffle=True, epsilon=0.1), ValueError, "shuffle: it has neither"),
        (lambda: p2m.dask.closest(points, path, shuffle=True, max_visits=3), ValueError, "shuffle: it has neither"),
        (lambda: p2m.dask.signed_distance(points, path, sign="odd"), ValueError, "sign: 'odd'"),
        (lambda: p2m.dask.rays(points, [0, 0, 1], path, "all"), ValueError, "mode: 'all' is none of"),
        (lambda: p2m.dask.rays(points, [0, 0, 1], path, "any", fields="t"), ValueError, "fields: the mode"),
        (lambda: p2m.dask.rays(points, [0, 0, 1], path, t_min=2, t_max=1), ValueError, "t_min, t_max"),
        (lambda: p2m.dask.field(path, (0, 0), 1.0, (2, 2, 2)), ValueError, "origin: the shape"),
        (lambda: p2m.dask.field(path, (0, 0, 0), 1.0, (2, 0, 2)), ValueError, "shape: "),
    ]:
        with pytest.raises(error, match=message):
            call()


def test_wrong_files_are_errors_of_the_computation(tmp_path: Path) -> None:
    file = tmp_path / "index.p2m"
    lazy = p2m.dask.distance(POINTS, file)
    with pytest.raises(FileNotFoundError, match=r"index\.p2m"):
        lazy.compute()
    p2m.Index(mixed_scene()).save(file)
    assert np.isfinite(lazy.compute()).all()
    by_path, by_index = p2m.dask.distance(POINTS, file), p2m.dask.distance(POINTS, p2m.load(file))
    p2m.Index(mixed_scene(3)).save(file)
    for replaced in [by_path, by_index]:
        with pytest.raises(ValueError, match="is not the file that the index came from"):
            replaced.compute()
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        p2m.dask.distance(POINTS, file).compute()
    with pytest.raises(IsADirectoryError):
        p2m.dask.distance(POINTS, tmp_path).compute()


def test_without_dask_the_message_names_the_package() -> None:
    code = "import sys; sys.modules['dask'] = None; import p2m; import p2m.dask"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ended.stderr.rstrip().endswith('ImportError: p2m.dask needs Dask: pip install "dask[array]"')


def kill_once(block: np.ndarray, flag: str) -> np.ndarray:
    """Return a block. The process ends if this is the first block that holds its point."""
    if block[0, 0] == POINTS[500, 0]:
        try:
            os.close(os.open(flag, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return block
        os.kill(os.getpid(), signal.SIGKILL)
    return block


@contextlib.contextmanager
def cluster(folder: Path) -> Iterator[Any]:
    """Yield the client of a cluster of two processes, each with one thread."""
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0,
            local_directory=str(folder),
        ) as local,
        distributed.Client(local) as client,
    ):
        yield client


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")
def test_processes_of_a_cluster_answer_and_one_may_end(path: Path, index: p2m.Index, tmp_path: Path) -> None:
    with cluster(tmp_path) as client:
        points = da.from_array(POINTS, chunks=(100, 3))
        for source in [path, index, p2m.Index(mixed_scene())]:
            answer = p2m.dask.closest(points, source, fields=FIELDS, map=source is path)
            assert_same(answer.compute(), index.closest(POINTS, fields=FIELDS))
        flag = tmp_path / "killed"
        before = set(client.run(os.getpid).values())
        dying = points.map_blocks(kill_once, flag=str(flag), dtype=points.dtype, meta=np.empty((0, 3)))
        found = p2m.dask.closest(dying, path, fields=FIELDS).compute()
        assert_same(found, index.closest(POINTS, fields=FIELDS))
        client.wait_for_workers(2, timeout=30)
        after = set(client.run(os.getpid).values())
        assert flag.exists() and len(before) == 2 and len(before - after) == 1


def loads_of(shards: p2m.Shards) -> int:
    """Return the number of times that this process has loaded a shard."""
    return shards.loads


def test_processes_that_share_shards_load_each_at_most_twice(tmp_path: Path) -> None:
    index = p2m.Index(mixed_scene())
    count = len(p2m.write_shards(index.scene, tmp_path / "site", 8000).shards)
    points = da.from_array(POINTS, chunks=(100, 3))
    loads = {}
    with cluster(tmp_path) as client:
        # A process treats an index with another limit as another index, so loads are counted from zero.
        for shuffle, limit in [(False, 1), (True, 2)]:
            shards = p2m.Shards(tmp_path / "site", limit)
            found = p2m.dask.closest(points, shards, fields=EXACT, shuffle=shuffle).compute(scheduler=client)
            assert_same(found, index.closest(POINTS, fields=EXACT))
            loads[shuffle] = sum(client.run(loads_of, shards).values())
    assert count <= loads[True] <= 2 * count < loads[False]


def test_millions_of_points_on_two_processes(tmp_path: Path) -> None:
    file = tmp_path / "scene.p2m"
    folder = models()
    scene = p2m.read(folder / "dragon_100k.obj") if folder else p2m.Scene(*sphere(150, 300))
    p2m.Index(scene).save(file)
    index = p2m.load(file, map=True)
    count = 10_000_000 if "P2M_DEEP" in os.environ else 2_000_000
    points = np.random.default_rng(1).uniform(*index.scene.bounds, (count, 3))
    da.to_npy_stack(str(tmp_path / "points"), da.from_array(points, chunks=(500_000, 3)))
    expected = index.closest(points)
    del points
    with cluster(tmp_path):
        found = p2m.dask.closest(da.from_npy_stack(str(tmp_path / "points")), index).compute()
    assert_same(found, expected)
