// The browser in which pages are opened.

import { existsSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

// The path of the browser, or undefined where there is none.
export const BROWSER = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);

// Starts the browser, which draws without a graphics processor.
export function launch() {
  return chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

// Opens a page in a window of its own and waits until it is drawn. Errors, and requests to a network, are passed to
// `report` as text.
export async function open(browser, html, report) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 800 } });
  page.on("console", (message) => message.type() === "error" && report(message.text()));
  page.on("pageerror", (error) => report(error.message));
  page.on("request", (request) => request.url().startsWith("http") && report(request.url()));
  await page.goto(pathToFileURL(html).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  return page;
}
