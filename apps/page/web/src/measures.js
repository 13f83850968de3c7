// Measured lines: pairs of points with the distances between them, such as the closest points of two scenes, or rays
// with their hits.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { line, limits, marker } from "./answers.js";
import { count, element, fillList, number, short, stepped } from "./text.js";

// The number of lines up to which each is drawn with its length.
const MAX_LABELLED = 8;

export class MeasuresLayer {
  // `data` has a title, a sentence, names of lines or none, their lengths, and their ends, six coordinates each.
  constructor(data, frame) {
    const { title, verdict, names, lengths, ends: coordinates } = data;
    Object.assign(this, { title, verdict, names, lengths, coordinates });
    this.positions = frame.positions(coordinates);
    this.length = coordinates.length / 6;
    this.isLabelled = this.length <= MAX_LABELLED;
    this.group = new three.Group();
    this.selection = new three.Group();
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(this.positions, 3));
    geometry.setAttribute("color", new three.BufferAttribute(new Uint16Array(this.positions.length), 3, true));
    const [, longest] = limits(this.lengths);
    this.scale = new ColourScale("sequential", 0, longest);
    this.lines = new three.LineSegments(geometry, new three.LineBasicMaterial({
      vertexColors: true, transparent: true, opacity: 0.5, depthWrite: false,
    }));
    this.lines.visible = !this.isLabelled;
    this.group.add(this.lines, this.selection);
  }

  ends(i) {
    return [0, 3].map((k) => new three.Vector3().fromArray(this.positions, 6 * i + k));
  }

  setTheme(theme, colours) {
    this.colours = colours;
    this.scale.setTheme(theme);
    const attribute = this.lines.geometry.getAttribute("color");
    this.scale.writeAll(this.lengths, attribute.array, 2);
    attribute.needsUpdate = true;
    this.draw();
  }

  // Draws the labelled lines, or the selected one.
  draw() {
    this.selection.clear();
    for (const i of this.drawn()) {
      const [a, b] = this.ends(i);
      const { selected } = this.colours;
      this.selection.add(line([a, b], selected), marker(a, selected, 9), marker(b, selected, 9));
    }
  }

  drawn() {
    if (this.isLabelled) return Array.from({ length: this.length }, (_, i) => i);
    return this.selected >= 0 ? [this.selected] : [];
  }

  labels() {
    if (!this.group.visible) return [];
    return this.drawn().map((i) => {
      const [a, b] = this.ends(i);
      return { position: a.lerp(b, 0.5), text: `${short(this.lengths[i])} ${this.unit}`, isImportant: true };
    });
  }

  makePanel(viewer, add) {
    this.unit = viewer.unit;
    this.selected = -1;
    this.text = element("dl", { id: "measure", "aria-live": "polite" });
    const step = (by, text) => element("button", { type: "button", onclick: () => {
      this.selected = stepped(this.selected, by, this.length);
      this.select(viewer);
    } }, text);
    const parts = [element("p", { class: "verdict" }, this.verdict)];
    if (this.isLabelled) {
      parts.push(this.text);
    } else {
      const what = "length";
      parts.push(viewer.figure(() => ({ scale: this.scale, what, unit: viewer.unit, values: this.lengths })).element,
        element("p", { class: "buttons" }, step(-1, "Previous"), step(1, "Next")), this.text);
    }
    add(this.title, "measures", ...parts);
    this.select(viewer);
  }

  select(viewer) {
    const rows = this.drawn().flatMap((i) => [
      [this.names[i] ?? `number ${count(i)}`, element("span", {}, number(this.lengths[i]), ` ${viewer.unit}`)],
      ["from", this.coordinates.subarray(6 * i, 6 * i + 3)], ["to", this.coordinates.subarray(6 * i + 3, 6 * i + 6)],
    ]);
    fillList(this.text, rows);
    if (this.colours) {
      this.draw();
      viewer.draw();
    }
  }
}
