"""Asks a saved index for the points of a data frame of Spark, by batches of Arrow in two processes of Python.

    pip install './bindings/python[arrow]' pyspark pandas
    python bindings/python/recipes/spark_arrow.py

It needs Java 17 or newer. The tests of the package run this script only where PySpark is installed.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from pyspark.sql import SparkSession
from scene import check, random_points, save_index

import p2m


def main() -> None:
    # Spark starts the Python that this variable names, in which p2m has to be installed.
    os.environ["PYSPARK_PYTHON"] = sys.executable
    spark = SparkSession.builder.master("local[2]").config("spark.ui.enabled", "false").getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    with tempfile.TemporaryDirectory() as folder:
        path, points = save_index(folder), random_points()
        table = pa.table({"row": np.arange(len(points)), **{axis: points[:, k] for k, axis in enumerate("xyz")}})
        pq.write_table(table, Path(folder) / "points.parquet")

        frame = spark.read.parquet(f"{folder}/points.parquet").repartition(4)
        ask = p2m.Ask(path, map=True)
        answers = frame.mapInArrow(ask.iterate, ask.spark_schema(frame.schema))
        found = answers.orderBy("row").toPandas()
        check(found["distance"].to_numpy(), found["primitive"].to_numpy(), path, points)
    spark.stop()


if __name__ == "__main__":
    main()
