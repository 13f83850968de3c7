// What lies over the picture: the axes, the scale bar, labels of lines and lengths, the tooltip, and the grid.

import * as three from "three";
import { element, roundUp, short } from "./text.js";

// The least length of the scale bar in pixels.
const LEAST_BAR = 60;
// Where a label with a leader stands relative to its position in pixels, so that it does not hide what it names.
const [ASIDE, ABOVE] = [22, 38];
// The width in pixels of a character of a label, at most.
const WIDE = 8.5;
// The width of a picture in pixels below which labels are shorter.
const NARROW = 600;
// The least distance between labels in pixels.
const LABEL_GAP = 44;

export class Overlay {
  constructor(viewer, stage) {
    this.viewer = viewer;
    this.axes = ["x", "y", "z"].map((name) => [
      element("line", { x1: 0, y1: 0, class: `axis-${name}` }), element("text", { class: `axis-${name}` }, name),
    ]);
    const triad = element("svg", { viewBox: "-36 -36 72 72", class: "triad" }, ...this.axes.flat());
    this.barText = element("span", {});
    this.bar = element("div", { class: "scale-bar" }, element("div", {}), this.barText);
    this.labels = element("div", { class: "labels" });
    this.tip = element("div", { id: "tip", hidden: true });
    this.leaders = element("svg", { class: "leaders" });
    this.legend = element("div", { class: "picture-legend", hidden: true });
    this.box = element("div", { id: "overlay", "aria-hidden": "true" }, this.leaders, this.labels, triad, this.bar, this.legend);
    stage.append(this.box, this.tip);
    // Lists of labels, each with a position in the frame and a text. Labels with a class have a leader to their position.
    this.sources = [];
    this.grid = null;
  }

  // Moves everything to where it belongs in the picture.
  update() {
    const { viewer } = this;
    const { camera } = viewer;
    camera.updateMatrixWorld();
    const inverse = camera.quaternion.clone().invert();
    const ends = [0, 1, 2].map((k) => new three.Vector3().setComponent(k, 1).applyQuaternion(inverse));
    ends.forEach(({ x, y }, k) => {
      const [line, text] = this.axes[k];
      for (const [name, value] of [["x2", 24 * x], ["y2", -24 * y]]) line.setAttribute(name, value.toFixed(1));
      for (const [name, value] of [["x", 31 * x], ["y", 4 - 31 * y]]) text.setAttribute(name, value.toFixed(1));
    });
    const { clientWidth: width, clientHeight: height } = viewer.stage;
    const pixel = viewer.view.pixel * viewer.frame.scale;
    const length = roundUp(LEAST_BAR * pixel);
    this.bar.hidden = !Number.isFinite(length) || length === 0;
    this.bar.firstChild.style.width = `${Math.min(length / pixel, width / 2)}px`;
    const isOne = length === 1 && viewer.unit === "units";
    this.barText.textContent = `${short(length)} ${isOne ? "unit" : viewer.unit}`;
    this.placeLabels(width, height);
  }

  placeLabels(width, height) {
    const placed = [];
    const shown = [];
    const leaders = [];
    // Labels with leaders come first, and hide others.
    const all = this.sources.flatMap((source) => source()).sort((a, b) => !a.kind - !b.kind);
    for (const { position, text: words, kind } of all) {
      // The panel has the whole sentence.
      const text = width < NARROW ? words.replace(/ from the \w+$/, "") : words;
      const seen = position.clone().project(this.viewer.camera);
      const [x, y] = [((seen.x + 1) / 2) * width, ((1 - seen.y) / 2) * height];
      const isInside = Math.abs(seen.z) < 1 && x > 20 && y > 10 && x < width - 20 && y < height - 10;
      if (!isInside || (!kind && placed.some(([a, b]) => Math.hypot(a - x, b - y) < LABEL_GAP))) continue;
      const label = element("span", kind ? { class: kind } : {}, text);
      let [at, up, anchor] = [x, y, "-50%"];
      if (kind) {
        // A label stays in the picture, below the toolbar.
        const long = Math.min(width - 12, LABEL_GAP / 3 + WIDE * text.length);
        const isLeft = x + ASIDE + long > width && x > width / 2;
        const free = Math.max(6, Math.min(width - 6 - long, isLeft ? x - ASIDE - long : x + ASIDE));
        [at, up, anchor] = [isLeft ? free + long : free, y + (y < 110 ? ABOVE : -ABOVE), isLeft ? "-100%" : "0%"];
        // Leaders are seen on any colour.
        for (const look of ["halo", "ink"]) {
          leaders.push(element("line", { x1: x, y1: y, x2: at, y2: up, class: look }), element("circle", { cx: x, cy: y, r: 4, class: look }));
        }
        placed.push([x, y]);
        for (let along = 0; along < long; along += LABEL_GAP) placed.push([at + (isLeft ? -along : along), up]);
      }
      placed.push([at, up]);
      label.style.transform = `translate(${at.toFixed(1)}px, ${up.toFixed(1)}px) translate(${anchor}, -50%)`;
      shown.push(label);
    }
    this.labels.replaceChildren(...shown);
    this.leaders.replaceChildren(...leaders);
  }

  // Shows the legend of the colours in the picture.
  setLegend(legend) {
    this.legend.replaceChildren(legend);
    this.legend.hidden = false;
  }

  // Shows a text beside the pointer, or nothing.
  showTip(event, text) {
    this.tip.hidden = !text;
    if (!text) return;
    this.tip.textContent = text;
    const { left, top, width } = this.viewer.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - left, event.clientY - top];
    const isRight = x > width - 200;
    this.tip.style.transform =
      `translate(${x + (isRight ? -14 : 14)}px, ${y + 14}px)${isRight ? " translate(-100%, 0)" : ""}`;
  }

  // Shows a grid below the scene, or hides it.
  setGrid(isOn) {
    if (isOn && !this.grid) this.makeGrid();
    if (this.grid) this.grid.visible = isOn;
  }

  makeGrid() {
    const { viewer } = this;
    const { samples, isYUp } = viewer.view;
    const [u, v, up] = isYUp ? [0, 2, 1] : [0, 1, 2];
    const ranges = [u, v, up].map((k) => {
      let [low, high] = [Infinity, -Infinity];
      for (let i = k; i < samples.length; i += 3) {
        low = Math.min(low, samples[i]);
        high = Math.max(high, samples[i]);
      }
      return low <= high ? [low, high] : [-1, 1];
    });
    const { scale, origin } = viewer.frame;
    const spacing = roundUp((viewer.data.frame.radius * scale) / 8);
    // Lines are at multiples of the spacing in the unit of the scene.
    const lines = [u, v].map((k, i) => {
      const at = (x) => ((x + origin[k]) * scale) / spacing;
      const [from, to] = [Math.floor(at(ranges[i][0])) - 1, Math.ceil(at(ranges[i][1])) + 1];
      return Array.from({ length: Math.min(200, to - from + 1) }, (_, j) => ((from + j) * spacing) / scale - origin[k]);
    });
    const points = [];
    const point = (x, y) => {
      const made = new three.Vector3();
      made.setComponent(u, x);
      made.setComponent(v, y);
      made.setComponent(up, ranges[2][0]);
      points.push(made);
    };
    for (const x of lines[0]) [lines[1][0], lines[1].at(-1)].forEach((y) => point(x, y));
    for (const y of lines[1]) [lines[0][0], lines[0].at(-1)].forEach((x) => point(x, y));
    const material = new three.LineBasicMaterial({ transparent: true, opacity: 0.4, depthWrite: false });
    this.grid = new three.LineSegments(new three.BufferGeometry().setFromPoints(points), material);
    material.color.set(viewer.colours.grid);
    viewer.world.add(this.grid);
  }

  setTheme(colours) {
    this.grid?.material.color.set(colours.grid);
  }
}
