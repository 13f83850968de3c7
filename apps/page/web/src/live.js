// Live queries: the npm package of p2m, in `bindings/js`, answers them in the page. Each index is in a worker of its
// own, so the page can be used while it is built, and the indexes that are ready answer meanwhile.

import * as three from "three";
import { answerRows, drawAnswer, empty, explainedWords, featureOf, line, marker } from "./answers.js";
import { checkbox, count, element, fillList, fillTable, short } from "./text.js";

// The indexes in the order of their numbers in the worker.
const BACKENDS = ["AABB tree", "k-DOP tree", "octree", "P2M index"];
// The number of primitives up to which all indexes are built when the page is opened. Above it the first one is, and the
// others once their table is opened.
const MAX_COMPARED = 10_000;

export class LiveQueries {
  // `viewer` has the scene, the camera and the picture; `scene` has the bytes of the module and the exact scene.
  constructor(viewer, scene) {
    this.viewer = viewer;
    this.scene = scene;
    this.frame = viewer.frame;
    this.group = new three.Group();
    this.isFar = false;
    this.hasSphere = true;
    // The part of the radius of the scene by which the plane is nearer to the viewer than the centre.
    this.depth = 0;
    // For each primitive the place of its first vertex among the indices.
    this.firstIndices = [];
    let next = 0;
    for (const size of scene.sizes) {
      this.firstIndices.push(next);
      next += size;
    }
    // Triangles have sides.
    this.hasSides = scene.sizes.every((size) => size === 3);
    // The indexes that are ready.
    this.indexes = [];
    this.failures = [];
  }

  // Builds the indexes that are not built yet, or the first one if the scene is large, at the same time. Then measures them
  // one after the other.
  async start(isComplete = this.scene.sizes.length <= MAX_COMPARED) {
    if (this.scene.sizes.length === 0) {
      this.say("The scene is empty.");
      return;
    }
    this.isComplete = isComplete;
    const wanted = BACKENDS.slice(0, isComplete ? undefined : 1).filter((name) => !this.indexes.some((index) => index.name === name));
    const building = new Set(wanted);
    const showStage = () => this.say(building.size > 0 ? `Building: ${[...building].join(", ")} ...` : "");
    showStage();
    await Promise.all(wanted.map(async (name) => {
      const index = await this.build(BACKENDS.indexOf(name), name);
      building.delete(name);
      if (index) this.add(index);
      showStage();
    }));
    if (this.indexes.length === 0) throw new Error(this.failures.join(" ") || "no index could be built");
    for (const index of this.indexes.filter(({ name }) => wanted.includes(name))) {
      this.say(`Measuring the ${index.name} ...`);
      index.rate = await this.ask(index, "measure", index.number);
      this.showSpeed();
    }
    [this.farIndex] = this.indexes;
    this.farScale = (this.farIndex && (await this.ask(this.farIndex, "buildFar"))) ?? 0;
    this.farBox.disabled = this.farScale === 0;
    if (this.farScale === 0) this.failures.push("f32 cannot represent this scene far from the origin.");
    this.say(this.failures.join(" "));
  }

  // Builds an index in a worker. The result is `null` if this index is not built for such a scene, or if the browser
  // has too little memory.
  async build(number, name) {
    const worker = new RemoteModule();
    try {
      await worker.call("load", this.scene);
      const { bytes, time } = await worker.call("build", number);
      if (bytes > 0) return { number, name, worker, bytes, time };
    } catch (error) {
      this.failures.push(`The ${name} could not be built: ${error.message}.`);
    }
    worker.end();
    return null;
  }

  // Adds an index that is ready.
  add(index) {
    this.indexes.push(index);
    this.indexes.sort((a, b) => a.number - b.number);
    if (this.query) {
      this.answerQuery();
      return;
    }
    this.inputs.forEach((input) => (input.disabled = false));
    this.setQuery(this.viewer.coordinates(this.viewer.example().toArray()), true);
  }

  // Calls a function of the worker of an index. The result is `null` if it fails, which is said.
  async ask(index, name, ...values) {
    try {
      return await index.worker.call(name, ...values);
    } catch (error) {
      this.failures.push(`The ${index.name} has failed: ${error.message}.`);
      this.say(this.failures.join(" "));
      this.indexes = this.indexes.filter((other) => other !== index);
      if (this.farIndex === index) this.farIndex = undefined;
      return null;
    }
  }

  makePanel(add) {
    this.message = element("p", { id: "live-message", role: "status" });
    this.inputs = [0, 1, 2].map((axis) => element("input", {
      type: "number", step: "any", disabled: true, id: `live-${"xyz"[axis]}`,
      oninput: () => this.readInputs(), onkeydown: (event) => this.stepInput(event, axis),
    }));
    const follow = checkbox("the query follows the mouse", true, (on) => this.setFollowing(on), "live-follow");
    const far = checkbox("compare f32 arithmetic far from the origin", false, (on) => this.setFar(on), "live-far");
    [this.followBox, this.farBox] = [follow.firstChild, far.firstChild];
    this.farBox.disabled = true;
    const depth = element("input", {
      type: "range", min: -1, max: 1, step: 0.01, value: 0, "aria-label": "depth of the query",
      oninput: () => this.setDepth(Number(depth.value)),
    });
    const keep = "Point anywhere in the picture to ask there. Click to keep the answer, and elsewhere to ask again.";
    this.answerText = element("dl", { id: "live-answer" });
    this.workTable = element("table", { id: "live-work" });
    this.speedTable = element("table", { id: "live-speed" });
    this.farText = element("div", { id: "live-far-text" });
    const what = this.hasSides ? "Distance and side at a point" : "Distance at a point";
    const plane = this.viewer.slice ? "The query lies on the slice, and beside it in a plane that faces you"
      : "The query moves in a plane that faces you";
    const more = element("details", { id: "live-more" }, element("summary", {}, "Indexes: their work and their speed"), far,
      this.farText, this.workTable, this.speedTable);
    more.addEventListener("toggle", () => more.open && this.isComplete === false && this.start(true));
    add(what, "live", this.message, this.answerText, explainedWords(), element("p", { class: "small" }, keep),
      element("fieldset", { class: "coordinates" }, element("legend", {}, "Query"),
        ...this.inputs.map((input, axis) => element("label", {}, "xyz"[axis], input))),
      element("div", { class: "boxes" }, follow), element("p", { class: "small" }, `${plane}. Its depth: `, depth), more);
    this.setFollowing(true);
  }

  // Returns the label of the answer in the picture.
  labels() {
    const answer = !this.isFar && this.group.visible && this.shown?.answers?.[0];
    if (!answer) return [];
    return [{ position: this.at(this.shown.query), text: this.inWords(answer), kind: "important" }];
  }

  inWords({ distance, signed }) {
    return this.viewer.inWords(signed ?? distance, signed !== undefined);
  }

  say(text) {
    this.message.textContent = text;
  }

  setFar(isFar) {
    this.isFar = isFar;
    this.largestErrors = [0, 0];
    this.farBox.checked = isFar;
    this.answerQuery();
  }

  // Lets the query follow the mouse, or keeps what is typed. The mouse moves all the time, so screen readers read only
  // answers to what is typed.
  setFollowing(isFollowing) {
    this.isFollowing = isFollowing;
    this.followBox.checked = isFollowing;
    this.answerText.setAttribute("aria-live", isFollowing ? "off" : "polite");
  }

  // Returns the direction from the centre of the picture to the viewer.
  towardsViewer() {
    const { camera, controls } = this.viewer;
    return camera.position.clone().sub(controls.target).normalize();
  }

  // Moves the query together with its plane.
  setDepth(depth) {
    const step = (depth - this.depth) * this.viewer.data.frame.radius * this.frame.scale;
    this.depth = depth;
    const towards = this.towardsViewer().toArray();
    if (this.query) this.setQuery(this.query.map((x, k) => x + step * towards[k]));
  }

  // Moves the query with the pointer.
  follow(event) {
    if (this.isFollowing && event.buttons === 0) this.askAt(event);
  }

  // Asks where the pointer is, and keeps the answer when it moves on.
  keep(event) {
    this.setFollowing(false);
    this.askAt(event);
  }

  // Moves the query to where the pointer is on the slice, or else in the plane.
  askAt(event) {
    if (!this.group.visible || !this.query) return;
    const { controls, data, slice } = this.viewer;
    const caster = this.viewer.pointer(event).caster();
    const [onSlice] = slice?.mesh.visible ? caster.intersectObject(slice.mesh) : [];
    if (onSlice) {
      this.setQuery(this.frame.coordinates(onSlice.point.toArray()));
      return;
    }
    const towards = this.towardsViewer();
    const through = controls.target.clone().addScaledVector(towards, this.depth * data.frame.radius);
    const plane = new three.Plane().setFromNormalAndCoplanarPoint(towards, through);
    const hit = caster.ray.intersectPlane(plane, new three.Vector3());
    if (hit) this.setQuery(this.frame.coordinates(hit.toArray()));
  }

  setQuery(query, isExample = false) {
    Object.assign(this, { query, isExample });
    query.forEach((x, k) => (this.inputs[k].value = x));
    this.answerQuery();
  }

  readInputs() {
    this.setFollowing(false);
    this.isExample = false;
    this.query = this.inputs.map((input) => (input.value === "" ? NaN : Number(input.value)));
    this.answerQuery();
  }

  // The arrow keys move a coordinate by a hundredth of the scene.
  stepInput(event, axis) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction || !Number.isFinite(this.query?.[axis])) return;
    event.preventDefault();
    this.setFollowing(false);
    const step = (this.viewer.data.frame.radius * this.frame.scale) / 100;
    this.setQuery(this.query.map((x, k) => (k === axis ? x + direction * step : x)));
  }

  // Lets all indexes answer the query. While they do, only the newest of further queries is kept.
  async answerQuery() {
    this.isChanged = true;
    if (this.isBusy || !this.query) return;
    this.isBusy = true;
    while (this.isChanged) {
      this.isChanged = false;
      const { query, isFar, indexes } = this;
      const isValid = query.every(Number.isFinite);
      const answers = isValid
        ? await Promise.all(indexes.map((index) => this.ask(index, "query", index.number, query))) : [];
      if (answers[0] && this.hasSides) {
        answers[0].signed = (await this.ask(indexes[0], "signed", indexes[0].number, query)) ?? undefined;
      }
      const far = isValid && isFar && this.farIndex ? await this.ask(this.farIndex, "queryFar", query) : null;
      this.shown = { query, isValid, indexes, answers, far };
      this.redraw();
    }
    this.isBusy = false;
  }

  // Draws the last answer and shows its values.
  redraw() {
    if (!this.shown) return;
    const { indexes, answers, far } = this.shown;
    empty(this.group);
    // Far from the origin the query is another one, because it is rounded.
    this.answerText.hidden = this.workTable.hidden = this.isFar;
    this.farText.replaceChildren();
    if (this.isFar && far) this.drawFar(far);
    // The first answer is drawn. The panel says whether the others are equal.
    else if (!this.isFar && answers[0]) this.draw(answers[0]);
    this.showAnswer();
    const { viewer } = this;
    if (viewer.slicePanel && viewer.asked === this) viewer.slicePanel.value.hidden = true;
    fillTable(this.workTable, "Work of this query", ["index", "nodes", "packets", "evaluated"],
      indexes.map(({ name }, i) => [name, ...(answers[i] ? answers[i].work : ["", "", ""])]));
    this.showSpeed();
    this.viewer.draw();
  }

  // Returns a position in the frame of the picture.
  at(point) {
    return new three.Vector3(...this.frame.positions(point));
  }

  draw({ point, lowerBound, primitive, feature }) {
    const { indices, sizes, coordinates } = this.scene;
    const first = this.firstIndices[primitive];
    const vertices = [...indices.subarray(first, first + sizes[primitive])]
      .map((i) => this.at(coordinates.subarray(3 * i, 3 * i + 3)));
    // The sphere of an example would cover much before anybody asked for it.
    const radius = this.hasSphere && !this.isExample ? lowerBound / this.frame.scale : 0;
    const { colours } = this.viewer;
    drawAnswer(this.group, this.at(this.shown.query), this.at(point), vertices, featureOf(feature), radius,
      { selected: colours.live, feature: colours.feature });
  }

  showAnswer() {
    const { query, isValid, indexes, answers } = this.shown;
    const [answer] = answers;
    const rows = [];
    if (this.isExample) rows.push(["this point", "an example: point elsewhere to ask"]);
    if (answer) {
      // Where the colours of a slice have no sign, the words tell the side.
      const signed = ([term]) => term === "signed distance" && this.viewer.slice?.scale.isDiverging === false;
      rows.push(...answerRows(this.viewer, { ...answer, size: this.scene.sizes[answer.primitive] })
        .filter((row) => !signed(row)));
      const key = (a) => a && [...a.point, a.distance, a.lowerBound, a.primitive, a.feature].join();
      const isSame = answers.every((other) => key(other) === key(answer));
      const all = `the ${indexes.length} indexes`;
      if (indexes.length > 1) rows.push(["agreement", isSame ? `${all} give equal answers` : `${all} differ`]);
      else if (!this.isComplete) rows.push(["agreement", "one index has answered; see “Indexes”"]);
    } else if (isValid) {
      rows.push(["answer", "none"]);
    }
    rows.push(["query", isValid ? this.viewer.place(query) : "Each coordinate has to be a number."]);
    fillList(this.answerText, rows);
  }

  showSpeed() {
    const rate = (index) => (index.rate ? count(Number(index.rate.toPrecision(2))) : "");
    fillTable(this.speedTable, "Speed in this browser, at points around the scene",
      ["index", "queries/s", "build", "size"],
      this.indexes.map((index) =>
        [index.name, rate(index), `${short(index.time)} ms`, `${count(Math.ceil(index.bytes / 1000))} kB`]));
  }

  // Draws the answers of a query far from the origin, and shows their errors.
  drawFar(far) {
    const { colours } = this.viewer;
    const [query, point, foot] = [far.query, far.p2m.point, far.ordinary.point].map((p) => this.at(p));
    const isFinite = (vector) => vector.toArray().every(Number.isFinite);
    if (isFinite(query) && isFinite(point)) {
      drawAnswer(this.group, query, point, [], null, 0, { ...colours, selected: colours.live });
    }
    if (isFinite(query) && isFinite(foot)) {
      this.group.add(line([query, foot], colours.feature), marker(foot, colours.feature, 6));
    }
    const errors = [far.p2m, far.ordinary].map(({ distance }) => Math.abs(distance - far.distance));
    // An infinite error is shown, and says nothing about later queries.
    const finite = errors.map((error) => (Number.isFinite(error) ? error : 0));
    this.largestErrors = this.largestErrors.map((error, i) => Math.max(error, finite[i]));
    const { unit } = this.viewer;
    const named = (name, colour) => element("span", {}, element("span", { style: `color: ${colour}` }, "● "), name);
    const table = element("table", { id: "live-far-table" });
    fillTable(table, "Distances in f32, and their errors", ["", "distance", "error", "largest"], [
      [named("p2m", colours.live), far.p2m.distance, errors[0], this.largestErrors[0]],
      [named("ordinary f32", colours.feature), far.ordinary.distance, errors[1], this.largestErrors[1]],
    ].map(([name, ...values]) => [name, ...values.map(short)]));
    const scaled = this.farScale === 1 ? "" : `, scaled by ${short(this.farScale)},`;
    this.farText.replaceChildren(
      element("p", { class: "small" }, `The scene${scaled} was moved a million units away from the origin, and its ` +
        "vertices and the query were rounded to f32 there, whose numbers are 1/16 of a unit apart" +
        (this.farScale === 1 ? "" : `, which is ${short(1 / (16 * this.farScale))} here`) + ". The true " +
        `distance of the rounded query from the rounded scene is ${short(far.distance)} ${unit}. Ordinary arithmetic ` +
        "rounds the closest point to such coordinates before it measures, so its distance jumps while the query " +
        "moves. p2m measures before it rounds, and gives the closest point by the weights of the vertices."),
      table);
  }
}

// A module of WebAssembly in a worker, whose script is part of this one, because a page that is a file may not read
// others.
class RemoteModule {
  constructor() {
    this.address = URL.createObjectURL(new Blob([WORKER_SCRIPT], { type: "text/javascript" }));
    this.worker = new Worker(this.address);
    // The calls that are not answered yet. Answers come in the order of the calls.
    this.calls = [];
    this.worker.onmessage = ({ data }) => this.settle(data);
    this.worker.onerror = ({ message }) => this.settle({ error: message ?? "the browser starts no worker" });
  }

  // Calls a function of the worker.
  call(name, ...values) {
    return new Promise((resolve, reject) => {
      this.calls.push({ resolve, reject });
      this.worker.postMessage({ name, values });
    });
  }

  settle({ result, error }) {
    // The script has been read if there is an answer.
    URL.revokeObjectURL(this.address);
    const call = this.calls.shift();
    if (error === undefined) call?.resolve(result);
    else call?.reject(new Error(error));
  }

  end() {
    this.worker.terminate();
  }
}
