"""Queries for pairs: shapes near a scene, two scenes, and moving balls."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._arrays import (
    Out,
    Progress,
    Queries,
    coordinates,
    flat,
    largest_distance,
    not_negative,
    one_output,
    one_transform,
    outputs,
    rigid_transforms,
    together,
)
from ._records import BallContacts, ClosestPairs, ClosestToShapes

_FLOAT64, _INT64 = np.dtype(np.float64), np.dtype(np.int64)
_UINT8, _BOOL = np.dtype(np.uint8), np.dtype(np.bool_)

_FIELDS_OF_BOTH: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "points": (_FLOAT64, (2, 3)),
    "features": (_UINT8, (2,)),
    "barycentric": (_FLOAT64, (2, 3)),
    "lower_bound": (_FLOAT64, ()),
    "is_intersecting": (_BOOL, ()),
}

PAIR_FIELDS: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "distance": (_FLOAT64, ()),
    "primitives": (_INT64, (2,)),
    **_FIELDS_OF_BOTH,
}
"""The types and the last axes of the columns of pairs of primitives."""

SHAPE_FIELDS: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "distance": (_FLOAT64, ()),
    "primitive": (_INT64, ()),
    **_FIELDS_OF_BOTH,
}
"""The types and the last axes of the columns of primitives near shapes."""

CONTACT_FIELDS: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "parameter": (_FLOAT64, ()),
    "primitive": (_INT64, ()),
    "point": (_FLOAT64, (3,)),
    "feature": (_UINT8, ()),
    "upper_parameter": (_FLOAT64, ()),
    "distance_bound": (_FLOAT64, ()),
}
"""The types and the last axes of the columns of contacts."""


def _shapes(values: ArrayLike) -> tuple[NDArray[np.float64], int]:
    """Return points, segments or triangles as an array of the shape (n, vertices, 3), and the number of vertices."""
    array = coordinates(values, "shapes", only_float64=True)
    if array.ndim == 2:
        array = array[:, None, :]
    if array.ndim != 3 or not 1 <= array.shape[1] <= 3:
        raise ValueError(
            f"shapes: the shape is {np.shape(values)} instead of (n, 3) for points, (n, 2, 3) for segments or "
            "(n, 3, 3) for triangles"
        )
    return array, array.shape[1]


class PairQueries(Queries):
    """The queries for pairs of an index."""

    __slots__ = ()

    _raw: _p2m.Index

    def _warn_of_open_surface(self, threads: int | None) -> None:
        """Warn if it is uncertain what is inside of the scene, or if nothing counts as inside."""
        note = self._raw.solid_note(self._count(threads))
        if note is not None:
            warnings.warn(note, stacklevel=4)

    def closest_to(
        self,
        shapes: ArrayLike,
        *,
        radius: float = 0.0,
        max_distance: float | None = None,
        certified: bool = False,
        solid: bool = False,
        fields: str | Sequence[str] | None = None,
        out: Out = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> ClosestToShapes:
        """Return the nearest points of the scene and of each of some shapes.

        Parameters
        ----------
        shapes : array_like, shape (n, 3), (n, 2, 3) or (n, 3, 3)
            Points, segments or triangles. One triangle has the shape (1, 3, 3), and (3, 3) is three points.
        radius : float, optional
            The radius around each shape. With it a point is a ball, and a segment is a capsule.
        max_distance : float, optional
            The largest distance of an answer, inclusive. Where nothing is as near, the primitive is -1 and the distance
            infinite.
        certified : bool, optional
            Whether to find the nearest primitive in exact arithmetic and round its distance once. Shapes
            with a radius have no certified answers.
        solid : bool, optional
            Whether the inside of the scene counts, so that a shape inside has the distance 0. Both points are then its
            first vertex. The inside of an open surface is defined as for `signed_distance`, with a warning.
        fields : str or sequence of str, optional
            The arrays of the answer, by default those of `out` or else ``("distance", "primitive")``: any of
            ``distance``, ``primitive``, ``points``, ``features``, ``barycentric``, ``lower_bound`` and
            ``is_intersecting``, which `ClosestToShapes` describes.
        out, threads, progress
            As for `closest`.

        Returns
        -------
        ClosestToShapes
            A record with the arrays of `fields`, each with one row for each shape.

        Raises
        ------
        ValueError
            If a coordinate is not finite, for a wrong shape or option, and for the backends ``"octree"`` and ``"p2m"``.
        KeyboardInterrupt
            Within a tenth of a second.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [9, 0, 0], [0, 9, 0]], triangles=[[0, 1, 2]]))
        >>> capsules = [[[1, 1, 2], [1, 3, 1]], [[1, 1, -1], [1, 1, 1]]]
        >>> near = index.closest_to(capsules, radius=0.5, fields=("distance", "points", "is_intersecting"))
        >>> near.distance, near.is_intersecting
        (array([0.5, 0. ]), array([False,  True]))
        >>> near.points[0].tolist()
        [[1.0, 3.0, 0.0], [1.0, 3.0, 0.5]]
        """
        array, width = _shapes(shapes)
        arrays = outputs(fields, (len(array),), out, SHAPE_FIELDS, ("distance", "primitive"))
        size, largest = not_negative(radius, "radius"), largest_distance(max_distance)
        if certified and size > 0.0:
            raise ValueError("certified: shapes with a radius have no certified answers")
        if certified and solid:
            raise ValueError("certified: solids have no certified answers")
        if solid:
            self._warn_of_open_surface(threads)
        with self._running(threads, progress, "shapes") as run:
            self._raw.closest_to(array.reshape(-1), width, flat(arrays), size, largest, certified, solid, run)
        return ClosestToShapes(arrays)

    def is_any_near(
        self,
        shapes: ArrayLike,
        max_distance: float,
        *,
        radius: float = 0.0,
        out: NDArray[np.bool_] | None = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Return whether any primitive is within a distance of each shape. A search ends at the first one.

        Parameters
        ----------
        shapes, radius, threads, progress
            As for `closest_to`.
        max_distance : float
            The distance from the shape and its radius, inclusive. With 0 the answer is whether they intersect.
        out : ndarray of bool, shape (n,), optional
            The array that receives the answers.

        Returns
        -------
        ndarray of bool, shape (n,)

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0]], points=[0]))
        >>> index.is_any_near([[[3, -1, 0], [3, 1, 0]], [[9, -1, 0], [9, 1, 0]]], 1.0, radius=2.0)
        array([ True, False])
        """
        array, width = _shapes(shapes)
        largest, size = not_negative(max_distance, "max_distance"), not_negative(radius, "radius")
        answers: NDArray[np.bool_] = one_output(out, "is_near", _BOOL, (len(array),))
        with self._running(threads, progress, "shapes") as run:
            self._raw.closest_to(array.reshape(-1), width, {"is_near": answers}, size, largest, False, False, run)
        return answers

    def closest_pair(
        self,
        other: PairQueries,
        transform: ArrayLike | None = None,
        *,
        max_distance: float | None = None,
        certified: bool = False,
        solid: bool = False,
        threads: int | None = None,
    ) -> ClosestPairs:
        """Return the nearest points of this scene and another one.

        Parameters
        ----------
        other : Index
            The index of the other scene, which may be this one. Only surfaces count unless `solid` is set: a scene
            inside of a closed one has the distance from its surface.
        transform : array_like, shape (4, 4), optional
            The rotation and the translation that move the other scene, as a matrix for column vectors. Its last row is
            (0, 0, 0, 1). Each moved coordinate is rounded, and the answer is that of the rounded vertices.
        max_distance, certified, threads
            As for `closest_to`.
        solid : bool, optional
            Whether the insides of both scenes count, as for `closest_to`. If one scene is inside of the other one, the
            distance is 0, and both points are a vertex of the inner one.

        Returns
        -------
        ClosestPairs
            A record with all its arrays and without leading axes.

        Raises
        ------
        ValueError
            If the transform is no rotation and translation, with a tolerance of 1e-6 for each entry, and for the
            backends ``"octree"`` and ``"p2m"``.
        KeyboardInterrupt
            At once. The search that was running ends with its next step in the background.

        Examples
        --------
        >>> import numpy as np, p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
        >>> raised = np.eye(4)
        >>> raised[:3, 3] = [0, 0, 2]
        >>> pair = index.closest_pair(index, raised)
        >>> float(pair.distance), bool(pair.is_intersecting)
        (2.0, False)
        """
        matrices = one_transform(transform, "transform")
        return self._closest_pairs(
            other, matrices, max_distance, certified, solid, tuple(PAIR_FIELDS), None, threads, None
        )

    def closest_pairs(
        self,
        other: PairQueries,
        transforms: ArrayLike,
        *,
        max_distance: float | None = None,
        certified: bool = False,
        solid: bool = False,
        fields: str | Sequence[str] | None = None,
        out: Out = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> ClosestPairs:
        """Return the nearest points of this scene and another one for each of some motions of the other one.

        Parameters
        ----------
        other, max_distance, certified, solid
            As for `closest_pair`.
        transforms : array_like, shape (..., 4, 4)
            The motions, with any leading axes, each as for `closest_pair`.
        fields : str or sequence of str, optional
            The arrays of the answer, by default those of `out` or else ``("distance", "primitives")``: any of
            ``distance``, ``primitives``, ``points``, ``features``, ``barycentric``, ``lower_bound`` and
            ``is_intersecting``, which `ClosestPairs` describes.
        out, threads, progress
            As for `closest`.

        Returns
        -------
        ClosestPairs
            A record with the arrays of `fields`, each with the leading axes of `transforms`.

        Examples
        --------
        >>> import numpy as np, p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
        >>> transforms = np.tile(np.eye(4), (3, 1, 1))
        >>> transforms[:, 2, 3] = [1, 2, 3]
        >>> index.closest_pairs(index, transforms).distance
        array([1., 2., 3.])
        """
        matrices = rigid_transforms(transforms, "transforms")
        return self._closest_pairs(other, matrices, max_distance, certified, solid, fields, out, threads, progress)

    def _closest_pairs(
        self,
        other: PairQueries,
        matrices: NDArray[np.float64] | None,
        max_distance: float | None,
        certified: bool,
        solid: bool,
        fields: str | Sequence[str] | None,
        out: Out,
        threads: int | None,
        progress: Progress,
    ) -> ClosestPairs:
        shape = () if matrices is None else matrices.shape[:-2]
        arrays = outputs(fields, shape, out, PAIR_FIELDS, ("distance", "primitives"))
        raw, largest = _raw_of(other), largest_distance(max_distance)
        if solid:
            if certified:
                raise ValueError("certified: solids have no certified answers")
            self._warn_of_open_surface(threads)
            other._warn_of_open_surface(threads)
        with self._running(threads, progress, "motions") as run:
            pairs = self._raw.closest_pairs(raw, _flat(matrices), largest, certified, solid, run)
        pairs.fill(flat(arrays))
        return ClosestPairs(arrays)

    def do_intersect(
        self,
        other: PairQueries,
        transform: ArrayLike | None = None,
        *,
        threads: int | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Return whether this scene and another one intersect, which is decided without rounding.

        Parameters
        ----------
        other
            As for `closest_pair`.
        transform : array_like, shape (..., 4, 4), optional
            One motion of the other scene, or several, as for `closest_pairs`.
        threads, progress
            As for `closest`.

        Returns
        -------
        ndarray of bool, shape (...)
            The answers, with the leading axes of `transform`. A search ends at the first pair that intersects.

        Examples
        --------
        >>> import p2m
        >>> floor = p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]]))
        >>> pole = p2m.Index(p2m.Scene([[1, 1, -1], [1, 1, 5]], segments=[[0, 1]]))
        >>> bool(floor.do_intersect(pole))
        True
        """
        matrices = rigid_transforms(transform, "transform")
        with self._running(threads, progress, "motions") as run:
            answers = self._raw.do_intersect(_raw_of(other), _flat(matrices), run)
        return answers.reshape(() if matrices is None else matrices.shape[:-2])

    def pairs_within(
        self,
        other: PairQueries,
        distance: float,
        transform: ArrayLike | None = None,
        *,
        fields: str | Sequence[str] | None = None,
        threads: int | None = None,
    ) -> ClosestPairs:
        """Return all pairs of primitives of this scene and another one within a distance, nearest first.

        Parameters
        ----------
        other, transform
            As for `closest_pair`.
        distance : float
            The distance, inclusive. With 0 the pairs are those that intersect.
        fields : str or sequence of str, optional
            As for `closest_pairs`.
        threads
            As for `closest`.

        Returns
        -------
        ClosestPairs
            A record with the arrays of `fields`, each with one row for each pair. Equally near pairs are ordered by
            their ids.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[0, 0, 0], [2, 0, 0], [9, 0, 0]], points=[0, 1, 2]))
        >>> near = index.pairs_within(index, 2.0)
        >>> near.primitives.tolist(), near.distance.tolist()
        ([[0, 0], [1, 1], [2, 2], [0, 1], [1, 0]], [0.0, 0.0, 0.0, 2.0, 2.0])
        """
        matrices = one_transform(transform, "transform")
        largest = not_negative(distance, "distance")
        outputs(fields, (0,), None, PAIR_FIELDS, ("distance", "primitives"))
        pairs = self._raw.pairs_within(_raw_of(other), _flat(matrices), largest, self._count(threads))
        arrays = outputs(fields, (len(pairs),), None, PAIR_FIELDS, ("distance", "primitives"))
        pairs.fill(flat(arrays))
        return ClosestPairs(arrays)

    def first_contact(
        self,
        starts: ArrayLike,
        ends: ArrayLike,
        radius: float,
        *,
        tolerance: float = 0.0,
        ignore_opening: bool = False,
        fields: str | Sequence[str] | None = None,
        out: Out = None,
        threads: int | None = None,
        progress: Progress = None,
    ) -> BallContacts:
        """Return the first contacts of balls with the scene, whose centres move along segments (sphere casts).

        Parameters
        ----------
        starts, ends : array_like, shape (..., 3)
            The centres at the parameters 0 and 1, which are broadcast against each other.
        radius : float
            The radius of all balls, which may be 0.
        tolerance : float, optional
            The distance from the ball within which a contact may be reported too early. The default 0 leaves some
            roundings.
        ignore_opening : bool, optional
            Whether to ignore primitives that the ball touches at the start without coming nearer to them, so that it
            can leave the surface on which it rests.
        fields : str or sequence of str, optional
            The arrays of the answer, by default those of `out` or else ``("parameter", "primitive")``: any of
            ``parameter``, ``primitive``, ``point``, ``feature``, ``upper_parameter`` and ``distance_bound``, which
            `BallContacts` describes.
        out, threads, progress
            As for `closest`.

        Returns
        -------
        BallContacts
            A record with the arrays of `fields`, each with the leading axes of the balls.

        Raises
        ------
        ValueError
            If a coordinate or the radius is not finite, and for the backends ``"octree"`` and ``"p2m"``.

        Notes
        -----
        A ball certainly touches nothing before the parameter, and nothing at all if there is no contact. Backends agree
        within rounding, but not to the bit.

        Examples
        --------
        >>> import p2m
        >>> index = p2m.Index(p2m.Scene([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], triangles=[[0, 1, 2]]))
        >>> contact = index.first_contact([[0, 0, 5], [0, 0, 5]], [[0, 0, -5], [0, 9, 5]], 1.0)
        >>> contact.parameter.round(9), contact.primitive
        (array([0.4, inf]), array([ 0, -1]))
        >>> float(index.first_contact([0, 0, 1], [0, 0, 5], 1.0).parameter)
        0.0
        >>> float(index.first_contact([0, 0, 1], [0, 0, 5], 1.0, ignore_opening=True).parameter)
        inf
        """
        leading, start, end = together(starts, "starts", ends, "ends")
        size, margin = not_negative(radius, "radius"), not_negative(tolerance, "tolerance")
        if not max(size, margin) < float("inf"):
            raise ValueError(f"radius, tolerance: {radius} and {tolerance} are not finite")
        arrays = outputs(fields, leading, out, CONTACT_FIELDS, ("parameter", "primitive"))
        with self._running(threads, progress, "balls", "moving") as run:
            self._raw.first_contact(start, end, flat(arrays), size, margin, bool(ignore_opening), run)
        return BallContacts(arrays)


def _flat(matrices: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
    return None if matrices is None else matrices.reshape(-1)


def _raw_of(other: Any) -> _p2m.Index:
    if not isinstance(other, PairQueries):
        raise TypeError(f"other: {type(other).__name__} is no p2m.Index")
    return other._raw
