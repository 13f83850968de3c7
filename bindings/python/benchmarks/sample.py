"""Measures samples with signed distances: many of one mesh, and some of many small meshes beside other libraries.

    pip install ./bindings/python[compare]
    python bindings/python/benchmarks/sample.py bunny.obj

It needs Linux, whose kernel tells the peak memory. Each library works on the small meshes in a process of its own.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from common import open3d_scene, surface, with_peak

import p2m


def ball(bumps: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a closed mesh of 2,000 triangles, whose shape depends on a number."""
    rings, sides = 25, 40
    angles, turns = np.meshgrid(np.arange(rings) * np.pi / rings + 0.06, np.arange(sides) * 2 * np.pi / sides)
    radius = 1 + 0.2 * np.sin(bumps % 7 * turns) * np.sin(angles)
    points = np.stack([np.sin(angles) * np.cos(turns), np.sin(angles) * np.sin(turns), np.cos(angles)], -1)
    grid = np.arange(sides * rings).reshape(sides, rings)
    a, b = grid, np.roll(grid, -1, axis=0)
    strips = np.stack([a[:, :-1], a[:, 1:], b[:, 1:], a[:, :-1], b[:, 1:], b[:, :-1]], -1).reshape(-1, 3)
    poles = [np.stack([ring, np.roll(ring, -1), np.full(sides, -1)], -1) for ring in (grid[:, 0], grid[::-1, -1])]
    vertices = np.concatenate([(points * radius[..., None]).reshape(-1, 3), [[0, 0, 1.0], [0, 0, -1.0]]])
    poles[0][:, 2], poles[1][:, 2] = len(vertices) - 2, len(vertices) - 1
    return vertices, np.concatenate([strips, *poles])


def with_p2m(meshes: list[Any], count: int) -> Any:
    half = count // 2
    return [found for found in p2m.map(lambda mesh: p2m.sample_sdf(mesh, near=half, uniform=half).distances, meshes)]


def points_around(mesh: Any, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points near the surface and in the box, as users of the other libraries choose them."""
    vertices, triangles = mesh
    near, _ = surface(vertices, triangles, count // 2, rng)
    near += rng.normal(scale=0.03, size=near.shape)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return np.concatenate([near, rng.uniform(low - 0.1, high + 0.1, (count // 2, 3))])


def with_trimesh(meshes: list[Any], count: int) -> Any:
    import trimesh

    rng = np.random.default_rng(0)
    return [
        -trimesh.proximity.signed_distance(trimesh.Trimesh(*mesh, process=False), points_around(mesh, count, rng))
        for mesh in meshes
    ]


def with_pcu(meshes: list[Any], count: int) -> Any:
    import point_cloud_utils

    rng = np.random.default_rng(0)
    return [
        point_cloud_utils.signed_distance_to_mesh(points_around(mesh, count, rng), *mesh)[0] for mesh in meshes
    ]


def with_open3d(meshes: list[Any], count: int) -> Any:
    rng = np.random.default_rng(0)
    return [
        open3d_scene(*mesh).compute_signed_distance(points_around(mesh, count, rng).astype(np.float32)).numpy()
        for mesh in meshes
    ]


# The libraries, with the number of meshes of each: slow ones get fewer.
LIBRARIES = [("p2m", with_p2m, 1000), ("Open3D", with_open3d, 200), ("point-cloud-utils", with_pcu, 50),
             ("trimesh", with_trimesh, 2)]


def run(name: str, count: int) -> None:
    _, method, meshes = next(entry for entry in LIBRARIES if entry[0] == name)
    balls = [ball(i) for i in range(meshes)]
    # The first call imports the library.
    method(balls[:1], 10)
    cpu, wall, memory = with_peak(lambda: method(balls, count))
    each = f"{wall / meshes * 1e3:.1f} ms and {cpu / meshes * 1e3:.1f} ms of processors for each"
    print(f"{name}: {meshes} meshes, {each}, {memory / 1e6:,.0f} MB")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="the file of a closed mesh")
    parser.add_argument("--samples", type=int, default=10_000_000, help="the number of samples of that mesh")
    parser.add_argument("--each", type=int, default=10_000, help="the number of samples of each small mesh")
    parser.add_argument("--library", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.library:
        return run(arguments.library, arguments.each)
    scene, half = p2m.read(arguments.mesh), arguments.samples // 2
    for kind, options in [("near", {"near": 2 * half}), ("uniform", {"uniform": 2 * half}),
                          ("both", {"near": half, "uniform": half})]:
        cpu, wall, memory = with_peak(lambda: p2m.sample_sdf(scene, dtype=np.float32, **options))
        times = f"{wall:.2f} s, {cpu:.2f} s of processors"
        print(f"{kind}: {2 * half:,} samples in {times}, {memory / 1e6:,.0f} MB", flush=True)
    for name, _, _ in LIBRARIES:
        command = [sys.executable, __file__, str(arguments.mesh), "--library", name, "--each", str(arguments.each)]
        subprocess.run(command, check=False)


if __name__ == "__main__":
    main()
