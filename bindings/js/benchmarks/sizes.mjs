// Prints the sizes of the package and of three-mesh-bvh in kB: as they are, and compressed by brotli and by gzip.
// Scripts are minified, without three.js.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, gzipSync } from "node:zlib";
import { build } from "vite";

const path = (name) => fileURLToPath(new URL(`../${name}`, import.meta.url));

// Returns the scripts of a package as one minified bundle.
async function minified(...names) {
  const rolldownOptions = { input: names.map(path), external: ["three"], preserveEntrySignatures: "strict" };
  const options = { write: false, minify: "oxc", assetsInlineLimit: 0, modulePreload: false, rolldownOptions };
  const { output } = await build({ configFile: false, logLevel: "silent", build: options });
  const codes = output.filter(({ fileName }) => fileName.endsWith(".js")).map(({ code, source }) => code ?? source);
  return Buffer.from(codes.join("\n"));
}

const parts = {
  "the module `p2m.wasm`": readFileSync(path("dist/p2m.wasm")),
  "the scripts of p2m": await minified("dist/index.js", "dist/three.js"),
  "the scripts of three-mesh-bvh": await minified("node_modules/three-mesh-bvh/build/index.module.js"),
};
const kilo = (bytes) => Math.round(bytes.length / 1000);
console.log("| | kB | by brotli | by gzip |\n|---|---:|---:|---:|");
for (const [name, bytes] of Object.entries(parts)) {
  console.log(
    `| ${name} | ${kilo(bytes)} | ${kilo(brotliCompressSync(bytes))} | ${kilo(gzipSync(bytes, { level: 9 }))} |`
  );
}
