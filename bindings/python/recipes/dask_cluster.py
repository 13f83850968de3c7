"""Asks a saved index for the points of a Zarr array, by two processes of Dask that map the file of the index.

    pip install './bindings/python[dask]' zarr
    python bindings/python/recipes/dask_cluster.py

The tests of the package run this script.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import dask.array as da
import zarr
from distributed import Client, LocalCluster
from scene import check, random_points, save_index

import p2m.dask


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path, points = save_index(folder), random_points()
        da.from_array(points, chunks=(50_000, 3)).to_zarr(str(Path(folder) / "points.zarr"))
        files = [
            zarr.create_array(Path(folder) / f"{name}.zarr", shape=(len(points),), chunks=(50_000,), dtype=dtype)
            for name, dtype in (("distance", "f8"), ("primitive", "i8"))
        ]
        with (
            LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=folder) as cluster,
            Client(cluster),
        ):
            lazy = p2m.dask.closest(da.from_zarr(str(Path(folder) / "points.zarr")), path, map=True)
            # Both arrays are stored by one call, so each block is searched once.
            da.store([lazy.distance, lazy.primitive], files)
        check(files[0][:], files[1][:], path, points)


if __name__ == "__main__":
    main()
