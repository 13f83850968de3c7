// The panel of query points and their answers: a histogram, the selected answer, and all of them as a table.

import { UNDEFINED } from "./colours.js";
import { explainedWords } from "./answers.js";
import { copyButton, count, counted, element, fillList, key, number, reveal, stepped, tableHead } from "./text.js";

// The number of rows of a page of the table.
const ROWS = 50;

export class AnswersPanel {
  constructor(viewer, add) {
    this.viewer = viewer;
    this.answers = viewer.answers;
    const { answers } = this;
    const what = answers.signed ? "signed distance" : "distance";
    const missing = answers.length - answers.answeredCount;
    const parts = [];
    const all = counted(answers.length, "query");
    if (missing > 0) parts.push(element("p", {}, `${count(missing)} of ${all} have no answer.`));
    if (answers.answeredCount > 0) {
      const { scale, values } = answers;
      const keys = missing > 0 ? [[UNDEFINED, "no answer"]] : [];
      parts.push(viewer.figure(() => ({ scale, what, unit: viewer.unit, values, keys })).element);
    }
    this.text = element("dl", { id: "answer", "aria-live": "polite" });
    const step = (by) =>
      element("button", { type: "button", onclick: () => this.step(by) }, by > 0 ? "Next" : "Previous");
    const symbol = (kind, text) => key(element("span", { class: `patch ${kind}` }), text);
    parts.push(element("div", { id: "symbols" }, symbol("ringed", "query point, in the colour of its distance"),
      symbol("foot", "its closest point"), ...(viewer.slice ? [symbol("faded", "away from the slice")] : [])));
    const section = add("Answer", "selected",
      element("p", { class: "buttons" }, step(-1), step(1), copyButton(this.text)), this.text);
    add(`Distances of ${all}`, "distances", ...parts);
    this.table = element("table", { id: "table" });
    this.page = 0;
    const turn = (by) => element("button", { type: "button", onclick: () => this.turn(by) },
      by > 0 ? "Next rows" : "Previous rows");
    section.append(explainedWords(), element("details", { id: "answers" }, element("summary", {}, "All answers as a table"),
      element("p", { class: "buttons" }, turn(-1), turn(1)),
      element("div", { class: "scrolled", tabindex: "0", role: "region", "aria-label": "answers" }, this.table)));
    this.turn(0);
    this.select(-1);
  }

  // Turns the pages of the table.
  turn(by) {
    const { answers } = this;
    const last = Math.max(0, Math.ceil(answers.length / ROWS) - 1);
    this.page = Math.max(0, Math.min(last, this.page + by));
    const first = this.page * ROWS;
    const head = ["query", "x", "y", "z", answers.signed ? "signed distance" : "distance", "primitive", "feature"];
    const rows = [];
    for (let i = first; i < Math.min(answers.length, first + ROWS); i++) {
      const select = element("button", { type: "button", onclick: () => this.select(i) }, String(i));
      const cells = answers.isAnswered(i)
        ? [...[...answers.points.subarray(3 * i, 3 * i + 3)].map((x) => this.viewer.coordinate(x)), number(answers.values[i]),
            answers.primitives[i], answers.featureName(i)]
        : ["no answer", "", "", "", "", ""];
      rows.push(element("tr", {}, element("td", {}, select), ...cells.map((cell) => element("td", {}, cell))));
    }
    this.table.replaceChildren(
      element("caption", {}, `Closest points, rows ${count(first)} to ${count(first + rows.length - 1)} of ` +
        `${count(answers.length)}`),
      tableHead(head), element("tbody", {}, ...rows));
  }

  step(by) {
    const { length, selected } = this.answers;
    if (length > 0) this.select(stepped(this.isExample ? -1 : selected, by, length));
  }

  // Selects the answered query that is nearest to the middle of the picture, as an example.
  selectExample() {
    const { answers, viewer } = this;
    viewer.camera.updateMatrixWorld();
    const at = viewer.camera.position.clone();
    let [found, least] = [-1, Infinity];
    for (let i = 0; i < answers.length; i++) {
      const { x, y } = at.fromArray(answers.from, 3 * i).project(viewer.camera);
      if (answers.isAnswered(i) && Math.hypot(x, y) < least) [found, least] = [i, Math.hypot(x, y)];
    }
    this.select(found, true);
  }

  // Returns the label of the selected answer in the picture.
  labels() {
    const { answers, viewer } = this;
    const i = answers.selected;
    if (i < 0 || !answers.isAnswered(i) || !answers.dots.visible) return [];
    const position = viewer.camera.position.clone().fromArray(answers.from, 3 * i);
    return [{ position, text: viewer.inWords(answers.values[i], !!answers.signed), kind: "important" }];
  }

  select(i, isExample = false) {
    this.isExample = isExample;
    const { answers, viewer } = this;
    // The sphere of an example would cover much before anybody asked for it.
    answers.select(i, viewer.colours, !isExample);
    const rows = isExample && i >= 0 ? [["this point", "an example: click any query point to read it"]] : [];
    if (i < 0) {
      rows.push(["none", "Click a query point, or press n."]);
    } else {
      if (answers.isAnswered(i)) {
        rows.push(...answers.rows(i, viewer));
        const object = answers.objects?.[i];
        if (object) rows.push(["object", viewer.data.object_names[object - 1]]);
      } else {
        rows.push(["answer", "none"]);
      }
      rows.push(["query", viewer.place(answers.queries.subarray(3 * i, 3 * i + 3))], ["number", `${count(i)} of ${count(answers.length)}`]);
    }
    fillList(this.text, rows);
    if (i >= 0 && !isExample) reveal(this.text);
    viewer.draw();
  }
}
