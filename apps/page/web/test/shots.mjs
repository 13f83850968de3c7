// Writes pictures of every page for five scenes, in light, dark and phone width, with a page that shows them all:
// P2M=PROGRAM node test/shots.mjs FOLDER [FOLDER OF EARLIER PICTURES] [--only WORD]
//
// The scenes are made by the program, unless the variable MODELS names a folder with others. With earlier pictures, the
// page has those at the left of the new ones.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import { PROGRAM, launch, openTab, skip } from "./browser.mjs";

if (skip) throw new Error(skip);
const words = process.argv.slice(2);
const only = words.includes("--only") ? words.splice(words.indexOf("--only"), 2)[1] : "";
const [folder, before] = words;
if (!folder) throw new Error("this needs a folder for the pictures");
mkdirSync(folder, { recursive: true });

const LOOKS = {
  light: { viewport: { width: 1280, height: 800 }, colorScheme: "light" },
  dark: { viewport: { width: 1280, height: 800 }, colorScheme: "dark" },
  phone: { viewport: { width: 390, height: 844 }, colorScheme: "light", hasTouch: true, deviceScaleFactor: 2 },
};

const at = (name) => join(folder, name);
const run = (...args) => execFileSync(PROGRAM, args, { stdio: "pipe", maxBuffer: 1e9 });

// Writes houses in a national grid, hundreds of kilometres from its origin.
function city(path) {
  const lines = [];
  const random = (i) => (Math.sin(i * 12.9898) * 43758.5453) % 1;
  for (let i = 0; i < 400; i++) {
    const [x, y] = [92000 + 25 * (i % 20) + 6 * random(i), 436000 + 25 * Math.floor(i / 20) + 6 * random(i + 7)];
    const sides = [12 + 8 * random(i + 1), 14 + 8 * random(i + 2)].map(Math.abs);
    const height = 6 + 30 * random(i + 3) ** 4 + (Math.hypot(x - 92250, y - 436250) < 80 ? 30 : 0);
    lines.push(`o house ${i}`);
    for (const k of [0, 1, 2, 3, 4, 5, 6, 7]) {
      lines.push(`v ${x + (k & 1 ? sides[0] : 0)} ${y + (k & 2 ? sides[1] : 0)} ${k & 4 ? height : 0}`);
    }
    for (const face of ["0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"]) {
      lines.push(`f ${face.split(" ").map((k) => 8 * i + Number(k) + 1).join(" ")}`);
    }
  }
  writeFileSync(path, lines.join("\n"));
}

// For each scene its file among models, what makes another one, and the arguments of its pages.
const SCENES = {
  mesh: ["bunny.obj", (path) => run("generate", "torus-knot", "--out", path), ["--signed"], ["--up", "y"]],
  mixed: ["", (path) => run("generate", "knot-and-cables", "--out", path), [], []],
  lines: ["rings_lines.obj", (path) => run("generate", "cable-bundle", "--out", path), [], []],
  points: ["lucy_100k.ply", (path) => run("generate", "torus-knot", "--out", path), [], []],
  city: ["rotterdam_city_far_from_origin.obj", city, [], ["--unit", "m"]],
};

// Returns the vertices of a scene.
function vertices(scene) {
  const lines = run("convert", scene, "-", "--to", "obj").toString().split("\n");
  return lines.filter((line) => line.startsWith("v ")).map((line) => line.slice(2).split(" ").map(Number));
}

// Writes points as a table.
const writePoints = (path, points) => writeFileSync(path, points.map((point) => point.join(" ")).join("\n"));

// Writes a scan of a scene: its vertices, moved by a wave and a little noise.
function scan(scene, path, side) {
  let seed = 1;
  const noise = () => ((seed = (seed * 16807) % 2147483647) / 2147483647) - 0.5;
  writePoints(path, vertices(scene).map((point) => point.map((x, k) =>
    x + (side / 400) * (Math.sin((9 * point[(k + 1) % 3]) / side + k) ** 3 + 0.3 * noise()))));
}

// Returns what makes the pages of a scene and a copy of it that stands beside it.
function pairs(name, scene, side, shared) {
  const copy = at(`${name}-copy.ply`);
  const beside = (command, page) => ({ [page]: () => {
    // A turn about the origin would move a city far away.
    const turn = command === "align" ? ["--rotate-z", "20"] : [];
    run("convert", scene, copy, ...turn, "--translate", String(1.1 * side), "0", "0");
    run(command, ...(command === "align" ? [copy, scene] : [scene, copy]), ...shared, "--html", at(`${name}-${page}.html`));
  } });
  const others = name === "mesh" ? { ...beside("hausdorff", "hausdorff"), ...beside("align", "align") } : {};
  return { ...beside("distance", "distance"), ...others };
}

// Returns what makes the pages of a scene.
function pages(name, scene, field, shared) {
  const { min, max } = JSON.parse(run("info", scene, "--json")).bounds;
  const side = Math.max(...max.map((x, k) => x - min[k]));
  const [html, points] = [(page) => ["--out", at(`${name}-${page}.html`)], at(`${name}-scan.xyz`)];
  const slice = ["--field", "64", ...field, "--random", "100", "--levels", "6"];
  const unsigned = field.length > 0 ? [] : ["--unsigned"];
  return {
    view: () => run("view", scene, ...shared, ...html("view")),
    field: () => run("view", scene, ...slice, ...shared, ...html("field")),
    deviation: () => {
      scan(scene, points, side);
      run("deviation", points, scene, ...unsigned, "--tolerance", (side / 500).toPrecision(1), ...shared, ...html("deviation"));
    },
    ...pairs(name, scene, side, shared),
    tradeoff: () =>
      run("tradeoff", scene, "--random", "300", "--rounds", "3", "--html", at(`${name}-tradeoff.html`)),
  };
}

const browser = await launch();
const shown = [];
for (const [name, [model, make, field, shared]] of Object.entries(SCENES)) {
  const given = model && process.env.MODELS ? join(process.env.MODELS, model) : "";
  let scene = given && existsSync(given) ? given : at(`${name}.obj`);
  if (scene !== given) make(scene);
  if (name === "points") {
    const points = vertices(scene);
    writePoints(scene = at("points.xyz"), points);
  }
  for (const [page, write] of Object.entries(pages(name, scene, field, shared))) {
    if (!`${name}-${page}`.includes(only)) continue;
    write();
    for (const [look, options] of Object.entries(LOOKS)) {
      const tab = await openTab(browser, at(`${name}-${page}.html`), (problem) => console.error(problem), options);
      // Live queries end their builds and measurements, and the picture is refined once the view rests.
      await tab.waitForFunction(() => !window.viewer?.live || document.documentElement.dataset.live, undefined,
        { timeout: 120_000 }).catch(() => {});
      await tab.waitForFunction(() => !window.viewer || window.viewer.painter.isRefined);
      const file = `${name}-${page}-${look}.png`;
      await tab.screenshot({ path: at(file) });
      shown.push(file);
      await tab.context().close();
    }
  }
}
await browser.close();

const figures = shown.map((file) => {
  const earlier = before && existsSync(join(before, file)) ? relative(resolve(folder), resolve(before, file)) : null;
  const images = [earlier, file].filter(Boolean).map((source) => `<img src="${source}" alt="${source}">`);
  return `<figure><figcaption>${file}</figcaption>${images.join("\n")}</figure>`;
});
writeFileSync(at("index.html"), `<!DOCTYPE html><meta charset="utf-8"><title>Pages of p2m</title>
<style>figure { margin: 0 0 2rem } img { max-width: 49%; max-height: 90vh; border: 1px solid #888 }</style>
${figures.join("\n")}
`);
console.log(at("index.html"));
