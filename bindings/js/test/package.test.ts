// Tests of the archive of `npm pack` in empty projects: strict TypeScript, Node.js, and pages that are built by Vite
// and webpack and opened in Chromium.

import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import type { Server } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { Index, Scene, init } from "../dist/index.js";
import { blob, mixture, pointsAround } from "./scenes.js";
import type { Arrays } from "./scenes.js";

const ROOT = fileURLToPath(new URL("..", import.meta.url));
const CHROMIUM = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
const WEBPACK = "webpack@~5.113.0";
const TYPES: Record<string, string> = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

let project: string;

const run = (program: string, ...args: string[]) =>
  execFileSync(program, args, { cwd: project, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const tool = (path: string, ...args: string[]) => run(process.execPath, join(project, "node_modules", path), ...args);
const file = (name: string, text: string) => writeFileSync(join(project, name), text);

beforeAll(() => {
  project = mkdtempSync(join(tmpdir(), "p2m-package-"));
  cpSync(join(ROOT, "example"), project, { recursive: true, filter: (path) => !/node_modules|dist/.test(path) });
  // `--ignore-scripts` avoids the build, which has run before the tests.
  execFileSync("npm", ["pack", "--ignore-scripts", "--pack-destination", project], { cwd: ROOT, stdio: "pipe" });
  const archive = readdirSync(project).find((name) => name.endsWith(".tgz"))!;
  const { devDependencies } = JSON.parse(readFileSync(join(ROOT, "package.json"), "utf8"));
  const tools = ["three", "@types/three", "typescript", "vite"].map((name) => `${name}@${devDependencies[name]}`);
  run(
    "npm", "install", "--prefer-offline", "--no-audit", "--no-fund", "--loglevel=error",
    `./${archive}`, ...tools, WEBPACK
  );
});
afterAll(() => rmSync(project, { recursive: true, force: true }));

test("the archive has what it needs, and nothing else", () => {
  const files = run("find", "node_modules/p2m", "-type", "f", "-printf", "%P\n").trim().split("\n").sort();
  const scripts = ["answers", "index", "inline", "module", "pool", "remote", "scene", "spatial", "three", "worker"];
  expect(files).toEqual([
    "LICENSE-APACHE", "LICENSE-MIT", "LICENSES.md", "README.md", "dist/p2m.wasm", "package.json",
    ...scripts.flatMap((name) => [`dist/${name}.d.ts`, `dist/${name}.js`]),
  ].sort());
});

test("the first code of the README runs in Node.js", () => {
  const readme = readFileSync(join(project, "node_modules/p2m/README.md"), "utf8");
  const code = readme.match(/```js\n(.*?)```/s)![1]!;
  expect(readme.slice(0, readme.indexOf("```js")).split("\n").length).toBeLessThan(20);
  file("readme.mjs", code);
  expect(run(process.execPath, "readme.mjs").trim()).toBe("1 [ 0.25, 0.25, 0 ]");
});

test("strict TypeScript accepts it, and refuses wrong arguments", () => {
  file("strict.ts", `
    import { Index, Pool, Scene, init, type Closest } from "p2m";
    import bytes from "p2m/inline";
    import { accelerate, indexOf, sceneOf } from "p2m/three";
    import { BufferGeometry, InstancedMesh, Mesh, Raycaster, Vector3 } from "three";
    await init(bytes);
    const index: Index = new Index(new Scene({ positions: new Float32Array(9), triangles: [0, 1, 2] }), { backend: "octree" });
    const answer: Closest | null = index.closestPoint(new Vector3());
    const distance: Float64Array = index.closestPoints([0, 0, 0]).distance;
    const own: { normal: Float32Array } = index.closestPoints([0, 0, 0], { normal: new Float32Array(3) });
    const inside: Uint8Array = index.containsEach([0, 0, 0]);
    using pool = await Pool.create(index);
    const answers: Float32Array = await pool.signedDistances([0, 0, 0], new Float32Array(1));
    accelerate(new Mesh(new BufferGeometry()), indexOf(new BufferGeometry()));
    accelerate(new InstancedMesh(new BufferGeometry(), undefined, 3)).refit(sceneOf(new BufferGeometry()));
    new Raycaster().firstHitOnly = true;
    // @ts-expect-error
    new Index(index);
    // @ts-expect-error
    index.closestPoint("here");
    // @ts-expect-error
    new Index(new Scene({ positions: [] }), { backend: "best" });
    console.log(answer?.point[2], distance, own, inside, answers);
  `);
  file("tsconfig.json", JSON.stringify({
    compilerOptions: { strict: true, noEmit: true, target: "esnext", module: "nodenext", types: [], skipLibCheck: false,
      exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, lib: ["esnext", "dom", "dom.iterable"] },
    files: ["strict.ts"],
  }));
  tool("typescript/lib/tsc.js", "-p", ".");
});

describe.skipIf(!CHROMIUM)("in Chromium", () => {
  let browser: Browser;
  let server: Server;
  let isIsolated = true;
  const problems: string[] = [];

  beforeAll(async () => {
    tool("vite/bin/vite.js", "build", "--logLevel", "warn");
    server = createServer((request, response) => {
      const path = new URL(request.url!, "http://localhost").pathname;
      const found = join(project, "dist", path === "/" ? "index.html" : path);
      const isolation = { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" };
      if (!existsSync(found)) response.writeHead(404).end();
      else response.writeHead(200, {
        "Content-Type": TYPES[extname(found)] ?? "text/plain", ...(isIsolated && isolation)
      })
        .end(readFileSync(found));
    });
    await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
    const graphics = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
    browser = await chromium.launch({ executablePath: CHROMIUM!, args: ["--no-sandbox", ...graphics] });
  });
  afterAll(async () => {
    await browser?.close();
    server?.close();
  });

  async function open(page = "index.html"): Promise<Page> {
    const tab = await browser.newPage({ viewport: { width: 1200, height: 800 } });
    tab.on("console", (message) => ["error", "warning"].includes(message.type()) && problems.push(message.text()));
    tab.on("pageerror", (error) => problems.push(error.message));
    await tab.goto(`http://127.0.0.1:${(server.address() as AddressInfo).port}/${page}`);
    await tab.waitForFunction(() => document.documentElement.dataset["ready"]);
    return tab;
  }

  test("the example answers the pointer", async () => {
    const tab = await open();
    await tab.mouse.move(700, 300);
    await tab.mouse.move(1010, 260);
    const rows = () => tab.evaluate(() => Object.fromEntries(
      [...document.querySelectorAll("dt")].map((dt) => [dt.textContent, dt.nextElementSibling!.textContent])));
    const { distance, nearest, "under the pointer": hit } = await rows();
    expect(Number(distance)).toBeGreaterThan(0);
    expect(nearest).toMatch(/^(triangle|segment|point) \d+$/);
    expect(hit).toBe("nothing");
    if (process.env["P2M_PICTURES"]) await tab.screenshot({ path: join(process.env["P2M_PICTURES"], "example.png") });
    await tab.mouse.move(840, 260);
    const other = await rows();
    expect(other["distance"]).not.toBe(distance);
    expect(other["under the pointer"]).toMatch(/^triangle \d+$/);
    const pixels = await tab.locator("canvas").screenshot();
    expect(new Set(pixels).size).toBeGreaterThan(200);
    expect(problems).toEqual([]);
    await tab.close();
  });

  test.each([[true], [false]])("a pool answers, isolated: %s", async (isolated) => {
    isIsolated = isolated;
    cpSync(join(ROOT, "test/pool"), project, { recursive: true });
    tool("vite/bin/vite.js", "build", "--logLevel", "warn");
    const tab = await open();
    const result = await tab.evaluate(() => (globalThis as any).result);
    expect(result).toEqual({ isShared: isolated, isSame: true, size: 2, inline: 3 });
    expect(problems).toEqual([]);
    await tab.close();
  });

  test("webpack makes a page with the module, the pool and its workers", async () => {
    cpSync(join(ROOT, "test/pool/main.js"), join(project, "packed.js"));
    // In this project the module is a separate file, which the script loads from its own folder.
    const source = readFileSync(join(project, "packed.js"), "utf8").replace("init(bytes)", "init()");
    file("packed.js", source.replace(/import bytes .*\n/, ""));
    file("webpack.mjs", `
      import webpack from "webpack";
      const output = { path: process.cwd() + "/dist" };
      // The module is larger than webpack recommends for scripts.
      const options = { mode: "production", entry: "./packed.js", output, performance: false };
      webpack(options, (error, stats) => {
        if (error || stats.hasErrors() || stats.hasWarnings()) throw error ?? new Error(stats.toString());
      });`);
    run(process.execPath, "webpack.mjs");
    expect(readdirSync(join(project, "dist")).filter((name) => name.endsWith(".wasm")).length).toBeGreaterThan(0);
    file("dist/packed.html", '<!doctype html><link rel="icon" href="data:,"><script src="main.js" defer></script>');
    isIsolated = true;
    const tab = await open("packed.html");
    expect(await tab.evaluate(() => (globalThis as any).result))
      .toEqual({ isShared: true, isSame: true, size: 2, inline: 3 });
    expect(problems).toEqual([]);
    await tab.close();
  });

  const scenes: [string, Arrays][] = [
    ["octree", mixture(1500, 800, 300, 29)], ["kdop", blob(60, [4e6, 5e5, -3e5], 100)], ["aabb", blob(80)],
  ];
  test.each(scenes)("20,000 answers are those of Node.js, bit for bit: %s", async (backend, scene) => {
    await init();
    const queries = pointsAround(scene, 20_000, 41);
    const expected = new Index(new Scene(scene), { backend: backend as "octree" }).closestPoints(queries);
    const tab = await open();
    const plain = Object.fromEntries(Object.entries(scene).map(([name, values]) => [name, [...values]]));
    const found = await tab.evaluate(([scene, queries, backend]) => (globalThis as any).answer(scene, queries, backend),
      [plain, [...queries], backend] as const);
    for (const [name, values] of Object.entries(expected)) {
      expect(found[name].length).toBe(values.length);
      expect(found[name].findIndex((x: number, i: number) => !Object.is(x, values[i]))).toBe(-1);
    }
    await tab.close();
  });
});
