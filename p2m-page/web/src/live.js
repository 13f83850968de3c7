// Live queries: the library itself, compiled to WebAssembly, answers them in the page.

import * as three from "three";
import { KINDS, drawAnswer, empty, featureName, featureOf, line, marker } from "./answers.js";
import { checkbox, count, element, fillList, namedRow, short, tableHead } from "./text.js";

// The indexes in the order of their numbers in the module.
const BACKENDS = ["AABB tree", "k-DOP tree", "octree", "P2M index"];
// The milliseconds for which the queries of an index are measured, after as long a time in which the browser finds out
// what it has to optimise.
const MEASURED_TIME = 100;

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

  // Loads the scene and builds the indexes one after the other. The page is drawn in between.
  async start() {
    const { coordinates, sizes, indices, module } = this.live;
    const { instance } = await WebAssembly.instantiate(module, {});
    this.module = instance.exports;
    const write = (number, array) => {
      const address = this.module.p2m_reserve(number, array.length);
      new array.constructor(this.module.memory.buffer, address, array.length).set(array);
    };
    [coordinates, sizes, indices].forEach((array, number) => write(number, array));
    if (this.module.p2m_load() === 0) throw new Error("the scene of the page is damaged");
    this.rows = [];
    for (const [number, name] of BACKENDS.entries()) {
      this.say(`Building the ${name} ...`);
      await painted();
      const start = performance.now();
      const bytes = this.module.p2m_build(number);
      const time = performance.now() - start;
      if (bytes > 0) this.rows.push({ number, name, bytes, time });
    }
    for (const row of this.rows) {
      this.say(`Measuring the ${row.name} ...`);
      await painted();
      this.measure(row.number);
      row.rate = this.measure(row.number);
    }
    this.farScale = this.module.p2m_build_far();
    this.inputs.forEach((input) => (input.disabled = false));
    this.farBox.disabled = this.farScale === 0;
    this.say(this.farScale === 0 ? "f32 cannot represent this scene far from the origin." : "");
    this.setQuery(this.frame.coordinates([0, 0, 0]));
  }

  // Returns the number of queries a second at points around the scene.
  measure(number) {
    let [answered, size, start, time] = [0, 64, performance.now(), 0];
    while (time < MEASURED_TIME) {
      answered += this.module.p2m_answer_many(number, size);
      time = performance.now() - start;
      size *= 2;
    }
    return answered / (time / 1000);
  }

  makePanel(add) {
    this.message = element("p", { id: "live-message", role: "status" });
    this.inputs = [0, 1, 2].map((axis) => element("input", {
      type: "number", step: "any", disabled: true, id: `live-${"xyz"[axis]}`,
      "aria-label": `${"xyz"[axis]} of the query`,
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
      element("p", { class: "coordinates" }, ...this.inputs),
      this.farText, this.answerText, this.workTable, this.speedTable);
  }

  say(text) {
    this.message.textContent = text;
  }

  setFar(isFar) {
    this.isFar = isFar;
    this.worst = [0, 0];
    this.farBox.checked = isFar;
    this.redraw();
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
    this.redraw();
  }

  readInputs() {
    const query = this.inputs.map((input) => (input.value === "" ? NaN : Number(input.value)));
    if (!query.every(Number.isFinite)) return;
    this.query = query;
    this.redraw();
  }

  // The arrow keys move a coordinate by a hundredth of the scene.
  stepInput(event, axis) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction || !this.query) return;
    event.preventDefault();
    const step = (this.viewer.data.frame.radius * this.frame.scale) / 100;
    this.setQuery(this.query.map((x, k) => (k === axis ? x + direction * step : x)));
  }

  // Returns the values of the answer of an index, or `null` if there is none.
  ask(number, query) {
    if (this.module.p2m_query(number, ...query) === 0) return null;
    const values = [...new Float64Array(this.module.memory.buffer, this.module.p2m_answer(), 10)];
    const [x, y, z, distance, lowerBound, primitive, feature, nodes, packets, primitives] = values;
    return { point: [x, y, z], distance, lowerBound, primitive, feature, work: [nodes, packets, primitives] };
  }

  askFar(query) {
    if (this.module.p2m_query_far(...query) === 0) return null;
    const values = [...new Float64Array(this.module.memory.buffer, this.module.p2m_answer(), 12)];
    const part = (at) => ({ point: values.slice(at, at + 3), distance: values[at + 3] });
    const [exact, p2m, ordinary] = [0, 4, 8].map(part);
    return { query: exact.point, distance: exact.distance, p2m, ordinary };
  }

  // Answers the query, draws the answer and shows its values.
  redraw() {
    if (!this.query) return;
    empty(this.group);
    const answers = this.rows.map(({ number }) => this.ask(number, this.query));
    // The first answer stands for all, because all have the same bits, which is compared here.
    const [answer] = answers;
    const key = (a) => a && [...a.point, a.distance, a.primitive, a.feature].join();
    const isSame = answers.every((other) => key(other) === key(answer));
    this.answer = answer;
    if (!this.isFar) this.farText.replaceChildren();
    if (this.isFar) this.drawFar();
    else if (answer) this.draw(answer);
    this.showAnswer(answer, isSame);
    // Far from the origin the query is another one, because it is rounded.
    this.answerText.hidden = this.workTable.hidden = this.isFar;
    this.showWork(answers);
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
    drawAnswer(this.group, this.at(this.query), this.at(point), vertices, featureOf(feature), radius, colours);
  }

  showAnswer(answer, isSame) {
    const rows = [];
    const row = (name, value) => rows.push([name, value]);
    row("query", this.query.join(",\n"));
    if (answer) {
      row("closest point", answer.point.join(",\n"));
      row("distance", answer.distance);
      row("lower bound", answer.lowerBound);
      row("primitive", `${KINDS[this.live.sizes[answer.primitive]]} ${answer.primitive}`);
      row("feature", featureName(answer.feature));
      const indexes = `the ${this.rows.length} indexes`;
      row("agreement", isSame ? `${indexes} give equal answers, bit for bit` : `${indexes} differ`);
    } else {
      row("answer", "none");
    }
    fillList(this.answerText, rows);
  }

  showWork(answers) {
    fill(this.workTable, "Work of this query", ["index", "nodes", "packets", "evaluated"],
      this.rows.map(({ name }, i) => [name, ...(answers[i] ? answers[i].work : ["", "", ""])]));
    fill(this.speedTable, "Speed in this browser, at points around the scene", ["index", "queries/s", "build", "size"],
      this.rows.map(({ name, rate, time, bytes }) =>
        [name, count(Number(rate.toPrecision(2))), `${short(time)} ms`, `${count(Math.ceil(bytes / 1000))} kB`]));
  }

  // Draws the answers of a query far from the origin, and shows their errors.
  drawFar() {
    const far = this.askFar(this.query);
    this.far = far;
    if (!far) return;
    const { colours } = this.viewer;
    const query = this.at(far.query);
    drawAnswer(this.group, query, this.at(far.p2m.point), [], null, 0, colours);
    const foot = this.at(far.ordinary.point);
    this.group.add(line([query, foot], colours.feature), marker(foot, colours.feature, 6));
    const errors = [far.p2m, far.ordinary].map(({ distance }) => Math.abs(distance - far.distance));
    this.worst = this.worst.map((error, i) => Math.max(error, errors[i]));
    const { unit } = this.viewer;
    const named = (name, colour) => element("span", {}, element("span", { style: `color: ${colour}` }, "● "), name);
    const table = element("table", { id: "live-far-table" });
    fill(table, "Distances in f32, and their errors", ["", "distance", "error", "largest"], [
      [named("p2m", colours.selected), far.p2m.distance, errors[0], this.worst[0]],
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

// Waits until the page was drawn. A page that is not visible is not drawn, so it waits for a moment only.
function painted() {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, 100);
    requestAnimationFrame(() => setTimeout(() => {
      clearTimeout(timer);
      resolve();
    }, 0));
  });
}
