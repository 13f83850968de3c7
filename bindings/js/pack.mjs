// Compresses the module of WebAssembly for pages, whose scripts read that format, and for the package. Fails if the module
// is too large: `node pack.mjs MODULE OUT`.

import { readFileSync, writeFileSync } from "node:fs";
import { brotliCompressSync, constants, deflateSync } from "node:zlib";

/** The largest module as servers send it, compressed by brotli. */
const MAX_BROTLI_BYTES = 700_000;

const [module, out] = process.argv.slice(2);
const bytes = readFileSync(module);
const { BROTLI_PARAM_LGWIN, BROTLI_PARAM_QUALITY, BROTLI_PARAM_SIZE_HINT } = constants;
const params = { [BROTLI_PARAM_QUALITY]: 11, [BROTLI_PARAM_LGWIN]: 24, [BROTLI_PARAM_SIZE_HINT]: bytes.length };
const brotli = brotliCompressSync(bytes, { params }).length;
const packed = deflateSync(bytes, { level: 9 });
console.log(`${bytes.length} bytes, ${packed.length} by deflate, ${brotli} by brotli`);
if (brotli > MAX_BROTLI_BYTES) {
  console.error(`the module has more than ${MAX_BROTLI_BYTES} bytes by brotli`);
  process.exit(1);
}
writeFileSync(out, packed);
