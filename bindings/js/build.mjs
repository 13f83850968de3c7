// Makes `dist`: the compiled scripts of `src` with their types, and the WebAssembly module, both as a file and as a
// script.

import { execFileSync } from "node:child_process";
import { copyFileSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { decompress } from "fzstd";

const folder = new URL("./", import.meta.url);
const module = new URL("../../apps/page/assets/p2m.wasm.zst", folder);
rmSync(new URL("dist", folder), { recursive: true, force: true });
execFileSync(
  process.execPath, [fileURLToPath(import.meta.resolve("typescript/lib/tsc.js"))],
  { cwd: folder, stdio: "inherit" }
);
// Packages cannot have links to files, so the licences are copied.
for (const licence of ["LICENSE-APACHE", "LICENSE-MIT"])
  copyFileSync(new URL(`../../${licence}`, folder), new URL(licence, folder));
const bytes = Buffer.from(decompress(readFileSync(module)));
writeFileSync(new URL("dist/p2m.wasm", folder), bytes);
const text = bytes.toString("base64");
writeFileSync(new URL("dist/inline.js", folder),
  `export default Uint8Array.from(atob("${text}"), (character) => character.charCodeAt(0));\n`);
writeFileSync(new URL("dist/inline.d.ts", folder),
  "/** The bytes of the module of WebAssembly, for `init`. */\ndeclare const bytes: Uint8Array<ArrayBuffer>;\nexport default bytes;\n");
