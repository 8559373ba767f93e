// Opens a report of `capsulemap report` from its file in Chromium, sorts and copies its tables, and prints what was found as one JSON object.
//
//   node report.mjs FILE [FOLDER]    screenshots and the printed pages go to FOLDER

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

// The packages of package.json, which are installed outside of the repository.
const require = createRequire(`${process.env.CAPSULEMAP_BROWSER}/`);
const { chromium } = require("playwright-core");
const AXE = readFileSync(require.resolve("axe-core"), "utf8");

const [file, folder] = process.argv.slice(2);
const address = pathToFileURL(file).href;
const executablePath = process.env.CAPSULEMAP_CHROMIUM || "/usr/bin/chromium";
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu", "--no-first-run"] });
const found = { requests: [], console: [], axe: [], views: {} };

/** The texts of a column of a table. */
const column = (table, place) => table.locator("tbody tr").evaluateAll((rows, place) => rows.map((row) => row.cells[place].textContent), place);

for (const [colorScheme, width] of [["light", 1280], ["dark", 390]]) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  page.on("request", (request) => found.requests.push(request.url().slice(0, 200)));
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) found.console.push(message.text()); });
  page.on("pageerror", (fault) => found.console.push(String(fault)));
  // What is copied is caught: by the newer interface in one scheme, by the older one in the other.
  await page.addInitScript((isNew) => {
    const copied = (text) => { window.copied = text; };
    const clipboard = { writeText: async (text) => { if (!isNew) throw new Error("refused"); copied(text); } };
    Object.defineProperty(navigator, "clipboard", { value: clipboard });
    document.addEventListener("copy", () => copied(document.activeElement.value));
  }, colorScheme === "light");
  await page.goto(address);

  const view = { width: await page.evaluate(() => document.scrollingElement.scrollWidth) };
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  for (const { id, impact, nodes } of violations) {
    found.axe.push({ colorScheme, id, impact, at: nodes.map((it) => it.target.join(" ")) });
  }
  if (folder) await page.screenshot({ path: `${folder}/${colorScheme}.png`, fullPage: true });

  // The table of what is held by its numbers, with the keyboard.
  const held = page.locator(".table", { hasText: "What is held." });
  const button = held.locator("th button").nth(3);
  view.orders = [];
  for (let press = 0; press < 4; press++) {
    view.orders.push([await held.locator("thead th").nth(3).getAttribute("aria-sort"), await column(held, 3)]);
    await button.focus();
    await page.keyboard.press("Enter");
  }
  await held.locator(".copy").click();
  await page.waitForFunction(() => window.copied !== undefined);
  view.copied = await page.evaluate(() => window.copied);
  view.said = await page.locator("[role=status]").textContent();

  // Every link within the page leads somewhere.
  view.lost = await page.evaluate(() => [...document.querySelectorAll("a[href^='#']")].map((it) => it.hash.slice(1)).filter((id) => !document.getElementById(id)));
  const pdf = await page.pdf({ preferCSSPageSize: true, printBackground: true, path: folder ? `${folder}/${colorScheme}.pdf` : undefined });
  view.pdf = pdf.subarray(0, 4).toString();
  found.views[colorScheme] = view;
  await context.close();
}
await browser.close();
console.log(JSON.stringify(found));
