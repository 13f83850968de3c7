// Opens a page of the program in a browser, and compares what it shows with the answers of `p2m query`.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { PROGRAM, Page, launch, openTab, parsed, skip } from "./browser.mjs";

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

test("a slice through cells tells the length of the list where the pointer is", { skip }, async () => {
  for (const backend of ["octree", "p2m"]) {
    const lists = await opened.view(opened.scene, "--backend", backend, "--lists", "32");
    const stats = JSON.parse(execFileSync(PROGRAM, ["stats", opened.scene, "--backend", backend, "--json"],
      { stdio: "pipe" }));
    const longest = await lists.evaluate(() => window.viewer.slice.values.reduce((a, b) => Math.max(a, b || 0), 0));
    assert.ok(2 ** longest > 1 && Math.round(2 ** longest) <= stats.lists.max, `${backend}: ${2 ** longest}`);
    await lists.mouse.move(430, 430);
    await lists.waitForFunction(() => document.querySelector("#slice-value").textContent !== "");
    assert.match(await lists.textContent("#slice-value"), /^(\d+ primitives|no list: the tree answers) at /);
    await lists.close();
  }
});

test("queries without an answer are counted, and their closest points are not drawn", { skip }, async () => {
  for (const [limit, text] of [["0", /^5 of 5 queries have no answer\.$/], ["0.4", /^\d of 5 queries have no /]]) {
    const other = await opened.view(opened.scene, "--random", "5", "--seed", "3", "--max-distance", limit);
    assert.match(await other.textContent("#distances p"), text);
    if (limit !== "0") assert.equal(await other.textContent("#distances .figure > .small"), "no answer");
    assert.equal(await other.locator("#distances svg").count(), limit === "0" ? 0 : 1);
    await other.close();
  }
});

test("without WebGL the panel has all answers", { skip }, async () => {
  const browser = await launch(false);
  try {
    const other = await openTab(browser, join(opened.folder, "page.html"), () => {});
    assert.match(await other.textContent("#failure"), /has no WebGL/);
    assert.match(await other.textContent("#distances p"), /have no answer/);
    await other.locator("#selected button >> nth=1").click();
    assert.equal(await other.locator("#answer dt").last().textContent(), "number");
  } finally {
    await browser.close();
  }
});

test("the keyboard alone moves the view and reads the slice", { skip }, async () => {
  await page.focus("#picture");
  await page.keyboard.press("f");
  const state = () => page.evaluate(() => {
    const { camera, controls: { target } } = window.viewer;
    return [camera.position.clone().sub(target).toArray(), target.toArray()];
  });
  const [offset, target] = await state();
  await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("Shift+ArrowUp");
  const [same, moved] = await state();
  same.forEach((x, k) => assert.ok(Math.abs(x - offset[k]) < 1e-6));
  assert.ok(Math.hypot(...moved.map((x, k) => x - target[k])) > 0.01);
  await page.keyboard.press("z");
  await page.keyboard.press("v");
  const [value, at] = (await page.textContent("#slice-value")).split(" at ");
  const position = at.split("; ").map(Number);
  const [[, , , , , , distance]] = opened.query("--points", opened.write("middle.xyz", position.join(" ")));
  // The field has 24 points along its longest side, and is linear between them.
  assert.ok(Math.abs(Number.parseFloat(value) - Number(distance)) < 0.1, `${value}, not ${distance}`);
  assert.equal(await page.getAttribute("#slice-value", "aria-live"), "polite");
  await page.keyboard.press("y");
  await page.keyboard.press("f");
});

test("the view contains the scene, and cannot be moved away from it", { skip }, async () => {
  await page.focus("#picture");
  await page.keyboard.press("f");
  // Returns the greatest part of the free picture, from its middle to its side, at which there are positions.
  const reach = (tab, isSlice) => tab.evaluate((isSlice) => {
    const { camera, scene, slice, stage: { clientHeight: height } } = window.viewer;
    const [top, bottom] = [document.getElementById("toolbar").getBoundingClientRect().bottom, 30];
    camera.updateMatrixWorld();
    const positions = isSlice ? slice.corners : scene.parts[0].geometry.getAttribute("position").array;
    const all = Array.from({ length: positions.length / 3 }, (_, i) =>
      camera.position.clone().fromArray(positions, 3 * i).project(camera));
    return Math.max(...all.map(({ x, y }) =>
      Math.max(Math.abs(x), Math.abs(2 * (((1 - y) / 2) * height - top) / (height - top - bottom) - 1))));
  }, isSlice);
  // In a flat picture, the height limits the size.
  const { width, height } = page.viewportSize();
  await page.setViewportSize({ width, height: 400 });
  // Before the browser has laid the page out again, the picture has the height of the stage as well.
  await page.waitForFunction(() => window.viewer.stage.clientHeight === 400 && window.viewer.canvas.height === 400);
  await page.keyboard.press("f");
  // The slice is not cut off, and not below the toolbar.
  const slice = await reach(page, true);
  assert.ok(slice < 1 && slice > 0.9, String(slice));
  // Without one, the scene fills four fifths of the free picture.
  await page.uncheck("#show-slice");
  await page.keyboard.press("f");
  const size = await reach(page, false);
  assert.ok(size < 0.85 && size > 0.75, String(size));
  await page.check("#show-slice");
  await page.setViewportSize({ width, height });
  await page.focus("#picture");
  for (let i = 0; i < 200; i++) await page.keyboard.press("Shift+ArrowRight");
  const distance = await page.evaluate(() => window.viewer.controls.target.length() / window.viewer.data.frame.radius);
  assert.ok(distance > 1 && distance < 2.001, String(distance));
  await page.keyboard.press("f");
});

test("in a narrow window an answer does not scroll the picture away", { skip }, async () => {
  const other = await opened.view(opened.scene, "--random", "20", "--seed", "3");
  await other.setViewportSize({ width: 320, height: 640 });
  await other.focus("#picture");
  await other.keyboard.press("n");
  assert.equal(await other.evaluate(() => scrollY), 0);
  // The label of the answer is short there, and stands at a border of the picture.
  await other.waitForSelector("#overlay .important");
  assert.match(await other.textContent("#overlay .important"), /^[\d.]+ units$/);
  const [above, below] = await other.evaluate(() => {
    const { top, bottom } = document.querySelector("#overlay .important").getBoundingClientRect();
    return [top - document.querySelector("#toolbar").getBoundingClientRect().bottom, window.viewer.stage.clientHeight - bottom];
  });
  assert.ok((above >= 0 && above < 30) || (below >= 0 && below < 30), `${above} ${below}`);
  assert.ok(await other.evaluate(() => document.documentElement.scrollWidth) <= 320);
  await other.close();
});

test("the histogram is a table too, and the rims of points have the colour of the theme", { skip }, async () => {
  const state = () => page.evaluate(() => {
    const rows = [...document.querySelectorAll("#distances table tbody td")].map((cell) => Number(cell.textContent));
    return [rows.reduce((a, b) => a + b, 0), window.viewer.answers.rim.value.getHexString()];
  });
  const [sum, rim] = await state();
  assert.equal(sum, 40);
  await page.click("#theme");
  const [same, other] = await state();
  assert.equal(same, 40);
  assert.notEqual(other, rim);
  await page.click("#theme");
  assert.deepEqual(await state(), [sum, rim]);
});

test("the theme follows the system until one is chosen", { skip }, async () => {
  const other = await opened.view(opened.scene);
  for (const colorScheme of ["dark", "light"]) {
    await other.emulateMedia({ colorScheme });
    await other.waitForFunction((theme) => document.documentElement.dataset.theme === theme, colorScheme);
  }
  await other.click("#theme");
  for (const colorScheme of ["dark", "light"]) {
    await other.emulateMedia({ colorScheme });
    // The event of a change comes with the next picture.
    await other.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.equal(await other.evaluate(() => document.documentElement.dataset.theme), "dark");
  }
  // Keys that do nothing in this page are not listed.
  assert.doesNotMatch(await other.textContent("#keys"), /slice|level/);
  await other.close();
});

test("the scene is cut open at the slice, on the side of the viewer", { skip }, async () => {
  await page.keyboard.press("f");
  const planes = () => page.evaluate(() => {
    const { scene, slice, camera } = window.viewer;
    const [plane] = scene.materials.triangles.clippingPlanes ?? [];
    // What is on the negative side of the plane is cut away.
    return plane && [Math.sign(plane.distanceToPoint(camera.position)), slice.plane(1).normal.dot(plane.normal)];
  });
  const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await drawn();
  const [side, direction] = await planes();
  assert.equal(side, -1);
  assert.equal(Math.abs(direction), 1);
  await page.evaluate(() => window.viewer.turn(Math.PI, 0, 1));
  await drawn();
  assert.deepEqual(await planes(), [-1, -direction]);
  await page.uncheck("#show-cut");
  await drawn();
  assert.equal((await planes()) ?? null, null);
  await page.check("#show-cut");
  await page.keyboard.press("f");
});

test("answers have the colours of the slice, and fade away from it", { skip }, async () => {
  await page.keyboard.press("f");
  const strengths = () => page.evaluate(async () => {
    window.viewer.draw();
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const { viewer } = window;
    const { answers, camera, renderer, stage, slice } = viewer;
    // Nothing but the dots is drawn, with all pixels.
    viewer.painter.setScale(1);
    const shown = [viewer.scene.group, slice.mesh, answers.segments, answers.feet].filter((part) => part.visible);
    shown.forEach((part) => (part.visible = false));
    renderer.render(viewer.world, camera);
    const gl = renderer.getContext();
    const pixel = new Uint8Array(4);
    const read = Array.from(answers.values, (_, i) => {
      const at = camera.position.clone().fromArray(answers.from, 3 * i).project(camera);
      gl.readPixels(((at.x + 1) / 2) * stage.clientWidth - 2, ((at.y + 1) / 2) * stage.clientHeight, 1, 1, gl.RGBA,
        gl.UNSIGNED_BYTE, pixel);
      const plane = slice.plane(1);
      const away = Math.abs(plane.distanceToPoint(at.fromArray(answers.from, 3 * i))) / viewer.data.frame.radius;
      return { away, darkness: 247 - pixel[0] };
    });
    shown.forEach((part) => (part.visible = true));
    return { read, isOneScale: answers.scale === slice.scale };
  });
  const mean = (list) => list.reduce((sum, { darkness }) => sum + darkness, 0) / list.length;
  const { read, isOneScale } = await strengths();
  assert.ok(isOneScale);
  const [near, far] = [read.filter(({ away }) => away < 0.1), read.filter(({ away }) => away > 0.3)];
  assert.ok(near.length > 2 && far.length > 2 && mean(near) > 2 * mean(far), `${mean(near)} ${mean(far)}`);
  // Without the slice nothing fades.
  await page.uncheck("#show-slice");
  const plain = (await strengths()).read.filter(({ away }) => away > 0.3);
  assert.ok(mean(plain) > 2 * mean(far), `${mean(plain)} ${mean(far)}`);
  await page.check("#show-slice");
});

test("a slice has the colours of its scale", { skip }, async () => {
  const other = await opened.view(opened.scene, "--field", "32", "--live", "never");
  for (const theme of ["light", "dark"]) {
    // Reads 200 positions of the slice where nothing else is drawn, in the moving picture and in the one at rest.
    const gaps = await other.evaluate(async (theme) => {
      const { viewer } = window;
      const { slice, camera, painter, stage } = viewer;
      viewer.setTheme(theme);
      await new Promise((done) => setTimeout(done, 600));
      const gl = viewer.renderer.getContext();
      const [{ low, high }, [width, height]] = [slice.scale, [stage.clientWidth, stage.clientHeight]];
      const [u, v] = [0, 1, 2].filter((k) => k !== slice.axis);
      const found = [];
      for (const draw of [() => { painter.setScale(1); viewer.renderer.render(viewer.world, camera); }, () => painter.refine()]) {
        draw();
        for (let i = 0; i < 200; i++) {
          const [x, y] = [0.05 + 0.9 * ((i * 0.618) % 1), 0.05 + 0.9 * ((i * 0.755) % 1)];
          const at = slice.position(slice.axis, x * (slice.counts[u] - 1), y * (slice.counts[v] - 1));
          const value = slice.valueAt(at);
          // Lines have another colour.
          const part = Math.abs(value / slice.spacingOfLines - Math.round(value / slice.spacingOfLines));
          const { x: px, y: py } = at.project(camera);
          const pixel = new Uint8Array(4);
          gl.readPixels(Math.floor(((px + 1) / 2) * width), Math.floor(((py + 1) / 2) * height), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
          const wanted = [0, 0, 0];
          slice.scale.write(value, wanted, 0);
          if (part > 0.25 && value > low && value < high) found.push(Math.max(...wanted.map((c, k) => Math.abs(c - pixel[k]))));
        }
      }
      return found.sort((a, b) => a - b);
    }, theme);
    // The outline of the scene covers few of them. A pixel is not where the position is, so its value differs a little.
    assert.ok(gaps.length > 150 && gaps[Math.floor(0.9 * gaps.length)] <= 4, `${theme}: ${gaps.length}, ${gaps}`);
  }
  await other.close();
});

test("a page answers an example before anything was asked", { skip }, async () => {
  for (const [words, list] of [[["--random", "30"], "answer"], [["--field", "16"], null], [["--live", "always"], "live-answer"]]) {
    const other = await opened.view(opened.scene, ...words, ...(list === "live-answer" ? [] : ["--live", "never"]));
    await other.waitForSelector("#overlay .important");
    const label = await other.textContent("#overlay .important");
    assert.match(label, /^[\d.]+ units from the scene$/, String(words));
    const shown = list ? Number.parseFloat(await opened.read(list, "distance", other))
      : Number.parseFloat(await other.textContent("#slice-value"));
    assert.ok(Math.abs(shown - Number.parseFloat(label)) < 1e-3 * shown, `${shown}, ${label}`);
    const panel = () => other.textContent(list ? `#${list}` : "#field .reading");
    assert.match(await panel(), /an example/);
    // Right below the answer, or beside the scale, stands why there is no side.
    const why = list ? `#${list} dd.main + dt + dd` : ".picture-legend .legend + div";
    assert.equal(await other.textContent(why), "No inside here, because the scene holds lines.");
    if (list) {
      await other.click(`section:has(#${list}) summary:has-text('What the words mean')`);
      assert.match(await other.innerText(`section:has(#${list}) details[open]`), /lower bound\s+A length that the true distance/);
    }
    // A click asks elsewhere, and the answer stays when the pointer moves on.
    if (!list) {
      await other.mouse.click(400, 430);
      const kept = await other.textContent("#slice-value");
      await other.mouse.move(520, 330);
      await other.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      assert.equal(await other.textContent("#slice-value"), kept);
      assert.notEqual(await other.textContent("#overlay .important"), label);
      assert.doesNotMatch(await panel(), /an example/);
    }
    await other.close();
  }
});

test("the scale bar has the length of the middle of the scene, whatever else is on the page", { skip }, async () => {
  const bars = [];
  for (const words of [[], ["--points", opened.write("far.xyz", "9 -6 8\n"), "--max-distance", "0"]]) {
    const other = await opened.view(opened.scene, "--live", "never", ...words);
    bars.push(await other.evaluate(() => {
      const { view, frame, camera, controls: { target }, stage, scene } = window.viewer;
      // A line of this length, across the view, in the depth of the middle of the scene.
      const towards = camera.position.clone().sub(target).normalize();
      const positions = scene.parts.flatMap(({ indices, geometry }) =>
        [...new Set(indices)].map((i) => target.clone().fromArray(geometry.getAttribute("position").array, 3 * i)));
      const depths = positions.map((position) => position.dot(towards));
      const middle = target.clone().addScaledVector(towards,
        (Math.min(...depths) + Math.max(...depths)) / 2 - target.dot(towards));
      const right = target.clone().setFromMatrixColumn(camera.matrixWorld, 0);
      const ends = [middle.clone(), middle.clone().addScaledVector(right, 0.1)].map((end) => end.project(camera));
      const pixels = ((ends[1].x - ends[0].x) / 2) * stage.clientWidth;
      return [view.pixelAt() * frame.scale, (0.1 * frame.scale) / pixels];
    }));
    await other.close();
  }
  for (const [said, true_] of bars) assert.ok(Math.abs(said / true_ - 1) < 0.01, String(bars));
});

test("a frame of a moving view draws nothing again that stands still", { skip }, async () => {
  const other = await opened.view(opened.scene, "--random", "30", "--live", "never");
  const [isOpaque, changes, layers] = await other.evaluate(async () => {
    const { viewer } = window;
    const changed = [];
    const observer = new MutationObserver((records) => changed.push(...records));
    observer.observe(document.querySelector(".scale-bar"), { childList: true, characterData: true, subtree: true });
    for (let i = 0; i < 5; i++) {
      viewer.turn(0.1, 0, 1);
      await new Promise(requestAnimationFrame);
    }
    const moved = document.querySelectorAll(".triad, .leaders, .labels span");
    return [!viewer.renderer.getContext().getContextAttributes().alpha, changed.length,
      [...moved].map((element) => getComputedStyle(element).willChange)];
  });
  assert.deepEqual([isOpaque, changes], [true, 0]);
  assert.deepEqual(layers, ["transform", "transform", "transform"]);
  await other.close();
});

test("lines of equal distance have the values of the field as labels", { skip }, async () => {
  const labels = await page.evaluate(() => {
    const { slice } = window.viewer;
    return slice.labels.map(({ text, position }) => [Number(text), slice.valueAt(position), slice.spacingOfLines]);
  });
  assert.ok(labels.length > 3);
  for (const [text, value, spacing] of labels) {
    assert.ok(Math.abs(text - value) < 1e-3 * spacing + 1e-3, `${text}, not ${value}`);
    assert.ok(Math.abs(text / spacing - Math.round(text / spacing)) < 1e-6, `${text} is no multiple of ${spacing}`);
  }
  // The legend says that there are larger values than that of its end, and how few they are.
  const { high, part } = await page.evaluate(() => {
    const { slice: { values, scale: { high } } } = window.viewer;
    return { high, part: values.filter((value) => value > high).length / values.length };
  });
  assert.ok(part > 0.01 && part < 0.15, String(part));
  const ticks = await page.$$eval(".picture-legend .ticks span", (all) => all.map((span) => span.textContent));
  assert.deepEqual(ticks.map((text) => text.startsWith("≥ ")), [false, false, true]);
  assert.equal(Number(ticks[2].slice(2)), Number(high.toPrecision(4)));
});

test("the toolbar and its keys change the view", { skip }, async () => {
  const other = await opened.view(opened.scene, "--live", "never");
  const state = () => other.evaluate(() => {
    const { camera, controls, view, scene, overlay } = window.viewer;
    const towards = camera.position.clone().sub(controls.target).normalize().toArray().map((x) => Math.round(x * 100) / 100);
    return { towards, isOrthographic: view.isOrthographic, edges: !!scene.edges?.visible, grid: !!overlay.grid?.visible };
  });
  for (const [key, towards] of [["1", [0, -1, 0]], ["3", [-1, 0, 0]], ["5", [0, 0, 1]]]) {
    await other.keyboard.press(key);
    assert.deepEqual((await state()).towards.map((x) => x + 0), towards);
  }
  await other.selectOption("#views", "right");
  assert.deepEqual((await state()).towards.map((x) => x + 0), [1, 0, 0]);
  // A list uses letters itself.
  await other.focus("#views");
  for (const key of ["o", "e", "g"]) await other.keyboard.press(key);
  assert.equal((await state()).isOrthographic, false);
  await other.focus("#picture");
  for (const key of ["o", "e", "g"]) await other.keyboard.press(key);
  const { isOrthographic, edges, grid } = await state();
  assert.deepEqual([isOrthographic, edges, grid], [true, true, true]);
  assert.equal(await other.getAttribute("#orthographic", "aria-pressed"), "true");
  // Depth does not change sizes in a parallel view.
  const ratio = await other.evaluate(() => {
    const { camera, data: { frame: { radius } } } = window.viewer;
    const width = (depth) => {
      const at = (x) => camera.position.clone().set(depth, x, 0).project(camera).x;
      return at(0.1 * radius) - at(0);
    };
    camera.updateMatrixWorld();
    return width(radius) / width(-radius);
  });
  assert.ok(Math.abs(ratio - 1) < 3e-3, String(ratio));
  const [download] = await Promise.all([other.waitForEvent("download"), other.keyboard.press("s")]);
  assert.match(download.suggestedFilename(), /\.png$/);
  await other.close();
});

test("keys act without a click, and copies have all digits", { skip }, async () => {
  const other = await opened.view(opened.scene, "--random", "20", "--seed", "3");
  await other.keyboard.press("n");
  assert.equal(await other.evaluate(() => window.viewer.answers.selected), 0);
  const [shown, copied] = await other.evaluate(() => {
    const data = [...document.querySelectorAll("#answer dt")].find((dt) => dt.textContent === "distance")
      .nextElementSibling;
    getSelection().selectAllChildren(document.querySelector("#answer"));
    const clipboardData = new DataTransfer();
    document.querySelector("#answer").dispatchEvent(new ClipboardEvent("copy", { clipboardData, bubbles: true }));
    return [data.textContent, clipboardData.getData("text/plain")];
  });
  const [[, , , , , , distance]] = opened.query("--random", "20", "--seed", "3", "--box-scale", "1.2");
  assert.match(shown, / units from the scene$/);
  assert.ok(shown.split(" ")[0].replace(/[-.,]|^0\.0*/g, "").length <= 6, shown);
  assert.match(copied, new RegExp(`distance\\s+${distance.replace(".", "\\.")}\\s`));
  await other.close();
});

test("the pointer reads answers, and highlights their segments", { skip }, async () => {
  await page.keyboard.press("f");
  const place = await page.evaluate(() => {
    const { viewer } = window;
    viewer.camera.updateMatrixWorld();
    const at = viewer.camera.position.clone().fromArray(viewer.answers.from, 3 * 7).project(viewer.camera);
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    return [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
  });
  await page.mouse.move(...place);
  await page.waitForFunction(() => window.viewer.answers.pointed === 7);
  assert.match(await page.textContent("#tip"), /^query 7: [\d.,]+ units from the scene$/);
  assert.ok(await page.evaluate(() => window.viewer.answers.highlight.children.length) > 0);
  await page.mouse.move(1190, 790);
});

test("the picture is refined once the view rests", { skip }, async () => {
  // A floor and two walls, which hide the sky from the corners between them. Smooth edges change pixels both ways.
  const corner = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\nf 1 4 7 5\nf 4 3 6 7\n";
  const other = await opened.view(opened.write("corner.obj", corner), "--live", "never");
  const [darker, lighter, background, isSame] = await other.evaluate(async () => {
    const { painter } = window.viewer;
    const gl = painter.renderer.getContext();
    painter.renderer.render(painter.world, painter.camera);
    const plain = window.readPicture();
    // Nothing but the time makes the refined picture.
    window.viewer.draw();
    await new Promise((done) => setTimeout(done, 1500));
    const refined = window.readPicture();
    let [darker, lighter, background] = [0, 0, 0];
    for (let i = 0; i < plain.length; i += 4) {
      const change = refined[i] - plain[i];
      if (change < -8) darker++;
      if (change > 8) lighter++;
      // The lowest rows have the background alone.
      if (i < 80 * gl.drawingBufferWidth) background = Math.max(background, Math.abs(change));
    }
    painter.refine();
    return [darker, lighter, background, window.readPicture().every((x, i) => x === refined[i])];
  });
  assert.ok(darker > 10_000 && lighter < darker / 10, `${darker} darker, ${lighter} lighter`);
  assert.ok(background === 0 && isSame, String(background));
  await other.close();
});

test("inside and outside are words, and a long title loses its middle", { skip }, async () => {
  const name = "a_name_that_is_far_too_long_for_the_panel.obj";
  const box = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n" +
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const points = opened.write("two.xyz", "0.5 0.5 0.25\n0.5 0.5 1.5\n");
  const other = await opened.view(opened.write(name, box), "--points", points, "--signed", "--live", "always", "--field", "16");
  const words = [];
  for (let i = 0; i < 2; i++) {
    await other.keyboard.press("n");
    words.push(await opened.read("answer", "distance", other));
  }
  assert.deepEqual(words, ["inside, 0.25 units from the surface", "outside, 0.5 units from the surface"]);
  // The field has the distances of the centre and of a corner, but for the interpolation between grid points.
  const [centre, corner] = await other.evaluate(() => {
    const { slice, frame, camera } = window.viewer;
    return [[0.5, 0.5, 0.5], [1.1, 1.1, 1.1]].map((point) => slice.valueAt(camera.position.clone().fromArray(frame.positions(point))));
  });
  assert.ok(Math.abs(centre + 0.5) < 0.1 && Math.abs(corner - Math.sqrt(3) / 10) < 0.1, `${centre}, ${corner}`);
  await other.waitForFunction(() => document.documentElement.dataset.live === "ready");
  for (const [z, side] of [["0.25", "inside"], ["1.05", "outside"], ["1", "on the surface"]]) {
    await other.fill("#live-x", "0.5");
    await other.fill("#live-y", "0.5");
    await other.fill("#live-z", z);
    // The label in the picture says it too.
    for (const words of ["#live-answer dd.main", "#overlay .important"]) {
      await other.waitForFunction(([words, side]) => document.querySelector(words)?.textContent.startsWith(side), [words, side]);
    }
  }
  // Numbers are not cut off.
  await other.fill("#live-x", "-0.1234567890123456");
  const [long, width] = await other.$eval("#live-x", (input) => [input.scrollWidth, input.clientWidth]);
  assert.ok(long <= width, `${long} > ${width}`);
  assert.equal(await other.textContent("h1"), "a_name_that_…he_panel.obj");
  assert.equal(await other.getAttribute("h1", "title"), name);
  await other.close();
});

test("a page says what can be done in it", { skip }, async () => {
  const other = await opened.view(opened.scene, "--live", "never");
  assert.match(await other.textContent("#facts"), /For distances in this page, make it with --live always/);
  assert.match(await other.textContent("#facts dd"), /^5\.843 × 6\.024 × 3\.242 units$/);
  await other.close();
});

test("on a phone nothing is wider than the page, and controls are large", { skip }, async () => {
  const other = await opened.view(opened.scene, "--random", "20", "--field", "16");
  await other.setViewportSize({ width: 390, height: 844 });
  assert.ok(await other.evaluate(() => document.documentElement.scrollWidth) <= 390);
  const sides = await other.$$eval("#toolbar button, #toolbar select", (all) => all.map((control) => {
    const { right, height } = control.getBoundingClientRect();
    return [right, height];
  }));
  for (const [right, height] of sides) assert.ok(right <= 390 && (height === 0 || height >= 36), `${right}, ${height}`);
  await other.close();
});

test("the view cannot leave the scene", { skip }, async () => {
  await page.focus("#picture");
  for (let i = 0; i < 80; i++) await page.keyboard.press("-");
  const [distance, far] = await page.evaluate(() => [window.viewer.camera.position.length(), window.viewer.camera.far]);
  assert.ok(distance < far);
  await page.keyboard.press("f");
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
    const file = opened.write(text.startsWith("OFF") ? "kind.off" : "kind.obj", text);
    const other = await opened.view(file);
    const isDrawn = await other.evaluate(() => {
      const { viewer } = window;
      viewer.renderer.render(viewer.world, viewer.camera);
      const pixels = window.readPicture();
      return new Set(new Uint32Array(pixels.buffer)).size > 1;
    });
    assert.equal(isDrawn, kind !== "empty");
    await other.close();
  });
}

test("nothing failed and nothing was fetched", { skip }, () => {
  assert.deepEqual(opened.problems, []);
});
