// Opens a page of the program in a browser, and compares what it shows with the answers of `p2m query`. The variable P2M
// names the program. The tests are skipped where that or Chromium is missing.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const PROGRAM = process.env.P2M;
const BROWSER = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
const SCENE = new URL("../../../scenes/knot_and_cables.obj", import.meta.url);
const skip = !PROGRAM ? "P2M does not name the program" : !BROWSER ? "Chromium is not installed" : false;

let browser, page, answers;
const problems = [];

before(async () => {
  if (skip) return;
  const folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
  const [scene, html, csv] = ["scene.obj", "page.html", "answers.csv"].map((name) => join(folder, name));
  writeFileSync(scene, `o all\n${readFileSync(SCENE, "utf8")}`);
  const queries = ["--random", "40", "--seed", "3", "--box-scale", "1.2"];
  execFileSync(PROGRAM, ["view", scene, ...queries, "--field", "24", "--levels", "4", "--out", html], { stdio: "pipe" });
  execFileSync(PROGRAM, ["query", scene, ...queries, "--out", csv], { stdio: "pipe" });
  answers = readFileSync(csv, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  browser = await chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  page = await opened(html);
});

// Opens a page, and keeps what goes wrong in it.
async function opened(html) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 800 } });
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("request", (request) => request.url().startsWith("http") && problems.push(request.url()));
  await page.goto(pathToFileURL(html).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  return page;
}

after(async () => browser?.close());

const read = (name, list = "answer", from = page) =>
  from.evaluate(([name, list]) => {
    const term = [...document.querySelectorAll(`#${list} dt`)].find((dt) => dt.textContent === name);
    return term?.nextElementSibling.textContent;
  }, [name, list]);

test("ten answers read as those of the program", { skip }, async () => {
  await page.focus("#picture");
  for (let i = 0; i < 10; i++) {
    await page.keyboard.press("n");
    const [qx, qy, qz, x, y, z, distance, primitive, feature] = answers[i];
    const numbers = async (name) => (await read(name)).split(", ").map(Number);
    assert.deepEqual(await numbers("query"), [qx, qy, qz].map(Number));
    assert.deepEqual(await numbers("closest point"), [x, y, z].map(Number));
    assert.deepEqual(await numbers("distance"), [Number(distance)]);
    assert.equal((await read("primitive")).split(" ")[1], primitive);
    assert.equal(await read("feature"), feature);
  }
});

test("a click selects the answer of a query point", { skip }, async () => {
  const place = await page.evaluate(() => {
    const { viewer } = window;
    const at = viewer.camera.position.clone().fromArray(viewer.answers.from, 3 * 5).project(viewer.camera);
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    return [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
  });
  await page.mouse.click(...place);
  assert.equal(await page.evaluate(() => window.viewer.answers.selected), 5);
});

test("dragging turns the view, and a shifted drag moves the slice", { skip }, async () => {
  const state = () => page.evaluate(() => [window.viewer.camera.position.toArray(), window.viewer.slicePart]);
  const drag = async () => {
    await page.mouse.move(400, 400);
    await page.mouse.down();
    await page.mouse.move(460, 360, { steps: 4 });
    await page.mouse.up();
  };
  const [position, part] = await state();
  await drag();
  const [turned, same] = await state();
  assert.notDeepEqual(turned, position);
  assert.equal(same, part);
  await page.keyboard.down("Shift");
  await drag();
  await page.keyboard.up("Shift");
  assert.ok((await state())[1] > part);
});

test("an object can be hidden, and levels of boxes shown", { skip }, async () => {
  const counts = () => page.evaluate(() => window.viewer.scene.drawnCounts());
  const whole = await counts();
  await page.click("#objects label >> nth=0");
  assert.notDeepEqual(await counts(), whole);
  await page.click("#objects button >> nth=0");
  assert.deepEqual(await counts(), whole);
  await page.focus("#picture");
  await page.keyboard.press("k");
  assert.match(await page.textContent("#level"), /^level 2: /);
  assert.ok(await page.isChecked("#show-cells"));
});

test("a page of deviations reads as the program, and its tolerance and colours can be changed", { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
  const [mesh, scan, html, csv] = ["mesh.ply", "scan.ply", "page.html", "table.csv"].map((name) => join(folder, name));
  const run = (...words) => execFileSync(PROGRAM, words, { stdio: "pipe", encoding: "utf8" });
  run("generate", "torus-knot", "--out", mesh);
  run("generate", "ico-sphere", "--out", scan);
  const deviation = ["deviation", scan, mesh, "--tolerance", "0.3"];
  run(...deviation, "--out", html);
  const report = JSON.parse(run(...deviation, "--out", csv, "--json"));
  const rows = readFileSync(csv, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  const page = await opened(html);

  // Ten points have the texts of the table.
  await page.focus("#picture");
  for (let i = 0; i < 10; i++) {
    await page.keyboard.press("n");
    const [x, y, z, , , , , deviation, primitive] = rows[i];
    assert.deepEqual((await read("point", "deviation", page)).split(", ").map(Number), [x, y, z].map(Number));
    assert.equal(Number(await read("deviation", "deviation", page)), Number(deviation));
    assert.equal(await read("primitive", "deviation", page), primitive);
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

  // The limit of colours changes the colours, the legend and nothing else.
  const colours = () => page.evaluate(() => [...window.viewer.deviations.colours.subarray(0, 300)]);
  const first = await colours();
  await page.fill("#limit", "2");
  assert.notDeepEqual(await colours(), first);
  assert.match(await page.textContent("#deviation-figures .ticks"), /^-202$/);
  assert.deepEqual(await parts(), counted(0.05));

  // A click reads the point in front.
  const [number, ...place] = await page.evaluate(() => {
    const { viewer } = window;
    const { deviations: layer, camera } = viewer;
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    const distances = [...layer.values.keys()]
      .map((i) => camera.position.distanceTo(camera.position.clone().fromArray(layer.drawn, 3 * i)));
    const i = distances.indexOf(Math.min(...distances));
    const at = camera.position.clone().fromArray(layer.drawn, 3 * i).project(camera);
    return [i, left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
  });
  await page.mouse.click(...place);
  assert.equal(await read("number", "deviation", page), `${number} of ${values.length}`);
  await page.mouse.move(place[0] + 1, place[1]);
  await page.waitForFunction(() => document.querySelector("#deviation-pointer").textContent.endsWith("at the pointer"));

  // What the check boxes and the buttons say happens.
  await page.uncheck("#show-scan");
  assert.equal(await page.evaluate(() => window.viewer.deviations.group.visible), false);
  await page.click("#largest button >> nth=0");
  const sizes = values.map(Math.abs);
  assert.equal(await read("number", "deviation", page), `${sizes.indexOf(Math.max(...sizes))} of ${values.length}`);
});

test("nothing failed and nothing was fetched", { skip }, () => {
  assert.deepEqual(problems, []);
});
