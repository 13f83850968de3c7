// Opens a page of the program in a browser, and compares what it shows with the answers of `p2m query`. The variable P2M
// names the program. The tests are skipped where that or Chromium is missing.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { BROWSER, launch, open } from "./browser.mjs";

const PROGRAM = process.env.P2M;
const SCENE = new URL("../../../scenes/knot_and_cables.obj", import.meta.url);
const skip = !PROGRAM ? "P2M does not name the program" : !BROWSER ? "Chromium is not installed" : false;

let browser, page, answers, folder;
const problems = [];

// Makes the page of a scene and opens it.
function view(scene, ...options) {
  const html = join(folder, "other.html");
  execFileSync(PROGRAM, ["view", scene, ...options, "--out", html], { stdio: "pipe" });
  return open(browser, html, (problem) => problems.push(problem));
}

before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
  const [scene, html, csv] = ["scene.obj", "page.html", "answers.csv"].map((name) => join(folder, name));
  writeFileSync(scene, `o all\n${readFileSync(SCENE, "utf8")}`);
  const queries = ["--random", "40", "--seed", "3", "--box-scale", "1.2"];
  execFileSync(PROGRAM, ["view", scene, ...queries, "--field", "24", "--levels", "4", "--out", html], { stdio: "pipe" });
  execFileSync(PROGRAM, ["query", scene, ...queries, "--out", csv], { stdio: "pipe" });
  answers = readFileSync(csv, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  browser = await launch();
  page = await open(browser, html, (problem) => problems.push(problem));
});

after(async () => browser?.close());

const read = (name) =>
  page.evaluate((name) => {
    const term = [...document.querySelectorAll("#answer dt")].find((dt) => dt.textContent === name);
    return term?.nextElementSibling.textContent;
  }, name);

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

test("a slice through cells tells the length of the list where the pointer is", { skip }, async () => {
  for (const backend of ["octree", "p2m"]) {
    const lists = await view(fileURLToPath(SCENE), "--backend", backend, "--lists", "32");
    const stats = JSON.parse(execFileSync(PROGRAM, ["stats", fileURLToPath(SCENE), "--backend", backend, "--json"],
      { stdio: "pipe" }));
    const longest = await lists.evaluate(() => window.viewer.slice.values.reduce((a, b) => Math.max(a, b || 0), 0));
    assert.ok(2 ** longest > 1 && Math.round(2 ** longest) <= stats.lists.max, `${backend}: ${2 ** longest}`);
    await lists.mouse.move(430, 430);
    assert.match(await lists.textContent("#slice-value"), /^(\d+ primitives|no list: the tree answers) at /);
    await lists.close();
  }
});

// A scene of each kind is drawn, and the picture is not empty unless the scene is.
const SCENES = {
  mesh: "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
  lines: "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n",
  points: "v 0 0 0\nv 1 0 0\nv 0 1 2\np 1 2 3\n",
  mixed: "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nl 1 4\np 4\n",
  "far from the origin": "v 1000000 5000000 0\nv 1000001 5000000 0\nv 1000000 5000001 0\nf 1 2 3\n",
  empty: "OFF\n0 0 0\n",
};
for (const [kind, text] of Object.entries(SCENES)) {
  test(`a scene is drawn: ${kind}`, { skip }, async () => {
    const file = join(folder, text.startsWith("OFF") ? "kind.off" : "kind.obj");
    writeFileSync(file, text);
    const other = await view(file);
    const isDrawn = await other.evaluate(() => {
      const { viewer } = window;
      viewer.renderer.render(viewer.world, viewer.camera);
      const gl = viewer.renderer.getContext();
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return new Set(new Uint32Array(pixels.buffer)).size > 1;
    });
    assert.equal(isDrawn, kind !== "empty");
    await other.close();
  });
}

test("nothing failed and nothing was fetched", { skip }, () => {
  assert.deepEqual(problems, []);
});
