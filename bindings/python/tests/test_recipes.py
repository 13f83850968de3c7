"""Runs the recipes and the benchmark for engines, whose scripts compare all answers with those of one call."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
CARRIED = PACKAGE.parents[1] / "scenes" / "knot_and_cables.obj"


def run(script: str, *arguments: str) -> str:
    """Run a script, and return what it prints."""
    if not (PACKAGE / script).exists():
        pytest.skip("the scripts are in a checkout of the repository")
    ended = subprocess.run(
        [sys.executable, str(PACKAGE / script), *arguments], capture_output=True, text=True, timeout=300
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.mark.parametrize(
    ("script", "needed"),
    [
        ("parquet_batches", ["pyarrow"]),
        ("dask_cluster", ["dask", "distributed", "zarr"]),
        ("ray_data", ["ray", "pyarrow", "pandas"]),
        ("spark_arrow", ["pyspark", "pyarrow", "pandas"]),
    ],
)
def test_recipes_have_the_same_bits(script: str, needed: list[str]) -> None:
    for package in needed:
        if importlib.util.find_spec(package) is None:
            pytest.skip(f"{package} is not installed")
    assert "200,000 answers are the same bits" in run(f"recipes/{script}.py")


def test_the_gradient_of_a_distance_is_a_direction() -> None:
    pytest.importorskip("torch")
    assert "mean square" in run("recipes/torch_distance.py")


@pytest.mark.skipif(not os.path.exists("/proc/self/smaps_rollup"), reason="the shared memory is not known here")
def test_the_benchmark_compares_all_answers() -> None:
    pytest.importorskip("distributed")
    printed = run("benchmarks/cluster.py", str(CARRIED), "--quick")
    assert printed.count("| cluster, map=") == 4 and printed.endswith("All answers are the same bits.\n")


def test_the_benchmark_of_shards_compares_all_answers() -> None:
    pytest.importorskip("distributed")
    printed = run("benchmarks/shuffle.py", "--quick")
    assert printed.count("| by block |") == printed.count("| to shards |") == 2
