"""Compares answers with the program `p2m` bit for bit, for a million points of each model."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import model

import p2m

MODELS = ["knot_and_cables.obj", "dragon_100k.obj", "mixed_armadillo_camel_wireframe.obj",
          "rotterdam_city_far_from_origin.obj", "political_borders_lines.obj", "thingi10k_73416.stl"]


@pytest.fixture(scope="module")
def program() -> str:
    """Return the program `p2m` of the environment variable P2M_PROGRAM, or of the path."""
    program = os.environ.get("P2M_PROGRAM") or shutil.which("p2m")
    if program is None or not os.access(program, os.X_OK):
        pytest.skip("there is no program p2m: name it by the variable P2M_PROGRAM")
    return program


@pytest.mark.parametrize("name", MODELS)
def test_answers_are_those_of_the_program(name: str, program: str, tmp_path: Path) -> None:
    path = model(name)
    scene = p2m.read(path)
    low, high = scene.bounds
    rng = np.random.default_rng(11)
    count = int(os.environ.get("P2M_QUERIES", "1000000"))
    points = low + (rng.random((count, 3)) * 1.5 - 0.25) * (high - low)
    np.save(tmp_path / "points.npy", points)
    columns = ["distance", "primitive", "point"]
    command = [program, "query", str(path), "--points", str(tmp_path / "points.npy"), "--out"]
    command += [str(tmp_path / "answers.npy"), "--columns", ",".join(columns)]
    subprocess.run(command, check=True, capture_output=True)
    expected = np.load(tmp_path / "answers.npy")
    answer = p2m.Index(scene, "octree").closest(points, fields=columns)
    assert len(expected) == count and expected.dtype.names is not None
    np.testing.assert_array_equal(answer.primitive, expected["primitive"].astype(np.int64))
    assert answer.distance.tobytes() == expected["distance"].tobytes()
    assert answer.point.tobytes() == np.ascontiguousarray(point_column(expected)).tobytes()


def point_column(answers: np.ndarray) -> np.ndarray:
    """Return the closest points of the answers of the program."""
    names = answers.dtype.names or ()
    if "point" in names:
        return answers["point"]
    return np.stack([answers[name] for name in names if name in ("x", "y", "z")], axis=1)
