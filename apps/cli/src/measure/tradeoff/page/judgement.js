"use strict";
// The measurements, how figures are written, and what they say.

const byId = (id) => document.getElementById(id);
const data = JSON.parse(byId("data").textContent);
const DEFAULT = data.settings[0].name;
const escaped = (text) =>
  String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
/** Escapes text, in which parts in backticks become code. */
const words = (text) => escaped(text).replace(/`([^`]*)`/g, "<code>$1</code>");
/** JSON has no NaN, so a figure that was not measured is null. */
const isNone = (value) => value === null || value === undefined;
const exponential = (x, digits) => x.toExponential(digits).replace("+", "");
const error = (x) => (isNone(x) ? "-" : x <= 0 ? "0" : x >= 0.1 && x < 1000 ? x.toFixed(1) : exponential(x, 1));
const seconds = (x) => (x < 1e-3 ? exponential(x, 1) : x < 10 ? x.toFixed(3) : x.toFixed(1));
const figure = (x) => (x >= 100 ? x.toFixed(0) : x >= 10 ? x.toFixed(1) : x >= 0.01 ? x.toFixed(3) : error(x));
const percentage = (part, total) => (part === 0 ? "0" : `${error((100 * part) / total)} %`);
/** Formats a count, of at least a million in words. */
const count = (x) =>
  x < 1e3
    ? x.toFixed(0)
    : x < 1e6
      ? Number(x.toPrecision(3)).toLocaleString("en-US")
      : `${(x / 1e6).toFixed(x < 1e9 ? 1 : 0)} million`;
/** Formats nanoseconds. */
const nanoseconds = (x) => `${Number(x.toPrecision(x < 1e4 ? 4 : 3)).toLocaleString("en-US", { maximumFractionDigits: x < 100 ? 1 : 0 })} ns`;
/** Formats the label of a tick. */
const tickLabel = (x) => {
  const short = (value, unit) => Number(value.toPrecision(2)) + unit;
  return x >= 1e9 || x < 0.01
    ? exponential(x, 0)
    : x >= 1e6
      ? short(x / 1e6, "M")
      : x >= 1e4
        ? short(x / 1e3, "k")
        : short(x, "");
};
/** Returns a table whose first columns are names. */
function table(head, names, rows, kind = "") {
  const row = (tag, cells) =>
    `<tr>${cells.map((cell, i) => `<${tag}${i < names ? ' class="name"' : ""}>${words(cell)}</${tag}>`).join("")}</tr>`;
  const body = rows.map((cells) => row("td", cells)).join("\n");
  return `<div class="wide ${kind}"><table><thead>${row("th", head)}</thead><tbody>${body}</tbody></table></div>`;
}

// Judgements

const defaultPoint = (curve) => curve.points.find((point) => point.setting === DEFAULT) ?? curve.points[0];
/** An error of 16 u M is what the contract allows: 8 for the primitive of the answer, and 8 for the nearest one. */
const isExact = ({ errors }) =>
  errors.unanswered === 0 && !isNone(errors.scaled.max) && errors.scaled.max <= data.exact_limit;
const isWithin = ({ errors }, limit) =>
  errors.unanswered === 0 && !isNone(errors.relative.max) && errors.relative.max <= limit;
const NEEDS = [
  { name: "no error but rounding", isMet: (point) => isExact(point) && point.setting === DEFAULT },
  { name: "up to 1 %", isMet: (point) => isExact(point) || isWithin(point, 0.01) },
  { name: "up to 10 %", isMet: (point) => isExact(point) || isWithin(point, 0.1) },
];
const JOBS = [
  [1e4, "10,000 queries, built"],
  [1e6, "a million, built"],
  [1e8, "100 million, built"],
];

/** Returns all settings of all indexes. The rank of a setting is its place, from the most accurate one on. */
const candidates = (curves) =>
  curves.flatMap((curve) => curve.points.map((point, rank) => ({ curve, rank, point })));

/**
 * Returns the fastest setting that meets a need. Of settings that are slower by no more than noise, it is the most
 * accurate one.
 */
function fastest(curves, isMet) {
  const byTime = (a, b) => a.point.nanoseconds.median - b.point.nanoseconds.median;
  const met = candidates(curves)
    .filter(({ point }) => isMet(point))
    .sort(byTime);
  const equallyFast = met.filter(({ point }) => point.nanoseconds.min <= met[0].point.nanoseconds.max);
  return equallyFast.sort((a, b) => a.rank - b.rank || byTime(a, b))[0];
}
function describe(best) {
  if (!best) return "-";
  const { curve, point } = best;
  const setting = point === defaultPoint(curve) ? "" : ` ${point.setting}`;
  const worst = isExact(point) ? "" : `, error ${error(point.errors.relative.max)}`;
  return `${curve.name}${setting}, ${nanoseconds(point.nanoseconds.median)}${worst}`;
}

/** Returns the seconds to build each index, and those of a query with its default setting. */
const costs = (curves) =>
  curves.map((curve) => {
    const point = defaultPoint(curve);
    return { name: curve.name, build: point.build.seconds, query: point.nanoseconds.median * 1e-9 };
  });
const total = (cost, queries) => cost.build + queries * cost.query;
/** Returns the number of queries from which on `other` costs no more than `first`, or null if there is none. */
function breakEven(first, other) {
  if (other.build <= first.build && other.query <= first.query) return 0;
  return first.query > other.query ? Math.max(0, (other.build - first.build) / (first.query - other.query)) : null;
}
/** Returns which costs are least, and the numbers of queries from which on they are, in increasing order. */
function cheapest(all) {
  const turns = [];
  let next = [...all].sort((a, b) => a.build - b.build || a.query - b.query).map((cost) => ({ cost, from: 0 }))[0];
  while (next) {
    turns.push(next);
    const { cost: current } = next;
    const faster = all.filter((cost) => cost.query < current.query);
    next = faster
      .map((cost) => ({ cost, from: breakEven(current, cost) }))
      .sort((a, b) => a.from - b.from || a.cost.query - b.cost.query)[0];
  }
  return turns;
}
const turnsInWords = (all) =>
  cheapest(all)
    .map(({ cost, from }) => (from > 0 ? `\`${cost.name}\` from ${count(from)} queries on` : `\`${cost.name}\``))
    .join(", then ");

/** Returns what to take: in short, and in sentences. */
function advice(set) {
  const exact = set.curves.filter((curve) => isExact(defaultPoint(curve)));
  const [best, rough] = [NEEDS[0], NEEDS[1]].map((need) => fastest(set.curves, need.isMet));
  if (!best) return ["No index answered all queries exactly", "The remarks in the table of all settings say why."];
  const turns = cheapest(costs(exact));
  const turn = turns.findIndex(({ cost }) => cost.name === best.curve.name);
  const before = turns[turn - 1];
  const from = turns[turn]?.from > 0 ? `; pays from ${count(turns[turn].from)} queries on` : "";
  const few = before ? `For fewer queries \`${before.cost.name}\` takes less time, because it is built sooner. ` : "";
  const gain =
    rough.point === best.point
      ? "No setting with errors of up to 1 % is faster beyond noise."
      : `If errors of up to 1 % do no harm, \`${rough.curve.name}\` with \`${rough.point.setting}\` takes ${nanoseconds(rough.point.nanoseconds.median)}.`;
  return [`${best.curve.name}, ${nanoseconds(best.point.nanoseconds.median)} per query, exact${from}`, few + gain];
}

/** Returns remarks about a setting in words. */
function remarks(set, { curve, point }) {
  const { errors, queries, nanoseconds } = point;
  const of = (part, what) => part > 0 && `${part} of ${errors.compared} ${what}`;
  const usual = defaultPoint(curve);
  const isNoFaster = point.setting !== usual.setting && usual.nanoseconds.min <= nanoseconds.max;
  return [
    queries < maxQueries(set) && `${queries} queries`,
    of(errors.unanswered, "unanswered"),
    of(errors.broken, "farther than promised"),
    of(errors.bounds_above_truth, "bounds above the truth"),
    isNoFaster && "no faster",
  ]
    .filter(Boolean)
    .join(", ");
}
const maxQueries = (set) => Math.max(...candidates(set.curves).map(({ point }) => point.queries));
