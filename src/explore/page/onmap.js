// What a person does on the map: cases that are chosen, values under the pointer, lines and rectangles.

import * as attractors from "./attractors.js";
import * as tip from "./tip.js";
import * as view from "./view.js";
import { brush } from "./brush.js";
import { by, marked, said, say } from "./element.js";
import { legend } from "./legend.js";
import { axes, clicked, here, named, page, price } from "./shown.js";
import { pane } from "./tabs.js";
import { short } from "./ticks.js";
import { prices } from "./tradeoff.js";

/** Shows the motion of a case. */
export function choose(coordinates) {
  Object.assign(clicked, { at: performance.now(), seen: null });
  view.step({ at: view.written(coordinates), ...pane("motion") });
}

/** Shows the motion of a point of the map. */
export const chooseOnMap = (point) => choose({ ...page.choices.held(), ...named(point), ...page.choices.from() });

/** Tells the values of a cell, of which the keyboard or the pointer of an event asks; none without a cell. */
export function hover(cell, isKey, event = null) {
  const { map, tradeOff } = page;
  // Between the cases the map has the value of the case of the cell.
  const point = () => (map.isExact ? ` (the point: ${axes().map((it, i) => said(it.label, cell.point[i] * it.factor)).join("; ")})` : "");
  const words = cell ? `${[said(map.data.told, map.told(cell)), ...here(cell.cell)].join("; ")}${point()}` : "\u00a0";
  by("told").replaceChildren(...marked(words));
  if (cell && event) { if (!attractors.beside(event)) beside(cell, event); } else tip.hide();
  if (cell && isKey) { say(words); legend(); }
  if (price()) tradeOff.mark(tradeOff.chosen, cell ? cell.number : null);
}

function beside(cell, event) {
  const { map } = page, at = map.isExact ? cell.point : cell.cell;
  const rows = axes().map((it, i) => tip.pair(it.label, short(at[i] * it.factor)));
  tip.show(event, { head: tip.pair(map.data.told, map.told(cell))[1], colour: map.colour(cell), rows: [...rows, ...map.more(cell)] });
}

/** The readout of the map as it is now: at the mark, or none. */
export const readout = () => hover(page.map.mark && page.map.at(page.map.mark), false);

/** Follows a line between two points of the axes. */
export function drawLine(from, to) {
  if (from.some((it, i) => it !== to[i])) view.step({ line: `${view.written(named(from))}~${view.written(named(to))}`, ...pane("line") });
  else { by("told").textContent = "Both ends of the line are at the same case: there is no line."; say(by("told").textContent); }
}

/** Takes a line or a rectangle that was drawn over the map. */
export function drag(kind, from, to) {
  if (kind === "line") { drawLine(from, to); return; }
  if (from.every((it, i) => it === to[i])) return;
  const all = prices(page.file);
  if (!price() && all.length) view.set({ trade: all[0][0] });
  view.set(pane("trade-off"));
  brush("map", [0, 1].map((i) => [Math.min(from[i], to[i]), Math.max(from[i], to[i])]));
}

/** Tells what dragging does now. */
export function mode(kind) {
  by("line-button").setAttribute("aria-pressed", String(kind === "line"));
  by("brush-button").setAttribute("aria-pressed", String(kind === "rectangle"));
  const how = { line: "a line over the map; or begin at the mark with L, move the end with the arrows, and end with L", rectangle: "a rectangle over the map; or begin at the mark with R, move the corner with the arrows, and end with R" };
  const words = how[kind] ? `Drag ${how[kind]}.` : "\u00a0";
  by("told").textContent = words;
  if (how[kind]) say(words);
}
