"""Makes the pictures and the tables of docs/python.md.

    pip install ./bindings/python[compare,gallery]
    python bindings/python/gallery/make.py --write

It takes about two minutes. Without `--write` it prints the tables and does not change the document. `--only NAME` makes
one part: deviation, slice, snapping, clearance, shells, origin, units, rays or fixed. The pictures show the scene in
the repository and meshes that this file makes.

Answers of other libraries are compared with exact ones: from the coordinates of boxes, from Python's fractions, or from
the certified distances of p2m.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import io
import os
import re
import sys
import warnings
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

os.environ.setdefault("MPLBACKEND", "Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap, TwoSlopeNorm
from PIL import Image

import p2m

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from exact import Mesh, squared_distance, vector

ROOT = Path(__file__).resolve().parents[3]
DOCUMENT = ROOT / "docs" / "python.md"
PICTURES = ROOT / "docs" / "pictures"
CARRIED = ROOT / "scenes" / "knot_and_cables.obj"

INSIDE, OUTSIDE, WRONG, INK = "#f2a65a", "#8fb8de", "#c1121f", "#222222"
plt.rcParams.update({"font.size": 10, "axes.titlesize": 10, "figure.facecolor": "white", "savefig.dpi": 110})


# ---------------------------------------------------------------------------------------------------------- pictures


def save(figure: Any, name: str) -> None:
    """Save a figure as a PNG file with a palette, which is small."""
    data = io.BytesIO()
    figure.savefig(data, format="png")
    plt.close(figure)
    image = Image.open(data).convert("RGB").quantize(112, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    path = PICTURES / f"python-{name}.png"
    image.save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1000:.0f} kB", file=sys.stderr)


def rendered(draw: Callable[[Any], None], size: tuple[int, int], camera: Any, zoom: float = 1.0) -> np.ndarray:
    """Return a picture that PyVista renders off screen."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=[2 * side for side in size])
    plotter.set_background("white")
    draw(plotter)
    plotter.camera_position = camera
    plotter.camera.zoom(zoom)
    image = Image.fromarray(plotter.screenshot(return_img=True))
    plotter.close()
    return np.asarray(image.resize(size, Image.Resampling.LANCZOS))


def polydata(vertices: np.ndarray, triangles: np.ndarray) -> Any:
    import pyvista

    return pyvista.PolyData(vertices, np.column_stack([np.full(len(triangles), 3), triangles]))


def tube() -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices and triangles of the tube in the scene of the repository, which is closed and knotted."""
    scene = p2m.read(CARRIED)
    return scene.vertices, scene.triangles


# ------------------------------------------------------------------------------------------------------ applications


def deviation() -> str:
    """Draw the distances of the points of a scan from the mesh."""
    vertices, triangles = tube()
    rng = np.random.default_rng(1)
    # A scan: points of the surface with noise, and a dent about one vertex and a bulge about another.
    corners = vertices[triangles[rng.integers(0, len(triangles), 150_000)]]
    weights = rng.dirichlet([1.0, 1.0, 1.0], len(corners))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    scan = (weights[:, :, None] * corners).sum(axis=1)
    offset = rng.normal(scale=0.003, size=len(scan))
    for centre, depth in (([2.35, 1.5, 0.9], -0.06), ([-1.9, -1.9, 0.6], 0.05)):
        near = vertices[np.argmin(np.linalg.norm(vertices - centre, axis=1))]
        offset += depth * np.exp(-(((scan - near) / 0.35) ** 2).sum(axis=1))
    scan += normals * offset[:, None]

    index = p2m.Index((vertices, triangles))
    signed = index.signed_distance(scan)

    limit = 0.06

    def draw(plotter: Any) -> None:
        plotter.add_points(
            scan,
            scalars=signed,
            cmap="coolwarm",
            clim=(-limit, limit),
            point_size=9,
            render_points_as_spheres=True,
            show_scalar_bar=False,
        )

    figure = plt.figure(figsize=(8.4, 4.2))
    axes = figure.add_axes((0.0, 0.0, 0.6, 1.0))
    axes.imshow(rendered(draw, (700, 580), [(0, -5, 13), (0, 0, 0), (0, 1, 0)], 1.25))
    axes.axis("off")
    histogram = figure.add_axes((0.68, 0.16, 0.29, 0.66))
    edges = np.linspace(-0.07, 0.07, 57)
    counts, _ = np.histogram(signed, edges)
    middles = (edges[:-1] + edges[1:]) / 2
    colours = plt.get_cmap("coolwarm")((middles + limit) / (2 * limit))
    histogram.bar(middles, counts, width=edges[1] - edges[0], color=colours, edgecolor="#555555", lw=0.3)
    histogram.set(yscale="log", xlabel="signed distance from the mesh", ylabel="points of the scan")
    histogram.set_title("blue: inside, a dent\nred: outside, a bulge", fontsize=9)
    save(figure, "deviation")
    within = float(np.quantile(np.abs(signed), 0.95))
    return (
        f"Of the {len(scan):,} points 95 % are within {within:.4f} of the mesh. "
        f"The dent is {-signed.min():.3f} deep and the bulge {signed.max():.3f} high."
    )


def slice_() -> str:
    """Draw signed distances in a plane."""
    vertices, triangles = tube()
    index = p2m.Index((vertices, triangles))
    shape = (420, 400)
    spacing = 0.0165
    origin = np.array([-3.45, -3.3, 0.0])
    values = index.field(origin, spacing, (*shape, 1), signed=True)[:, :, 0]
    figure, axes = plt.subplots(figsize=(6.4, 5.2), layout="constrained")
    extent = [origin[0], origin[0] + spacing * (shape[0] - 1), origin[1], origin[1] + spacing * (shape[1] - 1)]
    levels = np.arange(-0.3, 1.81, 0.1)
    norm = TwoSlopeNorm(0.0, -0.35, 1.8)
    picture = axes.contourf(values.T, levels, extent=extent, cmap="PuOr_r", norm=norm, extend="both")
    axes.contour(values.T, [0.0], extent=extent, colors=INK, linewidths=1.2)
    title = "signed distances in the plane z = 0; black is the surface"
    axes.set(aspect="equal", xlabel="x", ylabel="y", title=title)
    figure.colorbar(picture, ax=axes, ticks=[-0.3, 0.0, 0.5, 1.0, 1.5], label="negative inside, positive outside")
    save(figure, "signed-slice")
    return f"The picture has {values.size:,} distances, of which {np.count_nonzero(values < 0):,} are negative."


def snapping() -> str:
    """Draw the points of a track, each moved to the nearest street."""
    rng = np.random.default_rng(4)
    # A net of streets: a grid of crossings that are moved at random.
    across, up = 6, 4
    crossings = np.stack(np.meshgrid(np.arange(across), np.arange(up), indexing="ij"), -1).reshape(-1, 2) * 100.0
    crossings += rng.uniform(-20, 20, crossings.shape)
    number = np.arange(across * up).reshape(across, up)
    streets = np.concatenate(
        [
            np.stack([number[:-1].ravel(), number[1:].ravel()], 1),
            np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1),
        ]
    )
    vertices = np.column_stack([crossings, np.zeros(len(crossings))])
    route = number[[0, 1, 2, 2, 3, 4, 4, 5], [0, 0, 0, 1, 1, 1, 2, 2]]
    corners = crossings[route]
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    at = np.linspace(0, lengths.sum(), 70)
    stations = np.concatenate([[0], np.cumsum(lengths)])
    track = np.column_stack([np.interp(at, stations, corners[:, k]) for k in range(2)])
    track += rng.normal(scale=9.0, size=track.shape)
    points = np.column_stack([track, np.zeros(len(track))])

    index = p2m.Index(p2m.Scene(vertices, segments=streets))
    answer = index.closest(points, max_distance=50.0, fields=("distance", "primitive", "point"))

    figure, axes = plt.subplots(figsize=(8.0, 4.3), layout="constrained")
    for a, b in streets:
        axes.plot(*crossings[[a, b]].T, color="#d5d5d5", lw=7, solid_capstyle="round", zorder=1)
    for raw, snapped in zip(points, answer.point):
        axes.plot([raw[0], snapped[0]], [raw[1], snapped[1]], color="#555555", lw=0.8, zorder=2)
    axes.scatter(*track.T, s=20, facecolor="white", edgecolor=INK, lw=0.9, zorder=4, label="measured")
    used, colours = np.unique(answer.primitive, return_inverse=True)
    axes.scatter(*answer.point[:, :2].T, s=26, c=plt.get_cmap("tab20")(colours), zorder=3)
    axes.scatter([], [], s=26, color=plt.get_cmap("tab20")(0), label="snapped, one colour for each street")
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m")
    axes.set_xlim(track[:, 0].min() - 25, track[:, 0].max() + 25)
    axes.set_ylim(track[:, 1].min() - 20, track[:, 1].max() + 20)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)
    save(figure, "snapping")
    return (
        f"The {len(points)} points are {answer.distance.mean():.1f} m from their streets on average, at most "
        f"{answer.distance.max():.1f} m, and lie on {len(used)} of {len(streets)} streets."
    )


def clearance() -> str:
    """Draw the clearance along a path through the scene."""
    scene = p2m.read(CARRIED)
    index = p2m.Index(scene)
    s = np.linspace(0, 1, 2000)
    turn = 2 * np.pi * s
    path = np.column_stack([2.1 * np.cos(turn), 2.0 * np.sin(turn), 0.15 * np.sin(2 * turn)])
    answer = index.closest(path, fields=("distance", "primitive", "point"))
    is_cable = np.isin(answer.primitive, scene.segment_ids)
    worst = int(answer.distance.argmin())

    import pyvista

    def draw(plotter: Any) -> None:
        plotter.add_mesh(polydata(scene.vertices, scene.triangles), color="#cfd4da", smooth_shading=True)
        cables = pyvista.PolyData(
            scene.vertices, lines=np.column_stack([np.full(len(scene.segments), 2), scene.segments])
        )
        plotter.add_mesh(cables, color="#7a5230", line_width=3)
        line = pyvista.lines_from_points(path)
        line["clearance"] = answer.distance
        plotter.add_mesh(line, cmap="viridis", line_width=18, show_scalar_bar=False)
        plotter.add_mesh(pyvista.Sphere(0.14, path[worst]), color=WRONG, ambient=0.5)

    figure = plt.figure(figsize=(8.6, 4.0))
    axes = figure.add_axes((0.0, 0.0, 0.5, 1.0))
    axes.imshow(rendered(draw, (640, 600), [(2, -7, 11), (0, 0, 0), (0, 0, 1)], 1.12))
    axes.axis("off")
    chart = figure.add_axes((0.58, 0.17, 0.4, 0.68))
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    chart.scatter(length, answer.distance, c=answer.distance, cmap="viridis", s=5, zorder=3)
    top = answer.distance.max() * 1.1
    chart.fill_between(length, 0, top, where=is_cable, color="#7a5230", alpha=0.18, lw=0, label="a cable is nearest")
    chart.scatter(length[worst], answer.distance[worst], color=WRONG, s=40, zorder=4, label="the narrowest place")
    chart.set(ylim=(0, top), xlim=(0, length[-1]), xlabel="length along the path", ylabel="clearance")
    chart.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=8, columnspacing=1.0)
    save(figure, "clearance")
    kind = "cable" if is_cable[worst] else "tube"
    return (
        f"The smallest clearance is {answer.distance[worst]:.4f}, {length[worst]:.2f} along the path of length "
        f"{length[-1]:.2f}, from a {kind}. A cable is nearest along {100 * is_cable.mean():.0f} % of the path."
    )


# ------------------------------------------------------------------------------------------------------ other libraries


def open3d_scene(vertices: np.ndarray, triangles: np.ndarray) -> Any:
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
    return scene


def trimesh_mesh(vertices: np.ndarray, triangles: np.ndarray) -> Any:
    import trimesh

    return trimesh.Trimesh(vertices, triangles, process=False)


def signed_distances(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> dict[str, np.ndarray]:
    """Return the signed distances of all libraries, negative inside."""
    import igl
    import point_cloud_utils
    import pyvista
    import trimesh

    index = p2m.Index((vertices, triangles))
    scene = open3d_scene(vertices, triangles)
    queries = points.astype(np.float32)
    grid = pyvista.PolyData(points).compute_implicit_distance(polydata(vertices, triangles))
    return {
        "p2m": index.signed_distance(points),
        "Open3D": scene.compute_signed_distance(queries).numpy(),
        "Open3D, `nsamples=11`": scene.compute_signed_distance(queries, nsamples=11).numpy(),
        "trimesh": -trimesh.proximity.signed_distance(trimesh_mesh(vertices, triangles), points),
        "libigl, pseudonormals": igl.signed_distance(
            points, vertices, triangles, igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
        )[0],
        "libigl, default": igl.signed_distance(points, vertices, triangles)[0],
        "point-cloud-utils": point_cloud_utils.signed_distance_to_mesh(points, vertices, triangles)[0],
        "PyVista (VTK)": np.asarray(grid["implicit_distance"]),
    }


def markdown(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
CUBE_TRIANGLES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)


def shells() -> str:
    """Compare signs for two cubes that touch."""
    moves = {"a whole face": np.array([2.0, 0.0, 0.0]), "a quarter of a face": np.array([2.0, 1.0, 1.0])}
    x, y = np.arange(-16, 33) / 8, np.arange(-16, 25) / 8
    points = np.stack(np.meshgrid(x, y, y, indexing="ij"), -1).reshape(-1, 3)
    columns: dict[str, dict[str, np.ndarray]] = {}
    fields: dict[str, np.ndarray] = {}
    counted = []
    for name, move in moves.items():
        vertices = np.concatenate([CUBE, CUBE + move])
        triangles = np.concatenate([CUBE_TRIANGLES, CUBE_TRIANGLES + 8])
        first, second = np.abs(points).max(axis=1), np.abs(points - move).max(axis=1)
        is_inside = (first < 1) | (second < 1)
        is_clear = is_inside | ((first > 1) & (second > 1))
        answers = signed_distances(vertices, triangles, points)
        columns[name] = {library: ((d < 0) != is_inside) & is_clear for library, d in answers.items()}
        counted.append(int(is_clear.sum()))
        if not fields:
            fields = answers
    first_column, second_column = columns.values()
    rows = [
        [library, f"{int(first_column[library].sum()):,}", f"{int(second_column[library].sum()):,}"]
        for library in fields
    ]

    # The plane z = 0 through two cubes with a common face.
    in_plane = points[:, 2] == 0.0
    plane = points[in_plane]
    shown = ["p2m", "Open3D", "trimesh", "libigl, pseudonormals", "PyVista (VTK)"]
    figure, grid = plt.subplots(2, 3, figsize=(8.6, 4.2), layout="constrained", sharex=True, sharey=True)
    for axes, library in zip(grid.flat, shown):
        negative = fields[library][in_plane] < 0
        wrong = first_column[library][in_plane]
        colours = ListedColormap([OUTSIDE, INSIDE])
        axes.scatter(*plane[:, :2].T, c=negative, cmap=colours, vmin=0, vmax=1, s=5, marker="s", lw=0)
        axes.scatter(*plane[wrong, :2].T, color=WRONG, s=11, marker="s", lw=0)
        for left in (-1, 1):
            axes.plot(np.array([0, 2, 2, 0, 0]) + left, [-1, -1, 1, 1, -1], color=INK, lw=1)
        axes.set_title(f"{library}: {int(wrong.sum())} wrong", color=WRONG if wrong.any() else INK)
        axes.set(aspect="equal", xlim=(-2.1, 4.1), ylim=(-2.1, 2.1))
    legend = grid.flat[-1]
    legend.axis("off")
    for colour, text in ((INSIDE, "inside"), (OUTSIDE, "outside"), (WRONG, "wrong side")):
        legend.scatter([], [], color=colour, marker="s", s=60, label=text)
    legend.legend(loc="center", frameon=False, title="plane z = 0, one square for each query")
    save(figure, "touching-shells")
    head = ["signs", *(f"wrong of {n:,}: the cubes share {name}" for n, name in zip(counted, moves))]
    return markdown(head, rows)


def origin() -> str:
    """Compare signed distances far from the origin."""
    import igl
    import point_cloud_utils
    import trimesh

    vertices, triangles = tube()
    rng = np.random.default_rng(2)
    rows = []
    local = rng.uniform(-3, 3, (20_000, 3))
    places = {"at the origin": np.zeros(3), "1 km away": np.array([800.0, 600.0, 0.0])}
    places["UTM coordinates"] = np.array([500_000.0, 5_400_000.0, 100.0])
    for name, place in places.items():
        there, points = vertices + place, local + place
        index = p2m.Index((there, triangles))
        true = index.closest(points, certified=True, fields="distance").distance
        signs = index.signed_distance(points) < 0
        scene = open3d_scene(there, triangles)
        theirs = scene.compute_signed_distance(points.astype(np.float32)).numpy()
        wrong = np.nonzero((theirs < 0) != signs)[0]
        # Signs that differ are decided by fractions, for some of the points.
        mesh = Mesh(there, triangles)
        for i in wrong[:10]:
            if mesh.is_inside(points[i]) != signs[i]:
                raise AssertionError(f"p2m has the wrong sign at {points[i]}")
        found = {
            "p2m": index.distance(points),
            "Open3D (f32)": np.abs(theirs),
            "libigl": np.sqrt(igl.point_mesh_squared_distance(points, there, triangles)[0]),
            "point-cloud-utils": point_cloud_utils.closest_points_on_mesh(points, there, triangles)[0],
            "trimesh": trimesh.proximity.closest_point(trimesh_mesh(there, triangles), points[:1000])[1],
        }
        errors = [f"{np.abs(d - true[: len(d)]).max():.0e}" for d in found.values()]
        rows.append([name, *errors, f"{len(wrong):,}"])
    head = ["place of the tube", *(f"{library}, largest error" for library in found), "Open3D, wrong signs"]

    spacing, shape = 0.012, (560, 270)
    corner = places["UTM coordinates"] + [-3.35, -3.3, 0.2]
    x, y = (corner[k] + spacing * np.arange(shape[k]) for k in range(2))
    plane = np.stack([*np.meshgrid(x, y, indexing="ij"), np.full(shape, corner[2])], -1)
    ours = index.signed_distance(plane)
    theirs = scene.compute_signed_distance(plane.astype(np.float32)).numpy()
    figure, both = plt.subplots(1, 2, figsize=(8.6, 2.9), layout="constrained", sharey=True)
    extent = [0, spacing * shape[0], 0, spacing * shape[1]]
    for axes, values, name in zip(both, (ours, theirs), ("p2m, float64", "Open3D, float32")):
        picture = axes.imshow(
            values.T,
            origin="lower",
            extent=extent,
            cmap="PuOr_r",
            norm=TwoSlopeNorm(0.0, -0.35, 1.8),
            interpolation="nearest",
        )
        axes.contour(values.T, [0.0], extent=extent, colors=INK, linewidths=0.9)
        axes.set(title=name, xlabel="x - 499,996.65, m")
    both[0].set_ylabel("y - 5,399,996.7, m")
    figure.colorbar(picture, ax=both, ticks=[-0.3, 0.0, 0.5, 1.0, 1.5], label="signed distance, m")
    save(figure, "far-from-origin")
    return markdown(head, rows)


def units() -> str:
    """Compare distances near small parts, whose lengths are given in large units."""
    import igl
    import point_cloud_utils
    import trimesh

    vertices, triangles = tube()
    rng = np.random.default_rng(3)
    corners = vertices[triangles[rng.integers(0, len(triangles), 5_000)]]
    local = (rng.dirichlet([1.0, 1.0, 1.0], len(corners))[:, :, None] * corners).sum(axis=1)
    local += rng.normal(scale=0.05, size=local.shape)
    rows = []
    for name, scale in (("6 m", 1.0), ("6 cm", 0.01), ("6 mm", 0.001)):
        small, points = vertices * scale, local * scale
        answer = p2m.Index((small, triangles)).closest(points, certified=True, fields=("distance", "primitive"))
        true = answer.distance
        theirs = trimesh.proximity.closest_point(trimesh_mesh(small, triangles), points)[1]
        relative = theirs / true - 1
        worst = int(relative.argmax())
        if relative[worst] > 1e-9:
            found = [vector(corner) for corner in small[triangles[answer.primitive[worst]]]]
            if squared_distance(vector(points[worst]), found) >= Fraction(theirs[worst] * (1 - 1e-9)) ** 2:
                raise AssertionError("p2m has no nearer point")
        others = {
            "libigl": np.sqrt(igl.point_mesh_squared_distance(points, small, triangles)[0]),
            "point-cloud-utils": point_cloud_utils.closest_points_on_mesh(points, small, triangles)[0],
            "p2m": p2m.Index((small, triangles)).distance(points),
        }
        errors = [f"{np.abs(d / true - 1).max():.0e}" for d in others.values()]
        wrong = int((relative > 1e-6).sum())
        digits = 4 if relative[worst] > 1e-3 else 9
        example = f"{theirs[worst]:.{digits}g} m instead of {true[worst]:.{digits}g} m"
        rows.append([name, f"{wrong:,}", example, *errors])
    head = ["length of the tube", f"trimesh, wrong by more than 1e-6 of {len(local):,}", "trimesh, its worst answer"]
    return markdown(head + [f"{library}, largest relative error" for library in others], rows)


def rays() -> str:
    """Compare hits of rays through vertices."""
    vertices, triangles = tube()
    vertices = vertices.astype(np.float32).astype(np.float64)
    targets = vertices[np.unique(triangles)]
    index = p2m.Index((vertices, triangles))
    scene = open3d_scene(vertices, triangles)
    rows = []
    for axis, name in enumerate("xyz"):
        direction = np.eye(3)[axis]
        # The other coordinates equal those of the vertex, so the ray runs through it.
        origins = (targets - 8.0 * direction).astype(np.float32).astype(np.float64)
        queries = np.column_stack([origins, np.broadcast_to(direction, origins.shape)]).astype(np.float32)
        misses = ~scene.test_occlusions(queries).numpy(), ~index.rays(origins, direction, "any")
        odd = scene.count_intersections(queries).numpy() % 2, index.rays(origins, direction, "crossings") % 2
        rows.append([name, f"{len(targets):,}", *(str(int(n.sum())) for n in (*misses, *odd))])
    head = ["direction", "rays", "Open3D, without a hit", "p2m, without a hit"]
    return markdown(head + ["Open3D, odd number of crossings", "p2m, odd number of crossings"], rows)


def fixed() -> str:
    """Answer the questions of two old reports again."""
    import open3d

    box = open3d.geometry.TriangleMesh.create_box(1, 1, 1)
    ball = open3d.geometry.TriangleMesh.create_sphere(0.8)
    rows = []
    for name, mesh, scale in (
        ("cube, 61 points along each side", box, 61),
        ("sphere, 64 points along each side", ball, 64),
    ):
        vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles).astype(np.int64)
        low, high = (-1.0, 2.0) if mesh is box else (-0.88, 0.88)
        side = np.linspace(low, high, scale)
        points = np.stack(np.meshgrid(side, side, side, indexing="ij"), -1).reshape(-1, 3)
        points = points.astype(np.float32).astype(np.float64)
        ours = p2m.Index((vertices, triangles)).signed_distance(points)
        theirs = open3d_scene(vertices, triangles).compute_signed_distance(points.astype(np.float32)).numpy()
        # Open3D rounds the mesh to float32, so a point within this accuracy may be on its other side.
        differ = ((theirs < 0) != (ours < 0)) & (np.abs(ours) > 1e-6)
        rows.append([name, f"{len(points):,}", str(int(differ.sum()))])
    return markdown(["scene", "points", "signs that differ between Open3D and p2m"], rows)


PARTS: dict[str, Callable[[], str]] = {
    "deviation": deviation,
    "slice": slice_,
    "snapping": snapping,
    "clearance": clearance,
    "shells": shells,
    "origin": origin,
    "units": units,
    "rays": rays,
    "fixed": fixed,
}


def versions() -> str:
    names = ["p2m", "open3d", "trimesh", "libigl", "point-cloud-utils", "vtk", "numpy"]
    return "The versions are " + ", ".join(f"{name} {importlib.metadata.version(name)}" for name in names) + "."


def replace_block(text: str, name: str, block: str) -> str:
    """Return a document with the text between the markers of a block replaced."""
    pattern = re.compile(rf"(<!-- make\.py {name} -->\n).*?(<!-- end -->)", re.DOTALL)
    replaced, count = pattern.subn(lambda match: f"{match[1]}\n{block}\n\n{match[2]}", text)
    if count != 1:
        raise SystemExit(f"{DOCUMENT.name} has {count} blocks of the name {name}")
    return replaced


def wrapped(text: str) -> str:
    """Return prose wrapped at 120 characters, and tables unchanged."""
    import textwrap

    return text if text.startswith("|") else textwrap.fill(text, 120, break_on_hyphens=False)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="replace the tables of docs/python.md")
    parser.add_argument("--only", choices=PARTS, action="append", help="make this part alone")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    blocks = {name: wrapped(PARTS[name]()) for name in arguments.only or PARTS}
    if not arguments.only:
        blocks["versions"] = wrapped(versions())
    for name, block in blocks.items():
        print(f"\n{name}\n\n{block}")
    if arguments.write:
        text = DOCUMENT.read_text()
        for name, block in blocks.items():
            text = replace_block(text, name, block)
        DOCUMENT.write_text(text)


if __name__ == "__main__":
    main()
