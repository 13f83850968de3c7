"""Checks and conversions of arguments."""

from __future__ import annotations

import contextlib
import operator
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any, Literal, Self, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _p2m
from ._records import Record

Progress = Union[Callable[[int, int], object], bool, Literal["tqdm"], None]
"""A function ``callback(done, total)``, or ``True`` or ``"tqdm"`` for a progress bar of tqdm."""

Run = tuple[int, Union[Callable[[int, int], object], None]]
"""The options of a call: the number of threads, and the function that receives progress."""

Out = Union[Mapping[str, NDArray[Any]], Record, NDArray[Any], None]
"""Arrays that receive answers, by name, or a single array for a single answer."""

_FLOAT64 = np.dtype(np.float64)
_FLOAT32 = np.dtype(np.float32)

FIELDS: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "distance": (_FLOAT64, ()),
    "primitive": (np.dtype(np.int64), ()),
    "point": (_FLOAT64, (3,)),
    "feature": (np.dtype(np.uint8), ()),
    "barycentric": (_FLOAT64, (3,)),
    "lower_bound": (_FLOAT64, ()),
    "object": (np.dtype(np.int64), ()),
}
"""The types and the last axes of the columns of closest points."""

CLOSEST_FIELDS = {**FIELDS, "normal": (_FLOAT64, (3,))}
"""The columns of closest points, including those that only indexes over whole scenes have."""

HIT_FIELDS: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {
    "t": (_FLOAT64, ()),
    "primitive": (np.dtype(np.int64), ()),
    "point": (_FLOAT64, (3,)),
    "barycentric": (_FLOAT64, (3,)),
    "side": (np.dtype(np.int8), ()),
}
"""The types and the last axes of the columns of hits."""


def unmasked(values: ArrayLike, name: str) -> NDArray[Any]:
    """Return values as an array, or raise an error if it is a masked array that hides some of them."""
    if isinstance(values, np.ma.MaskedArray):
        raise TypeError(f"{name}: a masked array hides numbers: leave its masked rows out, or take its attribute data")
    return np.asarray(values)


def coordinates(values: ArrayLike, name: str, *, only_float64: bool = False) -> NDArray[Any]:
    """Return coordinates as a contiguous array of float64 or float32. It is copied only if necessary."""
    array = unmasked(values, name)
    if array.shape == (0,):
        array = array.reshape(0, 3)
    if array.dtype is not _FLOAT64 and array.dtype != _FLOAT64 and (only_float64 or array.dtype != _FLOAT32):
        if array.dtype.kind not in "iuf":
            raise TypeError(f"{name}: the type is {array.dtype}, but coordinates are real numbers")
        array = array.astype(_FLOAT64)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name}: the shape is {array.shape}, but the last axis has x, y and z")
    flags = array.flags
    if not (flags.c_contiguous and flags.aligned):
        array = array.copy()
    return array


def together(
    first: ArrayLike, first_name: str, second: ArrayLike, second_name: str
) -> tuple[tuple[int, ...], NDArray[np.float64], NDArray[np.float64]]:
    """Return the common leading axes of two arrays after broadcasting, and both as flat arrays."""
    arrays = [coordinates(first, first_name, only_float64=True), coordinates(second, second_name, only_float64=True)]
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    a, b = (np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays)
    return shape[:-1], a, b


def grid_of(origin: ArrayLike, shape: Sequence[int]) -> tuple[tuple[float, ...], tuple[int, ...]]:
    """Return the first point of a grid, and its numbers of points along the axes."""
    corner = coordinates(origin, "origin", only_float64=True)
    if corner.shape != (3,):
        raise ValueError(f"origin: the shape is {corner.shape} instead of (3,)")
    counts = tuple(whole(count, "shape", 0, 2**40) for count in shape)
    if len(counts) != 3 or min(counts) < 1:
        raise ValueError(f"shape: {tuple(shape)} are not three numbers of points")
    return tuple(corner.tolist()), counts


def one_transform(values: ArrayLike | None, name: str) -> NDArray[np.float64] | None:
    """Return the matrix of one rotation and translation."""
    matrix = rigid_transforms(values, name)
    if matrix is not None and matrix.ndim != 2:
        raise ValueError(f"{name}: the shape is {matrix.shape} instead of (4, 4)")
    return matrix


MAX_ROTATION_DEVIATION = 1e-6
"""The largest deviation of an entry of ``R @ R.T`` from the identity for a rotation R."""


def rigid_transforms(values: ArrayLike | None, name: str) -> NDArray[np.float64] | None:
    """Return matrices of rotations and translations as a contiguous array of the shape (..., 4, 4)."""
    if values is None:
        return None
    array = unmasked(values, name)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: the type is {array.dtype}, but matrices have real numbers")
    if array.shape[-2:] != (4, 4):
        raise ValueError(f"{name}: the shape is {array.shape}, but the last axes are (4, 4)")
    matrices = np.ascontiguousarray(array, np.float64).reshape(array.shape)
    rotation = matrices[..., :3, :3]
    with np.errstate(all="ignore"):
        deviation = np.abs(rotation @ np.swapaxes(rotation, -1, -2) - np.eye(3)).max(axis=(-1, -2))
        is_orthogonal = deviation <= MAX_ROTATION_DEVIATION
        for is_right, why in [
            (np.isfinite(matrices).all(axis=(-1, -2)), "has a number that is not finite"),
            ((matrices[..., 3, :] == [0.0, 0.0, 0.0, 1.0]).all(axis=-1), "has another last row than (0, 0, 0, 1)"),
            (is_orthogonal, "is no rotation in its first three columns, but scales or shears"),
            (np.linalg.det(rotation) > 0.0, "is no rotation in its first three columns, but reflects"),
        ]:
            if not np.all(is_right):
                row = int(np.nonzero(~np.reshape(is_right, -1))[0][0])
                which = f"matrix {row}" if array.ndim > 2 else "the matrix"
                raise ValueError(f"{name}: {which} {why}")
    return matrices


def indices(values: ArrayLike | None, name: str, width: int, vertices: int) -> NDArray[np.uint32]:
    """Return indices of vertices as a flat array, `width` for each primitive."""
    if values is None:
        return np.empty(0, np.uint32)
    array = unmasked(values, name)
    if array.size == 0:
        return np.empty(0, np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: the type is {array.dtype}, but indices are integers")
    shape = (array.shape[0], width) if width > 1 else (array.shape[0],)
    if array.shape != shape:
        expected = f"(m, {width})" if width > 1 else "(m,)"
        raise ValueError(f"{name}: the shape is {array.shape} instead of {expected}")
    if int(array.min()) < 0 or int(array.max()) >= vertices:
        wrong = (array < 0) | (array >= vertices)
        row = int(np.nonzero(wrong.reshape(len(array), -1).any(axis=1))[0][0])
        raise ValueError(f"{name}: row {row} is {array[row].tolist()}, but there are {vertices} vertices")
    return np.ascontiguousarray(array, np.uint32).reshape(-1)


class _Usual(threading.local):
    """The default number of threads for calls on this thread."""

    threads: int | None = None


usual = _Usual()


def thread_count(threads: int | None, default: int | None = None) -> int:
    """Return the number of threads to use."""
    if threads is None:
        return default or usual.threads or _p2m.default_threads()
    return whole(threads, "threads", 1, 1024)


def own_threads(threads: int | None) -> int | None:
    """Return the number of threads that an object was given, or None."""
    return None if threads is None else thread_count(threads)


def real(value: float, name: str) -> float:
    """Return a number as a float."""
    if isinstance(value, (str, bytes)):
        raise TypeError(f"{name}: {value!r} is text and no number")
    return float(value)


def whole(value: int, name: str, least: int, most: int) -> int:
    """Return a whole number in a range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: {value!r} is no whole number") from None
    if not least <= number <= most:
        raise ValueError(f"{name}: {number} is not from {least} to {most}")
    return number


def not_negative(value: float, name: str) -> float:
    """Return a number that is not negative; it may be infinite."""
    number = real(value, name)
    if not number >= 0.0:
        raise ValueError(f"{name}: {number} is negative or no number")
    return number


def largest_distance(value: float | None, name: str = "max_distance") -> float:
    """Return the largest distance of answers, which is infinite by default."""
    return float("inf") if value is None else not_negative(value, name)


def check_choice(value: object, name: str, choices: Sequence[object]) -> None:
    """Raise an error unless a value is one of the choices."""
    if value not in choices:
        raise ValueError(f"{name}: {value!r} is none of {', '.join(map(repr, choices))}")


SIGNS = ("auto", "winding", "parity")
"""The names of the rules of signs."""

INSIDE = ("negative", "positive")
"""The names of the signs inside that signed distances may have."""


def checked_limits(
    max_distance: float | None, epsilon: float, max_visits: int | None, certified: bool
) -> tuple[float, float]:
    """Return the largest distance and the relative error, after checking all limits of a search."""
    largest = largest_distance(max_distance)
    error = not_negative(epsilon, "epsilon")
    if max_visits is not None:
        whole(max_visits, "max_visits", 0, 2**32 - 1)
    if certified and (error > 0.0 or max_visits is not None):
        raise ValueError("certified: certified answers have neither epsilon nor max_visits")
    return largest, error


def checked_out(array: Any, name: str, dtype: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """Return an array after checking that answers can be written to it."""
    if not isinstance(array, np.ndarray):
        raise TypeError(f"out: {name} is no array of NumPy but {type(array).__name__}")
    if array.dtype != dtype:
        raise TypeError(f"out: {name} has the type {array.dtype} instead of {dtype}")
    if array.shape != shape:
        raise ValueError(f"out: {name} has the shape {array.shape} instead of {shape}")
    if not (array.flags.c_contiguous and array.flags.aligned):
        raise ValueError(f"out: {name} is not contiguous")
    if not array.flags.writeable:
        raise ValueError(f"out: {name} is read-only")
    return array


def one_output(out: Any, name: str, dtype: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """Return the array for one answer to each query."""
    return np.empty(shape, dtype) if out is None else checked_out(out, name, dtype, shape)


def outputs(
    fields: Sequence[str] | None,
    shape: tuple[int, ...],
    out: Out,
    known: Mapping[str, tuple[np.dtype[Any], tuple[int, ...]]],
    default: Sequence[str],
) -> dict[str, NDArray[Any]]:
    """Return the arrays for the fields, new ones or those of `out`."""
    if isinstance(fields, str):
        fields = (fields,)
    given: Mapping[str, Any] | None = None
    if out is None:
        pass
    elif isinstance(out, np.ndarray):
        names = tuple(fields) if fields is not None else tuple(default)
        if len(names) != 1:
            raise ValueError(f"out: one array was given for the fields {', '.join(names)}: give a dictionary of arrays")
        given = {names[0]: out}
    elif isinstance(out, Record):
        given = out.asdict()
    elif isinstance(out, Mapping):
        given = out
    else:
        raise TypeError(f"out: {type(out).__name__} is neither an array nor a dictionary of arrays")
    if fields is None:
        fields = tuple(given) if given is not None else default
    arrays = {}
    for name in fields:
        if name not in known:
            raise ValueError(f"fields: {name!r} is none of {', '.join(known)}")
        dtype, tail = known[name]
        if given is None:
            arrays[name] = np.empty(shape + tail, dtype)
        elif name in given:
            arrays[name] = checked_out(given[name], name, dtype, shape + tail)
        else:
            raise ValueError(f"out: there is no array for the field {name!r}")
    if given is not None and len(given) != len(arrays):
        raise ValueError(f"out: there are arrays for {', '.join(given)}, but the fields are {', '.join(arrays)}")
    if not arrays:
        raise ValueError("fields: none is asked for")
    return arrays


def flat(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Return flat views of contiguous arrays."""
    return {name: array if array.ndim == 1 else array.reshape(-1) for name, array in arrays.items()}


def running(threads: int, progress: Progress, what: str, unit: str) -> AbstractContextManager[Run]:
    """Return a context manager for the number of threads and the progress function. It closes a progress bar."""
    if progress is None or progress is False:
        return contextlib.nullcontext((threads, None))
    if progress is True or progress == "tqdm":
        return _bar(threads, progress, what, unit)
    if not callable(progress):
        raise TypeError(f"progress: {progress!r} is neither a function nor True nor 'tqdm'")
    return contextlib.nullcontext((threads, progress))


@contextlib.contextmanager
def _bar(threads: int, progress: Progress, what: str, unit: str) -> Iterator[Run]:
    """Yield the number of threads and a function that moves a progress bar of tqdm."""
    try:
        from tqdm.auto import tqdm
    except ImportError as error:
        raise ImportError(f"progress={progress!r} needs the package tqdm") from error
    with tqdm(desc=what, unit=unit, unit_scale=True, total=0) as bar:

        def update(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        yield threads, update


class Shared:
    """A base class of immutable objects, whose copies are the object itself."""

    __slots__ = ()

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self


class Queries(Shared):
    """The base class of objects with queries: it has the index of the library, and the default number of threads."""

    __slots__ = ()

    _raw: Any
    _threads: int | None

    def _count(self, threads: int | None) -> int:
        return thread_count(threads, self._threads)

    def _running(
        self, threads: int | None, progress: Progress, unit: str = "points", what: str = "answering"
    ) -> AbstractContextManager[Run]:
        return running(thread_count(threads, self._threads), progress, what, unit)
