// The measurements of p2m and three-mesh-bvh, which `compare.mjs` runs in Node.js and in a browser.

import { BufferAttribute, BufferGeometry, Ray, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import { Index, Scene } from "../dist/index.js";

/** The number of rounds. Everything is measured once in each, so that other work on the machine affects all alike. */
const ROUNDS = 7;
/** The sets of queries. */
const SETS = ["10x", "1x", "near", "surface"];

/** Returns a generator of numbers below 1 with a fixed seed (mulberry32). */
function generator(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/**
 * Returns the queries of each set: uniform in the box of the scene, or in one ten times as large; near the surface; on
 * it.
 */
function querySets({ positions, triangles }, count) {
  const random = generator(1);
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const diagonal = Math.hypot(...high.map((x, k) => x - low[k]));
  const inBox = (scale) => [0, 1, 2].map((k) => (low[k] + high[k]) / 2 + (random() - 0.5) * scale * (high[k] - low[k]));
  const onSurface = (displacement) => {
    const corners = triangles.subarray(3 * Math.floor((random() * triangles.length) / 3)).subarray(0, 3);
    let [u, v] = [random(), random()];
    if (u + v > 1) [u, v] = [1 - u, 1 - v];
    return [0, 1, 2].map((k) => {
      const [a, b, c] = [...corners].map((i) => positions[3 * i + k]);
      return a + u * (b - a) + v * (c - a) + displacement * (random() - 0.5);
    });
  };
  const make = {
    "10x": () => inBox(10), "1x": () => inBox(1), near: () => onSurface(0.02 * diagonal),
    surface: () => onSurface(0)
  };
  return Object.fromEntries(
    SETS.map((name) => [name, Float32Array.from(Array.from({ length: count }, make[name]).flat())])
  );
}

/**
 * Measures a mesh, and returns the median over the rounds of each measurement, in microseconds. `now` returns the CPU
 * time.
 */
export async function measure(mesh, count, now) {
  const { positions, triangles } = mesh;
  const sets = querySets(mesh, count);
  const times = {};
  const time = async (name, divisor, work) => {
    const start = await now();
    const result = work();
    (times[name] ??= []).push(((await now()) - start) / divisor);
    return result;
  };
  const vector = new Vector3();
  const memory = {};
  for (let round = 0; round < ROUNDS; round++) {
    // three-mesh-bvh reorders the indices of its geometry.
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setIndex(new BufferAttribute(triangles.slice(), 1));
    const bvh = await time("build three-mesh-bvh", 1, () => new MeshBVH(geometry));
    const scene = await time("scene", 1, () => new Scene({ positions, triangles }));
    const tree = await time("build aabb", 1, () => new Index(scene, { backend: "aabb" }));
    const octree = await time("build auto", 1, () => new Index(scene, { queries: 10_000_000 }));
    if (round === 0) {
      memory["three-mesh-bvh"] = bvh._roots.reduce((sum, root) => sum + root.byteLength, 0) + triangles.byteLength;
      memory.aabb = tree.memoryBytes;
      memory[`auto (${octree.backend})`] = octree.memoryBytes;
    }
    for (const set of SETS) {
      const queries = sets[set];
      const target = { point: new Vector3(), distance: 0, faceIndex: 0 };
      const sums = {};
      await time(`${set} three-mesh-bvh`, count, () => {
        let sum = 0;
        for (let i = 0; i < count; i++) {
          sum += bvh.closestPointToPoint(vector.fromArray(queries, 3 * i), target).distance;
        }
        sums.bvh = sum;
      });
      const into = tree.closestPoint([0, 0, 0]);
      for (const [name, index] of [["aabb", tree], ["auto", octree]]) {
        await time(`${set} ${name}`, count, () => {
          let sum = 0;
          for (let i = 0; i < count; i++)
            sum += index.closestPoint(vector.fromArray(queries, 3 * i), { into }).distance;
          sums[name] = sum;
        });
        const distance = new Float64Array(count);
        await time(`${set} ${name} batch`, count, () => index.closestPoints(queries, { distance }));
        sums[`${name} batch`] = distance.reduce((a, b) => a + b);
      }
      for (const [name, sum] of Object.entries(sums)) {
        if (!(Math.abs(sum - sums.aabb) <= 1e-4 * sums.aabb))
          throw new Error(`${set}: ${name}: ${sum} instead of ${sums.aabb}`);
      }
    }
    // Rays from points of the tenfold box to points of the scene.
    const [origins, targets] = [sets["10x"], sets["1x"]];
    const rays = Array.from({ length: count }, (_, i) => {
      const origin = new Vector3().fromArray(origins, 3 * i);
      return new Ray(origin, new Vector3().fromArray(targets, 3 * i).sub(origin).normalize());
    });
    const hits = {};
    await time("rays three-mesh-bvh", count, () => {
      hits.bvh = rays.filter((ray) => bvh.raycastFirst(ray, 2) !== null).length;
    });
    const into = { t: 0, point: [0, 0, 0], weights: [0, 0, 0], primitive: 0, side: 0 };
    await time("rays aabb", count, () => {
      hits.aabb = rays.filter((ray) => tree.raycastFirst(ray, into) !== null).length;
    });
    if (Math.abs(hits.bvh - hits.aabb) > count / 1000)
      throw new Error(`rays: ${hits.bvh} hits instead of ${hits.aabb}`);
    for (const owned of [scene, tree, octree]) owned.dispose();
  }
  const medians = Object.fromEntries(
    Object.entries(times).map(([name, all]) => [name, all.sort((a, b) => a - b)[all.length >> 1]]));
  return { medians, memory };
}
