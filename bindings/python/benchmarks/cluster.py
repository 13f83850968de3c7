"""Measures p2m.dask with one and two worker processes, beside one call in this process, and the memory of workers.

    pip install './bindings/python[dask]'
    python bindings/python/benchmarks/cluster.py MODEL --points 10000000

It needs Linux, whose kernel reports the shared memory of processes. The points are uniform in the box of the model, and
workers read them from files, one for each block. All answers are compared bit for bit with those of the one call.
`--quick` takes 200,000 points.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Any

import dask.array as da
import numpy as np
from distributed import Client, LocalCluster, wait

import p2m
import p2m.dask
from p2m._index_cache import open_index

BLOCK_POINTS = 250_000
MEGABYTE = 1 << 20


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", help="a file that p2m.read reads")
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--quick", action="store_true", help="200,000 points, for tests")
    parser.add_argument("--backend", default="aabb")
    return parser.parse_args()


def memory() -> dict[str, int]:
    """Return the memory of this process in bytes: all pages, and the pages of this process alone."""
    amounts = {}
    for line in Path("/proc/self/smaps_rollup").read_text().splitlines()[1:]:
        name, amount = line.split()[:2]
        amounts[name.rstrip(":")] = int(amount) * 1024
    return {
        "Rss": amounts["Rss"],
        "Pss": amounts["Pss"],
        "Private": amounts["Private_Clean"] + amounts["Private_Dirty"],
    }


def memory_of_opening(path: str, is_mapped: bool) -> dict[str, int]:
    """Open an index and query it, so that its pages are in memory, and return the memory that was added."""
    before = memory()
    index = open_index(path, map=is_mapped)
    low, high = index.scene.bounds
    index.distance(np.random.default_rng(2).uniform(low, high, (200_000, 3)), threads=1)
    return {name: amount - before[name] for name, amount in memory().items()}


def save_points(folder: Path, bounds: np.ndarray, count: int) -> np.ndarray:
    """Save points in a file for each block, and return all of them."""
    points = np.random.default_rng(1).uniform(*bounds, (count, 3))
    da.to_npy_stack(str(folder), da.from_array(points, chunks=(BLOCK_POINTS, 3)))
    return points


def measure_cluster(workers: int, path: str, folder: Path, expected: Any, is_mapped: bool) -> float:
    """Answer all points by a cluster, compare the answers, print the memory, and return the points per second."""
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None, memory_limit=0) as cluster,
        Client(cluster) as client,
    ):
        added = client.run(memory_of_opening, path, is_mapped)
        client.run(p2m.clear_opened)
        points = da.from_npy_stack(str(folder))
        start = time.perf_counter()
        answer = p2m.dask.closest(points, path, map=is_mapped).persist()
        wait(list(answer))
        seconds = time.perf_counter() - start
        found = answer.compute()
        for name in found.fields:
            assert found[name].tobytes() == expected[name].tobytes(), f"the cluster has another {name}"
    throughput = len(expected.distance) / seconds
    print(f"| cluster, map={is_mapped} | {workers} | {throughput:,.0f} | ", end="")
    means = {name: sum(amounts[name] for amounts in added.values()) / len(added) for name in ("Rss", "Pss", "Private")}
    print(" | ".join(f"{means[name] / MEGABYTE:.1f}" for name in means), "|", flush=True)
    return throughput


def main() -> None:
    options = parse()
    count = 200_000 if options.quick else options.points
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "index.p2m")
        p2m.Index(p2m.read(options.model), options.backend).save(path)
        index = p2m.load(path)
        points = save_points(Path(folder) / "points", index.scene.bounds, count)
        size = Path(path).stat().st_size / MEGABYTE
        print(f"{Path(options.model).name}, {index.backend}, a file of {size:.1f} MB, {count:,} points")
        print("| run | processes or threads | points per second | Rss, MB | Pss, MB | Private, MB |")
        print("| --- | --- | --- | --- | --- | --- |")
        expected: Any = None
        for threads in (1, 2):
            start = time.perf_counter()
            answer = index.closest(points, threads=threads)
            print(f"| one call | {threads} | {count / (time.perf_counter() - start):,.0f} | - | - | - |", flush=True)
            if expected is not None:
                assert answer.distance.tobytes() == expected.distance.tobytes()
            expected = answer
        del points
        for workers in (1, 2):
            for is_mapped in (False, True):
                measure_cluster(workers, path, Path(folder) / "points", expected, is_mapped)
    print("All answers are the same bits.")


if __name__ == "__main__":
    main()
