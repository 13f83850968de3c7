"""Times signed deviations of a noisy scan from a mesh beside PyVista and Open3D.

    pip install ./bindings/python pyvista open3d
    python bindings/python/benchmarks/deviation.py ../shared/models/dragon_100k.obj --points 1000000

The scan has uniformly distributed points of the surface with normal noise along the normals of the triangles. Every
library builds its structure and computes all signed distances on all cores; reading files is not included. The
libraries take turns in one process, and the table has medians of times by the clock and of CPU times of all threads, with
the mean and the root mean square of the deviations beside those of the noise. Open3D computes in float32.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import p2m


def noisy_scan(vertices: np.ndarray, triangles: np.ndarray, count: int, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a surface with noise along its normals, and the noise."""
    rng = np.random.default_rng(1)
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    drawn = rng.choice(len(triangles), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    noise = rng.normal(scale=sigma, size=count)
    points = a[drawn] + u * (b - a)[drawn] + v * (c - a)[drawn]
    return points + normals[drawn] / areas[drawn, None] * noise[:, None], noise


def with_p2m(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    return p2m.deviation(points, (vertices, triangles)).values


def with_pyvista(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    import pyvista

    faces = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    cloud = pyvista.PolyData(points)
    found = cloud.compute_implicit_distance(pyvista.PolyData(vertices, faces))
    return np.asarray(found["implicit_distance"])


def with_open3d(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    tensor = open3d.core.Tensor
    scene.add_triangles(tensor(vertices.astype(np.float32)), tensor(triangles.astype(np.uint32)))
    return np.asarray(scene.compute_signed_distance(tensor(points.astype(np.float32))).numpy())


LIBRARIES: list[tuple[str, Callable[..., Any]]] = [
    ("p2m `deviation`", with_p2m),
    ("PyVista `compute_implicit_distance`", with_pyvista),
    ("Open3D `compute_signed_distance`", with_open3d),
]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="the file of a closed mesh")
    parser.add_argument("--points", type=int, default=1_000_000, help="the number of points of the scan")
    parser.add_argument("--sigma", type=float, default=1e-3, help="the standard deviation of the noise")
    parser.add_argument("--rounds", type=int, default=3, help="how often each library is timed")
    arguments = parser.parse_args()
    scene = p2m.read(arguments.mesh)
    vertices, triangles = scene.vertices, scene.triangles
    points, noise = noisy_scan(vertices, triangles, arguments.points, arguments.sigma)
    available = []
    for name, compute in LIBRARIES:
        try:
            # The first call imports the library.
            compute(vertices, triangles, points[:100])
            available.append((name, compute))
        except ImportError as error:
            print(f"without {name}: {error}")
    times: dict[str, list[tuple[float, float]]] = {name: [] for name, _ in available}
    values = {}
    for _ in range(arguments.rounds):
        for name, compute in available:
            start = time.perf_counter(), time.process_time()
            values[name] = compute(vertices, triangles, points)
            times[name].append((time.perf_counter() - start[0], time.process_time() - start[1]))
    print(f"{arguments.points:,} points, {len(triangles):,} triangles\n")
    print("| | time, s | CPU time, s | mean | root mean square |")
    print("| --- | --- | --- | --- | --- |")
    print(f"| the noise | - | - | {noise.mean():.3g} | {np.sqrt(np.mean(noise**2)):.6g} |")
    for name, _ in available:
        found = values[name].astype(float)
        mean, rms = found.mean(), np.sqrt(np.mean(found**2))
        wall, cpu = (statistics.median(part) for part in zip(*times[name], strict=True))
        print(f"| {name} | {wall:.2f} | {cpu:.2f} | {mean:.3g} | {rms:.6g} |", flush=True)


if __name__ == "__main__":
    main()
