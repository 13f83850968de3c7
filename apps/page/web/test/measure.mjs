// Measures pages of scenes of 10^4 to 10^6 triangles: their sizes without and with live queries, the seconds until they
// are ready, and while they turn the frames per second and the CPU time of all processes of the browser for a frame:
// P2M=PROGRAM node test/measure.mjs [EARLIER PROGRAM]
//
// Times are those of pages without live queries, whose indexes would be built meanwhile. Programs take turns, and the
// figures are medians of several rounds.

import { execFileSync } from "node:child_process";
import { mkdtempSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { PROGRAM, launch, openTab, skip } from "./browser.mjs";

if (skip) throw new Error(skip);

// The number of frames that are timed, and that of rounds.
const [FRAMES, ROUNDS] = [20, 5];
const programs = [...process.argv.slice(2), PROGRAM];
const folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
const browser = await launch();
const session = await browser.newBrowserCDPSession();
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

// Returns the seconds of CPU time of all processes of the browser.
async function cpuTime() {
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  return processInfo.reduce((sum, process) => sum + process.cpuTime, 0);
}

// Opens a page and returns the seconds until it is ready, the frames a second, and the milliseconds of CPU time for a
// frame.
async function measure(html) {
  const start = performance.now();
  const page = await openTab(browser, html, (problem) => { throw new Error(problem); });
  const ready = (performance.now() - start) / 1000;
  const before = await cpuTime();
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
  const cpu = (1000 * (await cpuTime() - before)) / FRAMES;
  await page.close();
  return { ready, rate, cpu };
}

console.log("| program | triangles | page, MB | with live queries, MB | seconds until it is ready | frames a second | CPU time of a frame, ms |\n|---|---:|---:|---:|---:|---:|---:|");
// Each edge of the icosahedron is cut into so many parts, which makes 20 times the square of this number of triangles.
for (const frequency of [22, 71, 223]) {
  const scene = join(folder, "scene.ply");
  execFileSync(PROGRAM, ["generate", "ico-sphere", "--frequency", String(frequency), "--out", scene], { stdio: "pipe" });
  const pages = programs.map((program, i) => {
    const html = join(folder, `page${i}.html`);
    const write = (live) =>
      execFileSync(program, ["view", scene, "--random", "1000", "--live", live, "--out", html], { stdio: "pipe" });
    const size = () => (statSync(html).size / 1e6).toFixed(2);
    write("always");
    const liveSize = size();
    write("never");
    return { program, html, sizes: [size(), liveSize], figures: [] };
  });
  for (let round = 0; round < ROUNDS; round++) {
    for (const page of pages) page.figures.push(await measure(page.html));
  }
  for (const { program, sizes, figures } of pages) {
    const [ready, rate, cpu] = ["ready", "rate", "cpu"].map((key) => median(figures.map((figure) => figure[key])));
    const name = program === PROGRAM ? "now" : "earlier";
    console.log(`| ${name} | ${20 * frequency ** 2} | ${sizes.join(" | ")} | ${ready.toFixed(1)} | ${rate.toPrecision(2)} | ${cpu.toFixed(0)} |`);
  }
}
await browser.close();
