"""Programs of users that took too much time or memory with other packages, as a table of time and peak memory.

usage: python users.py [--rivals] [--threads N] [--dragon FILE]

    ten triangles       500,000 points and a mesh of ten triangles (trimesh issue 1116)
    signed distances    a million of them for a scanned mesh of 100,000 triangles (trimesh issue 976)
    small calls         10,000 calls of ten points each for the same mesh (libigl issue 623)

Each row runs in a process of its own. Times are those after the imports and the reading of the mesh, and include the
build of the index. Peak memory is what the process needs beyond that. Rivals answer the share of the queries that is
printed; their times are for these alone.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import p2m

PROGRAMS = ["ten triangles", "signed distances", "small calls"]
QUERIES = {"ten triangles": 500_000, "signed distances": 1_000_000, "small calls": 100_000}
PACKAGES = ["p2m", "p2m.compat.trimesh", "p2m.compat.open3d", "p2m.compat.igl", "trimesh", "open3d", "igl"]
SHARES = {
    "trimesh": {"ten triangles": 0.1, "signed distances": 0.002, "small calls": 0.005},
    "open3d": {"ten triangles": 1.0, "signed distances": 0.1, "small calls": 1.0},
    "igl": {"ten triangles": 1.0, "signed distances": 0.01, "small calls": 0.005},
}
"""The share of the queries that other packages answer, which takes seconds to a minute. trimesh needs 11 GB for 2,000
signed distances."""


def dragon(path: str | None) -> Path:
    """Return the file of the mesh."""
    if path is not None:
        return Path(path)
    folders = [os.environ.get("P2M_MODELS")] + [str(p / "shared" / "models") for p in Path(__file__).resolve().parents]
    for folder in folders:
        if folder and (Path(folder) / "dragon_100k.obj").exists():
            return Path(folder) / "dragon_100k.obj"
    raise SystemExit("name a mesh by --dragon, or its folder by P2M_MODELS")


def mesh_and_points(program: str, count: int, path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the vertices and triangles of a program and its points."""
    rng = np.random.default_rng(1)
    if program == "ten triangles":
        vertices, triangles = rng.random((12, 3)), np.array([[i, i + 1, i + 2] for i in range(10)])
    else:
        scene = p2m.read(path)
        vertices, triangles = scene.vertices, scene.triangles
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return vertices, triangles, low + (rng.random((count, 3)) * 1.1 - 0.05) * (high - low)


def calls(package: str, vertices: np.ndarray, triangles: np.ndarray, threads: int) -> tuple[Any, Any]:
    """Return the functions for closest points and for signed distances; building the index is part of their use."""
    if package == "p2m":
        index = p2m.Index(p2m.Scene(vertices, triangles), threads=threads)
        return index.closest, index.signed_distance
    if package.endswith("trimesh"):
        import trimesh

        mesh = trimesh.Trimesh(vertices, triangles, process=False)
        if package.startswith("p2m"):
            from p2m.compat.trimesh import ProximityQuery

            mesh.nearest = ProximityQuery(mesh)
        return mesh.nearest.on_surface, mesh.nearest.signed_distance
    if package.endswith("open3d"):
        if package.startswith("p2m"):
            from p2m.compat.open3d import RaycastingScene
        else:
            from open3d.t.geometry import RaycastingScene
        scene = RaycastingScene(nthreads=threads)
        scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
        return (
            lambda points: scene.compute_closest_points(points.astype(np.float32), nthreads=threads),
            lambda points: scene.compute_signed_distance(points.astype(np.float32), nthreads=threads),
        )
    if package.startswith("p2m"):
        from p2m.compat import igl
    else:
        import igl  # type: ignore[no-redef]
    return (
        lambda points: igl.point_mesh_squared_distance(points, vertices, triangles),
        lambda points: igl.signed_distance(points, vertices, triangles),
    )


def imported(package: str) -> bool:
    """Import a package, and return whether it is there."""
    try:
        __import__(package.removeprefix("p2m.compat.") if package.endswith("trimesh") else package)
    except ImportError as reason:
        print(f"{package} is left out: {reason}", file=sys.stderr)
        return False
    return True


def run(program: str, package: str, threads: int, path: Path) -> dict[str, float] | None:
    """Run one program, and return its time, its peak memory and the number of its queries."""
    if not imported(package):
        return None
    count = int(QUERIES[program] * SHARES.get(package, {}).get(program, 1.0))
    vertices, triangles, points = mesh_and_points(program, count, path)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    closest, signed = calls(package, vertices, triangles, threads)
    if program == "small calls":
        for first in range(0, count, 10):
            closest(points[first : first + 10])
    else:
        function: Callable[[np.ndarray], object] = closest if program == "ten triangles" else signed
        function(points)
    seconds = time.perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {"queries": count, "seconds": seconds, "megabytes": (peak - before) / 1024}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rivals", action="store_true", help="measure the other packages as well")
    parser.add_argument("--threads", type=int, default=1, help="the number of threads (trimesh and libigl have theirs)")
    parser.add_argument("--dragon", help="the mesh of 100,000 triangles")
    parser.add_argument("--one", nargs=2, metavar=("PROGRAM", "PACKAGE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    path = dragon(options.dragon)
    if options.one:
        print(json.dumps(run(*options.one, options.threads, path)))
        return
    print(f"| program | package | queries | seconds | microseconds a query | peak memory, MB |\n|{'---|' * 6}")
    for program in PROGRAMS:
        for package in PACKAGES:
            if not options.rivals and not package.startswith("p2m"):
                continue
            command = [sys.executable, __file__, "--threads", str(options.threads), "--dragon", str(path), "--one"]
            done = subprocess.run([*command, program, package], stdout=subprocess.PIPE, check=False, text=True)
            row = json.loads(done.stdout) if done.returncode == 0 else None
            if row is not None:
                micros = row["seconds"] / row["queries"] * 1e6
                numbers = f"{row['queries']:,} | {row['seconds']:.2f} | {micros:.2f} | {row['megabytes']:.0f}"
                print(f"| {program} | {package} | {numbers} |", flush=True)
            elif done.returncode != 0:
                print(f"| {program} | {package} | - | it ended with the status {done.returncode} | - | - |", flush=True)


if __name__ == "__main__":
    main()
