// Opens pages of results: of other commands than `p2m view`, of `p2m tradeoff`, and of scenes whose live queries wait.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { chmodSync, existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { PROGRAM, Page, openTab, skip } from "./browser.mjs";

let opened;
const run = (args, env = {}) =>
  execFileSync(PROGRAM, args, { stdio: "pipe", encoding: "utf8", env: { ...process.env, ...env } });
const path = (name) => join(opened.folder, name);
const open = (html, options) => openTab(opened.browser, html, (problem) => opened.problems.push(problem), options);

before(async () => {
  if (skip) return;
  opened = await Page.open("--live", "never");
  run(["generate", "ico-sphere", "--translate", "5", "0", "0", "--out", path("sphere.ply")]);
});

after(async () => opened?.close());

test("a page shows the distance of two scenes, and the farthest points", { skip }, async () => {
  for (const [command, verdict] of [["distance", /^The scenes are [\d.]+ mm apart\.$/], ["hausdorff", /^[\d.]+ to [\d.]+ mm at the farthest point\.$/]]) {
    const html = path(`${command}.html`);
    const report = JSON.parse(run([command, opened.scene, path("sphere.ply"), "--html", html, "--unit", "mm", "--json"]));
    const page = await open(html);
    assert.match(await page.textContent("#measures .verdict"), verdict);
    const [found, point] = command === "distance"
      ? [report.distance, report.scenes[1].nearest.point] : [report.lower_bound, report.scenes[1].farthest.point];
    const shown = await opened.read("measure", command === "distance" ? "distance" : "farthest", page);
    assert.equal(Number.parseFloat(shown), found);
    assert.deepEqual((await opened.read("measure", "sphere.ply", page)).split(", ").map(Number), point);
    // The sentence above is the only one in large print.
    assert.equal(await page.locator("#measure .main").count(), 0);
    // The coordinates that a reader sees have equal decimals, and are as far apart as the length beside them.
    const ends = await page.$$eval("#measure dd", ([, ...ends]) => ends.map((end) => end.textContent.split("; ")));
    assert.equal(new Set(ends.flat().map((x) => x.split(".")[1].length)).size, 1, String(ends));
    const apart = Math.hypot(...[0, 1, 2].map((k) => Number(ends[0][k]) - Number(ends[1][k])));
    assert.ok(Math.abs(apart - found) < 1e-4 * found, `${apart}: ${found}`);
    if (command === "hausdorff") {
      const [low, high] = (await page.textContent("#measures .verdict")).match(/^([\d.]+) to ([\d.]+) mm/).slice(1).map(Number);
      assert.equal(await page.textContent("#measures .verdict + p"), "No point of either scene is farther than this from the other scene.");
      assert.ok(low < high && Math.abs(low - report.lower_bound) < 1e-5 && Math.abs(high - report.upper_bound) < 1e-5);
    }
    // The label stands in the picture, between the points.
    await page.waitForSelector("#overlay .important");
    assert.match(await page.textContent("#overlay .important"), / mm$/);
    assert.equal(await page.locator("#objects label").count(), 2);
    // The scenes have different colours, and the view flies to the line between them.
    const [first, second] = await page.evaluate(() => [0, 1].map((k) => {
      const { scene } = window.viewer;
      return [...new Set([...scene.verticesOf(k)].map((i) => scene.colours.array.subarray(3 * i, 3 * i + 3).join()))];
    }));
    assert.ok(first.length === 1 && second.length === 1 && first[0] !== second[0], `${first}; ${second}`);
    await page.click("#fly");
    await page.waitForFunction(() => {
      const { controls, camera, measures } = window.viewer;
      const [a, b] = measures.ends(0);
      const size = camera.position.distanceTo(controls.target) * Math.tan((camera.fov / 360) * Math.PI);
      return controls.target.distanceTo(a.clone().lerp(b, 0.5)) < 1e-3 && size < 1.5 * a.distanceTo(b);
    });
    await page.close();
  }
});

test("a page shows a scan before and after it was aligned, and the matrix", { skip }, async () => {
  const [part, scan, html] = ["part.ply", "turned.ply", "align.html"].map(path);
  run(["generate", "torus-knot", "--out", part]);
  run(["convert", part, scan, "--rotate-z", "25", "--translate", "1", "2", "3"]);
  const report = JSON.parse(run(["align", scan, part, "--html", html, "--unit", "mm", "--json"]));
  const page = await open(html);
  assert.match(await page.textContent("#moved .verdict"), /^0 mm \(rounding: \de-1\d\) root mean square distance\.$/);
  assert.match(await page.textContent("#moved .verdict + p"), /^Warning: another pose fits about as well, .*\.$/);
  assert.equal(await page.locator("#notes").count(), 0);
  assert.match(await page.textContent("#moved-facts"), /root mean square0 \(rounding: \de-1\d\)/);
  assert.equal(Number(await opened.read("moved-facts", "root mean square", page)), report.rms);
  assert.equal(Number(await opened.read("moved-facts", "coverage in %", page)), 100 * report.coverage);
  const matrix = await page.$$eval("#matrix data", (all) => all.map((data) => Number(data.value)));
  assert.deepEqual(matrix, report.matrix.flat());
  // Copies of the vertices are where they were in the files.
  const [first, second] = [part, scan].map((file) => run(["convert", file, "-", "--to", "obj"]).split("\n")
    .filter((line) => line.startsWith("v ")).map((line) => line.slice(2).split(" ").map(Number)));
  const shown = (number) => page.evaluate((number) => {
    const { scene, frame } = window.viewer;
    return [...scene.verticesOf(number)].sort((a, b) => a - b)
      .map((i) => frame.coordinates(scene.positions.subarray(3 * i, 3 * i + 3)));
  }, number);
  const gap = (a, b) => Math.max(...a.map((point, i) => Math.max(...point.map((x, k) => Math.abs(x - b[i][k])))));
  assert.ok(gap(await shown(0), first) < 1e-5 && gap(await shown(1), first) < 1e-5);
  await page.click("#moved label:has-text('before')");
  assert.ok(gap(await shown(0), first) < 1e-5 && gap(await shown(1), second) < 1e-5);
  const position = await page.evaluate(() => window.viewer.scene.parts[0].geometry.getAttribute("position").version);
  assert.ok(position > 0);
  await page.click("#moved label:has-text('after')");
  assert.ok(gap(await shown(1), first) < 1e-5);
  await page.close();
});

test("a measured line is as long as the scale bar says", { skip }, async () => {
  const [sphere, beside, html] = ["near.ply", "beside.ply", "bar.html"].map(path);
  run(["generate", "ico-sphere", "--out", sphere]);
  // The last line is in front of the middle of the scene.
  const [long, short] = [["long.obj", "v 0 0 0\nv 0 20 0\nl 1 2\n"], ["short.obj", "v 4 0 0\nv 4 0 1\nl 1 2\n"]]
    .map(([name, text]) => opened.write(name, text));
  for (const [first, second, shift, up] of [
    [sphere, beside, ["4", "3", "0"], "z"], [sphere, beside, ["4", "0", "3"], "y"], [long, short, null, "z"],
  ]) {
    if (shift) run(["convert", first, second, "--translate", ...shift]);
    run(["distance", first, second, "--html", html, "--up", up]);
    const page = await open(html);
    const [line, bar] = await page.evaluate(() => {
      const { measures, camera, stage } = window.viewer;
      camera.updateMatrixWorld();
      const [a, b] = measures.ends(0).map((end) => end.project(camera));
      const pixels = Math.hypot((a.x - b.x) * stage.clientWidth, (a.y - b.y) * stage.clientHeight) / 2;
      const box = document.querySelector(".scale-bar");
      return [measures.lengths[0] / pixels, Number.parseFloat(box.textContent) / Number.parseFloat(box.firstChild.style.width)];
    });
    assert.ok(Math.abs(line / bar - 1) < 0.02, `${second}, ${up}: ${line} ${bar}`);
    await page.close();
  }
});

test("both of two parts are seen where they coincide", { skip }, async () => {
  const [sphere, copy, html] = ["sphere.ply", "same.ply", "same.html"].map(path);
  run(["convert", sphere, copy]);
  run(["hausdorff", sphere, copy, "--html", html]);
  const page = await open(html);
  // Reads how many pixels are grey and how many are green.
  const read = () => page.evaluate(() => {
    const { viewer } = window;
    viewer.measures.group.visible = false;
    viewer.painter.setScale(1);
    viewer.renderer.render(viewer.world, viewer.camera);
    const pixels = window.readPicture();
    const counts = [0, 0];
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = pixels.subarray(i, i + 3);
      if (Math.abs(r - pixels[0]) + Math.abs(g - pixels[1]) + Math.abs(b - pixels[2]) > 12) counts[g > b + 4 ? 1 : 0]++;
    }
    return counts;
  });
  const [grey, green] = await read();
  assert.ok(Math.min(grey, green) > 0.3 * (grey + green), `${grey} ${green}`);
  // One part alone has no holes.
  await page.click("#objects label >> nth=1");
  const [alone, none] = await read();
  assert.ok(none < 0.02 * alone && Math.abs(alone / (grey + green) - 1) < 0.02, `${alone} ${none}`);
  await page.close();
});

test("a moved scene is drawn where it was measured", { skip }, async () => {
  const html = path("moved.html");
  const matrix = "1 0 0 0  0 1 0 7  0 0 1 0";
  const report = JSON.parse(run(["distance", opened.scene, path("sphere.ply"), "--transform", matrix, "--html", html, "--json"]));
  const page = await open(html);
  const gap = await page.evaluate(() => {
    const { measures, data: { scene }, scene: { objects } } = window.viewer;
    const [, end] = measures.ends(0);
    const [first, last] = objects[1].triangles;
    const used = new Set(scene.triangles.subarray(3 * first, 3 * last));
    return Math.min(...[...used].map((i) => end.distanceTo(end.clone().fromArray(scene.positions, 3 * i))));
  });
  assert.ok(gap < 0.2, `${gap}: ${report.distance}`);
  await page.close();
});

test("a page shows the first hits of the rays of a table", { skip }, async () => {
  const [hits, html] = [path("hits.csv"), path("rays.html")];
  const report = JSON.parse(run(["ray", opened.scene, "--random", "50", "--out", hits, "--json"]));
  run(["view", opened.scene, "--rays", hits, "--live", "never", "--out", html]);
  const page = await open(html);
  const rows = readFileSync(hits, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  const hit = rows.filter((row) => row[7] !== "");
  assert.ok(hit.length > 5, JSON.stringify(report));
  assert.equal(await page.textContent("#measures .verdict"), `${hit.length} of 50 rays hit the scene.`);
  await page.click("#measures button >> nth=1");
  assert.deepEqual((await opened.read("measure", "to", page)).split(", ").map(Number), hit[0].slice(8, 11).map(Number));
  await page.close();
});

test("one index answers in a larger scene, and the others are built for their table", { skip }, async () => {
  const html = path("larger.html");
  run(["generate", "ico-sphere", "--frequency", "24", "--out", path("larger.ply")]);
  run(["view", path("larger.ply"), "--out", html]);
  const page = await open(html);
  await page.waitForFunction(() => document.documentElement.dataset.live === "ready", undefined, { timeout: 60000 });
  const names = () => page.$$eval("#live-speed tbody th", (cells) => cells.map((cell) => cell.textContent));
  assert.deepEqual(await names(), ["AABB tree"]);
  // There is an answer before anything was asked, in the picture as well.
  const words = await page.textContent("#live-answer dd.main");
  assert.match(words, /^outside, [\d.]+ units from the surface$/);
  assert.match(await page.textContent("#overlay .important"), /^outside, [\d.]+ units from the surface$/);
  assert.match(await opened.read("live-answer", "agreement", page), /^one index has answered/);
  await page.click("#live-more summary");
  await page.waitForFunction(() => window.viewer.live.indexes.every((index) => index.rate) &&
    window.viewer.live.indexes.length === 4, undefined, { timeout: 60000 });
  assert.deepEqual(await names(), ["AABB tree", "k-DOP tree", "octree", "P2M index"]);
  // What is drawn comes from the exact scene: vertices on the unit sphere, each in six triangles, or in five.
  const [lengths, uses] = await page.evaluate(() => {
    const { data: { scene }, frame } = window.viewer;
    const [lengths, uses] = [new Set(), {}];
    for (const i of scene.triangles) {
      lengths.add(Math.hypot(...frame.coordinates(scene.positions.subarray(3 * i, 3 * i + 3))).toFixed(5));
      uses[i] = (uses[i] ?? 0) + 1;
    }
    return [[...lengths], Object.values(uses)];
  });
  assert.deepEqual(lengths, ["1.00000"]);
  assert.deepEqual([uses.length, uses.filter((n) => n === 5).length], [5762, 12]);
  const { query, distance } = await page.evaluate(() => {
    const { live } = window.viewer;
    return { query: live.shown.query, distance: live.shown.answers[0].distance };
  });
  const gap = distance - (Math.hypot(...query) - 1);
  assert.ok(gap > -1e-6 && gap < 0.01, `${query}: ${distance}`);
  // Nothing hides the example, and its segment is long enough to be seen.
  const [pixels, hits] = await page.evaluate(() => {
    const { live: { shown }, live, camera, canvas, scene } = window.viewer;
    const [from, to] = [shown.query, shown.answers[0].point].map((point) => live.at(point).project(camera));
    const hits = window.viewer.caster(from.x, from.y).intersectObjects(scene.group.children).length;
    return [Math.hypot((to.x - from.x) * canvas.clientWidth, (to.y - from.y) * canvas.clientHeight) / 2, hits];
  });
  assert.ok(pixels >= 60 && hits === 0, `${pixels} ${hits}`);
  await page.close();
});

test("the answer of a trade-off stands first, and marks are read by pointer and keyboard", { skip }, async () => {
  const html = path("tradeoff.html");
  run(["tradeoff", opened.scene, "--random", "200", "--rounds", "2", "--html", html]);
  for (const viewport of [{ width: 1280, height: 800 }, { width: 390, height: 844 }]) {
    const page = await open(html, { viewport });
    assert.match(await page.textContent("#advice"), /^(For a million queries: )?(aabb|kdop|octree|p2m)( with certified)?, [\d,.]+ ns per query, exact$/);
    const [answer, chart, width] = await page.evaluate(() => [
      document.querySelector("#advice").getBoundingClientRect().bottom,
      document.querySelector("#plot svg").getBoundingClientRect().bottom, document.documentElement.scrollWidth,
    ]);
    assert.ok(answer < 400 && chart <= viewport.height + 40 && width <= viewport.width, `${answer} ${chart} ${width}`);
    const small = await page.$$eval("#plot svg text", (texts) =>
      texts.filter((text) => text.getBoundingClientRect().height < 10 && text.textContent).length);
    assert.equal(small, 0);
    // Each setting of each index has a mark, and no decade of the axis is empty of all marks but one.
    const marks = await page.$$eval("#plot .dot", (dots) => dots.map((dot) => dot.getAttribute("aria-label")));
    assert.equal(new Set(marks).size, 4 * 8);
    assert.ok(marks.some((text) => /, max visits 16: /.test(text)) && !marks.some((text) => /budget/.test(text)));
    // No label of the axis touches another one, names of lines are in the picture, and marks of a column lie apart.
    const { ticks, names, svg, gaps } = await page.evaluate(() => {
      const box = (element) => element.getBoundingClientRect().toJSON();
      const texts = [...document.querySelectorAll("#plot svg > text")];
      const baseline = Math.max(...texts.filter((text) => text.textContent === "exact").map((text) => text.getAttribute("y")));
      const dots = [...document.querySelectorAll("#plot .dot")].filter((dot) => / (default|certified): /.test(dot.ariaLabel))
        .map((dot) => ({ ...box(dot), index: dot.ariaLabel.split(",")[0] }));
      return {
        ticks: texts.filter((text) => Number(text.getAttribute("y")) === baseline).map((text) => [text.textContent, box(text)]),
        names: [...document.querySelectorAll("#plot .name-label")].map(box), svg: box(document.querySelector("#plot svg")),
        gaps: dots.flatMap((a, i) => dots.slice(0, i).filter((b) => b.index !== a.index).map((b) => Math.hypot(a.x - b.x, a.y - b.y))),
      };
    });
    ticks.sort(([, a], [, b]) => a.left - b.left).forEach(([text, { left }], i) =>
      assert.ok(i === 0 || left - ticks[i - 1][1].right >= 2, `${ticks[i - 1]?.[0]} ${text}`));
    assert.ok(ticks.some(([text]) => text === "0.01"), String(ticks.map(([text]) => text)));
    assert.ok(names.length === 4 && names.every(({ right }) => right <= svg.right), JSON.stringify(names));
    assert.ok(Math.min(...gaps) > 10, String(gaps));
    const [x, y] = await page.$$eval("#plot .dot", ([, dot]) => {
      const { left, top, width, height } = dot.getBoundingClientRect();
      return [left + width / 2, top + height / 2];
    });
    await page.mouse.move(x + 3, y);
    assert.ok(marks.includes(await page.textContent("#tip")));
    await page.mouse.move(2, 2);
    assert.ok(await page.isHidden("#tip"));
    await page.mouse.click(x, y);
    await page.mouse.move(2, 2);
    assert.ok(await page.isVisible("#tip"), "it stays after a click");
    await page.keyboard.press("Escape");
    assert.ok(await page.isHidden("#tip"));
    await page.focus("#plot .dot >> nth=3");
    assert.equal(await page.textContent("#tip"), await page.getAttribute("#plot .dot >> nth=3", "aria-label"));
    await page.close();
  }
});

test("--open starts the browser with the page", { skip }, async () => {
  const [script, log] = [opened.write("browser.sh", `#!/bin/sh\necho "$1" > "$0.log"\n`), path("browser.sh.log")];
  chmodSync(script, 0o755);
  const html = path("opened.html");
  run(["view", opened.scene, "--live", "never", "--out", html, "--open"], { BROWSER: script });
  assert.equal(readFileSync(log, "utf8").trim(), html);
  assert.ok(existsSync(html));
  assert.throws(() => run(["view", opened.scene, "--out", html, "--open"], { BROWSER: path("none") }), /cannot be run/);
});

test("nothing failed and nothing was fetched", { skip }, () => assert.deepEqual(opened.problems, []));
