"""Indexes on an NVIDIA card."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _p2m
from ._arrays import FIELDS, checked_limits, coordinates, flat, outputs, real, thread_count, whole
from ._records import ClosestPoints

if TYPE_CHECKING:
    from ._index import Index

# The fields, in the order of the columns in Rust.
_CARD_FIELDS = ("distance", "lower_bound", "point", "barycentric", "primitive", "feature")


class CudaIndex:
    """A scene on an NVIDIA card, which answers closest-point queries with the same bits as `Index`.

    `Index.to` makes it. NumPy points are copied to the card, and their answers back. Points that are on the card
    already are not copied: arrays of torch and CuPy, and those of other libraries with ``__dlpack__`` or
    ``__cuda_array_interface__`` (JAX, Numba), for which CuPy is needed.

    Attributes
    ----------
    by_tree : int
        The number of queries of the last call that have no interception list, which the tree has answered.
    by_processor : int
        The number of queries of the last call that the card could not decide, which the processor has answered.
    kernel_seconds : float
        The time of the kernels of the last call, without copies. NumPy points are divided into parts of a million,
        which are searched at the same time, so their times overlap.

    Notes
    -----
    Any number of threads may query an index, but the attributes are then those of an arbitrary one of their calls. A
    process that was forked after the first index was made cannot use cards.
    """

    def __init__(self, index: Index, *, threads: int | None, **options: Any) -> None:
        if not hasattr(_p2m, "CudaIndex"):
            raise RuntimeError(
                "p2m was built without CUDA: build it with the feature cuda, "
                "MATURIN_PEP517_ARGS='--features cuda' pip install ./bindings/python"
            )
        whole(options["ordinal"], "ordinal", 0, 2**31 - 1)
        whole(options["checked"], "checked", 0, 2**32 - 1)
        if options["memory"] is not None:
            whole(options["memory"], "memory", 0, 2**32 - 1)
        real(options["reach"], "reach")
        self._ordinal = options["ordinal"]
        self._raw = _p2m.CudaIndex.build(index._raw, thread_count(threads), **options)
        self.by_tree = 0
        self.by_processor = 0
        self.kernel_seconds = 0.0

    def __repr__(self) -> str:
        scene, lists, _ = self._raw.size()
        return f"<p2m.CudaIndex on card {self._ordinal}, {(scene + lists) / 1e6:.0f} MB>"

    @property
    def info(self) -> dict[str, int]:
        """The bytes of the scene and of the lists on the card, and the number of cells without a list."""
        scene, lists, without = self._raw.size()
        return {"scene_bytes": scene, "list_bytes": lists, "cells_without_list": without}

    def closest(
        self, points: Any, *, max_distance: float | None = None, fields: str | Sequence[str] = ("distance", "primitive")
    ) -> ClosestPoints:
        """Return the closest points of the scene to query points.

        The call waits for the current stream of torch or CuPy, and returns when all answers are there. Do not modify
        the points during the call.

        Parameters
        ----------
        points : array_like or array on the card, shape (..., 3)
            The query points. Arrays on the card are contiguous, of float64 or float32. A point on the card that is not
            finite has no answer.
        max_distance : float, optional
            The largest distance of an answer, inclusive.
        fields : str or sequence of str, optional
            The arrays of the answer: any of ``distance``, ``primitive``, ``point``, ``feature``, ``barycentric`` and
            ``lower_bound``.

        Returns
        -------
        ClosestPoints
            A record with the arrays of `fields`: NumPy arrays for NumPy points, otherwise arrays of torch or CuPy on
            the card, with primitives as int32.

        Raises
        ------
        ValueError
            For a wrong shape or option, and for points of NumPy that are not finite.
        TypeError
            For points of a wrong type.
        RuntimeError
            If the card fails, or if a checked answer differs from the processor's.
        MemoryError
            If the memory of the card does not suffice.
        """
        largest, _ = checked_limits(max_distance, 0.0, None, False)
        fields = (fields,) if isinstance(fields, str) else tuple(fields)
        library = _library(points)
        if library is None:
            queries = coordinates(points, "points").astype(np.float64, copy=False)
            arrays = outputs(fields, queries.shape[:-1], None, {name: FIELDS[name] for name in _CARD_FIELDS}, ())
            self._report(self._raw.closest(queries.reshape(-1), flat(arrays), largest))
            return ClosestPoints(arrays)
        queries = library.array(points, self._ordinal)
        shape, scalar = tuple(queries.shape), str(queries.dtype).removeprefix("torch.")
        if scalar not in ("float64", "float32"):
            raise TypeError(f"points: the type is {scalar} instead of float64 or float32")
        if not shape or shape[-1] != 3:
            raise ValueError(f"points: the shape is {shape}, but the last axis has x, y and z")
        if not library.is_contiguous(queries):
            raise ValueError("points: the array is not contiguous")
        unknown = [name for name in fields if name not in _CARD_FIELDS]
        if unknown or not fields:
            raise ValueError(f"fields: {unknown} are none of {', '.join(_CARD_FIELDS)}")
        found = {}
        for name in fields:
            dtype, tail = FIELDS[name]
            found[name] = library.empty(shape[:-1] + tail, "int32" if name == "primitive" else dtype.name, queries)
        columns = [library.address(found[name]) if name in found else 0 for name in _CARD_FIELDS]
        count = math.prod(shape[:-1])
        self._report((0, 0, 0.0))
        if count > 0:
            query = (library.address(queries), count, scalar == "float32")
            self._report(self._raw.closest_on_card(query, columns, largest, library.stream(queries)))
        return ClosestPoints(found)

    def _report(self, report: tuple[int, int, float]) -> None:
        self.by_tree, self.by_processor, self.kernel_seconds = report


class _Torch:
    """The part of the interface of torch that this module uses."""

    def __init__(self) -> None:
        self._torch = sys.modules["torch"]

    def array(self, points: Any, ordinal: int) -> Any:
        if points.device.index != ordinal:
            raise ValueError(f"points: they are on {points.device}, but the index is on card {ordinal}")
        return points.detach()

    def is_contiguous(self, array: Any) -> bool:
        return bool(array.is_contiguous())

    def empty(self, shape: tuple[int, ...], scalar: str, like: Any) -> Any:
        return self._torch.empty(shape, dtype=getattr(self._torch, scalar), device=like.device)

    def address(self, array: Any) -> int:
        return int(array.data_ptr())

    def stream(self, array: Any) -> int:
        return int(self._torch.cuda.current_stream(array.device).cuda_stream)


class _CuPy:
    """The part of the interface of CuPy that this module uses."""

    def __init__(self) -> None:
        try:
            import cupy
        except ImportError as error:
            raise TypeError("points: arrays on the card that are not of torch need CuPy") from error
        self._cupy = cupy

    def array(self, points: Any, ordinal: int) -> Any:
        # Both conversions wait for the stream of the library that made the array.
        is_dlpack = not isinstance(points, self._cupy.ndarray) and hasattr(points, "__dlpack__")
        array = self._cupy.from_dlpack(points) if is_dlpack else self._cupy.asarray(points)
        if array.device.id != ordinal:
            raise ValueError(f"points: they are on card {array.device.id}, but the index is on card {ordinal}")
        return array

    def is_contiguous(self, array: Any) -> bool:
        return bool(array.flags.c_contiguous)

    def empty(self, shape: tuple[int, ...], scalar: str, like: Any) -> Any:
        with like.device:
            return self._cupy.empty(shape, scalar)

    def address(self, array: Any) -> int:
        return int(array.data.ptr)

    def stream(self, array: Any) -> int:
        # The current stream depends on the current device.
        with array.device:
            return int(self._cupy.cuda.get_current_stream().ptr)


def _library(points: Any) -> _Torch | _CuPy | None:
    """Return the library of points on a card, or None for points in the memory of the processor."""
    torch = sys.modules.get("torch")
    if torch is not None and isinstance(points, torch.Tensor):
        return _Torch() if points.is_cuda else None
    # The device type 2 of DLPack is the memory of a card.
    if hasattr(points, "__dlpack_device__") and points.__dlpack_device__()[0] == 2:
        return _CuPy()
    return _CuPy() if hasattr(points, "__cuda_array_interface__") else None
