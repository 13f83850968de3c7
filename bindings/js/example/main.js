// An example page: a mesh, cables and points in one index, and the closest point to a query that follows the pointer.

import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Index, Scene, init } from "p2m";
import { accelerate } from "p2m/three";

await init();

// The scene as arrays: a knot of triangles, a helix of segments around it, and a ring of points.
const knot = new three.TorusKnotGeometry(1, 0.32, 400, 48);
const helix = Array.from({ length: 401 }, (_, i) => {
  const angle = (i / 400) * 6 * Math.PI;
  return [1.9 * Math.cos(angle), 1.9 * Math.sin(angle), (i / 400 - 0.5) * 2.4];
});
const ring = Array.from({ length: 90 }, (_, i) => {
  const angle = (i / 90) * 2 * Math.PI;
  return [2.3 * Math.cos(angle), 2.3 * Math.sin(angle), 0.25 * Math.sin(5 * angle)];
});
const knotVertices = knot.attributes.position.count;
const positions = new Float32Array([...knot.attributes.position.array, ...helix.flat(), ...ring.flat()]);
const triangles = knot.index.array;
const segments = helix.slice(1).flatMap((_, i) => [knotVertices + i, knotVertices + i + 1]);
const points = ring.map((_, i) => knotVertices + helix.length + i);

const start = performance.now();
const index = new Index(new Scene({ positions, triangles, segments, points }));
const buildTime = performance.now() - start;

// The picture.
const renderer = new three.WebGLRenderer({ antialias: true });
renderer.setPixelRatio(devicePixelRatio);
document.body.append(renderer.domElement);
const scene = new three.Scene();
scene.background = new three.Color("#f5f6f8");
const camera = new three.PerspectiveCamera(40, 1, 0.1, 100);
camera.position.set(0, -1.5, 7.5);
const light = new three.DirectionalLight("white", 2.2);
light.position.set(3, -2, 6);
scene.add(new three.HemisphereLight("white", "#8890a0", 1.6), light);
const mesh = new three.Mesh(knot, new three.MeshStandardMaterial({ color: "#d9a441", roughness: 0.55 }));
const path = (list) => new three.BufferGeometry().setFromPoints(list.map((point) => new three.Vector3(...point)));
scene.add(mesh, new three.Line(path(helix), new three.LineBasicMaterial({ color: "#3c4a5e" })),
  new three.Points(path(ring), new three.PointsMaterial({ color: "#3c4a5e", size: 6, sizeAttenuation: false })));
accelerate(mesh);

// The answer: the query, the closest point, the line between them, the primitive, and the empty ball.
const ball = (colour, radius) =>
  new three.Mesh(new three.SphereGeometry(radius, 24, 16),
    new three.MeshBasicMaterial({ color: colour, depthTest: false }));
const [queryMark, pointMark] = [ball("#1769d2", 0.035), ball("#d02b45", 0.035)];
const emptyBall = new three.Mesh(new three.SphereGeometry(1, 48, 32),
  new three.MeshBasicMaterial({ color: "#1769d2", transparent: true, opacity: 0.12, depthWrite: false }));
const between = new three.Line(new three.BufferGeometry().setFromPoints([new three.Vector3(), new three.Vector3()]),
  new three.LineBasicMaterial({ color: "#1769d2", depthTest: false }));
const outline = new three.LineLoop(new three.BufferGeometry().setFromPoints([0, 1, 2].map(() => new three.Vector3())),
  new three.LineBasicMaterial({ color: "#d02b45", depthTest: false }));
for (const mark of [queryMark, pointMark, between, outline]) mark.renderOrder = 1;
scene.add(emptyBall, between, outline, queryMark, pointMark);

const controls = new OrbitControls(camera, renderer.domElement);
const raycaster = new three.Raycaster();
raycaster.firstHitOnly = true;
const query = new three.Vector3(0.1, -0.9, 1.4);
const list = document.querySelector("dl");
const feature = (code) => (code < 3 ? `vertex ${code}` : code < 6 ? `edge ${code - 3}` : "interior");
const kind = (primitive) =>
  primitive < triangles.length / 3 ? ["triangle", triangles, 3, primitive]
    : primitive < triangles.length / 3 + segments.length / 2
      ? ["segment", segments, 2, primitive - triangles.length / 3]
      : ["point", points, 1, primitive - triangles.length / 3 - segments.length / 2];

function show() {
  const answer = index.closestPoint(query);
  const repetitions = 200;
  const before = performance.now();
  for (let i = 0; i < repetitions; i++) index.closestPoint(query, { into: answer });
  const rate = repetitions / ((performance.now() - before) / 1000);
  const point = new three.Vector3(...answer.point);
  queryMark.position.copy(query);
  pointMark.position.copy(point);
  emptyBall.position.copy(query);
  emptyBall.scale.setScalar(answer.lowerBound);
  between.geometry.setFromPoints([query, point]);
  const [name, vertices, size, number] = kind(answer.primitive);
  outline.geometry.setFromPoints([0, 1, 2].map((i) => {
    const vertex = vertices[size * number + Math.min(i, size - 1)];
    return new three.Vector3().fromArray(positions, 3 * vertex);
  }));
  const [hit] = raycaster.intersectObject(mesh);
  const rows = [
    ["distance", answer.distance.toFixed(6)], ["nearest", `${name} ${number}`],
    ["closest point on", feature(answer.feature)],
    ["under the pointer", hit ? `triangle ${hit.faceIndex}` : "nothing"],
    ["primitives", index.primitiveCount.toLocaleString("en")],
    ["built in", `${buildTime.toFixed(0)} ms`]];
  if (Number.isFinite(rate)) rows.push(["queries per second", Number(rate.toPrecision(2)).toLocaleString("en")]);
  list.replaceChildren(...rows.flatMap(([term, text]) => {
    const [dt, dd] = ["dt", "dd"].map((tag) => document.createElement(tag));
    [dt.textContent, dd.textContent] = [term, text];
    return [dt, dd];
  }));
  renderer.render(scene, camera);
}

// The query is the point under the pointer on the plane through the centre that faces the viewer.
addEventListener("pointermove", (event) => {
  raycaster.setFromCamera(
    new three.Vector2((event.clientX / innerWidth) * 2 - 1, 1 - (event.clientY / innerHeight) * 2), camera
  );
  const plane = new three.Plane().setFromNormalAndCoplanarPoint(
    camera.getWorldDirection(new three.Vector3()), controls.target
  );
  if (event.buttons === 0) raycaster.ray.intersectPlane(plane, query);
  show();
});
controls.addEventListener("change", show);
function resize() {
  renderer.setSize(innerWidth, innerHeight);
  camera.aspect = innerWidth / innerHeight;
  // The panel covers the left of a wide window.
  camera.setViewOffset(innerWidth, innerHeight, innerWidth > 900 ? -170 : 0, 0, innerWidth, innerHeight);
  show();
}
addEventListener("resize", resize);
resize();
document.documentElement.dataset.ready = "true";
