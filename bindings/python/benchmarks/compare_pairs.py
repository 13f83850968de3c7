"""Compares p2m with other libraries of Python for pairs: two meshes, capsules near a mesh, and Hausdorff distances.

    pip install ./bindings/python[compare,pairs]
    python bindings/python/benchmarks/compare_pairs.py ../shared/models/dragon_100k.obj ../shared/models/armadillo.obj \
        --hausdorff ../shared/models/dragon_48k_nonmanifold.ply ../shared/models/dragon_871k.ply

The second mesh is scaled to the diagonal of the first one. `far` poses have random rotations and centres at a distance
of two diagonals, and `near` poses are moved along the line of the centres to a gap of about a hundredth of the
diagonal. Capsules have a length of a tenth of the diagonal and a radius of a hundredth, and lie anywhere in the box of
the mesh.

In each round every library answers the same queries once, and each round begins with another library. All have one
thread. Tables have medians of the CPU times. Answers that differ by more than a millionth of the diagonal are counted,
and exact arithmetic decides some of them by the distances of the primitives that the libraries return.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

# This sets the number of threads of libigl before it is imported.
from common import diagonal, head, interleaved, row, versions

import numpy as np
from exact import root, squared_distance_of_hulls, vector
from motions import random_rotation

import p2m

GAP = 0.01
"""The distance of the centres of far poses, in diagonals."""
FAR = 2.0
"""The distance of the centres of far poses, in diagonals."""
TOLERANCE = 1e-6
"""The difference of distances that counts, in diagonals."""
DECIDED = 5
"""The number of differences that are decided by exact arithmetic."""
RADIUS, LENGTH = 0.01, 0.1
"""The radius and the length of capsules, in diagonals."""


class Mesh(NamedTuple):
    vertices: np.ndarray
    triangles: np.ndarray


class Library:
    """A library that finds the nearest points of two meshes, and of a mesh and a capsule."""

    name: str
    package: str

    def build(self, mesh: Mesh) -> Any:
        """Return the representation of a mesh that the library keeps."""
        raise NotImplementedError

    def pairs(self, first: Any, second: Any, transforms: np.ndarray) -> list[tuple[float, int, int]]:
        """Return the distance and the nearest triangles for each motion of the second mesh."""
        raise NotImplementedError

    def capsules(self, mesh: Any, segments: np.ndarray, radius: float) -> list[tuple[float, int]]:
        """Return the distance and the nearest triangle for each capsule."""
        raise NotImplementedError


class P2m(Library):
    package = "p2m"

    def __init__(self, backend: str) -> None:
        self.backend = backend
        self.name = f"p2m {backend}"

    def build(self, mesh):
        return p2m.Index(p2m.Scene(*mesh), self.backend, threads=1)

    def pairs(self, first, second, transforms):
        found = first.closest_pairs(second, transforms)
        return [(d, i, j) for d, (i, j) in zip(found.distance.tolist(), found.primitives.tolist())]

    def capsules(self, mesh, segments, radius):
        found = mesh.closest_to(segments, radius=radius)
        return list(zip(found.distance.tolist(), found.primitive.tolist()))


def capsule_frame(segment: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return a rotation of the z axis to a segment, its centre and its length."""
    along = segment[1] - segment[0]
    length = float(np.linalg.norm(along))
    z = along / length
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1), segment.mean(axis=0), length


class Fcl(Library):
    name, package = "python-fcl", "python-fcl"

    def build(self, mesh):
        import fcl

        model = fcl.BVHModel()
        model.beginModel(len(mesh.vertices), len(mesh.triangles))
        model.addSubModel(mesh.vertices, mesh.triangles)
        model.endModel()
        return model

    def pairs(self, first, second, transforms):
        import fcl

        a, b = fcl.CollisionObject(first), fcl.CollisionObject(second)
        answers = []
        for m in transforms:
            b.setTransform(fcl.Transform(m[:3, :3], m[:3, 3]))
            result = fcl.DistanceResult()
            fcl.distance(a, b, fcl.DistanceRequest(enable_nearest_points=True), result)
            answers.append((max(result.min_distance, 0.0), result.b1, result.b2))
        return answers

    def capsules(self, mesh, segments, radius):
        import fcl

        a = fcl.CollisionObject(mesh)
        answers = []
        for segment in segments:
            turn, centre, length = capsule_frame(segment)
            b = fcl.CollisionObject(fcl.Capsule(radius, length), fcl.Transform(turn, centre))
            result = fcl.DistanceResult()
            fcl.distance(a, b, fcl.DistanceRequest(), result)
            answers.append((max(result.min_distance, 0.0), result.b1))
        return answers


class Coal(Library):
    name, package = "coal", "coal"

    def build(self, mesh):
        import coal

        model = coal.BVHModelOBBRSS()
        model.beginModel(len(mesh.triangles), len(mesh.vertices))
        model.addVertices(mesh.vertices)
        model.addTriangles(mesh.triangles.astype(np.int32))
        model.endModel()
        return model

    def pairs(self, first, second, transforms):
        import coal

        identity, answers = coal.Transform3s.Identity(), []
        for m in transforms:
            result, pose = coal.DistanceResult(), coal.Transform3s(m[:3, :3], m[:3, 3])
            coal.distance(first, identity, second, pose, coal.DistanceRequest(), result)
            answers.append((max(result.min_distance, 0.0), result.b1, result.b2))
        return answers

    def capsules(self, mesh, segments, radius):
        import coal

        identity, answers = coal.Transform3s.Identity(), []
        for segment in segments:
            turn, centre, length = capsule_frame(segment)
            result, pose = coal.DistanceResult(), coal.Transform3s(turn, centre)
            coal.distance(mesh, identity, coal.Capsule(radius, length), pose, coal.DistanceRequest(), result)
            answers.append((max(result.min_distance, 0.0), result.b1))
        return answers


def poses(a: Mesh, b: Mesh, count: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Return far and near motions of the second mesh."""
    first, second = (p2m.Index(p2m.Scene(*mesh)) for mesh in (a, b))
    unit = diagonal(a.vertices)
    centres = [(mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2 for mesh in (a, b)]
    far = np.tile(np.eye(4), (count, 1, 1))
    near = far.copy()
    for k in range(count):
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        far[k, :3, :3] = random_rotation(rng)
        far[k, :3, 3] = centres[0] + FAR * unit * direction - far[k, :3, :3] @ centres[1]
        near[k] = far[k]
        # The mesh cannot pass through the other one in a step of the length of their distance.
        for _ in range(1000):
            gap = float(first.closest_pair(second, near[k]).distance) / unit
            if gap <= 1.1 * GAP:
                break
            near[k, :3, 3] -= (gap - GAP) * unit * direction
    return {"far": far, "near": near}


def exact_distance(corners: list[np.ndarray]) -> float:
    """Return the distance of the hulls of some vertices, correct to the last digit."""
    return float(root(squared_distance_of_hulls(*[[vector(v) for v in hull] for hull in corners])))


class Differences:
    """The differences from the first library, and the number of them in which p2m is right."""

    def __init__(self, unit: float, hulls: Callable[[int, tuple[int, ...]], list[np.ndarray]], radius: float) -> None:
        self.unit, self.hulls, self.radius = unit, hulls, radius

    def of(self, ours: list[tuple[Any, ...]], theirs: list[tuple[Any, ...]]) -> str:
        """Return the number of differences, and for how many of the first ones exact arithmetic confirms that p2m is
        right: its triangles are as near as it says, and nearer than those of the other library."""
        different = [
            k for k, (a, b) in enumerate(zip(ours, theirs)) if not abs(a[0] - b[0]) <= TOLERANCE * self.unit
        ]
        decided = different[:DECIDED]
        right = 0
        for k in decided:
            exact = max(exact_distance(self.hulls(k, ours[k][1:])) - self.radius, 0.0)
            is_ours = abs(exact - ours[k][0]) <= 1e-12 * self.unit and exact < theirs[k][0]
            if not is_ours and theirs[k][0] < exact:
                # The other library returns a smaller distance. It is wrong if its own triangles are farther apart.
                other = max(exact_distance(self.hulls(k, theirs[k][1:])) - self.radius, 0.0)
                is_ours = abs(exact - ours[k][0]) <= 1e-12 * self.unit and exact <= other
            right += is_ours
        return "0" if not different else f"{len(different)}; p2m is right in {right} of {len(decided)}"


def compare_meshes(paths: list[Path], arguments: argparse.Namespace) -> None:
    scenes = [p2m.read(path) for path in paths]
    a, b = (Mesh(scene.vertices, scene.triangles) for scene in scenes)
    unit = diagonal(a.vertices)
    b = Mesh(b.vertices * (unit / diagonal(b.vertices)), b.triangles)
    rng = np.random.default_rng(arguments.seed)
    transforms = poses(a, b, arguments.poses, rng)
    low, high = a.vertices.min(axis=0), a.vertices.max(axis=0)
    middle = low + rng.random((arguments.capsules, 3)) * (high - low)
    along = rng.normal(size=(arguments.capsules, 3))
    along *= 0.5 * LENGTH * unit / np.linalg.norm(along, axis=1, keepdims=True)
    segments = np.stack([middle - along, middle + along], axis=1)
    entrants: list[Library] = [P2m("aabb"), P2m("kdop"), Fcl(), Coal()]
    print("builds", file=sys.stderr)
    builds, kept = interleaved(
        [lambda library=library: (library.build(a), library.build(b)) for library in entrants], 3
    )
    print(f"\n{paths[0].name}, {len(a.triangles):,} triangles, and {paths[1].name}, {len(b.triangles):,} triangles\n")
    print(head(["queries", "library", "build of both, s", "a query, CPU us", "times p2m aabb", "differences"]))
    for name in ["far", "near", "capsules"]:
        print(name, file=sys.stderr)
        if name == "capsules":
            count, radius = len(segments), RADIUS * unit
            calls = [lambda i=i: entrants[i].capsules(kept[i][0], segments, radius) for i in range(len(entrants))]

            def hulls(k: int, ids: tuple[int, ...]) -> list[np.ndarray]:
                return [a.vertices[a.triangles[ids[0]]], segments[k]]

        else:
            matrices, radius = transforms[name], 0.0
            count = len(matrices)
            calls = [lambda i=i: entrants[i].pairs(*kept[i], matrices) for i in range(len(entrants))]

            def hulls(k: int, ids: tuple[int, ...]) -> list[np.ndarray]:
                m = matrices[k]
                return [a.vertices[a.triangles[ids[0]]], b.vertices[b.triangles[ids[1]]] @ m[:3, :3].T + m[:3, 3]]

        times, answers = interleaved(calls, arguments.rounds)
        differences = Differences(unit, hulls, radius)
        for library, (build, _), (time, _), answer in zip(entrants, builds, times, answers):
            different = "-" if library is entrants[0] else differences.of(answers[0], answer)
            cells = [name, library.name, f"{build:.2f}", f"{time / count * 1e6:,.1f}", f"{time / times[0][0]:.3g}"]
            print(row([*cells, different]), flush=True)


def compare_hausdorff(paths: list[Path], arguments: argparse.Namespace) -> None:
    import igl

    scenes = [p2m.read(path) for path in paths]
    (V, F), (W, G) = ((scene.vertices, scene.triangles) for scene in scenes)
    unit = diagonal(np.concatenate([V, W]))

    def ours(tolerance: float) -> Callable[[], tuple[float, float]]:
        def call() -> tuple[float, float]:
            first, second = (p2m.Index(p2m.Scene(*mesh), threads=1) for mesh in ((V, F), (W, G)))
            found = p2m.hausdorff(first, second, tolerance, threads=1)
            return found.lower_bound, found.upper_bound

        return call

    def libigl() -> tuple[float, None]:
        return igl.hausdorff(V, F, W, G), None

    print("hausdorff", file=sys.stderr)
    names = ["p2m, 1e-4 diagonals", "p2m, 1e-6 diagonals", "p2m, vertices alone", "libigl `hausdorff`, vertices alone"]
    calls = [ours(1e-4 * unit), ours(1e-6 * unit), ours(float("inf")), libigl]
    times, answers = interleaved(calls, arguments.rounds)
    print(f"\n{paths[0].name}, {len(F):,} triangles, and {paths[1].name}, {len(G):,} triangles\n")
    print(head(["Hausdorff distance", "CPU s", "times the first", "at least, diagonals", "at most, diagonals"]))
    for name, (time, _), (low, high) in zip(names, times, answers):
        most = "-" if high is None else f"{high / unit:.8f}"
        print(row([name, f"{time:.2f}", f"{time / times[0][0]:.3g}", f"{low / unit:.8f}", most]), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs=2, type=Path, help="files of triangle meshes")
    parser.add_argument("--hausdorff", nargs=2, type=Path, help="files of meshes for Hausdorff distances")
    parser.add_argument("--poses", type=int, default=40, help="poses of each kind")
    parser.add_argument("--capsules", type=int, default=2000, help="number of capsules")
    parser.add_argument("--rounds", type=int, default=5, help="rounds")
    parser.add_argument("--seed", type=int, default=1, help="seed of poses and capsules")
    arguments = parser.parse_args()
    print("python bindings/python/benchmarks/compare_pairs.py " + " ".join(sys.argv[1:]))
    print(versions(["numpy", "python-fcl", "coal", "libigl"]))
    compare_meshes(arguments.models, arguments)
    if arguments.hausdorff is not None:
        compare_hausdorff(arguments.hausdorff, arguments)


if __name__ == "__main__":
    main()
