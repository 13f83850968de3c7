// Compresses the WebAssembly module for pages and for the package by Zstandard, with a window that contains all of the
// module, because its many similar functions are far from each other. Fails if the module is too large: `node pack.mjs
// MODULE OUT`. It needs the program `zstd`.

import { execFileSync } from "node:child_process";
import { readFileSync, statSync } from "node:fs";
import { brotliCompressSync, constants } from "node:zlib";

/** The limit on the size of the module as servers send it, compressed by brotli. */
const MAX_BROTLI_BYTES = 700_000;

const [module, out] = process.argv.slice(2);
const bytes = readFileSync(module);
const { BROTLI_PARAM_LGWIN, BROTLI_PARAM_QUALITY, BROTLI_PARAM_SIZE_HINT } = constants;
const params = { [BROTLI_PARAM_QUALITY]: 11, [BROTLI_PARAM_LGWIN]: 24, [BROTLI_PARAM_SIZE_HINT]: bytes.length };
const brotli = brotliCompressSync(bytes, { params }).length;
console.log(`${bytes.length} bytes, ${brotli} by brotli`);
if (brotli > MAX_BROTLI_BYTES) {
  console.error(`the module has more than ${MAX_BROTLI_BYTES} bytes by brotli`);
  process.exit(1);
}
execFileSync("zstd", ["--quiet", "--force", "--ultra", "-22", "--no-check", module, "-o", out]);
console.log(`${statSync(out).size} bytes by Zstandard`);
