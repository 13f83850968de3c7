"""Scenes and queries that several tests use."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import p2m

BACKENDS = p2m.backends()
ALL_FIELDS = ("distance", "primitive", "point", "feature", "barycentric", "lower_bound")
EXACT_FIELDS = ("distance", "primitive", "point", "feature", "barycentric")
"""The fields that are the same bits in every backend; lower bounds depend on the search."""


CUBE_VERTICES = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CUBE_TRIANGLES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)
"""The cube from 0 to 1, whose normals point outwards."""

DIFFERENCES: list[tuple[str, str, str, str, int, str]] = []
"""Differences from other packages: the package, the difference, the model, the count, the decided count, the reason."""


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print the differences from other packages as a table."""
    if DIFFERENCES:
        terminalreporter.section("differences from other packages, in which p2m is right")
        terminalreporter.line("| package | what | model | differences | decided | reason |")
        terminalreporter.line("|---|---|---|---|---|---|")
        for row in sorted(DIFFERENCES):
            terminalreporter.line("| " + " | ".join(map(str, row)) + " |")


def models() -> Path | None:
    """Return the folder of real meshes, if there is one."""
    folder = os.environ.get("P2M_MODELS")
    for candidate in [folder] if folder else [p / "shared" / "models" for p in Path(__file__).resolve().parents]:
        if candidate and Path(candidate).is_dir():
            return Path(candidate)
    return None


def model(name: str) -> Path:
    """Return a scene of the repository or a real mesh, or skip the test if the mesh is absent."""
    scenes = Path(__file__).resolve().parents[3] / "scenes"
    for folder in [scenes, models()]:
        if folder is not None and (folder / name).exists():
            return folder / name
    pytest.skip(f"the model {name} is absent")


def mixed_scene(seed: int = 1, vertices: int = 300, count: int = 200) -> p2m.Scene:
    """Return random triangles, segments and points, some of them degenerate or duplicates."""
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(vertices, 3))
    triangles = rng.integers(0, vertices, (count, 3))
    triangles[:3] = triangles[3:6]
    triangles[6, 1] = triangles[6, 0]
    segments = rng.integers(0, vertices, (count // 2, 2))
    return p2m.Scene(positions, triangles, segments, rng.integers(0, vertices, count // 2))


def sphere(rings: int = 24, sectors: int = 48) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices and triangles of a closed sphere of radius 1."""
    heights = np.linspace(0, np.pi, rings + 1)[1:-1]
    angles = np.arange(sectors) * (2 * np.pi / sectors)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    vertices = [[0.0, 0.0, 1.0]]
    for height in heights:
        vertices += [[*(np.sin(height) * p), np.cos(height)] for p in ring]
    vertices.append([0.0, 0.0, -1.0])
    last = len(vertices) - 1
    triangles = []
    for s in range(sectors):
        t = (s + 1) % sectors
        triangles.append([0, 1 + s, 1 + t])
        for r in range(rings - 2):
            a, b = 1 + r * sectors, 1 + (r + 1) * sectors
            triangles += [[a + s, b + s, b + t], [a + s, b + t, a + t]]
        a = 1 + (rings - 2) * sectors
        triangles.append([a + s, last, a + t])
    return np.array(vertices), np.array(triangles)


@pytest.fixture(scope="session")
def scene() -> p2m.Scene:
    return mixed_scene()


@pytest.fixture(scope="session")
def brute(scene: p2m.Scene) -> p2m.Index:
    return p2m.Index(scene, "brute")


@pytest.fixture(scope="session")
def ball() -> p2m.Scene:
    return p2m.Scene(*sphere())


@pytest.fixture(scope="session")
def queries() -> np.ndarray:
    rng = np.random.default_rng(2)
    near = rng.normal(size=(400, 3))
    far = rng.normal(size=(100, 3)) * 100
    return np.concatenate([near, far, mixed_scene().vertices[:100]])


def assert_same(answer: Any, expected: Any, fields: tuple[str, ...] | None = None) -> None:
    """Check that arrays have the same bits."""
    names = fields if fields is not None else expected.fields
    for name in names:
        a, b = answer[name], expected[name]
        assert a.dtype == b.dtype and a.shape == b.shape, name
        assert a.tobytes() == b.tobytes(), name
