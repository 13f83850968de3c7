"""Runs the programs of users who reported that another library is slow or runs out of memory, in one call each.

    pip install ./bindings/python[compare]
    python bindings/python/benchmarks/users.py

It needs Linux, whose kernel reports the peak memory. Each program runs in its own process, on one thread. Slow
libraries get fewer points.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

# This sets the number of threads of libigl before it is imported.
from common import head, row, with_peak

import numpy as np

import p2m

CARRIED = Path(__file__).resolve().parents[3] / "scenes" / "knot_and_cables.obj"
SMALL_CALL_POINTS = 10


def few_triangles() -> tuple[np.ndarray, np.ndarray]:
    """Return ten triangles."""
    rng = np.random.default_rng(1)
    return rng.normal(size=(12, 3)), np.array([[i, i + 1, i + 2] for i in range(10)])


def tube() -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles of the scene in the repository: a closed tube of 3,600 triangles."""
    scene = p2m.read(CARRIED)
    return scene.vertices, scene.triangles


def p2m_closest(mesh: Any, points: np.ndarray) -> Any:
    return p2m.Index(mesh, threads=1).closest(points, fields=("distance", "primitive", "point"))


def trimesh_closest(mesh: Any, points: np.ndarray) -> Any:
    import trimesh

    return trimesh.proximity.closest_point(trimesh.Trimesh(*mesh, process=False), points)


def p2m_signed(mesh: Any, points: np.ndarray) -> Any:
    return p2m.Index(mesh, threads=1).signed_distance(points)


def trimesh_signed(mesh: Any, points: np.ndarray) -> Any:
    import trimesh

    return trimesh.proximity.signed_distance(trimesh.Trimesh(*mesh, process=False), points)


def p2m_small_calls(mesh: Any, points: np.ndarray) -> Any:
    index = p2m.Index(mesh, threads=1)
    return [index.signed_distance(few) for few in points.reshape(-1, SMALL_CALL_POINTS, 3)]


def igl_small_calls(mesh: Any, points: np.ndarray) -> Any:
    import igl

    return [igl.signed_distance(few, *mesh) for few in points.reshape(-1, SMALL_CALL_POINTS, 3)]


PROGRAMS: list[tuple[str, str, Any, Any, int]] = [
    ("closest points on ten triangles", "p2m", p2m_closest, few_triangles, 500_000),
    ("closest points on ten triangles", "trimesh", trimesh_closest, few_triangles, 500_000),
    ("signed distances from the tube", "p2m", p2m_signed, tube, 1_000_000),
    ("signed distances from the tube", "trimesh", trimesh_signed, tube, 20_000),
    ("signed distances, ten points a call", "p2m", p2m_small_calls, tube, 100_000),
    ("signed distances, ten points a call", "libigl", igl_small_calls, tube, 1_000),
]


def run(number: int) -> None:
    """Run one program, and print its CPU time in seconds and its peak memory in bytes without the points."""
    _, _, program, make, count = PROGRAMS[number]
    mesh = make()
    low, high = mesh[0].min(axis=0), mesh[0].max(axis=0)
    points = np.random.default_rng(2).uniform(low, high, (count, 3))
    # The first call imports the library.
    program(mesh, points[:SMALL_CALL_POINTS])
    cpu, _, memory = with_peak(lambda: program(mesh, points))
    print(cpu, memory)


def main() -> None:
    if len(sys.argv) > 1:
        return run(int(sys.argv[1]))
    print(head(["program", "library", "points", "CPU time, s", "time a point, us", "peak memory, MB"]))
    for number, (name, library, _, _, count) in enumerate(PROGRAMS):
        command = [sys.executable, __file__, str(number)]
        output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        seconds, memory = map(float, output.split())
        cells = [f"{count:,}", f"{seconds:.2f}", f"{seconds / count * 1e6:,.2f}", f"{memory / 1e6:,.0f}"]
        print(row([name, library, *cells]), flush=True)


if __name__ == "__main__":
    main()
