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
  return x >= 1e9 || x < 0.001
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
const hasNoError = ({ errors }) =>
  errors.unanswered === 0 && !isNone(errors.scaled.max) && errors.scaled.max <= data.exact_limit;
const GUARANTEES = new Map(data.settings.map(({ name, guarantee }) => [name, guarantee]));
/**
 * Returns the relative error that a setting guarantees, which is 0 for exact ones. It is null if the setting has no
 * guarantee, or if its answers did not keep it.
 */
function guaranteeOf(point) {
  const { setting, errors } = point;
  const limit = GUARANTEES.get(setting) ?? null;
  const isKept = errors.unanswered === 0 && errors.broken === 0 && (limit !== 0 || hasNoError(point));
  return isKept ? limit : null;
}
/** The largest errors that a reader may accept. */
const NEEDS = [
  { name: "exact", limit: 0 },
  { name: "1 % guaranteed", limit: 0.01 },
  { name: "10 % guaranteed", limit: 0.1 },
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
 * Returns the settings that are faster than all others with the same guarantee or a better one, the exact one first.
 * They are the rings of the chart, and the advice is made of them.
 */
function best(curves) {
  const time = ({ point }) => point.nanoseconds.median;
  const guaranteed = candidates(curves)
    .map((candidate) => ({ ...candidate, limit: guaranteeOf(candidate.point) }))
    .filter(({ limit }) => limit !== null)
    .sort((a, b) => a.limit - b.limit || time(a) - time(b) || a.rank - b.rank);
  const found = [];
  for (const candidate of guaranteed) {
    if (found.length === 0 || time(candidate) < time(found.at(-1))) found.push(candidate);
  }
  return found;
}
/** Returns the fastest setting that guarantees an error of at most `limit`. */
const fastest = (curves, limit) => best(curves).filter((candidate) => candidate.limit <= limit).at(-1);
function describe(candidate) {
  if (!candidate) return "-";
  const { curve, point } = candidate;
  const setting = point === defaultPoint(curve) ? "" : ` ${point.setting}`;
  return `${curve.name}${setting}, ${nanoseconds(point.nanoseconds.median)}`;
}

/** Returns the seconds to build each index, and those of a query with its fastest exact setting. */
const costs = (curves) =>
  curves.map((curve) => {
    const point = fastest([curve], 0)?.point ?? defaultPoint(curve);
    return { name: curve.name, build: point.build.seconds, query: point.nanoseconds.median * 1e-9 };
  });
const total = (cost, queries) => cost.build + queries * cost.query;
/** Returns the number of queries from which on `other` costs no more than `first`, or null if there is none. */
function breakEven(first, other) {
  if (other.build <= first.build && other.query <= first.query) return 0;
  return first.query > other.query ? Math.max(0, (other.build - first.build) / (first.query - other.query)) : null;
}
const turnsInWords = (turns) =>
  turns
    .map(({ name, from }) => (from > 0 ? `\`${name}\` from ${count(from)} queries on` : `\`${name}\``))
    .join(", then ");

/** The percentiles of times: their keys, their names, and the number of queries that each needs. */
const PERCENTILES = [
  ["p50", "50 %", 2],
  ["p90", "90 %", 10],
  ["p99", "99 %", 100],
  ["p999", "99.9 %", 1000],
];

/** The number of queries for which the headline names the index, in words below. */
const COMMON = 1e6;
/**
 * Returns what to take: in short for a million queries, and in sentences for other numbers. The index is that of
 * `p2m advise` for these queries, and its times are measured.
 */
function advice(set) {
  const [exact, rough] = NEEDS.map((need) => fastest(set.curves, need.limit));
  const point = ({ name }) => fastest(set.curves.filter((curve) => curve.name === name), 0)?.point;
  // An index that is built longer, but was no faster here, is left out.
  const turns = set.turns.filter(point).reduce((kept, turn) => {
    const isFaster = kept.length === 0 || point(turn).nanoseconds.median < point(kept.at(-1)).nanoseconds.median;
    return isFaster ? [...kept, turn] : kept;
  }, []);
  if (exact?.limit !== 0 || turns.length === 0) return ["No index answered all queries exactly", "The remarks in the table of all settings say why."];
  const here = Math.max(0, turns.findLastIndex(({ from }) => from <= COMMON));
  const [before, after] = [turns[here - 1], turns[here + 1]];
  const named = (turn, quoted) => {
    const [name, { setting }] = [turn.name, point(turn)];
    const words = quoted ? [`\`${name}\``, `\`${setting}\``] : [name, setting];
    return words[0] + (setting === DEFAULT ? "" : ` with ${words[1]}`);
  };
  const time = (turn) => nanoseconds(point(turn).nanoseconds.median);
  const few = before
    ? `For fewer than ${count(turns[here].from)} queries ${named(before, true)} takes less time in all, because it is built sooner. ` : "";
  const many = after
    ? `From ${count(after.from)} queries on ${named(after, true)} takes less time in all, building included: ${time(after)} ` +
      `per query. ` : "";
  const [slow, fast] = [point(turns[here]).nanoseconds, rough.point.nanoseconds];
  const isNoise = slow.min <= fast.max;
  const gain =
    rough.point === exact.point
      ? "No setting that guarantees errors of up to 1 % is faster."
      : `If errors of up to 1 % do no harm, \`${rough.curve.name}\` with \`${rough.point.setting}\` takes ` +
        `${nanoseconds(fast.median)}, ${(slow.median / fast.median).toPrecision(2)} times as fast` +
        `${isNoise ? ", within the noise of this measurement" : ""}.`;
  const job = turns.length > 1 ? "For a million queries: " : "";
  return [`${job}${named(turns[here])}, ${time(turns[here])} per query, exact`, few + many + gain];
}
/** Returns the indexes that have an exact setting. */
const exactCurves = (set) => set.curves.filter((curve) => fastest([curve], 0)?.limit === 0);

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
