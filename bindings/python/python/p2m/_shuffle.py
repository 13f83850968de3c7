"""The tasks of a shuffled query, in two phases. In each phase, a task asks one shard for the points of all blocks.

A block sends its points to shards, a shard answers the points from all blocks, and a block merges its answers. The
first phase sends each point to the shard with the nearest box. The second phase sends it to all other shards whose
boxes are within the distance that was found.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._arrays import FIELDS
from ._index_cache import IndexFile
from ._shards import SHARD_FIELDS, Shards

Columns = dict[str, NDArray[Any]]

_NEEDED = ("distance", "primitive", "key")
"""The fields that determine which shards are asked and which answer is the best."""

_NO_ANSWER = {
    "distance": np.inf,
    "primitive": -1,
    "point": np.nan,
    "feature": 255,
    "barycentric": np.nan,
    "lower_bound": np.inf,
    "key": np.inf,
}
"""The values of a missing answer. Its key is above all keys."""


class Query(NamedTuple):
    """The data of a query that all its tasks need."""

    source: IndexFile
    fields: tuple[str, ...]
    max_distance: float | None
    threads: int

    def open(self) -> Shards:
        """Return the shards, which a process opens once."""
        shards = self.source.open(self.threads)
        assert isinstance(shards, Shards)
        return shards

    def asked_fields(self) -> tuple[str, ...]:
        """Return the fields that shards answer."""
        return tuple(dict.fromkeys((*_NEEDED, *(name for name in self.fields if name in SHARD_FIELDS))))


class Sent(NamedTuple):
    """The points that a block sends to shards, grouped by shard."""

    shape: tuple[int, ...]
    """The leading axes of the block."""
    rows: NDArray[np.int64]
    """The row in the block of each point that is sent."""
    points: NDArray[Any]
    """The points that are sent, shape (n, 3)."""
    starts: NDArray[np.int64]
    """The index at which the points of each shard begin, and the number of all points."""

    @classmethod
    def of(
        cls,
        shape: tuple[int, ...],
        rows: NDArray[np.int64],
        points: NDArray[Any],
        shards: NDArray[np.int64],
        shard_count: int,
    ) -> Sent:
        """Group rows and their points by their shards."""
        order = np.argsort(shards, kind="stable")
        starts = np.searchsorted(shards[order], np.arange(shard_count + 1))
        return cls(shape, rows[order], points[order], starts)

    def piece(self, shard: int) -> NDArray[Any]:
        """Return the points that go to a shard."""
        return self.points[self.starts[shard] : self.starts[shard + 1]]

    def rows_of(self, shard: int) -> NDArray[np.int64]:
        """Return the rows of the points that go to a shard. No row occurs twice."""
        return self.rows[self.starts[shard] : self.starts[shard + 1]]


def send_to_nearest(block: NDArray[Any], query: Query) -> Sent:
    """Send each point of a block to the shard with the nearest box, if that is within the largest distance."""
    shards = query.open()
    points = block.reshape(-1, 3)
    nearest = shards.nearest_shards(points, max_distance=query.max_distance)
    rows = np.flatnonzero(nearest >= 0)
    return Sent.of(block.shape[:-1], rows, points[rows], nearest[rows], len(shards.shards))


def send_to_others(sent: Sent, answers: Sequence[Columns], query: Query) -> Sent:
    """Send points to all other shards that may have something nearer than the answer of the first shard."""
    shards = query.open()
    distances = np.concatenate([answer["distance"] for answer in answers] or [np.empty(0)])
    if query.max_distance is not None:
        distances = np.minimum(distances, query.max_distance)
    places, numbers = shards.shards_within(sent.points, distances)
    asked = np.repeat(np.arange(len(answers)), np.diff(sent.starts))
    is_other = numbers != asked[places]
    places, numbers = places[is_other], numbers[is_other]
    return Sent.of(sent.shape, sent.rows[places], sent.points[places], numbers, len(answers))


def ask(pieces: Sequence[NDArray[Any]], shard: int, query: Query) -> list[Columns]:
    """Return the answers of a shard to the pieces of all blocks. A shard that no point goes to is not loaded."""
    shards = query.open()
    answer = shards.closest_in_shard(
        np.concatenate(pieces), shard, fields=query.asked_fields(), max_distance=query.max_distance
    )
    ends = np.cumsum([len(piece) for piece in pieces])[:-1]
    return [dict(zip(answer.fields, parts)) for parts in zip(*(np.split(array, ends) for array in answer))]


def join(
    nearest: Sent, nearest_answers: Sequence[Columns], others: Sent, other_answers: Sequence[Columns], query: Query
) -> Columns:
    """Return the arrays of all fields of a block, with the answer of the least key and id for each point."""
    count = math.prod(nearest.shape)
    best: Columns = {}
    for name in query.asked_fields():
        dtype, tail = SHARD_FIELDS[name]
        best[name] = np.full((count, *tail), _NO_ANSWER[name], dtype)
    for sent, answers in ((nearest, nearest_answers), (others, other_answers)):
        for shard, answer in enumerate(answers):
            _keep_nearer(best, sent.rows_of(shard), answer)
    if "object" in query.fields:
        best["object"] = np.empty(count, FIELDS["object"][0])
        query.open()._fill_objects(best["primitive"], best["object"])
    return {name: best[name].reshape(nearest.shape + FIELDS[name][1]) for name in query.fields}


def _keep_nearer(best: Columns, rows: NDArray[np.int64], answer: Columns) -> None:
    """Replace the best answers of rows where other answers win. No row occurs twice."""
    (tier, square), (best_tier, best_square) = answer["key"].T, best["key"][rows].T
    is_first = (square == best_square) & (answer["primitive"] < best["primitive"][rows])
    wins = (tier < best_tier) | ((tier == best_tier) & ((square < best_square) | is_first))
    for name, values in answer.items():
        if name == "lower_bound":
            # Nothing in any of the shards that were asked is nearer than the least bound.
            best[name][rows] = np.minimum(best[name][rows], values)
        else:
            best[name][rows[wins]] = values[wins]
