// The scene far from the origin, in Node.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { decompress } from "fzstd";
import { build } from "esbuild";

let folder, FarScene;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "p2m-far-"));
  const [outfile, resolveDir] = [join(folder, "far.mjs"), new URL("../src", import.meta.url).pathname];
  const contents = 'export { FarScene } from "./far.js"; export { init } from "../../../../bindings/js/src/index.ts";';
  await build({ stdin: { contents, resolveDir }, bundle: true, format: "esm", target: "es2022", outfile });
  const module = await import(pathToFileURL(outfile));
  ({ FarScene } = module);
  await module.init(decompress(readFileSync(new URL("../../assets/p2m.wasm.zst", import.meta.url))));
});

after(() => rmSync(folder, { recursive: true, force: true }));

const triangle = (...positions) => FarScene.of({
  positions: Float64Array.from(positions.flat()), sizes: Uint8Array.of(3), vertices: Uint32Array.of(0, 1, 2),
});

test("only tiny and huge scenes are scaled", () => {
  const scales = [[0.75, 32], [8, 2], [16, 1], [3000, 1], [65536, 1], [1e5, 0.5], [3e5, 0.125]];
  for (const [side, scale] of scales) {
    assert.equal(triangle([0, 0, 0], [side, 0, 0], [0, side, 0]).scale, scale, String(side));
  }
});

test("a scene without primitives is not moved", () => {
  assert.equal(FarScene.of({ positions: [], sizes: [], vertices: [] }), null);
});

// Scenes that are large, tiny or far from the origin themselves are treated as any other.
test("the closest point is where the distance says", () => {
  for (const [size, origin] of [[1, 0], [1, 1e6], [1e20, 0], [1e20, 3e22], [1e-200, 0], [1e200, 0]]) {
    const at = (...point) => point.map((x) => origin + x * size);
    const far = triangle(at(0, 0, 0), at(1, 0.1, 0), at(0, 1, 0.3));
    for (const query of [at(0.3, 0.2, 0.9), at(1.4, 1.1, 0.2), at(-0.4, 0.2, -0.3)]) {
      const answer = far.query(query);
      const measured = Math.hypot(...answer.p2m.point.map((x, k) => (x - answer.query[k]) / size));
      const rounding = (2 * Number.EPSILON * origin) / size;
      assert.ok(Math.abs(measured - answer.distance / size) <= 1e-6 + rounding, `${size} ${origin} ${measured}`);
      assert.ok(Math.abs(answer.p2m.distance / answer.distance - 1) <= 2 ** -23);
    }
  }
});

test("distances far away are accurate where those of ordinary arithmetic jump", () => {
  const side = 12;
  const positions = Float64Array.from({ length: 3 * side * side }, (_, i) => {
    const [x, y] = [Math.floor(i / 3) % side, Math.floor(i / 3 / side)];
    return [x, y, Math.sin(0.9 * x) + Math.cos(0.7 * y)][i % 3];
  });
  const cells = [...Array(side * side).keys()].filter((i) => i % side < side - 1 && i < side * (side - 1));
  const vertices = Uint32Array.from(cells.flatMap((i) => [i, i + 1, i + side, i + 1, i + side + 1, i + side]));
  const far = FarScene.of({ positions, sizes: new Uint8Array(vertices.length / 3).fill(3), vertices });
  assert.equal(far.scale, 2);
  let worst = 0;
  for (let i = 0; i < 500; i++) {
    const t = i / 500;
    const query = [14 * t - 1, 6 + 7 * Math.sin(9 * t), 2 + 3 * Math.cos(23 * t)];
    const answer = far.query(query);
    // Half a spacing of f32, in each coordinate.
    assert.ok(answer.query.every((x, k) => Math.abs(x - query[k]) <= 1 / 32 / far.scale));
    assert.ok(Math.abs(answer.p2m.distance - answer.distance) <= 2 ** -23 * answer.distance);
    worst = Math.max(worst, Math.abs(answer.ordinary.distance - answer.distance));
  }
  assert.ok(worst > 0.007, String(worst));
});
