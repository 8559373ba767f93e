// What is told of a point of the bifurcation diagram of a file: beside the pointer, and in words.

import * as tip from "./tip.js";
import { shade } from "./drawing.js";
import { element, folded, parted, said, sentence, table } from "./element.js";
import { multipliers } from "./numbers.js";
import { result, short } from "./ticks.js";

// What a case is.
function motion(it) {
  const period = it.outcome === "periodic" && it.period ? `, period ${it.period}` : "";
  return `${it.outcome ?? "no outcome"}${period}`;
}

// The values of a case, one of each panel that has one, in words.
function values({ panels }, number) {
  return panels.filter((it) => it.values[number].length).map((it) => {
    const all = it.values[number], [, unit] = parted(it.label);
    return [it.label, all.length > 3 ? `${all.length} values` : all.map((value) => result(value, unit)).join("; ")];
  });
}

/** Tells of a case beside the pointer of an event. */
export function beside(data, { number, x }, event) {
  const it = data.cases[number], rows = [tip.pair(data.x.label, short(x))];
  if (it.sweep) rows.push(["sweep", it.sweep]);
  if (!data.by && data.sorts.length > 1 && it.attractor !== null && it.attractor !== undefined) rows.push(["drawn as", data.sorts[it.sort][0]]);
  for (const [label, text] of values(data, number)) rows.push(tip.pair(label, text));
  tip.show(event, { head: motion(it), colour: colour(data, it), rows });
}

// The colour of the points of a case.
const colour = (data, it) => (data.by ? it.colour && shade(it.colour) : shade(data.sorts[it.sort][1]));

/** The same in words. */
export function told(data, { number, x }) {
  const it = data.cases[number];
  return [said(data.x.label, x), ...(it.sweep ? [`sweep ${it.sweep}`] : []), motion(it), ...values(data, number).map(([label, text]) => said(label, text))].join("; ");
}

/** Tells of a special point beside the pointer of an event. */
export function besideSpecial(data, it, event) {
  const rows = [tip.pair(data.x.label, short(it.at[0], 9))];
  if (it.period) rows.push(["period", String(it.period)]);
  const { panels } = data;
  panels.forEach((panel, i) => { if (it.values?.[i]?.length === 1 || !it.values && i === it.panel) rows.push(tip.pair(panel.label, short(it.values ? it.values[i][0] : it.at[1]))); });
  if (it.multipliers?.length) rows.push(["multipliers", multipliers(it.multipliers)]);
  tip.show(event, { head: it.words, colour: null, rows: [...rows, ["of", it.multipliers ? "a branch" : "an attractor of a sweep"]] });
}

/** The same in words. */
export function toldOfSpecial(data, it) {
  const of = it.multipliers ? `on a branch of period ${it.period}; multipliers ${multipliers(it.multipliers)}` : "of an attractor of a sweep";
  return `${sentence(it.words).slice(0, -1)} at ${said(data.x.label, short(it.at[0], 9))}, ${of}`;
}

/** A point of a ramp in words. */
export const toldOfRamp = (data, { name, at, number }) => `${name}: ${said(data.x.label, at[0])}; ${said(data.panels[number].label, at[1])}`;


/** Tells of a point of a ramp beside the pointer of an event. */
export function besideRamp(data, { name, colour: own, at, number }, event) {
  tip.show(event, { head: name, colour: shade(own), rows: [tip.pair(data.x.label, short(at[0])), tip.pair(data.panels[number].label, short(at[1]))] });
}

/** Tells the branches of the file and their special points in tables in a place. */
export function tables({ x, branches, special, panels }, place) {
  const made = [];
  const many = (all) => (all.length > 4 ? `${all.length} points` : all.map((it) => short(it, 6)).join("; ")) || "–";
  if (branches.length) {
    const rows = branches.map((it) => [it.name, String(it.period), short(it.ends[0]), short(it.ends[1]), String(it.orbits), `${short(100 * it.stable / it.orbits, 3)} %`]);
    made.push(element("h2", { textContent: "Branches of the file" }), table("Branches of the file", ["branch", "period", `from, ${x.label}`, `to, ${x.label}`, "orbits", "stable"], rows));
  }
  if (special.length) {
    const rows = () => special.map((it) => [it.words, short(it.x, 9), String(it.period), ...panels.map((_, i) => many(it.values[i])), multipliers(it.multipliers)]);
    made.push(folded(`Special points of the branches (${special.length})`, ["point", x.label, "period", ...panels.map((it) => it.label), "multipliers"], rows, true));
  }
  place.replaceChildren(...made);
  place.hidden = !made.length;
}
