"""Tests of files that are written, results that do not fit into memory, and numbers of threads."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import threading
from pathlib import Path
from typing import Callable

import numpy as np
import pytest

import p2m
from conftest import mixed_scene

Save = Callable[[Path], None]


def saves() -> list[tuple[str, Save]]:
    """Return everything that writes a file."""
    index = p2m.Index(p2m.Scene(np.eye(3), [[0, 1, 2]]))
    found = p2m.deviation(np.eye(3) + 0.5, index, sign=None)
    return [("a.p2m", index.save), ("a.ply", found.save), ("a.html", found.save), ("a.csv", found.save)]


@pytest.mark.skipif(os.name != "posix", reason="links, modes and pipes are those of POSIX")
@pytest.mark.parametrize(("name", "save"), saves())
def test_a_saved_file_keeps_what_was_there(name: str, save: Save, tmp_path: Path) -> None:
    path, link = tmp_path / name, tmp_path / f"link_{name}"
    save(path)
    content = path.read_bytes()
    assert len(content) > 50
    # A link is followed, and a mode is kept.
    path.write_bytes(b"old")
    path.chmod(0o600)
    link.symlink_to(path)
    save(link)
    assert link.is_symlink() and path.read_bytes() == content
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    # Neither a link to nothing nor a read-only file is replaced.
    (tmp_path / f"dangling_{name}").symlink_to(tmp_path / "nothing")
    with pytest.raises(OSError, match="link to nothing"):
        save(tmp_path / f"dangling_{name}")
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(OSError):
        save(path)
    assert path.read_bytes() == b"old"
    assert sorted(os.listdir(tmp_path)) == sorted([name, link.name, f"dangling_{name}"])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with names")
@pytest.mark.parametrize(("name", "save"), saves())
def test_a_pipe_and_a_device_are_written_to(name: str, save: Save, tmp_path: Path) -> None:
    pipe = tmp_path / name
    os.mkfifo(pipe)
    seen: list[bytes] = []
    reader = threading.Thread(target=lambda: seen.append(pipe.read_bytes()))
    reader.start()
    save(pipe)
    reader.join()
    assert stat.S_ISFIFO(pipe.stat().st_mode) and len(seen[0]) > 50
    device = tmp_path / f"full{Path(name).suffix}"
    device.symlink_to("/dev/full")
    with pytest.raises(OSError):
        save(device)
    assert stat.S_ISCHR(device.stat().st_mode)


OUT_OF_MEMORY = """
import numpy as np, p2m, resource
rng = np.random.default_rng(1)
points = rng.random((8000, 3))
index = p2m.Index(p2m.Scene(points))
index.within(points, 0.01, threads=2)
with open("/proc/self/statm") as file:
    limit = int(file.read().split()[0]) * resource.getpagesize() + (100 << 20)
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
for ask in [
    lambda: index.within(points, 10.0),
    lambda: index.within(points, 10.0, threads=2),
    lambda: index.pairs_within(index, 10.0),
]:
    try:
        ask()
    except MemoryError as error:
        print("MemoryError", error)
    assert np.isfinite(index.distance(points)).all()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the memory of a process is limited on Linux")
def test_results_that_do_not_fit_into_memory_raise_an_exception() -> None:
    environment = {**os.environ, "RAYON_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "1"}
    ended = subprocess.run([sys.executable, "-c", OUT_OF_MEMORY], capture_output=True, text=True, env=environment)
    assert ended.returncode == 0, ended.stderr[-2000:]
    assert ended.stdout.splitlines() == ["MemoryError the answers do not fit into memory"] * 3


def test_there_are_at_most_1024_threads() -> None:
    code = "import p2m; print(p2m._p2m.default_threads())"
    environment = {**os.environ, "RAYON_NUM_THREADS": "99999"}
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert ended.stdout.strip() == "1024", ended.stderr


@pytest.mark.parametrize("backend", ["aabb", "octree", "p2m"])
def test_bounds_without_an_answer_are_bounds(backend: str) -> None:
    scene = mixed_scene()
    index, exact = p2m.Index(scene, backend), p2m.Index(scene, "brute")
    low, high = scene.bounds
    points = low + (high - low) * (1.4 * np.random.default_rng(3).random((4000, 3)) - 0.2)
    truth = exact.distance(points)
    largest = float(np.quantile(truth, 0.5))
    for options in [{"max_visits": 0}, {}, {"certified": True}]:
        fields = ("distance", "lower_bound", "primitive")
        answer = index.closest(points, max_distance=largest, fields=fields, **options)  # type: ignore[arg-type]
        missing = answer.primitive == -1
        assert missing.sum() > 1000 and (~missing).sum() > 1000
        assert (answer.lower_bound <= truth * (1 + 1e-12)).all(), options
        if not options:
            assert np.allclose(answer.lower_bound[missing], largest, rtol=1e-12)
