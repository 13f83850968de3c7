// The scene: its triangles, segments and points, of which each object can be hidden.

import * as three from "three";
import { lightOf } from "./colours.js";
import { outline, pointMaterial, setNormals, spacing, surface } from "./shading.js";

// The kinds of primitives, with the number of vertices of each.
const KINDS = [["triangles", 3], ["segments", 2], ["points", 1]];
// The size of a point relative to the distance to the next one.
const POINT_SIZE = 1.8;
// The number of triangles up to which the lines are drawn in which a slice cuts them, because that takes time.
const MAX_CUT = 300_000;

export class SceneLayer {
  // `scene` has positions in the frame (f32) and for each kind the numbers of vertices. `objects` are names with the
  // first and the last number of their primitives of each kind; primitives of no object have an entry without a name.
  // With `hasColours`, the second object has a colour of its own.
  constructor(scene, hasColours) {
    this.group = new three.Group();
    this.positions = scene.positions;
    this.colours = hasColours ? new three.BufferAttribute(new Uint16Array(scene.positions.length), 3, true) : null;
    const parameters = hasColours ? { vertexColors: true } : {};
    this.objects = scene.objects.map((object) => ({ ...object, isVisible: true }));
    const positions = new three.BufferAttribute(scene.positions, 3);
    this.parts = [];
    // The number of changes of what is visible.
    this.version = 0;
    this.materials = {
      segments: new three.LineBasicMaterial(parameters),
      points: pointMaterial({
        ...parameters,
        size: scene.points.length > 0 ? POINT_SIZE * spacing(scene.positions) : 1, sizeAttenuation: true,
      }),
    };
    for (const [kind, size] of KINDS) {
      const indices = scene[kind];
      if (indices.length === 0) continue;
      const geometry = new three.BufferGeometry();
      geometry.setAttribute("position", positions);
      geometry.setIndex(new three.BufferAttribute(indices, 1));
      if (this.colours) geometry.setAttribute("color", this.colours);
      if (this.colours && kind === "triangles") geometry.setAttribute("part", this.secondParts(indices));
      geometry.boundingSphere = new three.Sphere(new three.Vector3(), 4);
      const drawn = kind === "triangles" ? surface(geometry, parameters)
        : new { segments: three.LineSegments, points: three.Points }[kind](geometry, this.materials[kind]);
      this.materials[kind] = drawn.material;
      this.group.add(drawn);
      this.parts.push({ kind, size, indices, geometry, drawn });
    }
  }

  setTheme(theme, colours) {
    this.edges?.material.color.set(colours.edge);
    this.outlined(colours);
    if (this.colours) {
      const [first, second] = [colours.surface, colours.second].map(lightOf);
      const { array } = this.colours;
      for (let i = 0; i < array.length; i += 3) array.set(first, i);
      for (const i of this.verticesOf(1)) array.set(second, 3 * i);
      this.colours.needsUpdate = true;
      return;
    }
    this.materials.triangles?.color.set(colours.surface);
    this.materials.segments.color.set(colours.line);
    this.materials.points.color.set(colours.surface);
  }

  // Returns for each vertex whether it is one of the triangles of the second object.
  secondParts(triangles) {
    const second = new Uint8Array(this.positions.length / 3);
    const [first, end] = this.objects[1].triangles;
    for (const i of triangles.subarray(3 * first, 3 * end)) second[i] = 1;
    return new three.BufferAttribute(second, 1);
  }

  // Returns the numbers of the vertices of an object.
  verticesOf(number) {
    const all = this.parts.flatMap(({ kind, size, indices }) => {
      const [first, end] = this.objects[number][kind];
      return [...new Set(indices.subarray(size * first, size * end))];
    });
    return new Set(all);
  }

  // Moves all vertices to other positions in the frame.
  setPositions(positions) {
    for (const { kind, indices, geometry } of this.parts) {
      geometry.getAttribute("position").array.set(positions);
      geometry.getAttribute("position").needsUpdate = true;
      if (kind === "triangles") setNormals(geometry, indices);
    }
  }

  // Draws the edges of triangles over them. They are made when they are first asked for, because they take long.
  setEdges(isOn, colours) {
    const surface = this.parts.find(({ kind }) => kind === "triangles");
    if (!surface) return;
    if (!this.edges) {
      const material = new three.MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.5 });
      material.clippingPlanes = this.materials.triangles.clippingPlanes;
      this.edges = new three.Mesh(surface.geometry, material);
      this.edges.material.color.set(colours.edge);
      surface.drawn.add(this.edges);
    }
    this.edges.visible = isOn;
  }

  // Draws the outline of the whole scene over a slice, or not.
  setOutline(isOn, colours) {
    if (isOn && !this.outline) {
      this.outline = new three.Group();
      this.outline.add(...this.parts.map(({ kind, geometry }) => outline(kind, geometry)));
      this.group.add(this.outline);
      this.outlined(colours);
    }
    if (this.outline) this.outline.visible = isOn;
  }

  // Sets the colour of the outline.
  outlined(colours) {
    this.outline?.traverse(({ material }) => material?.color?.set(colours.outline));
  }

  // Draws the lines in which a plane across an axis cuts visible triangles, or none if there is no plane. They are of the
  // colour of text on a slice, whose colours are light near them.
  setSection(axis, at) {
    this.section?.geometry.dispose();
    const surface = this.parts.find(({ kind }) => kind === "triangles");
    if (!surface || surface.geometry.index.count > 3 * MAX_CUT) return;
    this.section ??= new three.LineSegments(new three.BufferGeometry(), new three.LineBasicMaterial({ color: "#101418", depthTest: false }));
    this.section.renderOrder = 1;
    if (!this.section.parent) this.group.add(this.section);
    this.section.geometry = new three.BufferGeometry();
    const ends = at === null ? [] : cutTriangles(this.positions, surface.geometry.index.array, axis, at);
    this.section.geometry.setAttribute("position", new three.Float32BufferAttribute(ends, 3));
  }

  // Cuts away what lies on the positive side of a plane, or nothing.
  cut(plane) {
    const planes = plane ? [plane.clone().negate()] : null;
    for (const material of [...Object.values(this.materials), this.edges?.material]) {
      if (material) material.clippingPlanes = planes;
    }
  }

  setOpacity(opacity) {
    const { triangles } = this.materials;
    if (!triangles) return;
    triangles.transparent = opacity < 1;
    triangles.opacity = opacity;
    triangles.depthWrite = opacity === 1;
    triangles.needsUpdate = true;
  }

  // Shows or hides an object, by its number.
  show(number, isVisible) {
    this.objects[number].isVisible = isVisible;
    this.update();
  }

  // Draws the primitives of visible objects only.
  update() {
    for (const { kind, size, indices, geometry } of this.parts) {
      const shown = this.objects.filter((object) => object.isVisible);
      const isWhole = shown.length === this.objects.length;
      const ranges = shown.map((object) => object[kind]).map(([a, b]) => indices.subarray(size * a, size * b));
      const total = ranges.reduce((sum, range) => sum + range.length, 0);
      const kept = isWhole ? indices : new Uint32Array(total);
      let at = 0;
      for (const range of isWhole ? [] : ranges) {
        kept.set(range, at);
        at += range.length;
      }
      geometry.setIndex(new three.BufferAttribute(kept, 1));
    }
    this.version++;
    // Sharp edges of hidden objects are not drawn.
    if (this.outline) {
      this.outline.removeFromParent();
      this.outline = null;
    }
  }

  // Returns the numbers of drawn primitives of each kind.
  drawnCounts() {
    return Object.fromEntries(this.parts.map(({ kind, size, geometry }) => [kind, geometry.index.count / size]));
  }
}

// Returns the ends of the lines in which a plane across an axis cuts triangles.
function cutTriangles(positions, triangles, axis, at) {
  const ends = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const heights = [0, 1, 2].map((k) => positions[3 * triangles[i + k] + axis] - at);
    if (heights.every((x) => x > 0) || heights.every((x) => x <= 0)) continue;
    for (let k = 0; k < 3; k++) {
      const [a, b] = [heights[k], heights[(k + 1) % 3]];
      if (a > 0 === b > 0) continue;
      const [from, to] = [3 * triangles[i + k], 3 * triangles[i + ((k + 1) % 3)]];
      for (let c = 0; c < 3; c++) ends.push(positions[from + c] + (a / (a - b)) * (positions[to + c] - positions[from + c]));
    }
  }
  return ends;
}
