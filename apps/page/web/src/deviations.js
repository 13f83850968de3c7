// A scan, whose points have the colours of their deviations, with the panel beside it.

import * as three from "three";
import { empty, marker, points } from "./answers.js";
import { ColourScale } from "./colours.js";
import { count, element, fillList, namedRow, reveal, short, stepped, tableHead } from "./text.js";

// The distance in pixels within which a point is read.
const PICK_RADIUS = 6;
// The number of points above which they are drawn smaller.
const MANY_POINTS = 200_000;
// The number of the largest deviations that are listed.
const LISTED = 10;

export class DeviationsLayer {
  constructor(data, frame) {
    Object.assign(this, data);
    this.length = data.values.length;
    this.drawn = frame.positions(data.positions);
    this.colours = new Uint16Array(3 * this.length);
    this.dots = points(this.drawn, this.colours, this.length > MANY_POINTS ? 2 : 4);
    // Points that are not finite are not drawn.
    const sphere = new three.Sphere(new three.Vector3(), 4);
    this.dots.geometry.boundingSphere = sphere;
    this.group = new three.Group();
    this.selection = new three.Group();
    this.group.add(this.selection);
    this.selected = -1;
    if (data.triangles.length > 0) {
      const geometry = new three.BufferGeometry();
      for (const name of ["position", "color"]) geometry.setAttribute(name, this.dots.geometry.getAttribute(name));
      geometry.boundingSphere = sphere;
      geometry.setIndex(new three.BufferAttribute(data.triangles, 1));
      const material = new three.MeshLambertMaterial({
        vertexColors: true, side: three.DoubleSide, flatShading: true,
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      });
      this.surface = new three.Mesh(geometry, material);
      this.group.add(this.surface);
      this.dots.visible = false;
    }
    this.group.add(this.dots);
    this.setLimit(data.limit);
  }

  // Sets the absolute deviation from which on colours do not change.
  setLimit(limit) {
    this.limit = limit;
    this.scale = new ColourScale(this.is_signed ? "diverging" : "sequential", this.is_signed ? -limit : 0, limit);
    if (this.theme) this.colourPoints();
  }

  setTheme(theme, colours) {
    this.theme = theme;
    this.colourPoints();
    this.select(this.selected, colours);
  }

  colourPoints() {
    this.scale.setTheme(this.theme);
    this.scale.writeAll(this.values, this.colours);
    this.dots.geometry.getAttribute("color").needsUpdate = true;
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

  // Marks a point, by its number among those that are drawn.
  select(i, colours) {
    this.selected = i;
    empty(this.selection);
    // A point that is not finite is nowhere.
    if (i < 0 || !this.drawn.subarray(3 * i, 3 * i + 3).every(Number.isFinite)) return;
    this.selection.add(marker(new three.Vector3(...this.drawn.subarray(3 * i, 3 * i + 3)), colours.feature, 12));
  }

  // Returns the numbers of the points with the largest deviations, by absolute value.
  largest() {
    const kept = [];
    for (let i = 0; i < this.length; i++) {
      const size = Math.abs(this.values[i]);
      if (Number.isNaN(size) || (kept.length === LISTED && size <= Math.abs(this.values[kept[LISTED - 1]]))) continue;
      const before = kept.findIndex((k) => Math.abs(this.values[k]) < size);
      kept.splice(before < 0 ? kept.length : before, 0, i);
      kept.length = Math.min(kept.length, LISTED);
    }
    return kept;
  }
}

// The sections of the panel that are about deviations.
export class DeviationsPanel {
  constructor(viewer, add) {
    this.viewer = viewer;
    this.layer = viewer.deviations;
    const { layer } = this;
    this.what = layer.is_signed ? "deviation" : "distance";
    this.tolerance = layer.tolerance;
    this.figure = viewer.figure(() => this.readFigure(), { id: "deviation-figures" });
    this.parts = element("p", { id: "deviation-parts", "aria-live": "polite" });
    this.inputs = {
      limit: this.numberInput("limit", "Limit of colours", layer.limit, (x) => x > 0 && this.setLimit(x)),
      tolerance: this.numberInput("tolerance", "Tolerance", layer.tolerance ?? "", (x) => this.setTolerance(x)),
    };
    add(layer.is_signed ? "Deviations, positive outside" : "Distances", "deviations", this.figure.element,
      ...Object.values(this.inputs), this.parts);
    this.pointText = element("dl", { id: "deviation", "aria-live": "polite" });
    this.pointerText = element("output", { id: "deviation-pointer", "aria-live": "off" });
    const step = (by, text) => element("button", { type: "button", onclick: () => this.step(by) }, text);
    const steps = element("p", {}, step(-1, "Previous"), " ", step(1, "Next"), " ", this.pointerText);
    add("Point", "point", steps, this.pointText);
    this.makeTables(add);
    this.redraw();
    this.select(-1);
  }

  // Makes a number and a slider with one meaning. The slider covers four orders of magnitude.
  numberInput(id, label, value, change) {
    const most = this.layer.statistics.reduce((a, { value }) => Math.max(a, Math.abs(value ?? 0)), 0) || 1;
    const part = (x) => Math.max(0, Math.min(1, 1 + Math.log10(x / most) / 4));
    const box = element("input", { type: "number", id, min: 0, step: "any", value, class: "number" });
    const slider = element("input", {
      type: "range", id: `${id}-slider`, min: 0, max: 1, step: 0.001, value: value === "" ? 1 : part(value),
      "aria-label": `${label}, slider`,
    });
    box.addEventListener("input", () => {
      // A number below zero is no limit and no tolerance, as the browser says.
      if (!box.checkValidity()) return;
      if (Number(box.value) > 0) slider.value = part(Number(box.value));
      change(box.value === "" ? null : Number(box.value));
    });
    slider.addEventListener("input", () => {
      box.value = short(most * 10 ** (4 * (Number(slider.value) - 1)));
      change(Number(box.value));
    });
    return element("div", { class: "setting" }, element("label", {}, `${label} (${this.viewer.unit}) `, box), slider);
  }

  setLimit(limit) {
    this.layer.setLimit(limit);
    this.redraw();
  }

  setTolerance(tolerance) {
    this.tolerance = tolerance !== null && tolerance >= 0 ? tolerance : null;
    this.redraw();
  }

  readFigure() {
    const { layer, tolerance, what, viewer: { unit } } = this;
    if (layer.total === layer.missing) return {};
    const [values, weight] = layer.population();
    const hasTwoSides = layer.is_signed && tolerance > 0;
    const marks = tolerance === null ? [] : hasTwoSides ? [-tolerance, tolerance] : [tolerance];
    return { scale: layer.scale, what, unit, values, options: { name: `${what}s`, weight, marks } };
  }

  // Draws the legend and the histogram, and writes how many points are within the tolerance.
  redraw() {
    const { layer, tolerance } = this;
    this.figure.update();
    if (tolerance === null) {
      this.parts.textContent = "With a tolerance, this counts the points outside of it.";
    } else {
      const [above, below, within] = layer.outside(tolerance);
      const share = (n) => `${count(n)} (${short((100 * n) / Math.max(1, above + below + within))} %)`;
      const under = layer.is_signed ? `${share(below)} below ${tolerance > 0 ? -tolerance : 0}, ` : "";
      const isRounded = layer.quantiles && tolerance !== layer.tolerance;
      const rounded = isRounded ? " Counts are to 0.01 %, because not all points are on the page." : "";
      this.parts.textContent =
        `${share(above)} above ${tolerance}, ${under}${share(within)} within the tolerance.${rounded}`;
    }
    this.viewer.draw();
  }

  makeTables(add) {
    const { layer, viewer: { unit } } = this;
    const rows = layer.statistics.map(({ label, value }) => namedRow(label, value ?? "none"));
    const counts = [["with", layer.total - layer.missing], ["without", layer.missing]]
      .map(([word, n]) => namedRow(`points ${word} a ${this.what}`, count(n)));
    add("Statistics", "statistics", element("table", { id: "statistics-table" },
      element("caption", {}, `${layer.is_signed ? "Deviations" : "Distances"} in ${unit}`),
      element("tbody", {}, ...counts, ...rows)));
    const largest = layer.largest().map((i) => {
      const select = element("button", { type: "button", onclick: () => this.select(i) }, String(i * layer.stride));
      return element("tr", {}, element("td", {}, select), element("td", {}, String(layer.values[i])));
    });
    const where = layer.stride > 1 ? " of the points on the page" : "";
    add(`Largest deviations${where}`, "largest-deviations",
      element("table", { id: "largest" }, tableHead(["point", this.what]), element("tbody", {}, ...largest)));
  }

  // Adds the check boxes of what is shown. `box` makes one.
  makeBoxes(box) {
    const { layer } = this;
    box("scan", true, (on) => (layer.group.visible = on), "show-scan");
    if (layer.surface) box("points of the scan", false, (on) => (layer.dots.visible = on), "show-scan-points");
  }

  pick(event) {
    if (!this.layer.group.visible) return -1;
    const { size, x, y } = this.viewer.pointer(event);
    return this.layer.pick(this.viewer.camera, size, x, y);
  }

  // Shows the deviation of the point under the pointer, once a frame.
  hover(event) {
    if (this.isHovering || event.buttons !== 0) return;
    this.isHovering = true;
    requestAnimationFrame(() => {
      this.isHovering = false;
      const i = this.pick(event);
      this.pointerText.textContent = i < 0 ? "" : `${short(this.layer.values[i])} ${this.viewer.unit} at the pointer`;
    });
  }

  step(by) {
    const { length, selected } = this.layer;
    if (length > 0) this.select(stepped(selected, by, length));
  }

  select(i) {
    const { layer, viewer } = this;
    layer.select(i, viewer.colours);
    const rows = i < 0 ? [["none", "Click a point of the scan, or press n."]] : [
      ["number", `${count(i * layer.stride)} of ${count(layer.total)}`],
      ["point", [...layer.positions.subarray(3 * i, 3 * i + 3)].join(", ")],
      [this.what, Number.isNaN(layer.values[i]) ? "none" : layer.values[i]],
      ...(Number.isNaN(layer.values[i]) ? [] : [["primitive", layer.primitives[i]]]),
    ];
    fillList(this.pointText, rows);
    if (i >= 0) reveal(this.pointText);
    viewer.draw();
  }
}
