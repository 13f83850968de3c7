"""Deviations of a scan from a mesh, with their statistics, figures and pages."""

from __future__ import annotations

import csv
import io
import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _p2m
from ._align import align as align_points
from ._align import scan_points
from ._arrays import SIGNS, Progress, check_choice, coordinates, largest_distance, not_negative
from ._index import Index, index_of
from ._page import Page, checked_up
from ._scene import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure as _Figure

# The names of features by their codes.
_FEATURES = ("vertex0", "vertex1", "vertex2", "edge0", "edge1", "edge2", "face")

# The largest number of points that a figure draws.
_MAX_DRAWN = 50_000


class Deviation:
    """The deviations of the points of a scan from a scene, which `deviation` computes."""

    __slots__ = ("_index", "_points", "_scan", "is_signed", "limit", "statistics", "tolerance", "unit", "values")

    values: NDArray[np.float64]
    """The deviation of each point, positive outside, or the distance if `is_signed` is false. It is nan for a point
    that is not finite or whose side is not defined."""
    statistics: dict[str, Any]
    """The statistics of the deviations, by name. ``count`` and ``missing`` are the numbers of deviations and of nan. In
    the unit of the scan there are ``mean``, ``mean_absolute``, ``rms``, ``standard_deviation`` (with the count as the
    divisor), ``min``, ``max``, and ``percentile_p`` and ``absolute_percentile_p`` for p of 1, 5, 25, 50, 75, 95 and 99,
    defined as in ``numpy.percentile``. Without any deviation they are nan."""
    is_signed: bool
    """Whether the deviations have signs."""
    tolerance: float | None
    """The tolerance, if one was given."""
    limit: float
    """The absolute deviation at which the colour scale ends."""
    unit: str
    """The name of the unit of lengths."""

    def __init__(
        self,
        values: NDArray[np.float64],
        points: NDArray[Any],
        scan: Scene | None,
        index: Index,
        is_signed: bool,
        tolerance: float | None,
        limit: float | None,
        unit: str,
    ) -> None:
        self.values, self.is_signed, self.tolerance, self.unit = values, is_signed, tolerance, unit
        self.statistics, usual_limit = _p2m.deviation_statistics(values, tolerance)
        self.limit = limit or usual_limit
        self._points, self._scan, self._index = points, scan, index

    def __repr__(self) -> str:
        mean, rms = self.statistics["mean"], self.statistics["rms"]
        return f"Deviation(points={len(self.values)}, mean={mean:.4g}, rms={rms:.4g})"

    def outside(self, tolerance: float | None = None) -> tuple[int, int]:
        """Return the number of deviations above a tolerance, and the number below its negative.

        Parameters
        ----------
        tolerance : float, optional
            The tolerance, by default that of `deviation`. Deviations of exactly the tolerance are inside.
        """
        limit = self.tolerance if tolerance is None else not_negative(tolerance, "tolerance")
        if limit is None:
            raise ValueError("tolerance: none is given")
        return int(np.sum(self.values > limit)), int(np.sum(self.values < -limit))

    def passes(self, required: float) -> bool:
        """Return whether at least this percentage of the deviations is within the tolerance of `deviation`.

        Without any deviation the result is False.

        Parameters
        ----------
        required : float
            The percentage, from 0 to 100.
        """
        count = self.statistics["count"]
        return bool(count > 0 and 100.0 * (count - sum(self.outside())) / count >= required)

    @property
    def objects(self) -> list[tuple[str, dict[str, Any]]]:
        """The objects of the mesh by name, with the statistics of the deviations whose closest primitive they have.

        Primitives outside of all objects come last, with an empty name. Without objects in the mesh the list is empty.
        """
        return self._report().objects()

    def figure(self) -> _Figure:
        """Return a figure of matplotlib: the scan, coloured by its deviations, and their histogram.

        If there are more than 50,000 points, only every n-th point is drawn. The histogram counts all of them. The
        figure is not attached to a window: ``figure.savefig("deviation.png")`` writes it, and notebooks show it.

        Raises
        ------
        ImportError
            If matplotlib is not installed.
        """
        try:
            from matplotlib.figure import Figure
        except ImportError as error:
            raise ImportError("figures need matplotlib: pip install matplotlib") from error
        what = "deviation" if self.is_signed else "distance"
        low = -self.limit if self.is_signed else 0.0
        colours = "RdBu_r" if self.is_signed else "viridis"
        figure = Figure(figsize=(11, 5), layout="constrained")
        space: Any = figure.add_subplot(1, 2, 1, projection="3d")
        step = max(1, -(-len(self.values) // _MAX_DRAWN))
        drawn = self._points[::step]
        dots = space.scatter(*drawn.T, c=self.values[::step], s=2, cmap=colours, vmin=low, vmax=self.limit)
        space.set_aspect("equal")
        figure.colorbar(dots, ax=space, label=f"{what} ({self.unit})", extend="both" if self.is_signed else "max")
        bars = figure.add_subplot(1, 2, 2)
        numbers = self.values[np.isfinite(self.values)]
        bars.hist(np.clip(numbers, low, self.limit), bins=64, range=(low, self.limit), color="0.5")
        if self.tolerance is not None:
            for mark in (-self.tolerance, self.tolerance) if self.is_signed else (self.tolerance,):
                bars.axvline(mark, color="black", linestyle="--")
        mean, rms = self.statistics["mean"], self.statistics["rms"]
        title = f"mean {mean:.4g}, root mean square {rms:.4g} {self.unit}"
        bars.set(xlabel=f"{what} ({self.unit}), ends include what is beyond", ylabel="points", title=title)
        return figure

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        up: Literal["y", "z"] = "z",
        head: Mapping[str, str] | None = None,
        required: float | None = None,
    ) -> None:
        """Write a page, a report or a file of points.

        Parameters
        ----------
        path : path
            The file, whose extension selects the format. ``.html`` is a page, which any browser opens without a
            network. ``.ply`` is the scan with the property ``deviation`` and colours from blue (inside) to red
            (outside), with its triangles if it has some. ``.csv`` is the table that ``p2m query --signed`` writes,
            where ``signed_distance`` is the deviation. ``.pdf`` and ``.png`` are a report on one sheet.
        up : {"y", "z"}, optional
            The axis that points up on the page.
        head : mapping of str to str, optional
            Lines below the heading of a report, such as ``{"Part": "bracket", "Date": "2026-05-04"}``.
        required : float, optional
            The percentage of points within the tolerance that decides whether a report says PASS or FAIL.

        Raises
        ------
        ValueError
            For another extension.
        OSError
            If the file cannot be written.
        """
        target, is_y_up = Path(path), checked_up(up)
        if target.suffix == ".ply":
            data = _p2m.deviation_ply(self._raw_scan(), self.values, self.limit)
        elif target.suffix == ".csv":
            data = self._table().encode()
        elif target.suffix == ".html":
            data = self.show(up=up).html.encode()
        elif target.suffix in (".pdf", ".png"):
            lines = [(str(name), str(value)) for name, value in (head or {}).items()]
            data = self._report().sheet("Deviations", lines, required, is_y_up, target.suffix == ".pdf")
        else:
            raise ValueError(f"path: {target.name!r} does not end in .html, .ply, .csv, .pdf or .png")
        _p2m.write_bytes(target, data)

    def show(self, *, up: Literal["y", "z"] = "z") -> Page:
        """Return the page that `save` writes, which notebooks show.

        Parameters
        ----------
        up : {"y", "z"}, optional
            The axis that points up.
        """
        what = "deviations, positive outside" if self.is_signed else "distances"
        count, mean, rms = (self.statistics[key] for key in ("count", "mean", "rms"))
        summary = f"{count:,} {what}: mean {mean:.4g} {self.unit}, root mean square {rms:.4g} {self.unit}"
        return Page(self._report().page("Deviations", summary, checked_up(up)))

    def _report(self) -> _p2m.Report:
        """Return the contents of pages and sheets, after searching for the closest primitive of each point."""
        primitives = np.full(len(self.values), np.iinfo(np.uint32).max, np.uint32)
        finite = np.isfinite(self._points).all(axis=1)
        primitives[finite] = self._index.closest(self._points[finite], fields="primitive").primitive
        scan, scene = self._raw_scan(), self._index.scene._raw
        return _p2m.Report(
            scan, self.values, primitives, scene, self.is_signed, self.limit, self.tolerance, self.unit
        )

    def _raw_scan(self) -> _p2m.Scene:
        if self._scan is not None:
            return self._scan._raw
        none = np.empty(0, np.uint32)
        return _p2m.Scene(self._points.reshape(-1), none, none, none)

    def _table(self) -> str:
        """Return the points, their closest points and the deviations as text."""
        finite = np.isfinite(self._points).all(axis=1)
        fields = ["point", "distance", "primitive", "feature", "object"]
        answers = self._index.closest(self._points[finite], fields=fields)
        objects = [named.name for named in self._index.scene.objects]
        names = ["qx", "qy", "qz", "x", "y", "z", "distance"] + ["signed_distance"] * self.is_signed
        names += ["primitive", "feature"] + ["object"] * bool(objects)
        out = io.StringIO()
        table = csv.writer(out, lineterminator="\n")
        table.writerow(names)
        columns = [answers[field].tolist() for field in fields]
        rows = zip(*columns)
        for query, value, has_answer in zip(self._points.tolist(), self.values.tolist(), finite.tolist()):
            point, distance, primitive, feature, number = next(rows) if has_answer else (None, 0.0, -1, 0, -1)
            if primitive < 0:
                table.writerow(query + [""] * (len(names) - 3))
                continue
            row = [*query, *point, distance] + [value] * self.is_signed + [primitive, _FEATURES[feature]]
            table.writerow(row + ([objects[number] if number >= 0 else ""] if objects else []))
        return out.getvalue()


def deviation(
    scan: Any,
    mesh: Any,
    *,
    align: bool = False,
    on_part: bool = False,
    drop_isolated: bool = False,
    max_distance: float | None = None,
    tolerance: float | None = None,
    limit: float | None = None,
    sign: Literal["auto", "winding", "parity"] | None = "auto",
    unit: str = "units",
    threads: int | None = None,
    progress: Progress = None,
) -> Deviation:
    """Return the deviations of the points of a scan from a mesh: values, statistics, figures and pages.

    Parameters
    ----------
    scan : array_like of shape (n, 3), Scene or object
        The points, or an object that `Scene.of` makes a scene of, such as a path, whose vertices are the points. A list
        or an array is points, and a pair is a mesh.
    mesh : Index, Scene or object
        The scene that the scan is compared with. An index of any backend is used, and for other objects a tree of boxes
        is built.
    align : bool, optional
        Whether the scan is moved onto the mesh first, as `p2m.align` does by default.
    Whether the result is given at the vertices of the mesh: each has the mean deviation of the points around it, or nan
    if there are none.
        nan where there are none.
    Whether isolated points of the scan, such as dust, have no deviation. A point is isolated if it is more than four
    times as far from its neighbours as they are from theirs.
        from their neighbours as these from theirs.
    max_distance : float, optional
        The distance from the mesh above which points have no deviation.
    tolerance : float, optional
        The tolerance that figures, pages and `Deviation.outside` mark, in the unit of the mesh.
    limit : float, optional
        The absolute deviation at which the colour scale ends. By default it is three tolerances, or else the 95th
        percentile of absolute deviations.
    sign : {"auto", "winding", "parity"} or None, optional
        The rule that decides which points are inside, as for `Index.signed_distance`; None for distances without signs,
        which scenes with segments or points need. If the surface is open or not consistently oriented, ``"auto"`` warns
        and names the rule. On an open surface, inside and outside are ambiguous near holes, and both sides of a single
        sheet are outside. For a cloud of points, ``"auto"`` means deviations from the planes through each point and its
        eleven nearest others, positive above or outside.
    unit : str, optional
        The name of the unit of lengths, for figures and pages.
    threads, progress
        As for `Index.closest`.

    Returns
    -------
    Deviation
        The deviations, positive outside.

    Raises
    ------
    ValueError
        If the scene has segments or points and `sign` is not None, or for a wrong argument.

    Examples
    --------
    >>> import numpy as np, p2m
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> solid = p2m.Scene(corners, triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> found = p2m.deviation([[0.125, 0.25, 0.25], [0.25, -0.5, 0.25], [0, 0, 0]], solid, tolerance=0.25)
    >>> found.values
    array([-0.125,  0.5  ,  0.   ])
    >>> found.statistics["mean"], found.outside()
    (0.125, (1, 0))
    """
    check_choice(sign, "sign", (*SIGNS, None))
    tolerance = None if tolerance is None else not_negative(tolerance, "tolerance")
    limit = None if limit is None else not_negative(limit, "limit")
    index = index_of(mesh, threads)
    points, scene = scan_points(scan)
    if align:
        points = align_points(points, index, threads=threads).points
        scene = None if scene is None else scene.moved(points)
    finite = np.isfinite(points).all(axis=1)
    queries = coordinates(points if finite.all() else points[finite], "scan")
    farthest = largest_distance(max_distance)
    numbers: NDArray[np.float64] | None = None
    if sign is None:
        numbers = index.distance(queries, threads=threads, progress=progress)
    elif sign == "auto":
        numbers = index._raw.deviations_from_planes(queries.reshape(-1), farthest, index._count(threads))
    if numbers is None:
        rule: Literal["auto", "winding", "parity"] = sign or "auto"
        _, note = index._raw.sign_rule(rule, index._count(threads))
        if note is not None and rule == "auto":
            warnings.warn(note, stacklevel=2)
        numbers = index.signed_distance(queries, sign=rule, threads=threads, progress=progress)
    # A scene without primitives has infinite distances.
    values = np.full(len(points), np.nan)
    values[finite] = np.where(np.isfinite(numbers) & (np.abs(numbers) <= farthest), numbers, np.nan)
    if drop_isolated:
        isolated = _p2m.isolated_points(coordinates(points, "scan").reshape(-1), index._count(threads))
        values[isolated] = np.nan
    if on_part:
        known = np.isfinite(values)
        answers = index.closest(points[known], fields=("primitive", "barycentric"), threads=threads)
        primitives, weights = answers.primitive.astype(np.uint32), answers.barycentric.reshape(-1)
        values = _p2m.deviation_on_vertices(index.scene._raw, primitives, weights, values[known])
        scene, points = index.scene, index.scene.vertices
    return Deviation(values, points, scene, index, sign is not None, tolerance, limit, unit)
