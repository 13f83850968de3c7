import { compiledModule, nodeModule } from "./module.js";
import { Remote } from "./remote.js";
import { COLUMNS, checkLength, defaultColumns, queryCount } from "./spatial.js";
import type { BatchOptions, Columns, DefaultColumns, Index, NumberArray } from "./spatial.js";
import { coordinates } from "./scene.js";
import type { Coordinates } from "./module.js";

/** The first message to a worker. */
export interface Start {
  module: WebAssembly.Module;
  saved: Uint8Array;
}

/** The arrays of a part of a batch: columns, or a single array under the name `answer`. */
type Outputs = Columns & { answer?: NumberArray };

/** A message to a worker with a part of a batch. */
export interface Call {
  method: "closestPoints" | "signedDistances" | "containsEach";
  queries: Coordinates;
  out: Outputs;
  options: BatchOptions;
}

interface Reply {
  out?: Outputs;
  error?: string;
}

/** The smallest and the largest number of queries in a part. Queries near each other are answered faster together. */
const PART_QUERIES = [1 << 10, 1 << 16] as const;
/** The number of parts of a batch for each worker, so that no worker has to wait long for the others. */
const PARTS_PER_WORKER = 4;

/**
 * Workers that answer batches together. Each has a copy of the index. If memory can be shared, which in a browser
 * requires a cross-origin isolated page, all workers share the queries and answers. Otherwise these are copied.
 */
export class Pool {
  #workers: Remote<Reply>[];

  private constructor(workers: Remote<Reply>[]) {
    this.#workers = workers;
  }

  /**
   * Starts workers, and sends them an index, which may be disposed of afterwards.
   *
   * @param options.workers The number of workers, by default the number of processors.
   * @throws Error if the backend of the index is "brute", or if a worker cannot be started.
   */
  static async create(index: Index, options: { workers?: number } = {}): Promise<Pool> {
    const count = options.workers ?? globalThis.navigator?.hardwareConcurrency
      ?? nodeModule("node:os").availableParallelism();
    let saved: Uint8Array = index.save();
    if (canShare()) saved = share(saved);
    const pool = new Pool(Array.from({ length: count }, start));
    try {
      await Promise.all(pool.#workers.map((worker) => worker.ask({ module: compiledModule(), saved })));
    } catch (error) {
      pool.dispose();
      throw error;
    }
    return pool;
  }

  /** The number of workers. */
  get size(): number {
    return this.#workers.length;
  }

  /** Finds the closest point to each of many queries: see `Index.closestPoints`. */
  closestPoints(queries: ArrayLike<number>, columns?: undefined, options?: BatchOptions): Promise<DefaultColumns>;
  closestPoints<Wanted extends Columns>(
    queries: ArrayLike<number>, columns: Wanted, options?: BatchOptions
  ): Promise<Wanted>;
  async closestPoints(
    queries: ArrayLike<number>, columns: Columns = defaultColumns(queryCount(queries)), options: BatchOptions = {},
  ): Promise<Columns> {
    await this.#answer("closestPoints", queries, columns, options);
    return columns;
  }

  /** Returns the signed distance of each of many queries: see `Index.signedDistances`. */
  async signedDistances<Numbers extends NumberArray = Float64Array>(
    queries: ArrayLike<number>, out = new Float64Array(queryCount(queries)) as NumberArray as Numbers,
    options: BatchOptions = {},
  ): Promise<Numbers> {
    await this.#answer("signedDistances", queries, { answer: out }, options);
    return out;
  }

  /** Returns 1 for each query that is inside, and 0 for the others: see `Index.containsEach`. */
  async containsEach<Numbers extends NumberArray = Uint8Array>(
    queries: ArrayLike<number>, out = new Uint8Array(queryCount(queries)) as NumberArray as Numbers,
    options: BatchOptions = {},
  ): Promise<Numbers> {
    await this.#answer("containsEach", queries, { answer: out }, options);
    return out;
  }

  /** Ends the workers. */
  dispose(): void {
    for (const worker of this.#workers) worker.end("p2m: the pool was disposed of");
    this.#workers = [];
  }

  /** Ends the workers at the end of a block that declares the pool with `using`. */
  [Symbol.dispose](): void {
    this.dispose();
  }

  async #answer(
    method: Call["method"], queries: ArrayLike<number>, out: Outputs, options: BatchOptions
  ): Promise<void> {
    if (this.#workers.length === 0) throw new Error("p2m: the pool was disposed of");
    const names = (Object.keys(out) as (keyof Outputs)[]).filter((name) => out[name]);
    const width = (name: keyof Outputs) => (name === "answer" ? 1 : COLUMNS[name].width);
    const count = queryCount(queries);
    for (const name of names) checkLength(out[name]!, count * width(name), name);
    const isShared = canShare();
    const all = isShared ? share(coordinates(queries)) : coordinates(queries);
    const shared: Outputs = {};
    for (const name of names) shared[name] = isShared ? share(out[name]!) : out[name]!;
    const wanted = Math.ceil(count / (PARTS_PER_WORKER * this.#workers.length));
    const part = Math.max(PART_QUERIES[0], Math.min(PART_QUERIES[1], wanted));
    let next = 0;
    await Promise.all(this.#workers.map(async (worker) => {
      while (next < count) {
        const [start, end] = [next, Math.min(next + part, count)];
        next = end;
        // Without shared memory, a message copies whole buffers. So each part gets an array of its own.
        const cut = <Numbers extends NumberArray | Coordinates>(array: Numbers, width: number) =>
          (isShared ? array.subarray(start * width, end * width) : array.slice(start * width, end * width)) as Numbers;
        const parts: Outputs = {};
        for (const name of names) parts[name] = cut(shared[name]!, width(name));
        const answered = await worker.ask({ method, queries: cut(all, 3), out: parts, options });
        if (!isShared) for (const name of names) out[name]!.set(answered.out![name]!, start * width(name));
      }
    }));
    if (isShared) for (const name of names) if (out[name] !== shared[name]) out[name]!.set(shared[name]!);
  }
}

/** Returns whether memory can be shared with workers. */
function canShare(): boolean {
  return typeof SharedArrayBuffer !== "undefined" && globalThis.crossOriginIsolated !== false;
}

/** Returns an array in shared memory with the same content. An array that is shared already is returned as it is. */
function share<Numbers extends NumberArray | Coordinates>(array: Numbers): Numbers {
  if (array.buffer instanceof SharedArrayBuffer) return array;
  const kind = array.constructor as new (buffer: SharedArrayBuffer) => Numbers;
  const copy = new kind(new SharedArrayBuffer(array.byteLength));
  copy.set(array);
  return copy;
}

/** Starts a worker. */
function start(): Remote<Reply> {
  const threads = nodeModule("node:worker_threads");
  // Bundlers find this address only in a call of `new Worker`.
  const here = import.meta.url;
  const worker = threads && typeof Worker === "undefined" ? new threads.Worker(new URL("./worker.js", here))
    : new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  return new Remote(worker, (message = "") => `p2m: a worker failed: ${message}`);
}
