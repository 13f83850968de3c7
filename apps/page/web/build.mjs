// Puts the script of the pages and the parts of other packages that it uses into one file, `assets/viewer.js`. With `--check`
// it fails if that file is not what the sources make.

import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const out = new URL("../assets/viewer.js", import.meta.url);

// Returns the name, the version and the licence of a package of which the script has parts.
async function credit(name) {
  const file = (path) => readFile(new URL(`node_modules/${name}/${path}`, import.meta.url), "utf8");
  const { version } = JSON.parse(await file("package.json"));
  return `This script has parts of ${name} ${version}.\n\n${(await file("LICENSE")).trim()}\n`;
}

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
const banner = `/*! ${await credit("three")}\n${await credit("fzstd")}*/\n`;
const script = banner + viewer;
if (process.argv.includes("--check")) {
  if ((await readFile(out, "utf8")) !== script) {
    console.error("assets/viewer.js is not what web/src makes: run `npm run build` in apps/page/web");
    process.exit(1);
  }
} else {
  await writeFile(out, script);
}
