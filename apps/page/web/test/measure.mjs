// Measures pages of scenes of 10^4 to 10^6 triangles: their sizes, the seconds until they are ready, and the frames a
// second while they turn. The variable P2M names the program.

import { execFileSync } from "node:child_process";
import { mkdtempSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { PROGRAM, launch, openTab, skip } from "./browser.mjs";

if (skip) throw new Error(skip);

// The number of frames that are timed.
const FRAMES = 20;

const folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
const browser = await launch();
console.log("| triangles | page, MB | seconds until it is ready | frames a second |\n|---:|---:|---:|---:|");
// Each edge of the icosahedron is cut into so many parts, which makes 20 times the square of this number of triangles.
for (const frequency of [22, 71, 223]) {
  const [scene, html] = ["scene.ply", "page.html"].map((name) => join(folder, name));
  const sphere = ["generate", "ico-sphere", "--frequency", String(frequency)];
  execFileSync(PROGRAM, [...sphere, "--out", scene], { stdio: "pipe" });
  execFileSync(PROGRAM, ["view", scene, "--random", "1000", "--live", "never", "--out", html], { stdio: "pipe" });
  const start = performance.now();
  const page = await openTab(browser, html, (problem) => { throw new Error(problem); });
  const ready = (performance.now() - start) / 1000;
  const rate = await page.evaluate(async (frames) => {
    const { viewer } = window;
    const gl = viewer.renderer.getContext();
    const begin = performance.now();
    for (let i = 0; i < frames; i++) {
      viewer.turn(0.05, 0, 1);
      await new Promise(requestAnimationFrame);
      // A read waits until the picture is complete.
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    }
    return (1000 * frames) / (performance.now() - begin);
  }, FRAMES);
  const megabytes = statSync(html).size / 1e6;
  console.log(`| ${20 * frequency ** 2} | ${megabytes.toFixed(1)} | ${ready.toFixed(1)} | ${rate.toPrecision(2)} |`);
  await page.close();
}
await browser.close();
