// A slice through a field: values in colours, which are those of the scale, without light or blending. Distances have lines of equal distance, and the line of distance zero.
// Lengths of lists are constant within each cell of an index, and have colours by their logarithms.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { limits } from "./answers.js";
import { inWords, roundUp, short } from "./text.js";

// The number of lines of equal distance between zero and the largest distance, at most.
const LINES = 8;
// The part of the values whose largest one is the end of a scale of distances, and how many of them are examined.
const [USUAL, EXAMINED] = [0.9, 20_000];

const VERTEX = `
  varying vec2 place;
  void main() {
    place = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT = `
  precision highp sampler2D;
  uniform sampler2D values, colours;
  uniform vec2 counts;
  uniform float low, high, spacing;
  uniform bool hasCells, isDiverging;
  uniform vec3 undefinedColour;
  varying vec2 place;

  float at(vec2 cell) { return texelFetch(values, ivec2(clamp(cell, vec2(0.0), counts - 1.0)), 0).r; }

  void main() {
    vec2 grid = place * (counts - 1.0);
    float value;
    if (hasCells) {
      value = at(floor(grid + 0.5));
    } else {
      vec2 cell = min(floor(grid), counts - 2.0);
      vec2 part = grid - cell;
      value = mix(mix(at(cell), at(cell + vec2(1.0, 0.0)), part.x),
                  mix(at(cell + vec2(0.0, 1.0)), at(cell + vec2(1.0, 1.0)), part.x), part.y);
    }
    if (!(abs(value) < 3e38)) {
      gl_FragColor = vec4(undefinedColour, 1.0);
    } else {
      vec3 colour = texture2D(colours, vec2(clamp((value - low) / (high - low), 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb;
      if (!hasCells) {
        float step = value / spacing;
        float width = max(fwidth(step), 1e-6);
        float line = 1.0 - smoothstep(0.6, 1.3, abs(fract(step - 0.5) - 0.5) / width);
        float zero = isDiverging ? 1.0 - smoothstep(0.8, 1.5, abs(step) / width) : 0.0;
        // Lines are darker than light colours and lighter than dark ones.
        float light = dot(colour, vec3(0.2126, 0.7152, 0.0722));
        vec3 ink = light > 0.12 ? colour * 0.35 : colour + 0.25;
        colour = mix(colour, ink, 0.75 * line * min(1.0, 0.4 / width));
        colour = mix(colour, vec3(0.004), zero);
      }
      gl_FragColor = vec4(colour, 1.0);
    }
    #include <colorspace_fragment>
  }
`;

export class SliceLayer {
  // `field` has counts of grid points, their values with x running fastest, and the first point and the spacing in the
  // frame. `hasCells` says that the values are the lengths of lists.
  constructor(field, hasCells) {
    Object.assign(this, field);
    this.hasCells = hasCells;
    const [least, most] = limits(this.values);
    if (hasCells) {
      this.values = this.values.map(Math.log2);
      this.scale = new ColourScale("field", 0, Math.max(1, Math.log2(most)), (value) => short(2 ** value));
    } else if (least < 0) {
      // Both signs have the same scale. What is far from the surface has the colour of an end of it, because the
      // inside of a slender scene is not deep.
      const [shorter, longer] = [Math.min(-least, most), Math.max(-least, most)];
      const limit = Math.min(longer, Math.max(1.6 * shorter, 0.3 * longer));
      this.scale = new ColourScale("signedField", -limit, limit).contain(least, most);
    } else {
      // Corners of the field are far from the scene, and would leave it pale.
      this.scale = new ColourScale("field", 0, most > 0 ? quantile(this.values, USUAL) : most).contain(least, most);
    }
    this.spacingOfLines = roundUp(this.scale.high / LINES);
    this.texture = new three.DataTexture(null, 1, 1, three.RedFormat, three.FloatType);
    this.colours = new three.DataTexture(new Uint8Array(4 * 256), 256, 1);
    this.colours.colorSpace = three.SRGBColorSpace;
    this.colours.minFilter = this.colours.magFilter = three.LinearFilter;
    const { low, high, isDiverging } = this.scale;
    this.uniforms = {
      values: { value: this.texture }, colours: { value: this.colours }, counts: { value: new three.Vector2() },
      low: { value: low }, high: { value: high }, spacing: { value: this.spacingOfLines }, hasCells: { value: hasCells },
      isDiverging: { value: isDiverging },
      undefinedColour: { value: new three.Color() },
    };
    const material = new three.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: three.DoubleSide,
    });
    this.mesh = new three.Mesh(new three.BufferGeometry(), material);
    // The panel sets the plane, which makes its corners.
    this.corners = [];
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

  setTheme(theme, colours) {
    this.scale.setTheme(theme);
    const { low, high } = this.scale;
    for (let i = 0; i < 256; i++) {
      this.scale.write(low + ((high - low) * i) / 255, this.colours.image.data, 4 * i);
      this.colours.image.data[4 * i + 3] = 255;
    }
    this.colours.needsUpdate = true;
    this.uniforms.undefinedColour.value.set(colours.undefined);
  }

  // Draws the plane across an axis at a real index.
  setPlane(axis, index) {
    this.axis = axis;
    this.index = Math.max(0, Math.min(this.counts[axis] - 1, index));
    const [u, v] = [0, 1, 2].filter((k) => k !== axis);
    const [width, height] = [u, v].map((k) => this.counts[k]);
    const values = new Float32Array(width * height);
    const across = this.parts(axis, this.index);
    const columns = Array.from({ length: width }, (_, x) => this.parts(u, x));
    for (let y = 0; y < height; y++) {
      const row = this.parts(v, y);
      for (let x = 0; x < width; x++) values[x + width * y] = this.value(columns[x], row, across);
    }
    this.texture.dispose();
    this.texture.image = { data: values, width, height };
    this.texture.needsUpdate = true;
    this.uniforms.counts.value.set(width, height);
    const corner = (x, y) => this.position(axis, x * (width - 1), y * (height - 1));
    const corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    this.corners = corners.flatMap((point) => point.toArray());
    const geometry = new three.BufferGeometry().setFromPoints(corners);
    geometry.setAttribute("uv", new three.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.labels = this.hasCells ? [] : this.makeLabels(values, width, height);
  }

  // Returns the position in the frame of real indices in the plane.
  position(axis, x, y) {
    const position = [...this.origin];
    const [u, v] = [0, 1, 2].filter((k) => k !== axis);
    position[axis] += this.index * this.spacing;
    position[u] += x * this.spacing;
    position[v] += y * this.spacing;
    return new three.Vector3(...position);
  }

  // Returns the position in the frame of the middle of the plane.
  middle() {
    const [u, v] = [0, 1, 2].filter((k) => k !== this.axis);
    return this.position(this.axis, (this.counts[u] - 1) / 2, (this.counts[v] - 1) / 2);
  }

  // The coordinate of the plane along its axis in the frame.
  get at() {
    return this.origin[this.axis] + this.index * this.spacing;
  }

  // Returns the plane in the frame, whose normal points along an axis or against it.
  plane(sign) {
    return new three.Plane(new three.Vector3().setComponent(this.axis, sign), -sign * this.at);
  }

  // Returns labels of lines of equal distance: texts with positions, where the lines cross two lines through the plane.
  makeLabels(values, width, height) {
    const labels = [];
    const lowest = values.indexOf(values.reduce((a, b) => (b < a ? b : a), Infinity));
    if (lowest < 0) return labels;
    const [x0, y0] = [lowest % width, Math.floor(lowest / width)];
    const paths = [[width, (i) => [i, y0]], [height, (i) => [x0, i]]];
    for (const [length, at] of paths) {
      for (let i = 0; i + 1 < length; i++) {
        const [[ax, ay], [bx, by]] = [at(i), at(i + 1)];
        const [a, b] = [values[ax + width * ay], values[bx + width * by]].map((value) => value / this.spacingOfLines);
        const level = Math.ceil(Math.min(a, b));
        if (!(level <= Math.max(a, b)) || a === b) continue;
        const part = (level - a) / (b - a);
        const position = this.position(this.axis, ax + part * (bx - ax), ay + part * (by - ay));
        labels.push({ text: short(level * this.spacingOfLines), position });
      }
    }
    return labels;
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
    return this.hasCells ? `${this.scale.text(value)} ${unit}` : inWords(value, this.scale.isDiverging, unit);
  }
}

// Returns the value below which a part of the values is that are numbers.
function quantile(values, part) {
  const step = Math.max(1, Math.floor(values.length / EXAMINED));
  const some = Array.from({ length: Math.ceil(values.length / step) }, (_, i) => values[step * i]).filter(Number.isFinite);
  return some.sort((a, b) => a - b)[Math.floor(part * (some.length - 1))] ?? 0;
}
