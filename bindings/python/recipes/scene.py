"""The saved index and the points that the recipes share."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import p2m

CARRIED = Path(__file__).resolve().parents[3] / "scenes" / "knot_and_cables.obj"


def save_index(folder: str | Path) -> str:
    """Save an index of the carried scene in a folder, and return its path."""
    path = Path(folder) / "knot.p2m"
    p2m.Index(p2m.read(CARRIED)).save(path)
    return str(path)


def random_points(count: int = 200_000) -> np.ndarray:
    """Return points in a box around the scene, as an array of shape (count, 3)."""
    return np.random.default_rng(1).uniform(-4, 4, (count, 3))


def check(distance: np.ndarray, primitive: np.ndarray, path: str, points: np.ndarray) -> None:
    """Check that answers are the same bits as those of one call in this process."""
    expected = p2m.load(path).closest(points)
    assert distance.dtype == np.float64 and distance.tobytes() == expected.distance.tobytes()
    assert np.array_equal(primitive, expected.primitive)
    print(f"{len(points):,} answers are the same bits as those of one call")
