// What lies over the map and beside it: marks, the selection, curves, and the trade-off of its cells.

import * as ask from "./ask.js";
import * as curves from "./curves.js";
import * as view from "./view.js";
import { isBasin } from "./attractors.js";
import { selection, told, within } from "./brush.js";
import { by, said, say } from "./element.js";
import { legend } from "./legend.js";
import { axes, cellOf, chosen, ends, onMap, page, pins, price } from "./shown.js";

// What the plane of the map holds, and how many cases the file has.
function plane() {
  const { choices, file } = page, held = choices.held(), { sweep } = choices.sweep();
  const words = choices.others().map((it) => said(it.label, held[it.name] * it.factor));
  return { held: [...words, ...(sweep ? [`sweep ${sweep}`] : [])].join(", "), cases: file.cases };
}

/** Shows the trade-off of the cells of the map, if it is wanted. */
export async function showTradeOff(signal) {
  const name = price();
  const asked = { ...page.choices.asked(), of: name };
  if (!name) page.tradeOff.none("");
  if (asked.sweep === "difference") page.tradeOff.none("The trade-off is that of one sweep: choose upward or downward.");
  else if (name) await page.tradeOff.show(asked, page.map, plane(), signal);
  select();
}

/** Takes away what lies over the map. */
export function bare() {
  Object.assign(page.map.marks, { pins: [], line: null, rectangle: null, fronts: {}, curves: null, spot: null });
  page.map.chosen = null;
  page.tradeOff.data = null;
}

/** Marks what is selected, and the fronts, on the map and in the trade-off. */
export function select() {
  const { map, tradeOff } = page, data = price() ? tradeOff.data : null, wanted = data && selection();
  const mask = wanted && (wanted.plane === "map" ? within(map.data, wanted.ranges) : tradeOff.within(wanted.ranges));
  const words = mask ? told(mask, data) : "";
  if (data) tradeOff.select(mask, wanted?.plane === "trade-off" ? wanted.ranges : null, words);
  map.cells.select(mask);
  const fronts = Object.entries(data?.fronts || {}).map(([direction, cells]) => [direction, cells.map((cell) => tradeOff.coordinates(cell))]);
  const corners = wanted?.plane === "map" ? wanted.ranges[0].map((x, i) => [x, wanted.ranges[1][i]]) : null;
  map.set({ fronts: Object.fromEntries(fronts), rectangle: corners });
  legend();
  if (mask) say(words);
}

/** Shows special points and branches over the map, if they are wanted. */
export async function showCurves(signal) {
  if (isBasin(page.file)) return;
  const isOn = view.text("curves") === "1" && page.file.has_curves;
  by("curves-switch").checked = isOn;
  by("curves-place").hidden = !isOn;
  by("branches-empty").hidden = isOn || by("branches-place").childElementCount > 0;
  page.curves = null;
  if (isOn) {
    const { x, y } = page.choices.chosen();
    page.curves = await ask.object("/api/curves", { x, y, ...page.choices.held() }, signal);
    by("curves-place").replaceChildren(curves.tables(page.curves, page.map.data));
  }
  page.map.set({ curves: page.curves && curves.layer(page.curves) });
  legend();
}

/** The place of the chosen case when it was marked last. */
let last = null;

/** Marks the cases and the line on the map, in the trade-off and in the basin. */
export function mark() {
  const { map, tradeOff, basin } = page, point = onMap(chosen());
  const place = point && map.shares(point), isOther = place && !place.every((it, i) => it === last?.[i]);
  // The mark of the keyboard follows the chosen case only where that changes.
  const seen = JSON.stringify([map.chosen, map.mark, map.marks.pins, map.marks.line]);
  map.chosen = last = place;
  if (isOther || (place && !map.mark)) map.mark = place;
  const pinned = pins().map((it, i) => ({ point: onMap(it), name: "AB"[i] })).filter((it) => it.point);
  const line = ends()?.map((it) => axes().map((axis) => it[axis.name])) ?? null;
  // A case that was clicked is marked already.
  if (JSON.stringify([place, map.mark, pinned, line]) !== seen) map.set({ pins: pinned, line });
  // A case with a start of its own may have another motion than the case of the file.
  const isOwn = Object.keys(chosen() || {}).some((name) => name.startsWith("start_") && !page.choices.axis(name));
  tradeOff.mark(isOwn ? null : cellOf(point));
  basin.mark(chosen());
  legend();
}
