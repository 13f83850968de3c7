"""Draws the charts of the README from the data in docs/measurements.

    pip install matplotlib
    python bindings/python/gallery/charts.py

The data are made by these commands:

    cargo run --release -p p2m-bench -- tables
    cargo run --release --bin p2m -- tradeoff ../shared/models/dragon_100k.obj --random 20000 \\
        --csv docs/measurements/tradeoff_dragon.csv
"""

from __future__ import annotations

import csv
import os
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")

import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT / "docs" / "measurements"
PICTURES = ROOT / "docs" / "pictures"
OURS, THEIRS, INK = "#2f6f9f", "#b9bec4", "#222222"

plt.rcParams.update({"font.size": 10, "svg.fonttype": "none", "svg.hashsalt": "p2m", "text.color": INK})


def rows(name: str) -> list[dict[str, str]]:
    """Return the rows of a file of data, without its comments."""
    with (DATA / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def save(figure: plt.Figure, name: str) -> None:
    figure.savefig(PICTURES / name, metadata={"Date": None}, bbox_inches="tight", transparent=False)
    plt.close(figure)


def speed() -> None:
    """Draw the time per query of indexes and of other libraries, in and near the box of the large dragon."""
    scene = "dragon_871k"
    table = {row["index"]: row for row in rows("speed.csv") if row["scene"] == scene}
    names = {
        "octree-batch": "p2m octree, batch",
        "octree": "p2m octree",
        "aabb-batch": "p2m AABB tree, batch",
        "aabb": "p2m AABB tree",
        "parry3d": "parry3d 0.31, f32",
        "bvh": "bvh 0.12, our distances",
    }
    sets = {"1x ns": "in the box", "near ns": "near the surface"}
    figure, axes = plt.subplots(1, len(sets), figsize=(9, 2.6), sharey=True)
    for axis, (column, title) in zip(axes, sets.items(), strict=True):
        shown = [(label, float(table[name][column])) for name, label in names.items() if table.get(name, {}).get(column)]
        labels, values = [label for label, _ in shown][::-1], [value for _, value in shown][::-1]
        colours = [OURS if label.startswith("p2m") else THEIRS for label in labels]
        bars = axis.barh(labels, values, color=colours)
        axis.bar_label(bars, [f"{value:,.0f}" for value in values], padding=3)
        axis.set_title(title)
        axis.set_xlim(0, 1.18 * max(values))
        axis.set_xticks([])
        axis.spines[["top", "right", "bottom"]].set_visible(False)
    figure.suptitle("ns per query on one thread, 871,414 triangles (less is better)", y=1.06)
    save(figure, "speed.svg")


def trade() -> None:
    """Draw the largest relative error against the time of each setting of two indexes."""
    figure, axis = plt.subplots(figsize=(9, 3.2))
    for backend, colour, below in (("octree", OURS, -11), ("aabb", "#d9822b", 5)):
        settings = [row for row in rows("tradeoff_dragon.csv") if row["backend"] == backend]
        points = [row for row in settings if not row["setting"].startswith("max visits")]
        errors = [max(float(row["error_relative_max"] or 0), 1e-17) for row in points]
        values = list(zip(errors, (float(row["ns_median"]) for row in points), (row["setting"] for row in points), strict=True))
        label = f"p2m {backend}"
        axis.plot([error for error, _, _ in values], [time for _, time, _ in values], "o", color=colour, label=label)
        for error, time, setting in values:
            axis.annotate(setting, (error, time), xytext=(4, below), textcoords="offset points", fontsize=7, color=INK)
    axis.set_xscale("log")
    axis.set_ylim(bottom=0)
    axis.set_xlabel("largest relative error of the distance (1e-17: none)")
    axis.set_ylabel("ns per query")
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend(frameon=False)
    save(figure, "trade.svg")


if __name__ == "__main__":
    speed()
    trade()
