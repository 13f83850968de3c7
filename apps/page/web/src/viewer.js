// The page: its picture with all layers, and what the other files share.

import * as three from "three";
import { AnswersLayer } from "./answers.js";
import { AnswersPanel } from "./answers-panel.js";
import { Camera } from "./camera.js";
import { CellsLayer, CellsPanel } from "./cells.js";
import { THEMES } from "./colours.js";
import { Frame, readData } from "./data.js";
import { DeviationsLayer } from "./deviations.js";
import { DeviationsPanel } from "./deviations-panel.js";
import { Figure } from "./histogram.js";
import { listen } from "./input.js";
import { LiveQueries } from "./live.js";
import { MeasuresLayer } from "./measures.js";
import { MovedPanel } from "./moved.js";
import { Overlay } from "./overlay.js";
import { makePanel } from "./panel.js";
import { SceneLayer } from "./scene.js";
import { Painter, addLights } from "./shading.js";
import { SliceLayer } from "./slice.js";
import { SlicePanel } from "./slice-panel.js";
import { copyAllDigits, element, inWords, number, numbers, reveal } from "./text.js";
import { addToolbar } from "./toolbar.js";

// The distance in pixels within which an answer is selected or read.
const PICK_RADIUS = 12;
// The number of answers up to which the pointer reads them.
const MAX_POINTED = 20_000;
// The distance in pixels of an example from the corner of the scene in the picture, which makes its answer visible.
const EXAMPLE_GAP = 30;
// The length in radii of the scene below which a length is an error of rounding.
const ROUNDING = 1e-12;

class Viewer {
  constructor(data) {
    this.data = data;
    this.unit = data.unit;
    this.frame = new Frame(data.frame);
    this.canvas = document.getElementById("picture");
    this.stage = this.canvas.parentElement;
    // All figures, which have the colours of a scale, which depend on the theme.
    this.figures = [];
    this.renderer = makeRenderer(this.canvas);
    this.renderer.localClippingEnabled = true;
    this.world = new three.Scene();

    this.scene = new SceneLayer(data.scene, data.has_object_colours);
    this.world.add(this.scene.group);
    if (data.answers) this.addLayer("answers", new AnswersLayer(data.answers, this.frame), "group");
    if (this.answers) this.world.add(this.answers.selection);
    if (data.cells) this.addLayer("cells", new CellsLayer(data.cells), "group");
    const field = data.field ?? data.lists;
    if (field) this.addLayer("slice", new SliceLayer(field, !!data.lists), "mesh");
    // One scale has the colours of both.
    if (data.field && this.answers) this.answers.scale = this.slice.scale;
    if (data.live) this.addLayer("live", new LiveQueries(this, data.live), "group");
    if (data.measures) this.addLayer("measures", new MeasuresLayer(data.measures, this.frame), "group");
    if (data.deviations) {
      this.addLayer("deviations", new DeviationsLayer(data.deviations, this.frame, data.scene), "group");
    }
    if (this.cells) this.cells.group.visible = false;

    const clouds = [data.scene.positions, this.deviations?.drawn, this.measures?.positions].filter(Boolean);
    this.view = new Camera(this.canvas, data.frame, data.up, clouds, () => this.draw());
    this.camera = this.view.camera;
    this.controls = this.view.controls;
    // What lies behind a slice is seen from the side.
    this.view.isOblique = !!this.slice;
    this.view.hasLegend = !!this.slice || !!this.deviations;
    addLights(this.world, this.camera);
    this.painter = new Painter(this.renderer, this.world, this.camera, data.frame.radius);
    for (const [event, isMoving] of [["start", true], ["end", false]]) {
      this.controls.addEventListener(event, () => this.painter.setMoving(isMoving));
    }
    // Shade must not hide the colours of values.
    if (this.deviations) this.painter.strength = 1;
    this.overlay = new Overlay(this, this.stage);
    if (this.slice) this.overlay.sources.push(() => (this.slice.mesh.visible ? this.slice.labels : []));
    // The latest answer has a label in the picture.
    this.overlay.sources.push(() => this.asked?.labels() ?? []);
    if (this.measures) this.overlay.sources.push(() => this.measures.labels());
    if (this.deviations) this.overlay.sources.push(() => this.deviationsPanel.labels());
    addToolbar(this, this.stage);

    makePanel(this, { AnswersPanel, CellsPanel, DeviationsPanel, MovedPanel, SlicePanel });
    copyAllDigits();
    listen(this);
    this.followSystem();
    this.resize();
    this.fit();
    if (this.deviations) {
      this.deviationsPanel.face();
      this.fit();
    }
    if (this.measures?.main) {
      const [a, b] = this.measures.main;
      this.view.layAcross(b.sub(a));
      this.fit();
    }
    if (this.slice) {
      this.slicePanel.lay();
      this.fit();
      this.slicePanel.show(this.slicePanel.example(), true);
    } else if (this.answers && !this.live) {
      this.answersPanel.selectExample();
    }
    new ResizeObserver(() => this.resize()).observe(this.stage);
  }

  get colours() {
    // A slice is light near the surface in both themes, and so is what lies under answers.
    const { live, selected } = THEMES.light;
    return this.slice ? { ...THEMES[this.theme], live, selected } : THEMES[this.theme];
  }

  get slicePart() {
    return this.slicePanel.part;
  }

  // What has the latest answer: live queries once they answer, unless the slice has something else than distances.
  get asked() {
    if (this.live?.shown && !this.data.lists) return this.live;
    return this.slicePanel ?? this.answersPanel;
  }

  // Returns the position of the example that a page shows before anything was asked: on the slice in the middle of the
  // picture, or where nothing hides it: in front of the middle of the scene, at a corner of what it covers in the picture.
  example() {
    return this.slicePanel?.example() ?? this.view.corner(EXAMPLE_GAP);
  }

  addLayer(name, layer, drawn) {
    this[name] = layer;
    this.world.add(layer[drawn]);
  }

  // ---- colours

  setTheme(theme) {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.renderer.setClearColor(this.colours.background);
    for (const name of ["surface", "second"]) document.documentElement.style.setProperty(`--${name}`, this.colours[name]);
    for (const layer of [this.scene, this.cells, this.answers, this.slice, this.measures, this.deviations]) {
      layer?.setTheme(theme, this.colours);
    }
    this.overlay.setTheme(this.colours);
    this.live?.redraw();
    this.figures.forEach((figure) => figure.update());
    this.slicePanel?.showLegend();
    this.deviationsPanel?.showLegend();
    this.draw();
  }

  toggleTheme() {
    this.isThemeChosen = true;
    this.setTheme(this.theme === "dark" ? "light" : "dark");
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

  // ---- the picture

  draw() {
    this.painter.draw(() => {
      this.cut();
      this.overlay.update();
    });
  }

  // Cuts the scene open at the slice, on the side of the viewer.
  cut() {
    const isCut = !!this.slice && this.slice.mesh.visible && this.isCut !== false;
    const towards = this.camera.position.clone().sub(this.controls.target);
    const plane = this.slice?.plane(this.slice && towards.getComponent(this.slice.axis) < 0 ? -1 : 1);
    this.scene.cut(isCut ? plane : null);
    const isOutlined = !!this.slice?.mesh.visible && this.isOutlined !== false;
    this.scene.setOutline(isOutlined, this.colours);
    // A signed field has a line at zero.
    const at = isOutlined && !this.slice.scale.isDiverging ? this.slice.at : null;
    const cut = `${at} ${this.slice?.axis} ${this.scene.version}`;
    if (this.slice && this.sectioned !== cut) this.scene.setSection(this.slice.axis, at);
    this.sectioned = cut;
    this.painter.plane = this.slice?.mesh.visible ? plane : null;
    this.answers?.fadeAwayFrom(this.painter.plane, this.data.frame.radius);
  }

  resize() {
    const { clientWidth, clientHeight } = this.stage;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.view.setSize(clientWidth, clientHeight);
    this.draw();
  }

  fit(preset) {
    if (this.slice) this.view.corners = this.slice.mesh.visible ? this.slice.corners : [];
    this.view.fit(preset);
    this.draw();
  }

  turn(around, up, factor) {
    this.view.turn(around, up, factor);
    this.draw();
  }

  pan(right, up) {
    this.view.pan(right, up);
    this.draw();
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

  // Reads what is under the pointer into the tooltip, once a frame.
  point(event) {
    this.pointed = event;
    if (this.isPointing) return;
    this.isPointing = true;
    requestAnimationFrame(() => {
      this.isPointing = false;
      const text = this.answerTip(this.pointed) ?? this.deviationsPanel?.tip(this.pointed) ??
        (this.asked === this.live ? this.liveTip() : this.slicePanel?.read(this.pointed));
      this.overlay.showTip(this.pointed, text ?? "");
    });
  }

  answerTip(event) {
    if (!this.answers || this.answers.length > MAX_POINTED) return undefined;
    const i = this.pick(event);
    if (this.answers.pointed !== i) {
      this.answers.point(i, this.colours);
      this.draw();
    }
    if (i < 0) return undefined;
    return `query ${i}: ${this.answers.isAnswered(i) ? this.inWords(this.answers.values[i], !!this.answers.signed) : "no answer"}`;
  }

  liveTip() {
    const answer = this.live?.isFollowing && this.live.group.visible && this.live.shown?.answers?.[0];
    if (!answer) return undefined;
    return this.live.inWords(answer);
  }

  // Returns a value as a text: a distance, or a signed distance as a distance and a side.
  inWords(value, isSigned) {
    return inWords(value, isSigned, this.unit);
  }

  isRounding(length) {
    return length < ROUNDING * this.data.frame.radius * this.frame.scale;
  }

  // The number of decimals of all coordinates: they are shown to a hundred thousandth of the radius of the scene.
  get decimals() {
    return Math.max(0, Math.min(100, 5 - Math.floor(Math.log10(this.data.frame.radius * this.frame.scale))));
  }

  // Returns the coordinates of a position in the frame, with as many decimals as are shown.
  coordinates(position) {
    return this.frame.coordinates(position).map((x) => Number(x.toFixed(this.decimals)));
  }

  // Makes an element that shows a coordinate, with all digits in copies.
  coordinate(x) {
    const { decimals } = this;
    const shown = number(x);
    // Numbers of other sizes have exponents.
    if (decimals > 12 || !(Math.abs(x) < 1e12)) return shown;
    const digits = { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
    shown.textContent = (Number(x.toFixed(decimals)) + 0).toLocaleString("en-US", digits);
    return shown;
  }

  // Makes an element that shows the coordinates of a point.
  place(coordinates) {
    return element("span", {}, ...numbers(coordinates, (x) => this.coordinate(x)));
  }

  // Opens or closes the list of keys.
  showHelp() {
    this.help.open = !this.help.open;
    if (this.help.open) {
      reveal(this.help);
      this.help.scrollIntoView({ block: "nearest" });
    }
  }

  // Starts live queries.
  startLive() {
    this.live.start().then(() => (document.documentElement.dataset.live = "ready"), (error) => {
      this.live.say(`Live queries do not work here: ${error.message}.`);
      document.documentElement.dataset.live = "failed";
      console.error(error);
    });
  }
}

// Returns the renderer. Without WebGL it draws nothing, and the panel has all numbers all the same.
function makeRenderer(canvas) {
  try {
    // Edges are smooth once the view rests, which makes moving pictures faster. The browser need not blend an opaque
    // picture with what is behind it.
    const context = canvas.getContext("webgl2", { alpha: false, antialias: false, preserveDrawingBuffer: true });
    return new three.WebGLRenderer({ canvas, context });
  } catch {
    document.getElementById("failure").textContent =
      "The picture cannot be drawn, because this browser has no WebGL. The panel has all numbers.";
    const nothing = () => {};
    return { isAbsent: true, render: nothing, setSize: nothing, setPixelRatio: nothing, setClearColor: nothing };
  }
}

readData().then((data) => {
  // Tests read what is shown from here.
  window.viewer = new Viewer(data);
  document.documentElement.dataset.ready = "true";
  if (window.viewer.live) window.viewer.startLive();
}).catch((error) => {
  document.getElementById("failure").textContent = `The page cannot be shown: ${error.message}.`;
  document.documentElement.dataset.ready = "failed";
  console.error(error);
});
