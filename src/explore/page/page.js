// The page: what is chosen, and the views that show it.

import * as ask from "./ask.js";
import * as attractors from "./attractors.js";
import * as busy from "./busy.js";
import * as colouring from "./colouring.js";
import * as diagram from "./diagram.js";
import * as divider from "./divider.js";
import * as tabs from "./tabs.js";
import * as view from "./view.js";
import { Basin } from "./basin.js";
import { brush, selection } from "./brush.js";
import { Choices } from "./choices.js";
import { by, element, fault, marked } from "./element.js";
import { facts } from "./facts.js";
import { caseForm, fillForm, lineForm } from "./form.js";
import { handMaps, nameSaving } from "./handed.js";
import { Indices } from "./indices.js";
import { decorate } from "./icons.js";
import { quoted } from "./keep.js";
import { legend } from "./legend.js";
import { Line, longer } from "./line.js";
import { CellMap } from "./map.js";
import { learn } from "./model.js";
import { Motions } from "./motions.js";
import { notice } from "./notices.js";
import { choose, chooseOnMap, drag, drawLine, hover, mode, readout } from "./onmap.js";
import { largest, lay, turnToTradeOff, wait } from "./opening.js";
import { bare, mark, select, showCurves, showTradeOff } from "./overlay.js";
import { recoloured } from "./plot.js";
import { watch } from "./progress.js";
import { Scatter } from "./scatter.js";
import { axes, chosen, clicked, ends, page, pins } from "./shown.js";
import { isSeen, listenToMap, listenToSteps, look, looked, offerSteps, pressed, switched } from "./tools.js";
import { TradeOff, prices } from "./tradeoff.js";
import * as units from "./units.js";

let asking = null;
/** The cells that the marks over the map belong to. */
let lying = null;
async function showMap() {
  asking?.abort();
  const { signal } = asking = new AbortController(), begun = performance.now(), task = busy.begin("map", "Map");
  const asked = page.choices.asked(), cells = JSON.stringify({ ...asked, of: null });
  const data = await attractors.tinted(asked, signal).catch((it) => { task.end(false); throw it; }), came = performance.now();
  // What lay over other cells is not over these.
  if (cells !== lying) { lying = null; bare(); }
  page.raw = data;
  paint();
  task.end();
  attractors.show(choose);
  const now = performance.now();
  Object.assign(by("map").dataset, { milliseconds: (now - begun).toFixed(1), painted: (now - came).toFixed(1) });
  by("map").setAttribute("aria-label", `Map of ${data.told} over ${data.x.label} and ${data.y.label}, ${data.x.values.length} by ${data.y.values.length} cases`);
  document.body.dataset.ready = "true";
  if (lying) select(); else await Promise.all([showTradeOff(signal), showCurves(signal)]);
  lying = cells;
  painted = Object.fromEntries(page.choices.keys().map((key) => [key, view.text(key)]));
  mark();
  handMaps();
  readout();
}

// The map in the colours that are asked for.
function paint() {
  const data = colouring.coloured(page.raw);
  page.map.show(data);
  colouring.fill(data, page.file);
}

/** What the address said of the map that is shown. */
let painted = null;
// A map that could not be shown is not chosen any more: the one before it is still there.
function takeBack() {
  if (!painted) return;
  view.restore(painted);
  page.choices.draw();
  notice();
}

/** The axes over which the form of a line was built, and what fills it. */
let formed = { key: "", fill: null };
// The form has the ends of the line, or those of the map.
function fillLine(line) {
  const all = axes(), key = all.map((it) => it.name).join();
  if (key !== formed.key) formed = { key, fill: lineForm(all, drawLine) };
  formed.fill(line || [0, -1].map((end) => all.map((it) => it.values.at(end))));
}

async function showMotion() {
  const coordinates = chosen();
  by("basin-button").disabled = !coordinates;
  offerSweep();
  if (!coordinates) { page.motions.clear(); return; }
  clicked.at ??= performance.now();
  if (!await page.motions.show(coordinates)) return;
  fillForm(page.file, coordinates);
  drawn(true);
}

// Keeps how long it took from the click until the charts of the motion were seen, and tells it when all of the motion is told.
function drawn(isWhole) {
  // The frame that shows the motion is painted before the next task.
  requestAnimationFrame(() => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      clicked.seen ??= performance.now() - clicked.at;
      if (!isWhole) return;
      page.motions.finish();
      by("motions").dataset.milliseconds = clicked.seen.toFixed(1);
      Object.assign(clicked, { at: null, seen: null });
    };
    port2.postMessage(0);
  });
}

// The same case in another sweep, unless it is pinned.
function otherSweep() {
  const coordinates = chosen(), sweep = coordinates?.sweep && page.file.directions.find((it) => it !== coordinates.sweep);
  const other = sweep && { ...coordinates, sweep };
  return other && pins().length < 2 && pins().every((it) => view.written(it) !== view.written(other)) ? other : null;
}

function offerSweep() {
  const other = otherSweep();
  by("other-sweep-button").hidden = !other;
  if (other) by("other-sweep-button").textContent = `Compare with the ${other.sweep} sweep`;
}

function showLine() {
  const both = ends(), { file, map, line } = page;
  by("line-place").hidden = !both;
  by("line-empty").hidden = !!both;
  if (axes().length) fillLine(both?.map((it) => axes().map((axis) => it[axis.name])));
  if (!both) return line.stop();
  const [from, to] = both, start = view.text("start") || (file.inherits ? "inherit" : "afresh");
  const along = map ? longer(map.data, from, to) : axes()[0];
  const fixed = Object.entries(from).filter(([name, value]) => to[name] === value);
  const where = page.motions.words({ ...(map ? page.choices.held() : {}), ...Object.fromEntries(fixed) });
  by("line-heading").replaceChildren(...marked(`Bifurcation diagram${map ? " along the line" : ""}${where ? `: ${where}` : ""}`));
  return line.follow({ from, to, held: { ...(map ? page.choices.held() : {}), ...page.choices.from() }, start, axes: axes(), along });
}

function showBasin() {
  const coordinates = view.coordinates(view.text("basin"));
  by("basin-place").hidden = !coordinates;
  by("basin-empty").hidden = !!coordinates || by("attractors").childElementCount > 0;
  if (!coordinates) return page.basin.stop();
  return page.basin.show(coordinates, view.numbers("starts", 4), page.motions.words(coordinates));
}

// The basins at the parameters of the chosen case, whatever its start.
function askBasin() {
  const parameters = Object.entries(chosen() || {}).filter(([name]) => name !== "from" && !name.startsWith("start_"));
  view.step({ basin: view.written(Object.fromEntries(parameters)), ...tabs.pane("basin") });
}

async function showPins() {
  offerSweep();
  await page.motions.pin(pins());
  if (page.map?.data) mark();
}

// What has changed of the map and of what lies over it.
async function mapChanged(has) {
  const isOther = has(...page.choices.keys());
  if (has("window") && !isSeen()) look();
  if (has("exact")) page.map.isExact = by("exact-switch").checked = view.text("exact") === "1";
  if (isOther) { page.choices.draw(); notice(); await showMap(); }
  else if (has("trade", "curves")) { await Promise.all([has("trade") && showTradeOff(), has("curves") && showCurves()]); mark(); handMaps(); }
  else if (has("brush")) select();
  if (has("bare")) attractors.over();
  if (has(...colouring.KEYS) && !isOther) { paint(); handMaps(); }
  if (has("at", "line", "pins") && !isOther) mark();
}

/** Shows what has changed in the address. */
async function changed(keys) {
  const has = (...all) => all.some((key) => keys.includes(key));
  // All that is shown is asked for in the units of the page.
  if (has("units")) { location.reload(); return; }
  by("fault").hidden = true;
  offerSteps();
  if (has("pane")) tabs.turn();
  // What is computed is asked for first, as it takes longest.
  const views = has("at") ? [showMotion()] : [];
  try {
    if (page.map) await mapChanged(has);
    if (page.diagram && has("at", ...diagram.KEYS)) views.push(page.diagram.show());
    if (has("pins")) views.push(showPins());
    if (has("same")) page.motions.scale(by("same-switch").checked = view.text("same") === "1");
    if (has("line", "start", ...page.choices.keys())) views.push(showLine());
    if (has("basin", "starts")) views.push(showBasin());
  } catch (it) {
    fault(it);
    if (it.name !== "AbortError" && has(...page.choices.keys())) takeBack();
  }
  notice();
  await Promise.all(views.map((it) => it?.catch(fault)));
}

function pin(all) {
  view.step({ pins: all.length ? all.map(view.written).join(";") : null });
  by("motion-heading").focus({ preventScroll: true });
}

function build(file) {
  page.file = file;
  page.choices = new Choices(file);
  page.motions = new Motions(file, { drawn: () => drawn(false), pin: (it) => pin([...pins(), it]), unpin: (key) => pin(pins().filter((it) => view.written(it) !== key)) });
  page.basin = new Basin(by("basin-place"), { choose, range: (all) => view.step({ starts: all && all.join(",") }), shown: () => page.basin.mark(chosen()) });
  page.line = new Line(by("line-place"), {
    choose, start: (start) => view.step({ start }), spot: (it) => page.map?.set({ spot: it && axes().map((axis) => it[axis.name]) }),
    turn: () => view.step({ line: view.text("line").split("~").reverse().join("~") }),
  });
  page.tradeOff = new TradeOff(by("trade-off-place"), prices(file), {
    price: (trade) => view.step({ trade, brush: selection()?.plane === "map" ? view.text("brush") : null }),
    choose: (cell) => chooseOnMap(page.tradeOff.coordinates(cell)),
    spot: (cell) => page.map.set({ spot: cell === null ? null : page.tradeOff.coordinates(cell) }),
    brush: (ranges) => brush("trade-off", ranges),
    drop: () => view.step({ trade: null, brush: null, ...tabs.pane("motion") }),
  });
  pressed("basin-button", askBasin);
  pressed("other-sweep-button", () => { const other = otherSweep(); if (other) pin([...pins(), other]); });
  pressed("fault-button", () => { by("fault").hidden = true; });
  switched("same");
  caseForm(file, (it) => choose({ ...it, ...(Object.keys(it).some((name) => name.startsWith("start_")) ? {} : page.choices.from()) }));
  fillForm(file, {});
}

function describe() {
  const { file } = page;
  by("title").textContent = file.title;
  by("about").textContent = `${file.file}: ${file.cases.toLocaleString("en")} case${file.cases === 1 ? "" : "s"}; ${file.program}`;
  by("about").title = by("about").textContent;
  by("study").textContent = file.study;
  // Tables that are open stay so while a run goes on.
  if (!by("facts").childElementCount) by("facts").replaceChildren(...facts(file));
  document.title = `${file.title}: capsulemap explore`;
  const command = element("code", { textContent: `capsulemap explore ${quoted(file.file)}` });
  by("again-hint").replaceChildren("To see this view on another day, start ", command, " again and put the part of this address from # behind the new address.");
  notice();
}

async function open(file) {
  decorate();
  build(file);
  describe();
  tabs.listen();
  divider.listen();
  listenToSteps();
  offerSteps();
  units.listen(file);
  wait(file, () => chooseOnMap(largest()));
  if (lay(file)) {
    page.map = new CellMap(by("map"), { hover, choose: chooseOnMap, drag, mode, looked });
    look();
    listenToMap();
    nameSaving();
    if (prices(file).length) tabs.turned("trade-off", () => turnToTradeOff(prices(file)));
    else tabs.remove("trade-off");
  }
  if (file.diagrams.length) {
    page.diagram = new diagram.Diagram(by("whole-place"), file, choose);
    await page.diagram.show().catch(fault);
    document.body.dataset.ready = "true";
  }
  // Draws have no axes, and are shown over what was drawn.
  if (file.is_design) new Indices(by("whole-place"), file);
  if (file.draws?.length) new Scatter(by("whole-place"), { choose }).show().then(() => { document.body.dataset.ready = "true"; }, fault);
  view.changed(changed);
  recoloured("legend", legend);
  await changed(["of", "exact", "at", "pins", "same", "line", "basin"]);
  if (file.running) watch(file.running, again);
}

// Takes the file and the map as they are now; the view stays.
async function again() {
  Object.assign(page.file, await ask.object("/api/file"));
  lying = null;
  describe();
  if (page.map) await mapChanged((...keys) => keys.includes("of"));
}

async function openAnew() {
  try {
    await ask.object("/api/anew");
    location.reload();
  } catch (it) { fault(it); }
}

addEventListener("results-changed", ({ detail }) => {
  fault({ message: detail });
  by("anew-button").hidden = false;
});
pressed("anew-button", openAnew);
const file = await ask.object("/api/file").catch(fault);
if (file) {
  learn(file.model);
  await open(file);
}
