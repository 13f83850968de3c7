// The program and the browser of the tests. The variable P2M names the program. Tests are skipped where that or
// Chromium is missing.

import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const PROGRAM = process.env.P2M;
const BROWSER = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
const SCENE = new URL("../../../../scenes/knot_and_cables.obj", import.meta.url);
export const skip = !PROGRAM ? "P2M does not name the program" : !BROWSER ? "Chromium is not installed" : false;

// Starts the browser, which draws without a graphics processor, or not at all.
export function launch(draws = true) {
  const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
  return chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", ...(draws ? drawing : ["--disable-3d-apis"])],
  });
}

// Opens a page in a window of a browser and waits until it is drawn. What must not happen is passed to `report` as
// text: errors, and requests of the page.
export async function openTab(browser, html, report, options = {}) {
  const tab = await browser.newPage({ viewport: { width: 1200, height: 800 }, ...options });
  tab.on("console", (message) => message.type() === "error" && report(message.text()));
  tab.on("pageerror", (error) => report(error.message));
  tab.on("request", (request) => request.url().startsWith("http") && report(request.url()));
  // Tests read the pixels of the picture as it was drawn last: four bytes for each.
  await tab.addInitScript(() => {
    window.readPicture = () => {
      const gl = window.viewer.renderer.getContext();
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return pixels;
    };
  });
  await tab.goto(pathToFileURL(html).href);
  await tab.waitForFunction(() => document.documentElement.dataset.ready || !document.getElementById("panel"));
  return tab;
}

// A page of the carried scene that `p2m view` wrote with these arguments.
export class Page {
  static async open(...args) {
    const self = new Page();
    self.folder = mkdtempSync(join(tmpdir(), "p2m-page-"));
    self.scene = self.write("scene.obj", `o all\n${readFileSync(SCENE, "utf8")}`);
    self.browser = await launch();
    self.problems = [];
    self.tab = await self.view(self.scene, ...args);
    return self;
  }

  // Writes a file into the folder of the page and returns its path.
  write(name, text) {
    const path = join(this.folder, name);
    writeFileSync(path, text);
    return path;
  }

  // Opens the page of another scene in a window of its own.
  view(scene, ...args) {
    const html = join(this.folder, "page.html");
    execFileSync(PROGRAM, ["view", scene, ...args, "--out", html], { stdio: "pipe" });
    return openTab(this.browser, html, (problem) => this.problems.push(problem));
  }

  // Returns the rows that `p2m query` prints for these arguments.
  query(...args) {
    const csv = join(this.folder, "answers.csv");
    execFileSync(PROGRAM, ["query", this.scene, ...args, "--out", csv], { stdio: "pipe" });
    return readFileSync(csv, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  }

  // Returns what stands beside a term of a list, with all digits of numbers.
  read(list, name, tab = this.tab) {
    return tab.evaluate(([list, name]) => {
      const term = [...document.querySelectorAll(`#${list} dt`)].find((dt) => dt.textContent === name);
      const shown = term?.nextElementSibling.cloneNode(true);
      shown?.querySelectorAll("data").forEach((data) => data.replaceWith(data.getAttribute("value")));
      return shown?.textContent;
    }, [list, name]);
  }

  // Returns the answer that a list shows, in the columns of `p2m query`.
  async answer(list) {
    const numbers = async (name) => (await this.read(list, name)).split(/,\s+/).map(Number.parseFloat);
    return [...(await numbers("query")), ...(await numbers("closest point")), ...(await numbers("distance")),
      Number((await this.read(list, "primitive")).split(" ")[1]), await this.read(list, "feature")];
  }

  close() {
    return this.browser.close();
  }
}

// Returns a row of `p2m query` with numbers as such.
export function parsed(row) {
  return row.slice(0, 9).map((cell, i) => (i < 8 ? Number(cell) : cell));
}
