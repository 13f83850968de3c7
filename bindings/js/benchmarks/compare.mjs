// Measures p2m and three-mesh-bvh in Node.js and in Chromium, and prints tables: `node benchmarks/compare.mjs COUNT
// MESH.obj ..`. Times are CPU times of the process: of Node.js, or of the page in Chromium.

import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { build, preview } from "vite";
import { init } from "../dist/index.js";
import { measure } from "./measure.mjs";

const [count, ...files] = process.argv.slice(2);
const CHROMIUM = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);

function read(file) {
  const [positions, triangles] = [[], []];
  for (const line of readFileSync(file, "utf8").split("\n")) {
    const [key, ...words] = line.trim().split(/\s+/);
    if (key === "v") positions.push(...words.slice(0, 3).map(Number));
    if (key === "f") triangles.push(...words.slice(0, 3).map((word) => parseInt(word, 10) - 1));
  }
  return { positions, triangles };
}

const typed = ({ positions, triangles }) =>
  ({ positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) });

// Starts Chromium, and returns a function that measures in it.
async function openChromium() {
  const root = mkdtempSync(join(tmpdir(), "p2m-benchmark-"));
  const script = fileURLToPath(new URL("measure.mjs", import.meta.url));
  writeFileSync(join(root, "index.html"), '<!doctype html><link rel="icon" href="data:,"><script type="module" src="/main.js"></script>');
  writeFileSync(join(root, "main.js"), `
    import { init } from ${JSON.stringify(fileURLToPath(new URL("../dist/index.js", import.meta.url)))};
    import { measure } from ${JSON.stringify(script)};
    await init();
    globalThis.run = ({ positions, triangles }, count) =>
      measure({ positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) }, count, globalThis.now);`);
  const options = { root, logLevel: "silent", server: { fs: { strict: false } }, resolve: { preserveSymlinks: true } };
  await build({ ...options, build: { target: "esnext" } });
  const server = await preview({ ...options, preview: { port: 0, host: "127.0.0.1" } });
  const browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox"] });
  const tab = await browser.newPage();
  tab.setDefaultTimeout(0);
  tab.on("pageerror", (error) => console.error(error.message));
  await tab.goto(server.resolvedUrls.local[0]);
  await tab.waitForFunction(() => globalThis.run);
  const session = await tab.context().newCDPSession(tab);
  await session.send("Performance.enable");
  await tab.exposeFunction("now", async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return 1e6 * metrics.find(({ name }) => name === "ProcessTime").value;
  });
  return {
    version: browser.version(),
    measure: (mesh, count) => tab.evaluate(([mesh, count]) => globalThis.run(mesh, count), [mesh, count]),
    close: async () => {
      await browser.close();
      await server.close();
      rmSync(root, { recursive: true });
    },
  };
}

function print(title, times, memory) {
  const factor = (base, own) => (times[base] / times[own]).toFixed(1);
  const micro = (name) => times[name].toFixed(2);
  console.log(`\n${title}\n`);
  console.log("| queries | three-mesh-bvh, us | `aabb` | times as fast | `aabb`, batch | times as fast | `auto` | times as fast | `auto`, batch | times as fast |");
  console.log("|---|---|---|---|---|---|---|---|---|---|");
  for (const set of ["10x", "1x", "near", "surface"]) {
    const cells = ["aabb", "aabb batch", "auto", "auto batch"].flatMap((own) =>
      [micro(`${set} ${own}`), factor(`${set} three-mesh-bvh`, `${set} ${own}`)]);
    console.log(`| \`${set}\` | ${micro(`${set} three-mesh-bvh`)} | ${cells.join(" | ")} |`);
  }
  console.log(`| first hits | ${micro("rays three-mesh-bvh")} | ${micro("rays aabb")} | ${factor("rays three-mesh-bvh", "rays aabb")} | | | | | | |`);
  const milli = (name) => (times[name] / 1000).toFixed(0);
  console.log(`| build, ms | ${milli("build three-mesh-bvh")} | ${milli("build aabb")} | ${factor("build three-mesh-bvh", "build aabb")} | | | ${milli("build auto")} | | | |`);
  const mega = (bytes) => (bytes / 1e6).toFixed(1);
  const [bvh, aabb, auto] = Object.values(memory);
  console.log(`| memory, MB | ${mega(bvh)} | ${mega(aabb)} | | | | ${mega(auto)} | | | |`);
}

await init();
const browser = CHROMIUM ? await openChromium() : null;
const cpu = () => {
  const { user, system } = process.cpuUsage();
  return user + system;
};
for (const file of files) {
  const mesh = read(file);
  const name = `${basename(file)}, ${mesh.triangles.length / 3} triangles, ${count} queries`;
  const { medians, memory } = await measure(typed(mesh), Number(count), cpu);
  print(`${name}, Node.js ${process.version}:`, medians, memory);
  if (browser)
    print(`${name}, Chromium ${browser.version}:`, (await browser.measure(mesh, Number(count))).medians, memory);
}
await browser?.close();
