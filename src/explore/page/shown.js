// What is shown, by the address of the page, and where it lies on the map.

import * as view from "./view.js";
import { said } from "./element.js";
import { prices } from "./tradeoff.js";

/** The file and the views of it: `choices`, `map` (none where there are no two axes), `diagram` (of other files), `line`, `basin`, `tradeOff`, `motions`, the
 * `curves` over the map, and the map as it came, in the usual colours (`raw`). */
export const page = { file: null, choices: null, map: null, diagram: null, line: null, basin: null, tradeOff: null, motions: null, curves: null, raw: null };

/** When the case was clicked whose motion is awaited, and how long after that its charts were `seen` [ms]; none where none is. */
export const clicked = { at: null, seen: null };

/** Coordinates are the same if they differ by less than this, relative to their size. */
const SAME = 1e-9;

/** The case whose motion is shown, by its coordinates. */
export const chosen = () => view.coordinates(view.text("at"));

/** The cases that are pinned, by their coordinates. */
export const pins = () => (view.text("pins") || "").split(";").map(view.coordinates).filter((it) => it).slice(0, 2);

/** The price of the trade-off; none where it is not shown. */
export const price = () => prices(page.file).find(([name]) => name === view.text("trade"))?.[0] ?? null;

/** The axes along which lines are drawn: those of the map, or the only one. */
export const axes = () => (page.map?.data ? [page.map.data.x, page.map.data.y] : page.file.axes);

/** The coordinates of a point of the map, by their names. */
export const named = (point) => Object.fromEntries(axes().map((it, i) => [it.name, point[i]]));

/** The place of a case on the map; none where it lies in another plane. */
export function onMap(coordinates) {
  if (!coordinates || !page.map?.data) return null;
  const constants = Object.fromEntries(page.file.constants.map((it) => [it.name, it.value]));
  const plane = Object.entries({ ...constants, ...page.choices.held() });
  const { sweep } = page.choices.from();
  // A difference is that of both sweeps.
  const isSweep = page.choices.sweep().sweep === "difference" || (coordinates.sweep ?? sweep) === sweep;
  const isHere = isSweep && plane.every(([name, value]) => Math.abs((coordinates[name] ?? value) - value) <= SAME * Math.abs(value));
  const point = axes().map((it) => coordinates[it.name]);
  return isHere && point.every((it) => it !== undefined) ? point : null;
}

/** The number of the cell of a case of the map; none between the cases. */
export function cellOf(point) {
  if (!point) return null;
  const found = page.map.at(page.map.shares(point));
  return found.cell.every((it, i) => it === point[i]) ? found.number : null;
}

/** The coordinates of a point of the map in words, with those of the axes that are held. */
export function here(point) {
  const { choices } = page, held = choices.held();
  const drawn = axes().map((it, i) => said(it.label, point[i] * it.factor));
  return [...drawn, ...choices.others().map((it) => said(it.label, held[it.name] * it.factor))];
}

/** The ends of the line by their coordinates; none where it lies over other axes. */
export function ends() {
  const both = (view.text("line") || "").split("~").map(view.coordinates);
  const isFit = both.length === 2 && both.every((it) => it && axes().every((axis) => axis.name in it));
  return isFit ? both : null;
}
