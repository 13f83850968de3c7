// Tables, and the page that is made of all.

const SETTING_HEAD = [
  "index",
  "setting",
  "ns per query",
  "speed-up",
  "largest relative error",
  "1 in 1,000 exceeds",
  "largest error, u M",
  "1 in 1,000 exceeds",
  "bound gap",
  "other primitive",
  "remarks",
];
const settingTable = (set) =>
  table(
    SETTING_HEAD,
    2,
    candidates(set.curves).map((candidate) => {
      const {
        curve,
        point: { setting, nanoseconds: ns, errors },
      } = candidate;
      return [
        curve.name,
        setting,
        `${ns.median.toFixed(0)} (${ns.min.toFixed(0)} to ${ns.max.toFixed(0)})`,
        `${(defaultPoint(curve).nanoseconds.median / ns.median).toFixed(2)}x`,
        error(errors.relative.max),
        error(errors.relative.p999),
        error(errors.scaled.max),
        error(errors.scaled.p999),
        error(errors.gap),
        percentage(errors.other_ids, errors.compared),
        remarks(set, candidate),
      ];
    }),
  );
const latencyTable = (set) =>
  table(
    ["index", "setting", "50 %", "90 %", "99 %", "99.9 %", "all"],
    2,
    candidates(set.curves)
      .filter(({ point }) => point.latency)
      .map(({ curve, point: { setting, queries, latency: l } }) => [
        curve.name,
        setting,
        // A percentile is shown only if there are enough queries for it.
        ...[
          [l.p50, 2],
          [l.p90, 10],
          [l.p99, 100],
          [l.p999, 1000],
          [l.max, 1],
        ].map(([ns, least]) => (queries < least ? "-" : ns)),
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
const sets = data.scenes[0].sets.map((set) => set.name);
const relative = data.scenes[0].sets[0].curves.some((curve) => !isNone(defaultPoint(curve).errors.relative.max));
byId("selectors").innerHTML =
  selector(
    "scene",
    "Scene",
    data.scenes.map((scene) => scene.name),
  ) +
  selector("set", "Queries", sets) +
  selector(
    "measure",
    "Error",
    MEASURES.map((measure) => measure.name),
  );
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
document.addEventListener("pointermove", ({ target, clientX, clientY }) => {
  const svg = target.closest?.("svg");
  if (!pinned) showTip(svg ? nearestMark(clientX, clientY, svg) : null);
});
document.addEventListener("click", ({ target, clientX, clientY }) => {
  const svg = target.closest?.("svg");
  pinned = svg ? nearestMark(clientX, clientY, svg) : null;
  showTip(pinned);
});
document.addEventListener("focusin", ({ target }) => {
  if (target.classList.contains("dot")) showTip((pinned = target));
});
document.addEventListener("keydown", ({ key }) => {
  if (key === "Escape") showTip((pinned = null));
});
let drawnWidth = 0;
globalThis.addEventListener?.("resize", () => {
  if (drawnWidth === document.documentElement.clientWidth) return;
  drawnWidth = document.documentElement.clientWidth;
  showPlots();
});
showSet();
