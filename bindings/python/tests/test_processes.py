"""Pickling, processes, threads, signals and progress."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ALL_FIELDS, BACKENDS, assert_same, mixed_scene, sphere

import p2m

POINTS = np.random.default_rng(8).normal(size=(20_000, 3))


def distances(index: p2m.Index, threads: int) -> bytes:
    return index.distance(POINTS, threads=threads).tobytes()


@pytest.mark.parametrize("backend", BACKENDS)
def test_pickled_indexes_answer_as_before(backend: str, scene: p2m.Scene, queries: np.ndarray) -> None:
    index = p2m.Index(scene, backend, threads=2)
    other = pickle.loads(pickle.dumps(index))
    assert other is not index and other.backend == backend and other._threads == 2
    assert_same(other.closest(queries, fields=ALL_FIELDS), index.closest(queries, fields=ALL_FIELDS))
    assert copy.copy(index) is index and copy.deepcopy([index])[0] is index
    again = pickle.loads(pickle.dumps(scene))
    np.testing.assert_array_equal(again.triangles, scene.triangles)
    assert copy.deepcopy(scene) is scene
    record = pickle.loads(pickle.dumps(index.closest(queries)))
    assert_same(record, index.closest(queries))
    assert isinstance(copy.copy(record), p2m.ClosestPoints)


def test_indexes_of_files_are_pickled_as_their_path(tmp_path: Path, queries: np.ndarray) -> None:
    path = tmp_path / "index.p2m"
    index = p2m.Index(mixed_scene())
    index.save(path)
    for is_mapped in [False, True]:
        loaded = p2m.load(path, map=is_mapped)
        data = pickle.dumps(loaded)
        assert len(data) < 400
        assert_same(pickle.loads(data).closest(queries), index.closest(queries))
    copied = pickle.dumps(p2m.load(path))
    p2m.Index(mixed_scene(3)).save(path)
    with pytest.raises(ValueError, match="is not the file that the index came from: its checksum"):
        pickle.loads(copied)
    path.unlink()
    with pytest.raises(FileNotFoundError):
        pickle.loads(copied)


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.parametrize("is_file", [False, True])
def test_processes_share_indexes(method: str, is_file: bool, tmp_path: Path) -> None:
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"this system cannot {method}")
    index = p2m.Index(mixed_scene(), "octree")
    if is_file:
        index.save(tmp_path / "index.p2m")
        index = p2m.load(tmp_path / "index.p2m", map=True)
    # The pool of this process has threads before the fork, and its children do not have these threads.
    expected = distances(index, 2)
    with multiprocessing.get_context(method).Pool(2) as pool:
        answers = pool.starmap_async(distances, [(index, 2), (index, 1), (index, 2)]).get(timeout=120)
    assert answers == [expected] * 3
    assert distances(index, 2) == expected


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
def test_a_child_has_threads_of_its_own() -> None:
    index = p2m.Index(mixed_scene())
    expected = distances(index, 2)
    child = os.fork()
    if child == 0:
        os._exit(0 if distances(index, 2) == expected and len(p2m.Index(mixed_scene(), "octree", threads=2)) else 1)
    deadline = time.monotonic() + 60
    while (ended := os.waitpid(child, os.WNOHANG)) == (0, 0):
        if time.monotonic() > deadline:
            os.kill(child, signal.SIGKILL)
            pytest.fail("the child waits for threads that it does not have")
        time.sleep(0.01)
    assert ended[1] == 0


@pytest.mark.parametrize("threads", [1, 2])
def test_the_interpreter_runs_during_a_batch(threads: int) -> None:
    index = p2m.Index(p2m.Scene(*sphere(100, 200)), "brute")
    points = np.zeros((400, 3))
    ended = threading.Event()

    def batch() -> None:
        index.distance(points, threads=threads)
        ended.set()

    thread = threading.Thread(target=batch)
    thread.start()
    ticks = 0
    while not ended.wait(0.001):
        ticks += 1
    thread.join()
    assert ticks > 20


def test_threads_query_one_index() -> None:
    index = p2m.Index(mixed_scene())
    expected = index.closest(POINTS)
    failures: list[str] = []

    def ask(threads: int) -> None:
        for _ in range(5):
            try:
                assert_same(index.closest(POINTS, threads=threads), expected)
                index.k_nearest(POINTS[:500], 3, threads=threads)
            except AssertionError as error:
                failures.append(str(error))

    workers = [threading.Thread(target=ask, args=(1 + i % 3,)) for i in range(6)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not failures


def test_what_a_batch_needs_may_be_deleted() -> None:
    index = p2m.Index(mixed_scene())
    expected = index.distance(POINTS)
    results = []

    def ask(index: p2m.Index) -> None:
        results.append(index.distance(POINTS.copy()))

    thread = threading.Thread(target=ask, args=(index,))
    thread.start()
    scene = index.scene
    del index
    thread.join()
    del scene
    np.testing.assert_array_equal(results[0], expected)


INTERRUPTED = """
import sys, time, signal, threading, os
import numpy as np, p2m
sys.path.insert(0, {tests!r})
from conftest import sphere
work = {work!r}
# The work takes several times as long as the interrupt waits.
scene = p2m.Scene(*sphere(*(400, 800) if work in ("octree", "p2m", "hausdorff") else (200, 400)))
# A process that runs in the background may have been started with the signal ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
threads = {threads}
small = p2m.Scene(*sphere(20, 40))
index = None if work in ("octree", "p2m") else p2m.Index(scene, "brute")
tree = p2m.Index(small)
slow = p2m.Index(small, "brute")
points = np.random.default_rng(1).normal(size=(100_000, 3))
many = np.random.default_rng(1).normal(size=(8_000_000 if work == "tree" else 0, 3))
sent = []
def interrupt():
    # The time of the processor does not depend on other work of the machine.
    sent.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)
timer = threading.Timer(0.3, interrupt)
timer.start()
try:
    if work in ("octree", "p2m"):
        p2m.Index(scene, work, threads=threads)
    elif work == "closest":
        index.closest(points, threads=threads)
    elif work == "certified":
        index.closest(points, certified=True, threads=threads)
    elif work == "k_nearest":
        index.k_nearest(points, 3, threads=threads)
    elif work == "within":
        index.within(points, 0.01, threads=threads)
    elif work == "rays":
        index.rays(points, [0, 0, 1], "count", threads=threads)
    elif work == "tree":
        tree.k_nearest(many, 4, threads=threads)
    elif work == "shapes":
        slow.closest_to(points.reshape(-1, 2, 3), threads=threads)
    elif work == "contacts":
        slow.first_contact(points, points[::-1], 0.1, threads=threads)
    elif work == "pair":
        index.closest_pair(tree, threads=threads)
    elif work == "pairs":
        index.closest_pairs(tree, np.tile(np.eye(4), (9, 1, 1)), threads=threads)
    elif work == "hausdorff":
        p2m.hausdorff(scene, (scene.vertices * 1.001, scene.triangles), 0.0, threads=threads)
    elif work == "field":
        tree.field((0, 0, 0), 1e-3, (1500, 1500, 1500), threads=threads)
except KeyboardInterrupt:
    print("interrupted", (time.process_time() - sent[0]) / threads)
else:
    print("ended")
# What was cancelled does not stand in the way of other work.
assert np.isfinite(tree.distance(points[:5000], threads=threads)).all()
print("works")
"""


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    "work",
    ["octree", "p2m", "closest", "certified", "k_nearest", "within", "rays", "shapes", "contacts", "pair", "pairs",
     "hausdorff", "tree", "field"],
)
def test_an_interrupt_ends_work_at_once(work: str, threads: int) -> None:
    by_one_thread = ("certified", "within", "p2m", "contacts", "pair")
    if threads != (1 if work in by_one_thread else 2) and (threads == 2 or "P2M_DEEP" not in os.environ):
        pytest.skip("as with another number of threads")
    code = INTERRUPTED.format(tests=str(Path(__file__).parent), work=work, threads=threads)
    for _ in range(3):
        ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
        assert ended.returncode == 0, ended.stderr
        first, second = ended.stdout.splitlines()
        assert first.startswith("interrupted") and second == "works", ended.stdout
        seconds = float(first.split()[1])
        print(work, threads, seconds)
        # One of three runs has to be in time.
        if seconds < 0.1:
            return
    pytest.fail(f"{work}: {seconds} s")


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_is_told(threads: int) -> None:
    index = p2m.Index(p2m.Scene(*sphere(100, 200)), "brute")
    points = np.full((150, 3), 0.5)
    for ask in [
        lambda call: index.closest(points, threads=threads, progress=call),
        lambda call: index.k_nearest(points, 2, threads=threads, progress=call),
        lambda call: p2m.Index(p2m.Scene(*sphere(200, 400)), "octree", threads=threads, progress=call),
    ]:
        seen: list[tuple[int, int]] = []
        ask(lambda done, total: seen.append((done, total)))
        dones = [done for done, _ in seen]
        assert len(seen) > 2 and dones == sorted(dones) and seen[-1][0] == seen[-1][1]
        assert any(0 < done < total for done, total in seen)


@pytest.mark.parametrize("threads", [1, 2])
def test_an_exception_of_the_callback_ends_the_work(threads: int) -> None:
    index = p2m.Index(p2m.Scene(*sphere(100, 200)), "brute")

    def fail(done: int, total: int) -> None:
        raise KeyError(f"{done} of {total}")

    start = time.process_time()
    with pytest.raises(KeyError, match="of 1000000"):
        index.closest(np.zeros((1_000_000, 3)), threads=threads, progress=fail)
    assert time.process_time() - start < 5
    with pytest.raises(KeyError):
        p2m.Index(p2m.Scene(*sphere(150, 300)), "octree", threads=threads, progress=fail)


def test_tqdm_shows_a_bar(capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    index = p2m.Index(mixed_scene())
    for progress in [True, "tqdm"]:
        index.closest(POINTS, progress=progress)
        assert "answering: 100%" in capfd.readouterr().err


def test_the_number_of_threads_comes_from_the_environment() -> None:
    code = "import p2m; print(p2m._p2m.default_threads())"
    for value, expected in [("3", "3"), ("0", None), ("many", None)]:
        environment = {**os.environ, "RAYON_NUM_THREADS": value}
        ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
        assert ended.stdout.strip() == (expected or str(len(os.sched_getaffinity(0)))), ended.stderr


def test_small_batches_start_no_threads() -> None:
    code = """
import numpy as np, os, p2m
index = p2m.Index(p2m.Scene(np.eye(3), [[0, 1, 2]]), threads=1)
before = len(os.listdir("/proc/self/task"))
index.closest(np.zeros((10, 3)), threads=8)
index.k_nearest(np.zeros((10, 3)), 1, threads=8)
assert len(os.listdir("/proc/self/task")) == before
index.closest(np.zeros((10_000, 3)), threads=8)
assert len(os.listdir("/proc/self/task")) > before
"""
    if not os.path.isdir("/proc/self/task"):
        pytest.skip("the threads of a process are not known here")
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
