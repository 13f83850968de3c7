// Live queries: the library itself, compiled to WebAssembly, answers them in the page. It runs in a worker, so the page
// can be used meanwhile, and queries are answered as soon as the first index is built.

import * as three from "three";
import { KINDS, drawAnswer, empty, featureName, featureOf, line, marker } from "./answers.js";
import { checkbox, count, element, fillList, namedRow, short, tableHead } from "./text.js";

// The indexes in the order of their numbers in the module.
const BACKENDS = ["AABB tree", "k-DOP tree", "octree", "P2M index"];
export class LiveQueries {
  // `viewer` has the scene, the camera and the picture; `live` has the bytes of the module and the exact scene.
  constructor(viewer, live) {
    this.viewer = viewer;
    this.live = live;
    this.frame = viewer.frame;
    this.group = new three.Group();
    this.isFollowing = true;
    this.isFar = false;
    this.hasSphere = true;
    // The part of the radius of the scene by which the plane is nearer to the viewer than the centre.
    this.depth = 0;
    this.first = [];
    let at = 0;
    for (const size of live.sizes) {
      this.first.push(at);
      at += size;
    }
  }

  // Builds the indexes one after the other. An index whose build fails, because the browser has too little memory, ends
  // its worker, so the others are built by a new one.
  async start() {
    this.failed = [];
    while (!(await this.buildAll()));
    const missing = this.failed.map(({ name, reason }) => `The ${name} could not be built: ${reason}.`);
    if (this.farScale === 0) missing.push("f32 cannot represent this scene far from the origin.");
    this.say(missing.join(" "));
    this.farBox.disabled = this.farScale === 0;
  }

  // Builds the indexes that have not failed. The result says whether all could be built.
  async buildAll() {
    this.worker?.terminate();
    this.worker = startWorker();
    // Promises of the calls that are not answered yet.
    const calls = [];
    this.calls = calls;
    this.worker.onmessage = ({ data }) => settle(calls.shift(), data);
    this.worker.onerror = (event) => settle(calls.shift(), { error: event.message });
    this.rows = [];
    this.isAsked = this.isChanged = false;
    if (!(await this.call("load", this.live))) throw new Error("the scene of the page is damaged");
    for (const [number, name] of BACKENDS.entries()) {
      if (this.failed.some((failed) => failed.number === number)) continue;
      this.say(`Building the ${name} ...`);
      try {
        const { bytes, time } = await this.call("build", number);
        if (bytes > 0) this.rows.push({ number, name, bytes, time });
      } catch (error) {
        this.failed.push({ number, name, reason: error.message });
        return false;
      }
      if (this.query) this.ask();
      else this.allowQueries();
    }
    for (const row of this.rows) {
      this.say(`Measuring the ${row.name} ...`);
      row.rate = await this.call("measure", row.number);
      this.showSpeed();
    }
    this.farScale = await this.call("buildFar");
    return true;
  }

  // Calls a function of the worker, which answers in the order of the calls.
  call(name, ...values) {
    return new Promise((resolve, reject) => {
      this.calls.push({ resolve, reject });
      this.worker.postMessage({ name, values });
    });
  }

  allowQueries() {
    this.inputs.forEach((input) => (input.disabled = false));
    this.setQuery(this.frame.coordinates([0, 0, 0]));
  }

  makePanel(add) {
    this.message = element("p", { id: "live-message", role: "status" });
    this.inputs = [0, 1, 2].map((axis) => element("input", {
      type: "number", step: "any", disabled: true, id: `live-${"xyz"[axis]}`,
      oninput: () => this.readInputs(), onkeydown: (event) => this.stepInput(event, axis),
    }));
    this.followBox = checkbox("the query follows the mouse", true, (on) => (this.isFollowing = on), "live-follow");
    this.farLabel = checkbox("compare f32 arithmetic far from the origin", false, (on) => this.setFar(on), "live-far");
    this.farBox = this.farLabel.firstChild;
    this.farBox.disabled = true;
    const depth = element("input", {
      type: "range", min: -1, max: 1, step: 0.01, value: 0, "aria-label": "depth of the plane of the mouse",
      oninput: () => { this.depth = Number(depth.value); },
    });
    this.answerText = element("dl", { id: "live-answer", "aria-live": "polite" });
    this.workTable = element("table", { id: "live-work" });
    this.speedTable = element("table", { id: "live-speed" });
    this.farText = element("div", { id: "live-far-text" });
    add("Live query", "live", this.message,
      element("div", { class: "boxes" }, this.followBox, this.farLabel),
      element("p", { class: "small" }, "The mouse moves the query in a plane that faces you. Its depth: ", depth),
      element("fieldset", { class: "coordinates" }, element("legend", {}, "Query"),
        ...this.inputs.map((input, axis) => element("label", {}, "xyz"[axis], input))),
      this.farText, this.answerText, this.workTable, this.speedTable);
  }

  say(text) {
    this.message.textContent = text;
  }

  setFar(isFar) {
    this.isFar = isFar;
    this.worst = [0, 0];
    this.farBox.checked = isFar;
    this.ask();
  }

  toggle() {
    this.isFollowing = !this.isFollowing;
    this.followBox.firstChild.checked = this.isFollowing;
  }

  // Moves the query to where the pointer is in the plane.
  follow(event) {
    if (!this.isFollowing || !this.query || event.buttons !== 0) return;
    const { camera, controls, data } = this.viewer;
    const caster = this.viewer.pointer(event).caster();
    const towards = camera.position.clone().sub(controls.target).normalize();
    const through = controls.target.clone().addScaledVector(towards, this.depth * data.frame.radius);
    const plane = new three.Plane().setFromNormalAndCoplanarPoint(towards, through);
    const hit = caster.ray.intersectPlane(plane, new three.Vector3());
    if (hit) this.setQuery(this.frame.coordinates(hit.toArray()));
  }

  setQuery(query) {
    this.query = query;
    query.forEach((x, k) => (this.inputs[k].value = x));
    this.ask();
  }

  readInputs() {
    const query = this.inputs.map((input) => (input.value === "" ? NaN : Number(input.value)));
    this.query = query;
    this.ask();
  }

  // The arrow keys move a coordinate by a hundredth of the scene.
  stepInput(event, axis) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction || !this.query) return;
    event.preventDefault();
    const step = (this.viewer.data.frame.radius * this.frame.scale) / 100;
    this.setQuery(this.query.map((x, k) => (k === axis ? x + direction * step : x)));
  }

  // Asks the worker. While it answers, only the newest of further queries is kept.
  async ask() {
    this.isChanged = true;
    if (this.isAsked || !this.query) return;
    this.isAsked = true;
    while (this.isChanged) {
      this.isChanged = false;
      const { query, isFar, rows } = this;
      const isQuery = query.every(Number.isFinite);
      try {
        const answers = isQuery ? await this.call("query", rows.map(({ number }) => number), query) : [];
        const far = isQuery && isFar ? await this.call("queryFar", query) : null;
        this.answered = { query, isQuery, rows: [...rows], answers, far };
      } catch {
        // The worker has ended, and its successor is asked again.
        return;
      }
      this.redraw();
    }
    this.isAsked = false;
  }

  // Draws the last answer and shows its values.
  redraw() {
    if (!this.answered) return;
    const { isQuery, rows, answers, far } = this.answered;
    empty(this.group);
    // The first answer stands for all, because all have the same bits, which is compared here.
    const [answer] = answers;
    const key = (a) => a && [...a.point, a.distance, a.primitive, a.feature].join();
    const isSame = answers.every((other) => key(other) === key(answer));
    this.answer = answer;
    if (!this.isFar) this.farText.replaceChildren();
    if (this.isFar) this.drawFar(far);
    else if (answer) this.draw(answer);
    this.showAnswer(answer, isQuery, isSame);
    // Far from the origin the query is another one, because it is rounded.
    this.answerText.hidden = this.workTable.hidden = this.isFar;
    fill(this.workTable, "Work of this query", ["index", "nodes", "packets", "evaluated"],
      rows.map(({ name }, i) => [name, ...(answers[i] ? answers[i].work : ["", "", ""])]));
    this.showSpeed();
    this.viewer.draw();
  }

  // Returns a position in the frame of the picture.
  at(point) {
    return new three.Vector3(...this.frame.positions(point));
  }

  draw({ point, lowerBound, primitive, feature }) {
    const first = this.first[primitive];
    const vertices = [...this.live.indices.subarray(first, first + this.live.sizes[primitive])]
      .map((i) => this.at(this.live.coordinates.subarray(3 * i, 3 * i + 3)));
    const radius = this.hasSphere ? lowerBound / this.frame.scale : 0;
    const { colours } = this.viewer;
    drawAnswer(this.group, this.at(this.answered.query), this.at(point), vertices, featureOf(feature), radius,
      { selected: colours.live, feature: colours.feature });
  }

  showAnswer(answer, isQuery, isSame) {
    const rows = [];
    const row = (name, value) => rows.push([name, value]);
    row("query", isQuery ? this.answered.query.join(",\n") : "Each coordinate has to be a number.");
    if (!isQuery) {
      // There is nothing to answer.
    } else if (answer) {
      row("closest point", answer.point.join(",\n"));
      row("distance", answer.distance);
      row("lower bound", answer.lowerBound);
      row("primitive", `${KINDS[this.live.sizes[answer.primitive]]} ${answer.primitive}`);
      row("feature", featureName(answer.feature));
      const indexes = `the ${this.answered.rows.length} indexes`;
      if (this.answered.rows.length > 1) {
        row("agreement", isSame ? `${indexes} give equal answers, bit for bit` : `${indexes} differ`);
      }
    } else {
      row("answer", "none");
    }
    fillList(this.answerText, rows);
  }

  showSpeed() {
    const rate = (row) => (row.rate === undefined ? "" : count(Number(row.rate.toPrecision(2))));
    fill(this.speedTable, "Speed in this browser, at points around the scene", ["index", "queries/s", "build", "size"],
      this.rows.map((row) =>
        [row.name, rate(row), `${short(row.time)} ms`, `${count(Math.ceil(row.bytes / 1000))} kB`]));
  }

  // Draws the answers of a query far from the origin, and shows their errors.
  drawFar(far) {
    this.far = far;
    if (!far) return;
    const { colours } = this.viewer;
    const query = this.at(far.query);
    drawAnswer(this.group, query, this.at(far.p2m.point), [], null, 0, { ...colours, selected: colours.live });
    const foot = this.at(far.ordinary.point);
    this.group.add(line([query, foot], colours.feature), marker(foot, colours.feature, 6));
    const errors = [far.p2m, far.ordinary].map(({ distance }) => Math.abs(distance - far.distance));
    this.worst = this.worst.map((error, i) => Math.max(error, errors[i]));
    const { unit } = this.viewer;
    const named = (name, colour) => element("span", {}, element("span", { style: `color: ${colour}` }, "● "), name);
    const table = element("table", { id: "live-far-table" });
    fill(table, "Distances in f32, and their errors", ["", "distance", "error", "largest"], [
      [named("p2m", colours.live), far.p2m.distance, errors[0], this.worst[0]],
      [named("ordinary f32", colours.feature), far.ordinary.distance, errors[1], this.worst[1]],
    ].map(([name, ...values]) => [name, ...values.map(short)]));
    const scaled = this.farScale === 1 ? "" : `, scaled by ${short(this.farScale)},`;
    this.farText.replaceChildren(
      element("p", { class: "small" }, `The scene${scaled} was moved a million units away from the origin, and its ` +
        "vertices and the query were rounded to f32 there, in which coordinates are 1/16 of a unit apart. The true " +
        `distance of the rounded query from the rounded scene is ${short(far.distance)} ${unit}. Ordinary arithmetic ` +
        "rounds the closest point to such coordinates before it measures, so its distance jumps while the query " +
        "moves. p2m measures before it rounds, and gives the closest point by the weights of the vertices."),
      table);
  }
}

// Fills a table. The first cell of each row names it.
function fill(table, caption, head, rows) {
  table.replaceChildren(element("caption", {}, caption), tableHead(head),
    element("tbody", {}, ...rows.map((row) => namedRow(...row))));
}

// Starts the worker, whose script is part of this one, because a page that is a file may not read others.
function startWorker() {
  const address = URL.createObjectURL(new Blob([WORKER_SCRIPT], { type: "text/javascript" }));
  return new Worker(address);
}

// Ends the promise of a call of the worker by what the worker says.
function settle(call, { result, error }) {
  if (error === undefined) call?.resolve(result);
  else call?.reject(new Error(error));
}
