// Compares answers with the program `p2m`, bit for bit. The environment variable P2M names the program.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { Index, Scene, init } from "../dist/index.js";
import type { Backend } from "../dist/index.js";
import { blob, mixture, obj, parseObj, pointsAround, rounded } from "./scenes.js";
import type { Arrays } from "./scenes.js";

const PROGRAM = process.env["P2M"];
const QUERIES = 100_000;

/** The scenes, each with a backend for the program and another one for the package. All give the same answers. */
const SCENES: [string, () => Arrays, Backend, Backend][] = [
  [
    "a knot and cables",
    () => parseObj(readFileSync(new URL("../../../scenes/knot_and_cables.obj", import.meta.url), "utf8")),
    "aabb", "octree"
  ],
  ["a closed surface", () => blob(80), "octree", "aabb"],
  ["a surface far from the origin", () => blob(60, [4e6, 5e5, -3e5], 100), "aabb", "kdop"],
  ["a mixture with degenerate primitives", () => mixture(1500, 800, 300, 29), "kdop", "p2m"],
  ["points", () => mixture(0, 0, 1000, 31), "p2m", "aabb"],
];

/** The codes of the features by their names in the output of the program. */
const FEATURES: Record<string, number> = {
  vertex0: 0, vertex1: 1, vertex2: 2, edge0: 3, edge1: 4, edge2: 5, face: 6,
};

describe.skipIf(!PROGRAM)("the answers of the program", () => {
  let folder: string;
  beforeAll(async () => {
    await init();
    folder = mkdtempSync(join(tmpdir(), "p2m-js-"));
  });
  afterAll(() => rmSync(folder, { recursive: true, force: true }));

  const run = (...args: string[]) => execFileSync(PROGRAM!, [...args, "--quiet"], { stdio: "pipe" });
  const file = (name: string, content: string | Uint8Array) => {
    writeFileSync(join(folder, name), content);
    return join(folder, name);
  };

  test.each(SCENES.flatMap((scene) => [[...scene, "f32"], [...scene, "f64"]] as const))(
    "%s: %s %s %s, %s", (_, make, theirs, ours, scalar) => {
      const isSingle = scalar === "f32";
      const scene = isSingle ? rounded(make()) : make();
      const points = pointsAround(scene, QUERIES, 37);
      const queries = isSingle ? Float32Array.from(points) : points;
      const [input, output] = [file("scene.obj", obj(scene)), join(folder, "answers.csv")];
      run("query", input, "--points", file("queries.npy", npy(queries)), "--backend", theirs,
        "--columns", "distance,point,primitive,feature", "--out", output);

      const positions = isSingle ? Float32Array.from(scene.positions) : scene.positions;
      const index = new Index(new Scene({ ...scene, positions }), { backend: ours });
      const answers = index.closestPoints(queries, {
        distance: new Float64Array(QUERIES), point: new Float64Array(3 * QUERIES), primitive: new Uint32Array(QUERIES),
        feature: new Uint8Array(QUERIES),
      });
      const rows = readFileSync(output, "utf8").trim().split("\n").slice(1);
      expect(rows.length).toBe(QUERIES);
      const different = rows.filter((row, i) => {
        const cells = row.split(",");
        const point = answers.point.subarray(3 * i, 3 * i + 3);
        const isSame = Object.is(Number(cells[0]), answers.distance[i]) && Number(cells[4]) === answers.primitive[i] &&
          FEATURES[cells[5]!] === answers.feature[i] && point.every((x, k) => Object.is(Number(cells[k + 1]), x));
        return !isSame;
      });
      expect([different.length, different[0]]).toEqual([0, undefined]);
    });

  test("its saved indexes are loaded, and ours are loaded by it", () => {
    const scene = blob(40);
    const queries = pointsAround(scene, 1000, 41);
    const [input, built, saved] = [file("scene.obj", obj(scene)), join(folder, "built.p2m"), join(folder, "saved.p2m")];
    run("build", input, "--backend", "octree", "--out", built);
    const index = Index.load(readFileSync(built));
    expect(index.backend).toBe("octree");
    expect(index.closestPoints(queries)).toEqual(new Index(new Scene(scene)).closestPoints(queries));
    file("saved.p2m", index.save());
    const output = join(folder, "signed.csv");
    run(
      "query", saved, "--points", file("queries.npy", npy(queries)),
      "--signed", "--columns", "signed", "--out", output
    );
    const rows = readFileSync(output, "utf8").trim().split("\n").slice(1).map(Number);
    expect(rows).toEqual([...index.signedDistances(queries)]);
  });
});

/** Returns rows of three numbers as a NumPy file. */
function npy(array: Float32Array | Float64Array): Uint8Array {
  const kind = array instanceof Float32Array ? "<f4" : "<f8";
  const header = `{'descr': '${kind}', 'fortran_order': False, 'shape': (${array.length / 3}, 3), }`;
  const padded = header.padEnd(Math.ceil((header.length + 11) / 64) * 64 - 11) + "\n";
  const start = Buffer.from([0x93, ...Buffer.from("NUMPY"), 1, 0, padded.length & 255, padded.length >> 8]);
  return Buffer.concat([start, Buffer.from(padded), Buffer.from(array.buffer, array.byteOffset, array.byteLength)]);
}
