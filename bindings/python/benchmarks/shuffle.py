"""Measures p2m.dask with shuffling, beside blocks that each ask all shards, with two worker processes.

    pip install './bindings/python[dask]'
    python bindings/python/benchmarks/shuffle.py

The scene and the points are uniform in a cube, so each block needs all shards. In the first runs one shard fits into
the memory of a worker, and in the last ones all do. All answers are compared bit for bit. `--quick` takes 2,000 points.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import dask.array as da
import numpy as np
from distributed import Client, LocalCluster

import p2m
import p2m.dask

BLOCKS = 20


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--triangles", type=int, default=500_000)
    parser.add_argument("--shard-bytes", type=int, default=1_800_000)
    parser.add_argument("--quick", action="store_true", help="2,000 points and 2,000 triangles, for tests")
    options = parser.parse_args()
    if options.quick:
        options.points, options.triangles, options.shard_bytes = 2_000, 2_000, 60_000
    return options


def loads_of(shards: p2m.Shards) -> int:
    """Return the number of times that this process has loaded a shard."""
    return shards.loads


def main() -> None:
    options = parse()
    rng = np.random.default_rng(1)
    corners = rng.uniform(size=(options.triangles, 1, 3)) + 0.02 * rng.uniform(size=(options.triangles, 3, 3))
    scene = p2m.Scene(corners.reshape(-1, 3), triangles=np.arange(3 * options.triangles).reshape(-1, 3))
    rows = rng.uniform(size=(options.points, 3))
    with (
        tempfile.TemporaryDirectory() as folder,
        LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, memory_limit=0, local_directory=folder
        ) as cluster,
        Client(cluster) as client,
    ):
        site, file = Path(folder) / "site", Path(folder) / "points.npy"
        expected = p2m.write_shards(scene, site, options.shard_bytes).closest(rows)
        np.save(file, rows)
        points = da.from_array(np.load(file, mmap_mode="r"), chunks=(options.points // BLOCKS, 3))
        print("| shards in memory | points go | tasks | seconds | loads of shards |")
        print("| --- | --- | --- | --- | --- |")
        # Each run has another limit, so that its processes open the shards anew.
        for name, limits in [("one", (1, 2)), ("all", (1 << 40, 1 << 41))]:
            for limit, shuffle in zip(limits, (False, True)):
                shards = p2m.Shards(site, limit)
                lazy = p2m.dask.closest(points, shards, shuffle=shuffle)
                start = time.perf_counter()
                found = lazy.compute()
                seconds = time.perf_counter() - start
                assert all(found[field].tobytes() == expected[field].tobytes() for field in found.fields)
                loads = sum(client.run(loads_of, shards).values())
                way, tasks = "to shards" if shuffle else "by block", len(lazy.distance.dask)
                print(f"| {name} of {len(shards.shards)} | {way} | {tasks:,} | {seconds:.1f} | {loads:,} |")


if __name__ == "__main__":
    main()
