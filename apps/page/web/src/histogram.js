// The legend of a scale and a histogram of values as SVG, whose bars have the colours of the scale.

import { count, element, key, namedRow, patch, short, tableHead } from "./text.js";

const BINS = 48;
// The size of the picture, and the width of what stands apart at its ends for values beyond the limits.
const [WIDTH, HEIGHT] = [320, 110];
const [OUTER, GAP] = [12, 6];
// The distance in pixels within which a mark can be dragged.
const REACH = 14;

// Returns the numbers of values in equal parts of the range between two limits, and of those beyond the limits.
export function bins(values, low, high) {
  const counts = new Array(BINS).fill(0);
  let [below, above] = [0, 0];
  for (const value of values) {
    if (value < low) below++;
    else if (value > high) above++;
    else if (!Number.isNaN(value)) {
      counts[Math.min(BINS - 1, Math.floor((BINS * (value - low)) / (high - low)))]++;
    }
  }
  return { counts, below, above };
}

// The legend of a scale and a histogram of values, which are made again when the values or the colours change.
export class Figure {
  // `read` returns what is shown: the scale, a name and the unit of the values, those of which there is a histogram with
  // its options, and keys, which are colours without a value and what they mean. Without a scale nothing is shown, and
  // without values there is only the legend. The option `onMark` makes marks that can be dragged; it is called with the
  // value.
  constructor(read, attributes = {}) {
    this.read = read;
    this.pictures = element("div", { class: "figure" });
    this.details = element("details", { hidden: true }, element("summary", {}, "Histogram as a table"));
    this.element = element("div", attributes, this.pictures, this.details);
    this.listen();
  }

  update() {
    const { scale, what, unit, values, options, keys = [] } = this.read();
    this.options = options;
    const { picture, table, place } = values ? histogram(values, scale, what, unit, options) : {};
    this.place = place;
    const pictures = scale ? [picture, legend(scale, what, unit, place), ...keys.map(([colour, text]) => key(patch(colour), text))] : [];
    this.pictures.replaceChildren(...pictures.filter(Boolean));
    // The summary stays, which may have the focus of the keyboard.
    this.details.hidden = !table;
    this.details.replaceChildren(...[this.details.firstChild, table].filter(Boolean));
  }

  // Lets the pointer drag the marks.
  listen() {
    let isDragging = false;
    const valueAt = (event) => {
      const { left, width } = this.pictures.querySelector("svg").getBoundingClientRect();
      return this.place.value(((event.clientX - left) / width) * WIDTH);
    };
    const isNear = (event) => {
      const svg = this.pictures.querySelector("svg");
      if (!this.options?.onMark || !svg?.contains(event.target)) return false;
      const { left, width } = svg.getBoundingClientRect();
      return this.options.marks.some((mark) =>
        Math.abs(left + (this.place.x(mark) / WIDTH) * width - event.clientX) < REACH);
    };
    this.pictures.addEventListener("pointerdown", (event) => {
      if (!isNear(event)) return;
      isDragging = true;
      this.pictures.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    this.pictures.addEventListener("pointermove", (event) => {
      this.pictures.style.cursor = isDragging || isNear(event) ? "ew-resize" : "";
      if (isDragging) this.options.onMark(Math.abs(valueAt(event)));
    });
    for (const end of ["pointerup", "pointercancel"]) {
      this.pictures.addEventListener(end, () => (isDragging = false));
    }
  }
}

// Returns a histogram between the limits of a scale, as a picture and as a table, and where values are in it. Each value
// stands for `weight` values, and lines are drawn at `marks`.
function histogram(values, scale, what, unit, { name = what, weight = 1, marks = [], onMark } = {}) {
  const { low, high } = scale;
  const { counts, ...outer } = bins(values, low, high);
  for (let i = 0; i < BINS; i++) counts[i] = Math.round(counts[i] * weight);
  const [below, above] = [outer.below, outer.above].map((n) => Math.round(n * weight));
  const most = [...counts, below, above].reduce((a, b) => Math.max(a, b), 1);
  const [left, right] = [below > 0 ? OUTER + GAP : 0, WIDTH - (above > 0 ? OUTER + GAP : 0)];
  const place = {
    left, right,
    x: (value) => left + ((right - left) * (value - low)) / (high - low),
    value: (x) => Math.max(low, Math.min(high, low + ((high - low) * (x - left)) / (right - left))),
  };
  const range = (i) => `${short(low + ((high - low) * i) / BINS)} to ${short(low + ((high - low) * (i + 1)) / BINS)}`;
  const bar = (x, width, n, text, colour) => {
    const height = n > 0 ? Math.max(1, (HEIGHT * n) / most) : 0;
    const made = element("rect", { x, y: HEIGHT - height, width, height, fill: colour });
    made.append(element("title", {}, `${text} ${unit}: ${count(n)}`));
    return made;
  };
  const width = (right - left) / BINS;
  const entries = counts.map((n, i) => ({
    n, text: range(i), x: left + i * width, width: width - 0.6,
    colour: scale.css(low + ((high - low) * (i + 0.5)) / BINS),
  }));
  if (below > 0) {
    entries.unshift({ n: below, text: `less than ${short(low)}`, x: 0, width: OUTER, colour: scale.css(-Infinity) });
  }
  if (above > 0) {
    const text = `more than ${short(high)}`;
    entries.push({ n: above, text, x: WIDTH - OUTER, width: OUTER, colour: scale.css(Infinity) });
  }
  const bars = entries.map(({ n, text, x, width, colour }) => bar(x, width, n, text, colour));
  const mode = entries.reduce((a, b) => (b.n > a.n ? b : a));
  const label = `Histogram of ${name} from ${short(low)} to ${short(high)} ${unit}. ` +
    `The most frequent are ${mode.text}, with ${count(mode.n)} of ` +
    `${count(entries.reduce((sum, { n }) => sum + n, 0))}.` +
    (marks.length > 0 ? ` The tolerance is marked at ${marks.map(short).join(" and ")} ${unit}.` : "");
  const lines = marks.filter((x) => x >= low && x <= high).flatMap((value) => {
    const x = place.x(value);
    const line = element("line", { x1: x, x2: x, y1: 0, y2: HEIGHT, stroke: "currentColor", "stroke-dasharray": "4 3" });
    return onMark ? [line, element("path", { d: `M${x - 5} 0h10l-5 8z`, fill: "currentColor" })] : [line];
  });
  const base = element("line", { x1: left, x2: right, y1: HEIGHT, y2: HEIGHT, stroke: "currentColor" });
  const viewBox = `0 0 ${WIDTH} ${HEIGHT + 1}`;
  const rows = entries.filter(({ n }) => n > 0).map(({ n, text }) => namedRow(text, count(n)));
  const table = element("table", {}, tableHead([`${name} (${unit})`, "number"]), element("tbody", {}, ...rows));
  return { picture: element("svg", { viewBox, role: "img", "aria-label": label }, ...bars, ...lines, base), table, place };
}

// Returns the legend of a scale that lies over the picture: the bands that values are in, or the gradient.
export function pictureLegend(scale, what, unit, values) {
  if (!scale.ranges) return legend(scale, what, unit);
  return element("div", { class: "legend" }, ...scale.ranges(values).map(([colour, text]) => key(patch(colour), text)),
    element("div", { class: "small" }, `${what} (${unit})`));
}

// Returns the legend of a scale: its gradient, its limits and a value between them, with the unit. It lies below a
// histogram, whose places of values it has.
function legend(scale, what, unit, place) {
  const { low, high } = scale;
  const middle = scale.isDiverging ? 0 : (low + high) / 2;
  const bar = element("div", { class: "gradient" });
  bar.style.background = scale.gradient();
  const [below, above] = scale.isOpen;
  const words = [[below ? "≤ " : "", low], ["", middle], [above ? "≥ " : "", high]]
    .map(([sign, value]) => element("span", {}, sign + scale.text(value)));
  const made = element("div", { class: "legend" }, bar, element("div", { class: "ticks" }, ...words),
    element("div", { class: "small" }, `${what} (${unit})`));
  if (place) {
    made.style.marginLeft = `${(100 * place.left) / WIDTH}%`;
    made.style.marginRight = `${100 - (100 * place.right) / WIDTH}%`;
  }
  return made;
}
