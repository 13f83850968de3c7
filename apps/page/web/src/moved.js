// The panel of an object that was moved, which shows it before and after, and the matrix.

import * as three from "three";
import { choice, copyButton, element, fillList, number, remarksOn, roundingInWords } from "./text.js";

// The digits that are shown of the numbers of the matrix.
const MATRIX_DIGITS = 4;
// The size below which a number of the matrix is shown as zero.
const ROUNDED_ZERO = 1e-12;

export class MovedPanel {
  constructor(viewer, add) {
    const { title, verdict, remarks, matrix, facts } = viewer.data.moved;
    this.viewer = viewer;
    this.after = viewer.scene.positions.slice();
    this.back = new three.Matrix4().set(...matrix).invert();
    const list = element("dl", { id: "moved-facts" });
    // What rounding has left of zeros is shown as such. Copies have it.
    const isRounding = ([term, x]) => term === "root mean square" && viewer.isRounding(x);
    fillList(list, facts.map((fact) => isRounding(fact)
      ? [fact[0], element("data", { value: String(fact[1]) }, `0 ${roundingInWords(fact[1])}`)] : fact));
    const cell = (x) => {
      const shown = number(x, MATRIX_DIGITS);
      if (Math.abs(x) < ROUNDED_ZERO) shown.textContent = "0";
      return element("td", {}, shown);
    };
    const rows = [0, 4, 8, 12].map((i) => element("tr", {}, ...matrix.slice(i, i + 4).map(cell)));
    const table = element("table", { id: "matrix" }, element("caption", {}, "Matrix of the motion"), element("tbody", {}, ...rows));
    const shown = choice("shown", ["after", "before"], 0, (i) => this.show(i === 1));
    add(title, "moved", element("p", { class: "verdict" }, verdict), ...remarksOn(remarks),
      element("div", { class: "row" }, element("span", {}, viewer.scene.objects[1].name), shown),
      element("p", { class: "small" }, "Where both coincide, squares show one or the other."), list, table,
      element("p", { class: "buttons" }, copyButton(table), element("span", { class: "small" }, "for --transform of other commands")));
  }

  // Shows the object before it was moved, or after.
  show(isBefore) {
    const { scene, view } = this.viewer;
    this.before ??= this.movedBack();
    scene.setPositions(isBefore ? this.before : this.after);
    view.setClouds([scene.positions]);
    this.viewer.fit();
  }

  movedBack() {
    const { scene, frame } = this.viewer;
    const positions = this.after.slice();
    const point = new three.Vector3();
    for (const i of scene.verticesOf(1)) {
      point.fromArray(frame.coordinates(positions.subarray(3 * i, 3 * i + 3))).applyMatrix4(this.back);
      positions.set(frame.positions(point.toArray()), 3 * i);
    }
    return positions;
  }
}
