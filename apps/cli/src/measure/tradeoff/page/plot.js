// Plots, as text of SVG.

const COLOURS = [
  ...new Set(data.scenes.flatMap((scene) => scene.sets.flatMap((set) => set.curves.map((curve) => curve.name)))),
];
const colour = (name) => `var(--c${Math.max(0, COLOURS.indexOf(name)) % 8})`;
const swatch = (name) => `<span class="swatch" style="background:${colour(name)}"></span>${escaped(name)}`;

/** Returns the positions of ticks of a logarithmic axis. */
function ticks(low, high) {
  const [from, to] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const step = Math.ceil((to - from) / 9);
  const digits = to - from <= 1 ? [1, 1.5, 2, 3, 4, 5, 6, 8] : to - from <= 3 ? [1, 2, 5] : [1];
  const decades = Array.from({ length: to - from + 1 }, (_, i) => from + i).filter((e) => (e - from) % step === 0);
  return decades.flatMap((e) => digits.map((digit) => digit * 10 ** e)).filter((x) => low <= x && x <= high);
}

const path = (kind, d) => `<path class="${kind}" d="${d}"/>`;
const label = (x, y, anchor, text) => `<text x="${x}" y="${y}" text-anchor="${anchor}">${escaped(text)}</text>`;

/**
 * Returns a plot with two logarithmic axes. A series has a name and points {x, y, note, isDefault, isFront}, in the
 * order of its line. Points with x = 0 lie on a line of their own.
 */
function plot(xName, yName, series) {
  const [width, height, left, right, top, bottom] = [860, 460, 70, 846, 14, 410];
  const shown = series.map((line) => ({ ...line, points: line.points.filter((p) => !isNone(p.x) && p.y > 0) }));
  const all = shown.flatMap((line) => line.points);
  if (all.length === 0) return "<p>There is nothing to draw. Choose another kind of error, or show more indexes.</p>";
  const range = (values) => (values.length ? [Math.min(...values) / 1.3, Math.max(...values) * 1.3] : [0.1, 1]);
  const hasZero = all.some((p) => p.x <= 0);
  const xs = range(all.map((p) => p.x).filter((x) => x > 0));
  const ys = range(all.map((p) => p.y));
  const position = ([low, high], from, to, value) =>
    from + ((to - from) * Math.log(value / low)) / Math.log(high / low);
  const start = hasZero ? left + 60 : left;
  const px = (x) => (x > 0 ? position(xs, start, right, x) : left + 30).toFixed(1);
  const py = (y) => position(ys, bottom, top, y).toFixed(1);
  const hasPositive = all.some((p) => p.x > 0);
  const xTicks = (hasPositive ? ticks(...xs) : [])
    .map((x) => [px(x), tickLabel(x)])
    .concat(hasZero ? [[px(0), "exact"]] : []);
  const grid = [
    ...xTicks.map(([x, text]) => path("grid", `M${x} ${top}V${bottom}`) + label(x, bottom + 18, "middle", text)),
    ...ticks(...ys).map(
      (y) => path("grid", `M${left} ${py(y)}H${right}`) + label(left - 6, Number(py(y)) + 4, "end", tickLabel(y)),
    ),
    hasZero ? path("border dashed", `M${start} ${top}V${bottom}`) : "",
  ];
  const lines = shown.map(({ name, points }) => {
    const steps = points.map((p) => `${px(p.x)} ${py(p.y)}`);
    return steps.length > 0 ? `<path class="curve" stroke="${colour(name)}" d="M${steps.join("L")}"/>` : "";
  });
  const marks = shown.flatMap(({ name, points }) =>
    points.map((p) => {
      const [x, y] = [px(p.x), py(p.y)];
      const ring = p.isFront ? `<circle class="border" cx="${x}" cy="${y}" r="9"/>` : "";
      const common = `class="dot" tabindex="0" role="img" aria-label="${escaped(p.note)}" fill="${colour(name)}"`;
      return (
        ring +
        (p.isDefault
          ? `<rect ${common} x="${x - 5}" y="${y - 5}" width="10" height="10"/>`
          : `<circle ${common} cx="${x}" cy="${y}" r="5"/>`)
      );
    }),
  );
  return `<svg viewBox="0 0 ${width} ${height}" role="group" aria-label="${escaped(`${yName} over ${xName}`)}">
${grid.join("\n")}
${path("border", `M${left} ${top}V${bottom}H${right}`)}
${label((left + right) / 2, height - 8, "middle", xName)}
<g transform="translate(16 ${(top + bottom) / 2}) rotate(-90)">${label(0, 0, "middle", yName)}</g>
${lines.join("\n")}
${marks.join("\n")}
</svg>`;
}

const MEASURES = [
  {
    name: "largest relative error",
    axis: "largest error, relative to the distance",
    of: (errors) => errors.relative.max,
  },
  {
    name: "relative error of one query in a thousand",
    axis: "relative error that one query in a thousand exceeds",
    of: (errors) => errors.relative.p999,
  },
  { name: "largest error in u M", axis: "largest error, in u M", of: (errors) => errors.scaled.max },
  {
    name: "error in u M of one query in a thousand",
    axis: "error in u M that one query in a thousand exceeds",
    of: (errors) => errors.scaled.p999,
  },
];

/** Plots the time over the error of each setting. */
function errorPlot(curves, measure) {
  const all = candidates(curves)
    .map(({ curve, point }) => ({
      curve,
      x: measure.of(point.errors),
      y: point.nanoseconds.median,
      isDefault: point.setting === DEFAULT,
      note:
        `${curve.name}, ${point.setting}: ${point.nanoseconds.median.toFixed(0)} ns, ` +
        `${measure.name} ${error(measure.of(point.errors))}`,
    }))
    .filter((p) => !isNone(p.x))
    .sort((a, b) => a.x - b.x || a.y - b.y);
  let least = Infinity;
  for (const p of all) {
    p.isFront = p.y < least;
    least = Math.min(least, p.y);
  }
  return plot(
    measure.axis,
    "ns per query",
    curves.map((curve) => ({ name: curve.name, points: all.filter((p) => p.curve === curve) })),
  );
}

/** Plots the times of single queries over their rarity. */
const latencyPlot = (curves) =>
  plot(
    "one query in so many",
    "takes longer than so many ns",
    curves.map((curve) => {
      const { latency, queries } = defaultPoint(curve);
      const all = latency
        ? [
            [2, latency.p50],
            [10, latency.p90],
            [100, latency.p99],
            [1000, latency.p999],
          ]
        : [];
      const points = all
        .filter(([oneIn]) => oneIn <= queries)
        .map(([x, y]) => ({ x, y, note: `${curve.name}: one in ${x} takes more than ${y} ns` }));
      return { name: curve.name, points };
    }),
  );

/** Plots the total time of building and querying over the number of queries. */
const totalPlot = (curves) =>
  plot(
    "queries",
    "seconds, with building",
    costs(curves).map((cost) => {
      const points = Array.from({ length: 15 }, (_, i) => 10 ** (2 + i / 2)).map((x) => ({ x, y: total(cost, x) }));
      return {
        name: cost.name,
        points: points.map((p) => ({
          ...p,
          note: `${cost.name}: ${count(p.x)} queries in ${seconds(p.y)} s, built`,
        })),
      };
    }),
  );
