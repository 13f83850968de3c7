// Measured lines: pairs of points with the distances between them, such as the closest points of two scenes, or rays
// with their hits.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { line, limits, marker } from "./answers.js";
import { copyButton, count, element, fillList, number, patch, remarksOn, short, shortened, stepped } from "./text.js";

// The number of characters of the name of an object above which its middle is left out.
const LONGEST_NAME = 18;
// The share of a fitted view that is seen after a flight to a line: at least so much, and so many times its length.
const [CLOSEST_FLIGHT, ROOM] = [0.04, 1.2];
// The number of lines up to which each is drawn with its length.
const MAX_LABELLED = 8;

export class MeasuresLayer {
  // `data` has a title, a sentence with remarks, names of lines or none, their lengths, and their ends, six coordinates each.
  constructor(data, frame) {
    const { title, verdict, remarks, names, lengths, ends: coordinates } = data;
    Object.assign(this, { title, verdict, remarks, names, lengths, coordinates });
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

  // Returns the ends of the only line, or of the first one of a few, with which the scale bar is compared.
  get main() {
    return this.isLabelled && this.length > 0 ? this.ends(0) : null;
  }

  drawn() {
    if (this.isLabelled) return Array.from({ length: this.length }, (_, i) => i);
    return this.selected >= 0 ? [this.selected] : [];
  }

  labels() {
    if (!this.group.visible) return [];
    return this.drawn().map((i) => {
      const [a, b] = this.ends(i);
      return { position: a.lerp(b, 0.5), text: this.lengths[i] === 0 ? this.names[i] : `${short(this.lengths[i])} ${this.unit}`, kind: "important" };
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
    const parts = [element("p", { class: "verdict" }, this.verdict), ...remarksOn(this.remarks)];
    // The ends of lines between two objects are on these.
    const names = viewer.scene.colours ? viewer.scene.objects.map((object) => object.name) : [];
    this.term = (k) => names[k]
      ? [patch(k === 1 ? "second" : "surface"), shortened(names[k], LONGEST_NAME)] : ["from", "to"][k];
    if (this.isLabelled) {
      parts.push(this.text);
      if (this.length > 0) {
        const fly = element("button", { type: "button", class: "primary", id: "fly", onclick: () => this.fly(viewer) }, "Fly there");
        parts.push(element("p", { class: "buttons" }, fly, copyButton(this.text)));
      }
    } else {
      const what = "length";
      parts.push(viewer.figure(() => ({ scale: this.scale, what, unit: viewer.unit, values: this.lengths })).element,
        element("p", { class: "buttons" }, step(-1, "Previous"), step(1, "Next")), this.text);
    }
    add(this.title, "measures", ...parts);
    this.select(viewer);
  }

  // Flies to the first line, from which the view is as far as it is long.
  fly(viewer) {
    const [a, b] = this.ends(0);
    const part = Math.max(CLOSEST_FLIGHT, (ROOM * a.distanceTo(b)) / viewer.data.frame.radius);
    viewer.view.flyTo(a.lerp(b, 0.5), Math.min(1, part));
  }

  select(viewer) {
    const rows = this.drawn().flatMap((i) => [
      [[this.names[i] ?? `number ${count(i)}`], element("span", {}, number(this.lengths[i]), ` ${viewer.unit}`)],
      ...[0, 1].map((k) => [this.term(k), viewer.place(this.coordinates.subarray(6 * i + 3 * k, 6 * i + 3 * k + 3))]),
    ]);
    fillList(this.text, rows);
    if (this.colours) {
      this.draw();
      viewer.draw();
    }
  }
}
