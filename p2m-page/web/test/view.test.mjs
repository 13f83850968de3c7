// Opens a page of the program in a browser, and compares what it shows with the answers of `p2m query`.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Page, parsed, skip } from "./browser.mjs";

let opened, page, answers;

before(async () => {
  if (skip) return;
  const queries = ["--random", "40", "--seed", "3", "--box-scale", "1.2"];
  opened = await Page.open(...queries, "--field", "24", "--levels", "4");
  page = opened.tab;
  answers = opened.query(...queries);
});

after(async () => opened?.close());

test("ten answers read as those of the program", { skip }, async () => {
  await page.focus("#picture");
  for (let i = 0; i < 10; i++) {
    await page.keyboard.press("n");
    assert.deepEqual(await opened.answer("answer"), parsed(answers[i]));
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

test("nothing failed and nothing was fetched", { skip }, () => {
  assert.deepEqual(opened.problems, []);
});
