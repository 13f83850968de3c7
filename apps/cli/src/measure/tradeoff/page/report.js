// Tables, and the page that is made of all.

const SETTING_HEAD = [
  "index",
  "setting",
  "ns per query",
  "as fast",
  "error, relative",
  "99.9 %",
  "error, u M",
  "99.9 %",
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
      const exact = costs(set.curves.filter((curve) => isExact(defaultPoint(curve))));
      const jobs = JOBS.map(([queries]) => {
        const [best] = [...exact].sort((a, b) => total(a, queries) - total(b, queries));
        return best ? `${best.name}, ${seconds(total(best, queries))} s` : "-";
      });
      return [scene.name, set.name, ...NEEDS.map((need) => describe(fastest(set.curves, need.isMet))), ...jobs];
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
  byId("headline").textContent = `${scene.name}: speed against error of queries "${set.name}"`;
  byId("about").innerHTML = words(
    `${scene.about} ${scene.primitives} primitives. Queries: ${set.about} ${maxQueries(set)} queries in a round.`,
  );
  const box = (curve, i) =>
    `<input type="checkbox" id="index${i}"${median(curve) <= limit ? " checked" : ""}>${swatch(curve.name)}`;
  byId("legend").innerHTML = set.curves.map((curve, i) => `<label>${box(curve, i)}</label>`).join("");
  byId("advice").innerHTML = words(advice(set));
  byId("detail").innerHTML = `<h2>The speed and the errors of each setting</h2>
<p>Rows have ${maxQueries(set)} queries unless the remarks state another number.</p>${settingTable(set)}
<h2>The time of single queries, in ns</h2><div id="latencies"></div>${latencyTable(set)}
<h2>Building</h2>
<p>The table has the seconds on one thread, and the heap bytes per primitive besides the scene.</p>${buildTable(set)}
<h2>Break-even: the number of queries from which on a longer build pays</h2>
<p>The cheapest index, with its build: ${words(turnsInWords(costs(set.curves)))}.</p>
<div id="totals"></div>${breakEvenTable(set)}`;
  showPlots();
}
/** Draws the plots of the indexes whose boxes are ticked. */
function showPlots() {
  const set = data.scenes[chosen("scene")].sets[chosen("set")];
  const curves = set.curves.filter((_, i) => byId(`index${i}`).checked);
  byId("plot").innerHTML = errorPlot(curves, MEASURES[chosen("measure")]);
  byId("latencies").innerHTML = latencyPlot(curves);
  byId("totals").innerHTML = totalPlot(curves);
}
/** Shows the name of a mark beside it. */
function showTip(target) {
  const note = target.classList?.contains("dot") ? target.getAttribute("aria-label") : "";
  const [tip, box] = [byId("tip"), note ? target.getBoundingClientRect() : null];
  tip.hidden = !note;
  tip.textContent = note;
  if (box)
    Object.assign(tip.style, {
      left: `${Math.min(box.right + scrollX, scrollX + innerWidth - 200)}px`,
      top: `${box.bottom + scrollY + 4}px`,
    });
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
for (const kind of ["pointerover", "focusin", "click"])
  document.addEventListener(kind, ({ target }) => showTip(target));
showSet();
