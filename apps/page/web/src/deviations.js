// A scan, whose points or triangles have the colours of their deviations, or the part with those of the points near it.

import * as three from "three";
import { empty, limits, marker } from "./answers.js";
import { BandScale, ColourScale } from "./colours.js";
import { neighbours, pointMaterial, spacing, surface } from "./shading.js";

// The distance in pixels within which a point is read.
const PICK_RADIUS = 6;
// The number of worst places that are listed, and their least distance from each other in radii of the scene.
const [LISTED, APART] = [6, 0.12];
// The number of points by which a surface is found smooth, and the cosine of the angle between normals of near points
// and the part of them that make it smooth. Only points of smooth surfaces are as large as their spacing.
const [COMPARED, ALIKE, MOST] = [60, 0.5, 0.75];
// The size of a point relative to the distance to the next one, which makes a closed surface of them.
const SPLAT = 1.9;

export class DeviationsLayer {
  constructor(data, frame, scene) {
    Object.assign(this, data);
    this.scene = scene;
    this.length = data.values.length;
    this.range = limits(data.values);
    this.drawn = frame.positions(data.positions);
    this.colours = new Uint16Array(3 * this.length);
    this.triangleOf = triangleNumbers(scene);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(this.drawn, 3));
    geometry.setAttribute("color", new three.BufferAttribute(this.colours, 3, true));
    const normals = data.triangles.length === 0 && this.triangleOf ? this.pointNormals() : null;
    if (normals) geometry.setAttribute("normal", new three.BufferAttribute(normals, 3, true));
    const isSmooth = normals !== null && isAlike(this.drawn, normals);
    const size = SPLAT * spacing(this.drawn);
    this.dots = new three.Points(geometry, pointMaterial({ size, vertexColors: true, sizeAttenuation: true }, isSmooth));
    // Points that are not finite are not drawn.
    const sphere = new three.Sphere(new three.Vector3(), 4);
    geometry.boundingSphere = sphere;
    this.group = new three.Group();
    this.selection = new three.Group();
    this.group.add(this.selection);
    this.selected = -1;
    if (data.triangles.length > 0) {
      const triangles = new three.BufferGeometry();
      for (const name of ["position", "color"]) triangles.setAttribute(name, geometry.getAttribute(name));
      triangles.boundingSphere = sphere;
      triangles.setIndex(new three.BufferAttribute(data.triangles, 1));
      this.surface = surface(triangles, { vertexColors: true });
      this.group.add(this.surface);
      this.dots.visible = false;
    }
    this.group.add(this.dots);
    this.setScale(data.limit, null);
  }

  // Sets the absolute deviation from which on colours do not change, and the tolerance of bands if there are some.
  setScale(limit, bandTolerance) {
    this.limit = limit;
    this.scale = bandTolerance === null
      ? new ColourScale(this.is_signed ? "signedField" : "field", this.is_signed ? -limit : 0, limit)
      : new BandScale(bandTolerance, limit, this.is_signed, Math.max(...this.range.map(Math.abs)));
    if (bandTolerance === null) this.scale.contain(...this.range);
    if (this.theme) this.colourPoints();
  }

  setTheme(theme, colours) {
    this.theme = theme;
    this.themeColours = colours;
    this.colourPoints();
    this.select(this.selected, colours);
  }

  colourPoints() {
    this.scale.setTheme(this.theme);
    this.scale.writeAll(this.values, this.colours);
    this.dots.geometry.getAttribute("color").needsUpdate = true;
    if (this.part?.visible) this.colourPart();
  }

  // Returns the normal of the closest triangle of each point, or zero where there is none.
  pointNormals() {
    const { positions, triangles } = this.scene;
    const normals = new Int8Array(3 * this.length);
    const [a, b, c] = [new three.Vector3(), new three.Vector3(), new three.Vector3()];
    for (let i = 0; i < this.length; i++) {
      const triangle = this.triangleOf(this.primitives[i]);
      if (triangle < 0) continue;
      [a, b, c].forEach((corner, k) => corner.fromArray(positions, 3 * triangles[3 * triangle + k]));
      const normal = b.sub(a).cross(c.sub(a)).normalize();
      for (let k = 0; k < 3; k++) normals[3 * i + k] = Math.round(127 * normal.getComponent(k)) || 0;
    }
    return normals;
  }

  // Shows the part with the colours of the points that are closest to it, instead of the scan, or the scan.
  showPart(isOn) {
    if (isOn && !this.part) {
      const geometry = new three.BufferGeometry();
      const { positions, triangles } = this.scene;
      geometry.setAttribute("position", new three.BufferAttribute(positions, 3));
      geometry.setAttribute("color", new three.BufferAttribute(new Uint16Array(positions.length), 3, true));
      geometry.setIndex(new three.BufferAttribute(triangles, 1));
      geometry.boundingSphere = new three.Sphere(new three.Vector3(), 4);
      this.part = surface(geometry, { vertexColors: true });
      this.group.add(this.part);
    }
    if (this.part) this.part.visible = isOn;
    (this.surface ?? this.dots).visible = !isOn;
    if (isOn) this.colourPart();
  }

  // Gives each vertex of the part the mean of the points whose closest triangle touches it.
  colourPart() {
    const { triangles } = this.scene;
    const attribute = this.part.geometry.getAttribute("color");
    const [sums, counts] = [new Float64Array(attribute.count), new Uint32Array(attribute.count)];
    for (let i = 0; i < this.length; i++) {
      const triangle = this.triangleOf(this.primitives[i]);
      if (triangle < 0 || Number.isNaN(this.values[i])) continue;
      for (let k = 0; k < 3; k++) {
        const vertex = triangles[3 * triangle + k];
        sums[vertex] += this.values[i];
        counts[vertex]++;
      }
    }
    this.scale.writeAll(sums.map((sum, i) => sum / counts[i]), attribute.array);
    // Where no point is near, the part has its usual colour.
    const colour = new three.Color(this.themeColours.surface).toArray().map((x) => Math.round(65535 * x));
    for (let i = 0; i < counts.length; i++) if (counts[i] === 0) attribute.array.set(colour, 3 * i);
    attribute.needsUpdate = true;
  }

  // Returns the values that stand for those of all points, and how many points each stands for.
  population() {
    const values = this.quantiles ?? this.values;
    return [values, this.quantiles ? (this.total - this.missing) / values.length : 1];
  }

  // Returns the numbers of points with a deviation above a tolerance, below its negative, and within it.
  outside(tolerance) {
    // The program has counted all points for its tolerance.
    if (tolerance === this.tolerance) {
      const [above, below] = this.outside_tolerance;
      return [above, below, this.total - this.missing - above - below];
    }
    const [values, weight] = this.population();
    let [above, below, all] = [0, 0, 0];
    for (const value of values) {
      if (Number.isNaN(value)) continue;
      all++;
      if (value > tolerance) above++;
      if (value < -tolerance) below++;
    }
    return [above, below, all - above - below].map((n) => Math.round(n * weight));
  }

  // Returns the point that is in front of all others within some pixels around a position on the screen, or -1.
  pick(camera, size, x, y) {
    camera.updateMatrixWorld();
    const matrix = new three.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const { drawn } = this;
    let [found, nearest] = [-1, Infinity];
    for (let i = 0; i < this.length; i++) {
      const [px, py, pz] = [drawn[3 * i], drawn[3 * i + 1], drawn[3 * i + 2]];
      const w = matrix[3] * px + matrix[7] * py + matrix[11] * pz + matrix[15];
      if (!(w > 0) || w >= nearest) continue;
      const dx = ((matrix[0] * px + matrix[4] * py + matrix[8] * pz + matrix[12]) / w + 1) * 0.5 * size.x - x;
      const dy = (1 - (matrix[1] * px + matrix[5] * py + matrix[9] * pz + matrix[13]) / w) * 0.5 * size.y - y;
      if (dx * dx + dy * dy <= PICK_RADIUS * PICK_RADIUS) [found, nearest] = [i, w];
    }
    return found;
  }

  position(i) {
    return new three.Vector3().fromArray(this.drawn, 3 * i);
  }

  // Marks a point, by its number among those that are drawn.
  select(i, colours) {
    this.selected = i;
    empty(this.selection);
    // A point that is not finite is nowhere.
    if (i < 0 || !this.position(i).toArray().every(Number.isFinite)) return;
    this.selection.add(marker(this.position(i), colours.feature, 12));
  }

  // Returns the numbers of the points with the largest deviations, by absolute value, of which no two are near each
  // other.
  worst(radius) {
    const found = [];
    while (found.length < LISTED) {
      let [best, size] = [-1, -1];
      for (let i = 0; i < this.length; i++) {
        const value = Math.abs(this.values[i]);
        if (!(value > size) || found.some((j) => this.apart(i, j) < APART * radius)) continue;
        [best, size] = [i, value];
      }
      if (best < 0) break;
      found.push(best);
    }
    return found;
  }

  apart(i, j) {
    const { drawn } = this;
    return Math.hypot(...[0, 1, 2].map((k) => drawn[3 * i + k] - drawn[3 * j + k]));
  }
}

// Returns a function from the number of a primitive to that of its triangle among those of the page, or -1. There is no
// such function if some primitives are not on the page.
function triangleNumbers({ triangles, objects }) {
  const places = [];
  let next = 0;
  for (const { count, triangles: [first, end] } of objects) {
    // Ids of objects of several kinds are mixed.
    places.push({ first: next, end: next + count, shift: end - first === count ? first - next : null });
    next += count;
  }
  if (triangles.length === 0 || places.every(({ shift }) => shift === null)) return null;
  return (primitive) => {
    let [low, high] = [0, places.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (primitive < places[middle].end) high = middle;
      else low = middle + 1;
    }
    const { end, shift } = places[low];
    return primitive < end && shift !== null ? primitive + shift : -1;
  };
}

// Returns whether most points have about the normal of the next one.
function isAlike(positions, normals) {
  const compared = neighbours(positions, COMPARED).filter(([, next]) => next >= 0);
  const alike = compared.filter((pair) => {
    const [a, b] = pair.map((i) => [...normals.subarray(3 * i, 3 * i + 3)]);
    return a.reduce((sum, x, k) => sum + x * b[k], 0) > ALIKE * 127 * 127;
  });
  return alike.length > MOST * compared.length;
}
