// The panel beside the picture: what the page is about first, then what is shown, then help.

import { KEYS } from "./input.js";
import { checkbox, count, counted, element, fillList, patch, short, shortened, withCode } from "./text.js";

// The number of characters of a word of the title above which its middle is left out.
const LONGEST_WORD = 26;
// The number of answers above which a page begins without segments to closest points, which would fill the picture.
const MANY_ANSWERS = 20_000;

// Makes all sections of the panel. `panels` has the classes of those with a file of their own.
export function makePanel(viewer, { AnswersPanel, CellsPanel, DeviationsPanel, MovedPanel, SlicePanel }) {
  const panel = document.getElementById("panel");
  const title = panel.querySelector("h1");
  title.title = title.textContent;
  title.textContent = shortened(title.textContent, LONGEST_WORD);
  // The verdict says it in large type.
  if (viewer.data.has_object_colours) panel.querySelector("header p").hidden = true;
  const add = (title, id, ...children) => {
    const section = element("section", { id, "aria-label": title }, element("h2", {}, title), ...children);
    panel.append(section);
    return section;
  };
  if (viewer.deviations) viewer.deviationsPanel = new DeviationsPanel(viewer, add);
  if (viewer.measures) viewer.measures.makePanel(viewer, add);
  if (viewer.data.moved) new MovedPanel(viewer, add);
  if (viewer.data.notes.length > 0) {
    add("Notes", "notes", element("ul", {}, ...viewer.data.notes.map((note) => element("li", {}, note))));
  }
  if (viewer.slice) viewer.slicePanel = new SlicePanel(viewer, add);
  viewer.live?.makePanel(add);
  if (viewer.answers) viewer.answersPanel = new AnswersPanel(viewer, add);
  addFacts(viewer, add);
  addShown(viewer, add);
  if (viewer.cells) viewer.cellsPanel = new CellsPanel(viewer, add);
  if (viewer.scene.objects.some((object) => object.name !== null)) addObjects(viewer, add);
  addHelp(viewer, panel);
}

// Adds what the scene is, and what can be done in this page.
function addFacts(viewer, add) {
  const { data, view, frame, unit } = viewer;
  const sides = [0, 1, 2].map((k) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = k; i < data.scene.positions.length; i += 3) {
      low = Math.min(low, data.scene.positions[i]);
      high = Math.max(high, data.scene.positions[i]);
    }
    return low <= high ? (high - low) * frame.scale : 0;
  });
  const rows = [["size", `${sides.map(short).join(" × ")} ${unit}`]];
  const middle = frame.coordinates([0, 0, 0]);
  if (Math.hypot(...middle) > 20 * view.radius * frame.scale) {
    rows.push(["around", viewer.place(viewer.coordinates([0, 0, 0]))]);
  }
  const list = element("dl", {});
  fillList(list, rows);
  const hints = [];
  if (viewer.answers) hints.push("Point at a query point to read its distance, and click it for the whole answer.");
  if (viewer.slice) hints.push("Move the slice with its slider, or drag it with Shift.");
  if (viewer.deviations) hints.push("Point at the scan to read deviations.");
  if (!viewer.answers && !viewer.slice && !viewer.deviations && !viewer.live && !viewer.measures && !data.moved) {
    hints.push("For distances in this page, make it with `--live always`, `--field 64` or `--random 1000` of `p2m view`.");
  }
  hints.push("Drag to turn, and use the wheel or two fingers to come nearer.");
  add("The scene", "facts", list,
    element("ul", { class: "hints" }, ...hints.map((hint) => element("li", {}, ...withCode(hint)))));
}

function addShown(viewer, add) {
  const boxes = [];
  const box = (label, isOn, change, id) =>
    boxes.push(checkbox(label, isOn, (value) => { change(value); viewer.draw(); }, id));
  const { scene, slice, answers, live, cells, deviations } = viewer;
  // A scan with signs is seen alone at first, because half of its points may be inside of the scene, and so is one that
  // the points of the scene would cover.
  scene.group.visible = !deviations || !(deviations.is_signed || viewer.data.scene.points.length > 0);
  box("scene", scene.group.visible, (on) => (scene.group.visible = on), "show-scene");
  if (viewer.data.scene.triangles.length > 0) {
    const opacity = deviations ? 0.2 : 0.25;
    if (deviations) scene.setOpacity(opacity);
    box("see through the scene", !!deviations, (on) => scene.setOpacity(on ? opacity : 1), "show-through");
  }
  if (slice) {
    box("slice", true, (on) => (slice.mesh.visible = on), "show-slice");
    box("scene cut open at the slice", true, (on) => (viewer.isCut = on), "show-cut");
    box("outline of the scene over the slice", true, (on) => (viewer.isOutlined = on), "show-outline");
  }
  viewer.deviationsPanel?.makeBoxes(box);
  if (answers) {
    const isCrowded = answers.length > MANY_ANSWERS;
    answers.segments.visible = !isCrowded;
    box("query points", true, (on) => (answers.dots.visible = on), "show-queries");
    box("closest points", true, (on) => (answers.feet.visible = on), "show-closest");
    box("segments to closest points", !isCrowded, (on) => (answers.segments.visible = on), "show-segments");
    // A sphere would change the colours of a slice.
    answers.hasSphere = !slice;
    box("empty sphere around the selected query", !slice, (on) => {
      answers.hasSphere = on;
      answers.select(answers.selected, viewer.colours);
    }, "show-sphere");
  }
  if (live) {
    box("query at the pointer", true, (on) => (live.group.visible = on), "show-live");
    live.hasSphere = !slice;
    box("empty sphere around it", !slice, (on) => {
      live.hasSphere = on;
      live.redraw();
    }, "show-live-sphere");
  }
  if (cells) box("boxes of the index", false, (on) => (cells.group.visible = on), "show-cells");
  if (viewer.measures) box("measured lines", true, (on) => (viewer.measures.group.visible = on), "show-measures");
  add("Show", "show", element("div", { class: "boxes" }, ...boxes));
}

function addObjects(viewer, add) {
  const { scene } = viewer;
  const boxes = scene.objects.map((object, i) => {
    const name = object.name ?? "primitives of no object";
    const made = checkbox(`${name} (${counted(object.count, "primitive")})`, true, (on) => {
      scene.show(i, on);
      viewer.draw();
    });
    if (scene.colours) made.firstChild.after(patch(i === 1 ? "second" : "surface"));
    return made;
  });
  const set = (isOn) => {
    boxes.forEach((label, i) => {
      label.firstChild.checked = isOn;
      scene.objects[i].isVisible = isOn;
    });
    scene.update();
    viewer.draw();
  };
  const button = (text, isOn) => element("button", { type: "button", onclick: () => set(isOn) }, text);
  add(`Objects (${count(boxes.length)})`, "objects",
    element("p", { class: "buttons" }, button("All", true), button("None", false)),
    element("div", { class: "boxes scrolled", tabindex: "0", role: "region", "aria-label": "objects" }, ...boxes));
}

function addHelp(viewer, panel) {
  const keys = KEYS.filter(([, , needed]) => !needed || viewer[needed])
    .map(([key, what]) => [element("dt", {}, element("kbd", {}, key)), element("dd", {}, what)]);
  viewer.help = element("details", { id: "keys" }, element("summary", {}, "Mouse and keyboard"),
    element("p", {}, "Drag to turn, drag with the right button to move, and turn the wheel to come nearer. Click a " +
      "query point or a point of a scan to keep its answer here."),
    element("dl", {}, ...keys.flat()));
  panel.append(viewer.help, document.getElementById("about"));
}
