// Runs the checksums as a WebAssembly module: node node.mjs MODULE. `cargo xtask wasm` calls this script.
import { readFileSync } from "node:fs";

const module = await WebAssembly.instantiate(readFileSync(process.argv[2]), {});
const { p2m_fault_count, p2m_report, p2m_report_length, memory } = module.instance.exports;
const faults = p2m_fault_count();
const text = new Uint8Array(memory.buffer, p2m_report(), p2m_report_length());
console.log(new TextDecoder().decode(text));
process.exit(faults ? 1 : 0);
