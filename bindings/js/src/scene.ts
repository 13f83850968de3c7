import { triple } from "./answers.js";
import {
  check, compiledModule, create, Owned, passArray, passBytes, scratch, u32, wasm, withMemory,
} from "./module.js";
import type { Allocate, Coordinates } from "./module.js";

/** Indices of vertices. Arrays of other types than `Uint32Array` are converted. */
export type Indices = ArrayLike<number>;

/** The arrays of a scene. Without triangles, segments and points, each position is a point. */
export interface SceneArrays {
  /** The coordinates of the vertices, three each. */
  positions: ArrayLike<number>;
  /** The vertices of the triangles, three each. */
  triangles?: Indices | null;
  /** The vertices of the segments, two each. */
  segments?: Indices | null;
  /** The vertices of the points, one each. */
  points?: Indices | null;
}

/** A scene whose primitives may come in any order. */
export interface MixedArrays {
  /** The coordinates of the vertices, three each. */
  positions: ArrayLike<number>;
  /** The number of vertices of each primitive: 3 for a triangle, 2 for a segment, 1 for a point. */
  sizes: ArrayLike<number>;
  /** The vertices of all primitives, one after the other. */
  vertices: Indices;
}

/** A position: three coordinates, or an object with the properties x, y and z. */
export type Position = ArrayLike<number> | { readonly x: number; readonly y: number; readonly z: number };

/** Returns coordinates as an array of a type that the library takes. */
export function coordinates(array: ArrayLike<number>): Coordinates {
  return array instanceof Float32Array || array instanceof Float64Array ? array : Float64Array.from(array);
}

function indices(array: Indices): Uint32Array {
  return array instanceof Uint32Array ? array : Uint32Array.from(array);
}

/**
 * A set of triangles, segments and points over shared vertices. It never changes. An index keeps what it needs of its
 * scene, so a scene can be disposed of once the index is built.
 *
 * Primitives are numbered from 0: first all triangles, then all segments, then all points. A scene of {@link
 * MixedArrays} keeps the order of its primitives.
 */
export class Scene extends Owned {
  /**
   * Makes a scene from arrays, which are copied. Coordinates in single precision are converted exactly.
   *
   * @throws Error if an index is out of range, or if a coordinate of a primitive is not finite.
   */
  constructor(arrays: SceneArrays | MixedArrays) {
    compiledModule();
    super(withMemory((allocate) => make(arrays, allocate)), wasm.p2m_scene_free);
  }

  /** The numbers of primitives of each kind. */
  get counts(): { triangles: number; segments: number; points: number } {
    check(wasm.p2m_scene_counts(this.address, scratch));
    const [triangles, segments, points] =
      u32.subarray(scratch / 4, scratch / 4 + 3) as unknown as [number, number, number];
    return { triangles, segments, points };
  }

  /**
   * The lowest and the highest coordinates of all primitives.
   *
   * @throws Error if there are no primitives.
   */
  get bounds(): { low: [number, number, number]; high: [number, number, number] } {
    check(wasm.p2m_scene_bounds(this.address, scratch, scratch + 24));
    return { low: triple(scratch / 8), high: triple(scratch / 8 + 3) };
  }
}

function make(arrays: SceneArrays | MixedArrays, allocate: Allocate): number {
  const positions = passArray(coordinates(arrays.positions), 3, "positions", allocate);
  if ("sizes" in arrays) {
    const sizes = passBytes(Uint8Array.from(arrays.sizes), allocate);
    const vertices = passArray(indices(arrays.vertices), 1, "vertices", allocate);
    return create((place) => wasm.p2m_js_scene_of_mixed(positions, sizes, arrays.sizes.length, vertices, place));
  }
  let { triangles, segments, points } = arrays;
  if (!triangles && !segments && !points)
    points = Uint32Array.from({ length: arrays.positions.length / 3 }, (_, i) => i);
  const pass = (array: Indices | null | undefined, width: number, name: string) =>
    array ? passArray(indices(array), width, name, allocate) : 0;
  const passed = [pass(triangles, 3, "triangles"), pass(segments, 2, "segments"), pass(points, 1, "points")] as const;
  return create((place) => wasm.p2m_scene_new(positions, ...passed, place));
}
