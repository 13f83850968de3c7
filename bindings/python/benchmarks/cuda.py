"""Compares p2m on an NVIDIA card with Warp, in one run.

    MATURIN_PEP517_ARGS="--features cuda" pip install ./bindings/python torch warp-lang
    python bindings/python/benchmarks/cuda.py dragon_100k.obj dragon_871k.ply

For each file and four sets of queries it prints million queries per second of three things: the kernels of Warp in f32
and the kernels of p2m in f64, both on queries that are sorted along a curve (for p2m this needs torch), and whole calls
of p2m on queries in random order, from NumPy arrays and from torch tensors on the card. It also counts the wrong
answers of Warp: the true distance of the triangle that Warp returns exceeds the least distance by more than a millionth
of the diagonal. Warp gets only triangles. Times are medians of rounds, in which all take turns. Libraries that are not
installed are left out.

Without a card, `--cpu` runs everything on the processor, to try the script.
"""

from __future__ import annotations

import argparse
import importlib.util
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from common import diagonal, surface

import p2m

SETS = ("10x", "1x", "near", "surface")


def make_queries(name: str, scene: p2m.Scene, count: int) -> np.ndarray:
    """Return the queries of a set, distributed as in p2m-bench."""
    rng = np.random.default_rng(7)
    low, high = scene.bounds
    if name in ("1x", "10x"):
        half = (1.05 if name == "1x" else 10.0) * (high - low) / 2.0
        return (low + high) / 2.0 + rng.uniform(-1.0, 1.0, (count, 3)) * half
    points, normals = surface(scene.vertices, scene.triangles, count, rng)
    return points + normals * rng.normal(0.0, 0.01 * diagonal(scene.bounds), (count, 1)) * (name == "near")


def along_curve(points: np.ndarray) -> np.ndarray:
    """Return points in Morton order."""
    low, high = points.min(axis=0), points.max(axis=0)
    cells = ((points - low) / np.maximum(high - low, 1e-300) * 1023.0).astype(np.uint64)
    key = np.zeros(len(points), np.uint64)
    for bit in range(10):
        for axis in range(3):
            key |= (cells[:, axis] >> np.uint64(bit) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return points[np.argsort(key, kind="stable")]


def warp_search(scene: p2m.Scene, points: np.ndarray, device: str) -> Callable[[], tuple[float, Any]] | None:
    """Return a function by which Warp answers, and which returns the seconds of its kernel and the triangles."""
    if importlib.util.find_spec("warp") is None:
        return None
    import warp as wp

    wp.config.quiet = True

    @wp.kernel
    def search(mesh: wp.uint64, points: wp.array(dtype=wp.vec3), face: wp.array(dtype=int), out: wp.array(dtype=float)):
        i = wp.tid()
        p = points[i]
        found = wp.mesh_query_point_no_sign(mesh, p, 1.0e30)
        if found.result:
            face[i] = found.face
            out[i] = wp.length(p - wp.mesh_eval_position(mesh, found.face, found.u, found.v))
        else:
            face[i] = -1

    mesh = wp.Mesh(
        wp.array(scene.vertices.astype(np.float32), dtype=wp.vec3, device=device),
        wp.array(scene.triangles.astype(np.int32).reshape(-1), dtype=int, device=device),
    )
    queries = wp.array(points.astype(np.float32), dtype=wp.vec3, device=device)
    face = wp.empty(len(points), dtype=int, device=device)
    out = wp.empty(len(points), dtype=float, device=device)

    def run() -> tuple[float, Any]:
        wp.synchronize()
        start = time.perf_counter()
        wp.launch(search, len(points), [mesh.id, queries, face, out], device=device)
        wp.synchronize()
        return time.perf_counter() - start, face

    return run


def wrong_answers(scene: p2m.Scene, index: p2m.Index, points: np.ndarray, faces: np.ndarray) -> int:
    """Count the queries whose triangle is farther than the nearest one by more than a millionth of the diagonal."""
    rounded = points.astype(np.float32)
    nearest = index.distance(rounded)
    tolerance = 1e-6 * diagonal(scene.bounds)
    wrong = int((faces < 0).sum())
    asked = np.nonzero(faces >= 0)[0]
    # The distance from a triangle is computed as the distance from a scene of this triangle, where triangles differ.
    own = index.closest(rounded, fields="primitive").primitive
    for i in asked[own[asked] != faces[asked]]:
        corners = scene.vertices[scene.triangles[faces[i]]]
        alone = p2m.Index(p2m.Scene(corners, triangles=[[0, 1, 2]]), "brute")
        wrong += bool(alone.distance(rounded[i]) > nearest[i] + tolerance)
    return wrong


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="+")
    parser.add_argument("--queries", type=int, default=10_000_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--checked", type=int, default=20_000, help="answers of Warp that are checked")
    parser.add_argument("--cpu", action="store_true")
    arguments = parser.parse_args()
    count = arguments.queries
    print("| scene | set | Warp f32, kernel | p2m f64, kernel | NumPy, whole call | torch, whole call | "
          "by tree | by processor | wrong answers of Warp |\n|---|---|---|---|---|---|---|---|---|")
    for file in arguments.files:
        read = p2m.read(file)
        scene = p2m.Scene(read.vertices, triangles=read.triangles)
        index = p2m.Index(scene, "aabb")
        start = time.perf_counter()
        unsorted = index if arguments.cpu else index.to("cuda")
        seconds = time.perf_counter() - start
        in_order = index if arguments.cpu else index.to("cuda", reorder=False)
        for name in SETS:
            points = make_queries(name, scene, count)
            ordered = along_curve(points)
            warp = warp_search(scene, ordered, "cpu" if arguments.cpu else "cuda:0")
            tensor = ordered_tensor = None
            if importlib.util.find_spec("torch") is not None:
                import torch

                device = "cpu" if arguments.cpu else "cuda:0"
                tensor, ordered_tensor = (torch.from_numpy(array).to(device) for array in (points, ordered))

            def ask(target: Any, queries: Any) -> float:
                begin = time.perf_counter()
                target.closest(queries)
                return time.perf_counter() - begin

            def kernels() -> float:
                seconds = ask(in_order, ordered_tensor)
                return getattr(in_order, "kernel_seconds", seconds)

            ways: dict[str, Callable[[], float]] = {"numpy": lambda: ask(unsorted, points)}
            if warp is not None:
                ways["warp"] = lambda: warp()[0]
            if tensor is not None:
                ways["torch"] = lambda: ask(unsorted, tensor)
                ways["kernel"] = kernels
            times: dict[str, list[float]] = {way: [] for way in ways}
            # The first round is not measured.
            for turn in range(arguments.rounds + 1):
                for way, run in ways.items():
                    seconds_of_run = run()
                    if turn > 0:
                        times[way].append(seconds_of_run)
            rate = {way: f"{count / statistics.median(of) / 1e6:.3g}" if (of := times[way]) else "" for way in times}
            some = slice(0, count, max(count // max(arguments.checked, 1), 1))
            wrong = ""
            if warp is not None:
                faces = warp()[1].numpy()[some]
                wrong = f"{wrong_answers(scene, index, ordered[some], faces)} of {len(faces)}"
            print(f"| {file} | {name} | {rate.get('warp', '')} | {rate.get('kernel', '')} | {rate['numpy']} | "
                  f"{rate.get('torch', '')} | {getattr(unsorted, 'by_tree', '')} | "
                  f"{getattr(unsorted, 'by_processor', '')} | {wrong} |", flush=True)
        info = {} if arguments.cpu else unsorted.info
        print(f"{file}: tree, upload and lists in {seconds:.2f} s; {info}")


if __name__ == "__main__":
    main()
