"""Indexes on a card. Without a card, a substitute for the native part reads and writes memory of the processor."""

from __future__ import annotations

import ctypes
import sys
import types
from typing import Any

import numpy as np
import pytest
from conftest import CUBE_TRIANGLES, CUBE_VERTICES

import p2m
from p2m import _cuda, _p2m

INDEX = p2m.Index(p2m.Scene(CUBE_VERTICES, triangles=CUBE_TRIANGLES), "aabb")
POINTS = np.random.default_rng(3).uniform(-1.0, 2.0, (500, 3))
FIELDS = ("distance", "primitive", "point", "feature", "barycentric", "lower_bound")


def has_card() -> bool:
    try:
        INDEX.to("cuda")
    except RuntimeError:
        return False
    return True


def test_errors_are_clear() -> None:
    with pytest.raises(ValueError, match="device: 'gpu' is not 'cuda'"):
        INDEX.to("gpu")  # type: ignore[arg-type]
    if not has_card():
        built_without = "p2m was built without CUDA"
        no_card = "there is no NVIDIA driver|the CUDA driver failed"
        with pytest.raises(RuntimeError, match=no_card if hasattr(_p2m, "CudaIndex") else built_without):
            INDEX.to("cuda")


class FakeArray(np.ndarray):
    """An array in the memory of the processor with the attributes of a CuPy array."""

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        return self.__array_interface__

    def __dlpack_device__(self) -> tuple[int, int]:
        return (2, 0)

    @property
    def device(self) -> Any:  # type: ignore[override]
        class Device:
            id = 0

            def __enter__(self) -> None: ...

            def __exit__(self, *_: object) -> None: ...

        return Device()

    @property
    def data(self) -> Any:  # type: ignore[override]
        return types.SimpleNamespace(ptr=self.ctypes.data)


class FakeRaw:
    """A substitute for the native part, whose card is the processor."""

    streams: list[int] = []

    @staticmethod
    def build(*_: Any, **__: Any) -> FakeRaw:
        return FakeRaw()

    def closest_on_card(self, queries: Any, columns: list[int], largest: float, stream: int) -> tuple[int, int, float]:
        address, count, is_f32 = queries
        self.streams.append(stream)
        scalar = ctypes.c_float if is_f32 else ctypes.c_double
        points = np.ctypeslib.as_array((scalar * (3 * count)).from_address(address)).reshape(-1, 3)
        answer = INDEX.closest(points, max_distance=largest, fields=FIELDS)
        order = ("distance", "lower_bound", "point", "barycentric", "primitive", "feature")
        types = (np.float64, np.float64, np.float64, np.float64, np.int32, np.uint8)
        for name, dtype, column in zip(order, types, columns, strict=True):
            if column:
                values = np.ascontiguousarray(answer[name], dtype)
                ctypes.memmove(column, values.ctypes.data, values.nbytes)
        return 1, 2, 0.5


@pytest.fixture
def on_fake_card(monkeypatch: pytest.MonkeyPatch) -> p2m.CudaIndex:
    cupy = types.ModuleType("cupy")
    cupy.ndarray = FakeArray  # type: ignore[attr-defined]
    cupy.asarray = lambda array: array  # type: ignore[attr-defined]
    cupy.from_dlpack = lambda array: np.asarray(array).view(FakeArray)  # type: ignore[attr-defined]
    cupy.empty = lambda shape, scalar: np.empty(shape, scalar).view(FakeArray)  # type: ignore[attr-defined]
    stream = types.SimpleNamespace(ptr=77)
    cupy.cuda = types.SimpleNamespace(get_current_stream=lambda: stream)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "cupy", cupy)
    monkeypatch.setattr(_cuda._p2m, "CudaIndex", FakeRaw, raising=False)
    return INDEX.to("cuda")


@pytest.mark.parametrize("scalar", [np.float64, np.float32])
def test_arrays_of_the_card_stay_there(on_fake_card: p2m.CudaIndex, scalar: Any) -> None:
    points = POINTS.astype(scalar).reshape(50, 10, 3).view(FakeArray)
    answer = on_fake_card.closest(points, max_distance=0.5, fields=FIELDS)
    expected = INDEX.closest(np.asarray(points), max_distance=0.5, fields=FIELDS)
    for name in FIELDS:
        assert isinstance(answer[name], FakeArray) and answer[name].shape == expected[name].shape
        np.testing.assert_array_equal(np.asarray(answer[name]), expected[name])
    assert answer.primitive.dtype == np.int32
    assert FakeRaw.streams[-1] == 77
    assert (on_fake_card.by_tree, on_fake_card.by_processor, on_fake_card.kernel_seconds) == (1, 2, 0.5)
    assert on_fake_card.closest(points[:0], fields="distance").distance.shape == (0, 10)


def test_wrong_arrays_are_refused(on_fake_card: p2m.CudaIndex) -> None:
    points = POINTS.view(FakeArray)
    for wrong, error, message in [
        (points.astype(np.int64), TypeError, "the type is int64"),
        (points[:, :2], ValueError, "the last axis has x, y and z"),
        (points[::2], ValueError, "not contiguous"),
    ]:
        with pytest.raises(error, match=message):
            on_fake_card.closest(wrong)
    with pytest.raises(ValueError, match=r"fields: \['normal'\] are none of"):
        on_fake_card.closest(points, fields="normal")
    on_fake_card._ordinal = 1
    with pytest.raises(ValueError, match="on card 0, but the index is on card 1"):
        on_fake_card.closest(points)


@pytest.mark.skipif(not has_card(), reason="there is no card")
def test_a_card_has_the_bits_of_the_processor() -> None:
    on_card = INDEX.to("cuda", checked=100)
    expected = INDEX.closest(POINTS, fields=FIELDS)
    answers = [on_card.closest(POINTS, fields=FIELDS)]
    torch = pytest.importorskip("torch")
    answers.append(on_card.closest(torch.from_numpy(POINTS).to("cuda:0"), fields=FIELDS))
    for answer in answers:
        for name in FIELDS[:-1]:
            values = np.asarray(answer[name] if isinstance(answer[name], np.ndarray) else answer[name].cpu())
            np.testing.assert_array_equal(values, expected[name])
