"""Tests of the cache of index files, each of which a process opens once."""

from __future__ import annotations

import os
import pickle
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import mixed_scene, sphere

import p2m
from p2m import _index_cache
from p2m._index_cache import open_index


@pytest.fixture
def loads(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Count the files that are loaded, and make each loading take a while."""
    seen: list[str] = []
    load = _index_cache._p2m.load

    class Counting:
        @staticmethod
        def load(path: str, is_mapped: bool, threads: int) -> Any:
            seen.append(path)
            time.sleep(0.05)
            return load(path, is_mapped, threads)

    p2m.clear_opened()
    monkeypatch.setattr(_index_cache, "_p2m", Counting)
    yield seen
    p2m.clear_opened()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    p2m.Index(mixed_scene()).save(tmp_path / "index.p2m")
    return tmp_path / "index.p2m"


def test_a_file_is_opened_once(path: Path, loads: list[str], queries: np.ndarray) -> None:
    link = path.with_name("link.p2m")
    link.symlink_to(path)
    indexes = [open_index(path), open_index(str(path)), open_index(link, threads=1)]
    assert len(loads) == 1 and len({id(index._raw) for index in indexes}) == 1
    assert indexes[2]._threads == 1 and indexes[0]._threads is None
    assert open_index(path, map=True)._raw is not indexes[0]._raw and len(loads) == 2
    np.testing.assert_array_equal(indexes[0].distance(queries), p2m.load(path).distance(queries))
    p2m.clear_opened()
    assert open_index(path)._raw is not indexes[0]._raw


def test_unpickled_indexes_share_one_file(path: Path, loads: list[str]) -> None:
    data = pickle.dumps(p2m.load(path))
    first, second = pickle.loads(data), pickle.loads(data)
    assert first._raw is second._raw and loads == [str(path)]


def test_threads_open_a_file_once(path: Path, loads: list[str]) -> None:
    opened: list[Any] = []
    together = threading.Barrier(4)

    def ask() -> None:
        together.wait()
        opened.append(open_index(path)._raw)

    workers = [threading.Thread(target=ask) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(loads) == 1 and len(opened) == 4 and len({id(raw) for raw in opened}) == 1


def test_a_replaced_file_is_opened_anew(path: Path, loads: list[str]) -> None:
    first = open_index(path)
    status = path.stat()
    other = p2m.Index(mixed_scene(3))
    other.save(path)
    # The header distinguishes files of the same size and time.
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
    second = open_index(path)
    assert len(loads) == 2
    np.testing.assert_array_equal(second.scene.vertices, other.scene.vertices)
    assert not np.array_equal(first.scene.vertices, second.scene.vertices)
    assert len(_index_cache._entries) == 1


def test_shards_replaced_while_they_are_opened_are_opened_anew_or_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, scenes = tmp_path / "site", [mixed_scene(1), mixed_scene(3)]
    p2m.write_shards(scenes[0], folder)
    opened = p2m.Shards(folder)
    source = _index_cache.index_source(opened, False)
    read_checksum = _index_cache.manifest_checksum

    def replace_after_reading(path: str) -> str | None:
        found = read_checksum(path)
        monkeypatch.setattr(_index_cache, "manifest_checksum", read_checksum)
        p2m.write_shards(scenes[1], folder, replace=True)
        return found

    monkeypatch.setattr(_index_cache, "manifest_checksum", replace_after_reading)
    second = _index_cache.open_shards(folder)
    assert second._manifest_checksum == read_checksum(str(folder)) != opened._manifest_checksum
    assert len(second) == len(p2m.Index(scenes[1]))
    p2m.write_shards(scenes[0], folder, replace=True)
    monkeypatch.setattr(_index_cache, "manifest_checksum", replace_after_reading)
    with pytest.raises(ValueError, match="is not the manifest that the shards came from"):
        _index_cache.opened(source, 1)


def test_few_indexes_are_kept(tmp_path: Path, loads: list[str]) -> None:
    paths = [tmp_path / f"{number}.p2m" for number in range(6)]
    for path in paths:
        p2m.Index(mixed_scene()).save(path)
        open_index(path)
    assert len(_index_cache._entries) == _index_cache.MAX_OPENED < len(paths)
    open_index(paths[-1])
    assert len(loads) == 6
    open_index(paths[0])
    assert len(loads) == 7


def test_errors_are_raised_again(path: Path, tmp_path: Path, loads: list[str]) -> None:
    checksum = p2m.load(path)._raw.origin()[1]
    assert _index_cache.read_checksum(str(path)) == checksum
    damaged = tmp_path / "damaged.p2m"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    damaged.write_bytes(data)
    text = tmp_path / "text.p2m"
    text.write_text("no index")
    for _ in range(2):
        with pytest.raises(FileNotFoundError, match=r"absent\.p2m"):
            open_index(tmp_path / "absent.p2m")
        with pytest.raises(ValueError, match="damaged"):
            open_index(damaged)
        with pytest.raises(ValueError, match=r"text\.p2m"):
            open_index(text)
        with pytest.raises(IsADirectoryError, match="saved index is a file"):
            open_index(tmp_path)
        with pytest.raises(ValueError, match=f"its checksum is {checksum} instead of 0123456789abcdef"):
            open_index(path, checksum="0123456789abcdef")
    assert loads == [str(damaged), str(text)] * 2 and not _index_cache._entries
    assert len(open_index(path, checksum=checksum)) == len(mixed_scene())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
def test_a_child_does_not_wait_for_a_file_that_a_thread_of_its_parent_opens(path: Path, loads: list[str]) -> None:
    worker = threading.Thread(target=open_index, args=(path,))
    with _index_cache._lock:
        worker.start()
        child = os.fork()
        if child == 0:
            try:
                os._exit(0 if len(open_index(path)) == len(mixed_scene()) else 1)
            finally:
                os._exit(2)
    worker.join()
    deadline = time.monotonic() + 30
    while (ended := os.waitpid(child, os.WNOHANG)) == (0, 0):
        if time.monotonic() > deadline:
            os.kill(child, 9)
            pytest.fail("the child waits for a lock")
        time.sleep(0.01)
    assert ended[1] == 0


def test_parts_of_a_field_have_the_same_bits() -> None:
    surface = p2m.Index(p2m.Scene(*sphere(8, 12)))
    origin, spacing, shape = (-1.3, -1.2, -1.1), 0.1, (27, 24, 23)
    for options in [{}, {"signed": True}, {"signed": True, "sign": "winding", "band": 0.3}]:
        whole = surface.field(origin, spacing, shape, **options)
        for first, part in [((0, 0, 0), (5, 6, 7)), ((11, 13, 9), (16, 11, 14)), ((20, 3, 1), (1, 1, 1))]:
            x, y, z = (slice(start, start + count) for start, count in zip(first, part))
            found = surface.field(origin, spacing, part, first=first, **options)
            assert found.tobytes() == np.asfortranarray(whole[x, y, z]).tobytes(), (options, first)
    for first in [(0, 0), (-1, 0, 0), (0, 0, 2**41)]:
        with pytest.raises(ValueError, match="first: "):
            surface.field(origin, spacing, shape, first=first)
