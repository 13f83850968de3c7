// The boxes of an index: the nodes of a tree, level by level.

import * as three from "three";
import { element } from "./text.js";

// The pairs of corners that an edge of a box joins. Bit k of a corner is set if it is at the upper end of axis k.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
  [1, 2, 4].filter((bit) => !(corner & bit)).map((bit) => [corner, corner | bit]));

export class CellsLayer {
  constructor(cells) {
    this.levels = cells.levels;
    this.group = new three.Group();
    this.material = new three.LineBasicMaterial();
    this.show(Math.min(3, this.levels.length - 1));
  }

  setTheme(theme, colours) {
    this.material.color.set(colours.line);
  }

  // Shows a level, by its number.
  show(number) {
    this.level = number;
    for (const child of this.group.children) child.geometry.dispose();
    this.group.clear();
    const { boxes } = this.levels[number];
    const corners = EDGES.flat();
    const count = boxes.length / 6;
    const vertices = new Float32Array(count * corners.length * 3);
    let at = 0;
    for (let i = 0; i < count; i++) {
      for (const corner of corners) {
        for (let k = 0; k < 3; k++) vertices[at++] = boxes[6 * i + k + (corner & (1 << k) ? 3 : 0)];
      }
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(vertices, 3));
    this.group.add(new three.LineSegments(geometry, this.material));
  }

  title() {
    return this.levels[this.level].title;
  }
}

// The panel of the levels of boxes.
export class CellsPanel {
  constructor(viewer, add) {
    this.viewer = viewer;
    const { cells } = viewer;
    this.text = element("output", { id: "level" });
    this.range = element("input", {
      type: "range", min: 0, max: cells.levels.length - 1, step: 1, value: cells.level, "aria-label": "level",
      oninput: () => this.show(Number(this.range.value)),
    });
    add(viewer.data.cells.title, "index", this.range, element("p", {}, this.text));
    this.text.textContent = cells.title();
  }

  step(by) {
    this.show(this.viewer.cells.level + by);
  }

  show(level) {
    const { cells } = this.viewer;
    cells.show(Math.max(0, Math.min(cells.levels.length - 1, level)));
    cells.group.visible = true;
    document.getElementById("show-cells").checked = true;
    this.range.value = cells.level;
    this.text.textContent = cells.title();
    this.viewer.draw();
  }
}
