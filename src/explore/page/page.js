// The page: what is chosen, and the views that show it.

import * as ask from "./ask.js";
import * as view from "./view.js";
import { Basin } from "./basin.js";
import { brush, selection } from "./brush.js";
import { Choices } from "./choices.js";
import { button, by, element, fault, parted, said, say } from "./element.js";
import { caseForm, fillForm, lineForm } from "./form.js";
import { handOver, quoted, save } from "./keep.js";
import { legend } from "./legend.js";
import { Line, longer } from "./line.js";
import { CellMap } from "./map.js";
import { learn } from "./model.js";
import { Motions } from "./motions.js";
import { bare, mark, select, showCurves, showTradeOff } from "./overlay.js";
import { recoloured } from "./plot.js";
import { watch } from "./progress.js";
import { axes, chosen, ends, here, named, page, pins, price } from "./shown.js";
import { TradeOff, prices } from "./tradeoff.js";

/** When the case was clicked whose motion is awaited. */
let clicked = null;

function choose(coordinates) {
  clicked = performance.now();
  view.step({ at: view.written(coordinates) });
}

const chooseOnMap = (point) => choose({ ...page.choices.held(), ...named(point), ...page.choices.from() });

function hover(cell, isKey) {
  const { map, tradeOff } = page;
  // Between the cases the map has the value of the case of the cell.
  const point = () => (map.isExact ? ` (the point: ${axes().map((it, i) => said(it.label, cell.point[i] * it.factor)).join("; ")})` : "");
  const words = cell ? `${[said(map.data.told, map.told(cell)), ...here(cell.cell)].join("; ")}${point()}` : "\u00a0";
  by("told").textContent = words;
  if (cell && isKey) { say(words); legend(); }
  if (price()) tradeOff.mark(tradeOff.chosen, cell ? cell.number : null);
}

// The readout of the map as it is now: at the mark, or none.
const readout = () => hover(page.map.mark && page.map.at(page.map.mark), false);

function drawLine(from, to) {
  if (from.some((it, i) => it !== to[i])) view.step({ line: `${view.written(named(from))}~${view.written(named(to))}` });
  else { by("told").textContent = "Both ends of the line are at the same case: there is no line."; say(by("told").textContent); }
}

// A line or a rectangle was drawn over the map.
function drag(kind, from, to) {
  if (kind === "line") { drawLine(from, to); return; }
  if (from.every((it, i) => it === to[i])) return;
  const all = prices(page.file);
  if (!price() && all.length) view.set({ trade: all[0][0] });
  brush("map", [0, 1].map((i) => [Math.min(from[i], to[i]), Math.max(from[i], to[i])]));
}

function mode(kind) {
  by("line-button").setAttribute("aria-pressed", String(kind === "line"));
  by("brush-button").setAttribute("aria-pressed", String(kind === "rectangle"));
  const how = { line: "a line over the map; or begin at the mark with L, move the end with the arrows, and end with L", rectangle: "a rectangle over the map; or begin at the mark with R, move the corner with the arrows, and end with R" };
  const words = how[kind] ? `Drag ${how[kind]}.` : "\u00a0";
  by("told").textContent = words;
  if (how[kind]) say(words);
}

let asking = null;
/** The cells that the marks over the map belong to. */
let marked = null;
async function showMap() {
  asking?.abort();
  const { signal } = asking = new AbortController(), begun = performance.now();
  const asked = page.choices.asked(), cells = JSON.stringify({ ...asked, of: null });
  const data = await ask.map(asked, signal), came = performance.now();
  // What lay over other cells is not over these.
  if (cells !== marked) { marked = null; bare(); }
  page.map.show(data);
  const now = performance.now();
  Object.assign(by("map").dataset, { milliseconds: (now - begun).toFixed(1), painted: (now - came).toFixed(1) });
  by("map").setAttribute("aria-label", `Map of ${data.told} over ${data.x.label} and ${data.y.label}, ${data.x.values.length} by ${data.y.values.length} cases`);
  document.body.dataset.ready = "true";
  if (marked) select(); else await Promise.all([showTradeOff(signal), showCurves(signal)]);
  marked = cells;
  painted = Object.fromEntries(page.choices.keys().map((key) => [key, view.text(key)]));
  mark();
  handMaps();
  readout();
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

// The ends of the axes as they are seen, as options of the command; none where all is seen.
function limits() {
  const { map, file } = page;
  if (!map.window) return "";
  return [map.data.x, map.data.y].map((axis, i) => {
    const unit = file.axes.find((it) => it.name === axis.name)?.unit;
    const [low, high] = map.window[i].map((share) => map.value(axis, share));
    // As many digits as tell the ends apart to a thousandth.
    const digits = 4 + Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low)));
    const ends = [low, high].map((it) => `${Number(it.toPrecision(Math.max(digits, 4)))}${unit ? ` ${unit}` : ""}`);
    return ` --limits ${quoted(`${axis.name}=${ends.join(",")}`)}`;
  }).join("");
}

// Figures that are saved here show the whole map.
function nameSaving() {
  for (const format of ["pdf", "svg"]) {
    const it = by(`${format}-button`);
    if (it.getAttribute("aria-disabled") !== "true") it.textContent = `Save ${page.map.window ? "whole " : ""}${it.dataset.words}`;
  }
}

// The commands of the figures of the map and of the trade-off.
function handMaps() {
  const { file, choices } = page, { of, x, y } = choices.chosen(), { sweep } = choices.sweep();
  const places = Object.entries(choices.held()).map(([name, value]) => ` --at ${name}=${value}`).join("") + (sweep ? ` --sweep ${sweep}` : "");
  const figure = (kind, more) => `capsulemap figure ${quoted(file.file)} --kind ${kind} ${more}${places}`;
  handOver("map", "Figure of the map", figure("map", `--of ${of} --x ${x} --y ${y}${page.curves ? " --curves" : ""}${limits()}`));
  handOver("trade-off", "Figure of the trade-off", price() && sweep !== "difference" && figure("trade-off", `--of ${price()}`));
}

async function showMotion() {
  const coordinates = chosen();
  by("basin-button").hidden = !coordinates;
  offerSweep();
  if (!coordinates) { page.motions.clear(); return; }
  const begun = clicked ?? performance.now();
  clicked = null;
  if (!await page.motions.show(coordinates)) return;
  fillForm(page.file, coordinates);
  // The frame that shows the motion is painted before the next task.
  requestAnimationFrame(() => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => { by("motions").dataset.milliseconds = (performance.now() - begun).toFixed(1); };
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
  by("line-section").hidden = !both;
  if (map) fillLine(both?.map((it) => axes().map((axis) => it[axis.name])));
  if (!both) return line.stop();
  const [from, to] = both, start = view.text("start") || (file.inherits ? "inherit" : "afresh");
  const along = map ? longer(map.data, from, to) : file.axes[0];
  const fixed = Object.entries(from).filter(([name, value]) => to[name] === value);
  const where = page.motions.words({ ...(map ? page.choices.held() : {}), ...Object.fromEntries(fixed) });
  by("line-heading").textContent = `Bifurcation diagram along the line${where ? `: ${where}` : ""}`;
  return line.follow({ from, to, held: { ...(map ? page.choices.held() : {}), ...page.choices.from() }, start, axes: axes(), along });
}

function showBasin() {
  const coordinates = view.coordinates(view.text("basin"));
  by("basin-section").hidden = !coordinates;
  if (!coordinates) return page.basin.stop();
  return page.basin.show(coordinates, view.numbers("starts", 4), page.motions.words(coordinates));
}

// The basins at the parameters of the chosen case, whatever its start.
function askBasin() {
  const parameters = Object.entries(chosen() || {}).filter(([name]) => name !== "from" && !name.startsWith("start_"));
  view.step({ basin: view.written(Object.fromEntries(parameters)) });
  by("basin-section").scrollIntoView({ block: "nearest" });
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
  if (has("at", "line", "pins") && !isOther) mark();
}

/** Shows what has changed in the address. */
async function changed(keys) {
  const has = (...all) => all.some((key) => keys.includes(key));
  by("fault").hidden = true;
  // What is computed is asked for first, as it takes longest.
  const views = has("at") ? [showMotion()] : [];
  try {
    if (page.map) await mapChanged(has);
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

const written = (window) => window && window.flat().map((it) => Number(it.toFixed(5))).join(",");
const isSeen = () => (view.text("window") ?? null) === written(page.map.window);

function look() {
  const all = view.numbers("window", 4);
  if (all) page.map.look(all.slice(0, 2), all.slice(2)); else page.map.look();
}

// What depends on the part of the map that is seen.
function seen() {
  legend();
  nameSaving();
  handMaps();
}

let looking = 0;
// Many parts are seen while the map is dragged: the last one is held.
function looked(window) {
  clearTimeout(looking);
  looking = setTimeout(() => { view.set({ window: written(window) }); if (page.map.data) seen(); }, 200);
}

const pressed = (id, act) => by(id).addEventListener("click", act);
const switched = (name) => by(`${name}-switch`).addEventListener("change", (event) => view.set({ [name]: event.target.checked ? 1 : null }));

function listenToMap() {
  const { map, file } = page, turn = (kind) => () => map.setMode(map.mode === kind ? "move" : kind);
  pressed("line-button", turn("line"));
  pressed("brush-button", turn("rectangle"));
  pressed("in-button", () => map.zoom(0.8));
  pressed("out-button", () => map.zoom(1.25));
  pressed("whole-button", () => map.look());
  for (const format of ["pdf", "svg"]) pressed(`${format}-button`, (event) => save({ kind: "map", ...page.choices.asked(), ...(page.curves ? { curves: 1 } : {}) }, format, event.currentTarget).then(nameSaving));
  pressed("trade-off-button", () => view.set({ trade: price() ? null : prices(file)[0][0], brush: null }));
  ["curves", "exact"].forEach(switched);
  by("trade-off-button").hidden = by("brush-button").hidden = !prices(file).length;
  by("curves-switch").parentElement.hidden = !file.has_curves;
}

function pin(all) {
  view.set({ pins: all.length ? all.map(view.written).join(";") : null });
  by("motion-heading").focus({ preventScroll: true });
}

function build(file) {
  page.file = file;
  page.choices = new Choices(file);
  page.motions = new Motions(file, { pin: (it) => pin([...pins(), it]), unpin: (key) => pin(pins().filter((it) => view.written(it) !== key)) });
  page.basin = new Basin(by("basin-place"), { choose, range: (all) => view.set({ starts: all && all.join(",") }), shown: () => page.basin.mark(chosen()) });
  page.line = new Line(by("line-place"), {
    choose, start: (start) => view.set({ start }), spot: (it) => page.map?.set({ spot: it && axes().map((axis) => it[axis.name]) }),
  });
  page.tradeOff = new TradeOff(by("trade-off-place"), prices(file), {
    price: (trade) => view.set({ trade, brush: selection()?.plane === "map" ? view.text("brush") : null }),
    choose: (cell) => chooseOnMap(page.tradeOff.coordinates(cell)),
    spot: (cell) => page.map.set({ spot: cell === null ? null : page.tradeOff.coordinates(cell) }),
    brush: (ranges) => brush("trade-off", ranges),
  });
  pressed("basin-button", askBasin);
  pressed("other-sweep-button", () => { const other = otherSweep(); if (other) pin([...pins(), other]); });
  pressed("fault-button", () => { by("fault").hidden = true; });
  switched("same");
  caseForm(file, (it) => choose({ ...it, ...(Object.keys(it).some((name) => name.startsWith("start_")) ? {} : page.choices.from()) }));
  fillForm(file, {});
}

// What of the address cannot be read, in sentences.
function unread() {
  const told = [], has = (key) => view.text(key) !== null;
  if (has("at") && !chosen()) told.push("The case in the address (at) cannot be read: no motion is chosen.");
  if (has("line") && !ends()) {
    const isLine = view.text("line").split("~").map(view.coordinates).filter((it) => it).length === 2;
    told.push(isLine ? "The line in the address lies over other axes and is not shown." : "The line in the address (line) cannot be read and is not shown.");
  }
  return told;
}

// What the address asks for and the file does not have.
function notice() {
  const told = [...page.choices.unknown(), ...unread()];
  // The same words are not told twice.
  if (by("notice").textContent !== told.join(" ")) by("notice").textContent = told.join(" ");
  by("notice").hidden = !told.length;
}

function describe() {
  const { file } = page;
  by("title").textContent = file.title;
  by("about").textContent = `${file.file}: ${file.cases.toLocaleString("en")} cases; ${file.program}`;
  by("study").textContent = file.study;
  document.title = `${file.title}: capsulemap explore`;
  const command = element("code", { textContent: `capsulemap explore ${quoted(file.file)}` });
  by("again-hint").replaceChildren("To see this view on another day, start ", command, " again and put the part of this address from # behind the new address.");
  notice();
}

// Results over one axis or over draws have no map.
function withoutMap({ axes: [axis] }) {
  const words = axis ? "These results have one axis: draw a line along it, or compute a case by its numbers." : "These results have no axes: compute a case by its numbers.";
  by("map-place").replaceChildren(element("p", { textContent: words }));
  by("motion-empty").textContent = "Compute a case by its numbers.";
  by("form-place").open = true;
  const line = () => view.set({ line: [axis.values[0], axis.values.at(-1)].map((it) => view.written({ [axis.name]: it })).join("~") });
  if (axis) by("map-place").append(button(`Draw the line along ${parted(axis.label)[0]}`, line, { id: "line-button" }));
  document.body.dataset.ready = "true";
}

async function open(file) {
  build(file);
  describe();
  if (file.axes.length < 2) withoutMap(file);
  else {
    page.map = new CellMap(by("map"), { hover, choose: chooseOnMap, drag, mode, looked });
    look();
    listenToMap();
  }
  view.changed(changed);
  recoloured("legend", legend);
  await changed(["of", "exact", "at", "pins", "same", "line", "basin"]);
  if (file.running) watch(file.running, again);
}

// Takes the file and the map as they are now; the view stays.
async function again() {
  Object.assign(page.file, await ask.object("/api/file"));
  marked = null;
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
