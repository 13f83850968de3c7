import {
  BackSide, BufferAttribute, BufferGeometry, DoubleSide, FrontSide, InstancedMesh, InterleavedBuffer,
  InterleavedBufferAttribute, Line, LineLoop, LineSegments, Matrix4, Mesh, MeshBasicMaterial, Object3D, Points,
  Raycaster,
  SphereGeometry, Vector3,
} from "three";
import type { Intersection } from "three";
import { beforeAll, describe, expect, test } from "vitest";
import { init } from "../dist/index.js";
import { accelerate, indexOf, sceneOf } from "../dist/three.js";
import type { Indexable } from "../dist/three.js";
import { generator } from "./scenes.js";

beforeAll(() => init());

const random = generator(43);

/** Returns random positions. */
function cloud(count: number): BufferGeometry {
  const positions = Float32Array.from({ length: 3 * count }, () => random(-1, 1));
  return new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
}

/** Moves an object by a transform with different scales, which mirrors a mesh. */
function moved<Own extends Object3D>(object: Own): Own {
  object.position.set(0.3, -0.2, 0.1);
  object.rotation.set(0.4, 1.1, -0.3);
  object.scale.set(1.3, 0.8, object instanceof Mesh ? -0.9 : 0.9);
  object.updateMatrixWorld();
  return object;
}

/** Compares the hits of three.js with those of an index, and returns their number. */
function compare(object: Indexable, threshold = 0.05): number {
  const raycaster = new Raycaster();
  raycaster.params.Line.threshold = raycaster.params.Points.threshold = threshold;
  const rays = Array.from({ length: 300 }, () => {
    const origin = new Vector3(random(-2, 2), random(-2, 2), random(-2, 2));
    return { origin, direction: new Vector3(random(-1, 1), random(-1, 1), random(-1, 1)).sub(origin).normalize() };
  });
  const cast = () => rays.map(({ origin, direction }, i) => {
    raycaster.set(origin, direction);
    [raycaster.near, raycaster.far] = i % 3 === 0 ? [0.5, 2] : [0, Infinity];
    const hits = raycaster.intersectObject(object);
    // Rounding decides the order of equally near hits.
    const id = ({ instanceId = 0, faceIndex, index }: Intersection) => 1e6 * instanceId + (faceIndex ?? index ?? 0);
    return raycaster.firstHitOnly ? hits : hits.sort((a, b) => id(a) - id(b));
  });
  const expected = cast();
  accelerate(object);
  expect(cast().map((hits) => hits.map(plain))).toEqual(expected.map((hits) => hits.map(plain).map(near)));
  raycaster.firstHitOnly = true;
  // Of equally near hits, which occur at shared vertices, either may come first.
  const distances = (hits: Intersection[]) => hits.map(({ distance }) => distance).sort((a, b) => a - b).slice(0, 1);
  expect(cast().map((hits) => [hits.length, distances(hits)]))
    .toEqual(expected.map((hits) => [Math.min(1, hits.length), distances(hits).map(near)]));
  return expected.flat().length;
}

/** Returns a hit as plain data, with the id of its object. */
function plain({ object, ...hit }: Intersection): object {
  return JSON.parse(JSON.stringify({ ...hit, uuid: object.uuid }));
}

/** Returns a value with a matcher for nearly equal numbers in place of each number. */
function near(value: unknown): unknown {
  if (typeof value === "number") return expect.closeTo(value, 4);
  if (Array.isArray(value)) return value.map(near);
  if (value && typeof value === "object")
    return Object.fromEntries(Object.entries(value).map(([k, v]) => [k, near(v)]));
  return value;
}

describe("hits are those of three.js", () => {
  test.each([FrontSide, BackSide, DoubleSide])("of a mesh with the side %d", (side) => {
    const mesh = moved(new Mesh(new SphereGeometry(1, 24, 16), new MeshBasicMaterial({ side })));
    expect(compare(mesh)).toBeGreaterThan(100);
  });

  test("of a mesh with groups, several materials and a draw range", () => {
    const geometry = new SphereGeometry(1, 24, 16);
    geometry.addGroup(0, 900, 1);
    geometry.addGroup(900, 300, 0);
    geometry.setDrawRange(300, 1500);
    const materials = [FrontSide, DoubleSide].map((side) => new MeshBasicMaterial({ side }));
    expect(compare(moved(new Mesh(geometry, materials)))).toBeGreaterThan(100);
  });

  test("of a mesh without indices, with interleaved positions", () => {
    const flat = new SphereGeometry(1, 12, 8).toNonIndexed();
    const data = new Float32Array(5 * flat.attributes["position"]!.count);
    for (let i = 0; i < data.length / 5; i++) {
      for (let k = 0; k < 3; k++) data[5 * i + k] = flat.attributes["position"]!.getComponent(i, k);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new InterleavedBufferAttribute(new InterleavedBuffer(data, 5), 3, 0));
    expect(compare(moved(new Mesh(geometry, new MeshBasicMaterial())))).toBeGreaterThan(100);
  });

  test("of a mesh with morph targets", () => {
    const geometry = new SphereGeometry(1, 12, 8);
    const shifted = geometry.attributes["position"]!.clone().applyMatrix4(new Matrix4().makeScale(1.5, 1, 1));
    geometry.morphAttributes["position"] = [shifted as BufferAttribute];
    const mesh = new Mesh(geometry, new MeshBasicMaterial());
    mesh.morphTargetInfluences![0] = 0.7;
    expect(compare(mesh)).toBeGreaterThan(100);
  });

  test("of instances", () => {
    const mesh = moved(
      new InstancedMesh(new SphereGeometry(0.4, 12, 8), new MeshBasicMaterial({ side: DoubleSide }), 5)
    );
    for (let i = 0; i < 5; i++)
      mesh.setMatrixAt(i, new Matrix4().makeTranslation(random(-1, 1), random(-1, 1), random(-1, 1)));
    expect(compare(mesh)).toBeGreaterThan(100);
  });

  test.each([Line, LineLoop, LineSegments])("of lines: %o", (kind) => {
    expect(compare(moved(new kind(cloud(41))))).toBeGreaterThan(100);
    const indexed = cloud(60);
    indexed.setIndex([...Array(50).keys()].reverse());
    indexed.setDrawRange(6, 30);
    expect(compare(moved(new kind(indexed)))).toBeGreaterThan(50);
  });

  test("of points", () => {
    expect(compare(moved(new Points(cloud(2000))))).toBeGreaterThan(100);
    const indexed = cloud(800);
    indexed.setIndex([...Array(700).keys()].reverse());
    indexed.setDrawRange(10, 600);
    expect(compare(moved(new Points(indexed)))).toBeGreaterThan(50);
  });
});

test("an object that a matrix flattens is not hit", () => {
  const mesh = new Mesh(new SphereGeometry(1), new MeshBasicMaterial());
  mesh.scale.setScalar(0);
  mesh.updateMatrixWorld();
  accelerate(mesh);
  expect(new Raycaster(new Vector3(0, 0, 5), new Vector3(0, 0, -1)).intersectObject(mesh)).toEqual([]);
});

test("an index of a geometry answers in its frame, and is fitted to its vertices", () => {
  const geometry = new SphereGeometry(1, 32, 32);
  const mesh = new Mesh(geometry, new MeshBasicMaterial());
  const index = accelerate(mesh, indexOf(geometry, { backend: "kdop" }));
  expect(index.backend).toBe("kdop");
  expect(index.closestPoint(new Vector3(0, 0, 5))!.distance).toBeCloseTo(4, 2);
  geometry.translate(0, 0, 2);
  index.refit(sceneOf(mesh));
  expect(index.closestPoint(new Vector3(0, 0, 5))!.distance).toBeCloseTo(2, 2);
  expect(new Raycaster(new Vector3(0, 0, 5), new Vector3(0, 0, -1))
    .intersectObject(mesh)[0]!.distance).toBeCloseTo(2, 2);
});
