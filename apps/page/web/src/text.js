// Numbers and elements for people to read.

// The digits of numbers in lists and tables. What is copied has all of them.
const DIGITS = 6;

// Returns a number with at most `digits` digits and with separators of thousands.
function figure(value, digits) {
  if (value === null || value === undefined || Number.isNaN(value)) return "undefined";
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  if (size === Infinity) return rounded < 0 ? "-infinity" : "infinity";
  if (size !== 0 && (size < 1e-5 || size >= 1e12)) return rounded.toExponential().replace("+", "");
  return rounded.toLocaleString("en-US", { maximumFractionDigits: 12, maximumSignificantDigits: digits });
}

// Returns a number with at most four digits, for legends and summaries.
export const short = (value) => figure(value, 4);

// Returns on which side of the surface a point with a signed distance is, if there is one.
export const sideOf = (signed) =>
  signed === undefined || Number.isNaN(signed) ? undefined : signed < 0 ? "inside" : signed > 0 ? "outside" : "on the surface";

// Returns a remark beside a zero that stands for an error of rounding.
export const roundingInWords = (length) => `(rounding: ${length.toExponential(0)})`;

// Returns the parts of a text that says where a point is that has a distance, in a scene with sides a signed one. `show`
// makes the part with the length.
export function distanceParts(value, isSigned, unit, show) {
  if (!isSigned) return [show(value), ` ${unit} from the scene`];
  return value === 0 ? [sideOf(value)] : [`${sideOf(value)}, `, show(Math.abs(value)), ` ${unit} from the surface`];
}

export const inWords = (value, isSigned, unit) => distanceParts(value, isSigned, unit, short).join("");

// Returns a text whose words have at most `most` characters. Longer ones lose their middle.
export const shortened = (text, most) => text.split(" ").map((word) => {
  const letters = [...word];
  const kept = Math.floor((most - 1) / 2);
  return letters.length > most ? `${letters.slice(0, kept).join("")}…${letters.slice(-kept).join("")}` : word;
}).join(" ");

// Makes an element that shows a number with six digits, or fewer, and has all of them to be copied.
export function number(value, digits = DIGITS) {
  if (typeof value !== "number" || Number.isNaN(value)) return "none";
  return element("data", { value: String(value) }, figure(value, digits));
}

// Makes elements and texts of several numbers with semicolons between them, because numbers have commas. Copies have
// commas between them. `show` makes the element of a number.
export const numbers = (values, show = (value) => number(value)) =>
  [...values].flatMap((value, i) => [...(i > 0 ? [element("data", { value: "," }, ";"), " "] : []), show(value)]);

// Lets copied numbers have all their digits.
export function copyAllDigits() {
  document.addEventListener("copy", (event) => {
    const selection = getSelection();
    if (selection.rangeCount === 0 || selection.isCollapsed || event.target.matches?.("input")) return;
    const box = element("div", {}, selection.getRangeAt(0).cloneContents());
    if (!box.querySelector("data")) return;
    event.clipboardData.setData("text/plain", fullText(box));
    event.preventDefault();
  });
}

// Returns the text of an element with all digits of its numbers, and with a line for each row.
function fullText(box) {
  for (const data of box.querySelectorAll("data")) data.textContent = data.getAttribute("value");
  for (const end of box.querySelectorAll("dd, tr, p, caption, h2")) end.append("\n");
  for (const gap of box.querySelectorAll("dt, td, th")) gap.append("\t");
  return box.textContent;
}

// Makes a button that copies an element with all digits.
export function copyButton(copied) {
  const button = element("button", { type: "button", onclick: async () => {
    await navigator.clipboard?.writeText(fullText(copied.cloneNode(true))).catch(() => {});
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = "Copy"), 1500);
  } }, "Copy");
  return button;
}

// Returns a whole number with separators of thousands.
export function count(value) {
  return value.toLocaleString("en-US");
}

// Returns a count with the singular or the plural of its noun.
export function counted(value, noun) {
  const plural = noun.endsWith("y") ? `${noun.slice(0, -1)}ies` : noun.endsWith("x") ? `${noun}es` : `${noun}s`;
  return `${count(value)} ${value === 1 ? noun : plural}`;
}

// Returns a distance between `least` and ten times that which is 1, 2 or 5 times a power of ten.
export function roundUp(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((digit) => digit * power >= least * (1 - 1e-12));
}

const SVG = ["svg", "rect", "text", "line", "g", "title", "path", "circle", "polyline"];

// Makes an element with attributes and children. A child that is no element is text.
export function element(name, attributes = {}, ...children) {
  const isSvg = SVG.includes(name);
  const made = isSvg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

// Makes the content of a cell or of an entry of a list: of a number, of several, of a text, in which numbers that are
// separated by commas and blanks are shortened, or of an element.
function content(value) {
  if (typeof value === "number") return [number(value)];
  if (Array.isArray(value) || ArrayBuffer.isView(value)) return numbers(value);
  if (typeof value === "string" && /^-?\d[-+.\de]*(,\s+-?\d[-+.\de]*)+$/.test(value)) {
    return numbers(value.split(",").map(Number));
  }
  return [value];
}

// The classes of entries that have a row without their term, which is a text and not a list.
const WHOLE_ROWS = { distance: "main", inside: "whole" };

// Makes paragraphs of remarks on a verdict, which stand below it.
export const remarksOn = (remarks) => remarks.map((remark) =>
  element("p", { class: `remark${remark.startsWith("Warning: ") ? " warning" : ""}` }, ...withCode(remark)));

// Replaces the content of a list by terms, which are texts or lists of elements and texts, each with its text, its number, its numbers or its element.
export function fillList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, value]) => [
      element("dt", {}, ...[term].flat()), element("dd", { class: typeof term === "string" && (WHOLE_ROWS[term] ?? false) }, ...content(value)),
    ]));
}

// Makes a symbol of the picture and what it means.
export const key = (symbol, text) => element("div", { class: "small" }, symbol, text);

// Makes the parts of a text, in which parts in backticks are code.
export const withCode = (text) => text.split("`").map((part, i) => (i % 2 ? element("code", {}, part) : part));

// Makes a patch of a colour of the picture, by its name, or of a colour in CSS.
export const patch = (colour) =>
  element("span", { class: "patch", style: `background: ${/^(#|rgb|linear)/.test(colour) ? colour : `var(--${colour})`}` });

// Makes the row of the names of columns.
export function tableHead(names) {
  return element("thead", {}, element("tr", {}, ...names.map((name) => element("th", { scope: "col" }, name))));
}

// Fills a table with rows, of which the first cell names the row.
export function fillTable(table, caption, head, rows) {
  table.replaceChildren(element("caption", {}, caption), tableHead(head),
    element("tbody", {}, ...rows.map((row) => namedRow(...row))));
}

// Scrolls the panel to an element, unless the whole page would scroll.
export function reveal(shown) {
  const panel = document.getElementById("panel");
  if (panel.scrollHeight > panel.clientHeight) shown.scrollIntoView({ block: "nearest" });
}

// Makes the row of a table whose first cell names it.
export function namedRow(name, ...cells) {
  return element("tr", {}, element("th", { scope: "row" }, name),
    ...cells.map((cell) => element("td", {}, ...content(cell))));
}

// Returns the number of the entry of a list of `length` that is `by` places from the selected one, or from the
// beginning if none is selected. The list has no end.
export function stepped(selected, by, length) {
  return (((selected < 0 && by < 0 ? 0 : selected) + by) % length + length) % length;
}

// Makes a check box with a label.
export function checkbox(label, isOn, change, id) {
  const box = element("input", { type: "checkbox", id, onchange: () => change(box.checked) });
  box.checked = isOn;
  return element("label", {}, box, ` ${label}`);
}

// Makes a choice between a few words, of which one is chosen. `change` is called with its number.
export function choice(name, words, chosen, change) {
  const labels = words.map((word, i) => {
    const radio = element("input", { type: "radio", name, value: i, onchange: () => change(i) });
    radio.checked = i === chosen;
    return element("label", {}, radio, element("span", {}, word));
  });
  return element("div", { class: "choice", role: "radiogroup", "aria-label": name }, ...labels);
}
