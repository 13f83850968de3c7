"""Tests of samples, of calls for many meshes, and of files of scenes."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import p2m

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def solid() -> p2m.Scene:
    return p2m.Scene(CORNERS, triangles=FACES)


def test_surface_samples_are_even_and_begin_alike() -> None:
    found = p2m.sample_surface(solid(), 20_000, seed=3)
    assert p2m.Index(solid()).distance(found.points).max() < 1e-15
    # The slanted face has the area sqrt(3) / 2, the others 1 / 2.
    shares = np.bincount(found.primitives, minlength=4) / 20_000
    np.testing.assert_allclose(shares, np.array([1, 1, 1, 3**0.5]) / (3 + 3**0.5), atol=0.015)
    shorter = p2m.sample_surface(solid(), 9_000, seed=3, threads=1)
    assert shorter.points.tobytes() == found.points[:9_000].tobytes()
    assert p2m.sample_surface(solid(), 9_000).points.tobytes() != shorter.points.tobytes()
    assert p2m.sample_surface(solid(), 9, dtype=np.float32).points.dtype == np.float32


def test_samples_have_the_distances_of_their_points(tmp_path: Path) -> None:
    options = {"near": 3000, "uniform": 2000, "sigma": (0.01, 0.1), "seed": 5}
    found = p2m.sample_sdf(solid(), **options)
    index = p2m.Index(solid(), "octree")
    assert index.signed_distance(found.points).tobytes() == found.distances.tobytes()
    assert p2m.sample_sdf(index, **options, threads=3).points.tobytes() == found.points.tobytes()
    few, many = np.abs(found.distances[:3000:2]).mean(), np.abs(found.distances[1:3000:2]).mean()
    assert 5 * few < many and (found.points[3000:] >= -0.05).all() and (found.points[3000:] <= 1.05).all()
    rounded = p2m.sample_sdf(solid(), **options, dtype=np.float32)
    assert rounded.points.tobytes() == found.points.astype(np.float32).tobytes()
    assert rounded.distances.tobytes() == index.signed_distance(rounded.points).astype(np.float32).tobytes()
    np.savez(tmp_path / "samples.npz", **found._asdict())
    assert np.load(tmp_path / "samples.npz")["distances"].tobytes() == found.distances.tobytes()
    with pytest.raises(ValueError, match="empty"):
        p2m.sample_sdf(p2m.Scene(np.empty((0, 3))), near=1)
    with pytest.raises(ValueError, match="neither float64 nor float32"):
        p2m.sample_sdf(solid(), near=1, dtype=np.float16)
    with pytest.raises(ValueError, match="no area or length of it is finite"):
        p2m.sample_surface(p2m.Scene(0 * CORNERS, triangles=FACES), 5)
    for sample in (lambda: p2m.sample_surface(solid(), 2**40), lambda: p2m.sample_sdf(solid(), uniform=2**40)):
        with pytest.raises(MemoryError):
            sample()
    for wrong in ({"sigma": np.inf}, {"sigma": [0.1, np.inf]}, {"box_scale": np.inf}):
        with pytest.raises(ValueError, match="inf is not finite"):
            p2m.sample_sdf(solid(), near=1, **wrong)


def test_samples_are_those_of_the_program(tmp_path: Path) -> None:
    program = os.environ.get("P2M_PROGRAM")
    if program is None:
        pytest.skip("there is no program p2m: name it by the variable P2M_PROGRAM")
    solid().save(tmp_path / "solid.ply")
    command = [program, "sample", "solid.ply", "--near", "2000", "--uniform", "1000", "--seed", "6", "--out", "s.npz"]
    subprocess.run(command, check=True, capture_output=True, cwd=tmp_path)
    expected, found = np.load(tmp_path / "s.npz"), p2m.sample_sdf(solid(), near=2000, uniform=1000, seed=6)
    assert expected["points"].tobytes() == found.points.tobytes()
    assert expected["distances"].tobytes() == found.distances.tobytes()


def test_map_keeps_the_order_on_several_threads_and_works_little_ahead() -> None:
    threads, started = set(), []

    def work(i: int) -> tuple[int, float]:
        started.append(i)
        threads.add(threading.get_ident())
        found = p2m.sample_sdf(p2m.Scene(CORNERS * (i + 1), triangles=FACES), uniform=500)
        return i, float(found.distances.min())

    results = p2m.map(work, range(100), threads=3)
    first = next(results)
    assert first[0] == 0 and max(started) < 10
    rest = list(results)
    assert [i for i, _ in rest] == list(range(1, 100)) and len(threads) > 1
    np.testing.assert_allclose([low / (i + 1) for i, low in rest], first[1])

    def fail(i: int) -> int:
        if i == 5:
            raise KeyError(i)
        return i

    with pytest.raises(KeyError):
        list(p2m.map(fail, range(1000), threads=2))


def test_scenes_are_written_in_the_format_of_the_name(tmp_path: Path) -> None:
    for name in ("solid.ply", "solid.obj", "solid.stl", "solid.off", "solid.p2m"):
        solid().save(tmp_path / name)
        again = p2m.read(tmp_path / name)
        assert again.vertices[again.triangles].tolist() == CORNERS[FACES].tolist()
    with pytest.raises(ValueError, match="unknown extension"):
        solid().save(tmp_path / "solid.doc")
    with pytest.raises(OSError, match="does not exist"):
        solid().save(tmp_path / "missing" / "solid.ply")
    with pytest.raises(ValueError, match="no triangle"):
        p2m.Scene(CORNERS).save(tmp_path / "points.stl")
    assert not (tmp_path / "points.stl").exists()


def test_the_package_runs_as_the_program(tmp_path: Path) -> None:
    solid().save(tmp_path / "solid.ply")

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "p2m", *arguments]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)

    assert '"triangles": 4' in run("info", "solid.ply", "--json").stdout
    wrong = run("info", "missing.ply")
    assert wrong.returncode == 1 and "missing.ply" in wrong.stderr
    assert "Usage: p2m" in run("--help").stdout
