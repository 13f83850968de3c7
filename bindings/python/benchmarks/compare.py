"""Compares p2m with other libraries of Python that find closest points on meshes, all in one run.

    pip install ./bindings/python[compare]
    cargo build --release -p p2m-python --example rust_batch
    python bindings/python/benchmarks/compare.py ../shared/models/dragon_100k.obj ../shared/models/dragon_871k.ply \
        --rust target/release/examples/rust_batch

In each round every library answers the same queries once, and each round begins with another library. Tables have
medians of rounds. All libraries get the same vertices and triangles. Open3D gets them and the queries as float32,
converted in advance.

Every library returns the closest points, the triangles and, except for Open3D, the distances. The errors of Open3D are
computed from the distances of `compute_distance`, which is not timed.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

# This sets the number of threads of libigl before it is imported.
from common import diagonal, head, medians, open3d_scene, rotated, row, surface, timed, versions, with_peak

import numpy as np

import p2m

NEAR_SIGMA = 0.01
"""The standard deviation of the distance of `near` queries, in diagonals of the scene."""
BOX_SCALE = 1.05
"""The size of the box of `1x` queries, in boxes of the scene."""


class Library:
    """A library with one setting."""

    name: str
    packages: tuple[str, ...]
    """The packages whose versions are printed."""
    threads = 1
    points = 1_000_000
    """The largest number of queries of a round."""
    rounds = 1000
    """The largest number of rounds."""
    builds = 1000
    """The largest number of rounds of builds."""

    def build(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        """Build what the library keeps between calls: only the mesh if it has no index."""
        self.vertices, self.triangles = vertices, triangles

    def prepare(self, points: np.ndarray) -> np.ndarray:
        """Return queries of the type that the library takes."""
        return points

    def query(self, points: np.ndarray) -> Any:
        """Return the closest points, in the form of the library."""
        raise NotImplementedError

    def distances(self, points: np.ndarray, answer: Any) -> np.ndarray:
        """Return the distances of an answer to queries."""
        raise NotImplementedError


class P2m(Library):
    packages = ("p2m",)

    def __init__(self, backend: str, threads: int = 1, resolution: float | None = None) -> None:
        self.backend, self.threads, self.resolution = backend, threads, resolution
        self.name = f"p2m {backend}" + ("" if resolution is None else f", resolution {resolution:g}")

    def build(self, vertices, triangles):
        scene = p2m.Scene(vertices, triangles)
        self.index = p2m.Index(scene, self.backend, threads=self.threads, resolution=self.resolution)

    def query(self, points):
        return self.index.closest(points, fields=("distance", "primitive", "point"))

    def distances(self, points, answer):
        return answer.distance


class Open3d(Library):
    packages = ("open3d",)

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.name = "Open3D `RaycastingScene` (f32)"

    def build(self, vertices, triangles):
        self.scene = open3d_scene(vertices, triangles, self.threads)
        # The scene is built by the first query.
        self.scene.compute_closest_points(np.zeros((1, 3), np.float32), nthreads=self.threads)

    def prepare(self, points):
        import open3d

        return open3d.core.Tensor.from_numpy(points.astype(np.float32))

    def query(self, points):
        return self.scene.compute_closest_points(points, nthreads=self.threads)

    def distances(self, points, answer):
        return self.scene.compute_distance(points).numpy().astype(np.float64)


class IglFunction(Library):
    name = "libigl `point_mesh_squared_distance`"
    packages = ("libigl",)
    rounds = 3

    def query(self, points):
        import igl

        return igl.point_mesh_squared_distance(points, self.vertices, self.triangles)

    def distances(self, points, answer):
        return np.sqrt(answer[0])


class IglTree(Library):
    name = "libigl `AABB`, kept"
    packages = ("libigl",)
    points = 200_000

    def build(self, vertices, triangles):
        import igl

        super().build(vertices, triangles)
        self.tree = igl.AABB()
        self.tree.init(vertices, triangles)

    def query(self, points):
        return self.tree.squared_distance(self.vertices, self.triangles, points)

    def distances(self, points, answer):
        return np.sqrt(answer[0])


class PointCloudUtils(Library):
    name = "point-cloud-utils `closest_points_on_mesh`"
    packages = ("point-cloud-utils",)
    rounds = 3

    def query(self, points):
        import point_cloud_utils

        return point_cloud_utils.closest_points_on_mesh(points, self.vertices, self.triangles)

    def distances(self, points, answer):
        return np.asarray(answer[0])


class Trimesh(Library):
    name = "trimesh `closest_point`"
    packages = ("trimesh", "rtree")
    points = 2_000
    rounds = 3
    builds = 1

    def build(self, vertices, triangles):
        import trimesh

        self.mesh = trimesh.Trimesh(vertices, triangles, process=False)
        # The first query would build this.
        trimesh.proximity.closest_point(self.mesh, vertices[:1])

    def query(self, points):
        import trimesh

        return trimesh.proximity.closest_point(self.mesh, points)

    def distances(self, points, answer):
        return answer[1]


def libraries() -> list[Library]:
    """Return all libraries, in the order of the table."""
    return [
        P2m("octree"),
        P2m("aabb"),
        Open3d(1),
        IglFunction(),
        IglTree(),
        PointCloudUtils(),
        Trimesh(),
        P2m("octree", threads=2),
        P2m("aabb", threads=2),
        Open3d(2),
    ]


class RustBatch:
    """A program in Rust that answers the same batch each time it reads a line."""

    def __init__(self, program: Path, model: Path, points: Path, library: P2m) -> None:
        command = [str(program), str(model), str(points), library.backend, str(library.threads)]
        self.library = library
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.run()

    def run(self) -> tuple[float, float]:
        """Return the CPU time and the wall time of a batch, in seconds."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        cpu, wall, _ = map(float, self.process.stdout.readline().split())
        return cpu, wall

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait()


def near(vertices: np.ndarray, triangles: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points of the surface, evenly distributed over its area, moved along the normal."""
    points, normals = surface(vertices, triangles, count, rng)
    sigma = NEAR_SIGMA * diagonal(vertices[triangles].reshape(-1, 3))
    return points + normals * rng.normal(scale=sigma, size=(count, 1))


def in_box(vertices: np.ndarray, triangles: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points that are evenly distributed in the box."""
    used = vertices[triangles].reshape(-1, 3)
    low, high = used.min(axis=0), used.max(axis=0)
    return (low + high) / 2 + rng.uniform(-1, 1, (count, 3)) * (high - low) / 2 * BOX_SCALE


SETS = {"near": near, "1x": in_box}


def print_peak_memory(number: int, arrays: str) -> None:
    """Print the peak memory of one library besides its input and the imported modules."""
    library = libraries()[number]
    with np.load(arrays) as loaded:
        vertices, triangles, points = (loaded[name] for name in ("vertices", "triangles", "points"))
    # The first build and query import the library and start its threads, which is not measured.
    small = np.eye(3), np.array([[0, 1, 2]])
    library.build(*small)
    library.query(library.prepare(np.zeros((1, 3))))
    library.build(*small)
    queries = library.prepare(points[: library.points])

    def work() -> None:
        library.build(vertices, triangles)
        library.query(queries)

    print(with_peak(work)[2])


def peak_memory(number: int, arrays: Path) -> int | None:
    """Return the peak memory of one library in its own process, or nothing if it cannot be measured."""
    command = [sys.executable, __file__, "--memory-of", str(number), "--arrays", str(arrays)]
    if not Path("/proc/self/clear_refs").exists():
        return None
    return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def measure(model: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Measure all libraries on a model."""
    scene = p2m.read(model)
    vertices, triangles = scene.vertices, scene.triangles
    rng = np.random.default_rng(arguments.seed)
    entrants = libraries()
    result: dict[str, Any] = {"model": model.name, "triangles": len(triangles), "rows": [], "rust": []}

    log(f"{model.name}: building")
    builds: list[list[tuple[float, float]]] = [[] for _ in entrants]
    for number in range(arguments.builds):
        for i, library in enumerate(entrants):
            if number >= library.builds:
                continue
            cpu, wall, _ = timed(lambda library=library: library.build(vertices, triangles))
            builds[i].append((cpu, wall))
    for library, times in zip(entrants, builds):
        cpu, wall = medians(times)
        result["rows"].append({"name": library.name, "threads": library.threads, "build_cpu": cpu, "build_wall": wall})
    truth_index = p2m.Index(scene, "octree")
    unit = diagonal(vertices[triangles].reshape(-1, 3))
    with tempfile.TemporaryDirectory() as folder:
        for name, generate in SETS.items():
            points = generate(vertices, triangles, arguments.points, rng)
            truth = truth_index.closest(points, certified=True, fields="distance").distance
            prepared = [library.prepare(points[: library.points]) for library in entrants]
            programs = []
            if arguments.rust is not None:
                file = Path(folder) / f"{name}.f64"
                points.tofile(file)
                programs = [RustBatch(arguments.rust, model, file, e) for e in entrants if is_plain(e)]
            times: list[list[tuple[float, float]]] = [[] for _ in entrants]
            rust_times: list[list[tuple[float, float]]] = [[] for _ in programs]
            for number in range(arguments.rounds):
                log(f"{model.name}: {name}, round {number + 1}")
                for i in rotated(len(entrants), number):
                    library, queries = entrants[i], prepared[i]
                    if number >= library.rounds:
                        continue
                    cpu, wall, answer = timed(lambda library=library, queries=queries: library.query(queries))
                    times[i].append((cpu, wall))
                    if number == 0:
                        found = library.distances(queries, answer)
                        error = float(np.abs(found - truth[: len(found)]).max()) / unit
                        result["rows"][i][name] = {"error": error, "points": len(found)}
                    del answer
                    for program, measured in zip(programs, rust_times):
                        if program.library is library:
                            measured.append(program.run())
            for entry, measured in zip(result["rows"], times):
                own, (cpu, wall) = entry[name], medians(measured)
                own["cpu"], own["wall"], own["rounds"] = cpu / own["points"], wall / own["points"], len(measured)
            for program, measured in zip(programs, rust_times):
                program.close()
                library = program.library
                mine = times[entrants.index(library)]
                ratios = [python[0] / rust[0] for python, rust in zip(mine, measured)]
                walls = [python[1] / rust[1] for python, rust in zip(mine, measured)]
                result["rust"].append(
                    {
                        "name": library.name,
                        "threads": library.threads,
                        "set": name,
                        "cpu": medians(measured)[0] / len(points),
                        "overhead_cpu": statistics.median(ratios) - 1,
                        "overhead_wall": statistics.median(walls) - 1,
                    }
                )
            if name == "1x":
                arrays = Path(folder) / "arrays.npz"
                np.savez(arrays, vertices=vertices, triangles=triangles, points=points)
        del entrants, prepared, truth_index
        for i, entry in enumerate(result["rows"]):
            log(f"{model.name}: memory of {entry['name']}")
            entry["memory"] = peak_memory(i, arrays)
    return result


def is_plain(library: Library) -> bool:
    """Return whether the Rust program measures this index too."""
    return isinstance(library, P2m) and library.resolution is None


def log(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def table(result: dict[str, Any]) -> str:
    """Return the measurements of a model as a table in Markdown."""
    columns = ["library", "threads", "build, s"]
    for name in SETS:
        columns += [f"{name}, CPU ns", f"{name}, wall ns", f"{name}, times p2m octree"]
    lines = [head([*columns, "largest error", "points", "rounds", "peak memory, MB"])]
    ours = {entry["threads"]: entry for entry in reversed(result["rows"]) if entry["name"] == "p2m octree"}
    for entry in result["rows"]:
        # With several threads, wall times are compared.
        kind = "wall" if entry["threads"] > 1 else "cpu"
        build = entry[f"build_{kind}"]
        cells = [entry["name"], entry["threads"], f"{build:.2f}" if build > 1e-3 else "in each call"]
        for name in SETS:
            measured = entry[name]
            ratio = measured[kind] / ours[entry["threads"]][name][kind]
            cells += [f"{measured['cpu'] * 1e9:,.0f}", f"{measured['wall'] * 1e9:,.0f}", f"{ratio:,.3g}"]
        largest = max(entry[name]["error"] for name in SETS)
        memory = "-" if entry.get("memory") is None else f"{entry['memory'] / 1e6:,.0f}"
        lines.append(row([*cells, f"{largest:.0e}", f"{entry['near']['points']:,}", entry["near"]["rounds"], memory]))
    return "\n".join(lines)


def rust_table(results: list[dict[str, Any]]) -> str:
    """Return a table in Markdown: the cost of calls from Python relative to the same batches in Rust."""
    lines = [
        head(["model", "set", "backend", "threads", "Rust, CPU ns", "Python, more CPU time", "Python, more wall time"])
    ]
    for result in results:
        for entry in result["rust"]:
            more = [f"{100 * entry[kind]:+.1f} %" for kind in ("overhead_cpu", "overhead_wall")]
            backend, time = entry["name"].removeprefix("p2m "), f"{entry['cpu'] * 1e9:,.0f}"
            lines.append(row([result["model"], entry["set"], backend, entry["threads"], time, *more]))
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", type=Path, help="files of triangle meshes")
    parser.add_argument("--points", type=int, default=1_000_000, help="queries in a round")
    parser.add_argument("--rounds", type=int, default=5, help="rounds; slow libraries have 3")
    parser.add_argument("--builds", type=int, default=3, help="rounds of builds")
    parser.add_argument("--seed", type=int, default=1, help="seed of the queries")
    parser.add_argument("--rust", type=Path, help="the program of the example rust_batch")
    parser.add_argument("--json", type=Path, help="file that receives all measurements")
    parser.add_argument("--memory-of", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--arrays", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.memory_of is not None:
        return print_peak_memory(arguments.memory_of, arguments.arrays)
    if not arguments.models:
        parser.error("no models")
    print("python bindings/python/benchmarks/compare.py " + " ".join(sys.argv[1:]))
    print(versions(sorted({package for library in libraries() for package in library.packages} | {"numpy"})))
    results = []
    for model in arguments.models:
        result = measure(model, arguments)
        results.append(result)
        if arguments.json is not None:
            arguments.json.write_text(json.dumps(results, indent=1) + "\n")
        print(f"\n{result['model']}, {result['triangles']:,} triangles\n\n{table(result)}", flush=True)
    if arguments.rust is not None:
        print(f"\n{rust_table(results)}")


if __name__ == "__main__":
    main()
