// Opens a page of `p2m deviation` in a browser, and compares what it shows with the table that the program writes.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { PROGRAM, Page, openTab, skip } from "./browser.mjs";

let opened;

after(async () => opened?.close());

test("a page of deviations reads as the program, and its tolerance and colours can be changed", { skip }, async () => {
  opened = await Page.open();
  const [mesh, scan, html, csv] = ["mesh.ply", "scan.ply", "deviations.html", "table.csv"]
    .map((name) => join(opened.folder, name));
  const run = (...words) => execFileSync(PROGRAM, words, { stdio: "pipe", encoding: "utf8" });
  run("generate", "torus-knot", "--out", mesh);
  run("generate", "ico-sphere", "--out", scan);
  const deviation = ["deviation", scan, mesh, "--tolerance", "0.3"];
  run(...deviation, "--out", html);
  const report = JSON.parse(run(...deviation, "--out", csv, "--json"));
  const rows = readFileSync(csv, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  const page = await openTab(opened.browser, html, (problem) => opened.problems.push(problem));

  // Ten points have the texts of the table.
  await page.focus("#picture");
  for (let i = 0; i < 10; i++) {
    await page.keyboard.press("n");
    const [x, y, z, , , , , deviation, primitive] = rows[i];
    assert.deepEqual((await opened.read("deviation", "point", page)).split(", ").map(Number), [x, y, z].map(Number));
    assert.equal(Number(await opened.read("deviation", "deviation", page)), Number(deviation));
    assert.equal(await opened.read("deviation", "primitive", page), primitive);
  }
  const table = await page.evaluate(() =>
    [...document.querySelectorAll("#statistics-table td")].map((cell) => Number(cell.textContent.replaceAll(",", ""))));
  assert.deepEqual(table, [report.deviations, report.missing, ...Object.values(report.statistics)]);

  // A tolerance counts the points outside of it as the program does.
  const values = rows.map((row) => Number(row[7]));
  const parts = async () => (await page.textContent("#deviation-parts")).match(/[\d,]+(?= \()/g)
    .map((text) => Number(text.replaceAll(",", "")));
  const counted = (x) => {
    const [above, below] = [values.filter((value) => value > x).length, values.filter((value) => value < -x).length];
    return [above, below, values.length - above - below];
  };
  assert.deepEqual((await parts()).slice(0, 2), [report.above, report.below]);
  assert.deepEqual(await parts(), counted(0.3));
  await page.fill("#tolerance", "0.05");
  assert.deepEqual(await parts(), counted(0.05));
  assert.match(await page.getAttribute("#deviation-figures svg", "aria-label"), /marked at -0.05 and 0.05/);

  // The outermost parts of the histogram have what is beyond the limit, and say so.
  await page.fill("#limit", "0.1");
  const parts48 = await page.$$eval("#deviation-figures tbody tr", (rows) =>
    rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const bin = (0.2 / 48);
  const expected = values.filter((value) => value >= 0.1 - bin).length;
  assert.match(parts48.at(-1)[0], /^0\.09583 or more$/);
  assert.ok(Math.abs(Number(parts48.at(-1)[1].replaceAll(",", "")) - expected) <= 1, `${parts48.at(-1)}, ${expected}`);
  // A number below zero changes nothing.
  await page.fill("#tolerance", "-1");
  assert.deepEqual(await parts(), counted(0.05));

  // The limit of colours changes the colours, the legend and nothing else.
  const colours = () => page.evaluate(() => [...window.viewer.deviations.colours.subarray(0, 300)]);
  const first = await colours();
  await page.fill("#limit", "2");
  assert.notDeepEqual(await colours(), first);
  assert.match(await page.textContent("#deviation-figures .ticks"), /^-202$/);
  assert.deepEqual(await parts(), counted(0.05));

  // A click reads the point in front.
  const numbered = (i) => `${i.toLocaleString("en-US")} of ${values.length.toLocaleString("en-US")}`;
  const [number, ...place] = await page.evaluate(() => {
    const { viewer } = window;
    const { deviations: layer, camera } = viewer;
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    const depths = [...layer.values.keys()]
      .map((i) => camera.position.clone().fromArray(layer.drawn, 3 * i).project(camera).z);
    const i = depths.indexOf(Math.min(...depths));
    const at = camera.position.clone().fromArray(layer.drawn, 3 * i).project(camera);
    return [i, left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
  });
  await page.mouse.click(...place);
  assert.equal(await opened.read("deviation", "number", page), numbered(number));
  await page.mouse.move(place[0] + 1, place[1]);
  await page.waitForFunction(() => document.querySelector("#deviation-pointer").textContent.endsWith("at the pointer"));

  // What the check boxes and the buttons say happens.
  await page.uncheck("#show-scan");
  assert.equal(await page.evaluate(() => window.viewer.deviations.group.visible), false);
  await page.click("#largest button >> nth=0");
  const sizes = values.map(Math.abs);
  const largest = sizes.indexOf(Math.max(...sizes));
  assert.equal(await opened.read("deviation", "number", page), numbered(largest));
  assert.deepEqual(opened.problems, []);
});
