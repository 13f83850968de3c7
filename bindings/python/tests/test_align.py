"""Tests of alignments."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import p2m

TUBE = Path(__file__).resolve().parents[3] / "scenes" / "knot_and_cables.obj"


def part() -> p2m.Scene:
    """Return a pyramid without symmetries."""
    corners = [[0, 0, 0], [5, 0, 0], [0, 3, 0], [0, 0, 2]]
    return p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def points_of(scene: p2m.Scene, count: int, sigma: float) -> np.ndarray:
    """Return points of the faces with noise."""
    rng = np.random.default_rng(5)
    weights = rng.dirichlet([1, 1, 1], count)
    points = [weights @ scene.vertices[face] for face in scene.triangles]
    return np.concatenate(points) + rng.normal(scale=sigma, size=(count * len(points), 3))


def motion() -> np.ndarray:
    """Return the matrix of a large motion."""
    matrix = np.eye(4)
    matrix[:3, :3] = [[0, -1, 0], [0.6, 0, -0.8], [0.8, 0, 0.6]]
    matrix[:3, 3] = [10, -20, 30]
    return matrix


def test_the_matrix_moves_the_scan_back_with_the_same_bits_everywhere() -> None:
    points, there = points_of(part(), 2000, 0.001), motion()
    scan = points @ there[:3, :3].T + there[:3, 3]
    found = p2m.align(scan, part())
    assert found.converged and found.ambiguity is None and found.coverage > 0.95
    np.testing.assert_allclose(found.matrix @ there, np.eye(4), atol=2e-3)
    np.testing.assert_allclose(found.points, points, atol=1e-3)
    np.testing.assert_allclose(scan @ found.matrix[:3, :3].T + found.matrix[:3, 3], found.points, atol=1e-13)
    assert found.rounds[-1][0] == len(scan) and 0.0008 < found.rms < 0.0012
    for backend, threads in [("octree", 1), ("kdop", 3)]:
        again = p2m.align(scan, p2m.Index(part(), backend), threads=threads)
        assert again.matrix.tobytes() == found.matrix.tobytes() and again.rounds == found.rounds
    # Points in f32 give the same result as their values in f64.
    rounded = scan.astype(np.float32)
    assert p2m.align(rounded, part()).matrix.tobytes() == p2m.align(rounded.astype(float), part()).matrix.tobytes()


@pytest.mark.filterwarnings("ignore:the scan can slide")
def test_options_reach_the_search() -> None:
    points, there = points_of(part(), 1000, 0.0), motion()
    scan = points @ there[:3, :3].T / 25.4 + there[:3, 3]
    found = p2m.align(scan, part(), scale=True)
    assert found.scale == pytest.approx(25.4, rel=1e-6) and found.rms < 1e-6
    scan = points @ there[:3, :3].T + there[:3, 3]
    near = p2m.align(scan, part(), search=False)
    assert np.abs(near.matrix @ there - np.eye(4)).max() > 0.1
    with pytest.raises(ValueError, match="overlap of 0"):
        p2m.align(scan, part(), overlap=0.0)
    with pytest.raises(ValueError, match="6 finite points, but the scan has 0"):
        p2m.align(np.full((9, 3), np.nan), part())


def test_an_ambiguous_pose_is_a_warning() -> None:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    box = p2m.Scene(corners, triangles=[half for a, b, c, d in quads for half in ([a, b, c], [a, c, d])])
    with pytest.warns(UserWarning, match="another pose fits about as well"):
        found = p2m.align(points_of(box, 300, 0.001), box)
    assert found.other is not None and found.other.shape == (4, 4)


def test_a_deviation_can_align_first(tmp_path: Path) -> None:
    points, there = points_of(part(), 1000, 0.001), motion()
    scan = points @ there[:3, :3].T + there[:3, 3]
    aligned = p2m.deviation(scan, part(), align=True, tolerance=0.005)
    expected = p2m.deviation(p2m.align(scan, part()).points, part())
    assert aligned.values.tobytes() == expected.values.tobytes() and aligned.statistics["rms"] < 0.0015
    # The file contains the moved scan, with its triangles.
    corners = part().vertices @ there[:3, :3].T + there[:3, 3]
    turned = p2m.Scene(np.concatenate([scan, corners]), triangles=part().triangles + len(scan))
    p2m.deviation(turned, part(), align=True).save(tmp_path / "aligned.ply")
    written = p2m.read(tmp_path / "aligned.ply")
    assert len(written.triangles) == 4 and np.abs(written.vertices[: len(points)] - points).max() < 0.002
