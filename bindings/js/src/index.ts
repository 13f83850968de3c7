/**
 * The closest point of a scene of triangles, segments and points, found exactly and fast. Await {@link init} first.
 *
 * @packageDocumentation
 */
export { init, version } from "./module.js";
export type { ModuleSource } from "./module.js";
export type { Closest, Hit, Pair, Triple } from "./answers.js";
export { Scene } from "./scene.js";
export type { Indices, MixedArrays, Position, SceneArrays } from "./scene.js";
export { Index } from "./spatial.js";
export type {
  Backend, BatchOptions, Columns, DefaultColumns, IndexOptions, NumberArray, QueryOptions, Ray,
} from "./spatial.js";
export { Pool } from "./pool.js";
