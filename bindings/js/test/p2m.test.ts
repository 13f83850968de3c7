import { readFileSync } from "node:fs";
import { Worker } from "node:worker_threads";
import { expect, test } from "vitest";
import { Index, Pool, Scene, init, version } from "../dist/index.js";
import type { Closest, IndexOptions } from "../dist/index.js";
import { blob, generator, mixture, pointsAround } from "./scenes.js";

const triangle = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], triangles: [0, 1, 2] };

test("what is used before the module is loaded says so", () => {
  expect(() => new Scene(triangle)).toThrow("call `await init()` first");
});

test("a source that is no module is refused, and another one may follow", async () => {
  await expect(init(new Uint8Array([1, 2, 3]))).rejects.toThrow();
  await expect(init("data:text/plain,nothing")).rejects.toThrow();
  await init(readFileSync(new URL("../dist/p2m.wasm", import.meta.url)));
  await init();
  expect(version()).toMatch(/^\d+\.\d+\.\d+$/);
});

test("the bytes of p2m/inline are the module", async () => {
  const { default: bytes } = await import("../dist/inline.js");
  expect(Buffer.from(bytes).equals(readFileSync(new URL("../dist/p2m.wasm", import.meta.url)))).toBe(true);
});

test("a scene counts its primitives, and knows its box", () => {
  const scene = new Scene({ ...triangle, segments: new Uint16Array([0, 1, 1, 2]), points: [2] });
  expect(scene.counts).toEqual({ triangles: 1, segments: 2, points: 1 });
  expect(scene.bounds).toEqual({ low: [0, 0, 0], high: [1, 1, 0] });
  expect(new Scene({ positions: new Float32Array([1, 2, 3, 4, 5, 6]) }).counts.points).toBe(2);
});

test("coordinates of ordinary arrays keep their digits", () => {
  const index = new Index(new Scene({ positions: [0.1, 0.2, 0.3] }));
  expect(index.closestPoint([0, 0, 0])!.point).toEqual([0.1, 0.2, 0.3]);
  expect([...index.closestPoints([0.1, 0.2, 0.30000000000000004]).distance]).toEqual([2 ** -54]);
});

test("errors have the messages of the library", () => {
  expect(() => new Scene({ positions: [0, 0], triangles: [] }))
    .toThrow("positions: the length 2 is not a multiple of 3");
  expect(() => new Scene({ positions: [0, 0, 0], triangles: [0, 1, 2] }))
    .toThrow("primitive 0 uses position 1, but there is only position 0");
  expect(() => new Scene({ positions: [NaN, 0, 0] })).toThrow("not finite");
  expect(() => new Scene({ positions: [], points: [] }).bounds).toThrow("it has no primitives");
  const scene = new Scene(triangle);
  expect(() => new Index(scene, { backend: "best" as "aabb" })).toThrow('there is none with the name "best"');
  expect(() => new Index(scene, { backend: "aabb", resolution: 2 })).toThrow("resolution");
  const index = new Index(scene);
  expect(() => index.closestPoint([0, NaN, 0])).toThrow("query: not finite");
  expect(() => index.closestPoints([0, 0, 0, 1])).toThrow("queries: the length 4");
  expect(() => index.closestPoints([0, 0, 0], { point: new Float64Array(2) }))
    .toThrow("point: the length is 2 instead of 3");
  expect(() => index.closestPoints([0, 0, 0, 0, 0, Infinity])).toThrow("queries: row 1 is not finite");
  expect(() => index.raycast({ origin: [0, 0, 0], direction: [0, 0, 0] })).toThrow("ray");
  expect(() => index.distanceTo(index, { matrix: new Array(16).fill(1) })).toThrow("rotation and a translation");
  expect(() => new Index(new Scene({ positions: [0, 0, 0] })).signedDistance([1, 0, 0])).toThrow("no triangles");
  expect(() => new Index(scene, { backend: "brute" }).save()).toThrow('"brute" has no saved form');
  expect(() => Index.load(new Uint8Array(3))).toThrow();
});

test("a disposed object throws, and can be disposed of again", () => {
  const [scene, other] = [new Scene(triangle), new Scene(triangle)];
  const index = new Index(scene);
  scene.dispose();
  scene.dispose();
  expect(() => scene.counts).toThrow("disposed");
  expect(index.closestPoint([0, 0, 2])!.distance).toBe(2);
  index[Symbol.dispose]();
  expect(() => index.closestPoint([0, 0, 2])).toThrow("disposed");
  expect(other.counts.triangles).toBe(1);
});

test("the memory of disposed objects is used again", () => {
  const arrays = blob(60);
  const addresses = Array.from({ length: 40 }, () => {
    const scene = new Scene(arrays);
    const index = new Index(scene);
    index.within([0, 0, 0], 10);
    index.save();
    const address = index.address;
    index.dispose();
    scene.dispose();
    return address;
  });
  // A leak of 30 indexes of a megabyte each would lead to addresses far above the first ones.
  expect(Math.max(...addresses)).toBeLessThan(Math.max(...addresses.slice(0, 10)) + 1e6);
});

const BACKENDS: IndexOptions[] = [
  { backend: "aabb" }, { backend: "kdop", kdopFaces: 18 }, { backend: "octree", resolution: 0.5 }, { backend: "p2m" },
  { queries: 1e7 },
];

test.each(BACKENDS)("%o answers as an exhaustive search does", (options) => {
  const arrays = mixture(400, 200, 100, 3);
  const scene = new Scene(arrays);
  const [index, brute] = [new Index(scene, options), new Index(scene, { backend: "brute" })];
  expect(index.primitiveCount).toBe(700);
  expect(index.memoryBytes).toBeGreaterThan(1000);
  if (options.backend) expect(index.backend).toBe(options.backend);
  const random = generator(5);
  const queries = pointsAround(arrays, 200, 7);
  const exact = ({ lowerBound, ...rest }: Closest) => rest;
  for (let i = 0; i < queries.length; i += 3) {
    const query = queries.subarray(i, i + 3);
    const [answer, expected] = [index.closestPoint(query)!, brute.closestPoint(query)!];
    expect(exact(answer)).toEqual(exact(expected));
    expect(answer.lowerBound).toBeLessThanOrEqual(answer.distance);
    expect(answer.lowerBound).toBeGreaterThan(answer.distance * (1 - 1e-9));
    expect(index.closestPoint({ x: query[0]!, y: query[1]!, z: query[2]! })).toEqual(answer);
    const [nodes, work] = [index.work(query), brute.work(query)];
    expect(nodes.primitives).toBeLessThan(work.primitives);
    expect(index.closestPoint(query, { maxDistance: answer.distance * 0.99 })).toBeNull();
    const nearest = index.kNearest(query, 5);
    expect(nearest.map(exact)).toEqual(brute.kNearest(query, 5).map(exact));
    const near = index.within(query, nearest[4]!.distance);
    expect(near.map(exact)).toEqual(brute.within(query, nearest[4]!.distance).map(exact));
    expect(near.length).toBeGreaterThanOrEqual(5);
    expect(index.isAnyWithin(query, answer.distance * 0.99)).toBe(false);
    expect(index.isAnyWithin(query, answer.distance)).toBe(true);
    if (["octree", "p2m"].includes(index.backend)) {
      expect(() => index.raycast({ origin: query, direction: [1, 0, 0] }))
        .toThrow("casts no rays; these do: brute, aabb, kdop");
      continue;
    }
    const ray = { origin: query, direction: [random(-1, 1), random(-1, 1), random(-1, 1)], radius: i % 2 ? 0 : 0.1 };
    const hits = index.raycast(ray);
    expect(hits).toEqual(brute.raycast(ray));
    expect(index.raycastFirst(ray)).toEqual(hits[0] ?? null);
    expect(index.raycastAny(ray)).toBe(hits.length > 0);
    if (hits[0]) expect(index.raycast({ ...ray, tMin: hits[0].t, tMax: hits[0].t })[0]).toEqual(hits[0]);
  }
  expect(index.kNearest([0, 0, 0], 1e9).length).toBe(700);
  expect(index.within([0, 0, 0], 1e-9)).toEqual([]);
});

test("an answer can be overwritten", () => {
  const index = new Index(new Scene(triangle));
  const into = index.closestPoint([0, 0, 1])!;
  expect(index.closestPoint([0.25, 0.25, -3], { into })).toBe(into);
  expect(into).toEqual({
    distance: 3, point: [0.25, 0.25, 0], weights: [0.5, 0.25, 0.25],
    lowerBound: into.lowerBound, primitive: 0, feature: 6
  });
  const hit = index.raycastFirst({ origin: [0.25, 0.25, 5], direction: [0, 0, -1] })!;
  expect(index.raycastFirst({ origin: [0.25, 0.5, -5], direction: [0, 0, 2] }, hit)).toBe(hit);
  expect(hit).toEqual({ t: 2.5, point: [0.25, 0.5, 0], weights: [0.25, 0.25, 0.5], primitive: 0, side: -1 });
});

test("batches are single queries", () => {
  const arrays = blob(40);
  const index = new Index(new Scene(arrays), { backend: "octree" });
  // The batch has two parts, the second of which is small.
  const count = (1 << 18) + 100;
  const queries = pointsAround(arrays, count, 11);
  const columns = {
    distance: new Float64Array(count), primitive: new Uint32Array(count), point: new Float64Array(3 * count),
    feature: new Uint8Array(count), weights: new Float64Array(3 * count), lowerBound: new Float64Array(count),
    normal: new Float64Array(3 * count),
  };
  expect(index.closestPoints(queries, columns)).toBe(columns);
  const single = new Float32Array(count);
  index.closestPoints(queries, { distance: single }, { keepsOrder: true });
  expect(single).toEqual(Float32Array.from(columns.distance));
  for (let i = 0; i < count; i += i < 260_000 ? 997 : 1) {
    const answer = index.closestPoint(queries.subarray(3 * i, 3 * i + 3))!;
    const at = (array: Float64Array) => [...array.subarray(3 * i, 3 * i + 3)];
    expect([columns.distance[i], columns.primitive[i], at(columns.point), columns.feature[i], at(columns.weights)])
      .toEqual([answer.distance, answer.primitive, answer.point, answer.feature, answer.weights]);
    expect(Math.hypot(...at(columns.normal))).toBeCloseTo(1, 12);
    expect(columns.lowerBound[i]).toBeCloseTo(answer.lowerBound, 12);
  }
  const { distance, primitive } = index.closestPoints(queries.subarray(0, 30), undefined, { maxDistance: 1e-9 });
  expect([...distance, ...primitive]).toEqual([...Array(10).fill(Infinity), ...Array(10).fill(0xffffffff)]);
  expect(index.closestPoints([]).distance.length).toBe(0);
});

test("signs are those of a sphere", () => {
  const index = new Index(new Scene(blob(40)));
  const queries = pointsAround(blob(4), 1000, 13);
  const [distances, inside] = [index.signedDistances(queries), index.containsEach(queries)];
  let count = 0;
  for (let i = 0; i < 1000; i++) {
    const query = queries.subarray(3 * i, 3 * i + 3);
    const radius = Math.hypot(...query);
    if (radius < 0.79) expect(inside[i]).toBe(1);
    if (radius > 1.21) expect(inside[i]).toBe(0);
    expect(Math.sign(distances[i]!)).toBe(inside[i] ? -1 : 1);
    expect(Math.abs(distances[i]!)).toBe(index.closestPoint(query)!.distance);
    expect(index.signedDistance(query)).toBe(distances[i]);
    expect(index.contains(query)).toBe(inside[i] !== 0);
    count += inside[i]!;
  }
  expect(count).toBeGreaterThan(40);
  expect(index.signedDistances(queries, new Float32Array(1000), { maxDistance: 1e-9 }).every(Number.isNaN)).toBe(true);
});

test("the distance to a moved scene", () => {
  const [first, second] = [new Index(new Scene(triangle)), new Index(new Scene(triangle), { backend: "kdop" })];
  // A quarter turn about z, and a translation, column by column.
  const matrix = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 2, 3, 1];
  const pair = first.distanceTo(second, { matrix })!;
  expect(pair.points).toEqual([[1, 0, 0], [4, 2, 3]].map((p) => p.map((x) => expect.closeTo(x, 12))));
  expect(pair.distance).toBeCloseTo(Math.hypot(3, 2, 3), 12);
  expect([pair.primitives, pair.features, pair.isIntersecting]).toEqual([[0, 0], [1, 2], false]);
  expect(pair.weights).toEqual([[0, 1, 0], [0, 0, 1]]);
  expect(first.distanceTo(second, { matrix, maxDistance: 4 })).toBeNull();
  expect(first.distanceTo(second)).toMatchObject({ distance: 0, isIntersecting: true });
});

test("a tree is fitted to moved vertices", () => {
  const [arrays, moved] = [blob(20), blob(20, [4, 0, 0])];
  const index = new Index(new Scene(arrays));
  index.refit(new Scene(moved));
  const query = [4.1, 0.2, 0.1];
  expect(index.closestPoint(query)).toEqual(new Index(new Scene(moved)).closestPoint(query));
  expect(() => index.refit(new Scene(triangle))).toThrow();
  expect(() => new Index(new Scene(arrays), { backend: "octree" }).refit(new Scene(moved))).toThrow("has no refit");
});

test("a saved index gives the same answers, and damage is noticed", () => {
  const arrays = mixture(300, 100, 50, 17);
  const index = new Index(new Scene(arrays), { backend: "octree" });
  const saved = index.save();
  const loaded = Index.load(saved);
  expect(loaded).toBeInstanceOf(Index);
  expect(loaded.backend).toBe("octree");
  const queries = pointsAround(arrays, 500, 19);
  expect(loaded.closestPoints(queries)).toEqual(index.closestPoints(queries));
  expect(Buffer.from(loaded.save()).equals(saved)).toBe(true);
  saved[saved.length >> 1]! ^= 1;
  expect(() => Index.load(saved)).toThrow();
});

test("primitives in any order", () => {
  const positions = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  const index = new Index(new Scene({ positions, sizes: [1, 3, 2], vertices: [3, 0, 1, 2, 0, 3] }));
  expect(index.closestPoint([0, 0, 2])!.primitive).toBe(0);
  expect(index.closestPoint([1, 1, -1])!.primitive).toBe(1);
  expect(index.closestPoint([-1, -1, 0.5])!.primitive).toBe(2);
  expect(() => new Scene({ positions, sizes: [1, 4], vertices: [0, 1, 2, 3, 0] })).toThrow("1 to 3 vertices");
  expect(() => new Scene({ positions, sizes: [1], vertices: [0, 1] })).toThrow("their sum is less");
});

test("a pool gives the answers of an index", async () => {
  const arrays = blob(30);
  const index = new Index(new Scene(arrays));
  const queries = pointsAround(arrays, 10_000, 23);
  using pool = await Pool.create(index, { workers: 3 });
  expect(pool.size).toBe(3);
  expect(await pool.closestPoints(queries)).toEqual(index.closestPoints(queries));
  const [point, distance] = [new Float32Array(30_000), new Float64Array(new SharedArrayBuffer(80_000))];
  const [answered, signed] = await Promise.all([
    pool.closestPoints(Float32Array.from(queries), { point, distance }), pool.signedDistances(queries),
  ]);
  expect(answered.point).toBe(point);
  expect(answered).toEqual(index.closestPoints(Float32Array.from(queries), {
    point: new Float32Array(30_000), distance: new Float64Array(new SharedArrayBuffer(80_000)),
  }));
  expect(signed).toEqual(index.signedDistances(queries));
  expect(await pool.containsEach(queries)).toEqual(index.containsEach(queries));
  await expect(pool.closestPoints(queries, { point: new Float64Array(1) })).rejects.toThrow("point: the length is 1");
  await expect(pool.closestPoints([0, 0, NaN])).rejects.toThrow("not finite");
  expect((await pool.closestPoints([0, 0, 9])).distance[0]).toBe(index.closestPoint([0, 0, 9])!.distance);
  pool.dispose();
  await expect(pool.closestPoints([0, 0, 9])).rejects.toThrow("disposed");
});

test("a pool with a worker that has ended rejects this batch and all later ones", async () => {
  const started: Worker[] = [];
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (this: Worker, ...message) {
    started.push(this);
    return post.apply(this, message);
  };
  const pool = await Pool.create(new Index(new Scene(triangle)), { workers: 2 })
    .finally(() => { Worker.prototype.postMessage = post; });
  const [, worker] = started;
  const pending = pool.closestPoints(new Float64Array(3 << 20));
  await Promise.all([worker!.terminate(), expect(pending).rejects.toThrow("a worker failed: it has ended")]);
  await expect(pool.closestPoints(new Float64Array(3 << 12))).rejects.toThrow("a worker failed: it has ended");
  pool.dispose();
});

test("a pool of an index that cannot be saved is refused", async () => {
  await expect(Pool.create(new Index(new Scene(triangle), { backend: "brute" }))).rejects.toThrow("no saved form");
});
