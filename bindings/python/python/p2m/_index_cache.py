"""The cache of open index files of a process, and the pickling of indexes by reference to their files."""

from __future__ import annotations

import copyreg
import errno
import os
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar, cast

from . import _p2m
from ._arrays import thread_count
from ._index import Index
from ._shards import MANIFEST_FILE, Shards, is_shard_folder, manifest_checksum, max_bytes_of, shard_folder

MAX_OPENED = 4
"""The number of indexes that a process keeps open, the most recently used ones."""

_Raw = TypeVar("_Raw", _p2m.Index, _p2m.Shards)

_HEADER_BYTES = 64
_MAGIC = b"\x89P2M\r\n\x1a\n"
_CHECKSUM = slice(24, 32)
"""The number of bytes of the header, which contains a checksum of the whole file."""


class _FileVersion(NamedTuple):
    """The version of a file, which another one may replace at the same path, and whether it is mapped."""

    path: str
    size: int
    modified_ns: int
    inode: int
    checksum: str | None
    is_mapped: bool
    max_bytes: int | None = None

    def is_same_use(self, other: _FileVersion) -> bool:
        """Return whether another version may replace this one."""
        return (self.path, self.is_mapped, self.max_bytes) == (other.path, other.is_mapped, other.max_bytes)


class _Entry:
    """An index that is open, or that one thread is opening while others wait for it."""

    def __init__(self, raw: _p2m.Index | _p2m.Shards | None = None) -> None:
        self.lock = threading.Lock()
        self.raw = raw


_lock = threading.Lock()
_entries: OrderedDict[_FileVersion, _Entry] = OrderedDict()


def _after_fork() -> None:
    """Replace the locks in a child process, because they may be held by threads that do not exist there."""
    global _lock
    _lock = threading.Lock()
    for version, entry in list(_entries.items()):
        if entry.raw is None:
            del _entries[version]
        else:
            _entries[version] = _Entry(entry.raw)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def clear_opened() -> None:
    """Forget the indexes of files and the shards that this process keeps open.

    A process keeps the four indexes that it used last among those that `Ask`, `p2m.dask` and `pickle` opened. Their
    memory is free as soon as nothing else uses them.

    Examples
    --------
    >>> import p2m
    >>> p2m.clear_opened()
    """
    with _lock:
        _entries.clear()


def read_checksum(path: str) -> str | None:
    """Return the checksum in the header of a saved index, or None if the file does not begin with such a header."""
    with open(path, "rb") as file:
        header = file.read(_HEADER_BYTES)
    if len(header) < _HEADER_BYTES or not header.startswith(_MAGIC):
        return None
    return f"{int.from_bytes(header[_CHECKSUM], 'little'):016x}"


def _version(path: str, checksum: str | None, is_mapped: bool, max_bytes: int | None = None) -> _FileVersion:
    """Return the version of a file, whose checksum has been read."""
    real = os.path.realpath(path)
    status = os.stat(real)
    return _FileVersion(real, status.st_size, status.st_mtime_ns, status.st_ino, checksum, is_mapped, max_bytes)


def _open_version(version: _FileVersion, open_new: Callable[[], _Raw]) -> _Raw:
    with _lock:
        for other in [key for key in _entries if key.is_same_use(version)]:
            if other != version:
                del _entries[other]
        entry = _entries.setdefault(version, _Entry())
        _entries.move_to_end(version)
        while len(_entries) > MAX_OPENED:
            _entries.popitem(last=False)
    with entry.lock:
        if entry.raw is None:
            try:
                entry.raw = open_new()
            except BaseException:
                with _lock:
                    if _entries.get(version) is entry:
                        del _entries[version]
                raise
        # The path tells index files and manifests apart, so the entry has the type that this function opens.
        return cast(_Raw, entry.raw)


def _open_checked(
    wrong: str,
    checksum: str | None,
    read_version: Callable[[], _FileVersion],
    open_new: Callable[[], _Raw],
    checksum_of: Callable[[_Raw], str | None],
) -> _Raw:
    """Open a path and check the checksum. `wrong` begins the message if it is another one."""
    while True:
        version = read_version()
        if checksum is not None and version.checksum not in (None, checksum):
            raise ValueError(f"{wrong} came from: its checksum is {version.checksum} instead of {checksum}")
        raw = _open_version(version, open_new)
        # The file may have been replaced after its checksum was read.
        if checksum_of(raw) == version.checksum:
            return raw


def open_index(
    path: str | os.PathLike[str], *, checksum: str | None = None, map: bool = False, threads: int | None = None
) -> Index:
    """Return the index that is saved at a path. This process opens it once.

    Later calls return the same index until another file is at the path. If two threads request a path at the same time,
    it is opened once. The process keeps `MAX_OPENED` indexes open.

    Parameters
    ----------
    path : path-like
        The file of a saved index.
    checksum : str, optional
        The checksum that the file has to have.
    map : bool, optional
        Whether the file is mapped, as for `p2m.load`.
    threads : int, optional
        The number of threads for queries, as for `p2m.load`.

    Raises
    ------
    OSError
        If the file cannot be read, or the path is a directory.
    ValueError
        If the file is damaged, is not a saved index, or has another checksum.
    """
    absolute = os.path.abspath(os.fspath(path))
    count = thread_count(threads)
    if os.path.isdir(absolute):
        raise IsADirectoryError(
            errno.EISDIR, "A saved index is a file, and this is a directory without shards", absolute
        )
    raw = _open_checked(
        f"{absolute} is not the file that the index",
        checksum,
        lambda: _version(absolute, read_checksum(absolute), map),
        lambda: _p2m.load(absolute, map, count),
        lambda raw: (raw.origin() or (None, None))[1],
    )
    return Index._from_raw(raw, threads)


def open_shards(
    path: str | os.PathLike[str],
    *,
    checksum: str | None = None,
    max_bytes: int | None = None,
    map: bool = False,
    threads: int | None = None,
) -> Shards:
    """Return the shards in a folder. This process opens them once for each limit of memory.

    Parameters
    ----------
    path, max_bytes, map, threads
        As for `p2m.Shards`.
    checksum : str, optional
        The checksum that the manifest has to have.

    Raises
    ------
    OSError
        If the manifest cannot be read.
    ValueError
        If the manifest is damaged, or has another checksum.
    """
    folder = shard_folder(path)
    limit = max_bytes_of(max_bytes)
    manifest = os.path.join(folder, MANIFEST_FILE)
    raw = _open_checked(
        f"{manifest} is not the manifest that the shards",
        checksum,
        lambda: _version(manifest, manifest_checksum(folder), map, max_bytes),
        lambda: _p2m.Shards(folder, limit, map),
        lambda raw: raw.checksum(),
    )
    return Shards.__new__(Shards)._set(raw, folder, max_bytes, map, threads)


@dataclass(frozen=True)
class IndexFile:
    """The file of a saved index, or the folder of shards, for other processes to open."""

    path: str
    checksum: str | None
    """The checksum that the file or the manifest has to have, or None for any."""
    is_mapped: bool
    max_bytes: int | None = None
    """The memory that shards may take in a process."""

    def open(self, threads: int | None) -> Index | Shards:
        """Return the index or the shards, which a process opens once."""
        # Only the process that opens the path can be sure what is there.
        if not is_shard_folder(self.path):
            return open_index(self.path, checksum=self.checksum, map=self.is_mapped, threads=threads)
        return open_shards(
            self.path, checksum=self.checksum, max_bytes=self.max_bytes, map=self.is_mapped, threads=threads
        )


def index_source(index: Any, map: bool) -> IndexFile | Index:
    """Return the file of an index, or the folder of shards, and an index that came from no file as it is."""
    if isinstance(index, Shards):
        return IndexFile(index.path, index._manifest_checksum, index._is_mapped or map, index.max_bytes)
    if isinstance(index, Index):
        origin = index._raw.origin()
        if origin is None:
            if map:
                raise ValueError("map: the index was not loaded from a file")
            return index
        return IndexFile(os.fspath(origin[0]), origin[1], origin[2] or map)
    if not isinstance(index, (str, os.PathLike)):
        raise TypeError(f"index: {type(index).__name__} is neither a path nor a p2m.Index or p2m.Shards")
    path = os.path.abspath(os.fspath(index))
    try:
        checksum = manifest_checksum(shard_folder(path)) if is_shard_folder(path) else read_checksum(path)
    except OSError:
        # The path may exist only in the file system of other machines.
        checksum = None
    return IndexFile(path, checksum, map)


def opened(source: IndexFile | Index, threads: int | None) -> Index | Shards:
    """Return the index or the shards of a source."""
    return source.open(threads) if isinstance(source, IndexFile) else source


def _load_bytes(data: bytes, backend: str, threads: int | None) -> Index:
    return Index._from_raw(_p2m.load_bytes(data, backend, thread_count(threads)), threads)


def _reduce(index: Index | Shards) -> tuple[Any, ...]:
    """Pickle an index as the path of its file or folder, or as bytes if it came from no file."""
    source = index_source(index, False)
    if isinstance(source, IndexFile):
        return source.open, (index._threads,)
    return _load_bytes, (source._raw.to_bytes(), source.backend, source._threads)


copyreg.pickle(Index, _reduce)
copyreg.pickle(Shards, _reduce)
