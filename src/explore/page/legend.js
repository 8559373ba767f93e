// The legend of the map, and what it does not show by itself.

import * as curves from "./curves.js";
import { by } from "./element.js";
import { colours } from "./plot.js";
import { cross, cursor, dot, entry as drawnEntry, front, letter, line, manifold, rectangle, saddle, sectionPoint } from "./marks.js";
import { chosen, onMap, page, pins } from "./shown.js";

/** What the legend has now. */
let shown = "";
// An entry that is drawn where the legend changes.
const entry = (text, draw) => ({ text, draw });

/** Tells what the marks on the map mean, and what is left out. */
export function legend() {
  const { map } = page;
  if (!map?.data) return;
  const { marks } = map, made = page.curves ? curves.entries(curves.seen(page.curves, map), entry) : [];
  const isSeen = (point) => map.isSeen(map.shares(point)), crosses = (from, to) => map.crosses(map.shares(from), map.shares(to));
  for (const direction of ["forward", "backward"]) {
    if (marks.fronts[direction]?.some(isSeen)) made.push(entry(`front, ${direction}`, (drawn, place) => dot(drawn, place, front(direction))));
  }
  made.push(...overBasins(map));
  if (map.chosen && map.isSeen(map.chosen)) made.push(entry("chosen case", (drawn, place) => cross(drawn, place)));
  if (map.hasCursor() && map.isSeen(map.mark)) made.push(entry("mark of the keyboard", (drawn, place) => cursor(drawn, place)));
  marks.pins.filter(({ point }) => isSeen(point)).forEach(({ name }) => made.push(entry(`pinned ${name}`, (drawn, place) => letter(drawn, place, name))));
  if (marks.line && crosses(...marks.line)) made.push(entry("line, from its ring", (drawn, [x, y]) => line(drawn, [[x - 9, y], [x + 12, y]])));
  if (marks.rectangle && sides(marks.rectangle).some((it) => crosses(...it))) made.push(entry("selection", (drawn, [x, y]) => rectangle(drawn, [[x - 11, y - 6], [x + 11, y + 6]])));
  const text = JSON.stringify([made.map((it) => it.text), colours()]);
  if (text !== shown) by("map-legend").replaceChildren(...made.map((it) => drawnEntry(it.text, it.draw)));
  shown = text;
  by("map-legend").hidden = !made.length;
  note();
}

// What lies over basins.
function overBasins(map) {
  const { attractors, saddles, manifolds } = map.marks, made = [], isSeen = ({ at }) => map.isSeen(map.shown(...at));
  const is = manifolds?.projected ? ", projected onto the plane" : "", stroke = (isStable) => (drawn, [x, y]) => manifold(drawn, [[x - 13, y], [x + 13, y]], isStable);
  if (attractors.some(isSeen)) made.push(entry(`section point of an attractor, in its colour${is}`, (drawn, place) => sectionPoint(drawn, place, "#888888")));
  if (saddles.some(isSeen)) made.push(entry(`saddle on the boundary${is}`, saddle));
  if (manifolds?.stable.length) made.push(entry("boundary as a curve", stroke(true)));
  if (manifolds?.unstable.length) made.push(entry(`unstable manifold of a saddle${is}`, stroke(false)));
  return made;
}

// The sides of a rectangle between two of its corners.
const sides = ([[x0, y0], [x1, y1]]) => [[[x0, y0], [x1, y0]], [[x1, y0], [x1, y1]], [[x1, y1], [x0, y1]], [[x0, y1], [x0, y0]]];

/** Tells what the map leaves out as it is seen now. */
export function note() {
  const { map } = page, told = [];
  const crowding = map.cells.crowding(map.area(), map.seen(), window.devicePixelRatio || 1);
  if (crowding > 1.01) told.push("There are more cases than pixels: zoom in to see each.");
  if (map.cells.mask) told.push("Faded: cases that are not selected.");
  if (map.cells.hasGaps) told.push(`Hatched: cases without a value${page.file.running ? " or not computed yet" : ""}.`);
  const away = pins().filter((it) => !onMap(it)).length;
  if (away) told.push(`${away === 1 ? "A pinned case lies" : "Both pinned cases lie"} in another plane or sweep than the map.`);
  if (chosen() && !onMap(chosen())) told.push("The chosen case lies in another plane or sweep than the map.");
  by("map-note").textContent = told.join(" ");
  by("map-note").hidden = !told.length;
}
