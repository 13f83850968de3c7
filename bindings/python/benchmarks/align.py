"""Measures alignments of noisy points, beside the ICP of Open3D and trimesh, in one run.

    pip install ./bindings/python[compare]
    python bindings/python/benchmarks/align.py bunny.obj armadillo.obj dragon_100k.obj --starts 100

Points of the surface get noise of a thousandth of the diagonal, and each start moves them by a rotation and by up to
half a diagonal. A start counts as found if the rms of the distances is within 1 % of the rms of the noise. The other
libraries have no search. They begin at the same starts, with the centroids moved onto each other.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
from common import diagonal, importable, medians, surface, timed

import p2m


def rotation(rng: np.random.Generator, degrees: float) -> np.ndarray:
    """Return a rotation by an angle about a random axis."""
    x, y, z = (axis := rng.normal(size=3)) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def with_open3d(scene: p2m.Scene) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return the point-to-plane ICP of Open3D, onto a point cloud of the surface with as many points as the scan."""
    import open3d

    def fit(scan: np.ndarray, start: np.ndarray) -> np.ndarray:
        mesh = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(scene.vertices), open3d.utility.Vector3iVector(scene.triangles)
        )
        mesh.compute_triangle_normals()
        target = mesh.sample_points_uniformly(len(scan), use_triangle_normal=True)
        source = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(scan))
        reach = 0.1 * diagonal(scene.bounds)
        method = open3d.pipelines.registration
        found = method.registration_icp(
            source, target, reach, start, method.TransformationEstimationPointToPlane()
        )
        return np.asarray(found.transformation)

    return fit


def with_trimesh(scene: p2m.Scene) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return the ICP of trimesh, onto a point cloud of the surface with as many points as the scan."""
    import trimesh

    def fit(scan: np.ndarray, start: np.ndarray) -> np.ndarray:
        mesh = trimesh.Trimesh(scene.vertices, scene.triangles, process=False)
        target = mesh.sample(len(scan))
        matrix, _, _ = trimesh.registration.icp(scan, target, start, reflection=False, scale=False)
        return matrix

    return fit


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, nargs="+", help="the files of meshes")
    parser.add_argument("--points", type=int, default=200_000, help="the number of points of the scan")
    parser.add_argument("--starts", type=int, default=100, help="the number of starts for each angle")
    parser.add_argument("--rounds", type=int, default=3, help="how often each library is timed, at 10 degrees")
    arguments = parser.parse_args()
    for path in arguments.mesh:
        scene = p2m.read(path)
        index = p2m.Index(scene)
        size = diagonal(scene.bounds)
        middle = scene.bounds.mean(axis=0)
        rng = np.random.default_rng(7)
        points, _ = surface(scene.vertices, scene.triangles, arguments.points, rng)
        points += rng.normal(scale=1e-3 * size, size=points.shape)

        def rms(moved: np.ndarray) -> float:
            return float(np.sqrt(np.mean(index.distance(moved) ** 2)))

        noise = rms(points)

        def moved(degrees: float) -> np.ndarray:
            way = rng.normal(size=3)
            way *= 0.5 * size * rng.random() / np.linalg.norm(way)
            return (points - middle) @ rotation(rng, degrees).T + middle + way

        print(f"{path.name}: {len(points):,} points, {len(scene.triangles):,} triangles")
        for limit in (10.0, 30.0) if arguments.starts else ():
            ratios = []
            for _ in range(arguments.starts):
                ratios.append(rms(p2m.align(moved(limit * rng.random()), index).points) / noise)
            found = sum(ratio <= 1.01 for ratio in ratios)
            print(f"  below {limit:g} degrees: {found} of {len(ratios)} found, largest {max(ratios):.5f}", flush=True)
        others = {"Open3D": with_open3d, "trimesh": with_trimesh}
        names = importable([(name, lambda make=make: make(scene)) for name, make in others.items()])
        methods = {"p2m": lambda scan, start: p2m.align(scan, p2m.Index(scene)).matrix}
        methods |= {name: others[name](scene) for name in names}
        results: dict[str, list[tuple[float, float, float]]] = {}
        for _ in range(arguments.rounds):
            scan = moved(10.0)
            start = np.eye(4)
            start[:3, 3] = points.mean(axis=0) - scan.mean(axis=0)
            for name, method in methods.items():
                cpu, wall, matrix = timed(lambda method=method: method(scan, start))
                ratio = rms(scan @ matrix[:3, :3].T + matrix[:3, 3]) / noise
                results.setdefault(name, []).append((cpu, wall, ratio))
        for name, values in results.items():
            cpu, wall, ratio = medians(values)
            print(f"  {name}: {wall:.2f} s, {cpu:.2f} s of processors, rms {ratio:.4f} of the noise's", flush=True)


if __name__ == "__main__":
    main()
