// The page: the picture, the panel beside it, and what mouse and keyboard do.

import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { AnswersLayer } from "./answers.js";
import { CellsLayer } from "./cells.js";
import { THEMES } from "./colours.js";
import { Frame, readData } from "./data.js";
import { DeviationsLayer, DeviationsPanel } from "./deviations.js";
import { Figure } from "./histogram.js";
import { LiveQueries } from "./live.js";
import { SceneLayer } from "./scene.js";
import { SliceLayer } from "./slice.js";
import { checkbox, count, counted, element, fillList, reveal, short, stepped, tableHead } from "./text.js";

// The number of rows of a page of the table.
const ROWS = 50;
// The distance from the middle of the scene to which the view can be moved, in radii of the scene.
const MAX_PAN = 2;
// The distance in pixels within which a click selects an answer.
const PICK_RADIUS = 12;
// The number of answers above which a page begins without segments to closest points, which would fill the picture.
const MANY_ANSWERS = 20_000;

// The keys, what they do, and the property that the viewer has in pages where they do it.
const KEYS = [
  ["arrow keys", "turn the view"],
  ["Shift and arrow keys", "move the view"],
  ["+ and -", "come nearer and go farther"],
  ["f", "fit the view to the scene"],
  ["n and p", "next and previous answer", "answers"],
  ["n and p", "next and previous point", "deviations"],
  ["x, y and z", "lay the slice across this axis", "slice"],
  ["[ and ]", "move the slice", "slice"],
  ["v", "read the slice in the middle of the picture", "slice"],
  ["l and k", "next and previous level of boxes", "cells"],
  ["q", "let the live query follow the mouse, or stop", "live"],
  ["d", "dark or light"],
  ["?", "show or hide this list"],
];

class Viewer {
  constructor(data) {
    this.data = data;
    this.unit = data.unit;
    this.frame = new Frame(data.frame);
    this.canvas = document.getElementById("picture");
    // All figures, which have the colours of a scale, which depend on the theme.
    this.figures = [];
    this.renderer = makeRenderer(this.canvas);
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.world = new three.Scene();
    this.camera = new three.PerspectiveCamera(45, 1, 0.001, 100);
    this.camera.up.set(...(data.up === "y" ? [0, 1, 0] : [0, 0, 1]));
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.light = new three.DirectionalLight(0xffffff, 2.2);
    this.camera.add(this.light);
    this.world.add(this.camera, new three.AmbientLight(0xffffff, 1.1));

    this.scene = new SceneLayer(data.scene);
    this.world.add(this.scene.group);
    if (data.answers) this.addLayer("answers", new AnswersLayer(data.answers, this.frame), "group");
    if (this.answers) this.world.add(this.answers.selection);
    if (data.cells) this.addLayer("cells", new CellsLayer(data.cells), "group");
    const field = data.field ?? data.lists;
    if (field) this.addLayer("slice", new SliceLayer(field, !!data.lists), "mesh");
    if (data.live) this.addLayer("live", new LiveQueries(this, data.live), "group");
    if (data.deviations) this.addLayer("deviations", new DeviationsLayer(data.deviations, this.frame), "group");
    if (this.cells) this.cells.group.visible = false;
    // The opacity of a transparent scene. Colours of a scan are seen through it.
    this.opacity = this.deviations ? 0.12 : 0.25;
    if (this.slice || this.deviations) this.scene.setOpacity(this.opacity);

    this.makePanel();
    this.listen();
    this.followSystem();
    this.fit();
    this.resize();
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
  }

  get colours() {
    return THEMES[this.theme];
  }

  addLayer(name, layer, drawn) {
    this[name] = layer;
    this.world.add(layer[drawn]);
  }

  setTheme(theme) {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.world.background = new three.Color(this.colours.background);
    for (const layer of [this.scene, this.cells, this.answers, this.slice, this.deviations]) {
      layer?.setTheme(theme, this.colours);
    }
    this.live?.redraw();
    this.figures.forEach((figure) => figure.update());
    this.draw();
  }

  // Takes the theme of the system, and its changes until another one is chosen in the page.
  followSystem() {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const follow = () => this.setTheme(system.matches ? "dark" : "light");
    system.addEventListener("change", () => this.isThemeChosen || follow());
    follow();
  }

  // Makes a figure whose colours follow the theme.
  figure(read, attributes) {
    const figure = new Figure(read, attributes);
    this.figures.push(figure);
    return figure;
  }

  // Draws once at the next frame, however often it is called until then.
  draw() {
    if (this.isPending) return;
    this.isPending = true;
    requestAnimationFrame(() => {
      this.isPending = false;
      this.renderer.render(this.world, this.camera);
    });
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  fit() {
    this.controls.target.set(0, 0, 0);
    const direction = this.data.up === "y" ? [1, 0.7, 1.6] : [1, -1.6, 0.9];
    const narrow = Math.min(1, this.canvas.parentElement.clientWidth / this.canvas.parentElement.clientHeight || 1);
    // From here the sphere around the scene fills the height of the picture.
    const distance = this.data.frame.radius / Math.sin((this.camera.fov / 360) * Math.PI);
    this.camera.position.set(...direction).setLength(distance / narrow);
    this.camera.near = this.data.frame.radius / 1000;
    this.camera.far = this.data.frame.radius * 100;
    // The scene stays between the planes that bound the picture.
    this.controls.minDistance = this.data.frame.radius / 100;
    this.controls.maxDistance = this.data.frame.radius * 50;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  // Turns the view by angles, and moves it by a factor of the distance.
  turn(around, up, factor) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const toY = new three.Quaternion().setFromUnitVectors(this.camera.up, new three.Vector3(0, 1, 0));
    const spherical = new three.Spherical().setFromVector3(offset.applyQuaternion(toY));
    spherical.theta += around;
    spherical.phi = Math.max(0.01, Math.min(Math.PI - 0.01, spherical.phi + up));
    const { minDistance, maxDistance } = this.controls;
    spherical.radius = Math.max(minDistance, Math.min(maxDistance, spherical.radius * factor));
    offset.setFromSpherical(spherical).applyQuaternion(toY.invert());
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  // Moves the view across itself by parts of the distance.
  pan(right, up) {
    const { camera, controls: { target } } = this;
    const distance = camera.position.distanceTo(target);
    camera.updateMatrix();
    const [x, y] = [0, 1].map((k) => new three.Vector3().setFromMatrixColumn(camera.matrix, k));
    const shift = x.multiplyScalar(right * distance).addScaledVector(y, up * distance);
    const before = target.clone();
    target.add(shift).clampLength(0, MAX_PAN * this.data.frame.radius);
    camera.position.add(target).sub(before);
    this.controls.update();
    this.draw();
  }

  // ---- the panel

  makePanel() {
    const panel = document.getElementById("panel");
    const add = (title, id, ...children) => {
      const section = element("section", { id, "aria-label": title }, element("h2", {}, title), ...children);
      panel.append(section);
      return section;
    };
    if (this.data.notes.length > 0) {
      add("Notes", "notes", element("ul", {}, ...this.data.notes.map((note) => element("li", {}, note))));
    }
    this.live?.makePanel(add);
    if (this.deviations) this.deviationsPanel = new DeviationsPanel(this, add);
    if (this.answers) this.makeAnswers(add);
    if (this.slice) this.makeSlice(add);
    this.makeShown(add);
    if (this.cells) this.makeCells(add);
    if (this.scene.objects.some((object) => object.name !== null)) this.makeObjects(add);
    const keys = KEYS.filter(([, , needed]) => !needed || this[needed])
      .map(([key, what]) => [element("dt", {}, element("kbd", {}, key)), element("dd", {}, what)]);
    this.help = element("details", { id: "keys" }, element("summary", {}, "Mouse and keyboard"),
      element("p", {}, "Drag to turn, drag with the right button to move, and turn the wheel to come nearer. Click a " +
        "query point or a point of a scan to read its answer. The keys act while the picture has the focus."),
      element("dl", {}, ...keys.flat()));
    panel.append(this.help, document.getElementById("about"));
  }

  makeShown(add) {
    const boxes = [];
    const box = (label, isOn, change, id) =>
      boxes.push(checkbox(label, isOn, (value) => { change(value); this.draw(); }, id));
    box("scene", true, (on) => (this.scene.group.visible = on), "show-scene");
    if (this.data.scene.triangles.length > 0) {
      box("wireframe", false, (on) => this.scene.setWireframe(on), "show-wireframe");
      const isThrough = !!(this.slice || this.deviations);
      box("transparent", isThrough, (on) => this.scene.setOpacity(on ? this.opacity : 1), "show-through");
    }
    if (this.deviationsPanel) this.deviationsPanel.makeBoxes(box);
    if (this.answers) {
      const { answers } = this;
      const isCrowded = answers.length > MANY_ANSWERS;
      answers.segments.visible = !isCrowded;
      box("query points", true, (on) => (answers.dots.visible = on), "show-queries");
      box("closest points", true, (on) => (answers.feet.visible = on), "show-closest");
      box("segments to closest points", !isCrowded, (on) => (answers.segments.visible = on), "show-segments");
      box("sphere of the lower bound", true, (on) => {
        answers.hasSphere = on;
        answers.select(answers.selected, this.colours);
      }, "show-sphere");
    }
    if (this.live) {
      box("live query", true, (on) => (this.live.group.visible = on), "show-live");
      box("sphere of its lower bound", true, (on) => {
        this.live.hasSphere = on;
        this.live.redraw();
      }, "show-live-sphere");
    }
    if (this.slice) box("slice", true, (on) => (this.slice.mesh.visible = on), "show-slice");
    if (this.cells) box("boxes of the index", false, (on) => (this.cells.group.visible = on), "show-cells");
    const toggle = () => this.toggleTheme();
    const theme = element("button", { type: "button", id: "theme", onclick: toggle }, "Dark or light");
    const fit = element("button", { type: "button", id: "fit", onclick: () => this.fit() }, "Fit the view");
    add("Show", "show", element("div", { class: "boxes" }, ...boxes), element("p", {}, fit, " ", theme));
  }

  toggleTheme() {
    this.isThemeChosen = true;
    this.setTheme(this.theme === "dark" ? "light" : "dark");
  }

  makeObjects(add) {
    const boxes = this.scene.objects.map((object, i) => {
      const name = object.name ?? "primitives of no object";
      return checkbox(`${name} (${counted(object.count, "primitive")})`, true, (on) => {
        this.scene.show(i, on);
        this.draw();
      });
    });
    const set = (isOn) => {
      boxes.forEach((label, i) => {
        label.firstChild.checked = isOn;
        this.scene.objects[i].isVisible = isOn;
      });
      this.scene.update();
      this.draw();
    };
    const button = (text, isOn) => element("button", { type: "button", onclick: () => set(isOn) }, text);
    add(`Objects (${count(boxes.length)})`, "objects",
      element("p", {}, button("All", true), " ", button("None", false)),
      element("div", { class: "boxes scrolled", tabindex: "0", role: "region", "aria-label": "objects" }, ...boxes));
  }

  makeAnswers(add) {
    const { answers } = this;
    const what = answers.signed ? "signed distance" : "distance";
    const missing = answers.length - answers.answeredCount;
    const parts = [];
    const all = counted(answers.length, "query");
    if (missing > 0) parts.push(element("p", {}, `${count(missing)} of ${all} have no answer.`));
    if (answers.answeredCount > 0) {
      const { scale, values } = answers;
      parts.push(this.figure(() => ({ scale, what, unit: this.unit, values })).element);
    }
    add("Distances", "distances", ...parts);
    this.answerText = element("dl", { id: "answer", "aria-live": "polite" });
    const step = (by) =>
      element("button", { type: "button", onclick: () => this.step(by) }, by > 0 ? "Next" : "Previous");
    add("Answer", "selected", element("p", {}, step(-1), " ", step(1)), this.answerText);
    this.table = element("table", { id: "table" });
    this.tablePage = 0;
    const pages = element("p", {});
    const turn = (by) => element("button", { type: "button", onclick: () => this.turnTable(by) },
      by > 0 ? "Next rows" : "Previous rows");
    pages.append(turn(-1), " ", turn(1));
    const details = element("details", { id: "answers" }, element("summary", {}, "All answers as a table"), pages,
      element("div", { class: "scrolled", tabindex: "0", role: "region", "aria-label": "answers" }, this.table));
    document.getElementById("panel").append(details);
    this.turnTable(0);
    this.select(-1);
  }

  turnTable(by) {
    const { answers } = this;
    const last = Math.max(0, Math.ceil(answers.length / ROWS) - 1);
    this.tablePage = Math.max(0, Math.min(last, this.tablePage + by));
    const first = this.tablePage * ROWS;
    const head = ["query", "x", "y", "z", answers.signed ? "signed distance" : "distance", "primitive", "feature"];
    const rows = [];
    for (let i = first; i < Math.min(answers.length, first + ROWS); i++) {
      const select = element("button", { type: "button", onclick: () => this.select(i) }, String(i));
      const cells = answers.isAnswered(i)
        ? [...answers.points.subarray(3 * i, 3 * i + 3), answers.values[i], answers.primitives[i],
            answers.featureName(i)]
        : ["no answer", "", "", "", "", ""];
      rows.push(element("tr", {}, element("td", {}, select), ...cells.map((cell) => element("td", {}, String(cell)))));
    }
    this.table.replaceChildren(
      element("caption", {}, `Closest points, rows ${count(first)} to ${count(first + rows.length - 1)} of ` +
        `${count(answers.length)}`),
      tableHead(head), element("tbody", {}, ...rows));
  }

  select(i) {
    const { answers } = this;
    answers.select(i, this.colours);
    const rows = [];
    const row = (name, value) => rows.push([name, value]);
    if (i < 0) {
      row("none", "Click a query point, or press n.");
    } else {
      row("number", `${i} of ${answers.length}`);
      row("query", [...answers.queries.subarray(3 * i, 3 * i + 3)].join(", "));
      if (answers.isAnswered(i)) {
        rows.push(...answers.rows(i));
        const object = this.objectOf(answers.objects?.[i]);
        if (object) row("object", object);
      } else {
        row("answer", "none");
      }
    }
    fillList(this.answerText, rows);
    if (i >= 0) reveal(this.answerText);
    this.draw();
  }

  objectOf(number) {
    return number === undefined || number === 0 ? null : this.data.object_names[number - 1];
  }

  step(by) {
    const { length, selected } = this.answers;
    if (length > 0) this.select(stepped(selected, by, length));
  }

  makeCells(add) {
    const { cells } = this;
    const text = element("output", { id: "level" });
    const range = element("input", {
      type: "range", min: 0, max: cells.levels.length - 1, step: 1, value: cells.level, "aria-label": "level",
      oninput: () => this.showLevel(Number(range.value)),
    });
    this.levelRange = range;
    this.levelText = text;
    add(this.data.cells.title, "index", range, element("p", {}, text));
    text.textContent = cells.title();
  }

  showLevel(level) {
    this.cells.show(Math.max(0, Math.min(this.cells.levels.length - 1, level)));
    this.cells.group.visible = true;
    document.getElementById("show-cells").checked = true;
    this.levelRange.value = this.cells.level;
    this.levelText.textContent = this.cells.title();
    this.draw();
  }

  makeSlice(add) {
    const { slice } = this;
    const what = slice.hasCells ? "length of the list" : slice.scale.isDiverging ? "signed distance" : "distance";
    this.sliceUnit = slice.hasCells ? "primitives" : this.unit;
    const axes = [0, 1, 2].map((axis) => {
      const radio = element("input", {
        type: "radio", name: "axis", value: axis, onchange: () => this.moveSlice(axis, 0.5),
      });
      radio.checked = axis === slice.axis;
      return element("label", {}, radio, ` ${"xyz"[axis]} `);
    });
    this.axisRadios = axes.map((label) => label.firstChild);
    this.sliceRange = element("input", {
      type: "range", min: 0, max: 1, step: 0.001, value: 0.5, "aria-label": "position of the slice",
      oninput: () => this.moveSlice(slice.axis, Number(this.sliceRange.value)),
    });
    this.sliceText = element("output", { id: "slice-text" });
    this.sliceValue = element("output", { id: "slice-value" });
    const about = slice.hasCells
      ? "A query evaluates only primitives of the list of its cell. Where a cell has no list the slice is violet, " +
        "and the AABB tree below the cells answers."
      : `${slice.scale.isDiverging ? "The black line is distance zero. " : ""}Lines of equal distance are darker.`;
    const title = slice.hasCells ? "Slice through the cells" : "Slice of the field";
    add(title, "field", element("p", {}, "across the axis ", ...axes), this.sliceRange,
      element("p", {}, this.sliceText), element("p", {}, this.sliceValue),
      this.figure(() => ({ scale: slice.scale, what, unit: this.sliceUnit })).element,
      element("p", { class: "small" }, `${about} The keys [ and ] move the slice, and Shift and the mouse drag it.`));
    this.moveSlice(slice.axis, 0.5);
  }

  // Moves the slice to a part of the field along an axis.
  moveSlice(axis, part) {
    const { slice } = this;
    const t = Math.max(0, Math.min(1, part));
    slice.setPlane(axis, t * (slice.counts[axis] - 1));
    this.slicePart = t;
    this.axisRadios.forEach((radio, k) => (radio.checked = k === axis));
    this.sliceRange.value = t;
    const position = slice.origin.map((x) => x);
    position[axis] += slice.index * slice.spacing;
    this.sliceText.textContent = `${"xyz"[axis]} = ${this.coordinateTexts(position)[axis]} ${this.unit}`;
    this.draw();
  }

  // ---- mouse and keyboard

  listen() {
    const { canvas } = this;
    let pressed = null;
    const release = () => {
      pressed = null;
      this.isDragging = false;
      this.controls.enabled = true;
    };
    canvas.addEventListener("pointerdown", (event) => {
      pressed = [event.clientX, event.clientY];
      this.isDragging = event.shiftKey && !!this.slice;
      this.controls.enabled = !this.isDragging;
      if (this.isDragging) canvas.setPointerCapture(event.pointerId);
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
      if (this.isDragging) this.moveSlice(this.slice.axis, this.slicePart - event.movementY / canvas.clientHeight);
      else this.readSlice(event);
      this.live?.follow(event);
      if (this.deviationsPanel) this.deviationsPanel.hover(event);
    });
    canvas.addEventListener("pointerup", (event) => {
      const isClick = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
      release();
      // A finger has no position before it touches.
      if (isClick && event.pointerType === "touch") this.live?.follow(event);
      if (isClick && this.answers) this.select(this.pick(event));
      if (isClick && this.deviationsPanel) this.deviationsPanel.select(this.deviationsPanel.pick(event));
    });
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("keydown", (event) => this.press(event));
  }

  // Returns the size of the picture and the position of the pointer in it, in pixels from its upper left corner, and a
  // function that makes the ray from the camera through the pointer.
  pointer(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - left, event.clientY - top];
    const caster = () => this.caster((2 * x) / width - 1, 1 - (2 * y) / height);
    return { size: { x: width, y: height }, x, y, caster };
  }

  // Returns the ray from the camera through a position of the picture, whose coordinates are from -1 to 1.
  caster(x, y) {
    const caster = new three.Raycaster();
    caster.setFromCamera(new three.Vector2(x, y), this.camera);
    return caster;
  }

  pick(event) {
    const { size, x, y } = this.pointer(event);
    return this.answers.pick(this.camera, size, x, y, PICK_RADIUS);
  }

  // Shows the value of the slice where the pointer is, or in the middle of the picture if there is no event.
  readSlice(event) {
    if (!this.slice) return;
    if (!this.slice.mesh.visible) {
      this.sliceValue.textContent = event ? "" : "The slice is not shown.";
      return;
    }
    const caster = event ? this.pointer(event).caster() : this.caster(0, 0);
    const [hit] = caster.intersectObject(this.slice.mesh);
    // The pointer moves all the time, and screen readers would read each value.
    this.sliceValue.setAttribute("aria-live", event ? "off" : "polite");
    if (!hit) {
      this.sliceValue.textContent = event ? "" : "The slice is not in the middle of the picture.";
      return;
    }
    const at = this.coordinateTexts(hit.point.toArray()).join(", ");
    this.sliceValue.textContent = `${this.slice.textAt(hit.point, this.sliceUnit)} at ${at}`;
  }

  // Returns the coordinates of a position in the frame as texts, to a hundred thousandth of the radius of the scene.
  coordinateTexts(position) {
    const digits = Math.max(0, Math.min(100, 5 - Math.floor(Math.log10(this.data.frame.radius * this.frame.scale))));
    return this.frame.coordinates(position).map((x) => String(Number(x.toFixed(digits))));
  }

  press(event) {
    // Some keyboards have the brackets on keys that need AltGr, which counts as Ctrl and Alt.
    const isBracket = event.key === "[" || event.key === "]";
    if (!isBracket && (event.ctrlKey || event.metaKey || event.altKey)) return;
    const { slice, cells, answers, deviationsPanel } = this;
    const shiftSlice = (by) => this.moveSlice(slice.axis, this.slicePart + by);
    const turnSlice = (axis) => this.moveSlice(axis, axis === slice.axis ? this.slicePart : 0.5);
    const step = answers ? (by) => this.step(by) : deviationsPanel && ((by) => deviationsPanel.step(by));
    const actions = {
      ShiftArrowLeft: () => this.pan(-0.05, 0), ShiftArrowRight: () => this.pan(0.05, 0),
      ShiftArrowUp: () => this.pan(0, 0.05), ShiftArrowDown: () => this.pan(0, -0.05),
      ArrowLeft: () => this.turn(-0.1, 0, 1), ArrowRight: () => this.turn(0.1, 0, 1),
      ArrowUp: () => this.turn(0, -0.1, 1), ArrowDown: () => this.turn(0, 0.1, 1),
      "+": () => this.turn(0, 0, 0.9), "=": () => this.turn(0, 0, 0.9), "-": () => this.turn(0, 0, 1 / 0.9),
      f: () => this.fit(), d: () => this.toggleTheme(),
      q: this.live && (() => this.live.setFollowing(!this.live.isFollowing)),
      n: step && (() => step(1)), p: step && (() => step(-1)),
      x: slice && (() => turnSlice(0)), y: slice && (() => turnSlice(1)), z: slice && (() => turnSlice(2)),
      "[": slice && (() => shiftSlice(-0.02)), "]": slice && (() => shiftSlice(0.02)),
      v: slice && (() => {
        this.readSlice(null);
        reveal(this.sliceValue);
      }),
      l: cells && (() => this.showLevel(cells.level + 1)), k: cells && (() => this.showLevel(cells.level - 1)),
      "?": () => {
        this.help.open = !this.help.open;
        if (this.help.open) reveal(this.help);
      },
    };
    const isShifted = event.shiftKey && event.key.startsWith("Arrow");
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = actions[isShifted ? `Shift${key}` : key];
    if (!action) return;
    event.preventDefault();
    action();
  }
}

// Returns the renderer. Without WebGL it draws nothing, and the panel has all numbers all the same.
function makeRenderer(canvas) {
  try {
    return new three.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  } catch {
    document.getElementById("failure").textContent =
      "The picture cannot be drawn, because this browser has no WebGL. The panel has all numbers.";
    const nothing = () => {};
    return { render: nothing, setSize: nothing, setPixelRatio: nothing };
  }
}

// Says what is missing where the page cannot be shown.
function fail(error) {
  const reason = typeof DecompressionStream === "undefined" ? "this browser is too old for it" : error.message;
  document.getElementById("failure").textContent = `The page cannot be shown: ${reason}.`;
}

readData().then((data) => {
  // Tests read what is shown from here.
  window.viewer = new Viewer(data);
  document.documentElement.dataset.ready = "true";
  const { live } = window.viewer;
  live?.start().then(() => (document.documentElement.dataset.live = "ready"), (error) => {
    live.say(`Live queries do not work here: ${error.message}.`);
    document.documentElement.dataset.live = "failed";
    console.error(error);
  });
}).catch((error) => {
  fail(error);
  document.documentElement.dataset.ready = "failed";
  console.error(error);
});
