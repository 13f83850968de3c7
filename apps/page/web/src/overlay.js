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
// The least distances between labels in pixels, and between the numbers of worst places and what they must not hide.
const [LABEL_GAP, MARK_GAP] = [44, 25];
// The places of a number relative to its position in pixels, the first that is free.
const AROUND = [[22, -38], [-22, -38], [44, 0], [-44, 0], [22, 38], [-22, 38], [0, -64], [64, -38], [-64, -38], [0, 64]];
// The widths in pixels at the ends of the lower border of a picture, which the axes and the scale bar cover.
const [COVERED_LEFT, COVERED_RIGHT] = [78, 110];
// The height in pixels of the middle of a label below the toolbar, and the width at its right that a legend covers.
const [BELOW_TOOLBAR, COVERED_BY_LEGEND] = [74, 166];

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
    // A measured line is as long as the scale bar says.
    const [from, to] = viewer.measures?.main ?? [];
    const pixel = viewer.view.pixelAt(from?.lerp(to, 0.5)) * viewer.frame.scale;
    const length = roundUp(LEAST_BAR * pixel);
    this.bar.hidden = !Number.isFinite(length) || length === 0;
    this.bar.firstChild.style.width = `${Math.min(length / pixel, width / 2).toFixed(1)}px`;
    const isOne = length === 1 && viewer.unit === "units";
    setText(this.barText, `${short(length)} ${isOne ? "unit" : viewer.unit}`);
    this.placeLabels(width, height);
  }

  placeLabels(width, height) {
    const isNarrow = width < NARROW;
    // Labels with leaders come first, and hide others.
    const all = this.sources.flatMap((source) => source()).sort((a, b) => !a.kind - !b.kind);
    const seen = all.map(({ position, text, kind = "" }) => {
      const { x, y, z } = position.clone().project(this.viewer.camera);
      // On a phone the panel has the whole sentence.
      return { text: isNarrow ? inShort(text) : text, kind, x: ((x + 1) / 2) * width, y: ((1 - y) / 2) * height, z };
    }).filter(({ x, y, z }) => Math.abs(z) < 1 && x > 20 && y > 10 && x < width - 20 && y < height - 10);
    // What further labels must not hide: positions that have labels, and these labels.
    const taken = seen.filter(({ kind }) => kind).map(({ x, y }) => [x, y]);
    const isFree = (x, y, gap) => taken.every(([a, b]) => Math.hypot(a - x, b - y) >= gap);
    let [labels, leaders] = [0, 0];
    for (const { text, kind, x, y } of seen) {
      if (!kind && !isFree(x, y, LABEL_GAP)) continue;
      // The part of the label that is at the left of its place.
      let [at, up, part] = [x, y, 0.5];
      if (kind) {
        const long = Math.min(width - 12, LABEL_GAP / 3 + WIDE * text.length);
        if (kind === "important") {
          [at, up, part] = placeSentence(x, y, long, width, height, isNarrow);
          for (let from = 0; from < long; from += LABEL_GAP) taken.push([at - part * long + from, up]);
        } else {
          const places = AROUND.map(([dx, dy]) => [x + dx, y + dy]);
          // The first number has its value beside it.
          const side = Math.max(12, text.length > 2 ? long / 2 : 0);
          const isAllFree = (a, b) => [-side + 12, 0, side - 12].every((shift) => isFree(a + shift, b, MARK_GAP));
          [at, up] = places.find(([a, b]) =>
            a > side && a < width - side && b > 60 && b < height - 12 && isAllFree(a, b)) ?? places[0];
          if (side > 12) for (let shift = 12 - side; shift < side; shift += MARK_GAP) taken.push([at + shift, up]);
        }
        // A leader ends where the label is nearest, whose letters are a little narrower than assumed.
        const wide = kind === "important" ? 0.7 * long : 0;
        this.setLeader(leaders++, x, y, Math.max(at - part * wide, Math.min(at + (1 - part) * wide, x)), up);
      }
      taken.push([at, up]);
      this.setLabel(labels++, text, kind,
        `translate(${at.toFixed(1)}px, ${up.toFixed(1)}px) translate(${-100 * part}%, -50%)`);
    }
    while (this.labels.children.length > labels) this.labels.lastChild.remove();
    while (this.leaders.children.length > leaders) this.leaders.lastChild.remove();
  }

  // Sets the label with a number. Elements of the frame before are used again.
  setLabel(i, text, kind, transform) {
    const label = this.labels.children[i] ?? this.labels.appendChild(element("span"));
    setText(label, text);
    if (label.className !== kind) label.className = kind;
    label.style.transform = transform;
  }

  // Sets the leader with a number, from a circle around a position to a label. It is seen on any colour.
  setLeader(i, x, y, at, up) {
    const leader = this.leaders.children[i] ?? this.leaders.appendChild(element("g", {}, ...["halo", "ink"].flatMap((look) =>
      [element("line", { class: look, x1: 0, y1: 0 }), element("circle", { class: look, r: 4 })])));
    leader.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
    for (const line of leader.querySelectorAll("line")) {
      line.setAttribute("x2", (at - x).toFixed(1));
      line.setAttribute("y2", (up - y).toFixed(1));
    }
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

// Sets the text of an element. A text that is set again would be laid out again.
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// Returns the text of a label for a narrow picture.
const inShort = (text) => text.replace(/^((?:in|out)side), (.*)/, "$2 $1").replace(/ from the \w+/, "");

// Returns where the label of an answer stands, and which part of it is at the left of there: beside its position, in the
// picture and below the toolbar. In a narrow picture, where it would hide much, it stands at the lower or upper border.
function placeSentence(x, y, long, width, height, isNarrow) {
  if (isNarrow && y > height / 2) {
    const most = Math.max(COVERED_LEFT + long / 2, width - COVERED_RIGHT - long / 2);
    return [Math.max(COVERED_LEFT + long / 2, Math.min(most, x)), height - 22, 0.5];
  }
  if (isNarrow) {
    const right = Math.min(x - ASIDE, width - COVERED_BY_LEGEND);
    return right - long > 6 ? [right, BELOW_TOOLBAR, 1] : [Math.min(x + ASIDE, width - 6 - long), BELOW_TOOLBAR, 0];
  }
  const isLeft = x + ASIDE + long > width && x > width / 2;
  const left = Math.max(6, Math.min(width - 6 - long, isLeft ? x - ASIDE - long : x + ASIDE));
  return [isLeft ? left + long : left, y + (y < 110 ? ABOVE : -ABOVE), isLeft ? 1 : 0];
}
