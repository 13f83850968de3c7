// The data of the page: one JSON value, in which each large array is text (base64 of compressed numbers).

import { decompress } from "fzstd";

const ARRAYS = { f32: Float32Array, f64: Float64Array, u32: Uint32Array, u8: Uint8Array };

// Returns the typed array that an object `{type, bytes}` describes, which `apps/page/src/packed.rs` has made. Machines
// with other than little-endian numbers run no browser, so bytes are not swapped.
async function unpack({ type, bytes: text, zstandard, planes, steps, decimals, rounded }) {
  const Wanted = ARRAYS[type];
  const Stored = decimals ? Int32Array : rounded ? Uint16Array : Wanted;
  const compressed = bytesOf(text);
  // A decompressed array may be a part of a larger one.
  const bytes = zstandard ? decompress(compressed).slice() : await inflate(compressed);
  const stored = new Stored((planes ? interleaved(bytes, Stored.BYTES_PER_ELEMENT) : bytes).buffer);
  if (steps) for (let i = 1; i < stored.length; i++) stored[i] += stored[i - 1];
  if (!decimals && !rounded) return stored;
  // `Wanted.from` with a function takes many times as long.
  const numbers = new Wanted(stored.length);
  const [unit, origin] = rounded ?? [];
  for (let i = 0; i < numbers.length; i++) {
    numbers[i] = decimals ? stored[i] / decimals : stored[i] === 0xffff ? NaN : origin + unit * stored[i];
  }
  return numbers;
}

// Returns the bytes of a text in base64.
function bytesOf(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Returns the bytes of numbers of some width, of which the first bytes come first, then the second ones, and so on.
function interleaved(bytes, width) {
  const [out, count] = [new Uint8Array(bytes.length), bytes.length / width];
  for (let plane = 0; plane < width; plane++) {
    for (let i = 0; i < count; i++) out[i * width + plane] = bytes[plane * count + i];
  }
  return out;
}

// Replaces each packed array within a value by its typed array.
async function unpackAll(value) {
  if (Array.isArray(value)) return Promise.all(value.map(unpackAll));
  if (value === null || typeof value !== "object") return value;
  if (typeof value.bytes === "string") return unpack(value);
  const entries = Object.entries(value).map(async ([key, part]) => [key, await unpackAll(part)]);
  return Object.fromEntries(await Promise.all(entries));
}

// Reads the data of the page.
export async function readData() {
  const element = document.getElementById("data");
  const data = await unpackAll(JSON.parse(element.textContent));
  element.remove();
  if (!data.scene.positions) Object.assign(data.scene, drawnScene(data.live, new Frame(data.frame)));
  return data;
}

// Returns what is drawn of the exact scene of live queries: positions in the frame, and the numbers of vertices of each
// kind of primitives.
function drawnScene({ coordinates, sizes, indices }, frame) {
  const lists = [1, 2, 3].map((size) => new Uint32Array(size * sizes.reduce((n, other) => n + (other === size), 0)));
  const ends = [0, 0, 0];
  let next = 0;
  for (const size of sizes) {
    lists[size - 1].set(indices.subarray(next, next + size), ends[size - 1]);
    ends[size - 1] += size;
    next += size;
  }
  const [points, segments, triangles] = lists;
  return { positions: frame.positions(coordinates), triangles, segments, points };
}

// The frame of the page: the GPU computes in f32, so positions are divided by a scale and are relative to the centre of
// the scene. A scene far from the origin is drawn as well as any other.
export class Frame {
  constructor({ origin, scale }) {
    this.scale = scale;
    this.origin = origin.map((x) => x / scale);
  }

  // Returns the positions in the frame of `count` points from the index `first` on.
  positions(points, first = 0, count = points.length / 3) {
    const out = new Float32Array(3 * count);
    for (let i = 0; i < out.length; i++) out[i] = points[3 * first + i] / this.scale - this.origin[i % 3];
    return out;
  }

  // Returns the coordinates in the unit of the scene of a position in the frame.
  coordinates(position) {
    return [0, 1, 2].map((k) => (position[k] + this.origin[k]) * this.scale);
  }
}
