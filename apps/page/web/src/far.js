// The scene in f32, a million units from the origin: what p2m answers there, and what ordinary arithmetic does.

import { Index, Scene } from "../../../../bindings/js/src/index.ts";

// The offset of the scene in each coordinate, which is a million units from the origin. Numbers of f32 are 1/16 apart
// there.
const OFFSET = 577_350.25;
// The least longest side of the scene, in units. A smaller scene is enlarged by a power of two, because vertices that are
// 1/16 apart would not resemble it.
const MIN_SIDE = 16;
// The largest longest side of the scene, in units. A larger scene is reduced by a power of two, because it would leave
// the range in which numbers are 1/16 apart.
const MAX_SIDE = 65_536;

const { fround } = Math;

export class FarScene {
  // Moves a scene. The result is `null` for an empty scene, and for one that f32 cannot represent.
  static of({ positions, sizes, vertices }) {
    if (sizes.length === 0) return null;
    const { low, high } = new Scene({ positions, sizes, vertices }).bounds;
    const side = Math.max(...high.map((x, k) => x - low[k]));
    let scale = 1;
    if (side > 0 && side < MIN_SIDE) scale = 2 ** Math.ceil(Math.log2(MIN_SIDE / side));
    if (side >= MAX_SIDE) scale = 2 ** Math.floor(Math.log2(MAX_SIDE / side));
    const far = new FarScene();
    far.scale = scale;
    far.centre = low.map((x, k) => x * 0.5 + high[k] * 0.5);
    // A position that no primitive uses may be anywhere, and is not moved.
    const isUsed = new Uint8Array(positions.length / 3);
    vertices.forEach((vertex) => (isUsed[vertex] = 1));
    far.positions = Float32Array.from(positions, (x, i) => (isUsed[Math.floor(i / 3)] ? far.rounded(x, i % 3) : 0));
    if (!far.positions.every(Number.isFinite)) return null;
    Object.assign(far, { sizes, vertices });
    far.index = new Index(new Scene({ positions: far.positions, sizes, vertices }));
    let next = 0;
    far.firstVertices = Array.from(sizes, (size) => (next += size) - size);
    return far;
  }

  // Returns a coordinate moved away and rounded.
  rounded(x, axis) {
    return fround((x - this.centre[axis]) * this.scale + OFFSET);
  }

  // Returns where a point far from the origin is in the scene.
  back(point) {
    return point.map((x, k) => this.centre[k] + (x - OFFSET) / this.scale);
  }

  vertex(number) {
    return [...this.positions.subarray(3 * number, 3 * number + 3)];
  }

  verticesOf(primitive) {
    const first = this.firstVertices[primitive];
    return [...this.vertices.subarray(first, first + this.sizes[primitive])].map((number) => this.vertex(number));
  }

  // Answers a query, which is moved and rounded as the scene is. All of the answer is in the frame of the scene: the query
  // as f32 represents it, its true distance, and the point and the distance of p2m and of ordinary arithmetic.
  query(query) {
    const moved = query.map((x, k) => this.rounded(x, k));
    if (!moved.every(Number.isFinite)) return null;
    const exact = this.index.closestPoint(moved);
    if (!exact) return null;
    // p2m computes in f64 and rounds its answer once. Weights of f32 add up to one only nearly, so the vertices are
    // relative to the centre of the scene.
    const point = [...this.centre];
    this.verticesOf(exact.primitive).forEach((vertex, i) => {
      const weight = fround(exact.weights[i]);
      vertex.forEach((x, k) => (point[k] += ((x - OFFSET) / this.scale) * weight));
    });
    const ordinary = this.ordinary(moved);
    return {
      query: this.back(moved),
      distance: exact.distance / this.scale,
      p2m: { point, distance: fround(exact.distance) / this.scale },
      ordinary: { point: this.back(ordinary.point), distance: ordinary.distance / this.scale },
    };
  }

  // Returns the closest point in ordinary f32 arithmetic, found by trying all primitives: the textbook formulas in the
  // coordinates of the scene, and the distance from the rounded closest point.
  ordinary(query) {
    let best = { distance: Infinity };
    for (let primitive = 0; primitive < this.sizes.length; primitive++) {
      const [a, b, c] = this.verticesOf(primitive);
      const point = c ? onTriangle(a, b, c, query) : b ? onSegment(a, b, query) : a;
      const distance = norm(minus(query, point));
      if (!(distance >= best.distance)) best = { point, distance };
    }
    return best;
  }
}

// Vectors of f32: each operation rounds.
const minus = (a, b) => a.map((x, k) => fround(x - b[k]));
const along = (a, b, t) => a.map((x, k) => fround(x + fround(b[k] * t)));
const dot = (a, b) => fround(fround(fround(a[0] * b[0]) + fround(a[1] * b[1])) + fround(a[2] * b[2]));
const norm = (a) => fround(Math.sqrt(dot(a, a)));
const cross = (a, b) =>
  [[1, 2], [2, 0], [0, 1]].map(([i, j]) => fround(fround(a[i] * b[j]) - fround(a[j] * b[i])));

function onSegment(a, b, query) {
  const edge = minus(b, a);
  const square = dot(edge, edge);
  const t = square > 0 ? fround(dot(minus(query, a), edge) / square) : 0;
  return along(a, edge, Math.min(1, Math.max(0, t)));
}

function onTriangle(a, b, c, query) {
  const normal = cross(minus(b, a), minus(c, a));
  const isInside = (from, to) => dot(normal, cross(minus(to, from), minus(query, from))) >= 0;
  const square = dot(normal, normal);
  if (square > 0 && isInside(a, b) && isInside(b, c) && isInside(c, a)) {
    return along(query, normal, -fround(dot(minus(query, a), normal) / square));
  }
  const points = [onSegment(a, b, query), onSegment(b, c, query), onSegment(c, a, query)];
  const distances = points.map((point) => norm(minus(query, point)));
  return points[distances.indexOf(Math.min(...distances))];
}
