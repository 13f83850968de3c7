// A slice through a field: values in colours. Distances have lines of equal distance, and the line of distance zero.
// Lengths of lists are constant within each cell of an index, and have colours by their logarithms.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { distanceScale, limits } from "./answers.js";
import { short } from "./text.js";

// The number of pixels along the longer side of a slice.
const PIXELS = 512;
// The number of lines of equal distance between zero and the largest distance.
const LINES = 8;

export class SliceLayer {
  // `field` has counts of grid points, their values with x running fastest, and the first point and the spacing in the
  // frame. `hasCells` says that the values are the lengths of lists.
  constructor(field, hasCells) {
    Object.assign(this, field);
    this.hasCells = hasCells;
    if (hasCells) {
      const longest = limits(this.values)[1];
      this.values = this.values.map(Math.log2);
      this.scale = new ColourScale("sequential", 0, Math.max(1, Math.log2(longest)), (value) => short(2 ** value));
    } else {
      this.scale = distanceScale(this.values);
    }
    this.canvas = document.createElement("canvas");
    this.texture = new three.CanvasTexture(this.canvas);
    this.texture.colorSpace = three.SRGBColorSpace;
    this.texture.generateMipmaps = false;
    this.texture.minFilter = three.LinearFilter;
    const material = new three.MeshBasicMaterial({ map: this.texture, side: three.DoubleSide });
    this.mesh = new three.Mesh(new three.BufferGeometry(), material);
    // The panel sets the plane.
    this.axis = 2;
  }

  // Returns the parts of the value at a real index along an axis: pairs of a step into the values and a weight. A field
  // of cells has that of the nearest grid point, and another one those of the points on both sides.
  parts(axis, at) {
    const stride = [1, this.counts[0], this.counts[0] * this.counts[1]][axis];
    if (this.hasCells) return [[stride * Math.round(at), 1]];
    const low = Math.max(0, Math.min(Math.floor(at), this.counts[axis] - 2));
    return [[low, low + 1 - at], [low + 1, at - low]].filter(([, weight]) => weight > 0)
      .map(([index, weight]) => [stride * index, weight]);
  }

  // Returns the value that is the product of the parts along the three axes. It is no number where one of the values
  // around is none.
  value(u, v, w) {
    let sum = 0;
    for (const [i, a] of u) for (const [j, b] of v) for (const [l, c] of w) sum += a * b * c * this.values[i + j + l];
    return sum;
  }

  setTheme(theme) {
    this.scale.setTheme(theme);
    this.draw();
  }

  // Draws the plane across an axis at a real index.
  setPlane(axis, index) {
    this.axis = axis;
    this.index = Math.max(0, Math.min(this.counts[axis] - 1, index));
    const [u, v] = [0, 1, 2].filter((k) => k !== axis);
    const sides = [u, v].map((k) => this.counts[k] - 1);
    const [width, height] = sides.map((side) => Math.max(2, Math.round((PIXELS * side) / Math.max(...sides))));
    const values = new Float32Array(width * height);
    const across = this.parts(axis, this.index);
    const columns = Array.from({ length: width }, (_, x) => this.parts(u, (sides[0] * x) / (width - 1)));
    for (let y = 0; y < height; y++) {
      const row = this.parts(v, (sides[1] * y) / (height - 1));
      for (let x = 0; x < width; x++) values[x + width * y] = this.value(columns[x], row, across);
    }
    this.drawn = { values, width, height };
    this.draw();
    const corner = (x, y) => {
      const position = [...this.origin];
      position[axis] += this.index * this.spacing;
      position[u] += sides[0] * x * this.spacing;
      position[v] += sides[1] * y * this.spacing;
      return new three.Vector3(...position);
    };
    const geometry = new three.BufferGeometry().setFromPoints([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
    // The first row of the canvas is at v = 0, and a texture begins at its last row.
    geometry.setAttribute("uv", new three.Float32BufferAttribute([0, 1, 1, 1, 1, 0, 0, 0], 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }

  // Draws the values of the plane in their colours.
  draw() {
    const { values, width, height } = this.drawn;
    Object.assign(this.canvas, { width, height });
    const context = this.canvas.getContext("2d");
    const image = context.createImageData(width, height);
    const step = Math.max(-this.scale.low, this.scale.high) / LINES;
    const colour = [0, 0, 0];
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const i = x + width * y;
        const value = values[i];
        this.scale.write(value, colour, 0);
        // Lines are not drawn between cells.
        if (!this.hasCells) {
          for (const other of [x + 1 < width ? values[i + 1] : value, y + 1 < height ? values[i + width] : value]) {
            if (Number.isNaN(other - value)) continue;
            if (value < 0 !== other < 0) colour.fill(0);
            else if (Math.floor(value / step) !== Math.floor(other / step)) darken(colour);
          }
        }
        for (let k = 0; k < 3; k++) image.data[4 * i + k] = colour[k];
        image.data[4 * i + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
    if (this.texture.image !== this.canvas || this.size !== `${width}x${height}`) this.texture.dispose();
    this.size = `${width}x${height}`;
    this.texture.needsUpdate = true;
  }

  // Returns the value at a position in the frame, which is in the plane.
  valueAt(position) {
    const at = [0, 1, 2].map((k) => (position.getComponent(k) - this.origin[k]) / this.spacing);
    return this.value(...at.map((x, k) => this.parts(k, Math.max(0, Math.min(this.counts[k] - 1, x)))));
  }

  // Returns the value at a position in the frame in words.
  textAt(position, unit) {
    const value = this.valueAt(position);
    if (this.hasCells && Number.isNaN(value)) return "no list: the tree answers";
    return `${this.scale.text(value)} ${unit}`;
  }
}

function darken(colour) {
  for (let k = 0; k < 3; k++) colour[k] *= 0.8;
}
