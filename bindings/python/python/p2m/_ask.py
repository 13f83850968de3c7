"""A callable for batches of tables, which data engines call in any process."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import FIELDS, checked_limits, outputs, thread_count
from ._index import Index
from ._index_cache import index_source, opened
from ._shards import Shards


class Ask:
    """A function of batches of points that appends the closest points of one saved index.

    An object of this class is small, can be pickled, and opens the file of the index at its first call in each process.
    This suits the batch functions of engines: ``map_batches`` of Ray, ``mapInArrow`` of Spark (`iterate`), and loops
    over Parquet files. Answers are the same bits as those of `p2m.Index.closest`.

    Parameters
    ----------
    index : path-like, p2m.Index or p2m.Shards
        The file of a saved index, or an index that was loaded from one, of which the path is used. The folder of shards
        that `write_shards` wrote, or a `Shards`, whose limit of memory then holds in each process. If the file is there
        when the object is made, other processes check that their file has the same checksum. Any other index is pickled
        as its bytes together with the scene.
    columns : str or sequence of str, optional
        The names of three columns with x, y and z, or the name of one column of points. In Arrow the latter is a
        column of GeoArrow, either ``FixedSizeList[3]`` of numbers, which is not copied if they are float64 or float32,
        or ``Struct`` with x, y and z; lists of three numbers of any other type of list are accepted as well. In a
        dictionary it is an array of shape (n, 3), and in pandas a column of sequences.
    fields : str or sequence of str, optional
        The columns to append, as for `p2m.Index.closest`.
    prefix : str, optional
        The prefix of the names of the appended columns.
    max_distance, epsilon, max_visits, certified
        As for `p2m.Index.closest`.
    threads : int, optional
        The number of threads for a batch, by default 1 because engines run several processes.
    map : bool, optional
        Whether processes map the file, so that all processes of a machine share its memory. By default each has a copy.
        Do not change the file while it is mapped: the behaviour is then undefined.
    must_exist : bool, optional
        Whether the file has to exist when the object is made. By default only the processes that call it need the file.

    Raises
    ------
    ValueError
        For a wrong option.
    TypeError
        If `index` is neither a path nor an index.
    FileNotFoundError
        With `must_exist`, if there is no file.

    Examples
    --------
    >>> import os, tempfile
    >>> import numpy as np, p2m
    >>> path = os.path.join(tempfile.mkdtemp(), "triangle.p2m")
    >>> p2m.Index(p2m.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles=[[0, 1, 2]])).save(path)
    >>> ask = p2m.Ask(path)
    >>> ask({"x": np.array([1.0, 9.0]), "y": np.array([1.0, 0.0]), "z": np.array([2.0, 0.0])})["distance"]
    array([2., 5.])
    >>> ask(np.array([[1.0, 1.0, 2.0]]))
    {'distance': array([2.]), 'primitive': array([0])}
    >>> import pyarrow
    >>> points = pyarrow.table({"x": [1.0, None], "y": [1.0, 0.0], "z": [2.0, 0.0]})
    >>> ask(points).column("distance").to_pylist()
    [2.0, None]
    """

    def __init__(
        self,
        index: str | os.PathLike[str] | Index | Shards,
        columns: str | Sequence[str] = ("x", "y", "z"),
        fields: str | Sequence[str] = ("distance", "primitive"),
        *,
        prefix: str = "",
        max_distance: float | None = None,
        epsilon: float = 0.0,
        max_visits: int | None = None,
        certified: bool = False,
        threads: int = 1,
        map: bool = False,
        must_exist: bool = False,
    ) -> None:
        self._columns = (columns,) if isinstance(columns, str) else tuple(columns)
        if len(self._columns) not in (1, 3):
            raise ValueError(f"columns: {self._columns} are neither one name nor three")
        self._fields = (fields,) if isinstance(fields, str) else tuple(fields)
        outputs(self._fields, (0,), None, FIELDS, self._fields)
        self._prefix = prefix
        checked_limits(max_distance, epsilon, max_visits, certified)
        self._options: dict[str, Any] = {
            "max_distance": max_distance,
            "epsilon": epsilon,
            "max_visits": max_visits,
            "certified": certified,
        }
        self._threads = thread_count(threads)
        self._source = index_source(index, map)
        if must_exist and not isinstance(self._source, Index):
            os.stat(self._source.path)
        self._opened: Index | Shards | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": None}

    def __repr__(self) -> str:
        source = repr(self._source) if isinstance(self._source, Index) else repr(self._source.path)
        return f"p2m.Ask({source}, columns={self._columns}, fields={self._fields})"

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the columns that are appended."""
        return tuple(self._prefix + name for name in self._fields)

    def __call__(self, batch: Any) -> Any:
        """Return a batch with the answers for its points.

        Parameters
        ----------
        batch : pyarrow.RecordBatch, pyarrow.Table, dict of ndarray, ndarray, pandas.DataFrame or polars.DataFrame
            The batch of points. An ndarray has the shape (..., 3).

        Returns
        -------
        The same type as `batch`, or dict of ndarray for an ndarray
            The batch with the answers as further columns. ``point`` and ``barycentric`` are columns of
            ``FixedSizeList[3]`` in Arrow, of arrays in pandas, and arrays of shape (n, 3) in dictionaries. A batch
            without points has empty answers.

            In Arrow and polars, the answers of a point that is null, or has a null coordinate, are null. Where nothing
            is within `max_distance`, the answers are those of `p2m.Index.closest`: an infinite distance and the
            primitive -1. pandas has no difference between nan and a missing number, so both are errors there.

        Raises
        ------
        ValueError
            If a coordinate is not finite (the message has the row of the batch), the batch has a column with the name
            of an answer, or the file of the index is damaged or not the one that the object was made for.
        KeyError
            If a column is missing.
        TypeError
            For a batch or a column of a wrong type.
        OSError
            If the file of the index cannot be read.
        """
        if isinstance(batch, np.ndarray):
            return dict(zip(self.names, self._answers(batch)))
        if isinstance(batch, Mapping):
            return self._ask_mapping(batch)
        library = type(batch).__module__.partition(".")[0]
        ways = {"pyarrow": self._ask_arrow, "pandas": self._ask_pandas, "polars": self._ask_polars}
        if library in ways:
            return ways[library](batch)
        raise TypeError(
            f"batch: {type(batch).__name__} is neither a RecordBatch or Table of Arrow, a dictionary of arrays, an "
            "array, nor a DataFrame of pandas or polars"
        )

    def iterate(self, batches: Iterable[Any]) -> Iterator[Any]:
        """Yield the answers to batches, one after the other, for ``DataFrame.mapInArrow`` of Spark.

        Parameters
        ----------
        batches : iterable
            Batches of any type that objects of this class take.

        Examples
        --------
        >>> import numpy as np, p2m
        >>> ask = p2m.Ask(p2m.Index(p2m.Scene([[0, 0, 0]], points=[0])), fields="distance")
        >>> [answer["distance"].tolist() for answer in ask.iterate([np.eye(3), np.ones((1, 3)) * 2])]
        [[1.0, 1.0, 1.0], [3.4641016151377544]]
        """
        for batch in batches:
            yield self(batch)

    def schema(self, schema: Any) -> Any:
        """Return the schema of the answers to batches of Arrow with a schema.

        Parameters
        ----------
        schema : pyarrow.Schema
            The schema of the batches with the points.

        Returns
        -------
        pyarrow.Schema

        Examples
        --------
        >>> import p2m, pyarrow
        >>> ask = p2m.Ask("scene.p2m", fields=("distance", "primitive"))
        >>> ask.schema(pyarrow.schema({"x": "float64", "y": "float64", "z": "float64"})).names
        ['x', 'y', 'z', 'distance', 'primitive']
        """
        import pyarrow

        self._check_new(schema.names)
        for name, field in zip(self.names, self._fields):
            schema = schema.append(pyarrow.field(name, _arrow_type(field)))
        return schema

    def spark_schema(self, schema: Any) -> Any:
        """Return the schema of the answers to data frames of Spark with a schema, for ``DataFrame.mapInArrow``.

        Parameters
        ----------
        schema : pyspark.sql.types.StructType
            The schema of the data frame with the points.

        Returns
        -------
        pyspark.sql.types.StructType

        Raises
        ------
        ValueError
            For the fields ``point``, ``barycentric`` and ``feature``, whose Arrow types Spark does not accept.
        """
        for field in self._fields:
            dtype, tail = FIELDS[field]
            if tail or dtype == np.uint8:
                raise ValueError(f"fields: Spark does not take {field!r} from Arrow, as {_arrow_type(field)}")
        from pyspark.sql.pandas.types import from_arrow_schema
        from pyspark.sql.types import StructType

        import pyarrow

        self._check_new(schema.names)
        added = pyarrow.schema([(name, _arrow_type(field)) for name, field in zip(self.names, self._fields)])
        return StructType([*schema.fields, *from_arrow_schema(added).fields])

    def _check_new(self, names: Iterable[str]) -> None:
        for name in names:
            if name in self.names:
                raise ValueError(f"batch: there is a column {name!r} already: use another prefix")

    def _index(self) -> Index | Shards:
        if self._opened is None:
            self._opened = opened(self._source, self._threads)
        return self._opened

    def _answers(self, points: NDArray[Any]) -> list[NDArray[Any]]:
        """Return the arrays of all fields."""
        if points.size == 0 and points.shape[-1:] == (3,):
            return list(outputs(self._fields, points.shape[:-1], None, FIELDS, self._fields).values())
        return list(self._index().closest(points, fields=self._fields, threads=self._threads, **self._options))

    def _ask_mapping(self, batch: Mapping[str, Any]) -> dict[str, Any]:
        self._check_new(batch)
        columns = [np.asarray(batch[name]) for name in self._columns]
        points = columns[0] if len(columns) == 1 else _joined(columns)
        return {**batch, **dict(zip(self.names, self._answers(points)))}

    def _ask_arrow(self, batch: Any) -> Any:
        import pyarrow

        if not isinstance(batch, (pyarrow.RecordBatch, pyarrow.Table)):
            raise TypeError(f"batch: {type(batch).__name__} is neither a RecordBatch nor a Table")
        schema = self.schema(batch.schema)
        answers = self._arrow_answers(batch)
        return type(batch).from_arrays([*batch.columns, *answers], schema=schema)

    def _arrow_answers(self, batch: Any) -> list[Any]:
        """Return the arrays of Arrow of all fields."""
        points, valid = arrow_points(batch, self._columns)
        if valid is None:
            return [_arrow_array(array, None) for array in self._answers(points)]
        # Points without answers are searched for as well, so that the row in a message counts all points of the batch.
        points = np.where(valid[:, np.newaxis], points, points.dtype.type(0.0))
        return [_arrow_array(array, ~valid) for array in self._answers(points)]

    def _ask_pandas(self, frame: Any) -> Any:
        self._check_new(frame.columns)
        _check_present(self._columns, frame.columns)
        columns = [frame[name] for name in self._columns]
        if len(columns) == 1:
            points = np.array(columns[0].tolist(), np.float64).reshape(len(frame), -1)
        else:
            points = _joined([column.to_numpy(np.float64, na_value=np.nan) for column in columns])
        answers = self._answers(points.reshape(0, 3) if len(frame) == 0 else points)
        return frame.assign(**{
            name: list(array) if array.ndim > 1 else array for name, array in zip(self.names, answers)
        })

    def _ask_polars(self, frame: Any) -> Any:
        import polars

        self._check_new(frame.columns)
        _check_present(self._columns, frame.columns)
        answers = self._arrow_answers(frame.select(self._columns).to_arrow())
        return frame.with_columns([
            polars.Series(name, polars.from_arrow(array)) for name, array in zip(self.names, answers)
        ])


def _check_present(columns: Sequence[str], names: Iterable[str]) -> None:
    for name in columns:
        if name not in names:
            raise KeyError(name)


def _joined(columns: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Return points of shape (n, 3) of three columns."""
    for column in columns:
        if column.ndim != 1 or len(column) != len(columns[0]):
            raise ValueError(f"columns: the shapes {', '.join(str(c.shape) for c in columns)} are not three times (n,)")
        if column.dtype.kind not in "iuf":
            raise TypeError(f"columns: the type is {column.dtype}, but coordinates are real numbers")
    is_single = all(column.dtype == np.float32 for column in columns)
    points = np.empty((len(columns[0]), 3), np.float32 if is_single else np.float64)
    for axis, column in enumerate(columns):
        points[:, axis] = column
    return points


def _arrow_type(field: str) -> Any:
    """Return the Arrow type of a field."""
    import pyarrow

    dtype, tail = FIELDS[field]
    item = pyarrow.from_numpy_dtype(dtype)
    return pyarrow.list_(item, tail[0]) if tail else item


def _arrow_array(array: NDArray[Any], nulls: NDArray[np.bool_] | None) -> Any:
    """Return an Arrow array, with rows of three as `FixedSizeList`."""
    import pyarrow

    if array.ndim == 1:
        return pyarrow.array(array, mask=nulls)
    values = pyarrow.array(array.reshape(-1))
    mask = None if nulls is None else pyarrow.array(nulls)
    return pyarrow.FixedSizeListArray.from_arrays(values, array.shape[1], mask=mask)


def arrow_points(batch: Any, columns: Sequence[str]) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
    """Return the points of an Arrow batch as an array of shape (n, 3), and which of them are valid unless all are.

    The coordinates of invalid points are arbitrary.
    """
    _check_present(columns, batch.schema.names)
    arrays = [_one_chunk(batch.column(name)) for name in columns]
    if len(arrays) == 1:
        return _geometry(arrays[0], columns[0])
    return _three(arrays, columns)


def _one_chunk(column: Any) -> Any:
    """Return a column as one array, which is not copied if it has one chunk."""
    import pyarrow

    if isinstance(column, pyarrow.ChunkedArray):
        column = column.chunk(0) if column.num_chunks == 1 else column.combine_chunks()
    return column.storage if isinstance(column, pyarrow.ExtensionArray) else column


def _three(arrays: Sequence[Any], names: Sequence[str]) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
    """Return the points of three arrays of coordinates, and which are valid."""
    coordinates, is_valid = zip(*(_numbers(array, name) for array, name in zip(arrays, names)))
    masks = [mask for mask in is_valid if mask is not None]
    return _joined(coordinates), np.logical_and.reduce(masks) if masks else None


def _numbers(array: Any, name: str) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
    """Return the numbers of an array of Arrow, and which are valid if some are not."""
    import pyarrow

    kind = array.type
    if not (pyarrow.types.is_floating(kind) or pyarrow.types.is_integer(kind) or pyarrow.types.is_decimal(kind)):
        if not pyarrow.types.is_null(kind):
            raise TypeError(f"columns: {name!r} has the type {kind}, but coordinates are real numbers")
    if not pyarrow.types.is_float32(kind):
        array = array.cast(pyarrow.float64())
    valid = None if array.null_count == 0 else array.is_valid().to_numpy(zero_copy_only=False)
    dtype = np.dtype(np.float32 if pyarrow.types.is_float32(array.type) else np.float64)
    data = array.buffers()[1]
    if data is None or len(array) == 0:
        return np.zeros(len(array), dtype), valid
    return np.frombuffer(data, dtype, len(array), array.offset * dtype.itemsize), valid


def _geometry(array: Any, name: str) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
    """Return the points of a column of points, and which are valid."""
    import pyarrow

    kind = array.type
    present = None if array.null_count == 0 else array.is_valid().to_numpy(zero_copy_only=False)
    if pyarrow.types.is_struct(kind):
        missing = [axis for axis in "xyz" if kind.get_field_index(axis) < 0]
        if missing:
            raise TypeError(f"columns: {name!r} has the type {kind}, without a field {missing[0]!r}")
        points, valid = _three([array.field(axis) for axis in "xyz"], [f"{name}.{axis}" for axis in "xyz"])
    elif pyarrow.types.is_fixed_size_list(kind) and kind.list_size == 3:
        numbers, is_valid = _numbers(array.values.slice(array.offset * 3, len(array) * 3), name)
        points = numbers.reshape(-1, 3)
        valid = None if is_valid is None else np.all(is_valid.reshape(-1, 3), axis=1)
    elif pyarrow.types.is_list(kind) or pyarrow.types.is_large_list(kind):
        lengths = array.value_lengths().fill_null(3).to_numpy(zero_copy_only=False)
        if np.any(lengths != 3):
            row = int(np.nonzero(lengths != 3)[0][0])
            raise ValueError(f"columns: row {row} of {name!r} has {lengths[row]} numbers instead of 3")
        numbers, is_valid = _numbers(array.flatten(), name)
        points = np.zeros((len(array), 3), numbers.dtype)
        valid = None
        rows = slice(None) if present is None else present
        points[rows] = numbers.reshape(-1, 3)
        if is_valid is not None:
            valid = np.ones(len(array), np.bool_)
            valid[rows] = is_valid.reshape(-1, 3).all(axis=1)
    else:
        raise TypeError(f"columns: {name!r} has the type {kind} instead of a list of three numbers or a struct of them")
    if present is not None:
        valid = present if valid is None else np.logical_and(valid, present)
    return points, valid
