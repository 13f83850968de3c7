// A worker of live queries: it has the npm package of p2m with the scene and an index. Each message calls one of the
// functions below, in order, and is answered by its result.

import { Index, Scene, init } from "../../../../bindings/js/src/index.ts";
import { FarScene } from "./far.js";

// The kinds of indexes by their numbers.
const BACKENDS = ["aabb", "kdop", "octree", "p2m"];
// The number of primitives above which no cells of vertices are built, because their build would take many seconds.
const MAX_VERTEX_CELL_PRIMITIVES = 50_000;
// The milliseconds for which the queries of an index are measured, after a warm-up of the same length, in which the
// browser compiles them.
const MEASURED_TIME = 100;

let arrays, scene, index, far;

const FUNCTIONS = {
  // Loads the module and the scene, before any other call.
  async load({ module, coordinates: positions, sizes, indices: vertices }) {
    await init(module);
    arrays = { positions, sizes, vertices };
    scene = new Scene(arrays);
  },

  // Builds an index. Its size is 0 if this index is not built for such a scene.
  build(number) {
    const backend = BACKENDS[number];
    if (backend === "p2m" && arrays.sizes.length > MAX_VERTEX_CELL_PRIMITIVES) return { bytes: 0, time: 0 };
    const start = performance.now();
    index = new Index(scene, { backend });
    return { bytes: index.memoryBytes, time: performance.now() - start };
  },

  // Returns the number of queries per second at points around the scene.
  measure() {
    measureRate();
    return measureRate();
  },

  // Builds the scene far from the origin, and returns its scale, or 0 if there is none.
  buildFar() {
    far = FarScene.of(arrays);
    return far?.scale ?? 0;
  },

  // Returns the answer to a query with the work that it took, or `null` if there is none.
  query(_, query) {
    const answer = index.closestPoint(query);
    if (!answer) return null;
    const { nodes, packets, primitives } = index.work(query);
    return { ...answer, work: [nodes, packets, primitives] };
  },

  // Returns the signed distance of a query in a scene of triangles.
  signed: (_, query) => index.signedDistance(query),

  // Returns the answer to a query far from the origin, or `null` if there is none.
  queryFar: (query) => far.query(query),
};

// Answers queries that are spread evenly in the box of the scene scaled by 1.2: multiples of these numbers modulo one,
// which are powers of the reciprocal of the root of x^4 = x + 1, leave no large gaps.
function measureRate() {
  const steps = [0.8191725133961644, 0.6710436067037892, 0.5497004779019701];
  const { low, high } = scene.bounds;
  const into = index.closestPoint(low);
  const query = [0, 0, 0];
  let [answered, size, time] = [0, 64, 0];
  const start = performance.now();
  while (time < MEASURED_TIME) {
    for (let i = 0; i < size; i++) {
      for (let k = 0; k < 3; k++) {
        const part = 1.2 * (((i * steps[k]) % 1) - 0.5) + 0.5;
        query[k] = low[k] * (1 - part) + high[k] * part;
      }
      index.closestPoint(query, { into });
    }
    answered += size;
    time = performance.now() - start;
    size *= 2;
  }
  return answered / (time / 1000);
}

onmessage = async ({ data: { name, values } }) => {
  try {
    postMessage({ result: await FUNCTIONS[name](...values) });
  } catch (error) {
    postMessage({ error: error.message });
  }
};
