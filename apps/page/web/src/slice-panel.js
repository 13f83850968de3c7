// The panel of a slice: its axis, its place, its colours, and its value at the pointer.

import { noInside } from "./answers.js";
import { pictureLegend } from "./histogram.js";
import { choice, element, short, withCode } from "./text.js";

export class SlicePanel {
  constructor(viewer, add) {
    this.viewer = viewer;
    this.slice = viewer.slice;
    const { slice } = this;
    const { isDiverging } = slice.scale;
    this.what = slice.hasCells ? "length of the list" : isDiverging ? "signed distance" : "distance";
    this.unit = slice.hasCells ? "primitives" : viewer.unit;
    this.axes = choice("axis", ["x", "y", "z"], slice.axis, (axis) => this.move(axis, 0.5));
    this.radios = [...this.axes.querySelectorAll("input")];
    this.range = element("input", {
      type: "range", min: 0, max: 1, step: 0.001, value: 0.5, "aria-label": "position of the slice",
      oninput: () => this.move(slice.axis, Number(this.range.value)),
    });
    this.text = element("output", { id: "slice-text" });
    this.value = element("output", { id: "slice-value" });
    const { triangles } = viewer.data.scene;
    const about = slice.hasCells
      ? "A query evaluates only primitives of the list of its cell. Where a cell has no list the slice is violet, " +
        "and the AABB tree below the cells answers."
      : (isDiverging ? "Blue is inside, red is outside, and the black line is the surface. " : "") +
        `The distance changes by ${short(slice.spacingOfLines)} ${viewer.unit} from line to line. ` +
        (isDiverging || viewer.data.no_inside ? "" : "With `--signed`, colours tell inside from outside. ") +
        (isDiverging || triangles.length === 0 ? ""
          : "Dark lines are edges of the scene, and its surface where the slice cuts it. ");
    const title = slice.hasCells ? "Slice through the cells" : isDiverging ? "Signed distance" : "Distance";
    add(title, "field",
      element("div", { class: "row" }, element("span", {}, "Across"), this.axes, this.text), this.range,
      element("p", { class: "reading" }, this.value),
      element("p", { class: "small" }, ...withCode(`Point at the slice to read it, and click to keep the answer. ${about}`)));
    // What was read last, and whether it stays when the pointer moves.
    this.shown = null;
    this.isKept = false;
  }

  // Shows the legend in the picture, in the colours of the theme.
  showLegend() {
    const { slice, viewer } = this;
    const why = viewer.data.no_inside ? noInside(viewer) : "Inside and outside have the same colours.";
    const hasNoSign = !slice.hasCells && !slice.scale.isDiverging;
    viewer.overlay.setLegend(element("div", {}, pictureLegend(slice.scale, this.what, this.unit),
      ...(hasNoSign ? [element("div", { class: "why" }, ...withCode(why))] : [])));
  }

  // Returns the label of what was read last.
  labels() {
    return this.shown && this.slice.mesh.visible ? [{ ...this.shown, kind: "important" }] : [];
  }

  // Lays the slice across the axis that points most to the viewer: a horizontal one, unless the scene is flat.
  lay() {
    const { camera, controls, view } = this.viewer;
    const towards = camera.position.clone().sub(controls.target).toArray().map(Math.abs);
    const up = view.isYUp ? 1 : 2;
    const isHigh = towards.every((x, k) => k === up || x < towards[up]);
    if (!isHigh) towards[up] = 0;
    this.move(towards.indexOf(Math.max(...towards)), 0.5);
  }

  // Moves the slice to a part of the field along an axis.
  move(axis, part) {
    const { slice, viewer } = this;
    this.part = Math.max(0, Math.min(1, part));
    slice.setPlane(axis, this.part * (slice.counts[axis] - 1));
    this.radios.forEach((radio, k) => (radio.checked = k === axis));
    this.range.value = this.part;
    const position = [...slice.origin];
    position[axis] += slice.index * slice.spacing;
    this.text.textContent = `at ${short(viewer.coordinates(position)[axis])} ${viewer.unit}`;
    this.isKept = false;
    this.show(this.example(), true);
    viewer.draw();
  }

  turn(axis) {
    this.move(axis, axis === this.slice.axis ? this.part : 0.5);
  }

  shift(by) {
    this.move(this.slice.axis, this.part + by);
  }

  // Returns the point of the slice that is in the middle of the picture, or else its middle.
  example() {
    const { slice, viewer } = this;
    const [hit] = viewer.caster(0, 0).intersectObject(slice.mesh);
    return hit?.point ?? slice.middle();
  }

  // Reads the slice where the pointer is, or in the middle of the picture if there is no event. Returns the value as a
  // text, if there is one.
  read(event) {
    const { slice, viewer, value } = this;
    // The pointer moves all the time, and screen readers would read each value.
    value.setAttribute("aria-live", event ? "off" : "polite");
    if (!slice.mesh.visible) {
      if (!event) value.textContent = "The slice is not shown.";
      return undefined;
    }
    if (!event) {
      this.show(this.example());
      this.value.hidden = false;
      return undefined;
    }
    const [hit] = viewer.pointer(event).caster().intersectObject(slice.mesh);
    if (!hit) return undefined;
    return this.isKept ? slice.textAt(hit.point, this.unit) : this.show(hit.point);
  }

  // Keeps what is read at the pointer until the next click or move of the slice.
  keep(event) {
    this.isKept = false;
    this.isKept = this.read(event) !== undefined;
    this.viewer.draw();
  }

  // Shows the value at a position in the frame, in the panel and in the picture, and returns it as a text.
  show(position, isExample = false) {
    const { slice, viewer, value } = this;
    const text = slice.textAt(position, this.unit);
    value.replaceChildren(text, element("span", { class: "small" }, " at ", viewer.place(viewer.coordinates(position.toArray())), isExample ? " (an example)" : ""));
    this.shown = { position, text };
    // Live queries say it without interpolation.
    value.hidden = viewer.asked === viewer.live;
    viewer.draw();
    return text;
  }
}
