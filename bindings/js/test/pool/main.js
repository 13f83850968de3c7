// A page that compares the answers of a pool with those of its index, and answers queries for tests.

import { Index, Pool, Scene, init } from "p2m";
import bytes from "p2m/inline";

await init(bytes);
const positions = Float64Array.from({ length: 3000 }, (_, i) => Math.sin(i * i));
const index = new Index(new Scene({ positions }));
const inline = Math.round(new Index(new Scene({ positions: [0, 0, 0] })).closestPoint([0, 0, 3]).distance);
const queries = Float64Array.from({ length: 30_000 }, (_, i) => 2 * Math.cos(i * i));
const pool = await Pool.create(index, { workers: 2 });
const [expected, found] = [index.closestPoints(queries), await pool.closestPoints(queries)];
const isSame = Object.keys(expected).every((name) => expected[name].every((x, i) => x === found[name][i]));
globalThis.answer = ({ positions, triangles, segments, points }, queries, backend) => {
  const [own, at] = [Float64Array.from(positions), (list) => Uint32Array.from(list)];
  const arrays = { positions: own, triangles: at(triangles), segments: at(segments), points: at(points) };
  const answers = new Index(new Scene(arrays), { backend }).closestPoints(queries);
  return Object.fromEntries(Object.entries(answers).map(([name, values]) => [name, [...values]]));
};
globalThis.result = { isShared: crossOriginIsolated, isSame, size: pool.size, inline };
pool.dispose();
document.documentElement.dataset.ready = "true";
