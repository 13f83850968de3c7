import { f64, u32, u8 } from "./module.js";

/** Three coordinates, or the weights of three vertices. */
export type Triple = [number, number, number];

/** The closest point of a scene. */
export interface Closest {
  /** The distance, in units of the scene. */
  distance: number;
  /** The closest point. */
  point: Triple;
  /** The weights of the vertices of the primitive. The point is the weighted sum of the vertices. */
  weights: Triple;
  /** A lower bound on the true distance. */
  lowerBound: number;
  /** The number of the primitive, the lowest one of equally near primitives. */
  primitive: number;
  /**
   * The feature that the point lies on: 0 to 2 for a vertex of the primitive, 3 to 5 for the edge from vertex 0, 1 or 2
   * to the next one, and 6 for the face.
   */
  feature: number;
}

/** A hit of a ray. */
export interface Hit {
  /** The parameter of the hit, in lengths of the direction of the ray. */
  t: number;
  /** The point on the primitive that is hit. */
  point: Triple;
  /** The weights of the vertices of the primitive. */
  weights: Triple;
  /** The number of the primitive. */
  primitive: number;
  /** The side from which a triangle is hit: 1 from the front, -1 from the back, and 0 along it. */
  side: number;
}

/** The nearest points of two scenes. */
export interface Pair {
  /** The distance. It is 0 if the scenes intersect. */
  distance: number;
  /** A lower bound on the true distance. */
  lowerBound: number;
  /** The nearest point of each scene. The point of the second scene is given after its motion. */
  points: [Triple, Triple];
  /** The weights of the vertices of each primitive. */
  weights: [Triple, Triple];
  /** The number of the primitive of each scene. */
  primitives: [number, number];
  /** The feature that each point lies on, as in {@link Closest}. */
  features: [number, number];
  /** Whether the scenes intersect. It is exact. */
  isIntersecting: boolean;
}

// The sizes of C structures, in bytes.
export const CLOSEST_BYTES = 72;
export const HIT_BYTES = 64;
export const PAIR_BYTES = 128;

const NO_PRIMITIVE = 0xffffffff;

/** Returns three consecutive numbers of the memory. `at` is the number of the first one. */
export function triple(at: number): Triple {
  return [f64[at]!, f64[at + 1]!, f64[at + 2]!];
}

function setTriple(into: Triple, at: number): void {
  into[0] = f64[at]!;
  into[1] = f64[at + 1]!;
  into[2] = f64[at + 2]!;
}

/**
 * Returns an empty answer. Its numbers are NaN, so that engines store them as floating-point numbers from the
 * beginning.
 */
const newClosest = (): Closest =>
  ({ distance: NaN, point: [NaN, NaN, NaN], weights: [NaN, NaN, NaN], lowerBound: NaN, primitive: 0, feature: 0 });
const newHit = (): Hit => ({ t: NaN, point: [NaN, NaN, NaN], weights: [NaN, NaN, NaN], primitive: 0, side: 0 });

/** Reads a closest point into an object, which is a new one by default. */
export function readClosest(address: number, into?: Closest): Closest | null {
  const primitive = u32[(address + 64) / 4]!;
  if (primitive === NO_PRIMITIVE) return null;
  const [at, closest] = [address / 8, into ?? newClosest()];
  closest.distance = f64[at]!;
  setTriple(closest.point, at + 1);
  setTriple(closest.weights, at + 4);
  closest.lowerBound = f64[at + 7]!;
  closest.primitive = primitive;
  closest.feature = u8[address + 68]!;
  return closest;
}

/** Reads a hit into an object, which is a new one by default. */
export function readHit(address: number, into?: Hit): Hit | null {
  const primitive = u32[(address + 56) / 4]!;
  if (primitive === NO_PRIMITIVE) return null;
  const [at, hit] = [address / 8, into ?? newHit()];
  hit.t = f64[at]!;
  setTriple(hit.point, at + 1);
  setTriple(hit.weights, at + 4);
  hit.primitive = primitive;
  hit.side = (u8[address + 60]! << 24) >> 24;
  return hit;
}

/** Reads a pair. */
export function readPair(address: number): Pair | null {
  const at = address / 8;
  const primitives: [number, number] = [u32[address / 4 + 28]!, u32[address / 4 + 29]!];
  if (primitives[0] === NO_PRIMITIVE) return null;
  return {
    distance: f64[at]!,
    lowerBound: f64[at + 1]!,
    points: [triple(at + 2), triple(at + 5)],
    weights: [triple(at + 8), triple(at + 11)],
    primitives,
    features: [u8[address + 120]!, u8[address + 121]!],
    isIntersecting: u8[address + 122] !== 0,
  };
}
