// A histogram of values as SVG, whose bars have the colours of the scale.

import { count, element, namedRow, short, tableHead } from "./text.js";

const BINS = 48;
const [WIDTH, HEIGHT] = [288, 96];

// Returns the numbers of values in equal parts of the range between two limits. Values outside count to the outermost
// parts, so that no value is lost.
export function bins(values, low, high) {
  const counts = new Array(BINS).fill(0);
  for (const value of values) {
    if (Number.isNaN(value)) continue;
    const at = Math.floor((BINS * (value - low)) / (high - low));
    counts[Math.max(0, Math.min(BINS - 1, at))]++;
  }
  return counts;
}

// The legend of a scale and a histogram of values, which are made again when the values or the colours change.
export class Figure {
  // `read` returns what is shown: the scale, a name and the unit of the values, and those of which there is a histogram
  // with its options. Without a scale nothing is shown, and without values there is only the legend.
  constructor(read, attributes = {}) {
    this.read = read;
    this.pictures = element("div");
    this.details = element("details", { hidden: true }, element("summary", {}, "Histogram as a table"));
    this.element = element("div", attributes, this.pictures, this.details);
  }

  update() {
    const { scale, what, unit, values, options } = this.read();
    const { picture, table } = values ? histogram(values, scale, what, unit, options) : {};
    const pictures = scale ? [legend(scale, what, unit), picture] : [];
    this.pictures.replaceChildren(...pictures.filter(Boolean));
    // The summary stays, which may have the focus of the keyboard.
    this.details.hidden = !table;
    this.details.replaceChildren(...[this.details.firstChild, table].filter(Boolean));
  }
}

// Returns a histogram between the limits of a scale, as a picture and as a table. Each value stands for `weight`
// values, and lines are drawn at `marks`.
function histogram(values, scale, what, unit, { name = what, weight = 1, marks = [] } = {}) {
  const { low, high } = scale;
  const counts = bins(values, low, high).map((n) => Math.round(n * weight));
  const most = counts.reduce((a, b) => Math.max(a, b), 1);
  const width = WIDTH / BINS;
  const isBelow = values.some((value) => value < low);
  const isAbove = values.some((value) => value > high);
  // The outermost bars have the values beyond the limits as well.
  const range = (i) => {
    const [from, to] = ends(i).map(short);
    return i === 0 && isBelow ? `less than ${to}` : i === BINS - 1 && isAbove ? `${from} or more` : `${from} to ${to}`;
  };
  const ends = (i) => [low + ((high - low) * i) / BINS, low + ((high - low) * (i + 1)) / BINS];
  const bars = counts.map((n, i) => {
    const height = (HEIGHT * n) / most;
    const [from, to] = ends(i);
    const bar = element("rect", {
      x: i * width, y: HEIGHT - height, width: width - 0.5, height, fill: scale.css((from + to) / 2),
    });
    bar.append(element("title", {}, `${range(i)} ${unit}: ${count(n)}`));
    return bar;
  });
  const mode = counts.indexOf(Math.max(...counts));
  const label = `Histogram of ${name} from ${short(low)} to ${short(high)} ${unit}. ` +
    `The most frequent are ${range(mode)}, with ${count(counts[mode])} of ` +
    `${count(counts.reduce((a, b) => a + b, 0))}.` +
    (marks.length > 0 ? ` The tolerance is marked at ${marks.map(short).join(" and ")} ${unit}.` : "");
  const lines = marks.filter((x) => x >= low && x <= high).map((value) => {
    const x = (WIDTH * (value - low)) / (high - low);
    return element("line", { x1: x, x2: x, y1: 0, y2: HEIGHT, stroke: "currentColor", "stroke-dasharray": "4 3" });
  });
  const base = element("line", { x1: 0, x2: WIDTH, y1: HEIGHT, y2: HEIGHT, stroke: "currentColor" });
  const viewBox = `0 0 ${WIDTH} ${HEIGHT + 1}`;
  const rows = counts.map((n, i) => [i, n]).filter(([, n]) => n > 0).map(([i, n]) => namedRow(range(i), count(n)));
  const table = element("table", {}, tableHead([`${name} (${unit})`, "number"]), element("tbody", {}, ...rows));
  return { picture: element("svg", { viewBox, role: "img", "aria-label": label }, ...bars, ...lines, base), table };
}

// Returns the legend of a scale: its gradient, its limits and a value between them, with the unit. The value between is
// zero for a scale with two directions, where zero is, unless that is too close to a limit.
function legend(scale, what, unit) {
  const { low, high } = scale;
  const zero = (0 - low) / (high - low);
  const part = scale.isDiverging && zero > 0.2 && zero < 0.8 ? zero : 0.5;
  const bar = element("div", { class: "gradient" });
  bar.style.background = scale.gradient();
  const middle = element("span", { class: "middle" }, scale.text(part === zero ? 0 : low + part * (high - low)));
  middle.style.left = `${100 * part}%`;
  const ends = [low, high].map((value) => element("span", {}, scale.text(value)));
  return element("div", { class: "legend" }, element("div", {}, `${what} (${unit})`), bar,
    element("div", { class: "ticks" }, ends[0], middle, ends[1]));
}
