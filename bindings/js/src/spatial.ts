import { CLOSEST_BYTES, HIT_BYTES, readClosest, readHit, readPair, triple } from "./answers.js";
import type { Closest, Hit, Pair } from "./answers.js";
import {
  attempt, check, create, f64, Owned, passArray, passBytes, refresh, scratch, text, u32, u8, wasm, withMemory,
} from "./module.js";
import type { Allocate } from "./module.js";
import { coordinates } from "./scene.js";
import type { Position, Scene } from "./scene.js";

/** The backends. The guide of p2m tells which one suits a task. */
export type Backend = "aabb" | "kdop" | "octree" | "p2m" | "brute";

/** The options of a build. */
export interface IndexOptions {
  /** The backend. "auto", the default, chooses by the number of queries. */
  backend?: Backend | "auto";
  /** The expected number of queries, by which "auto" chooses. Without it, "auto" chooses "aabb". */
  queries?: number;
  /** The fineness of the cells of an octree: a larger number makes finer cells. */
  resolution?: number;
  /** The number of faces of a k-DOP: 6, 14, 18 or 26. */
  kdopFaces?: number;
}

/** The options of a single query. */
export interface QueryOptions<Answer> {
  /** The largest distance of an answer. */
  maxDistance?: number;
  /** An earlier answer to be overwritten and returned, so that no object is created. */
  into?: Answer;
}

/** A ray: the points `origin + t * direction` with `tMin <= t <= tMax`. */
export interface Ray {
  /** The point with the parameter 0. */
  origin: Position;
  /** The direction, of any length but 0. */
  direction: Position;
  /** The smallest parameter, 0 by default. */
  tMin?: number;
  /** The largest parameter, infinite by default. */
  tMax?: number;
  /** The distance within which segments and points count as hit, 0 by default. Triangles are hit exactly. */
  radius?: number;
}

/** An array for answers. Numbers are converted to its type. */
export type NumberArray = Float64Array | Float32Array | Uint32Array | Int32Array | Uint8Array;

/**
 * The answers of a batch, each an array with a row for each query. Arrays that are missing are not computed. The fields
 * are as in {@link Closest}. If there is no answer, the distance is infinite and the primitive is 4294967295.
 */
export interface Columns {
  distance?: NumberArray;
  primitive?: NumberArray;
  /** Three numbers for each query. */
  point?: NumberArray;
  feature?: NumberArray;
  /** Three numbers for each query. */
  weights?: NumberArray;
  lowerBound?: NumberArray;
  /** The normal of the surface at the closest point, three numbers for each query. */
  normal?: NumberArray;
}

/** The answers of a batch that was given no arrays for them. */
export interface DefaultColumns {
  distance: Float64Array;
  primitive: Uint32Array;
  point: Float64Array;
}

/** The options of a batch. */
export interface BatchOptions {
  /** The largest distance of an answer. */
  maxDistance?: number;
  /** Whether queries are answered in their order, because neighbours in it are near each other already. */
  keepsOrder?: boolean;
}

/**
 * The columns in the order of `p2m_columns`, with the length of their rows and the types of the arrays of the library.
 */
export const COLUMNS = {
  distance: { width: 1, array: Float64Array },
  primitive: { width: 1, array: Uint32Array },
  point: { width: 3, array: Float64Array },
  feature: { width: 1, array: Uint8Array },
  weights: { width: 3, array: Float64Array },
  lowerBound: { width: 1, array: Float64Array },
  normal: { width: 3, array: Float64Array },
} as const;

/** Returns new arrays for the answers of a batch that was given none. */
export function defaultColumns(count: number): DefaultColumns {
  return {
    distance: new Float64Array(count), primitive: new Uint32Array(count), point: new Float64Array(3 * count),
  };
}

/**
 * The number of queries that are answered at a time, so that a large batch is never in the memory of the module as a
 * whole.
 */
const QUERIES_PER_CALL = 1 << 18;

/** The offset of the answers of single calls in their memory, after the query. */
const ANSWER = 128;

/** Writes a position into the memory of single calls, and returns its address, which is the start by default. */
function pass(position: Position, at = scratch): number {
  refresh();
  const i = at / 8;
  // Other ways to distinguish the two kinds of positions are several times slower.
  const { x, y, z } = position as { x?: number; y: number; z: number };
  if (x !== undefined) {
    f64[i] = x;
    f64[i + 1] = y;
    f64[i + 2] = z;
  } else {
    const array = position as ArrayLike<number>;
    f64[i] = array[0]!;
    f64[i + 1] = array[1]!;
    f64[i + 2] = array[2]!;
  }
  return at;
}

/** Writes a ray, and returns its address. */
function passRay({ origin, direction, tMin = 0, tMax = Infinity, radius = 0 }: Ray): number {
  pass(origin);
  pass(direction, scratch + 24);
  f64[scratch / 8 + 6] = tMin;
  f64[scratch / 8 + 7] = tMax;
  f64[scratch / 8 + 8] = radius;
  return scratch;
}

/** Reads memory that a call allocated, and frees it. */
function take<Read>(read: (address: number, bytes: number) => Read): Read {
  const [address, bytes] = [u32[(scratch + ANSWER) / 4]!, u32[(scratch + ANSWER) / 4 + 1]!];
  const found = read(address, bytes);
  wasm.p2m_js_free(address, bytes);
  return found;
}

/** Reads answers from memory that a call allocated, and frees it. */
function readAll<Answer>(size: number, read: (address: number) => Answer | null): Answer[] {
  return take((address, bytes) => Array.from({ length: bytes / size }, (_, i) => read(address + i * size)!));
}

/**
 * An index over a scene, which answers queries. All backends give the same answers, bit for bit, and so do the program,
 * Rust, Python and C.
 */
export class Index extends Owned {
  /**
   * Builds an index.
   *
   * @throws Error if an option does not suit the backend, or if there is not enough memory.
   */
  constructor(scene: Scene, options: IndexOptions = {}) {
    super(withMemory((allocate) => build(scene, options, allocate)), wasm.p2m_index_free);
  }

  /**
   * Loads an index from the bytes of {@link save}, or of a file that the program, Python or C has saved.
   *
   * @throws Error if the bytes are not a saved index, or if they are damaged.
   */
  static load(saved: Uint8Array): Index {
    const address = withMemory((allocate) => {
      const data = passBytes(saved, allocate);
      return create((place) => wasm.p2m_js_load(data, saved.length, place));
    });
    // The constructor of `Index` would build an index.
    return Reflect.construct(Owned, [address, wasm.p2m_index_free], Index) as Index;
  }

  /**
   * Returns the index with its scene as bytes, for {@link load} or for a file.
   *
   * @throws Error if the backend is "brute", which has no saved form.
   */
  save(): Uint8Array<ArrayBuffer> {
    attempt(() => wasm.p2m_js_save(this.address, scratch + ANSWER));
    return take((address, bytes) => u8.slice(address, address + bytes));
  }

  /**
   * Adapts the index to a scene in which the same primitives have moved. The boxes of a tree are recomputed, which is
   * faster than a build. Queries become slower if primitives have moved far.
   *
   * @throws Error if the number of primitives differs, or if the backend is neither "aabb", "kdop" nor "brute".
   */
  refit(scene: Scene): void {
    this.replace(create((place) => wasm.p2m_index_refit(this.address, scene.address, place)));
  }

  /** The backend of the index. */
  get backend(): Backend {
    return text(wasm.p2m_index_backend(this.address)) as Backend;
  }

  /** The number of primitives. */
  get primitiveCount(): number {
    return wasm.p2m_index_primitive_count(this.address) >>> 0;
  }

  /** The memory of the index in bytes, without its scene. */
  get memoryBytes(): number {
    return wasm.p2m_index_memory_bytes(this.address) >>> 0;
  }

  /**
   * Finds the closest point of the scene, or returns `null` if there is none within the largest distance.
   *
   * @throws Error if a coordinate is not finite.
   */
  closestPoint(query: Position, options?: QueryOptions<Closest>): Closest | null {
    const answer = scratch + ANSWER;
    check(wasm.p2m_closest_point(this.address, pass(query), options?.maxDistance ?? Infinity, answer));
    return readClosest(answer, options?.into);
  }

  /**
   * Finds the closest point to each of many queries, which is several times faster than single calls.
   *
   * @param queries Three coordinates for each query, in single or double precision.
   * @param columns The arrays for the answers. Without them, distances, primitives and points are returned.
   * @returns `columns`, or the new arrays.
   * @throws Error if a coordinate is not finite, or if an array has the wrong length.
   */
  closestPoints(queries: ArrayLike<number>, columns?: undefined, options?: BatchOptions): DefaultColumns;
  closestPoints<Wanted extends Columns>(queries: ArrayLike<number>, columns: Wanted, options?: BatchOptions): Wanted;
  closestPoints(
    queries: ArrayLike<number>, columns: Columns = defaultColumns(queryCount(queries)), options: BatchOptions = {},
  ): Columns {
    const rows = queryCount(queries);
    const wanted = Object.entries(COLUMNS).map(([name, kind]) => ({ name, kind, out: columns[name as keyof Columns] }));
    for (const { name, kind, out } of wanted) if (out) checkLength(out, kind.width * rows, name);
    inParts(queries, options, (passed, batch, count, start, allocate) => {
      const places = wanted.map(({ kind, out }) =>
        out ? allocate(count * kind.width * kind.array.BYTES_PER_ELEMENT) : 0);
      const described = allocate(8 * places.length);
      places.forEach((place, i) => u32.set([place, 0], described / 4 + 2 * i));
      attempt(() => wasm.p2m_closest_points(this.address, passed, batch, described));
      wanted.forEach(({ kind, out }, i) => out?.set(
        new kind.array(wasm.memory.buffer, places[i]!, count * kind.width) as ArrayLike<number>, start * kind.width));
    });
    return columns;
  }

  /**
   * Finds the `k` primitives that are nearest to a point, the nearest first. There may be fewer.
   *
   * @throws Error if a coordinate is not finite.
   */
  kNearest(query: Position, k: number, maxDistance = Infinity): Closest[] {
    k = Math.min(k, this.primitiveCount);
    return withMemory((allocate) => {
      const answers = allocate(CLOSEST_BYTES * k);
      const count = scratch + ANSWER;
      attempt(() => wasm.p2m_k_nearest(this.address, pass(query), k, maxDistance, answers, count));
      return Array.from({ length: u32[count / 4]! }, (_, i) => readClosest(answers + i * CLOSEST_BYTES)!);
    });
  }

  /**
   * Finds all primitives within a radius of a point, the nearest first. Equally near ones come in the order of their
   * numbers.
   *
   * @throws Error if a coordinate is not finite.
   */
  within(query: Position, radius: number): Closest[] {
    attempt(() => wasm.p2m_js_within(this.address, pass(query), radius, scratch + ANSWER));
    return readAll(CLOSEST_BYTES, (address) => readClosest(address));
  }

  /**
   * Returns whether any primitive is within a radius of a point.
   *
   * @throws Error if a coordinate is not finite.
   */
  isAnyWithin(query: Position, radius: number): boolean {
    check(wasm.p2m_is_any_within(this.address, pass(query), radius, scratch + ANSWER));
    return u8[scratch + ANSWER] !== 0;
  }

  /**
   * Finds all hits of a ray, one for each primitive that is hit, the nearest first.
   *
   * @throws Error if the ray is not valid, or if the backend casts none.
   */
  raycast(ray: Ray): Hit[] {
    attempt(() => wasm.p2m_js_hits(this.address, passRay(ray), scratch + ANSWER));
    return readAll(HIT_BYTES, (address) => readHit(address));
  }

  /**
   * Finds the first hit of a ray, the one with the smallest parameter, and of equal ones the one with the lowest
   * primitive. Returns `null` if there is no hit.
   *
   * @throws Error if the ray is not valid, or if the backend casts none.
   */
  raycastFirst(ray: Ray, into?: Hit): Hit | null {
    check(wasm.p2m_first_hit(this.address, passRay(ray), scratch + ANSWER));
    return readHit(scratch + ANSWER, into);
  }

  /**
   * Returns whether a ray hits anything.
   *
   * @throws Error if the ray is not valid, or if the backend casts none.
   */
  raycastAny(ray: Ray): boolean {
    check(wasm.p2m_any_hit(this.address, passRay(ray), scratch + ANSWER));
    return u8[scratch + ANSWER] !== 0;
  }

  /**
   * Returns the distance, negative inside of the surface that the triangles form. It is NaN if the sign is not
   * determined. The first call on an index prepares the signs.
   *
   * @throws Error if the scene has segments or points, or if a coordinate is not finite.
   */
  signedDistance(query: Position): number {
    return this.signedDistances(pointOf(query))[0]!;
  }

  /**
   * Returns the signed distance of each of many queries.
   *
   * @throws Error as {@link signedDistance} does, and if the array has the wrong length.
   */
  signedDistances<Numbers extends NumberArray = Float64Array>(
    queries: ArrayLike<number>, out = new Float64Array(queryCount(queries)) as NumberArray as Numbers,
    options: BatchOptions = {},
  ): Numbers {
    return answerColumn(this, wasm.p2m_signed_distances, queries, out, Float64Array, options);
  }

  /**
   * Returns whether a point is inside of the surface that the triangles form.
   *
   * @throws Error if the scene has segments or points, or if a coordinate is not finite.
   */
  contains(query: Position): boolean {
    return this.containsEach(pointOf(query))[0] !== 0;
  }

  /**
   * Returns 1 for each of many queries that is inside, and 0 for the others.
   *
   * @throws Error as {@link contains} does, and if the array has the wrong length.
   */
  containsEach<Numbers extends NumberArray = Uint8Array>(
    queries: ArrayLike<number>, out = new Uint8Array(queryCount(queries)) as NumberArray as Numbers,
    options: BatchOptions = {},
  ): Numbers {
    return answerColumn(this, wasm.p2m_contains, queries, out, Uint8Array, options);
  }

  /**
   * Finds the nearest points of this scene and another one, or returns `null` if there are none within the largest
   * distance.
   *
   * @param options.matrix Moves the other scene: the 16 numbers of a rotation and a translation, column by column, as
   * in
   *   `Matrix4.elements` of three.js.
   * @throws Error if the matrix is not a rotation and a translation, or if a backend does not answer such queries.
   */
  distanceTo(other: Index, options: { matrix?: ArrayLike<number>; maxDistance?: number } = {}): Pair | null {
    const { matrix, maxDistance = Infinity } = options;
    return withMemory((allocate) => {
      const motion = matrix ? allocate(128) : 0;
      for (let i = 0; matrix && i < 16; i++) f64[motion / 8 + 4 * (i % 4) + Math.floor(i / 4)] = matrix[i]!;
      attempt(() => wasm.p2m_closest_pair(this.address, other.address, motion, maxDistance, scratch + ANSWER));
      return readPair(scratch + ANSWER);
    });
  }

  /** Returns the numbers of nodes, packets and primitives that a query for the closest point visits. */
  work(query: Position): { nodes: number; packets: number; primitives: number } {
    check(wasm.p2m_js_work(this.address, pass(query), scratch + ANSWER));
    const [nodes, packets, primitives] = triple((scratch + ANSWER) / 8);
    return { nodes, packets, primitives };
  }
}

/** Passes the options of a build to the library, and builds. */
function build(scene: Scene, options: IndexOptions, allocate: Allocate): number {
  const { backend = "auto", queries = 0, resolution = 0, kdopFaces = 0 } = options;
  const name = passBytes(new TextEncoder().encode(`${backend}\0`), allocate);
  const passed = allocate(32);
  u32[passed / 4] = name;
  new BigUint64Array(wasm.memory.buffer)[passed / 8 + 1] = BigInt(Math.round(queries));
  f64[passed / 8 + 2] = resolution;
  u32[passed / 4 + 6] = kdopFaces;
  u32[passed / 4 + 7] = 1;
  return create((place) => wasm.p2m_index_build(scene.address, passed, place));
}

/**
 * Passes a batch to `call` in parts, with the queries, the options, the number of queries and the number of the first
 * one.
 */
function inParts(
  queries: ArrayLike<number>, { maxDistance = Infinity, keepsOrder = false }: BatchOptions,
  answer: (queries: number, options: number, count: number, start: number, allocate: Allocate) => void,
): void {
  const all = coordinates(queries);
  for (let start = 0; start < all.length / 3; start += QUERIES_PER_CALL) {
    withMemory((allocate) => {
      const part = all.subarray(3 * start, 3 * (start + QUERIES_PER_CALL));
      const [passed, batch] = [passArray(part, 3, "queries", allocate), allocate(24)];
      f64[batch / 8] = maxDistance;
      u32.set([1, Number(keepsOrder), 0], batch / 4 + 2);
      answer(passed, batch, part.length / 3, start, allocate);
    });
  }
}

/** Answers each query by one number, and writes the numbers to an array. */
function answerColumn<Numbers extends NumberArray>(
  index: Index,
  call: (index: number, queries: number, options: number, column: number) => number,
  queries: ArrayLike<number>, out: Numbers, kind: typeof Float64Array | typeof Uint8Array, options: BatchOptions,
): Numbers {
  checkLength(out, queryCount(queries), "out");
  inParts(queries, options, (passed, batch, count, start, allocate) => {
    const [place, column] = [allocate(count * kind.BYTES_PER_ELEMENT), allocate(8)];
    u32.set([place, 0], column / 4);
    // In C, columns are passed by value. In WebAssembly, this means by their address.
    attempt(() => call(index.address, passed, batch, column));
    out.set(new kind(wasm.memory.buffer, place, count) as ArrayLike<number>, start);
  });
  return out;
}

/** Returns the number of queries in an array of coordinates. */
export function queryCount(queries: ArrayLike<number>): number {
  if (queries.length % 3 !== 0) throw new Error(`queries: the length ${queries.length} is not a multiple of 3`);
  return queries.length / 3;
}

export function checkLength(out: NumberArray, expected: number, name: string): void {
  if (out.length !== expected) throw new Error(`${name}: the length is ${out.length} instead of ${expected}`);
}

function pointOf(query: Position): ArrayLike<number> {
  return "x" in query ? [query.x, query.y, query.z] : query;
}
