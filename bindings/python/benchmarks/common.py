"""What the benchmarks share: points of surfaces, times, peak memory and tables."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import statistics
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

# This has to be set before libigl is imported: it answers queries on one thread, like the others.
os.environ["IGL_NUM_THREADS"] = "1"

import numpy as np


def diagonal(points: np.ndarray) -> float:
    """Return the diagonal of the box of points."""
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


def surface(
    vertices: np.ndarray, triangles: np.ndarray, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Return points of the surface, evenly distributed over its area, and the unit normals there."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    doubled_areas = np.linalg.norm(normals, axis=1)
    sums = np.cumsum(doubled_areas)
    drawn = np.searchsorted(sums, rng.uniform(0.0, sums[-1], count), side="right").clip(0, len(triangles) - 1)
    u, v = rng.uniform(size=(2, count, 1))
    root = np.sqrt(u)
    points = a[drawn] * (1 - root) + b[drawn] * (root * (1 - v)) + c[drawn] * (root * v)
    return points, normals[drawn] / doubled_areas[drawn, None]


def timed(work: Callable[[], Any]) -> tuple[float, float, Any]:
    """Return the CPU time of all threads, the wall time, and the result."""
    cpu, wall = time.process_time(), time.perf_counter()
    result = work()
    return time.process_time() - cpu, time.perf_counter() - wall, result


def medians(times: Iterable[tuple[float, ...]]) -> tuple[float, ...]:
    """Return the median of each column."""
    return tuple(statistics.median(column) for column in zip(*times, strict=True))


def rotated(count: int, number: int) -> list[int]:
    """Return the order of a round. Each round begins with another library."""
    order = list(range(count))
    return order[number % count :] + order[: number % count]


def interleaved(calls: list[Callable[[], Any]], rounds: int) -> tuple[list[tuple[float, ...]], list[Any]]:
    """Return the medians of the CPU and wall times, and the first answers."""
    times: list[list[tuple[float, float]]] = [[] for _ in calls]
    answers: list[Any] = [None] * len(calls)
    for number in range(rounds):
        for i in rotated(len(calls), number):
            cpu, wall, answer = timed(calls[i])
            times[i].append((cpu, wall))
            answers[i] = answer if number == 0 else answers[i]
    return [medians(measured) for measured in times], answers


def status(key: str) -> int:
    """Return a number of bytes from the status of this process on Linux."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(key))
    return int(line.split()[1]) * 1024


def with_peak(work: Callable[[], Any]) -> tuple[float, float, int]:
    """Return the CPU time, the wall time, and the additional peak memory in bytes of a call, on Linux."""
    Path("/proc/self/clear_refs").write_text("5")
    before = status("VmRSS:")
    cpu, wall, result = timed(work)
    peak = status("VmHWM:") - before
    del result
    return cpu, wall, peak


def importable(libraries: list[tuple[str, Callable[[], Any]]]) -> list[str]:
    """Return the names of the libraries whose first call, which imports them, succeeds."""
    names = []
    for name, first_call in libraries:
        try:
            first_call()
            names.append(name)
        except ImportError as error:
            print(f"without {name}: {error}")
    return names


def open3d_scene(vertices: np.ndarray, triangles: np.ndarray, threads: int = 0) -> Any:
    """Return the scene of Open3D, which has float32."""
    import open3d

    scene = open3d.t.geometry.RaycastingScene(nthreads=threads)
    scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
    return scene


def row(cells: Iterable[object]) -> str:
    """Return a row of a table in Markdown."""
    return "| " + " | ".join(map(str, cells)) + " |"


def head(cells: list[str]) -> str:
    """Return the head of a table in Markdown."""
    return f"{row(cells)}\n{row(['---'] * len(cells))}"


def versions(packages: Iterable[str]) -> str:
    """Return the versions of Python and of packages."""
    found = [f"{name} {importlib.metadata.version(name)}" for name in packages]
    return ", ".join([f"Python {platform.python_version()}", *found])
