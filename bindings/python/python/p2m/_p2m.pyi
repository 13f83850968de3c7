from collections.abc import Callable
from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CudaIndex",
    "HitList",
    "Index",
    "NearList",
    "PairList",
    "Scene",
    "ShardWriter",
    "Shards",
    "__version__",
    "advise",
    "align",
    "backends",
    "closest",
    "default_threads",
    "deviation_objects",
    "deviation_on_vertices",
    "deviation_page",
    "deviation_ply",
    "deviation_sheet",
    "deviation_statistics",
    "grid_around",
    "grid_of_offset",
    "hausdorff",
    "is_any_within",
    "isolated_points",
    "k_nearest",
    "load",
    "load_bytes",
    "main",
    "rays",
    "read_points",
    "sample_box",
    "sample_surface",
    "scene_page",
    "within",
    "write_bytes",
]

__version__: str

_Coordinates = NDArray[np.float64] | NDArray[np.float32]
_Progress = Callable[[int, int], object] | None
_Arrays = dict[str, NDArray[Any]]
_Path = str | PathLike[str]

def backends() -> list[str]: ...
def default_threads() -> int: ...
def load(path: _Path, map: bool, threads: int) -> Index: ...
def write_bytes(path: _Path, bytes: bytes) -> None: ...
def load_bytes(bytes: bytes, backend: str, threads: int) -> Index: ...
def advise(
    scene: Scene,
    queries: int,
    region: str,
    points: _Coordinates | None,
    max_bytes: int | None,
    threads: int,
) -> list[tuple[str, tuple[float, float, float, float], bool, float | None, str]]: ...
def deviation_statistics(values: NDArray[np.float64]) -> dict[str, Any]: ...
def deviation_page(
    scan: Scene,
    values: NDArray[np.float64],
    primitives: NDArray[np.uint32],
    scene: Scene,
    is_signed: bool,
    limit: float,
    tolerance: float | None,
    is_y_up: bool,
    texts: tuple[str, str, str],
) -> str: ...
def grid_around(
    scene: Scene, resolution: int, scale: float
) -> tuple[tuple[float, float, float], float, tuple[int, int, int]]: ...
def grid_of_offset(
    scene: Scene, distance: float, resolution: int
) -> tuple[tuple[float, float, float], float, tuple[int, int, int]]: ...
def scene_page(
    scene: Scene,
    texts: tuple[str, str, str],
    is_y_up: bool,
    is_live: bool,
    field: tuple[tuple[tuple[float, float, float], float, tuple[int, int, int]], NDArray[np.float32]] | None,
) -> str: ...
def deviation_objects(
    scene: Scene, values: NDArray[np.float64], primitives: NDArray[np.uint32]
) -> list[tuple[str, dict[str, Any]]]: ...
def deviation_sheet(
    scan: Scene,
    values: NDArray[np.float64],
    primitives: NDArray[np.uint32],
    scene: Scene,
    is_signed: bool,
    limit: float,
    tolerance: float | None,
    required: float | None,
    is_y_up: bool,
    head: list[tuple[str, str]],
    texts: tuple[str, str, str],
    is_pdf: bool,
) -> bytes: ...
def deviation_on_vertices(
    scene: Scene,
    primitives: NDArray[np.uint32],
    barycentric: NDArray[np.float64],
    values: NDArray[np.float64],
) -> NDArray[np.float64]: ...
def isolated_points(points: _Coordinates, threads: int) -> NDArray[np.bool_]: ...
def deviation_ply(scan: Scene, values: NDArray[np.float64], limit: float) -> bytes: ...
def align(
    scan: _Coordinates,
    index: Index,
    point_to_point: bool,
    scale: bool,
    overlap: float,
    search: bool,
    threads: int,
) -> dict[str, Any]: ...
def read_points(
    path: _Path, coordinates: list[str], id: str | None
) -> tuple[NDArray[np.float64], list[str] | None, str | None]: ...
def sample_surface(
    scene: Scene, count: int, sigmas: list[float], seed: int, threads: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]: ...
def sample_box(
    low: list[float], high: list[float], count: int, seed: int, threads: int
) -> NDArray[np.float64]: ...
def main(arguments: list[str]) -> int: ...
def hausdorff(
    first: Scene,
    first_index: Index | None,
    second: Index,
    tolerance: float,
    max_queries: int,
    threads: int,
    progress: _Progress,
) -> dict[str, Any] | None: ...
def closest(
    index: Index | Shards,
    points: _Coordinates,
    out: _Arrays,
    max_distance: float,
    epsilon: float,
    max_visits: int | None,
    certified: bool,
    threads: int,
    progress: _Progress,
) -> None: ...
def k_nearest(
    index: Index | Shards,
    points: _Coordinates,
    k: int,
    out: _Arrays,
    max_distance: float,
    threads: int,
    progress: _Progress,
) -> None: ...
def within(
    index: Index | Shards,
    points: _Coordinates,
    radius: float,
    counts: NDArray[np.int64],
    threads: int,
    progress: _Progress,
) -> NearList: ...
def is_any_within(
    index: Index | Shards,
    points: _Coordinates,
    radius: float,
    out: _Arrays,
    threads: int,
    progress: _Progress,
) -> None: ...
def rays(
    index: Index | Shards,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    mode: str,
    out: _Arrays,
    t_min: float,
    t_max: float,
    radius: float,
    threads: int,
    progress: _Progress,
) -> HitList | None: ...
@final
class Scene:
    def __new__(
        cls,
        vertices: _Coordinates,
        triangles: NDArray[np.uint32],
        segments: NDArray[np.uint32],
        points: NDArray[np.uint32],
    ) -> Scene: ...
    @staticmethod
    def read(path: _Path) -> Scene: ...
    def write(self, path: _Path) -> None: ...
    @staticmethod
    def joined(parts: list[tuple[str, Scene]]) -> Scene: ...
    def with_sources(self, triangles: NDArray[np.uint32]) -> Scene: ...
    @staticmethod
    def from_bytes(bytes: bytes) -> Scene: ...
    def to_bytes(self) -> bytes: ...
    def moved(self, vertices: _Coordinates) -> Scene: ...
    def transformed(self, transform: NDArray[np.float64]) -> Scene: ...
    def counts(self) -> tuple[int, int, int, int]: ...
    def bounds(self) -> list[list[float]] | None: ...
    def vertices(self) -> NDArray[np.float64]: ...
    def triangles(self) -> NDArray[np.int64]: ...
    def segments(self) -> NDArray[np.int64]: ...
    def points(self) -> NDArray[np.int64]: ...
    def ids(self, vertices: int) -> NDArray[np.int64]: ...
    def sources(self) -> NDArray[np.int64]: ...
    def objects(self) -> list[tuple[str, int, int]]: ...
    def skipped(self) -> list[str]: ...
    def unit(self) -> str | None: ...

@final
class NearList:
    def __len__(self) -> int: ...
    def fill(self, out: _Arrays) -> None: ...

@final
class HitList:
    def __len__(self) -> int: ...
    def fill(self, out: _Arrays) -> None: ...

@final
class PairList:
    def __len__(self) -> int: ...
    def fill(self, out: _Arrays) -> None: ...

@final
class Index:
    @staticmethod
    def build(
        scene: Scene,
        backend: str,
        threads: int,
        progress: _Progress,
        directions: str | None = None,
        resolution: float | None = None,
        queries: int | None = None,
        max_bytes: int | None = None,
    ) -> Index: ...
    def refitted(self, scene: Scene, threads: int) -> Index: ...
    def scene(self) -> Scene: ...
    def backend(self) -> str: ...
    def origin(self) -> tuple[PathLike[str], str, bool] | None: ...
    def info(self) -> dict[str, Any]: ...
    def save(self, path: _Path) -> None: ...
    def to_bytes(self) -> bytes: ...
    def normals(
        self, primitive: NDArray[np.int64], feature: NDArray[np.uint8], out: _Arrays
    ) -> None: ...
    def deviations_from_planes(
        self, points: _Coordinates, max_distance: float, threads: int
    ) -> NDArray[np.float64] | None: ...
    def sign_rule(self, sign: str, threads: int) -> tuple[str, str | None]: ...
    def contains(
        self,
        points: _Coordinates,
        out: _Arrays,
        sign: str,
        threads: int,
        progress: _Progress,
    ) -> None: ...
    def signed_distance(
        self,
        points: _Coordinates,
        out: _Arrays,
        sign: str,
        inside_is_negative: bool,
        max_distance: float,
        threads: int,
        progress: _Progress,
    ) -> None: ...
    def field(
        self,
        origin: tuple[float, float, float],
        spacing: float,
        first: tuple[int, int, int],
        counts: tuple[int, int, int],
        sign: str | None,
        band: float,
        threads: int,
        progress: _Progress,
    ) -> NDArray[np.float32]: ...
    def offset_surface(
        self,
        origin: tuple[float, float, float],
        spacing: float,
        counts: tuple[int, int, int],
        values: NDArray[np.float32],
        distance: float,
        sign: str | None,
        threads: int,
    ) -> tuple[Scene, float, float]: ...
    def closest_to(
        self,
        shapes: NDArray[np.float64],
        width: int,
        out: _Arrays,
        radius: float,
        max_distance: float,
        certified: bool,
        solid: bool,
        threads: int,
        progress: _Progress,
    ) -> None: ...
    def solid_note(self, threads: int) -> str | None: ...
    def closest_pairs(
        self,
        other: Index,
        transforms: NDArray[np.float64] | None,
        max_distance: float,
        certified: bool,
        solid: bool,
        threads: int,
        progress: _Progress,
    ) -> PairList: ...
    def do_intersect(
        self,
        other: Index,
        transforms: NDArray[np.float64] | None,
        threads: int,
        progress: _Progress,
    ) -> NDArray[np.bool_]: ...
    def pairs_within(
        self,
        other: Index,
        transforms: NDArray[np.float64] | None,
        max_distance: float,
        threads: int,
    ) -> PairList: ...
    def first_contact(
        self,
        starts: NDArray[np.float64],
        ends: NDArray[np.float64],
        out: _Arrays,
        radius: float,
        tolerance: float,
        ignore_opening: bool,
        threads: int,
        progress: _Progress,
    ) -> None: ...

@final
class Shards:
    def __new__(cls, path: _Path, max_bytes: int, map: bool) -> Shards: ...
    def backend(self) -> str: ...
    def counts(self) -> tuple[int, int, int]: ...
    def bounds(self) -> list[list[float]] | None: ...
    def objects(self) -> list[tuple[str, int, int]]: ...
    def shards(self) -> list[tuple[str, int, int, list[list[float]]]]: ...
    def checksum(self) -> str: ...
    def loads(self) -> int: ...
    def nearest_shards(
        self, points: _Coordinates, out: _Arrays, max_distance: float, threads: int
    ) -> None: ...
    def shards_within(
        self, points: _Coordinates, distances: NDArray[np.float64], threads: int
    ) -> list[NDArray[np.int64]]: ...
    def closest_in_shard(
        self,
        points: _Coordinates,
        shard: int,
        out: _Arrays,
        max_distance: float,
        threads: int,
        progress: _Progress,
    ) -> None: ...
    def contains(
        self,
        points: _Coordinates,
        out: _Arrays,
        threads: int,
        progress: _Progress,
    ) -> None: ...

@final
class ShardWriter:
    def __new__(cls, folder: _Path, max_bytes: int, backend: str, replace: bool) -> ShardWriter: ...
    def add(self, scene: Scene) -> None: ...
    def close(self) -> None: ...
    def finish(self, threads: int, progress: _Progress) -> None: ...

@final
class CudaIndex:
    @staticmethod
    def build(
        index: Index,
        threads: int,
        ordinal: int,
        reach: float,
        memory: int | None,
        reorder: bool,
        checked: int,
    ) -> CudaIndex: ...
    def closest(self, points: NDArray[np.float64], out: _Arrays, max_distance: float) -> tuple[int, int, float]: ...
    def closest_on_card(
        self, queries: tuple[int, int, bool], columns: list[int], max_distance: float, stream: int
    ) -> tuple[int, int, float]: ...
    def size(self) -> tuple[int, int, int]: ...
