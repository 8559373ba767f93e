// The page: what is chosen, the map, the motion of the case that was clicked, and a line over the map.

import * as ask from "./ask.js";
import * as view from "./view.js";
import { Line } from "./line.js";
import { Map as CellMap } from "./map.js";
import { panel } from "./motion.js";
import { short } from "./plot.js";

const by = (id) => document.getElementById(id);
const file = await ask.object("/api/file").catch(told);
const pins = [];
let shown = null;

function told(fault) {
  if (fault.name === "AbortError") return;
  by("fault").textContent = fault.message;
  by("fault").hidden = false;
}

const map = new CellMap(by("map"), { hover, choose, line, mode });
const diagram = new Line(by("line"), by("line-told"));

const axis = (name) => file.axes.find((it) => it.name === name);
const chosen = () => ({
  of: view.text("of") || file.outputs[0].name,
  x: view.text("x") || file.axes.at(-1).name,
  y: view.text("y") || file.axes.at(-2).name,
});

/** The values of the axes that are not drawn. */
function held() {
  const { x, y } = chosen();
  const others = file.axes.filter((it) => it.name !== x && it.name !== y);
  return Object.fromEntries(others.map((it) => [it.name, view.number(it.name) ?? it.values[0]]));
}

const sweep = () => (file.directions.length > 1 ? { sweep: view.text("sweep") || file.directions[0] } : {});
const asked = () => ({ ...chosen(), ...held(), ...sweep() });

function option(select, value, text) {
  select.append(Object.assign(document.createElement("option"), { value, textContent: text }));
}

function choice(name, text, options, value) {
  const label = document.createElement("label"), select = document.createElement("select");
  select.name = name;
  options.forEach(([key, words]) => option(select, key, words));
  select.value = value;
  select.addEventListener("change", () => view.set({ [name]: select.value }));
  label.append(text, " ", select);
  by("choices").append(label);
}

function slider(it) {
  const label = document.createElement("label"), input = document.createElement("input"), says = document.createElement("output");
  const values = it.values, now = held()[it.name];
  Object.assign(input, { type: "range", min: 0, max: values.length - 1, step: 1, name: it.name });
  const nearest = (wanted) => values.reduce((best, value, i) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? i : best), 0);
  input.value = nearest(now);
  const tell = () => { says.textContent = `${short(values[input.value] * it.factor)} ${it.unit}`; };
  input.addEventListener("input", tell);
  input.addEventListener("change", () => view.set({ [it.name]: values[input.value] }));
  tell();
  label.append(it.label, " ", input, says);
  by("choices").append(label);
}

function drawChoices() {
  by("choices").replaceChildren();
  const { of, x, y } = chosen();
  choice("of", "Output", file.outputs.map((it) => [it.name, it.label]), of);
  if (file.axes.length > 2) {
    for (const [name, text, value] of [["x", "Across", x], ["y", "Up", y]]) choice(name, text, file.axes.map((it) => [it.name, it.label]), value);
  }
  if (file.directions.length > 1) choice("sweep", "Sweep", [...file.directions.slice(0, 2), "difference"].map((it) => [it, it]), sweep().sweep);
  file.axes.filter((it) => it.name !== x && it.name !== y).forEach(slider);
}

let asking = null;
async function showMap() {
  asking?.abort();
  asking = new AbortController();
  const data = await ask.map(asked(), asking.signal);
  map.show(data);
  by("map").setAttribute("aria-label", `Map of ${data.told} over ${data.x.label} and ${data.y.label}`);
  tellCommands();
}

/** What the page says of a cell. */
function words(at) {
  const { data } = map, { key } = data;
  const value = key.kinds ? key.kinds[at.value]?.[0] : Number.isFinite(at.value) ? short(at.value) : "no value";
  const place = (it, si) => `${it.label}: ${short(si * it.factor)}`;
  return `${data.told}: ${value ?? "no value"}; ${place(data.x, at.cell[0])}; ${place(data.y, at.cell[1])}`;
}

function hover(at) { by("told").textContent = at ? words(at) : "\u00a0"; }

function place([x, y]) { return { [map.data.x.name]: x, [map.data.y.name]: y }; }

async function choose(point) {
  view.set({ at: point.join(",") });
}

async function showMotion(point) {
  const data = map.data;
  const heading = `${data.x.label}: ${short(point[0] * data.x.factor)}; ${data.y.label}: ${short(point[1] * data.y.factor)}`;
  const begun = performance.now();
  const it = await ask.object("/api/motion", { ...held(), ...place(point) });
  shown = { it, heading, point };
  drawMotions();
  by("motions").dataset.milliseconds = (performance.now() - begun).toFixed(1);
  tellCommands();
}

function drawMotions() {
  const pin = () => { pins.push(shown); if (pins.length > 2) pins.shift(); drawMotions(); };
  const panels = pins.map((it) => panel(it.it, `Pinned: ${it.heading}`, { remove: () => { pins.splice(pins.indexOf(it), 1); drawMotions(); } }));
  if (shown) panels.unshift(panel(shown.it, shown.heading, { pin }));
  by("motions").replaceChildren(...panels);
  map.pinned = pins.map((it) => [map.share(map.data.x, it.point[0] * map.data.x.factor), map.share(map.data.y, it.point[1] * map.data.y.factor)]);
  map.draw();
}

function mode(isOn) {
  map.isDrawingLine = isOn;
  by("line-button").setAttribute("aria-pressed", String(isOn));
  by("told").textContent = isOn ? "Drag a line over the map, or move the mark with the arrows and press L." : "\u00a0";
}

function line(from, to) {
  mode(false);
  const { x, y } = map.data;
  view.set({ line: [...from.point, ...to.point].join(","), start: by("line-start").value });
  void x; void y;
}

function showLine() {
  const ends = view.text("line")?.split(",").map(Number);
  if (!ends || ends.length !== 4 || !ends.every(Number.isFinite)) return;
  by("line-place").hidden = false;
  const { x, y } = map.data;
  const shares = (a, b) => [map.share(x, a * x.factor), map.share(y, b * y.factor)];
  map.line = { from: shares(ends[0], ends[1]), to: shares(ends[2], ends[3]) };
  map.draw();
  // The diagram is over the axis along which the line is longer on the map.
  const [from, to] = [map.line.from, map.line.to];
  const along = Math.abs(to[0] - from[0]) >= Math.abs(to[1] - from[1]) ? x : y;
  diagram.follow(place(ends.slice(0, 2)), place(ends.slice(2)), held(), along, view.text("start") || "inherit");
}

function quoted(text) { return /^[\w.,=:/+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`; }

function tellCommands() {
  const { of, x, y } = chosen();
  const at = Object.entries(held()).map(([name, value]) => ` --at ${name}=${value}`).join("");
  const sweeps = sweep().sweep ? ` --sweep ${sweep().sweep}` : "";
  const lines = [`capsulemap figure ${quoted(file.file)} --kind map --of ${of} --x ${x} --y ${y}${at}${sweeps}`];
  if (shown) lines.push(shown.it.command);
  by("commands").textContent = lines.join("\n");
}

async function save(format) {
  const answer = await fetch(ask.figure(asked(), format));
  if (!answer.ok) return told(new Error((await answer.json()).error));
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(await answer.blob()), download: `map-${chosen().of}.${format}` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function changed(keys) {
  by("fault").hidden = true;
  try {
    const isOther = keys.some((key) => !["at", "line", "start"].includes(key));
    if (isOther) { drawChoices(); await showMap(); }
    if (keys.includes("at") && view.text("at")) {
      const point = view.text("at").split(",").map(Number);
      map.point(point);
      await showMotion(point);
    }
    if (keys.includes("line") || keys.includes("start")) showLine();
  } catch (fault) { told(fault); }
}

if (file) {
  by("title").textContent = file.title;
  by("about").textContent = `${file.file}: ${file.cases.toLocaleString("en")} cases; ${file.program}`;
  by("study").textContent = file.study;
  document.title = `${file.title}: capsulemap explore`;
  by("line-button").addEventListener("click", () => mode(!map.isDrawingLine));
  by("whole-button").addEventListener("click", () => map.whole());
  by("pdf-button").addEventListener("click", () => save("pdf"));
  by("svg-button").addEventListener("click", () => save("svg"));
  by("line-start").value = view.text("start") || (file.inherits ? "inherit" : "afresh");
  by("line-start").addEventListener("change", () => view.set({ start: by("line-start").value }));
  if (file.axes.length < 2) {
    by("map-place").textContent = "These results have no two axes: there is no map of them.";
  } else {
    view.changed(changed);
    await changed(["of", "at", "line"]);
  }
}
