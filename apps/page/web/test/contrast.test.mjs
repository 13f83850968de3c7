// Compares the colours of pages with the contrast that the guidelines WCAG 2.2 require: 4.5 for text (1.4.3), and 3 for
// what is drawn (1.4.11).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { BANDS, SCALES, THEMES, UNDEFINED } from "../src/colours.js";

const read = (path) => readFileSync(new URL(`../../../../${path}`, import.meta.url), "utf8");

// Returns the relative luminance of a colour, as the guidelines define it.
function luminance(hex) {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const x = parseInt(hex.slice(at, at + 2), 16) / 255;
    return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a, b) {
  const [x, y] = [luminance(a), luminance(b)].sort((a, b) => b - a);
  return (x + 0.05) / (y + 0.05);
}

// Returns the colours of a style by name, each with that of light and that of dark pages.
const colours = (style) =>
  Object.fromEntries([...style.matchAll(/--(\w+): light-dark\((#\w{6}), (#\w{6})\)/g)]
    .map(([, name, ...both]) => [name, both]));

test("text and marks have enough contrast", () => {
  const { ink, quiet, accent, good, bad, edge, paper, soft, raised } = colours(read("apps/page/src/style.css"));
  const marks = Object.values(colours(read("apps/cli/src/measure/tradeoff/page/report.html")));
  assert.equal(marks.length, 8);
  for (const theme of [0, 1]) {
    for (const text of [ink, quiet, accent, good, bad]) {
      for (const ground of [paper, soft, raised]) {
        assert.ok(contrast(text[theme], ground[theme]) >= 4.5, `${text[theme]} on ${ground[theme]}`);
      }
    }
    // The borders of controls.
    for (const ground of [paper, raised]) assert.ok(contrast(edge[theme], ground[theme]) >= 3);
    for (const mark of marks) assert.ok(contrast(mark[theme], paper[theme]) >= 3, mark[theme]);
  }
});

test("pictures have enough contrast", () => {
  for (const theme of ["light", "dark"]) {
    const { background, ...others } = THEMES[theme];
    const scales = [SCALES.sequential[theme], BANDS[theme]];
    const drawn = [...Object.values(others), ...scales.flat(), UNDEFINED];
    assert.equal(drawn.length, 22);
    for (const colour of drawn) assert.ok(contrast(colour, background) >= 3, `${colour} on ${background}`);
  }
});

test("the lightness of scales rises, or changes in one direction from the middle to both ends", () => {
  for (const theme of ["light", "dark"]) {
    const [sequential, field, signed] = ["sequential", "field", "signedField"]
      .map((kind) => SCALES[kind][theme].map(luminance));
    const rises = (values) => values.every((value, i) => i === 0 || value > values[i - 1]);
    assert.ok(rises(sequential));
    // Areas are light near the surface in both themes.
    assert.ok(rises([...field].reverse()));
    for (const half of [signed.slice(5), signed.slice(0, 6).reverse()]) assert.ok(rises(half.map((x) => -x)), String(half));
  }
});
