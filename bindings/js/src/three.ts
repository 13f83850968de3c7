/**
 * Indexes of the geometries of three.js, and raycasts that use them.
 *
 * @packageDocumentation
 */
import {
  BackSide, BufferGeometry, DoubleSide, FrontSide, InstancedMesh, Line, Matrix3, Matrix4, Mesh, Points, Sphere,
  Triangle,
  Vector2, Vector3,
} from "three";
import type { Intersection, Material, Raycaster } from "three";
import { Index, Scene } from "./index.js";
import type { Hit, IndexOptions, SceneArrays } from "./index.js";

declare module "three" {
  interface Raycaster {
    /** Whether the raycast of an accelerated object returns only the first hit, which is faster. */
    firstHitOnly?: boolean;
  }
}

/** An object over which an index can be built. */
export type Indexable = Mesh | Line | Points;

/**
 * Makes a scene from an object or a geometry, in the local frame of the object: triangles of meshes and geometries,
 * segments of lines, and points. Only the draw range counts. A mesh with bones or morph targets has its current pose.
 */
export function sceneOf(source: Indexable | BufferGeometry): Scene {
  const geometry = source instanceof BufferGeometry ? source : source.geometry;
  const { index } = geometry;
  const { start, end } = rangeOf(geometry);
  const vertex = (i: number) => vertexAt(geometry, i);
  const arrays: SceneArrays = { positions: positionsOf(source, geometry) };
  if (source instanceof Points) {
    arrays.points = Uint32Array.from({ length: end - start }, (_, i) => vertex(start + i));
  } else if (source instanceof Line) {
    const { step, count } = segmentsOf(source, end - start);
    arrays.segments = Uint32Array.from({ length: 2 * count }, (_, i) => {
      // The last segment of a loop ends at its first vertex.
      const at = (i >> 1) * step + (i & 1);
      return vertex(start + (at === end - start ? 0 : at));
    });
  } else {
    const length = Math.floor((end - start) / 3) * 3;
    const whole = index?.array instanceof Uint32Array && start === 0 && length === index.count;
    arrays.triangles = whole ? index.array as Uint32Array : Uint32Array.from({ length }, (_, i) => vertex(start + i));
  }
  return new Scene(arrays);
}

/** Builds an index over an object or a geometry: see {@link sceneOf}. */
export function indexOf(source: Indexable | BufferGeometry, options?: IndexOptions): Index {
  const scene = sceneOf(source);
  try {
    return new Index(scene, options);
  } finally {
    scene.dispose();
  }
}

/**
 * Replaces the `raycast` of an object by one that uses an index. It returns the hits of three.js, except at edges,
 * where rounding may make three.js miss a hit or find it twice. Instances of an instanced mesh share the index.
 *
 * @param object A mesh, an instanced mesh, a line or points.
 * @param index The index over the object. Other objects with the same geometry may share it. After vertices have moved,
 *   call `index.refit(sceneOf(object))`.
 * @returns The index.
 */
export function accelerate(object: Indexable, index: Index = indexOf(object)): Index {
  object.raycast = (raycaster: Raycaster, intersects: Intersection[]) => {
    if (object instanceof InstancedMesh) castAtInstances(object, index, raycaster, intersects);
    else if (object instanceof Mesh) castAtMesh(object, object.matrixWorld, index, raycaster, intersects);
    else castNear(object, index, raycaster, intersects);
  };
  return index;
}

/** Returns the range of the vertices of a geometry that are drawn. */
function rangeOf({ index, attributes, drawRange }: BufferGeometry): { start: number; end: number } {
  const start = Math.max(0, drawRange.start);
  const all = index ? index.count : attributes["position"]!.count;
  return { start, end: Math.max(start, Math.min(all, drawRange.start + drawRange.count)) };
}

/** Returns the vertex at a place of a geometry. */
function vertexAt({ index }: BufferGeometry, i: number): number {
  return index ? index.getX(i) : i;
}

function segmentsOf(line: Line, vertices: number): { step: number; count: number } {
  if ("isLineSegments" in line) return { step: 2, count: Math.floor(vertices / 2) };
  return { step: 1, count: "isLineLoop" in line && vertices > 0 ? vertices : Math.max(0, vertices - 1) };
}

function positionsOf(source: Indexable | BufferGeometry, geometry: BufferGeometry): ArrayLike<number> {
  const position = geometry.attributes["position"]!;
  const isPosed = source instanceof Mesh
    && ("isSkinnedMesh" in source || (source.morphTargetInfluences?.length ?? 0) > 0);
  const isPlain = "array" in position && !("isInterleavedBufferAttribute" in position) && position.itemSize === 3;
  if (isPlain && !isPosed && !position.normalized && position.array instanceof Float32Array) return position.array;
  const [all, vector] = [new Float64Array(3 * position.count), new Vector3()];
  for (let i = 0; i < position.count; i++) {
    if (isPosed) source.getVertexPosition(i, vector);
    else vector.fromBufferAttribute(position, i);
    vector.toArray(all as unknown as number[], 3 * i);
  }
  return all;
}

// Temporary values, which are reused by each call.
const inverse = new Matrix4();
const linear = new Matrix3();
const origin = new Vector3();
const direction = new Vector3();
const sphere = new Sphere();
const instanceMatrix = new Matrix4();
const worldMatrix = new Matrix4();

/** Transforms a ray to the frame of an object. Parameters remain distances in the world. */
function toLocal(raycaster: Raycaster, matrixWorld: Matrix4): boolean {
  if (matrixWorld.determinant() === 0) return false;
  inverse.copy(matrixWorld).invert();
  origin.copy(raycaster.ray.origin).applyMatrix4(inverse);
  direction.copy(raycaster.ray.direction).applyMatrix3(linear.setFromMatrix4(inverse));
  return true;
}

function castAtMesh(
  mesh: Mesh, matrixWorld: Matrix4, index: Index, raycaster: Raycaster, intersects: Intersection[],
): void {
  const { geometry, material } = mesh;
  if (material === undefined || !toLocal(raycaster, matrixWorld)) return;
  const first = rangeOf(geometry).start;
  const materialOf = (hit: Hit): { material: Material; materialIndex: number } | undefined => {
    if (!Array.isArray(material)) return { material, materialIndex: 0 };
    const at = first + 3 * hit.primitive;
    const group = geometry.groups.find(({ start, count }) => start <= at && at < start + count);
    const own = group && material[group.materialIndex ?? 0];
    return own && { material: own, materialIndex: group.materialIndex ?? 0 };
  };
  const isVisible = (hit: Hit) => {
    const side = materialOf(hit)?.material.side;
    return (side === FrontSide && hit.side > 0) || (side === BackSide && hit.side < 0) ||
      (side === DoubleSide && hit.side !== 0);
  };
  const ray = { origin, direction, tMin: raycaster.near, tMax: raycaster.far };
  let hits: Hit[];
  if (raycaster.firstHitOnly) {
    let hit = index.raycastFirst(ray);
    if (hit && !isVisible(hit)) hit = index.raycast(ray).find(isVisible) ?? null;
    hits = hit ? [hit] : [];
  } else {
    hits = index.raycast(ray).filter(isVisible);
  }
  for (const hit of hits) {
    const faceIndex = Math.floor(first / 3) + hit.primitive;
    const corners = [0, 1, 2].map((k) => vertexAt(geometry, first + 3 * hit.primitive + k));
    const [a, b, c] = corners as [number, number, number];
    const [pa, pb, pc] = [a, b, c].map((i) => mesh.getVertexPosition(i, new Vector3())) as [Vector3, Vector3, Vector3];
    const barycoord = new Vector3(...hit.weights);
    const point = new Vector3(...hit.point).applyMatrix4(matrixWorld);
    const normal = Triangle.getNormal(pa, pb, pc, new Vector3());
    const { materialIndex } = materialOf(hit)!;
    const found: Intersection = {
      distance: raycaster.ray.origin.distanceTo(point), point, object: mesh, faceIndex, barycoord,
      face: { a, b, c, normal, materialIndex },
    };
    const { uv, uv1, normal: normals } = geometry.attributes;
    if (uv) found.uv = Triangle.getInterpolatedAttribute(uv, a, b, c, barycoord, new Vector2());
    if (uv1) found.uv1 = Triangle.getInterpolatedAttribute(uv1, a, b, c, barycoord, new Vector2());
    if (normals) {
      found.normal = Triangle.getInterpolatedAttribute(normals, a, b, c, barycoord, new Vector3());
      if (found.normal.dot(direction) > 0) found.normal.negate();
    }
    intersects.push(found);
  }
}

function castAtInstances(
  mesh: InstancedMesh, index: Index, raycaster: Raycaster, intersects: Intersection[],
): void {
  if (mesh.geometry.boundingSphere === null) mesh.geometry.computeBoundingSphere();
  let found: Intersection[] = [];
  for (let instanceId = 0; instanceId < mesh.count; instanceId++) {
    mesh.getMatrixAt(instanceId, instanceMatrix);
    worldMatrix.multiplyMatrices(mesh.matrixWorld, instanceMatrix);
    sphere.copy(mesh.geometry.boundingSphere!).applyMatrix4(worldMatrix);
    if (!raycaster.ray.intersectsSphere(sphere)) continue;
    const before = found.length;
    castAtMesh(mesh, worldMatrix, index, raycaster, found);
    for (const hit of found.slice(before)) hit.instanceId = instanceId;
  }
  if (raycaster.firstHitOnly && found.length > 1) found = [found.reduce((a, b) => (b.distance < a.distance ? b : a))];
  intersects.push(...found);
}

/** Finds the segments or points near the line of a ray. */
function castNear(object: Line | Points, index: Index, raycaster: Raycaster, intersects: Intersection[]): void {
  if (!toLocal(raycaster, object.matrixWorld)) return;
  const { x, y, z } = object.scale;
  const isLine = object instanceof Line;
  const radius = (isLine ? raycaster.params.Line : raycaster.params.Points).threshold / ((x + y + z) / 3);
  const { geometry } = object;
  const { start, end } = rangeOf(geometry);
  const step = isLine ? segmentsOf(object, end - start).step : 1;
  const hits = index.raycast({ origin, direction, radius });
  // Behind the origin, the nearest point of the ray is the origin. So primitives within the radius of it count as well.
  const hit = new Set(hits.map(({ primitive }) => primitive));
  const behind = index.within(origin, radius).filter(({ primitive }) => !hit.has(primitive));
  const found: Intersection[] = [];
  for (const { t, point, primitive } of [...behind.map((closest) => ({ ...closest, t: 0 })), ...hits]) {
    const own = new Vector3(...point);
    const onRay = origin.clone().addScaledVector(direction, t);
    const distanceToRay = own.distanceTo(onRay);
    const distance = raycaster.ray.origin.distanceTo(onRay.applyMatrix4(object.matrixWorld));
    if (distance < raycaster.near || distance > raycaster.far) continue;
    const common = { distance, object, face: null, faceIndex: null, barycoord: null };
    const i = start + primitive * step;
    found.push((isLine
      ? { ...common, point: own.applyMatrix4(object.matrixWorld), index: i }
      : { ...common, distanceToRay, point: onRay, index: vertexAt(geometry, i) }) as unknown as Intersection);
    if (raycaster.firstHitOnly) break;
  }
  intersects.push(...found);
}
