// The WebAssembly module: loading, memory, and messages of failures.

/** The functions of the module: the C interface of p2m, and `exports.rs`. Pointers are numbers. */
export interface Exports {
  memory: WebAssembly.Memory;
  p2m_last_error(): number;
  p2m_version(): number;
  p2m_scene_new(positions: number, triangles: number, segments: number, points: number, scene: number): number;
  p2m_scene_free(scene: number): void;
  p2m_scene_counts(scene: number, counts: number): number;
  p2m_scene_bounds(scene: number, low: number, high: number): number;
  p2m_index_build(scene: number, options: number, index: number): number;
  p2m_index_refit(index: number, scene: number, refitted: number): number;
  p2m_index_free(index: number): void;
  p2m_index_backend(index: number): number;
  p2m_index_primitive_count(index: number): number;
  p2m_index_memory_bytes(index: number): number;
  p2m_closest_point(index: number, query: number, maxDistance: number, answer: number): number;
  p2m_closest_points(index: number, queries: number, options: number, columns: number): number;
  p2m_k_nearest(index: number, query: number, k: number, max: number, answers: number, count: number): number;
  p2m_is_any_within(index: number, query: number, radius: number, isWithin: number): number;
  p2m_first_hit(index: number, ray: number, hit: number): number;
  p2m_any_hit(index: number, ray: number, isHit: number): number;
  p2m_signed_distances(index: number, queries: number, options: number, column: number): number;
  p2m_contains(index: number, queries: number, options: number, column: number): number;
  p2m_closest_pair(first: number, second: number, motion: number, maxDistance: number, pair: number): number;
  p2m_js_alloc(bytes: number): number;
  p2m_js_free(data: number, bytes: number): void;
  p2m_js_scene_of_mixed(positions: number, sizes: number, count: number, vertices: number, scene: number): number;
  p2m_js_save(index: number, saved: number): number;
  p2m_js_load(data: number, bytes: number, index: number): number;
  p2m_js_within(index: number, query: number, radius: number, answers: number): number;
  p2m_js_hits(index: number, ray: number, hits: number): number;
  p2m_js_work(index: number, query: number, work: number): number;
}

/** The source of the module: the address of `p2m.wasm`, its bytes, a response with the bytes, or a compiled module. */
export type ModuleSource = string | URL | Response | BufferSource | WebAssembly.Module;

/** The functions of the module, once it is loaded. */
export let wasm: Exports;
/** The memory of the module as numbers. Calls may grow it, which detaches these arrays: see `refresh`. */
export let f64 = new Float64Array(0);
export let u32 = new Uint32Array(0);
export let u8 = new Uint8Array(0);

/** The size in bytes of the memory for arguments and answers of single calls. */
const SCRATCH_BYTES = 512;
/** The address of the memory for arguments and answers of single calls. */
export let scratch = 0;

let compiled: WebAssembly.Module | undefined;
let loading: Promise<void> | undefined;

/**
 * Loads the WebAssembly module. All other functions need it, so await it first. Only the first call loads anything.
 *
 * @param source The source of the module, by default the file `p2m.wasm` beside this script. Pages that cannot load
 *   files pass the default export of `p2m/inline`, which is the bytes of the module.
 * @throws Error if the module cannot be loaded.
 */
export function init(source?: ModuleSource | Promise<ModuleSource>): Promise<void> {
  loading ??= load(source).catch((error) => {
    loading = undefined;
    throw error;
  });
  return loading;
}

async function load(source?: ModuleSource | Promise<ModuleSource>): Promise<void> {
  compiled = await compile((await source) ?? new URL("./p2m.wasm", import.meta.url));
  wasm = (await WebAssembly.instantiate(compiled, {})).exports as unknown as Exports;
  scratch = wasm.p2m_js_alloc(SCRATCH_BYTES) >>> 0;
  refresh();
}

async function compile(source: ModuleSource): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  const found = typeof source === "string" || source instanceof URL ? await open(source) : source;
  if (!(found instanceof Response)) return WebAssembly.compile(found);
  if (!found.ok) throw new Error(`p2m: ${found.url}: ${found.status} ${found.statusText}`);
  // Some servers send no type for WebAssembly files. Then the bytes are compiled once all of them have arrived.
  return WebAssembly.compile(await found.arrayBuffer());
}

async function open(address: string | URL): Promise<Response | BufferSource> {
  const url = new URL(address, globalThis.location?.href);
  // `fetch` of Node.js does not read files.
  const files = url.protocol === "file:" ? nodeModule("node:fs") : undefined;
  return files ? files.readFileSync(url) : fetch(url);
}

/** Returns a module of Node.js, or `undefined` in a browser. Bundlers cannot see the import. */
export function nodeModule(name: string): any {
  return (globalThis as { process?: { getBuiltinModule?(name: string): unknown } }).process?.getBuiltinModule?.(name);
}

/** Returns the compiled module, so that workers need not compile it again. */
export function compiledModule(): WebAssembly.Module {
  if (!compiled) throw new Error("p2m: call `await init()` first");
  return compiled;
}

/**
 * Renews the arrays over the memory if they are detached. Call it after each call of the module, before their next use.
 */
export function refresh(): void {
  if (f64.length !== 0) return;
  const { buffer } = wasm.memory;
  f64 = new Float64Array(buffer);
  u32 = new Uint32Array(buffer);
  u8 = new Uint8Array(buffer);
}

/** Throws an error with the message of the call if it failed. */
export function check(status: number): void {
  refresh();
  if (status !== 0) throw new Error(text(wasm.p2m_last_error()));
}

/** Makes a call that may run out of memory. That aborts the module, which cannot be used afterwards. */
export function attempt(call: () => number): void {
  let status;
  try {
    status = call();
  } catch (cause) {
    throw new Error("p2m: the memory is used up, or p2m has a defect; the page has to be loaded anew", { cause });
  }
  check(status);
}

/** Makes a call that may use up the memory and writes the address of an object, and returns that address. */
export function create(call: (place: number) => number): number {
  attempt(() => call(scratch));
  return u32[scratch / 4]!;
}

/** Returns the string at an address, which ends with a zero. */
export function text(address: number): string {
  refresh();
  return new TextDecoder().decode(u8.slice(address >>> 0, u8.indexOf(0, address >>> 0)));
}

/** Returns the version of the library. */
export function version(): string {
  compiledModule();
  return text(wasm.p2m_version());
}

/** A function that allocates memory for the duration of a call. */
export type Allocate = (bytes: number) => number;

/** Runs a function that allocates memory, and frees the memory when it ends. */
export function withMemory<R>(use: (allocate: Allocate) => R): R {
  compiledModule();
  const blocks: [number, number][] = [];
  try {
    return use((bytes) => {
      const address = wasm.p2m_js_alloc(Math.max(bytes, 1)) >>> 0;
      refresh();
      if (address === 0) throw new Error(`p2m: there is no memory for ${bytes} bytes`);
      blocks.push([address, Math.max(bytes, 1)]);
      return address;
    });
  } finally {
    for (const [address, bytes] of blocks) wasm.p2m_js_free(address, bytes);
  }
}

/** Numbers in the types that the library takes for coordinates: single or double precision. */
export type Coordinates = Float32Array | Float64Array;

/** The values of `p2m_scalar`. */
const SCALARS = { f32: 0, f64: 1, u32: 2 };

/** Copies an array into the memory of the module with its description, and returns the address of the description. */
export function passArray(array: Coordinates | Uint32Array, width: number, name: string, allocate: Allocate): number {
  if (array.length % width !== 0) {
    throw new Error(`${name}: the length ${array.length} is not a multiple of ${width}`);
  }
  const data = passBytes(array, allocate);
  const description = allocate(16);
  const scalar = array instanceof Float32Array ? SCALARS.f32
    : array instanceof Float64Array ? SCALARS.f64 : SCALARS.u32;
  u32.set([data, array.length / width, 0, scalar], description / 4);
  return description;
}

/** Copies an array into the memory of the module, and returns its address. */
export function passBytes(array: ArrayBufferView, allocate: Allocate): number {
  const address = allocate(array.byteLength);
  u8.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), address);
  return address;
}

const registry = new FinalizationRegistry<() => void>((free) => free());

/**
 * An object in the memory of the module. `dispose` frees it, or else the garbage collector some time after its last
 * use.
 */
export class Owned {
  #address: number;
  #free: (address: number) => void;

  /** @internal */
  constructor(address: number, free: (address: number) => void) {
    this.#address = address;
    this.#free = free;
    registry.register(this, () => free(address), this);
  }

  /** @internal */
  get address(): number {
    if (this.#address === 0) throw new Error("p2m: the object was disposed of");
    return this.#address;
  }

  /** Frees this object, and puts another one in its place. @internal */
  replace(address: number): void {
    const free = this.#free;
    this.dispose();
    this.#address = address;
    registry.register(this, () => free(address), this);
  }

  /** Frees the memory. Later calls of other methods throw an error. */
  dispose(): void {
    if (this.#address === 0) return;
    registry.unregister(this);
    this.#free(this.#address);
    this.#address = 0;
  }

  /** Frees the memory at the end of a block that declares the object with `using`. */
  [Symbol.dispose](): void {
    this.dispose();
  }
}
