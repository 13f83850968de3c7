// Numbers and elements for people to read.

// Returns a number with at most four digits, for legends and summaries.
export function short(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "undefined";
  const rounded = Number(value.toPrecision(4));
  return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
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

// Makes an element with attributes and children. A child that is no element is text.
export function element(name, attributes = {}, ...children) {
  const isSvg = ["svg", "rect", "text", "line", "g", "title"].includes(name);
  const made = isSvg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

// Replaces the content of a list by terms, each with its text.
export function fillList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, text]) => [element("dt", {}, term), element("dd", {}, String(text))]));
}

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
    ...cells.map((cell) => element("td", {}, String(cell))));
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
