"""Draws the charts of the README from the data in docs/measurements.

    pip install matplotlib
    python bindings/python/gallery/charts.py

The data are made by these commands:

    cargo run --release -p p2m-bench -- tables
    cargo run --release -p p2m-cli -- tradeoff ../shared/models/dragon_100k.obj --random 20000 \\
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
        shown = [
            (label, float(table[name][column])) for name, label in names.items() if table.get(name, {}).get(column)
        ]
        labels, values = [label for label, _ in shown][::-1], [value for _, value in shown][::-1]
        colours = [OURS if label.startswith("p2m") else THEIRS for label in labels]
        bars = axis.barh(labels, values, color=colours)
        axis.bar_label(bars, [f"{value:,.0f}" for value in values], padding=3)
        axis.set(title=title, xlim=(0, 1.18 * max(values)), xticks=[])
        axis.spines[["top", "right", "bottom"]].set_visible(False)
    figure.suptitle("ns per query on one thread, 871,414 triangles (less is better)", y=1.06)
    save(figure, "speed.svg")


def trade() -> None:
    """Draw the time per query of each setting that guarantees an error, for two indexes."""
    guarantees = {
        "certified": "exact,\nrounded once",
        "default": "exact,\nup to rounding",
        "epsilon 0.001": "error of\nat most 0.1 %",
        "epsilon 0.01": "at most 1 %",
        "epsilon 0.1": "at most 10 %",
        "epsilon 1": "at most 100 %",
    }
    figure, axis = plt.subplots(figsize=(9, 3.2))
    table = {(row["backend"], row["setting"]): float(row["ns_median"]) for row in rows("tradeoff_dragon.csv")}
    octree, aabb = ([table[backend, setting] for setting in guarantees] for backend in ("octree", "aabb"))
    for name, colour, times, others in (("octree", OURS, octree, aabb), ("aabb", "#d9822b", aabb, octree)):
        axis.plot(times, "o-", color=colour, label=f"p2m {name}", linewidth=1.3)
        for at, (time, other) in enumerate(zip(times, others, strict=True)):
            beside = (0, 7 if time > other else -15)
            axis.annotate(
                f"{time:,.0f}", (at, time), xytext=beside, textcoords="offset points", ha="center", color=colour
            )
    axis.set_xticks(
        range(len(guarantees)), [f"{setting}\n{text}" for setting, text in guarantees.items()], fontsize=8.5
    )
    axis.set_ylim(bottom=0)
    axis.set(xlim=(-0.5, len(guarantees) - 0.5), ylabel="ns per query")
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend(frameon=False)
    save(figure, "trade.svg")


if __name__ == "__main__":
    speed()
    trade()
