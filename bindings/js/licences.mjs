// Writes LICENSES.md: the licences of the crates in the WebAssembly module, with their texts. With `--check` it fails
// if the file is out of date. It needs cargo, whose cache has the texts.

import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";

const out = new URL("LICENSES.md", import.meta.url);
const cwd = new URL("../..", import.meta.url);
const cargo = (...args) =>
  execFileSync("cargo", args, { cwd, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "pipe"] });

const target = "wasm32-unknown-unknown";
const tree = cargo(
  "tree", "--locked", "--package", "p2m-c", "--no-default-features", "--target", target,
  "--edges", "normal,no-proc-macro",
  "--prefix", "none", "--format", "{p}|{l}");
const crates = [...new Set(tree.trim().split("\n").map((line) => line.replace(" (*)", "")))]
  .map((line) => {
    const [name, version, ...rest] = line.split("|")[0].split(" ");
    return { name, version: version.slice(1), licence: line.split("|")[1], isOwn: rest.length > 0 };
  })
  .filter(({ isOwn }) => !isOwn)
  .sort((a, b) => (a.name < b.name ? -1 : 1));
const { packages } = JSON.parse(cargo("metadata", "--locked", "--format-version", "1"));

// A text that several crates share is written once, for all of them.
const texts = new Map();
for (const { name, version } of crates) {
  const folder = dirname(packages.find((own) => own.name === name && own.version === version).manifest_path);
  for (const file of readdirSync(folder).filter((own) => /^(licen[cs]e|copying|notice)/i.test(own)).sort()) {
    if (!existsSync(join(folder, file))) continue;
    const text = readFileSync(join(folder, file), "utf8").replaceAll("\r", "").replace(/[ \t]+$/gm, "").trim();
    // Users of a crate choose between its licences, and the package has the text of the Apache licence already.
    if (!/Apache License\s+Version 2\.0/.test(text)) texts.set(text, [...(texts.get(text) ?? []), name]);
  }
}
const rows = crates.map(({ name, version, licence }) => `| ${name} | ${version} | ${licence} |`);
const sections = [...texts].map(([text, names]) => `## ${names.join(", ")}\n\n\`\`\`text\n${text}\n\`\`\`\n`);
const page = `# Licences

p2m itself is licensed under MIT or Apache-2.0: see LICENSE-MIT and LICENSE-APACHE. The module of WebAssembly contains the
standard library of Rust (MIT or Apache-2.0) and these crates. Their licences follow, but for that of Apache, whose text
is LICENSE-APACHE.

| crate | version | licence |
|---|---|---|
${rows.join("\n")}

${sections.join("\n")}`;
if (process.argv.includes("--check")) {
  if (readFileSync(out, "utf8") !== page) {
    console.error("bindings/js/LICENSES.md is not that of the crates: run `node licences.mjs` in bindings/js");
    process.exit(1);
  }
} else {
  writeFileSync(out, page);
}
