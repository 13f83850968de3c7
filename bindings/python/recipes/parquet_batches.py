"""Asks a saved index for the points of a Parquet file, batch by batch, in one process with a thread for each core.

    pip install './bindings/python[arrow]'
    python bindings/python/recipes/parquet_batches.py

The points are a column of GeoArrow, which is read without a copy. The tests of the package run this script.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
from scene import check, random_points, save_index

import p2m


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path, points = save_index(folder), random_points()
        geometry = pa.FixedSizeListArray.from_arrays(pa.array(points.reshape(-1)), 3)
        pq.write_table(pa.table({"geometry": geometry}), Path(folder) / "points.parquet")

        ask = p2m.Ask(path, "geometry", threads=os.cpu_count() or 1)
        source = pq.ParquetFile(Path(folder) / "points.parquet")
        with pq.ParquetWriter(Path(folder) / "answers.parquet", ask.schema(source.schema_arrow)) as target:
            for batch in ask.iterate(source.iter_batches(batch_size=65_536)):
                target.write_batch(batch)

        answers = pq.read_table(Path(folder) / "answers.parquet")
        check(answers["distance"].to_numpy(), answers["primitive"].to_numpy(), path, points)


if __name__ == "__main__":
    main()
