"""`Ask` returns the same bits as the eager queries, for batches of all types."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import assert_same, mixed_scene
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import p2m
from p2m._ask import arrow_points

pa = pytest.importorskip("pyarrow")

FIELDS = ("distance", "primitive", "point", "feature", "barycentric", "lower_bound", "object")
POINTS = np.random.default_rng(6).normal(size=(500, 3))


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("ask") / "mixed.p2m"
    p2m.Index(mixed_scene()).save(file)
    return file


@pytest.fixture(scope="module")
def index(path: Path) -> p2m.Index:
    return p2m.load(path)


def xyz(points: np.ndarray) -> dict[str, np.ndarray]:
    return {"name": np.arange(len(points)), **{axis: points[:, k].copy() for k, axis in enumerate("xyz")}}


def lists(points: np.ndarray) -> Any:
    return pa.FixedSizeListArray.from_arrays(pa.array(points.reshape(-1)), 3)


def structs(points: np.ndarray) -> Any:
    # The order of the fields does not matter.
    return pa.StructArray.from_arrays([pa.array(points[:, k].copy()) for k in (2, 0, 1)], ["z", "x", "y"])


def columns(batch: Any, names: tuple[str, ...] = FIELDS) -> dict[str, np.ndarray]:
    """Return the answers in an Arrow batch as NumPy arrays."""
    arrays = {}
    for name in names:
        column = batch.column(name)
        array = column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column
        is_list = pa.types.is_fixed_size_list(array.type)
        arrays[name] = array.flatten().to_numpy().reshape(-1, 3) if is_list else array.to_numpy()
    return arrays


@pytest.mark.parametrize("options", [{}, {"max_distance": 0.3}, {"certified": True}, {"epsilon": 0.1, "max_visits": 4}])
def test_batches_of_all_types_have_the_same_bits(path: Path, index: p2m.Index, options: Any) -> None:
    ask = p2m.Ask(path, fields=FIELDS, **options)
    expected = index.closest(POINTS, fields=FIELDS, **options)
    table = pa.table(xyz(POINTS))
    found = ask(table)
    assert isinstance(found, pa.Table) and found.schema == ask.schema(table.schema)
    assert found.column_names == ["name", "x", "y", "z", *FIELDS]
    assert_same(columns(found), expected, FIELDS)
    batch = table.to_batches()[0].slice(40, 300)
    found = ask(batch)
    assert isinstance(found, pa.RecordBatch) and found.column("name")[0].as_py() == 40
    assert_same(columns(found), index.closest(POINTS[40:340], fields=FIELDS, **options), FIELDS)
    rows = xyz(POINTS)
    found = ask(rows)
    assert list(found) == [*rows, *FIELDS] and list(rows) == ["name", "x", "y", "z"]
    assert_same(found, expected, FIELDS)
    found = ask(POINTS.reshape(50, 10, 3))
    assert_same(found, index.closest(POINTS.reshape(50, 10, 3), fields=FIELDS, **options), FIELDS)
    single = ask(POINTS.astype(np.float32))
    assert_same(single, index.closest(POINTS.astype(np.float32), fields=FIELDS, **options), FIELDS)
    assert_same(ask(xyz(POINTS.astype(np.float32))), single, FIELDS)


def test_data_frames_have_the_same_bits(path: Path, index: p2m.Index) -> None:
    expected = index.closest(POINTS, fields=FIELDS)
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(xyz(POINTS), index=np.arange(500)[::-1])
    found = p2m.Ask(path, fields=FIELDS)(frame)
    assert list(frame.columns) == ["name", "x", "y", "z"] and found.index.equals(frame.index)
    arrays = {name: np.stack(found[name]) if name in ("point", "barycentric") else found[name] for name in FIELDS}
    assert_same({name: np.asarray(array) for name, array in arrays.items()}, expected, FIELDS)
    found = p2m.Ask(path, "geometry", "distance")(pandas.DataFrame({"geometry": list(POINTS)}))
    assert found["distance"].to_numpy().tobytes() == expected.distance.tobytes()
    frame = pandas.DataFrame(xyz(POINTS)).convert_dtypes(dtype_backend="pyarrow")
    assert p2m.Ask(path)(frame)["distance"].to_numpy().tobytes() == expected.distance.tobytes()
    frame.loc[7, "y"] = None
    for missing in [frame, pandas.DataFrame(xyz(POINTS)).assign(y=np.where(np.arange(500) == 7, np.nan, 0.0))]:
        with pytest.raises(ValueError, match="row 7 has a coordinate that is not finite"):
            p2m.Ask(path)(missing)
    with pytest.raises(KeyError, match="'z'"):
        p2m.Ask(path)(frame.drop(columns="z"))


def test_frames_of_polars_have_the_same_bits(path: Path, index: p2m.Index) -> None:
    polars = pytest.importorskip("polars")
    expected = index.closest(POINTS, fields=FIELDS)
    found = p2m.Ask(path, fields=FIELDS)(polars.DataFrame(xyz(POINTS)))
    assert isinstance(found, polars.DataFrame) and found.columns == ["name", "x", "y", "z", *FIELDS]
    assert_same({name: found[name].to_numpy() for name in FIELDS}, expected, FIELDS)
    found = p2m.Ask(path, "geometry", "distance")(polars.DataFrame({"geometry": POINTS})[3:9])
    assert found["distance"].to_numpy().tobytes() == expected.distance[3:9].tobytes()
    some = polars.DataFrame({"x": [0.5, None], "y": [0.0, 1.0], "z": [0.0, 1.0]})
    assert p2m.Ask(path)(some)["primitive"].is_null().to_list() == [False, True]


def test_columns_of_points_are_read(path: Path, index: p2m.Index) -> None:
    expected = index.closest(POINTS, fields=FIELDS)
    ask = p2m.Ask(path, "geometry", FIELDS)
    single = POINTS.astype(np.float32)
    for column, answer in [
        (lists(POINTS), expected),
        (structs(POINTS), expected),
        (pa.array(POINTS.tolist()), expected),
        (pa.array(POINTS.tolist(), pa.large_list(pa.float64())), expected),
        (lists(single), index.closest(single, fields=FIELDS)),
        (lists(np.round(POINTS).astype(np.int32)), index.closest(np.round(POINTS), fields=FIELDS)),
        (pa.chunked_array([lists(POINTS[:100]), lists(POINTS[100:])]), expected),
        (pa.chunked_array([structs(POINTS[:7]), structs(POINTS[7:])]), expected),
    ]:
        assert_same(columns(ask(pa.table({"geometry": column}))), answer, FIELDS)
        part = pa.table({"geometry": column}).slice(11, 30)
        assert_same(columns(ask(part)), {name: answer[name][11:41] for name in FIELDS}, FIELDS)
    assert_same(ask({"geometry": POINTS}), expected, FIELDS)


def test_interleaved_points_are_not_copied() -> None:
    for dtype in [np.float64, np.float32]:
        column = lists(POINTS.astype(dtype))
        start = column.values.buffers()[1].address
        for batch in [pa.record_batch({"p": column}), pa.table({"p": column})]:
            points, valid = arrow_points(batch, ("p",))
            assert valid is None and points.__array_interface__["data"][0] == start
            points, _ = arrow_points(batch.slice(5), ("p",))
            assert points.__array_interface__["data"][0] == start + 5 * 3 * points.itemsize
            np.testing.assert_array_equal(points, POINTS[5:].astype(dtype))


@given(st.lists(st.sampled_from(["valid", "null", "part"]), max_size=12), st.integers(0, 4), st.booleans())
@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
def test_points_that_are_null_have_null_answers(index: p2m.Index, kinds: list[str], first: int, is_table: bool) -> None:
    """A point is null if it is null itself or has a null coordinate; all other answers are those without nulls."""
    points = POINTS[: len(kinds)]
    rows = [None if kind == "null" else [*p[:2], None if kind == "part" else p[2]] for p, kind in zip(points, kinds)]
    is_valid = np.array([kind == "valid" for kind in kinds[first:]], bool)
    expected = index.closest(points[first:][is_valid], fields=FIELDS)
    maps = [None if row is None else dict(zip("xyz", row)) for row in rows]
    axes = {axis: pa.array([None if r is None else r[k] for r in rows], pa.float64()) for k, axis in enumerate("xyz")}
    struct = pa.struct([(axis, pa.float64()) for axis in "xyz"])
    for data in [
        {"g": pa.array(rows, pa.list_(pa.float64(), 3))}, {"g": pa.array(rows, pa.list_(pa.float64()))},
        {"g": pa.array(maps, struct)}, axes,
    ]:
        batch = (pa.table if is_table else pa.record_batch)(data).slice(first)
        found = p2m.Ask(index, tuple(data) if len(data) == 3 else "g", FIELDS)(batch)
        for name in FIELDS:
            assert found.column(name).is_valid().to_pylist() == is_valid.tolist()
        assert_same(columns(found.filter(pa.array(is_valid))), expected, FIELDS)


def test_empty_batches_have_empty_answers(tmp_path: Path) -> None:
    # Engines ask for the schema with an empty batch, on machines where the file may be absent.
    ask = p2m.Ask(tmp_path / "absent.p2m", fields=FIELDS)
    empty = {axis: np.empty(0) for axis in "xyz"}
    found = ask(pa.table(empty))
    assert found.num_rows == 0 and found.schema == ask.schema(pa.table(empty).schema)
    assert found.schema.field("point").type == pa.list_(pa.float64(), 3)
    assert ask(pa.table({axis: pa.array([], pa.null()) for axis in "xyz"})).num_rows == 0
    assert [array.shape for array in ask(np.empty((0, 3))).values()][2:4] == [(0, 3), (0,)]
    assert ask(empty)["barycentric"].shape == (0, 3)
    pandas = pytest.importorskip("pandas")
    assert ask(pandas.DataFrame(empty))["distance"].dtype == np.float64
    with pytest.raises(FileNotFoundError):
        ask(np.zeros((1, 3)))


def test_nothing_within_the_distance_is_no_null(index: p2m.Index) -> None:
    found = p2m.Ask(index, "g", max_distance=1.0)(pa.table({"g": lists(np.array([[99.0, 0.0, 0.0]]))}))
    assert found.column("distance").to_pylist() == [np.inf] and found.column("primitive").to_pylist() == [-1]


def test_prefixes_tell_two_indexes_apart(path: Path) -> None:
    table = p2m.Ask(path, prefix="a_")(pa.table(xyz(POINTS)))
    both = p2m.Ask(path, fields="distance", prefix="b_")(table)
    assert both.column_names[4:] == ["a_distance", "a_primitive", "b_distance"]
    for batch in [table, {"a_distance": POINTS, **xyz(POINTS)}]:
        with pytest.raises(ValueError, match="there is a column 'a_distance' already"):
            p2m.Ask(path, prefix="a_")(batch)


def test_asks_are_pickled_without_their_index(path: Path, index: p2m.Index) -> None:
    ask = p2m.Ask(path, "g", FIELDS, max_distance=0.5, threads=2)
    before = len(pickle.dumps(ask))
    first = columns(ask(pa.table({"g": lists(POINTS)})))
    assert len(pickle.dumps(ask)) == before < 600
    assert_same(columns(pickle.loads(pickle.dumps(ask))(pa.table({"g": lists(POINTS)}))), first, FIELDS)
    for source in [p2m.load(path, map=True), p2m.Index(mixed_scene())]:
        other = pickle.loads(pickle.dumps(p2m.Ask(source)))
        assert_same(other(POINTS), index.closest(POINTS), ("distance", "primitive"))
    code = f"""
import pickle, sys
ask = pickle.loads({pickle.dumps(p2m.Ask(path))!r})
assert "pyarrow" not in sys.modules and "dask" not in sys.modules
import numpy
print(float(ask(numpy.zeros((1, 3)))["distance"][0]))
assert "pyarrow" not in sys.modules
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert float(ended.stdout) == index.distance([0, 0, 0])


def test_wrong_files_are_errors(tmp_path: Path) -> None:
    file = tmp_path / "index.p2m"
    with pytest.raises(FileNotFoundError):
        p2m.Ask(file, must_exist=True)
    p2m.Index(mixed_scene()).save(file)
    assert len(p2m.Ask(file, must_exist=True)(POINTS)["distance"]) == 500
    by_path, by_index = pickle.dumps(p2m.Ask(file)), pickle.dumps(p2m.Ask(p2m.load(file)))
    p2m.Index(mixed_scene(3)).save(file)
    for data in [by_path, by_index]:
        with pytest.raises(ValueError, match="is not the file that the index came from"):
            pickle.loads(data)(POINTS)
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    with pytest.raises(ValueError, match="damaged"):
        p2m.Ask(file)(POINTS)


def test_wrong_arguments_are_errors(path: Path) -> None:
    bad = POINTS.copy()
    bad[77, 1] = np.inf
    for ask, batch, error, message in [
        (p2m.Ask(path), pa.table({"x": [1.0], "y": [1.0]}), KeyError, "'z'"),
        (p2m.Ask(path), {"x": POINTS[:, 0], "y": POINTS[:, 1]}, KeyError, "'z'"),
        (p2m.Ask(path), pa.table({"x": ["a"], "y": [1.0], "z": [1.0]}), TypeError, "'x' has the type string"),
        (p2m.Ask(path), {**xyz(POINTS), "z": POINTS[:3, 2]}, ValueError, "three times"),
        (p2m.Ask(path), POINTS[:, :2], ValueError, "the last axis has x, y and z"),
        (p2m.Ask(path), [1.0, 2.0, 3.0], TypeError, "list is neither"),
        (p2m.Ask(path), pa.array([1.0]), TypeError, "neither a RecordBatch nor a Table"),
        (p2m.Ask(path, "g"), pa.table({"g": [1.0]}), TypeError, "'g' has the type double instead of a list"),
        (p2m.Ask(path, "g"), pa.table({"g": [[1.0, 2.0, 3.0], [1.0]]}), ValueError, "row 1 of 'g' has 1 numbers"),
        (p2m.Ask(path, "g"), pa.table({"g": [{"x": 1.0, "y": 2.0}]}), TypeError, "without a field 'z'"),
        (p2m.Ask(path, "g"), pa.table({"g": pa.array([[1.0, 2.0]], pa.list_(pa.float64(), 2))}), TypeError, "'g' has"),
        (p2m.Ask(path), pa.table(xyz(bad)), ValueError, "points: row 77 has a coordinate that is not finite"),
        (p2m.Ask(path), pa.table({**xyz(bad), "x": pa.array([None, *bad[1:, 0]])}), ValueError, "points: row 77 "),
    ]:
        with pytest.raises(error, match=message):
            ask(batch)
    for arguments, options, error, message in [
        ((3,), {}, TypeError, "index: int is neither a path nor"),
        ((path, ("x", "y")), {}, ValueError, "neither one name nor three"),
        ((path, "g", "colour"), {}, ValueError, "'colour' is none of"),
        ((path,), {"max_distance": -1.0}, ValueError, "max_distance: -1"),
        ((path,), {"certified": True, "epsilon": 0.5}, ValueError, "certified: "),
        ((path,), {"threads": 0}, ValueError, "threads: 0"),
    ]:
        with pytest.raises(error, match=message):
            p2m.Ask(*arguments, **options)


def test_files_of_parquet_are_read_and_written_by_batches(path: Path, index: p2m.Index, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    parquet.write_table(pa.table({"g": lists(POINTS)}), tmp_path / "points.parquet", row_group_size=100)
    ask = p2m.Ask(path, "g", FIELDS)
    file = parquet.ParquetFile(tmp_path / "points.parquet")
    with parquet.ParquetWriter(tmp_path / "answers.parquet", ask.schema(file.schema_arrow)) as writer:
        for batch in ask.iterate(file.iter_batches(batch_size=90)):
            writer.write_batch(batch)
    found = parquet.read_table(tmp_path / "answers.parquet")
    assert_same(columns(found), index.closest(POINTS, fields=FIELDS), FIELDS)
