// What a file of basins tells of them: attractors with their shares, the saddles between basins, and their manifolds, over the basins and in tables.

import * as ask from "./ask.js";
import * as tip from "./tip.js";
import * as view from "./view.js";
import { button, by, element, sentence, table } from "./element.js";
import { legend } from "./legend.js";
import { model, shown } from "./model.js";
import { multipliers } from "./numbers.js";
import { page } from "./shown.js";
import { short } from "./ticks.js";

/** A mark is meant that lies so near [CSS pixels]. */
const NEAR = 9;
/** Nothing over the basins. */
const NOTHING = { attractors: [], saddles: [], manifolds: null };

/** Whether all axes of a file are coordinates of the start. */
export const isBasin = (file) => file.axes.length > 1 && file.axes.every(({ name }) => name.startsWith("start_"));

/** Whether what lies over the basins is shown. */
export const isShown = () => view.text("bare") !== "1";

/** What the file tells of the plane that is shown last. */
let told = null;

/** Asks what the file tells of the basins of the map; the map itself, in the colours of basins where it shows them. */
export async function tinted(asked, signal) {
  if (!isBasin(page.file)) return ask.map(asked, signal);
  const { x, y } = asked;
  const [data, now] = await Promise.all([ask.map(asked, signal), ask.object("/api/stored-basin", { x, y, ...page.choices.held() }, signal)]);
  told = now;
  if (asked.of !== "attractor" || !data.key.kinds) return data;
  // A basin has a paler colour than its attractor, so that this stands out from it.
  const paler = new Map(told.attractors.map((it) => [String(it.colour), it.basin]));
  data.key.kinds = data.key.kinds.map(([name, colour]) => [name, paler.get(String(colour)) ?? colour]);
  data.values.forEach((kind, cell) => { const colour = data.key.kinds[kind]?.[1]; if (colour) data.colours.set(colour, 4 * cell); });
  return data;
}

/** Lays it over the basins and tells it in tables; `choose` shows the motion of a case by its coordinates. */
export function show(choose) {
  if (!told) return;
  tables(choose);
  over();
}

/** Lays it over the basins, or takes it away. */
export function over() {
  by("curves-switch").checked = isShown();
  if (!told) return;
  const points = (all) => all.flatMap((it, number) => it.points.map((at) => ({ at, number, colour: it.colour })));
  const { attractors, saddles, stable, unstable, projected } = told;
  page.map.set(isShown() ? { attractors: points(attractors), saddles: points(saddles), manifolds: { stable, unstable, projected } } : NOTHING);
  legend();
}

// The case of a number by its coordinates: the last axis varies fastest.
function coordinates(number) {
  const all = {};
  for (const { name, values } of [...page.file.axes].reverse()) {
    all[name] = values[number % values.length];
    number = Math.floor(number / values.length);
  }
  return all;
}

const swatched = (colour, text) => {
  const swatch = element("span", { className: "swatch" });
  swatch.style.background = `rgb(${colour})`;
  return element("span", {}, swatch, text);
};
// A share with its standard error, of which two digits say how many of the share are known.
function share([value, error]) {
  if (!error) return `${short(100 * value, 3)} %`;
  const decimals = Math.min(Math.max(1 - Math.floor(Math.log10(100 * error)), 0), 4);
  return `${(100 * value).toFixed(decimals)} ± ${(100 * error).toFixed(decimals)} %`;
}
const motion = (text) => (/^period/.test(text) ? `periodic, ${text}` : text);

function tables(choose) {
  const { attractors, saddles, outputs, stable, unstable, left_out: out } = told, made = [], counted = (all, word) => (all.length ? [`${all.length} ${word}${all.length === 1 ? "" : "s"}`] : []);
  if (attractors.length) {
    const show = (it, i) => (it.case === null ? "–" : button("Show", () => choose({ ...coordinates(it.case), ...page.choices.from() }), { ariaLabel: `Show the motion of attractor ${i}` }));
    const rows = attractors.map((it, i) => [swatched(it.colour, String(i)), show(it, i), motion(it.motion), share(it.share), ...it.outputs.map((value, at) => shown(value, outputs[at])), multipliers(it.multipliers)]);
    made.push(element("h2", { textContent: "Attractors of the file" }), scrolled("Attractors of the file", ["attractor", "its motion", "motion", "share of starts", ...outputs.map((it) => it.label), "multipliers"], rows));
  }
  if (saddles.length) {
    const rows = saddles.map((it, i) => [String(i), it.between.join(" and "), String(it.period), multipliers(it.multipliers), short(it.misses, 2)]);
    made.push(element("h2", { textContent: "Saddles between the basins" }), scrolled("Saddles between the basins", ["saddle", "between the basins of", "period", "multipliers", "residual"], rows));
  } else if (attractors.length > 1) made.push(element("p", { className: "note", textContent: "The file has no saddle between the basins." }));
  const lines = [...counted(stable, "curve"), ...counted(unstable, "half")];
  if (lines.length) made.push(element("p", { className: "note", textContent: `Manifolds of the saddles: the boundary as ${lines[0]}${lines[1] ? `, and ${lines[1]} of unstable manifolds`.replace("halfs", "halves") : ""}.` }));
  for (const it of out) made.push(element("p", { className: "note", textContent: sentence(it) }));
  by("attractors").replaceChildren(...made);
  by("basin-empty").hidden = made.length > 0;
}

const scrolled = (name, head, rows) => element("div", { className: "wide", tabIndex: 0, role: "group", ariaLabel: name }, table(name, head, rows));

/** Tells of the mark under the pointer of an event; false where there is none. */
export function beside(event) {
  const found = told && isShown() && page.map.met(event, NEAR);
  if (!found) return false;
  const { x, y } = page.map.data, at = [x, y].map((axis, i) => tip.pair(axis.label, short(found.at[i])));
  if (found.kind === "saddle") {
    const it = told.saddles[found.number];
    tip.show(event, { head: `saddle ${found.number}`, colour: null, rows: [["between the basins of", it.between.join(" and ")], ["period", String(it.period)], ["multipliers", multipliers(it.multipliers)], ...at] });
  } else {
    const it = told.attractors[found.number], main = told.outputs.findIndex((one) => one.name === model.main_output.name);
    const rows = [["motion", motion(it.motion)], ["share of starts", share(it.share)], ...(main < 0 ? [] : [tip.pair(told.outputs[main].label, shown(it.outputs[main], told.outputs[main]))]), ["multipliers", multipliers(it.multipliers)], ...at];
    tip.show(event, { head: `attractor ${found.number}`, colour: `rgb(${it.colour})`, rows });
  }
  return true;
}
