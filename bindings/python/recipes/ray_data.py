"""Asks a saved index for the points of Parquet files, by two actors of Ray Data, each of which opens the file once.

    pip install './bindings/python[arrow]' ray pandas
    python bindings/python/recipes/ray_data.py

The tests of the package run this script only where Ray is installed.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import ray
from scene import check, random_points, save_index

import p2m


def main() -> None:
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    with tempfile.TemporaryDirectory() as folder:
        path, points = save_index(folder), random_points()
        table = pa.table({"row": np.arange(len(points)), **{axis: points[:, k] for k, axis in enumerate("xyz")}})
        (Path(folder) / "points").mkdir()
        for part in range(4):
            rows = table.slice(part * len(points) // 4, len(points) // 4)
            pq.write_table(rows, Path(folder) / "points" / f"{part}.parquet")

        answers = ray.data.read_parquet(f"{folder}/points").map_batches(
            p2m.Ask,
            fn_constructor_args=[path],
            fn_constructor_kwargs={"map": True},
            batch_format="pyarrow",
            batch_size=16_384,
            # Actors that take all processors leave none for the tasks that read, and the job never begins.
            num_cpus=0.5,
            compute=ray.data.ActorPoolStrategy(size=2),
        )
        found = answers.to_pandas().sort_values("row")
        check(found["distance"].to_numpy(), found["primitive"].to_numpy(), path, points)
    ray.shutdown()


if __name__ == "__main__":
    main()
