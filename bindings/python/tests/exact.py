"""Closest triangles, insides and hits of rays in exact arithmetic, by textbook methods and without code of p2m.

Every finite float is a fraction. Floats are used only to leave out triangles that are far from mattering, with margins
of millions of roundings.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np

Vector = tuple[Fraction, Fraction, Fraction]

MARGIN = 1e-9
"""The margin of the filters in floats, relative to the coordinates. Their rounding is below 1e-14."""


def vector(values: Sequence[float] | np.ndarray) -> Vector:
    """Return the exact coordinates of a point."""
    x, y, z = (Fraction(float(value)) for value in values)
    return x, y, z


def minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a: Vector, b: Vector) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def squared_distance_of_segment(q: Vector, a: Vector, b: Vector) -> Fraction:
    """Return the squared distance of a point from a segment."""
    edge, offset = minus(b, a), minus(q, a)
    length = dot(edge, edge)
    t = min(max(dot(offset, edge) / length, Fraction(0)), Fraction(1)) if length else Fraction(0)
    rest = minus(offset, (t * edge[0], t * edge[1], t * edge[2]))
    return dot(rest, rest)


def squared_distance(q: Vector, triangle: Sequence[Vector]) -> Fraction:
    """Return the squared distance of a point from a triangle, which may be degenerate."""
    a, b, c = triangle
    normal = cross(minus(b, a), minus(c, a))
    area = dot(normal, normal)
    pairs = ((a, b), (b, c), (c, a))
    if area and all(dot(cross(minus(end, start), minus(q, start)), normal) >= 0 for start, end in pairs):
        return dot(minus(q, a), normal) ** 2 / area
    return min(squared_distance_of_segment(q, start, end) for start, end in pairs)


def squared_distance_of_segments(p: Sequence[Vector], q: Sequence[Vector]) -> Fraction:
    """Return the squared distance of two segments, which may be degenerate."""
    u, v, w = minus(p[1], p[0]), minus(q[1], q[0]), minus(p[0], q[0])
    a, b, c, d, e = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    determinant = a * c - b * b
    if determinant:
        s, t = (b * e - c * d) / determinant, (a * e - b * d) / determinant
        if 0 <= s <= 1 and 0 <= t <= 1:
            gap = (w[0] + s * u[0] - t * v[0], w[1] + s * u[1] - t * v[1], w[2] + s * u[2] - t * v[2])
            return dot(gap, gap)
    ends = [squared_distance_of_segment(end, *q) for end in p] + [squared_distance_of_segment(end, *p) for end in q]
    return min(ends)


def is_pierced(segment: Sequence[Vector], triangle: Sequence[Vector]) -> bool:
    """Return whether a segment crosses the plane of a triangle in a point of the triangle."""
    a, b, c = triangle
    normal = cross(minus(b, a), minus(c, a))
    start, end = (dot(minus(point, a), normal) for point in segment)
    if start == end or start * end > 0:
        return False
    t = start / (start - end)
    u = minus(segment[1], segment[0])
    point = (segment[0][0] + t * u[0], segment[0][1] + t * u[1], segment[0][2] + t * u[2])
    return squared_distance(point, triangle) == 0


def squared_distance_of_hulls(a: Sequence[Vector], b: Sequence[Vector]) -> Fraction:
    """Return the squared distance of the hulls of one to three points each: points, segments and triangles."""
    # A hull with fewer points is a degenerate triangle.
    first, second = ([*hull, *[hull[-1]] * (3 - len(hull))] for hull in (a, b))
    edges = [[(hull[i], hull[(i + 1) % 3]) for i in range(3)] for hull in (first, second)]
    if any(is_pierced(edge, second) for edge in edges[0]) or any(is_pierced(edge, first) for edge in edges[1]):
        return Fraction(0)
    squares = [squared_distance(vertex, second) for vertex in first]
    squares += [squared_distance(vertex, first) for vertex in second]
    squares += [squared_distance_of_segments(p, q) for p in edges[0] for q in edges[1]]
    return min(squares)


class Mesh:
    """Triangles with the data of the filters."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        self.corners = np.asarray(vertices, np.float64)[np.asarray(triangles, np.int64)]
        self.center = self.corners.mean(axis=1)
        self.radius = np.linalg.norm(self.corners - self.center[:, None], axis=2).max(axis=1)
        self.low, self.high = self.corners.min(axis=1), self.corners.max(axis=1)
        self.size = float(np.abs(self.corners).max())
        keys = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        self.is_closed = bool((np.unique(keys, axis=0, return_counts=True)[1] % 2 == 0).all())

    def triangle(self, number: int) -> tuple[Vector, Vector, Vector]:
        a, b, c = (vector(corner) for corner in self.corners[number])
        return a, b, c

    def distance_to(self, point: np.ndarray, number: int) -> Fraction:
        """Return the squared distance of a point from one triangle."""
        return squared_distance(vector(point), self.triangle(number))

    def nearest(self, point: np.ndarray) -> tuple[Fraction, list[int]]:
        """Return the squared distance of a point from the nearest triangles, and their numbers."""
        # The lower bounds by balls and boxes are valid, and the corners give an upper bound.
        ball = np.linalg.norm(self.center - point, axis=1) - self.radius
        box = np.linalg.norm(np.maximum(0.0, np.maximum(self.low - point, point - self.high)), axis=1)
        least = np.maximum(ball, box)
        slack = MARGIN * (self.size + float(np.abs(point).max()))
        bound = np.linalg.norm(self.corners - point, axis=2).min() + slack
        near = np.nonzero(least <= bound)[0]
        best, ids = None, []
        for number in near[np.argsort(least[near])].tolist():
            if least[number] > bound:
                break
            found = self.distance_to(point, number)
            if best is None or found < best:
                best, ids = found, [number]
                bound = min(bound, float(found) ** 0.5 + slack)
            elif found == best:
                ids.append(number)
        assert best is not None
        return best, sorted(ids)

    def is_inside(self, point: np.ndarray) -> bool | None:
        """Return whether a ray from the point crosses the closed surface an odd number of times."""
        winding = self.winding_number(point)
        return None if winding is None else winding != 0

    def winding_number(self, point: np.ndarray) -> int | None:
        """Return the winding number of a closed surface around a point, counted along a ray in the direction of z.

        The point is shifted by an infinitesimal (e, e^2) in x and y, so the ray passes by all edges. On the surface the
        answer is None.
        """
        x, y, z = vector(point)
        slack = MARGIN * (self.size + float(np.abs(point).max()))
        hit = (self.low[:, :2] <= point[:2] + slack) & (self.high[:, :2] >= point[:2] - slack)
        winding = 0
        for number in np.nonzero(hit.all(axis=1) & (self.high[:, 2] >= point[2] - slack))[0].tolist():
            triangle = self.triangle(number)
            if squared_distance((x, y, z), triangle) == 0:
                return None
            is_odd = False
            for start, end in zip(triangle, (*triangle[1:], triangle[0]), strict=True):
                # Does a ray along x, in the plane, cross the edge? The half-open rule is the shift.
                if (start[1] > y) != (end[1] > y):
                    at = start[0] + (y - start[1]) / (end[1] - start[1]) * (end[0] - start[0])
                    is_odd ^= at > x
            if is_odd:
                a, b, c = triangle
                normal = cross(minus(b, a), minus(c, a))
                # The height of the plane at (x, y). Its projection has an area, because the shifted point is in it.
                height = a[2] - (normal[0] * (x - a[0]) + normal[1] * (y - a[1])) / normal[2]
                if height > z:
                    winding += 1 if normal[2] > 0 else -1
        return winding

    def hits(self, origin: np.ndarray, direction: np.ndarray) -> dict[Fraction, list[int]]:
        """Return the parameters at which a ray hits triangles that are not parallel to it, with their numbers."""
        o, d = vector(origin), vector(direction)
        offset = self.center - origin
        along = offset @ direction / (direction @ direction)
        away = np.linalg.norm(offset - along[:, None] * direction, axis=1)
        slack = MARGIN * (self.size + float(np.abs(origin).max()))
        found: dict[Fraction, list[int]] = {}
        near = np.nonzero(away <= self.radius + slack)[0]
        corners = self.corners[near] - origin
        others = np.roll(corners, -1, axis=1)
        moments = np.cross(corners, others) @ direction
        size = np.linalg.norm(corners, axis=2) * np.linalg.norm(others, axis=2) * np.linalg.norm(direction)
        is_possible = (moments >= -MARGIN * size).all(axis=1) | (moments <= MARGIN * size).all(axis=1)
        for number in near[is_possible].tolist():
            a, b, c = (minus(corner, o) for corner in self.triangle(number))
            sides = [dot(d, cross(p, q)) for p, q in ((a, b), (b, c), (c, a))]
            normal = cross(minus(b, a), minus(c, a))
            if dot(normal, d) and (min(sides) >= 0 or max(sides) <= 0):
                t = dot(normal, a) / dot(normal, d)
                if t >= 0:
                    found.setdefault(t, []).append(number)
        return dict(sorted(found.items()))


def root(value: Fraction) -> Decimal:
    """Return a square root with 60 digits."""
    with localcontext() as context:
        context.prec = 60
        return (Decimal(value.numerator) / Decimal(value.denominator)).sqrt()


def error(distance: float, squared: Fraction) -> float:
    """Return how far a distance is from the root of a squared one."""
    with localcontext() as context:
        context.prec = 60
        return float(abs(Decimal(float(distance)) - root(squared)))
