// The boxes of an index: the nodes of a tree level by level, or the cells of a partition coloured by list length.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { limits, points } from "./answers.js";

// The pairs of corners that an edge of a box joins. Bit k of a corner is set if it is at the upper end of axis k.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
  [1, 2, 4].filter((bit) => !(corner & bit)).map((bit) => [corner, corner | bit]));

export class CellsLayer {
  constructor(cells, frame, colours) {
    this.levels = cells.levels;
    this.hasLengths = this.levels.some((level) => level.lengths);
    const all = this.levels.map((level) => (level.lengths ? limits(level.lengths) : [0, 1]));
    this.scale = new ColourScale("sequential", Math.min(...all.map((a) => a[0])), Math.max(...all.map((a) => a[1])));
    this.group = new three.Group();
    this.colours = colours;
    this.show(Math.min(3, this.levels.length - 1));
  }

  // Shows a level, by its number, or none.
  show(number) {
    this.level = number;
    this.group.clear();
    const level = this.levels[number];
    if (!level) return;
    if (level.sites) {
      this.group.add(points(level.sites, this.scale.colours(level.lengths), 5));
      return;
    }
    const count = level.boxes.length / 6;
    const vertices = new Float32Array(count * EDGES.length * 6);
    const colours = new Uint8Array(vertices.length);
    const base = new three.Color(this.colours.line);
    const colour = [base.r, base.g, base.b].map((x) => 255 * x);
    let at = 0;
    for (let i = 0; i < count; i++) {
      if (level.lengths) this.scale.write(level.lengths[i], colour, 0);
      for (const corner of EDGES.flat()) {
        for (let k = 0; k < 3; k++) {
          vertices[at] = level.boxes[6 * i + k + (corner & (1 << k) ? 3 : 0)];
          colours[at++] = colour[k];
        }
      }
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(vertices, 3));
    geometry.setAttribute("color", new three.BufferAttribute(colours, 3, true));
    this.group.add(new three.LineSegments(geometry, new three.LineBasicMaterial({ vertexColors: true })));
  }

  title() {
    return this.levels[this.level]?.title ?? "nothing";
  }
}
