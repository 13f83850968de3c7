// Writes a picture of a page as a browser shows it: node test/picture.mjs PAGE.html PICTURE.png [dark]

import { launch, openTab } from "./browser.mjs";

const [, , html, picture, theme] = process.argv;
if (!picture) throw new Error("this needs a page, and the file of the picture");
const browser = await launch();
const page = await openTab(browser, html, (problem) => { throw new Error(problem); });
if (theme === "dark") await page.click("#theme");
await page.waitForFunction(() => !window.viewer?.live || document.documentElement.dataset.live);
await page.waitForFunction(() => !window.viewer || window.viewer.painter.isRefined);
await page.screenshot({ path: picture });
await browser.close();
