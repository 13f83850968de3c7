"""Times signed deviations of a noisy scan from a mesh beside PyVista and Open3D.

    pip install ./bindings/python pyvista open3d
    python bindings/python/benchmarks/deviation.py ../shared/models/dragon_100k.obj --points 1000000

The scan has uniformly distributed points of the surface with normal noise along the normals of the triangles. Every
library builds its structure and computes all signed distances on all cores; reading files is not included. The
libraries take turns in one process. The table has medians of wall times and of CPU times of all threads, with the mean
and the root mean square of the deviations beside those of the noise. Open3D computes in float32.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from common import head, importable, interleaved, open3d_scene, row, surface

import p2m


def noisy_scan(vertices: np.ndarray, triangles: np.ndarray, count: int, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a surface with noise along its normals, and the noise."""
    rng = np.random.default_rng(1)
    points, normals = surface(vertices, triangles, count, rng)
    noise = rng.normal(scale=sigma, size=count)
    return points + normals * noise[:, None], noise


def with_p2m(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    return p2m.deviation(points, (vertices, triangles)).values


def with_pyvista(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    import pyvista

    faces = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    cloud = pyvista.PolyData(points)
    found = cloud.compute_implicit_distance(pyvista.PolyData(vertices, faces))
    return np.asarray(found["implicit_distance"])


def with_open3d(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    scene = open3d_scene(vertices, triangles)
    return np.asarray(scene.compute_signed_distance(points.astype(np.float32)).numpy())


LIBRARIES: dict[str, Callable[..., Any]] = {
    "p2m `deviation`": with_p2m,
    "PyVista `compute_implicit_distance`": with_pyvista,
    "Open3D `compute_signed_distance`": with_open3d,
}


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
    mesh = vertices, triangles
    first_calls = [(name, lambda call=call: call(*mesh, points[:100])) for name, call in LIBRARIES.items()]
    names = importable(first_calls)
    times, values = interleaved([lambda name=name: LIBRARIES[name](*mesh, points) for name in names], arguments.rounds)
    print(f"{arguments.points:,} points, {len(triangles):,} triangles\n")
    print(head(["", "time, s", "CPU time, s", "mean", "root mean square"]))
    print(row(["the noise", "-", "-", f"{noise.mean():.3g}", f"{np.sqrt(np.mean(noise**2)):.6g}"]))
    for name, (cpu, wall), value in zip(names, times, values):
        found = value.astype(float)
        mean, rms = found.mean(), np.sqrt(np.mean(found**2))
        print(row([name, f"{wall:.2f}", f"{cpu:.2f}", f"{mean:.3g}", f"{rms:.6g}"]), flush=True)


if __name__ == "__main__":
    main()
