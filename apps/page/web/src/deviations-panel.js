// The panel of deviations: the verdict, the histogram with the tolerance, the worst places, one point, and statistics.

import { UNDEFINED } from "./colours.js";
import { pictureLegend } from "./histogram.js";
import { spacing } from "./shading.js";
import { choice, copyButton, count, element, fillList, namedRow, remarksOn, reveal, roundingInWords, short, sideOf, stepped, tableHead } from "./text.js";

// The share of a fitted view that is seen around a place after a flight to it.
const NEAR = 0.35;
// The number of views around the scene of which the first shows most of the worst places.
const TURNS = 8;

export class DeviationsPanel {
  constructor(viewer, add) {
    this.viewer = viewer;
    this.layer = viewer.deviations;
    const { layer } = this;
    this.what = layer.is_signed ? "deviation" : "distance";
    this.tolerance = layer.tolerance;
    this.hasBands = layer.tolerance > 0;
    this.verdict = element("p", { id: "verdict", class: "verdict", role: "status" });
    this.figure = viewer.figure(() => this.readFigure(), { id: "deviation-figures" });
    this.parts = element("p", { id: "deviation-parts", "aria-live": "polite" });
    this.bands = choice("colours", ["bands", "gradient"], this.hasBands ? 0 : 1, (i) => this.setBands(i === 0));
    this.inputs = {
      tolerance: this.numberInput("tolerance", "Tolerance", layer.tolerance ?? "", (x) => this.setTolerance(x)),
      limit: this.numberInput("limit", "Colours up to", layer.limit, (x) => x > 0 && this.setLimit(x)),
    };
    const rows = [element("div", { class: "row" }, element("span", {}, "Colours"), this.bands)];
    if (layer.triangleOf) {
      const shown = choice("coloured", ["scan", "model"], 0, (i) => {
        layer.showPart(i === 1);
        this.redraw();
      });
      rows.push(element("div", { class: "row" }, element("span", {}, "Coloured"), shown));
    }
    add(layer.is_signed ? "Deviations, positive outside" : "Distances", "deviations", this.verdict, ...remarksOn(this.remarks()), this.parts);
    this.addWorst(add);
    add("Tolerance and colours", "colours", this.figure.element, ...Object.values(this.inputs), ...rows);
    this.text = element("dl", { id: "deviation", "aria-live": "polite" });
    const step = (by, text) => element("button", { type: "button", onclick: () => this.step(by) }, text);
    add("Point", "point",
      element("p", { class: "buttons" }, step(-1, "Previous"), step(1, "Next"), copyButton(this.text)), this.text);
    this.addStatistics(add);
    this.setColours();
    this.select(-1);
  }

  // Returns remarks on what the numbers mean.
  remarks() {
    const { layer, viewer: { data: { scene }, frame, unit } } = this;
    const remarks = [];
    if (scene.triangles.length + scene.segments.length === 0 && scene.points.length > 0) {
      const apart = short(spacing(scene.positions) * frame.scale);
      remarks.push(`Distances include the spacing of the part, which has only points, about ${apart} ${unit} apart.`);
    } else if (!layer.is_signed && scene.segments.length + scene.points.length === 0) {
      remarks.push("Without signs, as was asked: points inside and outside of the surface count alike.");
    }
    return remarks;
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
      box.value = Number((most * 10 ** (4 * (Number(slider.value) - 1))).toPrecision(3));
      change(Number(box.value));
    });
    return element("div", { class: "setting" },
      element("label", { for: id }, `${label} (${this.viewer.unit})`), box, slider);
  }

  setLimit(limit) {
    this.layer.limit = limit;
    this.setColours();
  }

  setTolerance(tolerance) {
    const before = this.tolerance;
    this.tolerance = tolerance !== null && tolerance >= 0 ? tolerance : null;
    // The first tolerance brings its bands.
    if (before === null && this.tolerance > 0) this.hasBands = true;
    this.setColours();
  }

  setBands(isOn) {
    this.hasBands = isOn;
    this.setColours();
  }

  setColours() {
    const hasBands = this.hasBands && this.tolerance > 0;
    const [bands, gradient] = this.bands.querySelectorAll("input");
    bands.disabled = !(this.tolerance > 0);
    bands.checked = hasBands;
    gradient.checked = !hasBands;
    this.layer.setScale(this.layer.limit, hasBands ? this.tolerance : null);
    this.redraw();
  }

  readFigure() {
    const { layer, tolerance, what, viewer: { unit } } = this;
    if (layer.total === layer.missing) return {};
    const [values, weight] = layer.population();
    const hasTwoSides = layer.is_signed && tolerance > 0;
    const marks = tolerance === null ? [] : hasTwoSides ? [-tolerance, tolerance] : [tolerance];
    const onMark = (value) => {
      const rounded = Number(value.toPrecision(3));
      document.getElementById("tolerance").value = rounded;
      document.getElementById("tolerance").dispatchEvent(new Event("input"));
    };
    const keys = [];
    if (layer.part?.visible) keys.push([this.viewer.colours.surface, "no point of the scan is near"]);
    else if (layer.missing > 0) keys.push([UNDEFINED, `no ${what}`]);
    return { scale: layer.scale, what, unit, values, keys, options: { name: `${what}s`, weight, marks, onMark } };
  }

  // Draws the legend and the histogram, and writes how many points are within the tolerance.
  redraw() {
    const { layer, tolerance, viewer: { unit } } = this;
    this.figure.update();
    this.verdict.classList.remove("good", "bad");
    if (tolerance === null) {
      const rms = layer.statistics.find(({ label }) => /root mean square/.test(label));
      this.verdict.textContent = rms?.value == null
        ? "No point has a deviation." : `The root mean square is ${this.besidesRounding(rms.value)}.`;
      this.parts.textContent = "Type a tolerance to count the points outside of it.";
    } else {
      const [above, below, within] = layer.outside(tolerance);
      const all = Math.max(1, above + below + within);
      const share = (n) => `${count(n)} (${short((100 * n) / all)} %)`;
      const under = layer.is_signed ? `${share(below)} below ${tolerance > 0 ? -tolerance : 0}; ` : "";
      const out = layer.is_signed ? `${count(above + below)} of ${count(all)} points: ` : "";
      const isRounded = layer.quantiles && tolerance !== layer.tolerance;
      const rounded = isRounded ? " Counts are to 0.01 %, because not all points are on the page." : "";
      this.parts.textContent = `${out}${share(above)} above ${tolerance}; ${under}${share(within)} within.${rounded}`;
      const range = `${layer.is_signed ? "±" : ""}${short(tolerance)} ${unit}`;
      const isGood = above + below === 0;
      this.verdict.classList.add(isGood ? "good" : "bad");
      this.verdict.textContent = isGood ? `All ${count(within)} points are within ${range}.`
        : `${short((100 * (above + below)) / all)} % of the points are out of tolerance (${range}).`;
    }
    this.showLegend();
    this.viewer.draw();
  }

  // Shows the legend of the colours in the picture.
  showLegend() {
    const { layer, viewer } = this;
    if (layer.total > layer.missing) viewer.overlay?.setLegend(pictureLegend(layer.scale, this.what, viewer.unit, layer.values));
  }

  // Returns a length with its unit for a sentence. An error of rounding is called so.
  besidesRounding(length) {
    const { unit } = this.viewer;
    return this.viewer.isRounding(length) ? `0 ${unit} ${roundingInWords(length)}` : `${short(length)} ${unit}`;
  }

  // Adds the worst places with their numbers in the picture and their coordinates, and buttons that fly there.
  addWorst(add) {
    const { layer, viewer } = this;
    this.worst = layer.worst(viewer.data.frame.radius);
    const rows = this.worst.map((i, k) => {
      const value = this.signedText(i);
      const fly = element("button", { type: "button", title: `Fly to point ${count(i * layer.stride)}`, "data-point": i,
        onclick: () => {
          this.select(i);
          this.flyTo(i);
        } }, element("span", { class: "mark" }, String(k + 1)), value);
      const cells = [...layer.positions.subarray(3 * i, 3 * i + 3)].map((x) => element("td", {}, viewer.coordinate(x)));
      return element("tr", {}, element("th", { scope: "row" }, fly), ...cells);
    });
    const which = layer.stride > 1 ? " of the points on the page" : "";
    const table = element("table", { id: "largest" }, tableHead([this.what, "x", "y", "z"]), element("tbody", {}, ...rows));
    add(`Worst places${which} (${viewer.unit})`, "worst", table,
      element("p", { class: "small" }, "Click a number to fly there. White numbers in the picture are on the far side."));
  }

  // Returns the numbers of the worst places, which stand in the picture.
  labels() {
    const { layer, viewer: { camera } } = this;
    if (!layer.group.visible) return [];
    return this.worst.filter((i) => layer.position(i).toArray().every(Number.isFinite)).map((i) => {
      const position = layer.position(i);
      const normal = this.normal(i);
      const isBehind = normal && normal.dot(position.clone().sub(camera.position)) > 0;
      const k = this.worst.indexOf(i);
      const text = k === 0 ? `1: ${this.signedText(i)} ${this.viewer.unit}` : String(k + 1);
      return { position, text, kind: isBehind ? "mark behind" : "mark" };
    });
  }

  // Returns the value of a point with its sign.
  signedText(i) {
    const { is_signed, values } = this.layer;
    return `${is_signed && values[i] > 0 ? "+" : ""}${short(values[i])}`;
  }

  // Returns the normal of the surface at a point, if there is one.
  normal(i) {
    const { dots, surface } = this.layer;
    const normals = dots.geometry.getAttribute("normal") ?? surface?.geometry.getAttribute("normal");
    const normal = normals && this.layer.position(i).fromBufferAttribute(normals, i);
    return normal?.length() > 0 ? normal : null;
  }

  // Turns fitted views so that most of the worst places are seen, the worst one if possible.
  face() {
    const { view } = this.viewer;
    const normals = this.worst.map((i) => this.normal(i));
    const seen = (angle) => {
      view.turned = angle;
      const [x, y, z] = view.usualDirection();
      return normals.reduce((n, normal, i) =>
        n + (normal && x * normal.x + y * normal.y + z * normal.z > 0 ? (i === 0 ? 1.5 : 1) : 0), 0);
    };
    const angles = Array.from({ length: TURNS }, (_, i) => (2 * Math.PI * i) / TURNS);
    const counts = angles.map(seen);
    view.turned = angles[counts.indexOf(Math.max(...counts))];
  }

  // Flies to a point, and around the scene if the scene is in front of it.
  flyTo(i) {
    const { layer, viewer } = this;
    const point = layer.position(i);
    if (!point.toArray().every(Number.isFinite)) return;
    const normal = this.normal(i);
    const towards = viewer.camera.position.clone().sub(viewer.controls.target).normalize();
    if (normal) {
      // Surfaces are seen from outside, a little from where the viewer is.
      towards.multiplyScalar(0.4).add(normal);
    } else if (!layer.triangleOf) {
      towards.multiplyScalar(0.4).add(point.clone().normalize());
    }
    viewer.view.flyTo(point, NEAR, towards);
  }

  addStatistics(add) {
    const { layer, viewer: { unit } } = this;
    const rows = layer.statistics.map(({ label, value }) => namedRow(label, value ?? "none"));
    const counts = [["with", layer.total - layer.missing], ["without", layer.missing]]
      .map(([word, n]) => namedRow(`points ${word} a ${this.what}`, count(n)));
    add("Statistics", "statistics", element("table", { id: "statistics-table" },
      element("caption", {}, `${layer.is_signed ? "Deviations" : "Distances"} in ${unit}`),
      element("tbody", {}, ...counts, ...rows)));
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

  // Returns the deviation of the point under the pointer as a text, if there is one.
  tip(event) {
    const i = this.pick(event);
    if (i < 0) return undefined;
    return this.inWords(i);
  }

  // Returns the deviation of a point as a text.
  inWords(i) {
    const value = this.layer.values[i];
    return Number.isNaN(value) ? `no ${this.what}` : this.viewer.inWords(value, this.layer.is_signed);
  }

  step(by) {
    const { length, selected } = this.layer;
    if (length > 0) this.select(stepped(selected, by, length));
  }

  select(i) {
    const { layer, viewer } = this;
    layer.select(i, viewer.colours ?? { feature: "#c000c0" });
    const rows = i < 0 ? [["none", "Click a point of the scan, or press n."]] : [
      ["number", `${count(i * layer.stride)} of ${count(layer.total)}`],
      ["point", viewer.place(layer.positions.subarray(3 * i, 3 * i + 3))],
      [this.what, layer.values[i]],
      ...(layer.is_signed && !Number.isNaN(layer.values[i]) ? [["side", sideOf(layer.values[i])]] : []),
      ...(Number.isNaN(layer.values[i]) ? [] : [["primitive", String(layer.primitives[i])]]),
    ];
    fillList(this.text, rows);
    if (i >= 0) reveal(this.text);
    viewer.draw();
  }
}
