// Tables, and the page that is made of all.

/** The columns of the table of settings: their names, and their cells for a candidate and its set of queries. */
const SETTING_COLUMNS = [
  ["index", ({ curve }) => curve.name],
  ["setting", ({ point }) => point.setting],
  ["ns per query", ({ point: { nanoseconds: ns } }) =>
    `${ns.median.toFixed(0)} (${ns.min.toFixed(0)} to ${ns.max.toFixed(0)})`],
  ["speed-up", ({ curve, point }) =>
    `${(defaultPoint(curve).nanoseconds.median / point.nanoseconds.median).toFixed(2)}x`],
  ["largest relative error", ({ point }) => error(point.errors.relative.max)],
  ["1 in 1,000 exceeds", ({ point }) => error(point.errors.relative.p999)],
  ["largest error, u M", ({ point }) => error(point.errors.scaled.max)],
  ["1 in 1,000 exceeds", ({ point }) => error(point.errors.scaled.p999)],
  ["bound gap", ({ point }) => error(point.errors.gap)],
  ["other primitive", ({ point: { errors } }) => percentage(errors.other_ids, errors.compared)],
  ["remarks", (candidate, set) => remarks(set, candidate)],
];
const settingTable = (set) =>
  table(
    SETTING_COLUMNS.map(([name]) => name),
    2,
    candidates(set.curves).map((candidate) => SETTING_COLUMNS.map(([, cell]) => cell(candidate, set))),
  );
const latencyTable = (set) =>
  table(
    ["index", "setting", ...PERCENTILES.map(([, share]) => share), "all"],
    2,
    candidates(set.curves)
      .filter(({ point }) => point.latency)
      .map(({ curve, point: { setting, queries, latency: l } }) => [
        curve.name,
        setting,
        // A percentile is shown only if there are enough queries for it.
        ...PERCENTILES.map(([key, , least]) => (queries < least ? "-" : l[key])),
        l.max,
      ]),
  );
function breakEvenTable(set) {
  const all = costs(set.curves);
  const cell = (a, b) => {
    const queries = breakEven(a, b);
    return a === b ? "" : queries === null ? "never" : queries === 0 ? "always" : count(queries);
  };
  return table(
    ["instead of", ...all.map((cost) => cost.name)],
    1,
    all.map((a) => [a.name, ...all.map((b) => cell(a, b))]),
  );
}
const buildTable = (set) =>
  table(
    ["index", "seconds", "bytes per primitive"],
    1,
    set.curves.map((curve) => {
      const { seconds: time, bytes_per_primitive: bytes } = defaultPoint(curve).build;
      return [curve.name, seconds(time), bytes.toFixed(0)];
    }),
  );
function summaryTable() {
  const rows = data.scenes.flatMap((scene) =>
    scene.sets.map((set) => {
      const exact = costs(exactCurves(set));
      const jobs = JOBS.map(([queries]) => {
        const [best] = [...exact].sort((a, b) => total(a, queries) - total(b, queries));
        return best ? `${best.name}, ${seconds(total(best, queries))} s` : "-";
      });
      return [scene.name, set.name, ...NEEDS.map((need) => describe(fastest(set.curves, need.limit))), ...jobs];
    }),
  );
  const head = ["scene", "queries", ...NEEDS.map((need) => need.name), ...JOBS.map(([, name]) => name)];
  const points = data.scenes.flatMap((scene) =>
    scene.sets.flatMap((set) => candidates(set.curves).map(({ point }) => point.errors)),
  );
  const sum = (key) => points.reduce((sum, errors) => sum + errors[key], 0);
  return `${table(head, 2, rows, "words")}<p>${sum("broken")} of ${sum("compared")} answers have a larger error than
their setting promises (other libraries and limits of visits promise nothing but lower bounds).</p>`;
}
const terms = (all) =>
  all.map(([name, meaning]) => `<dt>${escaped(name)}</dt><dd>${words(meaning)}</dd>`).join("\n");
function selector(id, label, names) {
  const options = names.map((name, i) => `<option value="${i}">${escaped(name)}</option>`);
  const hidden = names.length > 1 ? "" : " hidden";
  return `<label${hidden}>${label} <select id="${id}">${options.join("")}</select></label>`;
}
const chosen = (id) => Number(byId(id).value);

/** An index is hidden at first if it is slower than the fastest one by more than this factor. */
const MAX_SHOWN_TIME_FACTOR = 30;

/** Shows the chosen scene and set of queries. The boxes of the legend are made anew for each set. */
function showSet() {
  const scene = data.scenes[chosen("scene")];
  const set = scene.sets[chosen("set")];
  const median = (curve) => defaultPoint(curve).nanoseconds.median;
  const limit = MAX_SHOWN_TIME_FACTOR * Math.min(...set.curves.map(median));
  byId("headline").textContent = `Which index for ${scene.name.split("/").pop()}?`;
  byId("about").innerHTML = words(
    `${scene.about} Queries: ${set.about} ` +
      `${maxQueries(set).toLocaleString("en-US")} queries in a round.`,
  );
  const box = (curve, i) =>
    `<input type="checkbox" id="index${i}"${median(curve) <= limit ? " checked" : ""}>${swatch(curve.name)}`;
  byId("legend").innerHTML = set.curves.map((curve, i) => `<label>${box(curve, i)}</label>`).join("");
  const [short, long] = advice(set);
  byId("advice").textContent = short;
  byId("why").innerHTML = words(long);
  byId("detail").innerHTML = `<details open><summary>When does a longer build pay?</summary>
<p>The index to take by counted work, as <code>p2m advise</code> does: ${words(turnsInWords(set.turns))}. The table has
the number of queries from which on the index of the column takes less time than that of the row, by the times that were
measured.</p>
<div id="totals"></div>${breakEvenTable(set)}</details>
<details><summary>Build time and memory</summary>
<p>The seconds on one thread, and the heap bytes per primitive besides the scene.</p>${buildTable(set)}</details>
<details><summary>Speed and errors of each setting</summary>
<p>Rows have ${maxQueries(set)} queries unless the remarks state another number.</p>${settingTable(set)}</details>
<details><summary>Times of single queries, in ns</summary><div id="latencies"></div>${latencyTable(set)}</details>`;
  pinned = null;
  showPlots();
}
/** Draws the plots of the indexes whose boxes are ticked. */
function showPlots() {
  const set = data.scenes[chosen("scene")].sets[chosen("set")];
  const isShown = (_, i) => byId(`index${i}`).checked;
  const curves = set.curves.filter(isShown);
  byId("plot").innerHTML = errorPlot(set.curves, isShown, MEASURES[chosen("measure")]);
  byId("latencies").innerHTML = latencyPlot(curves);
  byId("totals").innerHTML = totalPlot(curves);
  byId("tip").hidden = true;
}

/** The distance in pixels from a mark within which the pointer reads it. */
const NEAR = 26;
/** The mark whose tip stays, after a click. */
let pinned = null;

/** Returns the mark that is nearest to a position on the screen, if one is near. */
function nearestMark(x, y, svg) {
  let [found, best] = [null, NEAR];
  for (const dot of svg.querySelectorAll(".dot")) {
    const { left, top, width, height } = dot.getBoundingClientRect();
    const distance = Math.hypot(left + width / 2 - x, top + height / 2 - y);
    if (distance < best) [found, best] = [dot, distance];
  }
  return found;
}
/** Shows the name of a mark beside it, or nothing. */
function showTip(target) {
  const tip = byId("tip");
  for (const old of document.querySelectorAll(".dot.read")) old.classList.remove("read");
  tip.hidden = !target;
  if (!target) return;
  target.classList.add("read");
  tip.textContent = target.getAttribute("aria-label");
  const box = target.getBoundingClientRect();
  const x = Math.max(4, Math.min(box.right + scrollX + 6, scrollX + document.documentElement.clientWidth - tip.offsetWidth - 4));
  tip.style.transform = `translate(${x}px, ${box.bottom + scrollY + 6}px)`;
}

// All scenes have the same sets of queries.
const relative = data.scenes[0].sets[0].curves.some((curve) => !isNone(defaultPoint(curve).errors.relative.max));
const nameOf = ({ name }) => name;
byId("selectors").innerHTML = selector("scene", "Scene", data.scenes.map(nameOf)) +
  selector("set", "Queries", data.scenes[0].sets.map(nameOf)) + selector("measure", "Error", MEASURES.map(nameOf));
byId("measure").value = relative ? "0" : "2";
byId("summary").innerHTML = summaryTable();
byId("backends").innerHTML = terms(data.backends);
byId("settings").innerHTML = terms(data.settings.map(({ name, about }) => [name, about]));
byId("truth").textContent = data.truth;
byId("clock").textContent = data.clock.toFixed(0);
const { date, command, cpu, label: build, rustc, flags, commit } = data.provenance;
byId("provenance").innerHTML = words(
  `Measured on ${date} by \`${command}\`: ${cpu}; build \`${build}\`: ${rustc}, ${flags}; commit ${commit}. ` +
    data.effort,
);
document.addEventListener("change", ({ target }) =>
  ["scene", "set"].includes(target.id) ? showSet() : showPlots(),
);
const markAt = ({ target, clientX, clientY }) => {
  const svg = target.closest?.("svg");
  return svg ? nearestMark(clientX, clientY, svg) : null;
};
const pin = (mark) => showTip((pinned = mark));
document.addEventListener("pointermove", (event) => pinned || showTip(markAt(event)));
document.addEventListener("click", (event) => pin(markAt(event)));
document.addEventListener("focusin", ({ target }) => target.classList.contains("dot") && pin(target));
document.addEventListener("keydown", ({ key }) => key === "Escape" && pin(null));
let drawnWidth = 0;
globalThis.addEventListener?.("resize", () => {
  if (drawnWidth === document.documentElement.clientWidth) return;
  drawnWidth = document.documentElement.clientWidth;
  showPlots();
});
showSet();
