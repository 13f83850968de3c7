// Puts the script of the pages and the parts of three.js that it uses into one file, `assets/viewer.js`. With `--check`
// it fails if that file is not what the sources make.

import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const out = new URL("../assets/viewer.js", import.meta.url);
const licence = await readFile(new URL("node_modules/three/LICENSE", import.meta.url), "utf8");
const { version } = JSON.parse(await readFile(new URL("node_modules/three/package.json", import.meta.url), "utf8"));

// Returns the text of a script with all that it imports.
async function bundle(name, define = {}) {
  const { outputFiles } = await build({
    entryPoints: [new URL(`src/${name}`, import.meta.url).pathname],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    legalComments: "none",
    write: false,
    // The package loads no file: the page has its module.
    define: { "import.meta.url": "undefined", ...define },
  });
  return outputFiles[0].text;
}

const viewer = await bundle("viewer.js", { WORKER_SCRIPT: JSON.stringify(await bundle("worker.js")) });
const banner = `/*! This script has parts of three.js ${version}.\n\n${licence.trim()}\n*/\n`;
const script = banner + viewer;
if (process.argv.includes("--check")) {
  if ((await readFile(out, "utf8")) !== script) {
    console.error("assets/viewer.js is not what web/src makes: run `npm run build` in apps/page/web");
    process.exit(1);
  }
} else {
  await writeFile(out, script);
}
