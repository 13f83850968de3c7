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
const label = (x, y, anchor, text, kind = "") =>
  `<text class="${kind}" x="${x}" y="${y}" text-anchor="${anchor}">${escaped(text)}</text>`;

/**
 * The families of settings: what their marks look like, whether the line between them is broken, and whether they
 * guarantee nothing, so that their marks are hollow.
 */
const FAMILIES = {
  default: { name: "default", shape: "square" },
  certified: { name: "certified", shape: "diamond" },
  epsilon: { name: "epsilon", shape: "circle" },
  visits: { name: "max visits: observed, no guarantee", shape: "triangle", isBroken: true, isHollow: true },
};
const familyOf = (setting) =>
  setting === DEFAULT ? "default"
    : setting.startsWith("epsilon") ? "epsilon" : setting.startsWith("max visits") ? "visits" : "certified";
/** Returns the mark of a shape around a position. */
function mark(shape, x, y, r, attributes) {
  const polygon = (points) =>
    `<path ${attributes} d="M${points.map(([dx, dy]) => `${(x + dx * r).toFixed(1)} ${(y + dy * r).toFixed(1)}`).join("L")}Z"/>`;
  if (shape === "square") return polygon([[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]);
  if (shape === "diamond") return polygon([[0, -1.25], [1.25, 0], [0, 1.25], [-1.25, 0]]);
  if (shape === "triangle") return polygon([[0, -1.15], [1.1, 0.85], [-1.1, 0.85]]);
  return `<circle ${attributes} cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="${r}"/>`;
}

/** Returns the size of a plot, which is that of the page. */
function plotSize() {
  const width = Math.max(320, Math.min(960, byId("plot").clientWidth || 860));
  return [width, width < 600 ? 400 : 440];
}

/**
 * Returns a plot with two logarithmic axes. A series has the name of an index, points {x, y, note, shape, isBest,
 * isHollow}, and `isBroken` for a broken line. A point whose x is the name of one of `columns` lies in that column.
 * `key` explains shapes.
 */
function plot(xName, yName, series, key = [], columns = []) {
  const [width, height] = plotSize();
  const isNarrow = width < 600;
  const shown = series.map((line) => ({ ...line, points: line.points.filter((p) => !isNone(p.x) && p.y > 0) }));
  const all = shown.flatMap((line) => line.points);
  if (all.length === 0) return "<p>There is nothing to draw. Choose another kind of error, or show more indexes.</p>";
  // Between the last values and the border is room for the names of lines.
  const border = width - 8;
  const [left, right, bottom] = [isNarrow ? 46 : 62, border - (isNarrow ? 52 : 76), height - 46];
  let [keyX, keyY] = [left, 14];
  const keys = key.map(({ shape, text, isBroken, isHollow }) => {
    const long = 38 + text.length * 7;
    // The key has further rows where it is too long for one.
    if (keyX + long > width) [keyX, keyY] = [left, keyY + 22];
    const [x, y] = [keyX + 12, keyY];
    keyX += long;
    const line = isBroken === undefined ? "" : path(isBroken ? "key dashed" : "key", `M${x - 12} ${y}H${x + 12}`);
    const shown = shape === "ring" ? `<circle class="border" cx="${x}" cy="${y}" r="7"/>`
      : mark(shape, x, y, 4.5, `class="key-mark${isHollow ? " hollow" : ""}"`);
    return line + shown + label(x + 16, y + 4, "start", text, "key-text");
  });
  const top = key.length ? keyY + 24 : 14;
  const range = (values, margin) =>
    values.length ? [Math.min(...values) / margin, Math.max(...values) * margin] : [0.1, 1];
  const used = columns.filter((name) => all.some((p) => p.x === name));
  const xs = range(all.map((p) => p.x).filter((x) => x > 0), 1.6);
  const ys = range(all.map((p) => p.y), 1.25);
  const position = ([low, high], from, to, value) =>
    from + ((to - from) * Math.log(value / low)) / Math.log(high / low);
  const column = isNarrow ? 64 : 92;
  const hasPositive = all.some((p) => p.x > 0);
  // In a column each index has a place of its own, because marks would hide each other.
  const order = [...new Set(series.map((line) => line.name))];
  const aside = (name) => ((order.indexOf(name) - (order.length - 1) / 2) * 0.8 * column) / Math.max(4, order.length);
  const px = (x, name) => (x > 0 ? position(xs, left + column * used.length + 12, right, x)
    : left + column * (used.indexOf(x) + 0.5) + (name === undefined ? 0 : aside(name)));
  const py = (y) => position(ys, bottom, top, y);
  const place = (x, y, name) => `${px(x, name).toFixed(1)} ${py(y).toFixed(1)}`;
  // Names of columns stay, and then the labels that a text is likely to name.
  const xTicks = used.map((name) => [px(name), name]);
  const half = (text) => text.length * (isNarrow ? 3 : 3.4) + 3;
  const known = (x) => [0.01, 0.1, 1].indexOf(x) + 1 || 4;
  for (const x of (hasPositive ? ticks(...xs) : []).sort((a, b) => known(a) - known(b) || a - b)) {
    const [at, text] = [px(x), tickLabel(x)];
    if (xTicks.every(([other, name]) => Math.abs(other - at) >= half(text) + half(name))) xTicks.push([at, text]);
  }
  const grid = [
    ...used.map((_, i) =>
      `<rect class="column" x="${left + column * i}" y="${top}" width="${column - 2}" height="${bottom - top}"/>`),
    ...xTicks.map(([x, text]) => path("grid", `M${x.toFixed(1)} ${top}V${bottom}`) + label(x.toFixed(1), bottom + 17, "middle", text)),
    ...ticks(...ys).map(
      (y) => path("grid", `M${left} ${py(y).toFixed(1)}H${border}`) + label(left - 6, (py(y) + 4).toFixed(1), "end", tickLabel(y)),
    ),
  ];
  const lines = shown.map(({ name, points, isBroken }) => {
    const steps = points.map((p) => place(p.x, p.y, name));
    const kind = isBroken ? "curve dashed" : "curve";
    return steps.length > 1 ? `<path class="${kind}" stroke="${colour(name)}" d="M${steps.join("L")}"/>` : "";
  });
  const drawn = new Set();
  // Marks with a ring lie over the others.
  const ordered = shown.flatMap(({ name, points }) => points.map((p) => ({ name, p }))).sort((a, b) => !!a.p.isBest - !!b.p.isBest);
  const marks = ordered.map(({ name, p }) => {
    // The default setting begins both lines of an index, and is drawn once.
    if (drawn.has(p.note)) return "";
    drawn.add(p.note);
    const [x, y] = [px(p.x, name), py(p.y)];
    const ring = p.isBest ? `<circle class="border" cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="9.5"/>` : "";
    const kind = p.isHollow ? "dot hollow" : "dot";
    const common = `class="${kind}" tabindex="0" role="img" aria-label="${escaped(p.note)}" color="${colour(name)}"`;
    return ring + mark(p.shape ?? "circle", x, y, 5.5, common);
  });
  // The name of an index stands beside the right end of its lines.
  const names = [];
  for (const { name, points } of shown) {
    const end = points.reduce((a, p) => (a && px(a.x, name) >= px(p.x, name) ? a : p), undefined);
    const near = names.find((other) => other.name === name);
    if (!end || (near && near.x >= px(end.x, name))) continue;
    if (near) Object.assign(near, { x: px(end.x, name), y: py(end.y) });
    else names.push({ name, x: px(end.x, name), y: py(end.y) });
  }
  names.sort((a, b) => a.y - b.y).forEach((entry, i) => {
    const above = names[i - 1];
    if (above && Math.abs(above.x - entry.x) < 80 && entry.y - above.y < 15) entry.y = above.y + 15;
  });
  const labels = names.map(({ name, x, y }) =>
    `<text class="name-label" x="${(x + 13).toFixed(1)}" y="${(y + 4).toFixed(1)}" style="fill:${colour(name)}">${escaped(name)}</text>`);
  return `<svg viewBox="0 0 ${width} ${height}" width="${width}" role="group" aria-label="${escaped(`${yName} over ${xName}`)}">
${grid.join("\n")}
${path("border", `M${left} ${top}V${bottom}H${border}`)}
${label((left + border) / 2, height - 8, "middle", xName)}
<g transform="translate(${isNarrow ? 10 : 14} ${(top + bottom) / 2}) rotate(-90)">${label(0, 0, "middle", yName)}</g>
${lines.join("\n")}
${labels.join("\n")}
${marks.join("\n")}
${keys.join("\n")}
</svg>`;
}

/** The errors that a plot may have: the name, that of the axis, and what they are among those of a setting. */
const MEASURES = [
  ["largest relative error", "largest error, relative to the distance", "relative", "max"],
  ["relative error of one query in a thousand", "relative error that one query in a thousand exceeds", "relative",
    "p999"],
  ["largest error in u M", "largest error, in u M", "scaled", "max"],
  ["error in u M of one query in a thousand", "error in u M that one query in a thousand exceeds", "scaled", "p999"],
].map(([name, axis, kind, part]) => ({ name, axis, of: (errors) => errors[kind][part] }));

/** The columns of settings that are exact, and of those of which no error was seen. */
const [EXACT, NONE_SEEN] = ["exact", "none seen"];
/** Returns what a setting guarantees, in words. */
const guaranteeInWords = (limit) =>
  limit === null ? "no guarantee" : limit === 0 ? "exact" : `at most ${Number((100 * limit).toPrecision(2))} % guaranteed`;

/**
 * Plots the time over the error of each setting of the shown indexes, with a line for each family of settings of an
 * index. Rings are around the best settings of all indexes.
 */
function errorPlot(all, isShown, measure) {
  const rings = new Set(best(all).map(({ point }) => point));
  const curves = all.filter(isShown);
  const place = (x) => (x === EXACT ? -1 : x === NONE_SEEN ? 0 : x);
  const points = candidates(curves)
    .map(({ curve, point }) => {
      const [family, limit, isZero] = [familyOf(point.setting), guaranteeOf(point), hasNoError(point)];
      const { shape, isHollow } = FAMILIES[family];
      const seen = isZero ? "no error seen" : `${measure.name} ${error(measure.of(point.errors))}`;
      return {
        curve, family, shape,
        x: limit === 0 ? EXACT : isZero ? NONE_SEEN : measure.of(point.errors),
        y: point.nanoseconds.median,
        isBest: rings.has(point),
        // A setting that broke its guarantee has none.
        isHollow: isHollow || limit === null,
        note: `${curve.name}, ${point.setting}: ${nanoseconds(point.nanoseconds.median)}, ${guaranteeInWords(limit)}` +
          (limit === 0 ? "" : `, ${seen}`),
      };
    })
    .filter((p) => !isNone(p.x))
    .sort((a, b) => place(a.x) - place(b.x) || a.y - b.y);
  const line = (curve, families) => points.filter((p) => p.curve === curve && families.includes(p.family));
  const series = curves.flatMap((curve) => [
    { name: curve.name, points: line(curve, ["default", "epsilon"]) },
    { name: curve.name, points: line(curve, ["default", "visits"]), isBroken: true },
    { name: curve.name, points: line(curve, ["certified"]) },
  ]);
  const used = new Set(points.map((p) => p.family));
  const key = Object.entries(FAMILIES).filter(([family]) => used.has(family))
    .map(([family, { name, isBroken, ...look }]) =>
      ({ ...look, text: name, isBroken: ["epsilon", "visits"].includes(family) ? !!isBroken : undefined }));
  const ring = { shape: "ring", text: "fastest for its guarantee, once built" };
  return plot(measure.axis, "ns per query", series, [...key, ring], [EXACT, NONE_SEEN]);
}

/** Plots the times of single queries over their rarity. */
const latencyPlot = (curves) =>
  plot(
    "one query in so many",
    "takes longer than so many ns",
    curves.map((curve) => {
      const { latency, queries } = defaultPoint(curve);
      const points = PERCENTILES.filter(([, , oneIn]) => latency && oneIn <= queries).map(([key, , x]) => {
        const y = latency[key];
        return { x, y, note: `${curve.name}: one in ${x} takes more than ${y} ns` };
      });
      return { name: curve.name, points };
    }),
  );

/** Plots the total time of building and querying over the number of queries. */
const totalPlot = (curves) =>
  plot(
    "queries",
    "seconds, with building",
    costs(curves).map((cost) => {
      const points = Array.from({ length: 15 }, (_, i) => {
        const x = 10 ** (2 + i / 2);
        const y = total(cost, x);
        return { x, y, note: `${cost.name}: ${count(x)} queries in ${seconds(y)} s, built` };
      });
      return { name: cost.name, points };
    }),
  );
