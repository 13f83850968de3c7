"""Tests of deviations against NumPy and the program."""

from __future__ import annotations

import builtins
import json
import os
import subprocess
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import p2m

SCENES = Path(__file__).resolve().parents[3] / "scenes"


def cube(size: float = 2.0, offset: float = 0.0) -> p2m.Scene:
    """Return a closed cube whose triangles face outwards."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float) * size + offset
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return p2m.Scene(corners, triangles=[part for a, b, c, d in quads for part in ([a, b, c], [a, c, d])])


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_noise_on_a_face_is_its_statistics(offset: float, dtype: type) -> None:
    rng = np.random.default_rng(3)
    noise = rng.normal(scale=0.01, size=5000)
    points = np.column_stack([rng.uniform(0.5, 1.5, (5000, 2)), 2.0 + noise]) + offset
    points = points.astype(dtype)
    expected = points[:, 2].astype(float) - (2.0 + offset)
    found = p2m.deviation(points, cube(offset=offset), tolerance=0.015)
    assert np.abs(found.values - expected).max() <= 1e-15 * (1.0 + 4.0 * offset)
    statistics = found.statistics
    values = found.values
    assert (statistics["count"], statistics["missing"]) == (5000, 0)
    assert np.isclose(statistics["mean"], values.mean(), rtol=1e-9, atol=1e-18)
    assert np.isclose(statistics["rms"], np.sqrt(np.mean(values**2)), rtol=1e-12)
    assert np.isclose(statistics["standard_deviation"], values.std(), rtol=1e-9)
    assert np.isclose(statistics["mean_absolute"], np.abs(values).mean(), rtol=1e-12)
    for percent in (1, 5, 25, 50, 75, 95, 99):
        assert np.isclose(statistics[f"percentile_{percent}"], np.percentile(values, percent), rtol=1e-9, atol=1e-15)
        of_absolute = np.percentile(np.abs(values), percent)
        assert np.isclose(statistics[f"absolute_percentile_{percent}"], of_absolute, rtol=1e-9, atol=1e-15)
    assert found.outside() == ((values > 0.015).sum(), (values < -0.015).sum())
    assert found.outside(0.0)[0] == (expected > 0).sum()


def test_scans_without_deviations_have_nan() -> None:
    found = p2m.deviation(np.array([[1.0, 1.0, 3.0], [np.nan, 0.0, 0.0], [np.inf, 0.0, 0.0]]), cube())
    assert found.values[0] == 1.0
    assert np.isnan(found.values[1:]).all()
    assert (found.statistics["count"], found.statistics["missing"]) == (1, 2)
    empty = p2m.deviation(np.empty((0, 3)), cube())
    assert (len(empty.values), empty.limit, np.isnan(empty.statistics["mean"])) == (0, 1.0, True)
    same = p2m.deviation(cube(), cube())
    assert (same.statistics["rms"], len(same.values)) == (0.0, 8)
    nothing = p2m.deviation([[0.0, 0.0, 0.0]], p2m.Scene(np.empty((0, 3))), sign=None)
    assert nothing.statistics["missing"] == 1


def test_signs_are_those_that_are_asked_for() -> None:
    whole = cube()
    hole = p2m.Scene(whole.vertices, triangles=whole.triangles[:-2])
    with pytest.warns(UserWarning, match="the surface is open"):
        found = p2m.deviation([[1.0, 1.0, 0.5]], hole)
    assert found.values[0] == -0.5
    with pytest.raises(ValueError, match="open"):
        p2m.deviation([[1.0, 1.0, 0.5]], hole, sign="parity")
    cables = p2m.Scene([[0, 0, 0], [4, 0, 0]], segments=[[0, 1]])
    with pytest.raises(ValueError, match="no side"):
        p2m.deviation([[1.0, 1.0, 0.5]], cables)
    assert p2m.deviation([[1.0, 3.0, 4.0]], cables, sign=None).values[0] == 5.0
    for wrong in ({"sign": "normal"}, {"tolerance": -1.0}, {"limit": float("nan")}):
        with pytest.raises(ValueError):
            p2m.deviation([[1.0, 3.0, 4.0]], cables, **wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="instead of"):
        p2m.deviation([1.0, 3.0, 4.0], cables)


def test_pages_and_files_have_the_deviations(tmp_path: Path) -> None:
    found = p2m.deviation(cube(2.5), cube(), limit=1.0, unit="mm")
    found.save(tmp_path / "page.html", up="y")
    html = (tmp_path / "page.html").read_text(encoding="utf-8")
    data = json.loads(html.split('id="data">')[1].split("</script>")[0])
    assert (data["deviations"]["total"], data["unit"], data["up"]) == (8, "mm", "y")
    found.save(tmp_path / "scan.ply")
    scan = p2m.read(tmp_path / "scan.ply")
    assert np.array_equal(scan.vertices, cube(2.5).vertices)
    assert len(scan.triangles) == 12
    points = p2m.deviation(np.array([[1.0, 1.0, 3.0], [np.nan, 0.0, 0.0]]), cube())
    points.save(tmp_path / "page.html")
    with pytest.raises(ValueError, match="does not end in"):
        found.save(tmp_path / "scan.txt")


def test_figures_need_matplotlib(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = p2m.deviation(cube(2.5), cube(), tolerance=0.1)
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        pass
    else:
        figure = found.figure()
        figure.savefig(tmp_path / "figure.png")
        assert (tmp_path / "figure.png").stat().st_size > 10_000
    imported = builtins.__import__

    def without(name: str, *rest: Any, **options: Any) -> Any:
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return imported(name, *rest, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="pip install matplotlib"):
        found.figure()


def test_the_program_has_the_same_statistics(tmp_path: Path) -> None:
    program = os.environ.get("P2M_PROGRAM")
    if program is None:
        pytest.skip("P2M_PROGRAM does not name the program")
    np.save(tmp_path / "scan.npy", np.random.default_rng(5).uniform(-1.0, 3.0, (2000, 3)))
    lines = [f"v {x} {y} {z}" for x, y, z in cube().vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in cube().triangles]
    (tmp_path / "cube.obj").write_text("\n".join(lines))
    command = [program, "deviation", tmp_path / "scan.npy", tmp_path / "cube.obj", "--json"]
    report = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    statistics = p2m.deviation(np.load(tmp_path / "scan.npy"), p2m.read(tmp_path / "cube.obj")).statistics
    assert report["statistics"] == {key: value for key, value in statistics.items() if key not in ("count", "missing")}


def test_a_table_has_the_points_and_their_deviations(tmp_path: Path) -> None:
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    found = p2m.deviation([[0.125, 0.25, 0.25], [np.nan, 0, 0], [0.25, -0.5, 0.25]], solid)
    found.save(tmp_path / "a.csv")
    rows = (tmp_path / "a.csv").read_text().splitlines()
    assert rows[0] == "qx,qy,qz,x,y,z,distance,signed_distance,primitive,feature"
    assert rows[1] == "0.125,0.25,0.25,0.0,0.25,0.25,0.125,-0.125,2,face"
    assert rows[2].startswith("nan,0.0,0.0,,") and rows[2].count(",") == 9
    assert rows[3] == "0.25,-0.5,0.25,0.25,0.0,0.25,0.5,0.5,1,face"


def test_reports_have_a_verdict(tmp_path: Path) -> None:
    found = p2m.deviation([[1.0, 1.0, 3.0], [1.0, 1.0, 2.1]], cube(), tolerance=0.5, unit="mm")
    assert (found.passes(50), found.passes(50.1)) == (True, False)
    assert not p2m.deviation(np.empty((0, 3)), cube(), tolerance=0.5).passes(0)
    found.save(tmp_path / "report.pdf", head={"Part": "bracket"}, required=50)
    pdf = (tmp_path / "report.pdf").read_bytes()
    parts = [zlib.decompressobj().decompress(part) for part in pdf.split(b"\nstream\n")[1:]]
    drawn = next(part for part in parts if b"Tj" in part)
    assert b"(Part  bracket)" in drawn and b"PASS  50 % within ".hex().upper().encode() in drawn
    found.save(tmp_path / "report.png", up="y")
    assert (tmp_path / "report.png").read_bytes().startswith(b"\x89PNG")
    named = cube()
    assert found.objects == [] and p2m.deviation(named, named).objects == []


def test_filters_and_vertices(tmp_path: Path) -> None:
    grid = np.stack(np.meshgrid(np.linspace(0, 2, 20), np.linspace(0, 2, 20), [2.0]), axis=-1).reshape(-1, 3)
    scan = np.concatenate([grid, [[1.0, 1.0, 2.5], [1.0, 1.0, 5.0], [np.nan, 0.0, 0.0]]])
    count = lambda **options: p2m.deviation(scan, cube(), **options).statistics["count"]  # noqa: E731
    assert (count(), count(max_distance=0.5), count(drop_isolated=True)) == (402, 401, 400)
    found = p2m.deviation([[0, 0, 2.25], [2, 0, 2], [2, 2, 2], [0, 2, 2]], cube(), on_part=True)
    top = cube().vertices[:, 2] == 2.0
    assert np.array_equal(np.isfinite(found.values), top)
    assert np.array_equal(found.values[top], [0.25, 0.0, 0.0, 0.0])
    found.save(tmp_path / "part.ply")
    assert len(p2m.read(tmp_path / "part.ply").triangles) == 12


def test_objects_and_clouds(tmp_path: Path) -> None:
    (tmp_path / "two.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 9\no low\nf 1 2 3\no high\nl 3 4\n")
    scan = [[0.25, 0.25, 0.5], [0.25, 0.5, 0.25], [0.0, 1.0, 5.0]]
    found = p2m.deviation(scan, tmp_path / "two.obj", sign=None)
    assert [(name, statistics["count"], statistics["mean"]) for name, statistics in found.objects] == [
        ("low", 2, 0.375),
        ("high", 1, pytest.approx(5 / 82**0.5)),
    ]
    x, y = np.meshgrid(np.arange(30.0), np.arange(30.0))
    ground = p2m.Scene(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3))
    queries = [[15.5, 15.5, 0.75], [15.4, 10.3, -0.25], [15.5, 15.5, 4.0]]
    assert np.allclose(p2m.deviation(queries, ground).values, [0.75, -0.25, 4.0], atol=1e-12)
    assert p2m.deviation(queries, ground, max_distance=2.0).statistics["missing"] == 1
