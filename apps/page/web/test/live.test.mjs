// Compares the live queries of a page, which the library answers in the browser, with the answers of `p2m query`.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Page, parsed, skip } from "./browser.mjs";

let page, tab;

before(async () => {
  if (skip) return;
  page = await Page.open();
  tab = page.tab;
  await tab.waitForFunction(() => document.documentElement.dataset.live, undefined, { timeout: 60000 });
});

after(async () => page?.close());

// Moves the mouse and waits until the query under it is answered.
const move = async (x, y) => {
  await tab.mouse.move(x, y);
  await answered();
};
const answered = () => tab.waitForFunction(() => {
  const { live } = window.viewer;
  return !live.isBusy && live.shown.query === live.query;
});
const query = async () => {
  await answered();
  return (await page.read("live-answer", "query")).split(/,\s+/).map(Number);
};

test("ten answers where the mouse is are those of the program", { skip }, async () => {
  assert.equal(await tab.evaluate(() => document.documentElement.dataset.live), "ready");
  const shown = [];
  for (let i = 0; i < 10; i++) {
    await move(120 + 60 * i, 200 + 37 * ((i * i) % 11));
    assert.equal(await page.read("live-answer", "agreement"), "the 4 indexes give equal answers");
    shown.push(await page.answer("live-answer"));
  }
  const points = join(page.folder, "points.xyz");
  writeFileSync(points, shown.map((answer) => answer.slice(0, 3).join(" ")).join("\n"));
  assert.deepEqual(shown, page.query("--points", points).map(parsed));
  assert.equal(new Set(shown.map(String)).size, 10);
});

test("the work and the speed of each index are shown", { skip }, async () => {
  const rows = (table) =>
    tab.$$eval(`#${table} tbody tr`, (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const [work, speed] = [await rows("live-work"), await rows("live-speed")];
  for (const table of [work, speed]) {
    assert.deepEqual(table.map(([name]) => name), ["AABB tree", "k-DOP tree", "octree", "P2M index"]);
  }
  assert.ok(work.every(([, , , evaluated]) => Number(evaluated) >= 1), work.join("; "));
  assert.ok(speed.every(([, rate]) => Number(rate.replaceAll(",", "")) > 1000), speed.join("; "));
});

test("the keyboard moves the query", { skip }, async () => {
  const [x, y, z] = await query();
  await tab.focus("#live-y");
  await tab.keyboard.press("ArrowUp");
  const moved = await query();
  assert.deepEqual([moved[0], moved[2]], [x, z]);
  assert.ok(moved[1] > y);
  await tab.fill("#live-x", "0.125");
  assert.equal((await query())[0], 0.125);
  // Typing ends the following of the mouse.
  assert.ok(!(await tab.isChecked("#live-follow")));
  await tab.focus("[aria-label='depth of the query']");
  await tab.keyboard.press("ArrowRight");
  assert.notEqual((await query())[0], 0.125);
  await tab.focus("#picture");
  const before = await query();
  await tab.mouse.move(500, 500);
  assert.deepEqual(await query(), before);
  await tab.keyboard.press("q");
  await tab.mouse.move(510, 500);
  assert.notDeepEqual(await query(), before);
});

test("far from the origin ordinary arithmetic jumps", { skip }, async () => {
  await tab.click("#live-more summary");
  await tab.check("#live-far");
  for (let i = 0; i < 20; i++) await move(300 + 7 * i, 400 - 5 * i);
  const [worst, far] = await tab.evaluate(() => {
    const { live } = window.viewer;
    return [live.largestErrors, live.shown.far];
  });
  assert.ok(worst[0] < 1e-6 && worst[1] > 1e-3, String(worst));
  assert.ok(Math.abs(far.p2m.distance - far.distance) < 1e-6);
  assert.equal(await tab.locator("#live-far-table tbody tr").count(), 2);
  await tab.uncheck("#live-far");
  await answered();
  assert.equal(await tab.locator("#live-far-table").count(), 0);
});

test("a coordinate that is no number has no answer", { skip }, async () => {
  const [x] = await query();
  await tab.fill("#live-x", "");
  await answered();
  assert.equal(await page.read("live-answer", "query"), "Each coordinate has to be a number.");
  assert.equal(await page.read("live-answer", "distance"), undefined);
  await tab.fill("#live-x", String(x));
  assert.equal((await query())[0], x);
  // The mouse does not take away what was typed.
  await tab.mouse.move(333, 444);
  assert.equal((await query())[0], x);
  await tab.check("#live-follow");
});

test("without an index that cannot be built the others answer", { skip }, async () => {
  const other = await Page.open();
  await other.tab.waitForFunction(() => document.documentElement.dataset.live);
  await other.tab.evaluate(async () => {
    const { live } = window.viewer;
    // A worker fails as it does when the browser has too little memory for its index, and another one later.
    const { call } = Object.getPrototypeOf(live.indexes[0].worker);
    Object.getPrototypeOf(live.indexes[0].worker).call = function (name, ...values) {
      const fails = (name === "build" && values[0] === 1) || (name === "query" && values[0] === 2);
      return fails ? Promise.reject(new Error("unreachable")) : call.call(this, name, ...values);
    };
    live.indexes = [];
    await live.start();
  });
  assert.equal(await other.tab.textContent("#live-message"),
    "The k-DOP tree could not be built: unreachable. The octree has failed: unreachable.");
  await other.tab.mouse.move(400, 400);
  await other.tab.waitForFunction(() => window.viewer.live.shown.indexes.length === 2);
  assert.equal(await other.read("live-answer", "agreement"), "the 2 indexes give equal answers");
  assert.deepEqual(other.problems, []);
  await other.close();
});

test("a page without live queries has no panel for them", { skip }, async () => {
  const other = await Page.open("--live", "never");
  assert.equal(await other.tab.locator("#live").count(), 0);
  assert.deepEqual(other.problems, []);
  await other.close();
});

test("nothing failed and nothing was fetched", { skip }, () => assert.deepEqual(page.problems, []));
