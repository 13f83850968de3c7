"""Shards answer with the same bits as one index, and wrong files are errors that name the file."""

from __future__ import annotations

import copy
import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import EXACT_FIELDS, assert_same, mixed_scene, sphere
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import p2m

FIELDS = (*EXACT_FIELDS, "object")
HIT_FIELDS = ("t", "primitive", "point", "barycentric", "side")
QUERIES = np.random.default_rng(3).normal(size=(300, 3)) * 2


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shards") / "mixed"
    assert len(p2m.write_shards(mixed_scene(), path, 8000).shards) > 5
    return path


@pytest.fixture
def damaged(folder: Path, tmp_path: Path) -> Path:
    """Return a copy of the folder, in which files may be changed."""
    return Path(shutil.copytree(folder, tmp_path / "copy"))


@st.composite
def sharded(draw: st.DrawFn) -> tuple[p2m.Index, p2m.Shards, np.ndarray, int]:
    """Return the index of a scene, its shards of any size with any limit of memory, queries, and threads."""
    seed, backend = draw(st.integers(0, 10_000)), draw(st.sampled_from(["aabb", "kdop"]))
    scene = mixed_scene(seed, draw(st.integers(8, 80)), draw(st.integers(8, 120)))
    path = os.path.join(tempfile.mkdtemp(dir=_TEMPORARY.name), "shards")
    p2m.write_shards(scene, path, draw(st.integers(2000, 40_000)), backend=backend)
    limit = draw(st.one_of(st.none(), st.integers(0, 60_000)))
    shards = p2m.Shards(path, limit, draw(st.booleans()), threads=draw(st.integers(1, 3)))
    rng = np.random.default_rng(seed)
    near = rng.normal(size=(draw(st.integers(0, 60)), 3)) * draw(st.sampled_from([0.5, 3.0, 100.0]))
    # At vertices many primitives are equally near.
    queries = np.concatenate([near, scene.vertices[:10]])
    return p2m.Index(scene, backend), shards, queries, seed


_TEMPORARY = tempfile.TemporaryDirectory()
LIMITS = ({}, {"max_distance": 0.3}, {"max_distance": 0.0}, {"certified": True})
ANY_CASE = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))

# Each query loads shards again where few fit into memory.
FEW_CASES = settings(ANY_CASE, max_examples=15)


@given(sharded(), st.sampled_from(LIMITS))
@ANY_CASE
def test_closest_points_are_the_same_bits(case: Any, options: Any) -> None:
    index, shards, queries, _ = case
    found = shards.closest(queries, fields=(*FIELDS, "lower_bound"), **options)
    expected = index.closest(queries, fields=FIELDS, **options)
    assert_same(found, expected, FIELDS)
    is_found = np.isfinite(found.distance)
    assert np.all(found.lower_bound[is_found] <= found.distance[is_found])
    single = shards.closest(queries.astype(np.float32), **options)
    assert_same(single, index.closest(queries.astype(np.float32), **options))


@given(sharded(), st.floats(0, 0.5))
@FEW_CASES
def test_approximate_answers_have_their_error(case: Any, epsilon: float) -> None:
    index, shards, queries, _ = case
    exact = index.distance(queries)
    found = shards.closest(queries, epsilon=epsilon).distance
    assert np.all(exact <= found) and np.all(found <= exact * (1 + epsilon))
    few = shards.closest(queries, max_visits=2, fields=("distance", "lower_bound"))
    assert np.all(few.lower_bound <= exact) and np.all(exact <= few.distance)


@given(sharded(), st.integers(1, 12), st.sampled_from([None, 0.4]))
@FEW_CASES
def test_near_primitives_are_the_same_bits(case: Any, k: int, limit: float | None) -> None:
    index, shards, queries, _ = case
    fields = (*FIELDS, "lower_bound")
    assert_same(
        shards.k_nearest(queries, k, max_distance=limit, fields=fields),
        index.k_nearest(queries, k, max_distance=limit, fields=fields),
    )
    for radius in [0.0, 0.3, 1.5]:
        assert_same(shards.within(queries, radius, fields=FIELDS), index.within(queries, radius, fields=FIELDS))
        assert np.array_equal(shards.is_any_within(queries, radius), index.is_any_within(queries, radius))


@given(sharded(), st.sampled_from([0.0, 0.05]))
@FEW_CASES
def test_rays_are_the_same_bits(case: Any, radius: float) -> None:
    index, shards, queries, seed = case
    directions = np.random.default_rng(seed).integers(-2, 3, queries.shape).astype(np.float64)
    directions[np.all(directions == 0, axis=1)] = 1.0
    options: dict[str, Any] = {"radius": radius, "t_min": -1.0}
    for mode in ["first", "all"]:
        found = shards.rays(queries, directions, mode, fields=HIT_FIELDS, **options)
        assert_same(found, index.rays(queries, directions, mode, fields=HIT_FIELDS, **options))
    for mode in ["count", "any", "crossings"]:
        found, expected = (one.rays(queries, directions, mode, **options) for one in (shards, index))
        assert found.dtype == expected.dtype and np.array_equal(found, expected), mode


@pytest.mark.parametrize("options", [{}, {"inside": "positive"}, {"max_distance": 0.25}])
def test_signed_distances_are_those_of_one_index(tmp_path: Path, options: Any) -> None:
    vertices, triangles = sphere(16, 24)
    scene = p2m.Scene(vertices, triangles)
    shards = p2m.write_shards(scene, tmp_path / "ball", 10_000)
    assert len(shards.shards) > 4
    queries = np.concatenate([QUERIES * 0.7, vertices[:20]]).reshape(-1, 4, 3)
    expected = p2m.Index(scene).signed_distance(queries, sign="parity", **options)
    found = shards.signed_distance(queries, **options)
    assert found.tobytes() == expected.tobytes() and np.any(found < 0) and np.any(found > 0)
    away = queries.reshape(-1, 3)[:300]
    assert np.array_equal(shards.contains(away), p2m.Index(scene).signed_distance(away) < 0)
    for sign in ["parity", "winding"]:
        with pytest.raises(ValueError, match=f"sign: '{sign}' is not for shards, which have only 'auto'"):
            shards.signed_distance(queries, sign=sign)  # type: ignore[arg-type]


def test_scenes_with_points_have_no_inside(folder: Path) -> None:
    for query in [p2m.Shards(folder).contains, p2m.Shards(folder).signed_distance]:
        with pytest.raises(ValueError, match="no inside"):
            query(np.zeros((2, 3)))


def test_batches_of_several_parts(tmp_path: Path) -> None:
    """A part has 2**20 points."""
    rng = np.random.default_rng(8)
    scene = p2m.Scene(rng.uniform(size=(400, 3)), points=np.arange(400))
    assert len(p2m.write_shards(scene, tmp_path / "points", 10_000).shards) > 3
    points = rng.uniform(size=((1 << 20) + 500, 3)).astype(np.float32)
    seen: list[tuple[int, int]] = []
    shards = p2m.Shards(tmp_path / "points", 0)
    found = shards.closest(points, progress=lambda done, total: seen.append((done, total)))
    assert_same(found, p2m.Index(scene).closest(points))
    assert shards.loads <= 4 * len(shards.shards)
    assert seen[-1] == (len(points), len(points)) and len(seen) > 3 and seen == sorted(seen)
    assert any(0 < done < len(points) for done, _ in seen)


@pytest.mark.parametrize("threads", [1, 2])
def test_batches_load_each_shard_at_most_twice(folder: Path, threads: int) -> None:
    index = p2m.Index(mixed_scene())
    for query, options in [("closest", {}), ("closest", {"certified": True}), ("k_nearest", {"k": 20})]:
        shards = p2m.Shards(folder, 0, threads=threads)
        seen: list[int] = []
        found = getattr(shards, query)(QUERIES, progress=lambda done, total: seen.append(done), **options)
        assert_same(found, getattr(index, query)(QUERIES, **options))
        assert len(shards.shards) < shards.loads <= 2 * len(shards.shards)
        assert seen == sorted(seen) and seen[-1] == len(QUERIES)


def test_facts_of_the_manifest(folder: Path) -> None:
    scene = mixed_scene()
    shards = p2m.Shards(folder / "manifest.json", max_bytes=123_456)
    assert len(shards) == len(scene) == sum(shard.primitives for shard in shards.shards)
    assert np.array_equal(shards.bounds, scene.bounds) and shards.backend == "aabb"
    assert shards.path == str(folder) and shards.max_bytes == 123_456 and shards.loads == 0
    for shard in shards.shards:
        assert (folder / shard.file).stat().st_size == shard.file_bytes <= 8000
        assert np.all(shard.bounds >= scene.bounds[0]) and np.all(shard.bounds <= scene.bounds[1])
    shards.distance([0, 0, 0])
    assert 0 < shards.loads <= len(shards.shards)


def test_parts_are_one_scene(tmp_path: Path) -> None:
    parts = [mixed_scene(seed, 50, 40) for seed in range(4)]
    shards = p2m.write_shards(iter(parts), tmp_path / "parts", 6000)
    firsts = np.cumsum([0, *(len(part) for part in parts)])
    assert len(shards) == firsts[-1]
    answers = [p2m.Index(part).closest(QUERIES) for part in parts]
    nearest = np.argmin([answer.distance for answer in answers], axis=0)
    found = shards.closest(QUERIES)
    for row, part in enumerate(nearest):
        assert found.distance[row] == answers[part].distance[row]
        assert found.primitive[row] == firsts[part] + answers[part].primitive[row]


def test_an_empty_scene_has_no_answers(tmp_path: Path) -> None:
    shards = p2m.write_shards([], tmp_path / "empty")
    assert len(shards) == 0 and shards.shards == [] and np.all(np.isnan(shards.bounds))
    assert np.all(np.isinf(shards.distance(QUERIES))) and not np.any(shards.contains(QUERIES))
    answer = p2m.Index(p2m.Scene([])).closest(QUERIES, fields=FIELDS)
    assert_same(shards.closest(QUERIES, fields=FIELDS), answer)


def test_objects_are_those_of_the_scene(tmp_path: Path) -> None:
    file = tmp_path / "tiles.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\no first\nf 1 2 3\no second\nl 1 4\n")
    scene = p2m.read(file)
    shards = p2m.write_shards(scene, tmp_path / "tiles", 1)
    assert len(shards.shards) == 2 and shards.objects == scene.objects
    assert_same(shards.closest(QUERIES, fields=FIELDS), p2m.Index(scene).closest(QUERIES, fields=FIELDS))


def test_wrong_files_are_named(damaged: Path, tmp_path: Path) -> None:
    shards = p2m.Shards(damaged)
    answer = shards.closest(QUERIES)
    names = [damaged / shard.file for shard in shards.shards]
    whole = {name: name.read_bytes() for name in names}

    def fails(error: type[Exception], name: Path) -> None:
        for threads in [1, 2]:
            fresh = p2m.Shards(damaged, threads=threads)
            for query in [
                lambda: fresh.closest(QUERIES), lambda: fresh.closest(QUERIES, certified=True),
                lambda: fresh.k_nearest(QUERIES, 400), lambda: fresh.within(QUERIES, 9.0),
                lambda: fresh.rays(QUERIES, -QUERIES, "count"), lambda: fresh.closest(QUERIES, epsilon=0.1),
            ]:
                with pytest.raises(error) as raised:
                    query()
                assert name.name in str(raised.value)

    for name in names[::3]:
        name.unlink()
        fails(FileNotFoundError, name)
        name.write_bytes(whole[name][:-1])
        fails(ValueError, name)
        changed = bytearray(whole[name])
        changed[len(changed) // 2] ^= 1
        name.write_bytes(changed)
        fails(ValueError, name)
        name.write_bytes(whole[names[1]])
        fails(ValueError, name)
        name.write_bytes(whole[name])
    assert_same(p2m.Shards(damaged).closest(QUERIES), answer)


def test_wrong_manifests_are_named(damaged: Path, tmp_path: Path) -> None:
    file = damaged / "manifest.json"
    text = file.read_text()
    for content in ["{}", "no manifest", text.replace('"primitives": ', '"primitives": 1', 1), text[:-20]]:
        file.write_text(content)
        with pytest.raises(ValueError, match=r"manifest\.json"):
            p2m.Shards(damaged)
    file.unlink()
    with pytest.raises(FileNotFoundError, match=r"manifest\.json"):
        p2m.Shards(damaged)
    with pytest.raises(FileNotFoundError, match="absent"):
        p2m.Shards(tmp_path / "absent")


def test_wrong_options_are_errors(folder: Path, tmp_path: Path) -> None:
    shards = p2m.Shards(folder)
    with pytest.raises(ValueError, match="points: row 1 has a coordinate that is not finite"):
        shards.closest([[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="row 0 is zero"):
        shards.rays([0, 0, 0], [0, 0, 0])
    with pytest.raises(IndexError, match=f"shard: {len(shards.shards)} is not from 0"):
        shards.closest_in_shard([0, 0, 0], len(shards.shards))
    with pytest.raises(ValueError, match=r"distances: the shape is \(2,\) instead of \(1,\)"):
        shards.shards_within([[0, 0, 0]], [1.0, 2.0])
    with pytest.raises(ValueError, match="max_bytes: -1"):
        p2m.Shards(folder, -1)
    with pytest.raises(ValueError, match="max_bytes: 0"):
        p2m.write_shards(mixed_scene(), tmp_path / "new", 0)
    with pytest.raises(ValueError, match="brute"):
        p2m.write_shards(mixed_scene(), tmp_path / "new", backend="brute")
    with pytest.raises(ValueError, match="'none' is none of"):
        p2m.write_shards(mixed_scene(), tmp_path / "new", backend="none")
    assert not (tmp_path / "new").exists()


def test_shards_are_replaced_only_if_asked(damaged: Path) -> None:
    with pytest.raises(FileExistsError, match="replace=True"):
        p2m.write_shards(mixed_scene(2), damaged)
    assert len(p2m.Shards(damaged)) == len(mixed_scene())
    other = mixed_scene(2)
    shards = p2m.write_shards(other, damaged, replace=True)
    assert len(shards.shards) == 1 and len(list(damaged.iterdir())) == 2
    assert_same(shards.closest(QUERIES), p2m.Index(other).closest(QUERIES))


def test_an_error_or_an_exception_of_progress_removes_all_files(tmp_path: Path) -> None:
    def parts() -> Any:
        yield mixed_scene()
        raise RuntimeError("no more parts")

    with pytest.raises(RuntimeError, match="no more parts"):
        p2m.write_shards(parts(), tmp_path / "parts")
    with pytest.raises(TypeError):
        p2m.write_shards([mixed_scene(), 7], tmp_path / "parts")
    seen = []

    def stop(done: int, total: int) -> None:
        seen.append(done)
        if 0 < done < total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        p2m.write_shards(mixed_scene(1, 20_000, 60_000), tmp_path / "parts", 100_000, progress=stop)
    assert not (tmp_path / "parts").exists() and seen[-1] > 0


@pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="this system has no timers")
def test_an_interrupt_ends_a_batch(folder: Path) -> None:
    points = np.random.default_rng(1).normal(size=(1 << 21, 3))

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        shards = p2m.Shards(folder)
        for query, options in [("closest", {}), ("closest", {"certified": True}), ("k_nearest", {"k": 3})]:
            shards.distance(QUERIES)
            seen: list[int] = []
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            with pytest.raises(KeyboardInterrupt):
                getattr(shards, query)(points, progress=lambda done, total: seen.append(done), **options)
            assert max(seen, default=0) < len(points) // 2
            assert_same(shards.closest(QUERIES), p2m.Index(mixed_scene()).closest(QUERIES))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_copies_and_pickles(folder: Path, damaged: Path) -> None:
    shards = p2m.Shards(folder, 50_000, threads=1)
    assert copy.copy(shards) is shards and copy.deepcopy(shards) is shards
    data = pickle.dumps(shards)
    assert len(data) < 1000
    p2m.clear_opened()
    first, second = pickle.loads(data), pickle.loads(data)
    assert first._raw is second._raw and first.max_bytes == 50_000 and first._threads == 1
    assert_same(first.closest(QUERIES), shards.closest(QUERIES))
    program = "import pickle, sys; print(len(pickle.load(sys.stdin.buffer)))"
    ended = subprocess.run([sys.executable, "-c", program], input=data, capture_output=True, check=True)
    assert int(ended.stdout) == len(shards)
    data = pickle.dumps(p2m.Shards(damaged))
    p2m.write_shards(mixed_scene(3), damaged, replace=True)
    with pytest.raises(ValueError, match=r"manifest\.json is not the manifest that the shards came from"):
        pickle.loads(data)
    assert json.loads((damaged / "manifest.json").read_text())["format"] == "p2m-shards"
