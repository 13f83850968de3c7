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
    [...document.querySelectorAll("#statistics-table td")].map((cell) =>
      Number(cell.querySelector("data")?.getAttribute("value") ?? cell.textContent.replaceAll(",", ""))));
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

  // What is beyond the limit stands apart in the histogram.
  await page.fill("#limit", "0.1");
  const parts48 = await page.$$eval("#deviation-figures tbody tr", (rows) =>
    rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const numberOf = (text) => Number(text.replaceAll(",", ""));
  assert.deepEqual(parts48.at(-1), ["more than 0.1", values.filter((value) => value > 0.1).length.toLocaleString("en-US")]);
  assert.equal(parts48.reduce((sum, [, n]) => sum + numberOf(n), 0), values.length);
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
  await page.waitForFunction(() => /^(inside|outside), [\d.e-]+ units from the surface$/.test(document.querySelector("#tip").textContent));

  // What the check boxes and the buttons say happens.
  await page.uncheck("#show-scan");
  assert.equal(await page.evaluate(() => window.viewer.deviations.group.visible), false);
  await page.click("#largest button >> nth=0");
  const sizes = values.map(Math.abs);
  const largest = sizes.indexOf(Math.max(...sizes));
  assert.equal(await opened.read("deviation", "number", page), numbered(largest));
  assert.deepEqual(opened.problems, []);
});

test("a verdict comes first, bands show the tolerance, and worst places are flown to", { skip }, async () => {
  const [mesh, scan, html] = ["mesh.ply", "scan.ply", "bands.html"].map((name) => join(opened.folder, name));
  execFileSync(PROGRAM, ["deviation", scan, mesh, "--tolerance", "0.3", "--out", html], { stdio: "pipe" });
  const page = await openTab(opened.browser, html, (problem) => opened.problems.push(problem));
  const values = await page.evaluate(() => [...window.viewer.deviations.values]);
  const outside = values.filter((value) => Math.abs(value) > 0.3).length;
  const percent = Number(((100 * outside) / values.length).toPrecision(4));
  assert.equal(await page.textContent("#verdict"), `${percent} % of the points are out of tolerance (±0.3 units).`);
  const bottom = (id) => page.evaluate((id) => document.getElementById(id).getBoundingClientRect().bottom, id);
  assert.ok((await bottom("verdict")) < 300 && (await bottom("largest")) < 720, String(await bottom("largest")));

  // Points within the tolerance have one colour, and the others have colours by how far outside they are. The limit is
  // three tolerances.
  const bands = await page.evaluate(() => {
    const { deviations: { values, colours } } = window.viewer;
    const found = {};
    values.forEach((value, i) => {
      const size = Math.abs(value);
      const band = size <= 0.3 ? "within" : `${value > 0 ? "above" : "below"}${size > 0.9 ? " far" : ""}`;
      (found[band] ??= new Set()).add(colours.subarray(3 * i, 3 * i + 3).join());
    });
    return Object.entries(found).map(([band, colours]) => [band, [...colours]]);
  });
  assert.ok(bands.length >= 3, String(bands));
  for (const [band, colours] of bands) assert.equal(colours.length > 5, band === "above" || band === "below", `${band}: ${colours.length}`);
  const legend = await page.$$eval(".picture-legend .patch", (all) => all.map((patch) =>
    [patch.nextSibling.textContent, getComputedStyle(patch).backgroundColor, getComputedStyle(patch).backgroundImage]));
  const texts = { "above far": "above 0.9", above: "0.3 to 0.9", within: "within ±0.3", below: "-0.9 to -0.3", "below far": "below -0.9" };
  const { order, css } = await page.evaluate(() => {
    const { scale } = window.viewer.deviations;
    return { order: scale.ranges([2, 0.5, 0, -0.5, -2]).map(([, text]) => text), css: [2, 0.5, 0, -0.5, -2].map((x) => scale.css(x)) };
  });
  assert.deepEqual(legend.map(([text]) => text), order.filter((text) => bands.some(([band]) => texts[band] === text)));
  for (const [text, colour, image] of legend) {
    const graded = { "0.3 to 0.9": [0.3001, 0.8999], "-0.9 to -0.3": [-0.8999, -0.3001] }[text];
    if (!graded) assert.equal(colour.replaceAll(" ", ""), css[order.indexOf(text)]);
    else assert.match(image, /^linear-gradient/);
  }
  // The colour of a point depends on how far outside it is, up to the limit or the largest deviation.
  const ends = await page.evaluate(() => {
    const { scale } = window.viewer.deviations;
    const short = new scale.constructor(0.3, 0.9, true, 0.5);
    return [scale, short].map((s) => [0.3001, 0.4, s === short ? 0.5 : 0.9].map((x) => s.css(x)));
  });
  assert.deepEqual(ends.map(([near]) => near), ["rgb(179,131,0)", "rgb(179,131,0)"]);
  assert.deepEqual(ends.map(([, , far]) => far), ["rgb(196,36,31)", "rgb(196,36,31)"]);
  assert.ok(new Set(ends.flatMap(([near, middle, far]) => [near, middle, far])).size === 4, String(ends));
  await page.setViewportSize({ width: 390, height: 844 });
  const { bottom: low, right } = await page.$eval(".picture-legend", (box) => box.getBoundingClientRect().toJSON());
  assert.ok(low < 400 && right <= 390, `${low} ${right}`);
  await page.setViewportSize({ width: 1200, height: 800 });
  await page.click("#colours label:has-text('gradient')");
  assert.ok(await page.evaluate(() => new Set(window.viewer.deviations.colours).size) > 20);

  // A tolerance line is dragged.
  const line = await page.evaluate(() => {
    const svg = document.querySelector("#deviation-figures svg");
    svg.scrollIntoView();
    const [mark] = [...svg.querySelectorAll("line[stroke-dasharray]")].slice(-1);
    const { left, top, width } = svg.getBoundingClientRect();
    return [left + (Number(mark.getAttribute("x1")) / 320) * width, top + 40];
  });
  await page.mouse.move(...line);
  await page.mouse.down();
  await page.mouse.move(line[0] + 20, line[1], { steps: 3 });
  await page.mouse.up();
  const dragged = Number(await page.inputValue("#tolerance"));
  assert.ok(dragged > 0.35 && dragged < 0.9, String(dragged));

  // Worst places are apart, the first is the worst point, and the view flies there.
  const worst = await page.$$eval("#largest button", (buttons) => buttons.map((button) => Number(button.dataset.point)));
  const [least, radius] = await page.evaluate((worst) => {
    const { deviations, data } = window.viewer;
    const gaps = worst.flatMap((i, k) => worst.slice(0, k).map((j) => deviations.apart(i, j)));
    return [Math.min(...gaps), data.frame.radius];
  }, worst);
  // Their numbers stand in the picture, and their coordinates in the list. The legend of the bands is in the picture.
  const marks = await page.$$eval("#overlay .labels .mark", (marks) => marks.map((mark) => mark.textContent));
  // The view shows most of the worst places at first, the worst one among them.
  const behind = await page.$$eval("#overlay .labels .mark", (marks) => marks.map((mark) => mark.classList.contains("behind")));
  assert.ok(!behind[0] && behind.filter(Boolean).length <= behind.length / 2, String(behind));
  // No number hides another one, even from far away.
  const zoom = (factor) => page.evaluate(async (factor) => {
    window.viewer.turn(0, 0, factor);
    for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
  }, factor);
  await zoom(2.5);
  const boxes = await page.$$eval("#overlay .labels .mark", (marks) => marks.map((mark) => {
    const { left, top, width } = mark.getBoundingClientRect();
    return [left, top, width];
  }));
  boxes.forEach(([a, b, width], i) => boxes.slice(0, i).forEach(([c, d]) =>
    assert.ok(Math.hypot(a - c, b - d) >= width, String(boxes))));
  await zoom(0.4);
  // The first number has its value, and no number is pale.
  const first = await page.textContent("#largest button");
  assert.deepEqual(marks, worst.map((_, i) => (i > 0 ? String(i + 1) : `1: ${first.slice(1)} units`)));
  const faint = await page.$$eval("#overlay .labels .mark", (marks) => marks.filter((mark) => getComputedStyle(mark).opacity !== "1"));
  assert.equal(faint.length, 0);
  const rows = await page.$$eval("#largest td data", (all) => all.map((data) => Number(data.value)));
  const points = await page.evaluate((worst) =>
    worst.flatMap((i) => [...window.viewer.deviations.positions.subarray(3 * i, 3 * i + 3)]), worst);
  assert.deepEqual(rows, points);
  assert.ok(worst.length >= 3 && least >= 0.12 * radius, `${worst}: ${least}`);
  await page.click("#largest button >> nth=1");
  await page.waitForFunction((i) => {
    const { controls, deviations } = window.viewer;
    return controls.target.distanceTo(deviations.position(i)) < 1e-4;
  }, worst[1]);
  assert.equal(await page.evaluate(() => window.viewer.deviations.selected), worst[1]);

  // The model can have the colours instead of the scan.
  await page.click("#colours label:has-text('model')");
  const part = await page.evaluate(() => {
    const { deviations: { part, surface } } = window.viewer;
    return [part.visible, surface.visible, new Set(part.geometry.getAttribute("color").array).size > 3];
  });
  assert.deepEqual(part, [true, false, true]);
  assert.equal(await page.textContent("#colours .figure > .small"), "no point of the scan is near");
  assert.deepEqual(opened.problems, []);
});

test("points of a scan have at least three pixels", { skip }, async () => {
  const html = join(opened.folder, "three.html");
  const scan = opened.write("three.xyz", "0 0 0\n3 0 0\n0 3 0\n");
  execFileSync(PROGRAM, ["deviation", scan, opened.scene, "--unsigned", "--out", html], { stdio: "pipe" });
  const page = await openTab(opened.browser, html, (problem) => opened.problems.push(problem));
  const covered = await page.evaluate(() => {
    const { viewer } = window;
    // The points are as small as if the view were far away, and alone.
    viewer.deviations.dots.material.size = 1e-9;
    viewer.scene.group.visible = false;
    viewer.painter.setScale(1);
    viewer.renderer.render(viewer.world, viewer.camera);
    const pixels = window.readPicture();
    return new Uint32Array(pixels.buffer).filter((pixel, _, all) => pixel !== all[0]).length;
  });
  // A disc of three pixels covers seven of them, nearly.
  assert.ok(covered >= 3 * 5 && covered < 3 * 13, String(covered));
  assert.deepEqual(opened.problems, []);
});

test("a page says what distances without signs and distances between points mean", { skip }, async () => {
  const scan = opened.write("few.xyz", "0 0 1\n3 0 1\n0 3 1\n");
  for (const [scene, remark] of [
    [opened.write("part.xyz", "0 0 0\n3 0 0\n0 3 0\n"), /only points, about 3 units apart/],
    [join(opened.folder, "mesh.ply"), /^Without signs, /], [opened.scene, null],
  ]) {
    const html = join(opened.folder, "remark.html");
    execFileSync(PROGRAM, ["deviation", scan, scene, "--unsigned", "--out", html], { stdio: "pipe" });
    const page = await openTab(opened.browser, html, (problem) => opened.problems.push(problem));
    const remarks = await page.$$eval("#verdict ~ .remark", (all) => all.map((p) => p.textContent));
    if (remark) assert.ok(await page.$eval("#verdict + .remark", (p) => getComputedStyle(p).fontSize === getComputedStyle(document.body).fontSize));
    assert.equal(remarks.length, remark ? 1 : 0);
    if (remark) assert.match(remarks[0], remark);
    await page.close();
  }
  assert.deepEqual(opened.problems, []);
});
