// Opens the page of `capsulemap explore` in Chromium, uses it as a person would, and prints what was found as one JSON object.
//
//   node explore.mjs check ADDRESS [FOLDER]    goes through every view in light and dark; screenshots go to FOLDER
//   node explore.mjs open ADDRESS [FOLDER]     opens a file of one axis, of basins or of draws in all sizes, and clicks what it shows
//   node explore.mjs measure ADDRESS CLICKS    times from click to painted motion, and from request to painted map [ms]

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

// The packages of package.json, which are installed outside of the repository.
const require = createRequire(`${process.env.CAPSULEMAP_BROWSER}/`);
const { chromium } = require("playwright-core");
const AXE = readFileSync(require.resolve("axe-core"), "utf8");

const [task, address, option] = process.argv.slice(2);
const ARGUMENTS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
const executablePath = process.env.CAPSULEMAP_CHROMIUM || "/usr/bin/chromium";
const found = { requests: [], console: [], axe: [], views: {} };

const browser = await chromium.launch({ executablePath, args: ARGUMENTS });
// The page is opened once by its token: the cookie of that context opens it in the other scheme.
const opening = await browser.newContext({ viewport: { width: 1400, height: 1000 } });

async function opened(context, at) {
  const page = await context.newPage();
  // Machines that do much else beside are slow.
  page.setDefaultTimeout(120_000);
  page.on("request", (request) => found.requests.push(request.url()));
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) found.console.push(message.text()); });
  page.on("pageerror", (fault) => found.console.push(String(fault)));
  await page.goto(at);
  await page.waitForSelector("body[data-ready=true]");
  return page;
}

/** The serious findings of axe-core on what is shown, and a picture of it. */
async function look(page, scheme, name) {
  // axe-core is evaluated by the test, which the policy of the page does not bind.
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  for (const { id, impact, nodes } of violations) {
    if (["serious", "critical"].includes(impact)) found.axe.push({ scheme, name, id, at: nodes.map((it) => it.target.join(" ")) });
  }
  if (option) await page.screenshot({ path: `${option}/${scheme}-${name}.png`, fullPage: true });
}

/** A point of the map by its shares of the frame. */
async function point(page, across, up) {
  const box = await page.locator("#map").boundingBox();
  // Within the frame, whose labels are left of it and below, and whose colours are right of it.
  const [left, right, bottom] = [80, 150, 50];
  return [box.x + left + across * (box.width - left - right), box.y + (1 - up) * (box.height - bottom)];
}

/** Clicks the map and waits for the motion; returns the time until it was painted [ms]. */
async function click(page, across, up) {
  await page.evaluate(() => { delete document.getElementById("motions").dataset.milliseconds; });
  await page.mouse.click(...await point(page, across, up));
  await page.waitForSelector("#motions[data-milliseconds]");
  return Number(await page.getAttribute("#motions", "data-milliseconds"));
}

/** The rows of the table called `heading`. */
const table = (page, heading) => page.evaluate((wanted) => {
  const summary = [...document.querySelectorAll("#motions summary")].find((it) => it.textContent.startsWith(wanted));
  const details = summary.parentElement;
  details.open = true;
  return new Promise((resolve) => setTimeout(() => {
    const rows = [...details.querySelectorAll("tr")].map((row) => [...row.children].map((cell) => cell.textContent.replace("−", "-")));
    details.open = false;
    resolve(rows);
  }, 300));
}, heading);

const command = (page, start) => page.evaluate((wanted) => {
  const all = [...document.querySelectorAll("#commands pre, #commands code")].map((it) => it.textContent);
  return all.find((it) => it.includes(wanted)) ?? null;
}, start);

async function check(page, scheme) {
  await look(page, scheme, "map");
  await click(page, 0.4, 0.5);
  const view = { command: await command(page, "capsulemap simulate"), numbers: await table(page, "Numbers of the orbit"), figure: await command(page, "capsulemap figure") };
  view.charts = await page.locator("#motions canvas").count();
  await look(page, scheme, "motion");
  // The address holds the view: another page at it shows the same.
  const again = await opened(page.context(), page.url());
  await again.waitForSelector("#motions[data-milliseconds]");
  view.again = await command(again, "capsulemap simulate");
  await again.close();

  await page.click("#pin-button");
  await click(page, 0.7, 0.8);
  view.pinned = await page.locator("#motions > *").count();
  await look(page, scheme, "compare");

  // The keyboard alone.
  const before = await command(page, "capsulemap simulate");
  await page.focus("#map");
  for (const key of ["ArrowLeft", "ArrowLeft", "ArrowDown"]) await page.keyboard.press(key);
  await page.keyboard.press("Enter");
  await page.waitForFunction((before) => ![...document.querySelectorAll("#commands pre, #commands code")].some((it) => it.textContent === before), before);
  view.byKeys = (await command(page, "capsulemap simulate")) !== before;

  await page.click("#trade-off-tab");
  await page.waitForSelector("#trade-off-section:not([hidden]) canvas");
  await page.waitForTimeout(500);
  await look(page, scheme, "trade-off");

  // A line along omega.
  await page.click("#line-button");
  await page.mouse.move(...await point(page, 0.1, 0.5));
  await page.mouse.down();
  await page.mouse.move(...await point(page, 0.5, 0.5), { steps: 4 });
  await page.mouse.move(...await point(page, 0.9, 0.5), { steps: 4 });
  await page.mouse.up();
  await page.waitForSelector("#line-section:not([hidden])");
  view.inFront = await page.getAttribute("#line-tab", "aria-selected");
  await page.waitForFunction(() => [...document.querySelectorAll("#commands pre, #commands code")].some((it) => it.textContent.includes("name = \"bifurcation\"")), null, { timeout: 60_000 });
  view.line = await command(page, "name = \"bifurcation\"");
  await page.waitForFunction(() => document.getElementById("line-section").textContent.includes("values in"), null, { timeout: 60_000 });
  await look(page, scheme, "line");
  await page.click("#branches-button");
  await page.waitForFunction(() => /branch(es)? of .* in .* s/.test(document.getElementById("branches-told").textContent), null, { timeout: 120_000 });
  view.branches = await page.textContent("#branches-told");
  await look(page, scheme, "branches");

  await page.click("#basin-button");
  await page.waitForSelector("#basin-section:not([hidden])");
  await page.waitForFunction(() => { const told = document.getElementById("basin-told").textContent; return told.includes("starts in") && !told.includes("finer"); }, null, { timeout: 60_000 });
  view.basin = await command(page, "name = \"basin\"");
  await look(page, scheme, "basin");

  const download = page.waitForEvent("download");
  await page.click("#pdf-button");
  const bytes = readFileSync(await (await download).path());
  view.pdf = bytes.subarray(0, 4).toString();
  found.views[scheme] = view;
  found.hash = new URL(page.url()).hash.slice(1).replace(/&?pane=[^&]*/, "").replace(/&?basin=[^&]*/, "");
  await steps(page, scheme);
}

/** A condition that the page must meet. */
function must(isMet, words) {
  if (!isMet) throw new Error(words);
}

/** Goes through the widths of windows: nothing is cut off, and the map stays in sight beside the pane. */
async function widths(state, scheme) {
  for (const [width, height] of [[390, 844], [1280, 800], [1920, 1080]]) {
    const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, storageState: state });
    const page = await opened(context, `${new URL("/", address).href}#${found.hash}`);
    await page.waitForSelector("#motions[data-milliseconds]");
    for (const view of ["motion", "line", "trade-off", "data"]) {
      await page.click(`#${view}-tab`);
      await page.waitForTimeout(400);
      await look(page, scheme, `${width}-${view}`);
      const wide = await page.evaluate(() => [document.documentElement.scrollWidth, document.getElementById("pane").scrollWidth - document.getElementById("pane").clientWidth]);
      must(wide[0] <= width && wide[1] <= 0, `at ${width} px the ${view} is wider than the window: ${wide}`);
    }
    if (width > 960) {
      const [map, pane] = await Promise.all(["#map", "#pane"].map((it) => page.locator(it).boundingBox()));
      must(map.y >= 0 && map.y + map.height <= height && map.x + map.width <= pane.x, `at ${width} px the map is out of sight`);
      await page.evaluate(() => document.getElementById("data-section").scrollTo(0, 1e6));
      must((await page.locator("#map").boundingBox()).y === map.y, "the map moves where the pane scrolls");
    }
    await context.close();
  }
}

/** Steps are undone and done again, the tabs follow the arrows, colours go into the command, and the end of a line is dragged. */
async function steps(page, scheme) {
  await page.click("#data-tab");
  await page.keyboard.press("ArrowRight");
  must(await page.getAttribute("#motion-tab", "aria-selected") === "true", "the arrows do not go around the tabs");
  const before = await page.evaluate(() => location.hash);
  await page.click("#colours-button");
  await page.selectOption("#colours-form select[name=colours]", "cividis");
  await page.fill("#colours-form input[name=from]", "-20");
  await page.fill("#colours-form input[name=to]", "20");
  await page.click("#colours-form button:not([type=button])");
  const figure = await command(page, "--colour-map progression_speed=cividis");
  must(figure?.includes("-20 mm/s,20 mm/s"), `the colours are not in the command: ${figure}`);
  await page.click("#undo-button");
  await page.click("#undo-button");
  await page.waitForFunction((before) => location.hash === before, before);
  await page.click("#redo-button");
  await page.waitForFunction(() => location.hash.includes("cividis"));
  await page.click("#undo-button");
  await page.waitForFunction((before) => location.hash === before, before);
  await page.click("#colours-button");
  const ends = () => page.evaluate(() => [...document.querySelectorAll("#line-form input")].map((it) => Number(it.value)));
  const old = await ends(), [x, y] = await lineEnd(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y - 40, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction((old) => [...document.querySelectorAll("#line-form input")].some((it, i) => Number(it.value) !== old[i]), old);
  const now = await ends();
  must(now[0] === old[0] && now[1] === old[1] && now[2] < old[2] && now[3] > old[3], `the end of the line is not where it was dragged: ${old} to ${now}`);
  await units(page, now, scheme);
}

/** Other units are those of the map, of the forms and of the command, and go again where they are undone. */
async function units(page, ends, scheme) {
  // Another view may be in front.
  const loaded = () => page.waitForSelector("#motions[data-milliseconds]", { state: "attached" });
  const chosen = () => page.evaluate(() => [...document.querySelectorAll("#line-form input")].map((it) => Number(it.value)));
  await page.click("#units-button");
  await page.selectOption("#units-form select[name=unit-0]", "Hz");
  await Promise.all([page.waitForEvent("load"), page.click("#units-form button:not([type=button])")]);
  await loaded();
  const figure = await command(page, "--unit omega=Hz"), [from, , to] = await chosen(), turn = 2 * Math.PI;
  must(figure !== null, "the unit is not in the command");
  must(Math.abs(from * turn / ends[0] - 1) < 1e-9 && Math.abs(to * turn / ends[2] - 1) < 1e-9, `the line is not told in hertz: ${from} to ${to}`);
  must((await page.getAttribute("#map", "aria-label")).includes("Hz"), "the map is not in hertz");
  await page.click("#units-button");
  await look(page, scheme, "units");
  await Promise.all([page.waitForEvent("load"), page.click("#undo-button")]);
  await loaded();
  must(await command(page, "--unit") === null, "the unit stays where it is undone");
}

/** The place of the end of the line on the page. */
async function lineEnd(page) {
  const to = await page.evaluate(async () => {
    const { page: shown } = await import("/page/shown.js");
    return shown.map.place(shown.map.ends()[1]);
  });
  const box = await page.locator("#map").boundingBox();
  return [box.x + to[0], box.y + to[1]];
}

async function measure(page) {
  const clicks = [], maps = [];
  // Not at the rim, where a click may miss the frame.
  const within = (share) => 0.05 + 0.9 * (share % 1);
  // Places of a sequence that fills the map evenly.
  for (let i = 1; i <= Number(option || 100); i++) clicks.push(await click(page, within(i * 0.7548776662), within(i * 0.5698402910)));
  const outputs = await page.locator("#choices select[name=of] option").evaluateAll((all) => all.map((it) => it.value));
  for (const of of outputs.slice(0, 10)) {
    await page.evaluate(() => { delete document.getElementById("map").dataset.milliseconds; });
    await page.selectOption("#choices select[name=of]", of);
    await page.waitForSelector("#map[data-milliseconds]");
    maps.push(Number(await page.getAttribute("#map", "data-milliseconds")));
  }
  const at = (all, share) => [...all].sort((a, b) => a - b)[Math.min(all.length - 1, Math.floor(share * all.length))];
  const told = (all) => ({ count: all.length, median: at(all, 0.5), p95: at(all, 0.95), most: at(all, 1) });
  return { clicks: told(clicks), maps: told(maps) };
}

/** What a file without a map of a parameter plane opens on, in all sizes and in both schemes; what a click and the keyboard tell there. */
async function files(state) {
  for (const scheme of ["light", "dark"]) for (const [width, height] of [[390, 844], [1280, 800], [1920, 1080]]) {
    const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, storageState: state });
    const page = await opened(context, new URL("/", address).href);
    await page.waitForTimeout(500);
    await look(page, scheme, `${width}-opened`);
    const view = {};
    const canvas = page.locator("#diagram, #map, #scatter").locator("visible=true").first();
    view.shows = await canvas.getAttribute("aria-label");
    if (await page.locator("#diagram").isVisible()) await diagram(page, view);
    else if (await page.locator("#map").isVisible()) await basins(page, view);
    else if (await page.locator("#indices button").isVisible()) {
      await page.click("#indices button");
      await page.waitForSelector("#indices table");
      view.indices = await page.textContent("#indices");
    }
    for (const name of ["motion", "branches", "basin", "data"]) {
      if (!await page.locator(`#${name}-tab`).isVisible()) continue;
      await page.click(`#${name}-tab`);
      await page.waitForTimeout(200);
      await look(page, scheme, `${width}-${name}`);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      must(wide <= width, `at ${width} px the ${name} is wider than the window: ${wide}`);
    }
    found.views[`${scheme} ${width}`] = view;
    await context.close();
  }
}

/** Clicks a point of a diagram, goes to a special point, and takes a part of the axis. */
async function diagram(page, view) {
  const box = await page.locator("#diagram").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 60);
  await page.waitForSelector("#motions[data-milliseconds]");
  view.command = await command(page, "capsulemap simulate");
  view.figure = await command(page, "capsulemap figure");
  await page.focus("#diagram");
  await page.keyboard.press("s");
  view.special = await page.textContent("#diagram-at");
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.7 * box.width, box.y + 60, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => location.hash.includes("range="));
  view.part = await command(page, "capsulemap figure");
  await page.keyboard.press("0");
  await page.waitForFunction(() => !location.hash.includes("range="));
}

/** Tells what lies over basins, and shows the motion of an attractor. */
async function basins(page, view) {
  view.attractors = await page.locator("#attractors tbody tr").count();
  view.figure = await command(page, "capsulemap figure");
  const at = await page.evaluate(async () => {
    const { page: shown } = await import("/page/shown.js");
    return shown.map.place(shown.map.shown(...shown.map.marks.saddles[0].at));
  });
  const box = await page.locator("#map").boundingBox();
  await page.mouse.move(box.x + at[0], box.y + at[1]);
  view.saddle = await page.textContent("#tip");
  await page.click("#attractors tbody button");
  await page.waitForSelector("#motions[data-milliseconds]");
  view.command = await command(page, "capsulemap simulate");
  // A click into the tools takes what lies over the basins away, another brings it back.
  await page.click("#curves-switch", { force: true });
  await page.waitForFunction(() => location.hash.includes("bare=1"));
  view.bare = await page.evaluate(async () => (await import("/page/shown.js")).page.map.marks.saddles.length);
  await page.click("#curves-switch", { force: true });
}

try {
  const first = await opened(opening, address);
  if (task === "open") {
    await files(await opening.storageState());
    console.log(JSON.stringify(found));
  } else if (task === "measure") {
    console.log(JSON.stringify(await measure(first)));
  } else {
    const state = await opening.storageState();
    await check(first, "light");
    await widths(state, "light");
    const dark = await browser.newContext({ viewport: { width: 1400, height: 1000 }, colorScheme: "dark", storageState: state });
    await check(await opened(dark, new URL("/", address).href), "dark");
    await widths(state, "dark");
    console.log(JSON.stringify(found));
  }
} finally {
  await browser.close();
}
